// The system, drawn and moving: the structure on its spring and dashpot, the damper in its cavity, the force. Lengths along the motion
// are all to one scale.

import { css } from "./charts.js";

export class Drawing {
    constructor(canvas) {
        this.canvas = canvas;
        this.speed = 1;
        this.paused = matchMedia("(prefers-reduced-motion: reduce)").matches;
        this.time = 0;
        this.last = 0;
        this.motion = null;
        this.frame = this.frame.bind(this);
        new ResizeObserver(() => this.draw()).observe(canvas);
        document.addEventListener("visibilitychange", () => this.wake());
        this.asked = false;
    }

    show(motion, { damper, P }) {
        this.motion = motion;
        this.damper = damper;
        this.force = P;
        const { columns } = motion;
        const t = columns["drawn.t"];
        this.from = t[0];
        this.length = t[t.length - 1] - t[0];
        let [reach, least, largest] = [1e-9, Infinity, -Infinity];
        for (const x of columns["drawn.x1"]) reach = Math.max(reach, Math.abs(x));
        for (const x of columns["drawn.x"]) [least, largest] = [Math.min(least, x), Math.max(largest, x)];
        this.reach = reach;
        this.ends = [least, largest];
        if (this.paused) this.draw();
        this.wake();
    }

    pause(paused) {
        this.paused = paused;
        this.wake();
    }

    wake() {
        if (this.asked || this.paused || document.hidden || !this.motion) return;
        this.asked = true;
        this.last = 0;
        requestAnimationFrame(this.frame);
    }

    frame(now) {
        if (this.paused || document.hidden) {
            this.asked = false;
            return;
        }
        if (this.last) this.time += (Math.min(100, now - this.last) / 1000) * this.speed;
        this.last = now;
        this.draw();
        requestAnimationFrame(this.frame);
    }

    // The state now: [x1, x2 - x1], between two rows.
    state() {
        const { columns } = this.motion;
        const t = columns["drawn.t"];
        const at = ((this.time % this.length) / this.length) * (t.length - 1);
        const i = Math.min(Math.floor(at), t.length - 2);
        const between = (column) => column[i] + (at - i) * (column[i + 1] - column[i]);
        return [between(columns["drawn.x1"]), between(columns["drawn.x"]), this.from + (this.time % this.length)];
    }

    draw() {
        if (!this.motion || !this.length) return;
        const ratio = devicePixelRatio;
        const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
        if (this.canvas.width !== Math.round(width * ratio)) this.canvas.width = Math.round(width * ratio);
        if (this.canvas.height !== Math.round(height * ratio)) this.canvas.height = Math.round(height * ratio);
        const ctx = this.canvas.getContext("2d");
        ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
        ctx.clearRect(0, 0, width, height);
        const [x1, x, t] = this.state();
        const walls = this.motion.walls;
        const damped = this.damper !== "none";
        const [least, largest] = damped ? this.ends : [0, 0];
        // Walls that are far away are cut off.
        const room = Math.max(largest - least, 1e-9);
        const obstacle = walls && walls[1] < largest + 2 * room ? walls[1] : null;
        const left = damped ? Math.min(0, least) : 0;
        const right = damped ? Math.max(largest, obstacle ?? largest) : 0;
        const spring = Math.max(60, 0.16 * width);
        const block = Math.min(84, 0.15 * width);
        const mass = Math.min(46, 0.09 * width);
        const scale = (width - 24 - spring - block - (damped ? mass + 34 : 10)) / (2 * this.reach + right - left);
        const floor = Math.min(height - 26, height / 2 + 58);
        const ink = css("--ink");
        ctx.strokeStyle = ctx.fillStyle = ink;
        ctx.lineWidth = 1.25;
        // The ground.
        ctx.fillStyle = css("--wall");
        ctx.fillRect(0, floor - 92, 10, 92);
        ctx.fillRect(0, floor, width, 8);
        ctx.fillStyle = ink;
        const rest = 10 + spring + scale * this.reach;
        const at = rest + scale * x1;
        const high = 78;
        coil(ctx, 10, at, floor - 60, 9, 7);
        dashpot(ctx, 10, at, floor - 22);
        // The structure, with the tray that carries the obstacle.
        ctx.fillStyle = css("--blue");
        ctx.fillRect(at, floor - high, block, high - 6);
        const face = at + block;
        const place = (x) => face + scale * (x - left);
        ctx.fillStyle = css("--card");
        ctx.font = "600 12px system-ui, sans-serif";
        ctx.textAlign = "center";
        ctx.fillText("m1", at + block / 2, floor - high / 2);
        if (damped) {
            // x2 - x1 = 0 is the face of the structure for the near side of the damper; D + C the obstacle for its far side.
            const near = place(x);
            const end = obstacle === null ? place(right) + mass + 12 : place(obstacle) + mass;
            ctx.fillStyle = css("--blue");
            ctx.fillRect(face - 1, floor - 12, end - face + (obstacle === null ? 0 : 8), 6);
            if (obstacle !== null) ctx.fillRect(end, floor - high + 12, 8, high - 18);
            ctx.strokeStyle = ink;
            coil(ctx, face, near, floor - 52, 6, 6);
            dashpot(ctx, face, near, floor - 26);
            const hit = walls && (x <= 0 || x >= walls[1]);
            ctx.fillStyle = css("--vermilion");
            ctx.beginPath();
            ctx.roundRect(near, floor - 62, mass, 48, 5);
            ctx.fill();
            ctx.fillStyle = css("--card");
            ctx.fillText("m2", near + mass / 2, floor - 34);
            if (hit) {
                const side = x <= 0 ? near : near + mass;
                ctx.strokeStyle = css("--ink");
                ctx.lineWidth = 2;
                for (const angle of [-0.9, -0.45, 0, 0.45, 0.9]) {
                    ctx.beginPath();
                    ctx.moveTo(side + 5 * Math.sin(angle), floor - 64 - 5 * Math.cos(angle));
                    ctx.lineTo(side + 13 * Math.sin(angle), floor - 64 - 13 * Math.cos(angle));
                    ctx.stroke();
                }
            }
        }
        this.arrow(ctx, at + block / 2, floor - high - 12, t, ink);
        ctx.fillStyle = css("--soft");
        ctx.font = "11px system-ui, sans-serif";
        ctx.textAlign = "left";
        ctx.fillText(`t = ${t.toFixed(2)} s`, 14, 14);
        this.bar(ctx, width, scale);
    }

