// SPDX-License-Identifier: MIT
// The visible range, and the charts over time: position, speed, acceleration, error.
"use strict";

const COLORS = {
    light: ["#0072b2", "#d55e00", "#009e73", "#c0559a", "#b57f00", "#2f9bd6", "#7b5ea7", "#555555"],
    dark: ["#58a6ff", "#ff8f4d", "#3fd69b", "#f191c9", "#f0b429", "#84d3ff", "#b79df2", "#a8b0ba"],
};
const theme = () => document.documentElement.dataset.theme;
const colorOf = index => COLORS[theme()][index % 8];
const styleOf = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const CLOCKS_MIN = 8;
const FRAME = 25;  // ms that a short frame takes
const MARGIN = 0.015;  // beside the motion, when all of it is shown

function element(parent, tag, name = "", text = "") {
    const made = document.createElement(tag);
    made.className = name;
    made.textContent = text;
    parent.append(made);
    return made;
}

// What is visible: a range of clocks, and the axes that are not hidden.
class View {
    constructor(motion) {
        this.motion = motion;
        this.hidden = new Set();
        this.listeners = [];
        this.pointed = [];  // called when the pointer moves
        this.pointer = null;  // its clock
        this.peers = [this];  // views that show the same time
        this.charts = [];
        this.due = [];
        this.whole = [0, motion.clocks];
        this.limit(motion.clocks);
    }

    limit(clocks) {
        this.limits = [-MARGIN * clocks - CLOCKS_MIN, (1 + MARGIN) * clocks + CLOCKS_MIN];
        [this.min, this.max] = this.limits;
    }

    // Views that show the same time.
    static join(views) {
        for (const view of views) {
            view.peers = views;
            view.limit(Math.max(...views.map(({ motion }) => motion.clocks)));
        }
    }

    get axes() { return this.motion.axes.map((axis, n) => [axis, n]).filter(([, n]) => !this.hidden.has(n)); }
    get isAll() { return this.min <= this.limits[0] && this.max >= this.limits[1]; }

    set(min, max) {
        const [first, last] = this.limits, length = Math.min(last - first, Math.max(CLOCKS_MIN, max - min));
        const begin = Math.max(first, Math.min(last - length, (min + max - length) / 2));
        for (const view of this.peers) {
            [view.min, view.max] = [begin, begin + length];
            view.changed();
        }
    }

    // The way of the tool in what is shown.
    get course() {
        const min = Math.max(0, this.min), max = Math.min(this.motion.clocks, this.max);
        if (this._course?.min !== min || this._max !== max) [this._course, this._max] = [new Course(this.motion, min, Math.max(max, min + 1)), max];
        return this._course;
    }

    // Moves the pointer of all charts.
    point(clock) {
        this.pointer = clock;
        for (const { plot } of this.charts) plot.setCursor({ left: plot.valToPos(clock, "x"), top: 1 }, true, false);
        for (const listener of this.pointed) listener();
    }

    all() { this.set(...this.limits); }

    zoom(factor, center = (this.min + this.max) / 2) {
        this.set(center - (center - this.min) * factor, center + (this.max - center) * factor);
    }

    pan(part) {
        const shift = part * (this.max - this.min);
        this.set(this.min + shift, this.max + shift);
    }

    toggle(n) {
        for (const view of this.peers) {
            if (!view.hidden.delete(n)) view.hidden.add(n);
            view.changed();
        }
    }

    // Draws everything again, over as many frames as it takes: a browser paints what was drawn at the end of each. What
    // update() returns draws on at each next().
    changed() {
        this.due = [];
        [...this.charts, ...this.listeners].forEach(listener => this.redraw(listener));
    }

    redraw(listener) {
        this.due.push({ next: () => this.begin(listener) });
        this.pace = 1;
        this.waiting ||= requestAnimationFrame(now => this.draw(now));
    }

    begin(listener) {
        const rest = listener.update();
        if (rest?.next) this.due.push(rest);
        return { done: true };
    }

    // Twice as many steps as in a frame before that was short, one after a long one.
    draw(now, before = now) {
        this.pace = now - before > FRAME ? 1 : 2 * this.pace;
        for (let n = 0; n < this.pace && this.due.length; n++) {
            const step = this.due.shift();
            if (!step.next().done) this.due.unshift(step);
        }
        this.waiting = this.due.length ? requestAnimationFrame(next => this.draw(next, now)) : 0;
    }

