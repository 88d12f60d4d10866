// SPDX-License-Identifier: MIT
// A motion: every edge at the pins, and what follows from it. Clocks count from the start of the first channel.
"use strict";

// Index of the first element that is not below `value`.
function lower(sorted, value, end = sorted.length) {
    let low = 0, high = end;
    while (low < high) {
        const middle = (low + high) >> 1;
        if (sorted[middle] < value) low = middle + 1;
        else high = middle;
    }
    return low;
}

// Smallest and largest of a range of values, without NaN; blocks of 64 make it quick.
class Extremes {
    constructor(values) {
        this.values = values;
        const blocks = Math.ceil(values.length / 64);
        this.least = new Float64Array(blocks);
        this.most = new Float64Array(blocks);
        for (let b = 0; b < blocks; b++) {
            [this.least[b], this.most[b]] = this.scan(64 * b, Math.min(values.length, 64 * b + 64), [Infinity, -Infinity]);
        }
    }

    scan(begin, end, found) {
        for (let i = begin; i < end; i++) {
            const value = this.values[i];
            if (value < found[0]) found[0] = value;
            if (value > found[1]) found[1] = value;
        }
        return found;
    }

    of(begin, end) {
        const found = [Infinity, -Infinity];
        const first = Math.ceil(begin / 64), last = Math.floor(end / 64);
        if (first >= last) return this.scan(begin, end, found);
        this.scan(begin, 64 * first, found);
        for (let b = first; b < last; b++) {
            if (this.least[b] < found[0]) found[0] = this.least[b];
            if (this.most[b] > found[1]) found[1] = this.most[b];
        }
        return this.scan(64 * last, end, found);
    }
}

// The edges of each axis, [rises of STEP, falls of STEP, edges of DIR], from the streams of sim/passo/report_data.py,
// and those of further signals.
function unpack(bytes, axes, signals = []) {
    let place = 0;
    const sums = count => {
        const found = new Float64Array(count);
        for (let i = 0, sum = 0; i < count; i++) {
            let number = 0, weight = 1, byte;
            do {
                byte = bytes[place++];
                number += (byte & 127) * weight;
                weight *= 128;
            } while (byte > 127);
            sum += number % 2 ? -(number + 1) / 2 : number / 2;
            found[i] = sum;
        }
        return found;
    };
    const ofAxes = axes.map(({ edges: [rises, falls, turns] }) => {
        const up = sums(rises);
        for (let i = 1; i < rises; i++) up[i] += up[i - 1];
        const down = sums(falls).map((length, i) => length + up[i]);
        return [up, down, sums(turns)];
    });
    return [ofAxes, signals.map(({ edges }) => sums(edges))];
}

class Axis {
    constructor(facts, run, [rises, falls, turns], alphaReset) {
        Object.assign(this, facts, { motion: run, rises, falls, turns });
        const count = rises.length;
        this.counted = new Float64Array(count);  // position from each step on
        this.start ??= 0;  // position of the machine before the first step
        for (let i = 0, turn = 0, position = this.start; i < count; i++) {
            while (turn < turns.length && turns[turn] <= rises[i]) turn++;
            position += turn % 2 ? -1 : 1;
            this.counted[i] = position;
        }
        this.plans = [];
        let begin = run.start, first = 0, base = 0;
        for (const plan of run.plans) {
            const steps = plan.steps[this.axis], curve = new Curve(plan, alphaReset);
            this.plans.push({ begin, first, base, steps, share: steps / plan.substeps, curve, count: Math.abs(steps) });
            begin += curve.clocks;
            first += Math.abs(steps);
            base += steps;
        }
        this.begins = this.plans.map(plan => plan.begin);
        this.end = this.plans.length ? begin : run.start + run.clocks;
        this._speeds();
        this._errors();
        this.extremes = {
            counted: new Extremes(this.counted), speeds: new Extremes(this.speeds), errors: new Extremes(this.errors),
        };
    }

