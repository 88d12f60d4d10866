// SPDX-License-Identifier: MIT
// The tool path in space: to be turned, with the tool at a time.
"use strict";

// From slow to fast, of even lightness in between, also for the color-blind.
const SPEED_COLORS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
const SHADES = 24;
const SLICE_SAMPLES = 1500, COARSE = 6;  // drawn together; of which one is drawn while it turns
const TOP = { yaw: 0, pitch: Math.PI / 2 }, TILTED = { yaw: -0.6, pitch: 0.62 };
const TAIL = 0.03;  // of the time shown, behind the tool
const EDGES = [0, 1, 2].flatMap(axis => [0, 1, 2, 3].map(k => {
    const [one, other] = [0, 1, 2].filter(n => n !== axis), from = [0, 0, 0];
    [from[one], from[other]] = [k & 1, k >> 1];
    return { axis, from, to: from.map((bit, n) => (n === axis ? 1 : bit)) };
}));

function speedColor(share) {
    const place = Math.min(0.9999, Math.max(0, share)) * (SPEED_COLORS.length - 1), n = Math.floor(place);
    const mixed = SPEED_COLORS[n].map((value, i) => Math.round(value + (SPEED_COLORS[n + 1][i] - value) * (place - n)));
    return `rgb(${mixed.join(",")})`;
}

class ToolPath {
    constructor(parent, view) {
        this.view = view;
        this.axes = toolAxes(view.motion);
        this.turned = { ...(this.axes.length > 2 ? TILTED : TOP) };
        const panel = element(parent, "section", "panel");
        panel.id = "path";
        const head = element(panel, "header");
        element(head, "h2", "", "Tool path");
        this.note = element(head, "span", "note");
        this.choices = ["across", "along", "up"].slice(0, this.axes.length).map((label, n) => this.choice(head, label, n));
        const button = (text, hint, turned) => {
            const made = element(head, "button", "", text);
            made.title = hint;
            made.onclick = () => this.turn(turned);
        };
        if (this.axes.length > 2) {
            button("top", "from above", TOP);
            button("front", "from the front", { yaw: 0, pitch: 0 });
            button("in space", "from the side above", TILTED);
        }
        const stage = element(panel, "div", "stage");
        [this.canvas, this.overlay] = ["path", "path tool"].map(name => element(stage, "canvas", name));
        this.overlay.tabIndex = 0;
        this.overlay.setAttribute("role", "img");
        this.overlay.setAttribute("aria-label", "Tool path: arrows turn it");
        if (this.axes.length > 2) this.listen();
        new ResizeObserver(() => this.canvas.clientWidth !== this.drawnWidth && view.changed()).observe(stage);
        view.listeners.push(this);
        view.pointed.push(() => this.drawTool());
    }

    choice(head, label, n) {
        if (this.axes.length < 4 && this.axes.length !== 2) return { value: n };
        const box = element(head, "label", "note", `${label} `), list = element(box, "select");
        this.axes.forEach(({ name }, k) => { element(list, "option", "", name).value = k; });
        list.value = n;
        list.onchange = () => this.view.changed();
        return list;
    }

    // `turning`: by hand.
    turn(turned, turning = false) {
        Object.assign(this.turned, turned);
        this.turned.pitch = Math.max(0, Math.min(Math.PI / 2, this.turned.pitch));
        this.turning = turning;
        cancelAnimationFrame(this.waiting);
        this.waiting = requestAnimationFrame(() => (turning ? this.draw() : this.view.redraw(this)));
    }

    listen() {
        const { overlay, turned } = this;
        overlay.classList.add("turns");
        overlay.addEventListener("pointerdown", event => overlay.setPointerCapture(event.pointerId));
        overlay.addEventListener("pointermove", event => {
            if (event.buttons & 1) this.turn({ yaw: turned.yaw + event.movementX / 150, pitch: turned.pitch + event.movementY / 150 }, true);
        });
        overlay.addEventListener("pointerup", () => this.turning && this.turn(turned));
        overlay.addEventListener("dblclick", () => this.turn(TILTED));
        const keys = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
        overlay.addEventListener("keydown", event => {
            const by = keys[event.key];
            if (!by) return;
            event.preventDefault();
            event.stopPropagation();
            this.turn({ yaw: turned.yaw + by[0], pitch: turned.pitch + by[1] });
        });
    }

