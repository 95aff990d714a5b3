// The page: what is turned goes to the server, and what comes back is shown.

import { Branches } from "./branches.js";
import { Series, forget } from "./charts.js";
import { build, mark, refresh } from "./controls.js";
import { Drawing } from "./drawing.js";
import { Figures } from "./figures.js";
import { Forcing } from "./forcing.js";
import { Link } from "./link.js";
import { Own, sent } from "./own.js";
import { Phase } from "./phase.js";
import { asked, begin, controls, copy, know, place, quantities, quantity, remember, value } from "./place.js";
import { Response } from "./response.js";
import { copyText, download } from "./save.js";
import { Tuning } from "./tuning.js";

const $ = (id) => document.getElementById(id);
const SLOTS = ["A", "B"];

let hello = null;
let id = 0;
let resting = false; // whether what does not move with the hand waits to be drawn
let latest = null;
let tuningHere = false;
let begun = false;
let forced = false; // whether the session has been told what moves the structure
let kept = null; // what moved it before, and the text of a record
let record = null;
const wrong = { own: false, forcing: false }; // whether what the address has of them is none
let fresh = false; // whether a structure of one's own has been sent, whose damper and numbers are to be shown

const series = new Series($("series"), (span) => show(span, null));
const response = new Response($("response"), $("response-key"), $("response-part"), (omega) => {
    place.set.omega = omega;
    refresh();
    turned();
});
const drawing = new Drawing($("drawing"));
const phases = [new Phase($("phase-1"), ["x1", "v1"], "--blue"), new Phase($("phase-2"), ["x", "v"], "--vermilion")];
const branches = new Branches($("following"));
const figures = new Figures({ heroes: $("heroes"), table: $("figures"), irregular: $("irregular"), said: $("said"), text: $("text") });
const tuning = new Tuning({ section: $("tuning"), canvas: $("map"), words: $("map-words"), log: $("log"), result: $("tuned") });

const frequency = () => hello.controls.find(({ name }) => name === "omega");
const omega = () => (frequency() ? value(frequency()) : 0); // of a pulse or a record there is none

function problem(words, field = null) {
    $("problem").hidden = !words;
    $("problem").textContent = words ?? "";
    mark(field);
}

// Tells whoever watches the page how far it is: tests and measurements do.
const tell = (what, detail) => document.dispatchEvent(new CustomEvent(what, { detail }));

// Asks for what the page should show now. The server drops what it was doing for an earlier place.
function turned() {
    id += 1;
    tell("asked", id);
    response.at(omega());
    remember();
    link.send({ look: { id, place: asked(), span: place.span, columns: series.columns(), branches: place.branches, quantity: quantity().name } });
}