    // Whether all is drawn.
    get isDrawn() { return !this.waiting; }

    close() {
        this.due = [];
        for (const chart of this.charts) chart.plot.destroy();
    }
}

// A chart over time. `spec`: title, height, unit, decimals of values;
//   ideal(axis, clock)   value of the wide line, or absent
//   draw(chart, scale)   draws what was measured, and returns the most steps in a column
//   range()              smallest and largest measured value in view
//   read(axis, clock)    text at the cursor
class TimeChart {
    constructor(parent, view, spec) {
        Object.assign(this, { view, spec });
        const panel = element(parent, "section", "panel");
        panel.id = spec.id;
        const head = element(panel, "header");
        element(head, "h2", "", spec.title);
        this.note = element(head, "span", "note");
        this.readout = element(head, "span", "readout");
        spec.controls?.(head, () => this.update());
        this.body = element(panel, "div", "chart");
        this.bounds = [0, 1];
        this.plot = new uPlot(this.options(), [[view.min, view.max], ...view.motion.axes.map(() => [null, null])], this.body);
        this.mouse();
        this.touch();
        new ResizeObserver(() => this.resize()).observe(this.body);
        view.charts.push(this);
    }

    get width() { return Math.max(280, this.body.clientWidth); }
    get hz() { return this.view.motion.hz; }

    options() {
        const { view, spec } = this;
        const line = { stroke: () => styleOf("--faint"), font: "11px system-ui", ticks: { stroke: () => styleOf("--grid"), width: 1 },
            grid: { stroke: () => styleOf("--grid"), width: 1 }, labelFont: "11px system-ui", labelSize: 16, labelGap: 0 };
        const ticks = () => timeTicks(view.min, view.max, this.hz, this.width / 90);
        return {
            width: this.width, height: spec.height, padding: [8, 14, 0, 0], legend: { show: false },
            scales: { x: { time: false, range: () => [view.min, view.max] }, y: { range: () => this.bounds } },
            axes: [
                { ...line, size: 26, splits: () => ticks().ticks, values: () => ticks().texts, label: () => ticks().label },
                { ...line, size: 72, label: spec.unit ?? " ", values: (_, splits) => splits.map(value => plain(value)), ...spec.yAxis },
            ],
            series: [{}, ...view.motion.axes.map((_, n) => ({
                stroke: () => colorOf(n) + (spec.draw ? "48" : ""), width: spec.draw ? 5 : 1.5, pxAlign: 0, points: { show: false },
            }))],
            cursor: {
                y: false, points: { show: false }, drag: { x: true, y: false, setScale: false },
                sync: { key: "clocks", scales: ["x", null] },
            },
            hooks: {
                drawClear: [chart => clipped(chart, (ctx, scale) => spec.drawBehind?.(ctx, scale))],
                draw: [chart => clipped(chart, (ctx, scale) => this.draw(ctx, scale))],
                setSelect: [chart => this.selected(chart)],
                setCursor: [chart => this.hover(chart)],
            },
        };
    }

    selected(chart) {
        const { left, width } = chart.select;
        if (width < 4) return;
        const [min, max] = [left, left + width].map(place => chart.posToVal(place, "x"));
        chart.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        this.view.set(min, max);
    }

    mouse() {
        const over = this.plot.over, view = this.view;
        over.addEventListener("dblclick", () => view.all());
        over.addEventListener("wheel", event => {
            if (!(event.ctrlKey || event.shiftKey || event.metaKey)) return;
            event.preventDefault();
            const turned = event.deltaY || event.deltaX;
            view.zoom(1.0015 ** turned, this.plot.posToVal(event.offsetX, "x"));
        }, { passive: false });
        over.addEventListener("mousedown", event => {
            if (!event.shiftKey && event.button !== 1) return;
            event.preventDefault();
            event.stopImmediatePropagation();
            const [min, max, from] = [view.min, view.max, event.clientX];
            const move = ({ clientX }) => {
                const shift = (from - clientX) / over.clientWidth * (max - min);
                view.set(min + shift, max + shift);
            };
            addEventListener("mousemove", move);
            addEventListener("mouseup", () => removeEventListener("mousemove", move), { once: true });
        }, { capture: true });
    }