    get chosen() { return this.choices.map(list => Number(list.value)); }

    // Places of the chosen axes at a sample; of two axes the third is 0.
    place(course, k) { return [0, 1, 2].map(n => (n < this.choices.length ? course.places[this.chosen[n]][k] : 0)); }

    update() {
        this.whole ??= new Course(this.view.motion, ...this.view.whole);
        this.part = this.view.isAll ? null : this.view.course;
        cancelAnimationFrame(this.waiting);
        return this.steps();
    }

    // Chooses the scale, the same for all axes, so that a circle is round; `flat` projects a place to pixels.
    fit(width, height) {
        const { yaw, pitch } = this.turned, [sin, cos, sinPitch, cosPitch] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
        const extents = [0, 1, 2].map(n => (n < this.choices.length ? this.whole.extent(this.chosen[n]) : [0, 0]));
        const middle = extents.map(([low, high]) => (low + high) / 2);
        const turn = ([x, y, z]) => [(x - middle[0]) * cos - (y - middle[1]) * sin,
            ((x - middle[0]) * sin + (y - middle[1]) * cos) * sinPitch + (z - middle[2]) * cosPitch];
        const corners = [0, 1, 2, 3, 4, 5, 6, 7].map(k => turn(extents.map((extent, n) => extent[k >> n & 1])));
        const [wide, high] = [0, 1].map(n => Math.max(...corners.map(corner => Math.abs(corner[n]))) || 1e-9);
        const scale = Math.min((width / 2 - 70) / wide, (height / 2 - 34) / high);
        this.extents = extents;
        this.flat = place => {
            const [x, y] = turn(place);
            return [width / 2 + x * scale, height / 2 + 4 - y * scale];
        };
    }

    // The edges of the box around the path that are lowest or leftmost, with what they measure.
    drawBox(ctx) {
        const { extents, flat } = this;
        const ends = EDGES.map(({ axis, from, to }) => ({ axis, line: [from, to].map(bits => flat(extents.map((extent, n) => extent[bits[n]]))) }))
            .filter(({ axis, line: [a, b] }) => extents[axis][1] > extents[axis][0] && Math.hypot(a[0] - b[0], a[1] - b[1]) > 24);
        ctx.strokeStyle = styleOf("--grid");
        ctx.lineWidth = 1;
        ctx.beginPath();
        for (const { line: [a, b] } of ends) {
            ctx.moveTo(...a);
            ctx.lineTo(...b);
        }
        ctx.stroke();
        ctx.fillStyle = styleOf("--faint");
        for (let axis = 0; axis < this.choices.length; axis++) {
            const own = ends.filter(end => end.axis === axis), middle = ({ line: [a, b] }) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
            if (!own.length) continue;
            const steep = ({ line: [a, b] }) => Math.abs(a[1] - b[1]) > 2 * Math.abs(a[0] - b[0]);
            const best = own.reduce((one, other) => {
                const [m, o] = [middle(one), middle(other)];
                return (steep(one) ? o[0] < m[0] : o[1] > m[1]) ? other : one;
            });
            const { name, unit } = this.axes[this.chosen[axis]], [low, high] = extents[axis].map(value => plain(value, 4));
            const [x, y] = middle(best), text = `${name} ${low} … ${high} ${unit}`;
            if (steep(best)) {
                ctx.save();
                ctx.translate(x - 8, y);
                ctx.rotate(-Math.PI / 2);
                ctx.textAlign = "center";
                ctx.fillText(text, 0, 0);
                ctx.restore();
                continue;
            }
            const [[left, top], [right, bottom]] = best.line, slope = (bottom - top) / (right - left || 1);
            ctx.textAlign = Math.abs(slope) < 0.1 ? "center" : slope > 0 ? "right" : "left";
            ctx.fillText(text, x, y + 16);
        }
    }

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

