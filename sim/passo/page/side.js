// SPDX-License-Identifier: MIT
// Beside the charts over time: the histogram of the timing error, and the tool path.
"use strict";

const BINS = 61;
const PATH_POINTS = 20000;
const SPEED_SAMPLES = 4000, SPEED_WINDOW = 0.004;  // seconds
// From slow to fast, of even lightness in between, also for the color-blind.
const SPEED_COLORS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];

function speedColor(share) {
    const place = Math.min(0.9999, Math.max(0, share)) * (SPEED_COLORS.length - 1), n = Math.floor(place);
    const mixed = SPEED_COLORS[n].map((value, i) => Math.round(value + (SPEED_COLORS[n + 1][i] - value) * (place - n)));
    return `rgb(${mixed.join(",")})`;
}

class Histogram {
    constructor(parent, view, errors) {
        Object.assign(this, { view, errors });
        const panel = element(parent, "section", "panel");
        panel.id = "histogram";
        const head = element(panel, "header");
        element(head, "h2", "", "Timing error, histogram");
        this.note = element(head, "span", "note");
        this.body = element(panel, "div", "chart");
        this.plot = null;
        new ResizeObserver(() => this.plot?.setSize(this.size)).observe(this.body);
        view.listeners.push(this);
    }

    get size() { return { width: Math.max(240, this.body.clientWidth), height: 280 }; }

    // Counts of the visible steps of each axis.
    counts() {
        const { view, errors: { way } } = this, shown = view.axes.map(([axis, n]) => {
            const values = way.values(axis)[0];
            return [n, values.subarray(lower(axis.rises, view.min), lower(axis.rises, view.max))];
        });
        let largest = 0, total = 0;
        for (const [, values] of shown) {
            for (const value of values) {
                if (Math.abs(value) > largest) largest = Math.abs(value);
                total += value === value;
            }
        }
        largest ||= 1 / way.factor;
        const bins = view.motion.axes.map(() => new Array(BINS).fill(null));
        for (const [n, values] of shown) {
            bins[n].fill(0);
            for (const value of values) {
                if (value === value) bins[n][Math.min(BINS - 1, Math.floor((value / largest + 1) / 2 * BINS))]++;
            }
        }
        const centers = Array.from({ length: BINS }, (_, k) => ((2 * k + 1) / BINS - 1) * largest * way.factor);
        return { centers, bins, largest: largest * way.factor, total };
    }

    update() {
        const { centers, bins, largest, total } = this.counts();
        const unit = this.errors.way.unit;
        this.found = { largest, total };
        this.note.textContent = `${grouped(total)} steps in view, at most ${plain(largest, 3)} ${unit}`;
        const share = bins.map(own => own.map(count => (count === null ? null : 100 * count / Math.max(1, total))));
        const line = { stroke: () => styleOf("--faint"), font: "11px system-ui", labelFont: "11px system-ui", labelSize: 16, labelGap: 0,
            ticks: { stroke: () => styleOf("--grid"), width: 1 }, grid: { stroke: () => styleOf("--grid"), width: 1 } };
        this.plot?.destroy();
        this.plot = new uPlot({
            ...this.size, padding: [8, 14, 0, 0], legend: { show: false }, cursor: { show: false },
            scales: { x: { time: false, range: () => [-1.02 * largest, 1.02 * largest] }, y: { range: (_, __, most) => [0, 1.08 * most || 1] } },
            axes: [
                { ...line, size: 26, label: unit, values: (_, splits) => splits.map(value => plain(value)) },
                { ...line, size: 60, label: "% of the steps", values: (_, splits) => splits.map(value => plain(value)) },
            ],
            series: [{}, ...bins.map((_, n) => ({
                stroke: () => colorOf(n), fill: () => colorOf(n) + "38", width: 1.5, points: { show: false },
                paths: uPlot.paths.bars({ size: [1], gap: 0 }),
            }))],
        }, [centers, ...share], this.body);
    }
}

class ToolPath {
    constructor(parent, view) {
        this.view = view;
        const panel = element(parent, "section", "panel");
        panel.id = "path";
        const head = element(panel, "header");
        element(head, "h2", "", "Tool path");
        this.note = element(head, "span", "note");
        const choose = (label, value) => {
            const box = element(head, "label", "note", label), list = element(box, "select");
            view.motion.axes.forEach((axis, n) => { element(list, "option", "", axis.name).value = n; });
            list.value = value;
            list.onchange = () => this.update();
            return list;
        };
        this.across = choose("across ", 0);
        this.up = choose("up ", 1);
        this.canvas = element(panel, "canvas", "path");
        new ResizeObserver(() => this.update()).observe(panel);
        view.listeners.push(this);
    }

    // Positions at the steps of both axes between two clocks; of many, every k-th, and those where moves meet.
    points(min, max) {
        const axes = [this.across, this.up].map(list => this.view.motion.axes[list.value]);
        const ranges = axes.map(axis => [lower(axis.rises, min), lower(axis.rises, max)]);
        const every = Math.max(1, Math.ceil((ranges[0][1] - ranges[0][0] + ranges[1][1] - ranges[1][0]) / PATH_POINTS));
        const clocks = [min, max];
        axes.forEach((axis, n) => {
            for (let i = ranges[n][0]; i < ranges[n][1]; i += every) clocks.push(axis.rises[i]);
            clocks.push(...axis.begins.filter(clock => clock > min && clock < max));
        });
        clocks.sort((a, b) => a - b);
        return { every, points: clocks.map(clock => axes.map(axis => axis.position(clock) * axis.per_step)) };
    }