    // One finger moves, two zoom; up and down scrolls the page.
    touch() {
        const over = this.plot.over, view = this.view, fingers = new Map();
        over.style.touchAction = "pan-y";
        const placed = () => [...fingers.values()].map(x => x - over.getBoundingClientRect().left).sort((a, b) => a - b);
        const lift = ({ pointerId }) => fingers.delete(pointerId);
        over.addEventListener("pointerdown", ({ pointerType, pointerId, clientX }) => pointerType === "touch" && fingers.set(pointerId, clientX));
        over.addEventListener("pointermove", ({ pointerId, clientX }) => {
            if (!fingers.has(pointerId)) return;
            const before = placed();
            fingers.set(pointerId, clientX);
            const now = placed(), perPixel = (view.max - view.min) / over.clientWidth;
            const factor = now.length > 1 ? (before[1] - before[0]) / Math.max(1, now[1] - now[0]) : 1;
            const fixed = view.min + before[0] * perPixel, min = fixed - now[0] * perPixel * factor;
            view.set(min, min + (view.max - view.min) * factor);
        });
        for (const kind of ["pointerup", "pointercancel", "pointerleave"]) over.addEventListener(kind, lift);
    }

    resize() {
        if (this.plot.width !== this.width) this.plot.setSize({ width: this.width, height: this.spec.height });
    }

    update() {
        const { view, spec } = this, columns = Math.round(this.width), grid = [];
        for (let n = 0; n <= columns; n++) grid.push(view.min + (view.max - view.min) * n / columns);
        const series = view.motion.axes.map((axis, n) => {
            if (!spec.ideal || view.hidden.has(n)) return grid.map(() => null);
            return grid.map(clock => (clock < axis.motion.start || clock > axis.end ? null : spec.ideal(axis, clock)));
        });
        const bounds = spec.range ? spec.range() : [Infinity, -Infinity];
        for (const values of series) {
            for (const value of values) {
                if (value === null) continue;
                bounds[0] = Math.min(bounds[0], value);
                bounds[1] = Math.max(bounds[1], value);
            }
        }
        if (!(bounds[0] <= bounds[1])) [bounds[0], bounds[1]] = [0, 1];
        const room = (bounds[1] - bounds[0]) * 0.07 || Math.abs(bounds[0]) * 0.07 || 1;
        this.bounds = spec.bounds || [bounds[0] - room, bounds[1] + room];
        this.plot.batch(() => this.plot.setData([grid, ...series], true));  // now, not at the end of the frame
    }

    draw(ctx, scale) {
        for (const { clock, kind } of this.view.motion.facts.events) {
            if (clock < scale.min || clock > scale.max) continue;
            ctx.strokeStyle = styleOf(kind ? "--bad" : "--event");
            ctx.lineWidth = devicePixelRatio;
            ctx.setLineDash([3 * devicePixelRatio, 3 * devicePixelRatio]);
            ctx.beginPath();
            ctx.moveTo(scale.x(clock), scale.top);
            ctx.lineTo(scale.x(clock), scale.top + scale.height);
            ctx.stroke();
        }
        ctx.setLineDash([]);
        let most = 1;
        for (const [axis, n] of this.view.axes) {
            ctx.strokeStyle = ctx.fillStyle = colorOf(n);
            ctx.lineWidth = Math.max(1, devicePixelRatio);
            ctx.globalAlpha = this.spec.alpha ?? 1;
            most = Math.max(most, this.spec.draw?.(ctx, scale, axis, n) ?? 1);
        }
        this.note.textContent = most > 1 ? this.spec.decimated(most) : this.spec.exact;
        this.note.classList.toggle("decimated", most > 1);
    }

    hover({ cursor, posToVal }) {
        const clock = cursor.left < 0 ? null : posToVal(cursor.left, "x");
        this.read(clock);
        // That of the mouse is in one chart, that of the player in all: the first one tells.
        if (cursor.event && clock !== null && this.view.pointer !== clock) {
            this.view.pointer = clock;
            for (const listener of this.view.pointed) listener();
        }
    }

