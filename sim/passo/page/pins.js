// SPDX-License-Identifier: MIT
// STEP and DIR of each axis as a logic analyzer shows them, and the timing error of each step.
"use strict";

const ROW = 1.5;

function signalsOf(axis) {
    const { rises, falls, turns } = axis;
    return {
        STEP: {
            count: clock => lower(rises, clock + 1e-9) + lower(falls, clock + 1e-9),
            at: n => (n % 2 ? falls[n >> 1] : rises[n >> 1]),
        },
        DIR: { count: clock => lower(turns, clock + 1e-9), at: n => turns[n] },
    };
}

function addPins(parent, view) {
    const { axes, hz } = view.motion, signals = axes.map(signalsOf);
    const rows = axes.flatMap((_, n) => [["STEP", n], ["DIR", n]]);
    const baseOf = (name, n) => -ROW * (2 * n + (name === "DIR" ? 1 : 0)) - 1;
    const centers = rows.map(([name, n]) => baseOf(name, n) + 0.5).reverse();
    const names = rows.map(([name, n]) => `${name} ${axes[n].name}`).reverse();
    new TimeChart(parent, view, {
        id: "pins", title: "STEP and DIR", height: 70 + 40 * axes.length, bounds: [-ROW * rows.length - 0.1, 0.4],
        exact: "every edge drawn, to the clock",
        decimated: most => `up to ${grouped(most)} edges per pixel, drawn as a block: zoom in to see each`,
        yAxis: { splits: () => centers, values: () => names, grid: { show: false }, ticks: { show: false } },
        drawBehind(ctx, scale) {
            if (scale.perPixel > 1 / (7 * devicePixelRatio)) return;
            ctx.strokeStyle = styleOf("--grid");
            ctx.lineWidth = 1;
            ctx.beginPath();
            for (let clock = Math.ceil(scale.min); clock <= scale.max; clock++) {
                ctx.moveTo(scale.x(clock), scale.top);
                ctx.lineTo(scale.x(clock), scale.top + scale.height);
            }
            ctx.stroke();
        },
        draw(ctx, scale, axis, n) {
            const step = drawLevel(ctx, scale, signals[n].STEP, baseOf("STEP", n));
            ctx.globalAlpha = 0.7;
            const dir = drawLevel(ctx, scale, signals[n].DIR, baseOf("DIR", n));
            ctx.globalAlpha = 1;
            return Math.max(step, dir);
        },
        read(axis, clock) {
            const { high, since, until } = axis.level("STEP", clock), way = axis.level("DIR", clock).high ? "−" : "+";
            const length = until - since;
            return `${way} ${high ? "high" : "low"}` + (isNaN(length) ? "" : ` ${grouped(length)} clk = ${duration(length, hz)}`);
        },
    });
}

function addErrors(parent, view) {
    const { hz } = view.motion;
    const ways = {
        steps: { unit: "steps", factor: 1, values: axis => [axis.errors, "errors"], text: value => `${plain(value, 4)} steps` },
        time: { unit: "µs", factor: 1e6 / hz, values: axis => [axis.lags, "lags"], text: value => `${plain(value, 4)} µs` },
    };
    let way = ways.steps;
    const chart = new TimeChart(parent, view, {
        id: "error", title: "Timing error", height: 180, alpha: 0.6, unit: "steps", exact: "every step drawn",
        decimated: most => `up to ${grouped(most)} steps per pixel, drawn as their range`,
        yAxis: { label: () => way.unit },
        range: () => {
            for (const [axis] of view.axes) way.values(axis);
            return visible(view, way.values(view.motion.axes[0])[1], () => way.factor);
        },
        draw(ctx, scale, axis) {
            const [values, name] = way.values(axis);
            return drawTrace(ctx, scale, axis.rises, values, axis.extremes[name], { points: true, factor: way.factor });
        },
        read(axis, clock) {
            const made = Math.max(1, lower(axis.rises, clock + 1e-9));
            return made <= axis.rises.length ? way.text(way.values(axis)[0][made - 1] * way.factor) : "–";
        },
        controls(head, changed) {
            const choice = element(head, "span", "choice");
            for (const [name, text, hint] of [
                ["steps", "steps", "how far the ideal curve is ahead of each step, in steps of that axis"],
                ["time", "µs", "how much later than the ideal curve each step comes"],
            ]) {
                const button = element(choice, "button", name === "steps" ? "on" : "", text);
                button.title = hint;
                button.onclick = () => {
                    way = ways[name];
                    for (const other of choice.children) other.classList.toggle("on", other === button);
                    view.changed();
                };
            }
        },
    });
    return { get way() { return way; }, chart };
}
