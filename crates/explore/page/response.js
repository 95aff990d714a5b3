// The response over frequency: this design, no damper, the pinned ones, and what the study's limit forbids; the present ω as a cursor to
// drag.

import { axis, css, worded } from "./charts.js";
import { shown } from "./controls.js";
import { ticks } from "./phase.js";

// A limit up to so many times the largest value is drawn.
const NEAR = 3;
const WHOSE = ["none", "A", "B", "now"];
const STROKES = { none: ["--ink", [5, 4]], A: ["--blue", []], B: ["--green", []], now: ["--vermilion", []] };

export class Response {
    constructor(into, key, part, moved) {
        this.into = into;
        this.key = key;
        this.part = part;
        this.moved = moved;
        this.curves = {};
        this.omega = 0;
        this.chart = null;
        this.branches = null;
        new ResizeObserver(() => this.chart && this.into.clientWidth !== this.chart.width && this.chart.setSize(this.size())).observe(into);
    }

    // Draws curves of a quantity over a band; those of another are dropped.
    begin(band, quantity) {
        if (quantity.name !== this.quantity?.name) this.curves = {};
        this.band = band;
        this.quantity = quantity;
        const series = WHOSE.map((whose) => ({
            stroke: () => css(STROKES[whose][0]),
            dash: STROKES[whose][1],
            width: whose === "now" ? 1.8 : 1.2,
            points: { show: false },
            spanGaps: true,
        }));
        const turn = 2 * Math.PI;
        const hertz = {
            side: 0,
            scale: "x",
            grid: { show: false },
            splits: (u, _, from, to) => ticks([from / turn, to / turn], u.width / 90).map((hertz) => hertz * turn),
            values: (_, splits) => splits.map((omega) => String(Number((omega / turn).toPrecision(6)))),
        };
        this.chart?.destroy();
        this.into.replaceChildren();
        this.chart = new uPlot(
            {
                ...this.size(),
                legend: { show: false },
                cursor: { drag: { x: false, y: false }, points: { show: false }, y: false },
                scales: { x: { time: false, range: () => this.band }, y: { range: (u, least, largest) => [0, this.height(largest)] } },
                series: [{}, ...series],
                axes: [axis("ω, rad/s", 22), axis(`${quantity.name.replace("_", " ")}, ${quantity.unit}`, 50, { values: worded, space: 32 }), axis("frequency, Hz", 20, hertz)],
                hooks: { drawAxes: [(u) => this.forbidden(u)], draw: [(u) => this.branches?.draw(u, this.quantity.name)] },
            },
            [[], ...WHOSE.map(() => [])],
            this.into,
        );
        this.handle = document.createElement("div");
        this.handle.className = "handle";
        this.handle.tabIndex = 0;
        this.handle.setAttribute("role", "slider");
        this.handle.setAttribute("aria-label", "ω, frequency of the force");
        this.handle.setAttribute("aria-valuemin", band[0]);
        this.handle.setAttribute("aria-valuemax", band[1]);
        this.chart.over.append(this.handle);
        this.chart.over.style.touchAction = "pan-y";
        this.chart.over.addEventListener("pointerdown", (event) => {
            if (event.button) return;
            this.chart.over.setPointerCapture(event.pointerId);
            this.drag(event);
        });
        this.chart.over.addEventListener("pointermove", (event) => event.buttons & 1 && this.drag(event));
        this.handle.addEventListener("keydown", (event) => {
            const steps = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
            if (!steps) return;
            event.preventDefault();
            this.move(this.omega + (steps * (band[1] - band[0])) / 300);
        });
    }

    // A limit that is not far above the curves is drawn.
    height(largest) {
        const top = Math.max(largest, this.branches?.top(this.quantity.name) ?? 0);
        const { limit } = this.quantity;
        return 1.06 * (Math.max(top, limit !== null && limit < NEAR * top ? limit : 0) || limit || 1);
    }

