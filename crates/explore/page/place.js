// What the page shows: the structure where it is one's own, the damper, the numbers that differ from the study's, the span of time, the
// quantity of the curves, what moves it where that is not the study's, whether branches are drawn, and the pinned designs. The address holds all of it, so that a reload or a copy of the
// address shows the same.

export const place = { damper: "ssvi", set: {}, span: null, quantity: null, branches: false, pins: [null, null], own: null, forcing: null };

let hello = null;
let writing = 0;

// The numbers that a damper has.
export const controls = (damper = place.damper) => hello.controls.filter((control) => control.dampers.includes(damper));

export const value = (control, of = place) => of.set[control.name] ?? control.value;

// The quantities that the damper has, and the one that curves are of: the one that was chosen where the damper has it, else the study's.
export const quantities = () => hello.quantities.filter(({ of_damper, of_walls }) => (!of_damper || place.damper !== "none") && (!of_walls || place.damper === "ssvi"));

export const quantity = () => {
    const named = (name) => quantities().find((one) => one.name === name);
    return named(place.quantity) ?? named(hello.quantity.name) ?? hello.quantities[0];
};

// A design as the server reads it: only what its damper has.
export function asked(of = place) {
    const set = {};
    for (const control of controls(of.damper)) {
        if (control.name in of.set) set[control.name] = of.set[control.name];
    }
    return { damper: of.damper, set };
}

export const copy = (of = place) => ({ damper: of.damper, set: { ...of.set } });

// What the server says of the study of the session.
export const know = (said) => (hello = said);

// What the address holds, beside what the server said first.
export function begin(said) {
    place.damper = said.damper;
    const words = new URLSearchParams(location.hash.slice(1));
    Object.assign(place, design(words));
    const span = (words.get("span") ?? "").split(",").map(Number);
    place.span = span.length === 2 && span[0] >= 0 && span[1] > span[0] ? span : null;
    place.quantity = words.get("quantity");
    place.branches = words.get("branches") === "1";
    place.own = structure(words.get("own"));
    place.forcing = object(words.get("forcing"));
    place.pins = ["A", "B"].map((slot) => {
        const text = words.get(slot);
        return text ? design(new URLSearchParams(text.replaceAll(";", "&"))) : null;
    });
}

// A structure of one's own, as its form has it.
function structure(text) {
    const found = object(text);
    return found && Object.values(found).every((value) => typeof value === "string") ? found : null;
}

function object(text) {
    try {
        const found = JSON.parse(text);
        return found && typeof found === "object" ? found : null;
    } catch {
        return null;
    }
}

function design(words) {
    const damper = words.get("damper");
    const set = {};
    for (const { name } of hello.controls) {
        const number = words.has(name) ? Number(words.get(name)) : NaN;
        if (Number.isFinite(number)) set[name] = number;
    }
    return { damper: ["none", "tmd", "ssvi"].includes(damper) ? damper : hello.damper, set };
}

const written = ({ damper, set }, separator) =>
    [`damper=${damper}`, ...Object.entries(set).map(([name, number]) => `${name}=${number}`)].join(separator);

// Writes the address, not at every step of a drag: browsers limit how often it may change.
export function remember() {
    clearTimeout(writing);
    writing = setTimeout(() => {
        const words = [written(place, "&")];
        if (place.span) words.push(`span=${place.span.map((t) => Number(t.toPrecision(7)))}`);
        if (place.quantity) words.push(`quantity=${place.quantity}`);
        if (place.branches) words.push("branches=1");
        if (place.own) words.push(`own=${encodeURIComponent(JSON.stringify(place.own))}`);
        // A record is too long for an address.
        if (place.forcing?.pulse) words.push(`forcing=${encodeURIComponent(JSON.stringify(place.forcing))}`);
        place.pins.forEach((pin, slot) => pin && words.push(`${"AB"[slot]}=${written(pin, ";")}`));
        history.replaceState(null, "", `#${words.join("&")}`);
    }, 150);
}