    // Draws samples in one color, or each in that of its speed; yields between slices.
    *trace(ctx, course, color, thick) {
        ctx.lineJoin = ctx.lineCap = "round";
        const shade = k => (color ? 0 : Math.min(SHADES - 1, Math.floor(SHADES * course.speed[k] / (course.fastest || 1))));
        const every = this.turning ? COARSE : 1;
        for (let begin = 0; begin < course.count - 1; begin += SLICE_SAMPLES) {
            const lines = [], end = Math.min(course.count - 1, begin + SLICE_SAMPLES);
            let before = this.flat(this.place(course, begin)), last = -1;
            for (let k = begin; k < end;) {
                k = Math.min(end, k + every);
                const next = this.flat(this.place(course, k)), own = shade(k);
                const line = lines[own] ??= new Path2D();
                if (own !== last) line.moveTo(...before);
                line.lineTo(...next);
                [before, last] = [next, own];
            }
            ctx.lineWidth = thick;
            lines.forEach((line, own) => {
                ctx.strokeStyle = color ?? speedColor((own + 0.5) / SHADES);
                ctx.stroke(line);
            });
            yield;
        }
    }

    context(canvas) {
        const ratio = devicePixelRatio, [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
        [canvas.width, canvas.height] = [width * ratio, height * ratio];
        const ctx = canvas.getContext("2d");
        ctx.scale(ratio, ratio);
        ctx.font = "11px system-ui";
        return [ctx, width, height];
    }

    // Draws in one frame, roughly while it turns.
    draw() {
        Array.from(this.steps());
    }

    *steps() {
        const { whole, part } = this, [ctx, width, height] = this.context(this.canvas);
        this.drawnWidth = width;
        this.fit(width, height);
        this.drawBox(ctx);
        this.drawTool();
        yield;
        if (part) yield* this.trace(ctx, whole, styleOf("--event"), 1);
        const shown = part ?? whole;
        yield* this.trace(ctx, shown, shown.speed ? null : colorOf(0), part ? 2.5 : 1.6);
        if (shown.speed) this.drawScale(ctx, shown.fastest, shown.unit, width - 90);
        this.note.textContent = part ? "strong: what the charts show" : "";
        for (const [k, color] of [[0, styleOf("--good")], [whole.count - 1, styleOf("--bad")]]) {
            ctx.fillStyle = color;
            ctx.beginPath();
            ctx.arc(...this.flat(this.place(whole, k)), 4, 0, 7);
            ctx.fill();
        }
    }

    // The tool at the pointer of the charts, or of the player.
    drawTool() {
        if (!this.flat) return;
        const [ctx] = this.context(this.overlay), { view } = this, clock = view.pointer;
        if (clock === null) return;
        const course = this.part ?? this.whole, at = course.sample(clock), tail = Math.round(TAIL * course.count);
        ctx.strokeStyle = ctx.fillStyle = styleOf("--accent");
        ctx.lineCap = "round";
        for (let k = Math.max(1, at - tail); k <= at; k++) {
            ctx.globalAlpha = 1 - (at - k) / tail;
            ctx.lineWidth = 1 + 3 * ctx.globalAlpha;
            ctx.beginPath();
            ctx.moveTo(...this.flat(this.place(course, k - 1)));
            ctx.lineTo(...this.flat(this.place(course, k)));
            ctx.stroke();
        }
        const [x, y] = this.flat(this.place(course, at));
        ctx.globalAlpha = 0.25;
        ctx.beginPath();
        ctx.arc(x, y, 11, 0, 7);
        ctx.fill();
        ctx.globalAlpha = 1;
        ctx.beginPath();
        ctx.arc(x, y, 4.5, 0, 7);
        ctx.fill();
    }
}
