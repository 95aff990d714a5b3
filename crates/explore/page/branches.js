// Every periodic motion over the band: stable ones solid, unstable ones dashed, and what happens along them.

import { css } from "./charts.js";

// As `retune branches` draws them.
const MARKS = {
    fold: ["--vermilion", (path, x, y, r) => (path.moveTo(x, y - r), path.lineTo(x + r, y + r), path.lineTo(x - r, y + r), path.closePath())],
    "branch point": ["--orange", (path, x, y, r) => path.arc(x, y, r, 0, 2 * Math.PI)],
    "period doubling": ["--purple", (path, x, y, r) => path.rect(x - 0.8 * r, y - 0.8 * r, 1.6 * r, 1.6 * r)],
    "Neimark-Sacker": ["--green", (path, x, y, r) => path.arc(x, y, r, 0, 2 * Math.PI)],
    grazing: [null, (path, x, y, r) => (path.moveTo(x - r, y - r), path.lineTo(x + r, y + r), path.moveTo(x - r, y + r), path.lineTo(x + r, y - r))],
};

export class Branches {
    constructor(words) {
        this.words = words;
        this.found = null;
        this.going = null;
    }

    progress(answer) {
        this.found = null;
        this.going = answer;
    }

    set(answer) {
        this.found = answer;
        this.going = null;
    }

    // The largest value that is drawn.
    top(quantity) {
        const values = this.of(quantity);
        return values.reduce((top, value) => (value > top ? value : top), 0);
    }

    // The values of a quantity along them.
    of(quantity) {
        return this.found?.columns[quantity] ?? [];
    }

    draw(u, quantity) {
        if (!this.found?.columns.omega) return;
        const { ctx, bbox } = u;
        const { omega, stable } = this.found.columns;
        const value = this.of(quantity);
        const at = (x, y) => [u.valToPos(x, "x", true), u.valToPos(y, "y", true)];
        const ratio = devicePixelRatio;
        ctx.save();
        ctx.beginPath();
        ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
        ctx.clip();
        ctx.strokeStyle = css("--purple");
        for (const is of [0, 1]) {
            ctx.lineWidth = (is ? 2 : 1) * ratio;
            ctx.setLineDash(is ? [] : [3 * ratio, 3 * ratio]);
            ctx.beginPath();
            for (let i = 0; i + 1 < omega.length; i++) {
                if (stable[i] !== is || Number.isNaN(omega[i + 1])) continue;
                if (i === 0 || stable[i - 1] !== is) ctx.moveTo(...at(omega[i], value[i]));
                ctx.lineTo(...at(omega[i + 1], value[i + 1]));
            }
            ctx.stroke();
        }
        ctx.setLineDash([]);
        ctx.lineWidth = ratio;
        for (const [kind, x, , values] of this.found.events) {
            const y = values[quantity];
            const [colour, shape] = MARKS[kind];
            ctx.beginPath();
            shape(ctx, ...at(x, y), 3.5 * ratio);
            ctx.fillStyle = colour ? css(colour) : "transparent";
            ctx.strokeStyle = css(colour ? "--card" : "--ink");
            if (colour) ctx.fill();
            ctx.stroke();
        }
        ctx.restore();
    }

    // What is drawn, or how far the search is.
    describe(quantity, shown) {
        this.words.hidden = !shown || !(this.found || this.going);
        if (this.words.hidden) return;
        const { found, going } = this;
        if (going) {
            const now = going.done < going.of ? `runs from rest at ${going.done} of ${going.of} frequencies` : "runs from other starts, and their branches";
            this.words.textContent = `Looking for other motions: ${now} …`;
        } else if (found.problem) {
            this.words.textContent = `Branches: ${found.problem}.`;
        } else {
            const ended = found.ended ? "The search was ended at the most motions that a page may ask for: there may be more. " : "";
            const kinds = Object.keys(MARKS).filter((kind) => found.events.some((event) => event[0] === kind));
            this.words.replaceChildren(
                ...key("line branch", "stable motions"),
                ...key("line unstable", "unstable"),
                ...kinds.flatMap((kind) => key(`mark ${kind.split(/[ -]/)[0]}`, kind)),
                document.createElement("br"),
                `${ended}All of it, as tables and a page: `,
                code("retune branches"),
            );
        }
    }
}

function code(words) {
    const made = document.createElement("code");
    made.textContent = words;
    return made;
}

// A mark with its words, which stay together, and a space after which a line may end.
function key(kind, words) {
    const made = document.createElement("span");
    const mark = document.createElement("i");
    mark.className = kind;
    made.append(mark, ` ${words}`);
    return [made, " "];
}
