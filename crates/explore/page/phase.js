// A phase portrait: the last periods as a line, and the state once a period of the force as points.

import { FONT, css } from "./charts.js";

export class Phase {
    constructor(canvas, names, colour) {
        this.canvas = canvas;
        this.names = names;
        this.colour = colour;
        this.line = this.points = null;
        new ResizeObserver(() => this.draw()).observe(canvas);
    }

    show(line, points, walls = null) {
        this.line = line;
        if (points) this.points = points;
        this.walls = walls;
        this.draw();
    }

    draw() {
        if (!this.line) return;
        const { canvas } = this;
        const ratio = devicePixelRatio;
        const [width, height] = [canvas.clientWidth, canvas.clientHeight];
        if (!width || !height) return;
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
        const ctx = canvas.getContext("2d");
        ctx.scale(ratio, ratio);
        const [left, right, top, bottom] = [46, 8, 6, 18];
        const ends = [0, 1].map((axis) => {
            let [least, largest] = [Infinity, -Infinity];
            for (const column of [this.line[axis], this.points?.[axis] ?? []]) {
                for (const value of column) [least, largest] = [Math.min(least, value), Math.max(largest, value)];
            }
            const room = Math.max(largest - least, 1e-12);
            return [least - 0.06 * room, largest + 0.06 * room];
        });
        const x = (value) => left + ((value - ends[0][0]) / (ends[0][1] - ends[0][0])) * (width - left - right);
        const y = (value) => height - bottom - ((value - ends[1][0]) / (ends[1][1] - ends[1][0])) * (height - top - bottom);
        ctx.font = FONT;
        ctx.fillStyle = css("--soft");
        ctx.strokeStyle = css("--grid");
        ctx.lineWidth = 1;
        for (const value of ticks(ends[0], Math.max(2, width / 80))) {
            line(ctx, x(value), top, x(value), height - bottom);
            const half = ctx.measureText(String(value)).width / 2;
            ctx.textAlign = "center";
            ctx.fillText(String(value), Math.min(x(value), width - half), height - 4);
        }
        for (const value of ticks(ends[1], height / 45)) {
            line(ctx, left, y(value), width - right, y(value));
            ctx.textAlign = "right";
            ctx.fillText(String(value), left - 5, y(value) + 4);
        }
        ctx.fillStyle = css("--wall");
        for (const [i, wall] of (this.walls ?? []).entries()) {
            const at = Math.min(width - right, Math.max(left, x(wall)));
            ctx.fillRect(i ? at : left, top, i ? width - right - at : at - left, height - top - bottom);
        }
        ctx.strokeStyle = css(this.colour);
        ctx.lineWidth = 1;
        ctx.globalAlpha = 0.75;
        ctx.beginPath();
        for (let i = 0; i < this.line[0].length; i++) ctx.lineTo(x(this.line[0][i]), y(this.line[1][i]));
        ctx.stroke();
        ctx.globalAlpha = 1;
        ctx.fillStyle = css("--ink");
        // Squares: many are drawn at every step of a drag.
        const [across, along] = this.points ?? [[], []];
        const size = across.length > 100 ? 2.4 : 4;
        for (let i = 0; i < across.length; i++) ctx.fillRect(x(across[i]) - size / 2, y(along[i]) - size / 2, size, size);
    }
}

function line(ctx, a, b, c, d) {
    ctx.beginPath();
    ctx.moveTo(a, b);
    ctx.lineTo(c, d);
    ctx.stroke();
}

// Round numbers between two ends, about so many.
export function ticks([from, to], count) {
    const raw = (to - from) / Math.max(1, count);
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((n) => n * power).find((step) => step >= raw);
    const found = [];
    for (let i = Math.ceil(from / step); i * step <= to; i++) found.push(Number((i * step).toPrecision(10)));
    return found;
}