    // P cos ωt.
    arrow(ctx, x, y, t, ink) {
        const { forcing } = this.motion.run.parameters;
        const size = this.force ? 34 * Math.cos(forcing.omega * t) : 0;
        if (Math.abs(size) < 2) return;
        ctx.strokeStyle = ctx.fillStyle = ink;
        ctx.lineWidth = 1.5;
        ctx.beginPath();
        ctx.moveTo(x, y);
        ctx.lineTo(x + size, y);
        ctx.stroke();
        const tip = Math.sign(size) * Math.min(6, Math.abs(size));
        ctx.beginPath();
        ctx.moveTo(x + size, y);
        ctx.lineTo(x + size - tip, y - 3.5);
        ctx.lineTo(x + size - tip, y + 3.5);
        ctx.fill();
    }

    // A length to compare with.
    bar(ctx, width, scale) {
        const power = 10 ** Math.floor(Math.log10(90 / scale));
        const length = [5, 2, 1].map((n) => n * power).find((length) => length * scale <= 90) ?? power;
        ctx.strokeStyle = css("--soft");
        ctx.lineWidth = 1;
        ctx.beginPath();
        ctx.moveTo(width - 12 - length * scale, 18);
        ctx.lineTo(width - 12, 18);
        ctx.stroke();
        ctx.textAlign = "right";
        ctx.fillText(`${Number(length.toPrecision(2))} m`, width - 12, 13);
    }
}

function coil(ctx, from, to, y, turns, size) {
    const step = (to - from) / (turns + 1);
    ctx.lineWidth = 1.25;
    ctx.beginPath();
    ctx.moveTo(from, y);
    ctx.lineTo(from + step / 2, y);
    for (let i = 0; i < turns; i++) ctx.lineTo(from + step * (i + 1), y + (i % 2 ? -size : size));
    ctx.lineTo(to - step / 2, y);
    ctx.lineTo(to, y);
    ctx.stroke();
}

function dashpot(ctx, from, to, y) {
    const middle = (from + to) / 2;
    const half = Math.max(4, Math.min(14, Math.abs(to - from) / 5));
    ctx.lineWidth = 1.25;
    ctx.beginPath();
    ctx.moveTo(from, y);
    ctx.lineTo(middle - half, y);
    ctx.moveTo(middle + half, y - 6);
    ctx.lineTo(middle - half, y - 6);
    ctx.lineTo(middle - half, y + 6);
    ctx.lineTo(middle + half, y + 6);
    ctx.moveTo(middle + half / 3, y - 5);
    ctx.lineTo(middle + half / 3, y + 5);
    ctx.moveTo(middle + half / 3, y);
    ctx.lineTo(to, y);
    ctx.stroke();
}