    // What the limit of the study on this quantity forbids.
    forbidden(u) {
        const { limit } = this.quantity;
        if (limit === null || limit > u.scales.y.max) return;
        const { ctx, bbox } = u;
        const y = u.valToPos(limit, "y", true);
        ctx.save();
        ctx.fillStyle = css("--forbidden");
        ctx.fillRect(bbox.left, bbox.top, bbox.width, y - bbox.top);
        ctx.strokeStyle = css("--fails");
        ctx.lineWidth = devicePixelRatio;
        ctx.beginPath();
        ctx.moveTo(bbox.left, y);
        ctx.lineTo(bbox.left + bbox.width, y);
        ctx.stroke();
        ctx.restore();
    }

    size() {
        return { width: Math.max(200, this.into.clientWidth), height: innerWidth < 700 ? 230 : 276 };
    }

    drag(event) {
        const box = this.chart.over.getBoundingClientRect();
        this.move(this.chart.posToVal(event.clientX - box.left, "x"));
    }

    move(omega) {
        const [from, to] = this.band;
        this.moved(Number(Math.min(to, Math.max(from, omega)).toFixed(4)));
    }

    at(omega) {
        this.omega = omega;
        if (!this.chart) return;
        this.handle.setAttribute("aria-valuenow", omega);
        this.handle.setAttribute("aria-valuetext", `${omega} rad/s`);
        const left = this.chart.valToPos(omega, "x");
        this.handle.style.transform = `translateX(${left}px)`;
        this.handle.hidden = omega < this.band[0] || omega > this.band[1];
    }

    // The branches that are drawn over the curves; none to take them away.
    follow(branches) {
        this.branches = branches;
        this.chart?.setData(this.table ?? this.chart.data, true);
        this.at(this.omega);
    }

    // A curve of a design; none to take it away.
    set(whose, answer) {
        if (answer && answer.quantity !== this.quantity.name) return; // of the quantity before this one
        if (answer) this.curves[whose] = answer.columns;
        else delete this.curves[whose];
        this.show();
    }

    // All curves on the frequencies of all: uPlot has one abscissa.
    show() {
        const all = new Set();
        for (const curve of Object.values(this.curves)) for (const omega of curve.omega) all.add(omega);
        const omega = [...all].sort((a, b) => a - b);
        const column = (whose) => {
            const curve = this.curves[whose];
            if (!curve) return omega.map(() => null);
            const values = new Map();
            curve.omega.forEach((at, i) => values.set(at, Number.isNaN(curve.value[i]) ? null : curve.value[i]));
            return omega.map((at) => values.get(at) ?? null);
        };
        this.table = [omega, ...WHOSE.map(column)];
        this.chart.setData(this.table, true);
        this.at(this.omega);
        const names = { none: "no damper", A: "A", B: "B", now: "this design" };
        this.key.replaceChildren(
            ...WHOSE.filter((whose) => this.curves[whose]).flatMap((whose) => {
                const line = document.createElement("i");
                line.className = `line ${whose}`;
                return [line, ` ${names[whose]} `];
            }),
        );
        this.explain();
        this.into.setAttribute("aria-label", `${this.quantity.words} over the frequency of the force, from ${this.band[0]} to ${this.band[1]} rad/s`);
    }

    // What the curves are of, and the limit on it.
    explain() {
        const { words, part, limit, limit_part, unit } = this.quantity;
        const beyond = limit !== null && limit > this.height(Math.max(0, ...this.table.slice(1).flat())) ? ", above this chart" : "";
        const said = limit === null ? "" : ` The study's limit: ${shown(limit)} ${unit} ${limit_part}${beyond}.`;
        this.part.textContent = `${words[0].toUpperCase()}${words.slice(1)}, ${part}.${said}`;
    }

    // The curves as a table.
    csv() {
        const { name } = this.quantity;
        const whose = WHOSE.filter((one) => this.curves[one]);
        const head = ["omega", ...whose.map((one) => `${name}_${one}`)].join(",");
        const rows = this.table[0].map((omega, i) => [omega, ...whose.map((one) => this.table[1 + WHOSE.indexOf(one)][i] ?? "")].join(","));
        return [head, ...rows, ""].join("\n");
    }
}