    // Places at even times, [across, up] each, and the speed there: mean over a window, in units per second.
    sampled() {
        const { motion, limits: [min, max] } = this.view, axes = [this.across, this.up].map(list => motion.axes[list.value]);
        const count = SPEED_SAMPLES, step = (max - min) / (count - 1);
        const width = Math.max(1, Math.round(SPEED_WINDOW * motion.hz / step / 2));
        const points = Array.from({ length: count }, (_, i) => axes.map(axis => axis.position(min + i * step) * axis.per_step));
        const speeds = points.map((_, i) => {
            const [from, to] = [Math.max(0, i - width), Math.min(count - 1, i + width)];
            return Math.hypot(points[to][0] - points[from][0], points[to][1] - points[from][1]) * motion.hz / (step * (to - from));
        });
        return { points, speeds, fastest: Math.max(...speeds) };
    }

    // A scale of the colors, with its ends.
    drawScale(ctx, fastest, unit, right) {
        const width = 90, left = right - width;
        for (let i = 0; i < width; i++) {
            ctx.fillStyle = speedColor(i / width);
            ctx.fillRect(left + i, 6, 1.5, 7);
        }
        ctx.fillStyle = styleOf("--faint");
        ctx.textAlign = "right";
        ctx.fillText("0", left - 5, 13);
        ctx.textAlign = "left";
        ctx.fillText(`${plain(fastest, 3)} ${unit}/s`, right + 5, 13);
    }

    update() {
        const canvas = this.canvas, ratio = devicePixelRatio, width = canvas.clientWidth, height = 280;
        [canvas.width, canvas.height] = [width * ratio, height * ratio];
        const ctx = canvas.getContext("2d"), view = this.view;
        const whole = this.whole?.[0] === this.across.value + this.up.value ? this.whole[1] : this.points(...view.limits).points;
        this.whole = [this.across.value + this.up.value, whole];
        const part = view.isAll ? null : this.points(view.min, view.max);
        const range = n => whole.reduce(([low, high], point) => [Math.min(low, point[n]), Math.max(high, point[n])], [Infinity, -Infinity]);
        const [[left, right], [low, high]] = [range(0), range(1)];
        // The same scale both ways, so that a circle is round.
        const edge = { left: 64, right: 16, top: 24, bottom: 40 };
        const scale = Math.min((width - edge.left - edge.right) / (right - left || 1), (height - edge.top - edge.bottom) / (high - low || 1));
        const middle = [(width + edge.left - edge.right) / 2, (height + edge.top - edge.bottom) / 2];
        const x = value => middle[0] + (value - (left + right) / 2) * scale, y = value => middle[1] - (value - (low + high) / 2) * scale;
        ctx.scale(ratio, ratio);
        ctx.font = "11px system-ui";
        ctx.fillStyle = styleOf("--faint");
        ctx.textAlign = "center";
        for (const value of new Set([left, right])) ctx.fillText(plain(value, 7), x(value), height - 20);
        const { motion } = view, unit = axis => motion.axes[axis].motion.unit;
        ctx.fillText(`axis ${motion.axes[this.across.value].name}, ${unit(this.across.value)}`, middle[0], height - 5);
        ctx.textAlign = "right";
        for (const value of new Set([low, high])) ctx.fillText(plain(value, 7), x(left) - 8, y(value) + 4);
        const draw = (points, color, thick) => {
            ctx.strokeStyle = color;
            ctx.lineWidth = thick;
            ctx.lineJoin = "round";
            ctx.beginPath();
            for (const point of points) ctx.lineTo(x(point[0]), y(point[1]));
            ctx.stroke();
        };
        const sameUnit = unit(this.across.value) === unit(this.up.value);
        this.speeds = null;
        if (part || !sameUnit) {
            draw(whole, part ? styleOf("--event") : colorOf(0), 1.5);
            if (part) draw(part.points, colorOf(0), 2.5);
        } else {
            const { points, speeds, fastest } = this.speeds = this.sampled();
            for (let i = 0; i + 1 < points.length; i++) draw(points.slice(i, i + 2), speedColor(speeds[i] / fastest), 2);
            this.drawScale(ctx, fastest, unit(this.across.value), width - 90);
        }
        const every = part?.every ?? 1;
        this.note.textContent = every > 1 ? `every ${grouped(every)}th step drawn` : part ? "what is in view is drawn strong" : sameUnit ? "colored by the speed along it" : "";
        const [first, last] = [whole[0], whole[whole.length - 1]];
        for (const [point, color] of [[first, styleOf("--good")], [last, styleOf("--bad")]]) {
            ctx.fillStyle = color;
            ctx.beginPath();
            ctx.arc(x(point[0]), y(point[1]), 4, 0, 7);
            ctx.fill();
        }
    }
}