    read(clock) {
        this.readout.textContent = "";
        if (clock === null) return;
        for (const [axis, n] of this.view.axes) {
            const value = element(this.readout, "span", "value", this.spec.read(axis, clock));
            value.style.color = colorOf(n);
        }
    }
}

// Smallest and largest of the visible steps, with the one before.
function visible(view, name, factor) {
    const found = [Infinity, -Infinity];
    for (const [axis] of view.axes) {
        const begin = Math.max(0, lower(axis.rises, view.min) - 1), end = lower(axis.rises, view.max);
        const [least, most] = axis.extremes[name].of(begin, end);
        found[0] = Math.min(found[0], least * factor(axis));
        found[1] = Math.max(found[1], most * factor(axis));
    }
    return found;
}

// Speed and acceleration along the way of the tool. `scales`: their largest values in all motions beside each other.
function addCourse(parent, view, scales) {
    const { unit } = view.course;
    if (!unit) return;
    const chart = (id, title, per, seconds, values, bounds) => new TimeChart(parent, view, {
        id, title, unit: `${unit}/${per}`, height: 150, bounds, decimated: () => "", exact: `of the steps, over ${plain(1000 * seconds)} ms or more`,
        drawBehind(ctx, scale) {
            const { course } = view, own = values(course);
            ctx.strokeStyle = styleOf("--accent");
            ctx.lineWidth = 1.5 * devicePixelRatio;
            ctx.beginPath();
            own.forEach((value, k) => ctx.lineTo(scale.x(course.min + k * course.step), scale.y(value)));
            ctx.stroke();
        },
        read(axis, clock) {
            return axis === view.axes[0]?.[0] ? `${plain(values(view.course)[view.course.sample(clock)], 4)} ${unit}/${per}` : "";
        },
    });
    chart("along", "Speed along the path", "s", SPEED_WINDOW, course => course.speed, [0, 1.07 * scales.speed || 1]);
    chart("push", "Acceleration along the path", "s²", ACCELERATION_WINDOW, course => course.acceleration, [-1.07 * scales.acceleration || -1, 1.07 * scales.acceleration || 1]);
}

function addMotionCharts(parent, view) {
    const { hz, facts, planned, machine } = view.motion, units = new Set(facts.runs.map(run => run.unit));
    const unit = units.size === 1 ? [...units][0] : "steps", same = units.size === 1;
    const per = axis => (same ? axis.per_step : 1);
    const shared = { height: 210, decimated: most => `up to ${grouped(most)} steps per pixel, drawn as their range`, exact: "every step drawn" };
    new TimeChart(parent, view, {
        ...shared, id: "position", title: machine ? "Position of the machine" : "Position", unit,
        ideal: planned && ((axis, clock) => axis.ideal(clock)[1] * per(axis)),
        range: () => visible(view, "counted", per),
        draw: (ctx, scale, axis) => drawTrace(ctx, scale, axis.rises, axis.counted, axis.extremes.counted,
            { before: axis.start, factor: per(axis), end: axis.end }),
        read: (axis, clock) => `${plain(axis.position(clock) * per(axis), 9)}`,
    });
    const speed = per => axis => per(axis) * hz;
    new TimeChart(parent, view, {
        ...shared, id: "speed", title: "Speed", unit: `${unit}/s`,
        ideal: planned && ((axis, clock) => axis.ideal(clock)[0] * per(axis) * hz),
        draw: (ctx, scale, axis) => drawTrace(ctx, scale, axis.rises, axis.speeds, axis.extremes.speeds, { factor: speed(per)(axis) }),
        range: () => visible(view, "speeds", speed(per)),
        read: (axis, clock) => plain((planned ? axis.ideal(clock)[0] : axis.speed(clock)) * per(axis) * hz),
    });
    if (!planned) return;
    new TimeChart(parent, view, {
        ...shared, id: "acceleration", title: "Acceleration", unit: `${unit}/s²`, height: 160, exact: "of the ideal curve",
        ideal: (axis, clock) => axis.ideal(clock)[2] * per(axis) * hz * hz,
        read: (axis, clock) => plain(axis.ideal(clock)[2] * per(axis) * hz * hz),
    });
}
