// The figures, with their units: what the page says in numbers. They come as text from the server, to the digits that are printed.

import { help } from "./help.js";

// What the last two rows mean.
const REDUCTION = "How many times less the worst of the band is than without a damper.";
const MOTION = "The kind of motion. “2T, 1, 3” repeats every two periods of the force, with one impact on the structure and three on the obstacle.";

export class Figures {
    constructor({ heroes, table, irregular, said, text }) {
        Object.assign(this, { heroes, table, irregular, said, text });
        this.now = {};
        this.worst = {};
        this.kinds = {};
        this.spread = null;
        this.other = null;
    }

    begin({ quantity, band, figures, transient }) {
        this.transient = transient;
        this.quantity = quantity;
        this.rows = figures;
        this.band = band;
    }

    motion(answer, omega) {
        this.now = answer.figures;
        this.omega = omega;
        this.text.textContent = answer.text;
        this.show();
    }

    worse(answer) {
        this.worst[answer.whose] = answer;
        this.show();
    }

    kind(answer) {
        this.kinds[answer.whose ?? "now"] = answer;
        if (!answer.whose && !answer.irregular) this.spread = null;
        this.show();
    }

    scatter(answer) {
        this.spread = answer;
        this.show();
    }

    // The largest of all motions that were found; none where they are not looked for.
    follow(largest) {
        this.other = largest ?? null;
        this.show();
    }

    unpin(whose) {
        delete this.worst[whose];
        delete this.kinds[whose];
        this.show();
    }

    show() {
        const { now, quantity, band } = this;
        const worst = this.worst.now;
        const kind = this.kinds.now;
        const { transient } = this;
        const over = transient ? "of the run" : `over ${band.map((end) => Number(end.toPrecision(4))).join(" to ")} rad/s`;
        const [value, unit] = worst?.words ? [worst.words, quantity.unit] : ["–", ""];
        const heroes = [
            [value, unit, `${transient ? "largest" : "worst"} ${quantity.name} ${over}`, worst?.words && !transient ? `at ω = ${Number(worst.omega.toPrecision(4))} rad/s` : (worst?.problem ?? "")],
            [worst?.reduction ? worst.reduction : "–", "", "times less than without a damper", worst?.none ? `which has ${worst.none} ${quantity.unit}` : ""],
            [kind?.label ?? "–", "", transient ? "kind of motion" : "kind of motion at this ω", kind?.words ?? ""],
        ];
        if (this.other) heroes.push(this.coexisting());
        update(this.heroes, JSON.stringify(heroes), () =>
            heroes.map(([value, unit, words, more]) => {
                const hero = element("div", "hero");
                const number = element("p", "number", value);
                if (unit) number.append(element("small", "", ` ${unit}`));
                hero.append(number, element("p", "", words), element("p", "more", more));
                return hero;
            }),
        );
        this.irregular.hidden = !kind?.irregular;
        if (kind?.irregular) {
            const ends = this.spread?.ends;
            const among = ends ? ` ${this.spread.members} neighbours within 0.1 % have E1max from ${ends[0]} to ${ends[1]} J.` : "";
            this.irregular.replaceChildren(element("b", "", "One realisation."), ` The motion is irregular: its E1max is one of many.${among}`);
        }
        const columns = [[transient ? "in the window" : `at ω = ${Number((this.omega ?? 0).toPrecision(5))}`, now, ""], [transient ? "from the start on" : "worst of band, from rest on", worst?.figures, ""]];
        for (const whose of ["A", "B"]) {
            if (this.worst[whose]) columns.push([`${whose}, worst`, this.worst[whose].figures, whose.toLowerCase()]);
        }
        const pinned = columns.slice(2).map(([, , whose]) => whose.toUpperCase());
        const times = (answer) => (answer?.reduction ? `${answer.reduction}×` : "–");
        const rows = [
            ["", ...columns.map(([name]) => name)],
            ...this.rows.map(([name, unit]) => [(unit ? `${name}, ${unit}` : name).replace("_", " "), ...columns.map(([, figures]) => worded(figures?.[name]))]),
            ["reduction", "", times(worst), ...pinned.map((whose) => times(this.worst[whose]))],
            ["motion", kind?.label ?? "–", "", ...pinned.map((whose) => this.kinds[whose]?.label ?? "–")],
        ];
        const meanings = [...this.rows.map(([name, , words]) => `${name.replace("_", " ")}: ${words}.`), REDUCTION, MOTION];
        // The cells stay while their numbers change: a table that is made anew at every step of a drag is laid out anew.
        update(this.table, `pinned ${pinned} ${transient}`, () => rows.map((row, i) => tableRow(row, i, columns, meanings[i - 1])));
        rows.forEach((row, i) => row.forEach((words, j) => write(this.table.children[i].children[j], words)));
    }

    coexisting() {
        const { words, omega, rest, share, periods } = this.other;
        const starts = rest ? "from rest" : "from other starts";
        const motion = periods ? "" : "; it does not repeat";
        const few = share && !rest ? `, of which at most ${Math.round(100 * share)} % end there` : "";
        return [words, this.quantity.unit, "largest over all motions found", `at ω = ${Number(omega.toPrecision(4))} rad/s, ${starts}${few}${motion}`];
    }

    // What a screen reader says once everything is known.
    say() {
        const worst = this.worst.now;
        const { quantity } = this;
        const words = worst?.words ? `worst ${quantity.name} ${worst.words} ${quantity.unit}, ` : "";
        const others = this.other ? `over all motions found ${this.other.words} ${quantity.unit}, ` : "";
        this.said.textContent = `${words}${others}${this.transient ? "in the window" : "at this frequency"} E1max ${this.now.E1max} J, ${this.kinds.now?.label ?? ""}`;
    }
}

const worded = (value) => (Array.isArray(value) ? value.map((one) => one ?? "–").join(", ") : (value ?? "–"));

function tableRow(row, i, columns, meaning) {
    const made = element("tr");
    made.append(
        ...row.map((_, j) => {
            const cell = element(j && i ? "td" : "th", j ? columns[j - 1][2] : "");
            if (cell.tagName === "TH") cell.scope = j ? "col" : "row";
            if (!j) cell.append(element("span"));
            if (!j && meaning) help(cell.firstChild, meaning);
            return cell;
        }),
    );
    return made;
}

function write(place, words) {
    const cell = place.firstElementChild ?? place;
    if (cell.textContent !== words) cell.textContent = words;
}

// Makes what is inside anew where its key has changed.
function update(into, key, make) {
    if (into.key !== key) into.replaceChildren(...make());
    into.key = key;
}

function element(tag, kind = "", words = "") {
    const made = document.createElement(tag);
    if (kind) made.className = kind;
    if (words) made.textContent = words;
    return made;
}