const answers = {
    hello(answer) {
        hello = answer;
        know(answer);
        if (!begun) begin(answer);
        if (!begun) for (const part of Object.keys(wrong)) if (wrong[part]) place[part] = null;
        if (place.own && !answer.own) {
            link.send({ own: { structure: sent(place.own) } });
            return;
        }
        if (place.forcing && !forced) {
            forced = true;
            link.send({ force: { forcing: place.forcing, text: record } });
            return;
        }
        if (fresh) {
            Object.assign(place, { damper: answer.damper, set: {}, span: null, pins: [null, null] });
            response.curves = {};
            SLOTS.forEach(unpin);
        }
        if (!begun) $("own").open = !answer.named && !answer.own;
        else if (fresh) $("own").open = false;
        if (place.own) own.show(place.own);
        forcing.show(place.forcing);
        forcing.refuse(null);
        if (begun) forcing.details.open = false;
        moved(answer);
        [begun, fresh] = [true, false];
        $("study").textContent = answer.study;
        document.title = `${answer.study}: Retune explore`;
        figures.begin(answer);
        $("from-rest").hidden = !answer.motions;
        dampers();
        followed();
        build($("controls"), turned, problem);
        SLOTS.forEach((_, slot) => place.pins[slot] && pin(slot));
        pressed(place.span ? null : "window");
        $("tune").hidden = !answer.tunes;
        turned();
    },
    motion(answer) {
        if (answer.id !== id) return;
        problem(null);
        paint(answer);
    },
    response(answer) {
        response.set(answer.whose, answer);
    },
    worst(answer) {
        figures.worse(answer);
    },
    "motion kind"(answer) {
        figures.kind(answer);
        if (answer.whose) return;
        if (!answer.irregular) series.scatter(null);
        const { columns } = answer;
        if (columns["crest.x1"]?.length) points(columns);
    },
    spread(answer) {
        figures.scatter(answer);
        series.scatter(answer);
    },
    following(answer) {
        branches.progress(answer);
        followed();
    },
    branches(answer) {
        branches.set(answer);
        followed();
        figures.say();
        tell("followed", answer.id);
    },
    done(answer) {
        if (resting) rest();
        figures.say();
        tell("known", answer.id);
    },
    pinned(answer) {
        if (answer.problem) problem(`${answer.whose}: ${answer.problem}`);
    },
    refused(answer) {
        if (answer.force) {
            forcing.refuse(answer.problem, answer.field);
            place.forcing = kept;
            if (!begun) {
                wrong.forcing = true;
                answers.hello(hello);
            }
            return;
        }
        if (answer.own) {
            own.refuse(answer.problem, answer.field);
            place.own = hello.own ? place.own : null;
            if (!begun) {
                wrong.own = true;
                answers.hello(hello);
            }
            return;
        }
        if (answer.tuning) running(false);
        problem(answer.problem, answer.field);
    },
    tuning(answer) {
        running(true);
        tuning.begin(answer);
    },
    map: (answer) => tuning.map(answer),
    row: (answer) => tuning.row(answer),
    tuned(answer) {
        running(false);
        tuning.end(answer);
        place.damper = tuningHere.damper;
        place.set = { ...tuningHere.set, ...answer.design };
        dampers();
        build($("controls"), turned, problem);
        turned();
    },
    written(answer) {
        if (answer.file) download(answer.file, answer.text);
        else copyText($("copied"), answer.text);
    },
};

const own = new Own($("own"), $("own-problem"), (structure) => {
    [place.own, place.forcing, fresh] = [structure, null, true];
    link.send({ own: { structure: sent(structure) } });
});

const forcing = new Forcing($("forcing"), (said) => {
    [kept, place.forcing, record, forced, place.span] = [place.forcing, said.forcing, said.text ?? null, true, null];
    link.send({ force: said });
});

// What moves the structure, in words; what there is of a motion without a frequency.
function moved({ forcing, transient }) {
    const named = place.forcing?.pulse ? `a ${place.forcing.pulse} of ${place.forcing.peak} ${place.forcing.unit ?? forcing.unit} in ${place.forcing.duration} s` : place.forcing?.record;
    const words = named ?? (forcing ? forcing.words : "its start");
    $("moved").textContent = named && forcing ? `${named}: ${forcing.words}` : words;
    $("frequency").hidden = transient;
    $("crests").hidden = transient;
    $("drawn-periods").textContent = transient ? "first periods" : "last periods";
}

const link = new Link(
    (answer) => answers[answer.kind]?.(answer),
    (open) => {
        if (open) forced = false; // a new session begins with the study's own
        document.body.classList.toggle("lost", !open);
        if (!open) running(false);
        problem(open ? null : "The connection is lost: is `retune explore` still running? This page tries again.");
    },
);

// What moves with the hand is drawn at once, so that the next frame has it; the rest after that frame.
function paint(motion) {
    latest = motion;
    series.spread = null; // that of an earlier place
    series.show(motion, place.damper, hello.forcing);
    tell("painted", motion.id);
    if (!resting) requestAnimationFrame(() => setTimeout(rest));
    resting = true;
}

function rest() {
    resting = false;
    figures.motion(latest, omega());
    const size = controls().find(({ amplitude }) => amplitude);
    drawing.show(latest, { damper: place.damper, P: size ? value(size) : 0 });
    $("phase-2-figure").hidden = place.damper === "none";
    points(latest.columns, latest);
}

function points(columns, motion = null) {
    const drawn = motion?.columns;
    const walls = motion ? motion.walls : phases[1].walls;
    phases.forEach((phase, i) => {
        const [x, v] = phase.names;
        const line = drawn ? [drawn[`drawn.${x}`], drawn[`drawn.${v}`]] : phase.line;
        if (line) phase.show(line, [columns[`crest.${x}`], columns[`crest.${v}`]], i ? walls : null);
    });
}

// Branches are kept while they are hidden: the server sends them once for a design.
function followed() {
    $("follow").checked = place.branches;
    const shown = place.branches ? branches : null;
    branches.describe(hello.quantity, place.branches);
    response.follow(shown);
    figures.follow(shown?.found?.largest);
}

