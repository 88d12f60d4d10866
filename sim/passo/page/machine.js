// SPDX-License-Identifier: MIT
// A machine at the pins: its signals, the power, what encoders have measured and trackers have made.
"use strict";

class Rig {
    // `edges`: of each signal, low at first.
    constructor(facts, edges) {
        Object.assign(this, facts);
        this.signals = facts.signals.map((signal, n) => ({
            ...signal, edges: edges[n], count: clock => lower(edges[n], clock + 1e-9), at: k => edges[n][k],
        }));
        if (this.power) {
            this.power.values = Float64Array.from(this.power.percent);
            this.power.extremes = new Extremes(this.power.values);
        }
        const sampled = [[this.encoders, ["measured", "error"]], [this.trackers, ["tracked"]]];
        for (const [all, names] of sampled) {
            for (const own of all) {
                for (const name of names) {
                    own[name] = Float64Array.from(own[name]);
                    own[`${name}Extremes`] = new Extremes(own[name]);
                }
            }
        }
    }

    // The encoder or the tracker of an axis, which has samples with that name.
    sampled(axis, name) { return [...this.encoders, ...this.trackers].find(one => one.axis === axis.axis && one[name]); }
    level(n, clock) { return this.signals[n].count(clock) % 2 === 1; }
}

function addSignals(parent, view, machine) {
    const { signals } = machine, { hz } = view.motion, base = n => -ROW * n - 1;
    const names = signals.map(signal => signal.name).reverse();
    new TimeChart(parent, view, {
        id: "signals", title: "Inputs, drives and outputs", height: 70 + 20 * signals.length, bounds: [-ROW * signals.length - 0.1, 0.4],
        exact: "every edge drawn, to the clock", decimated: () => "",
        yAxis: { splits: () => signals.map((_, n) => base(n) + 0.5).reverse(), values: () => names, grid: { show: false }, ticks: { show: false } },
        drawBehind(ctx, scale) {
            signals.forEach((signal, n) => {
                ctx.strokeStyle = ctx.fillStyle = signal.axis === null ? styleOf("--faint") : colorOf(signal.axis);
                ctx.lineWidth = Math.max(1, devicePixelRatio);
                drawLevel(ctx, scale, signal, base(n));
            });
        },
        read(axis, clock) {
            if (axis !== view.axes[0][0]) return "";
            const high = signals.filter((_, n) => machine.level(n, clock)).map(signal => signal.name);
            return `${duration(clock, hz, 9)}: ${high.join(", ") || "all low"}`;
        },
    });
}

// A chart of values at the samples of each axis that has them.
function addSamples(parent, view, machine, { id, title, name, unit, per, limit }) {
    const of = axis => machine.sampled(axis, name);
    new TimeChart(parent, view, {
        id, title, unit, height: 150, exact: "every sample of the host drawn",
        decimated: most => `up to ${grouped(most)} samples per pixel, drawn as their range`,
        range() {
            const found = [Infinity, -Infinity];
            for (const [axis] of view.axes) {
                const own = of(axis);
                if (!own) continue;
                const begin = Math.max(0, lower(own.clocks, view.min) - 1), end = lower(own.clocks, view.max);
                const [least, most] = own[`${name}Extremes`].of(begin, end);
                const reach = limit && own.limit ? own.limit : 0;
                found[0] = Math.min(found[0], least * per(axis), -reach || Infinity);
                found[1] = Math.max(found[1], most * per(axis), reach || -Infinity);
            }
            return found;
        },
        draw(ctx, scale, axis) {
            const own = of(axis);
            if (!own) return 1;
            if (limit && own.limit) {
                ctx.save();
                ctx.strokeStyle = styleOf("--bad");
                ctx.setLineDash([6 * devicePixelRatio, 3 * devicePixelRatio]);
                ctx.beginPath();
                for (const value of [-own.limit, own.limit]) {
                    ctx.moveTo(scale.left, scale.y(value));
                    ctx.lineTo(scale.left + scale.width, scale.y(value));
                }
                ctx.stroke();
                ctx.restore();
            }
            return drawTrace(ctx, scale, own.clocks, own[name], own[`${name}Extremes`], { factor: per(axis) });
        },
        read(axis, clock) {
            const own = of(axis), n = own ? lower(own.clocks, clock + 1e-9) : 0;
            return n ? `${plain(own[name][n - 1] * per(axis), 6)}` : "";
        },
    });
}

function addMachine(parent, view) {
    const { machine, facts } = view.motion;
    if (!machine) return;
    addSignals(parent, view, machine);
    if (machine.power) {
        const { clocks, values, extremes } = machine.power;
        new TimeChart(parent, view, {
            id: "power", title: "Power", unit: "%", height: 140, exact: "share of the time that the pin is high", decimated: () => "its range in each pixel",
            range: () => [0, extremes.of(0, values.length)[1]],
            drawBehind(ctx, scale) {
                ctx.strokeStyle = ctx.fillStyle = styleOf("--bad");
                ctx.lineWidth = Math.max(1, devicePixelRatio);
                drawTrace(ctx, scale, clocks, values, extremes);
            },
            read(axis, clock) {
                const n = lower(clocks, clock + 1e-9);
                return axis === view.axes[0][0] && n ? `${plain(values[n - 1])} %` : "";
            },
        });
    }
    if (machine.trackers.length) {
        addSamples(parent, view, machine, {
            id: "trackers", title: "Trackers: their share of the position", name: "tracked", unit: facts.runs[0].unit, per: axis => axis.per_step,
        });
    }
    if (!machine.encoders.length) return;
    addSamples(parent, view, machine, {
        id: "measured", title: "Measured position", name: "measured", unit: facts.runs[0].unit, per: axis => axis.per_step,
    });
    addSamples(parent, view, machine, {
        id: "following", title: "Following error: steps less measured, limit", name: "error", unit: "steps", per: () => 1, limit: true,
    });
}