    // Speed (steps per clock) from each step to the next, NaN where the axis rests or turns.
    _speeds() {
        const count = this.rises.length;
        this.speeds = new Float64Array(count).fill(NaN);
        let plan = 0;
        const planOf = i => {
            while (plan + 1 < this.plans.length && i >= this.plans[plan + 1].first) plan++;
            return plan;
        };
        for (let i = 0, own = planOf(0), way = this.counted[0] - this.start; i + 1 < count; i++) {
            const next = planOf(i + 1), nextWay = this.counted[i + 1] - this.counted[i];
            if (way === nextWay && next - own <= 1) this.speeds[i] = way / Math.max(1, this.rises[i + 1] - this.rises[i]);
            [own, way] = [next, nextWay];
        }
    }

    // How far the ideal curve is ahead of each step at its clock, in steps; step q belongs at q + 1/2.
    _errors() {
        this.errors = new Float64Array(this.plans.length ? this.rises.length : 0).fill(NaN);
        for (const plan of this.plans) {
            const share = Math.abs(plan.share), end = Math.min(plan.first + plan.count, this.rises.length);
            for (let i = plan.first; i < end; i++) {
                this.errors[i] = plan.curve.at(this.rises[i] - plan.begin)[1] * share - (i - plan.first + 0.5);
            }
        }
    }

    // How many clocks each step comes after the ideal one; computed when first asked for.
    get lags() {
        if (this._lags) return this._lags;
        this._lags = new Float64Array(this.rises.length).fill(NaN);
        for (const plan of this.plans) {
            const end = Math.min(plan.first + plan.count, this.rises.length);
            for (let i = plan.first; i < end; i++) {
                const own = this.rises[i] - plan.begin;
                this._lags[i] = own - plan.curve.when((i - plan.first + 0.5) / Math.abs(plan.share), own);
            }
        }
        this.extremes.lags = new Extremes(this._lags);
        return this._lags;
    }

    // Ideal [speed, position, acceleration] in steps and clocks.
    ideal(clock) {
        const plan = this.plans[Math.max(0, lower(this.begins, clock + 1e-9) - 1)];
        const [velocity, distance, slope] = plan.curve.at(clock - plan.begin);
        return [velocity * plan.share, plan.base + distance * plan.share, slope * plan.share];
    }

    // Speed at the pins, in steps per clock.
    speed(clock) {
        const made = lower(this.rises, clock + 1e-9);
        return made ? this.speeds[made - 1] || 0 : 0;
    }

    // Position of the machine, counted at the pins.
    position(clock) {
        const made = lower(this.rises, clock + 1e-9);
        return made ? this.counted[made - 1] : this.start;
    }

    // Level of STEP or DIR, and the clocks of the edges before and after.
    level(signal, clock) {
        const up = lower(this.rises, clock + 1e-9), down = lower(this.falls, clock + 1e-9);
        if (signal === "DIR") {
            const turn = lower(this.turns, clock + 1e-9);
            return { high: turn % 2 === 1, since: this.turns[turn - 1], until: this.turns[turn] };
        }
        const high = up > down;
        return { high, since: high ? this.rises[up - 1] : this.falls[down - 1], until: high ? this.falls[down] : this.rises[up] };
    }
}

class Motion {
    constructor(facts, [edges, signals]) {
        this.facts = facts;
        this.machine = facts.machine ? new Rig(facts.machine, signals) : null;
        this.hz = facts.clock_hz;
        this.planned = facts.runs.some(run => run.plans.length);  // otherwise there are no ideal curves
        this.clocks = Math.max(1, facts.clocks);
        this.axes = facts.axes.map((own, n) => new Axis(own, facts.runs[own.run], edges[n], facts.alpha_reset));
    }

    // A motion that a worker has made: structured clones forget their classes.
    static from(data) {
        const { machine, axes } = Object.setPrototypeOf(data, Motion.prototype);
        if (machine) throw new Error("a machine cannot be cloned");
        for (const axis of axes) {
            Object.setPrototypeOf(axis, Axis.prototype);
            for (const extremes of Object.values(axis.extremes)) Object.setPrototypeOf(extremes, Extremes.prototype);
        }
        return data;
    }
}
