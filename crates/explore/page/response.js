// The response over frequency: this design, no damper, the pinned ones; the present ω as a cursor to drag.

import { axis, css, worded } from "./charts.js";
import { ticks } from "./phase.js";

const WHOSE = ["none", "A", "B", "now"];
const STROKES = { none: ["--ink", [5, 4]], A: ["--blue", []], B: ["--green", []], now: ["--vermilion", []] };

export class Response {
    constructor(into, key, moved) {
        this.into = into;
        this.key = key;
        this.moved = moved;
        this.curves = {};
        this.omega = 0;
        this.chart = null;
        this.branches = null;
        new ResizeObserver(() => this.chart && this.into.clientWidth !== this.chart.width && this.chart.setSize(this.size())).observe(into);
    }

    begin({ band, quantity }) {
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
                scales: { x: { time: false, range: () => this.band }, y: { range: (u, least, largest) => [0, 1.06 * (Math.max(largest, this.branches?.top ?? 0) || 1)] } },
                series: [{}, ...series],
                axes: [axis("ω, rad/s", 22), axis(`${quantity.name}, ${quantity.unit}`, 50, { values: worded, space: 32 }), axis("frequency, Hz", 20, hertz)],
                hooks: { draw: [(u) => this.branches?.draw(u)] },
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
        this.into.setAttribute("aria-label", `${this.quantity.words} over the frequency of the force, from ${this.band[0]} to ${this.band[1]} rad/s`);
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
