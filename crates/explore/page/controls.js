// Sliders with editable numbers.

import { help } from "./help.js";
import { controls, place, value } from "./place.js";

const STEPS = 1000;

const share = ({ range: [from, to], log }, number) =>
    log ? Math.log(Math.max(number, 1e-300) / from) / Math.log(to / from) : (number - from) / (to - from);

function number({ range: [from, to], log }, share) {
    const exact = log ? from * (to / from) ** share : from + (to - from) * share;
    // As many digits as a step of the slider tells apart, so that what is shown is what is run.
    const step = log ? (exact * Math.log(to / from)) / STEPS : (to - from) / STEPS;
    const digits = Math.max(0, Math.min(12, 1 - Math.floor(Math.log10(step))));
    return Math.min(to, Math.max(from, Number(exact.toFixed(digits))));
}

export function shown(number) {
    const rounded = Number(number.toPrecision(6));
    return Math.abs(rounded) < 1e7 ? String(rounded) : rounded.toExponential().replace("e+", "e");
}

// A number as it was typed, in the SI unit: alone, or with one of the control's units; NaN where it is none.
export function read({ units }, text) {
    const [, number, unit] = text.trim().replace(",", ".").match(/^([-+]?[\d.]+(?:e[-+]?\d+)?)\s*(.*)$/i) ?? [];
    const size = unit ? units.find(([name]) => name === unit)?.[1] : 1;
    return number === undefined || size === undefined ? NaN : Number(number) * size;
}

let rows = [];

// What a parameter is, how far its slider goes and what else may be typed.
function explained({ words, unit, units, range, value: own }, symbol) {
    const [from, to, set] = [...range, own].map(shown);
    const named = units.map(([name]) => name).filter(Boolean);
    const typed = named.length > 1 ? `, also in ${named.filter((name) => name !== unit).join(", ")}` : "";
    return `${symbol}: ${words}. The study has ${set} ${unit}. The slider goes from ${from} to ${to} ${unit}; the field takes what is allowed beyond it${typed}.`;
}

// Where the slider ends, if it stands there.
function ended({ range: [from, to] }, now) {
    const near = (end) => Math.abs(now - end) <= 1e-9 * Math.max(Math.abs(end), Math.abs(to - from));
    if (near(from) || now < from) return now < from ? "below the slider" : "the slider's lower end";
    return near(to) ? "the slider's upper end" : now > to ? "above the slider" : "";
}

// Makes the controls of the present damper. `changed` is called with the name of what was turned, `refused` with what is wrong with what was
// typed, and its name.
export function build(into, changed, refused) {
    const open = into.querySelector("details")?.open;
    into.replaceChildren();
    const walls = document.createElement("details");
    walls.innerHTML = "<summary>Walls and contacts</summary>";
    walls.open = Boolean(open);
    rows = controls().map((control) => {
        const row = document.createElement("div");
        row.className = "control";
        row.innerHTML = `<label><b></b> <span></span></label><span class="end"></span>
            <input type="range" min="0" max="${STEPS}" step="1"><input type="text" inputmode="decimal" autocomplete="off" spellcheck="false"><span class="unit"></span>`;
        const [slider, text] = row.querySelectorAll("input");
        const symbol = control.name === "omega" ? "ω" : control.name;
        row.querySelector("b").textContent = symbol;
        help(row.querySelector("b"), explained(control, symbol));
        row.querySelector("label span").textContent = control.words;
        row.querySelector(".unit").textContent = control.unit;
        slider.id = `slider-${control.name}`;
        text.id = `number-${control.name}`;
        row.querySelector("label").htmlFor = slider.id;
        slider.setAttribute("aria-label", `${symbol}, ${control.words}`);
        text.title = `${symbol}, ${control.words}: a number in ${control.unit || "no unit"}${control.units.length > 1 ? `, or with a unit: ${control.units.map(([name]) => name).join(", ")}` : ""}`;
        text.setAttribute("aria-label", `${symbol}, ${control.words}, in ${control.unit}`);
        const put = (to) => {
            if (to === control.value) delete place.set[control.name];
            else place.set[control.name] = to;
            refresh();
            changed(control.name);
        };
        slider.addEventListener("input", () => put(number(control, slider.value / STEPS)));
        slider.addEventListener("dblclick", () => put(control.value));
        text.addEventListener("change", () => {
            const typed = read(control, text.value);
            const names = control.units.map(([name]) => name).filter(Boolean);
            if (!text.value.trim()) refresh();
            else if (Number.isFinite(typed)) put(typed);
            else refused(`${control.name}: "${text.value}" is not a number${names.length ? `, alone or in ${names.join(", ")}` : ""}`, control.name);
        });
        (control.of_contact ? walls : into).append(row);
        return { control, slider, text, row };
    });
    if (walls.childElementCount > 1) into.append(walls);
    refresh();
}

// Shows the numbers as they are.
export function refresh() {
    for (const { control, slider, text, row } of rows) {
        const now = value(control);
        const at = Math.round(STEPS * Math.min(1, Math.max(0, share(control, now))));
        if (Number(slider.value) !== at) slider.value = at;
        const hertz = control.name === "omega" ? `: ${Number((now / (2 * Math.PI)).toPrecision(4))} Hz` : "";
        const bound = ["smallest", "largest"].find((_, end) => control.bounds[end] !== null && Math.abs(now - control.bounds[end]) <= 1e-9 * Math.abs(now));
        const end = bound ? `the ${bound} that the study allows` : ended(control, now);
        row.querySelector("label span").textContent = `${control.words}${hertz}`;
        row.querySelector(".end").textContent = end;
        slider.setAttribute("aria-valuetext", `${shown(now)} ${control.unit}${end ? `, ${end}` : ""}`);
        if (document.activeElement !== text || Number(text.value) !== now) text.value = shown(now);
        row.classList.toggle("changed", control.name in place.set);
        row.title = control.name in place.set ? `the study has ${shown(control.value)} ${control.unit}` : "";
    }
}

// Marks what the server refused; nothing with no name.
export function mark(name) {
    for (const { control, text } of rows) text.setAttribute("aria-invalid", String(control.name === name));
}
