// Time series: displacement, relative displacement with walls and contacts, E1 with its maximum and the spread of neighbours, forces.

// Colours of the style sheet. They are kept, for asking in the middle of drawing costs a layout.
const colours = new Map();
export function css(name) {
    if (!colours.has(name)) colours.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
    return colours.get(name);
}
export const forget = () => colours.clear();

export const FONT = "11px system-ui, sans-serif";

export const axis = (label, size, more = {}) => ({
    stroke: () => css("--soft"),
    grid: { stroke: () => css("--grid"), width: 1 },
    ticks: { stroke: () => css("--grid"), width: 1, size: 4 },
    font: FONT,
    labelFont: FONT,
    labelSize: 15,
    labelGap: 0,
    label,
    size,
    gap: 2,
    ...more,
});

// Numbers of an axis: short, and alike.
export const worded = (_, splits) => splits.map((value) => (value === null ? "" : String(Number(value.toPrecision(5)))));

const KINDS = [
    { name: "x1", label: "x1, m", words: "displacement of the structure", columns: ["x1"], colours: ["--blue"] },
    { name: "gap", label: "x2 − x1, m", words: "damper from the structure, with walls and contacts", columns: ["gap"], colours: ["--vermilion"] },
    { name: "E1", label: "E1, J", words: "energy of the structure, with its maximum", columns: ["E1"], colours: ["--blue"] },
    { name: "force", label: "force, N", words: "contact forces on the structure and on the obstacle", columns: ["FconL", "FconR"], colours: ["--vermilion", "--purple"] },
    { name: "forcing", label: "", words: "what moves the structure", columns: ["forcing"], colours: ["--soft"] },
];

export class Series {
    constructor(into, zoomed) {
        this.into = into;
        this.zoomed = zoomed;
        this.motion = null;
        this.spread = null;
        this.charts = [];
        this.shown = "";
        this.measure();
        new ResizeObserver(() => this.resize()).observe(into);
    }

    // Asking for the width costs a layout: it is asked for when it changes.
    measure() {
        this.wide = Math.max(200, this.into.clientWidth);
    }

    // Pixels that the curves themselves have.
    columns() {
        return Math.min(2000, Math.round((this.wide - 70) * Math.min(2, devicePixelRatio)));
    }

    build(kinds) {
        this.charts.forEach((chart) => chart.destroy());
        this.into.replaceChildren();
        this.charts = kinds.map((kind, i) => {
            const last = i === kinds.length - 1;
            const place = document.createElement("div");
            place.className = "chart";
            place.setAttribute("role", "img");
            this.into.append(place);
            const chart = new uPlot(
                {
                    width: this.wide,
                    height: this.height(last),
                    legend: { show: false },
                    cursor: { sync: { key: "time" }, drag: { setScale: false, x: true, y: false }, points: { show: false } },
                    scales: { x: { time: false }, y: { range: (u, least, largest) => this.range(kind, least, largest) } },
                    series: [{}, ...kind.columns.map((_, n) => ({ stroke: () => css(kind.colours[n]), width: 1, points: { show: false } }))],
                    axes: [axis(last ? "t, s" : null, last ? 22 : 8, last ? { values: worded } : { values: () => [] }), axis(kind.name === "forcing" ? `${this.forcing.name}, ${this.forcing.unit}` : kind.label, 50, { values: worded, space: 22 })],
                    hooks: {
                        drawAxes: [(u) => this.behind(kind, u)],
                        draw: [(u) => this.before(kind, u)],
                        setSelect: [
                            (u) => {
                                if (u.select.width < 4) return;
                                this.zoomed([u.posToVal(u.select.left, "x"), u.posToVal(u.select.left + u.select.width, "x")]);
                                u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
                            },
                        ],
                    },
                },
                [[], ...kind.columns.map(() => [])],
                place,
            );
            chart.kind = kind;
            chart.place = place;
            return chart;
        });
    }

    height(last) {
        return (innerWidth < 700 ? 104 : 118) + (last ? 26 : 0);
    }

    resize() {
        this.measure();
        const width = this.wide;
        if (!this.charts.length || width === this.charts[0].width) return;
        this.charts.forEach((chart, i) => chart.setSize({ width, height: this.height(i === this.charts.length - 1) }));
    }

    // Draws a motion. Which charts there are follows from what there is to see.
    show(motion, damper, forcing) {
        this.motion = motion;
        this.forcing = forcing;
        const kinds = KINDS.filter(({ name }) => name === "x1" || name === "E1" || (name === "forcing" && forcing) || (damper !== "none" && (name === "gap" || motion.walls)));
        const wanted = `${kinds.map((kind) => kind.name).join(" ")} ${forcing?.name} ${forcing?.unit}`;
        if (wanted !== this.shown) this.build(kinds);
        this.shown = wanted;
        for (const chart of this.charts) this.fill(chart);
        this.name();
    }

    fill(chart) {
        const { columns, span } = this.motion;
        chart.batch(() => {
            chart.setData([chart.kind.name === "forcing" ? columns["forcing.t"] : columns.t, ...chart.kind.columns.map((name) => columns[name])], false);
            chart.setScale("x", { min: span[0], max: span[1] });
        });
    }

