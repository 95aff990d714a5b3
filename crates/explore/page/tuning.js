// Tune from here: the map of what is made small, the path of the simplex over it, and the log.

import { FONT, css } from "./charts.js";
import { ticks } from "./phase.js";

// Viridis at eighths (S. van der Walt and N. Smith, matplotlib, 2015, CC0), as in all maps of Retune.
const VIRIDIS = ["#440154", "#472C7A", "#3B518B", "#2C718E", "#21908D", "#27AD81", "#5CC863", "#AADC32", "#FDE725"];
const channels = VIRIDIS.map((colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16)));

export function viridis(share) {
    const at = Math.min(1, Math.max(0, share)) * (channels.length - 1);
    const i = Math.min(Math.floor(at), channels.length - 2);
    return `rgb(${channels[i].map((low, c) => Math.round(low + (at - i) * (channels[i + 1][c] - low))).join(" ")})`;
}

export class Tuning {
    constructor({ section, canvas, words, log, result }) {
        Object.assign(this, { section, canvas, words, log, result });
        this.running = false;
        new ResizeObserver(() => this.draw()).observe(canvas);
    }

    begin(answer) {
        this.running = true;
        this.section.hidden = false;
        this.axes = answer.x ? { x: { ...answer.x, values: answer.columns.x }, y: { ...answer.y, values: answer.columns.y } } : null;
        this.rows = [];
        this.path = [];
        this.lines = [answer.header];
        this.log.textContent = answer.header;
        this.result.textContent = "";
        this.canvas.parentElement.hidden = !this.axes;
        const at = answer.at ? ` at ${answer.at}` : "";
        this.words.textContent = this.axes ? `What is made small over ${answer.variables[0]} and ${answer.variables[1]}${at}: dark is small. The path is that of the best vertex.` : "";
        this.draw();
        const smooth = matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth";
        this.section.scrollIntoView({ block: "nearest", behavior: smooth });
    }

    map(answer) {
        this.rows[answer.row] = answer.columns.value;
        this.later();
    }

    row(answer) {
        this.path.push(answer.best);
        this.lines.push(answer.text);
        this.later();
    }

    later() {
        if (this.asked) return;
        this.asked = true;
        requestAnimationFrame(() => {
            this.asked = false;
            const atEnd = this.log.scrollTop + this.log.clientHeight > this.log.scrollHeight - 30;
            this.log.textContent = this.lines.join("\n");
            if (atEnd) this.log.scrollTop = this.log.scrollHeight;
            this.draw();
        });
    }

    end(answer) {
        this.running = false;
        this.result.textContent = `${answer.stop[0].toUpperCase()}${answer.stop.slice(1)}: ${answer.worth} ${answer.unit} after ${answer.iterations} iterations, ${answer.evaluations} evaluations. The sliders stand there.`;
    }

    draw() {
        const { canvas, axes } = this;
        const [width, height] = [canvas.clientWidth, canvas.clientHeight];
        if (!axes || !width) return;
        const ratio = devicePixelRatio;
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
        const ctx = canvas.getContext("2d");
        ctx.scale(ratio, ratio);
        const [left, right, top, bottom] = [56, 10, 8, 36];
        const on = (axis, from, to) => {
            const [first, last] = [axis.values[0], axis.values[axis.values.length - 1]];
            const share = (value) => (axis.log ? Math.log(value / first) / Math.log(last / first) : (value - first) / (last - first));
            const half = 0.5 / (axis.values.length - 1);
            return (value) => from + ((share(value) + half) / (1 + 2 * half)) * (to - from);
        };
        const [x, y] = [on(axes.x, left, width - right), on(axes.y, height - bottom, top)];
        const all = this.rows.flatMap((row) => [...row]).filter((value) => Number.isFinite(value) && value > 0);
        const [least, largest] = [Math.min(...all), Math.max(...all)];
        const [wide, tall] = [(width - left - right) / axes.x.values.length, (height - top - bottom) / axes.y.values.length];
        ctx.fillStyle = css("--wall");
        ctx.fillRect(left, top, width - left - right, height - top - bottom);
        this.rows.forEach((row, j) =>
            row.forEach((value, i) => {
                if (!Number.isFinite(value)) return;
                ctx.fillStyle = viridis(Math.log(value / least) / Math.max(1e-9, Math.log(largest / least)));
                ctx.fillRect(x(axes.x.values[i]) - wide / 2, y(axes.y.values[j]) - tall / 2, wide + 0.5, tall + 0.5);
            }),
        );
        ctx.save();
        ctx.beginPath();
        ctx.rect(left, top, width - left - right, height - top - bottom);
        ctx.clip();
        for (const [colour, wide] of [["#000", 3.5], ["#fff", 1.6]]) {
            ctx.strokeStyle = colour;
            ctx.lineWidth = wide;
            ctx.beginPath();
            for (const best of this.path) ctx.lineTo(x(best[0]), y(best[1]));
            ctx.stroke();
        }
        this.path.forEach((best, i) => {
            const last = i === this.path.length - 1;
            ctx.beginPath();
            ctx.arc(x(best[0]), y(best[1]), last ? 5 : 2.2, 0, 2 * Math.PI);
            ctx.fillStyle = "#fff";
            ctx.fill();
            ctx.lineWidth = last ? 2 : 0.7;
            ctx.strokeStyle = "#000";
            ctx.stroke();
        });
        ctx.restore();
        ctx.font = FONT;
        ctx.fillStyle = css("--soft");
        ctx.textAlign = "center";
        for (const value of marks(axes.x, width / 70)) ctx.fillText(String(value), x(value), height - bottom + 14);
        ctx.fillText(axes.x.label, (left + width - right) / 2, height - 5);
        ctx.textAlign = "right";
        for (const value of marks(axes.y, height / 40)) ctx.fillText(String(value), left - 5, y(value) + 4);
        ctx.translate(11, (top + height - bottom) / 2);
        ctx.rotate(-Math.PI / 2);
        ctx.textAlign = "center";
        ctx.fillText(axes.y.label, 0, 0);
    }
}

function marks({ values, log }, count) {
    const ends = [values[0], values[values.length - 1]];
    if (!log) return ticks(ends, count);
    const found = [];
    for (let power = Math.floor(Math.log10(ends[0])); power <= Math.log10(ends[1]); power++) {
        for (const n of [1, 2, 5]) found.push(Number((n * 10 ** power).toPrecision(6)));
    }
    return found.filter((value) => value >= ends[0] && value <= ends[1]);
}