$("follow").addEventListener("change", ({ target }) => {
    place.branches = target.checked;
    followed();
    turned();
});

// The quantity of the curves, of those that the damper has. Those of another are asked for anew.
function curved() {
    const now = quantity();
    $("quantity").replaceChildren(...quantities().map(({ name, words, limit }) => new Option(`${name.replace("_", " ")}${limit === null ? "" : ", limited"}`, name, false, name === now.name)));
    $("quantity").title = now.words;
    if (response.quantity === now) return;
    const another = response.quantity && response.quantity.name !== now.name;
    response.begin(hello.band, now);
    response.show();
    if (another) SLOTS.forEach((_, slot) => place.pins[slot] && pin(slot));
}

$("quantity").addEventListener("change", ({ target }) => {
    place.quantity = target.value === hello.quantity.name ? null : target.value;
    curved();
    turned();
});

function dampers() {
    curved();
    for (const input of $("dampers").querySelectorAll("input")) input.checked = input.value === place.damper;
    $("tune").disabled = place.damper === "none" || tuning.running;
}

$("dampers").addEventListener("change", ({ target }) => {
    place.damper = target.value;
    dampers();
    build($("controls"), turned, problem);
    turned();
});

// Spans of time by name.
function show(span, name) {
    place.span = span;
    pressed(name);
    turned();
}

function pressed(name) {
    for (const button of document.querySelectorAll("[data-span]")) button.setAttribute("aria-pressed", String(button.dataset.span === name));
}

for (const button of document.querySelectorAll("[data-span]")) {
    button.addEventListener("click", () => {
        const end = hello.window[1];
        const periods = 12 * (omega() > 0 ? (2 * Math.PI) / omega() : hello.period);
        const spans = { window: null, run: [0, end], start: [0, Math.min(end, periods)], end: [Math.max(0, end - periods), end] };
        show(spans[button.dataset.span], button.dataset.span);
    });
}

function pin(slot) {
    const button = $(`pin-${SLOTS[slot]}`);
    button.setAttribute("aria-pressed", "true");
    button.textContent = `Unpin ${SLOTS[slot]}`;
    link.send({ pin: { slot, place: asked(place.pins[slot]), quantity: quantity().name } });
}

function unpin(whose) {
    $(`pin-${whose}`).setAttribute("aria-pressed", "false");
    $(`pin-${whose}`).textContent = `Pin ${whose}`;
    response.set(whose, null);
    figures.unpin(whose);
}

SLOTS.forEach((whose, slot) =>
    $(`pin-${whose}`).addEventListener("click", () => {
        if (place.pins[slot]) {
            place.pins[slot] = null;
            unpin(whose);
        } else {
            place.pins[slot] = copy();
            pin(slot);
        }
        remember();
    }),
);

function running(is) {
    tuning.running = is;
    $("stop").disabled = !is;
    $("close").disabled = is;
    dampers();
}

$("tune").addEventListener("click", () => {
    tuningHere = copy();
    link.send({ tune: { place: asked() } });
});
$("stop").addEventListener("click", () => link.send({ stop: {} }));
$("close").addEventListener("click", () => ($("tuning").hidden = true));

$("save").addEventListener("click", ({ target }) => {
    const what = target.dataset.write;
    if (!what) return;
    $("save").open = false;
    if (what === "curves") download(`${hello.study}-response.csv`, response.csv());
    else link.send({ write: { place: asked(), what, pins: place.pins.map((pin) => pin && asked(pin)), quantity: quantity().name } });
});
document.addEventListener("click", ({ target }) => !$("save").contains(target) && ($("save").open = false));
document.addEventListener("keydown", ({ key }) => key === "Escape" && ($("save").open = false));

const paused = () => {
    $("pause").setAttribute("aria-pressed", String(drawing.paused));
    $("pause").textContent = drawing.paused ? "Play" : "Pause";
};
$("pause").addEventListener("click", () => {
    drawing.pause(!drawing.paused);
    paused();
});
$("speed").addEventListener("change", ({ target }) => (drawing.speed = Number(target.value)));
paused();

const restyle = () => {
    forget();
    series.redraw();
    response.chart?.redraw(false, true);
    phases.forEach((phase) => phase.draw());
    tuning.draw();
    drawing.draw();
};
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", restyle);