    // The neighbours of an irregular motion; none of a regular one.
    scatter(spread) {
        if (!spread && !this.spread) return;
        this.spread = spread;
        for (const chart of this.charts) if (chart.kind.name === "E1" && this.motion) this.fill(chart);
    }

    name() {
        const { run, span } = this.motion;
        const over = `from ${span[0].toPrecision(4)} to ${span[1].toPrecision(4)} s`;
        const said = {
            x1: `largest ${run.x1max.toPrecision(4)} m`,
            gap: `${run.impacts.primary} impacts on the structure, ${run.impacts.obstacle} on the obstacle`,
            E1: `largest ${run.E1max.toPrecision(4)} J at ${run.t_E1max.toPrecision(4)} s`,
            forcing: this.forcing?.words ?? "",
            force: `largest ${run.force_max.primary.toPrecision(4)} N and ${run.force_max.obstacle.toPrecision(4)} N`,
        };
        for (const { kind, place } of this.charts) place.setAttribute("aria-label", `${kind.words} ${over}: ${said[kind.name]}`);
    }

    redraw() {
        this.charts.forEach((chart) => chart.redraw(false, true));
    }

    range(kind, least, largest) {
        if (least === null || !this.motion) return [0, 1];
        if (kind.name === "E1" || kind.name === "force") {
            const spread = kind.name === "E1" ? this.most() : 0;
            return [0, Math.max(largest, spread, 1e-12) * 1.08];
        }
        const room = Math.max(largest - least, 1e-9);
        // Walls that are near are shown.
        for (const wall of this.motion.walls && kind.name === "gap" ? this.motion.walls : []) {
            if (wall > least - 1.5 * room && wall < largest + 1.5 * room) [least, largest] = [Math.min(least, wall), Math.max(largest, wall)];
        }
        const pad = 0.07 * Math.max(largest - least, 1e-9);
        return [least - pad, largest + pad];
    }

    most() {
        let most = 0;
        if (this.spread) for (const value of this.spread.columns.largest) if (value > most && Number.isFinite(value)) most = value;
        return most;
    }

    behind(kind, u) {
        if (!this.motion) return;
        const { ctx, bbox } = u;
        ctx.save();
        ctx.beginPath();
        ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
        ctx.clip();
        if (kind.name === "gap" && this.motion.walls) {
            ctx.fillStyle = css("--wall");
            const [structure, obstacle] = this.motion.walls.map((wall) => u.valToPos(wall, "y", true));
            ctx.fillRect(bbox.left, structure, bbox.width, bbox.top + bbox.height - structure);
            ctx.fillRect(bbox.left, bbox.top, bbox.width, obstacle - bbox.top);
        }
        if (kind.name === "E1" && this.spread) {
            const { t, least, largest } = this.spread.columns;
            ctx.fillStyle = css("--spread");
            ctx.beginPath();
            const point = (i, column) => ctx.lineTo(u.valToPos(t[i], "x", true), u.valToPos(Number.isFinite(column[i]) ? column[i] : 0, "y", true));
            for (let i = 0; i < t.length; i++) point(i, largest);
            for (let i = t.length - 1; i >= 0; i--) point(i, least);
            ctx.fill();
        }
        const [t0] = this.motion.window;
        if (t0 > this.motion.span[0]) {
            const x = u.valToPos(t0, "x", true);
            ctx.fillStyle = css("--before");
            ctx.fillRect(bbox.left, bbox.top, x - bbox.left, bbox.height);
        }
        ctx.restore();
    }

    before(kind, u) {
        if (!this.motion) return;
        const { ctx } = u;
        const ratio = devicePixelRatio;
        const { span, run } = this.motion;
        ctx.save();
        ctx.font = `${11 * ratio}px system-ui, sans-serif`;
        if (kind.name === "E1" && run.t_E1max >= span[0] && run.t_E1max <= span[1]) {
            const [x, y] = [u.valToPos(run.t_E1max, "x", true), u.valToPos(run.E1max, "y", true)];
            ctx.fillStyle = css("--ink");
            ctx.beginPath();
            ctx.arc(x, y, 3 * ratio, 0, 2 * Math.PI);
            ctx.fill();
            const left = x < u.bbox.left + u.bbox.width / 2;
            ctx.textAlign = left ? "left" : "right";
            ctx.lineWidth = 3 * ratio;
            ctx.strokeStyle = css("--card");
            const words = `${run.E1max.toPrecision(4)} J`;
            ctx.strokeText(words, x + (left ? 7 : -7) * ratio, y + 3 * ratio);
            ctx.fillText(words, x + (left ? 7 : -7) * ratio, y + 3 * ratio);
        }
        if (kind.name === "gap" && this.motion.walls) {
            const contacts = this.motion.columns.contacts;
            ctx.fillStyle = css("--ink");
            for (let i = 0; i < contacts.length; i += 2) {
                ctx.beginPath();
                ctx.arc(u.valToPos(contacts[i], "x", true), u.valToPos(contacts[i + 1], "y", true), 2 * ratio, 0, 2 * Math.PI);
                ctx.fill();
            }
        }
        ctx.restore();
    }
}
