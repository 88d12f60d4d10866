// SPDX-License-Identifier: MIT
// The way of the tool over time, from the steps of the motors: places, speed and acceleration along it.
"use strict";

const COURSE_SAMPLES = 12000;
const SPEED_WINDOW = 0.004, ACCELERATION_WINDOW = 0.02;  // seconds over which they are measured, at least

// The axes of the tool: those of the motors, unless `rows` (motor x axis: -1, 0, 1) says which axes each motor moves.
function toolAxes(motion) {
    const { rows, letters } = motion.facts;
    if (!rows) return motion.axes.map((axis, n) => ({ name: axis.name, unit: axis.motion.unit, parts: [[n, 1]] }));
    return [...letters].map((name, axis) => {
        const moved = rows.map((row, n) => [n, row[axis]]).filter(([, part]) => part);
        return { name, unit: motion.axes[0].motion.unit, parts: moved.map(([n, part]) => [n, part / moved.length]) };
    });
}

// Places of a motor at even clocks: straight between two steps.
function placesOf(axis, min, step, count) {
    const { rises, counted, per_step } = axis, places = new Float64Array(count);
    for (let k = 0, i = lower(rises, min); k < count; k++) {
        const clock = min + k * step;
        while (i < rises.length && rises[i] <= clock) i++;
        const place = i ? counted[i - 1] : axis.start;
        const part = i && i < rises.length ? (clock - rises[i - 1]) / Math.max(1, rises[i] - rises[i - 1]) : 0;
        places[k] = (place + (part ? (counted[i] - place) * part : 0)) * per_step;
    }
    return places;
}

class Course {
    // From clock `min` to `max`.
    constructor(motion, min, max, count = COURSE_SAMPLES) {
        const step = (max - min) / (count - 1), own = motion.axes.map(axis => placesOf(axis, min, step, count));
        this.axes = toolAxes(motion);
        Object.assign(this, { min, step, count, hz: motion.hz });
        this.places = this.axes.map(({ parts }) => {
            if (parts.length === 1 && parts[0][1] === 1) return own[parts[0][0]];
            return own[0].map((_, k) => parts.reduce((sum, [n, part]) => sum + part * own[n][k], 0));
        });
        this.unit = this.axes.every(({ unit }) => unit === this.axes[0].unit) ? this.axes[0].unit : null;
        this.speed = this.unit && this.change(SPEED_WINDOW);
        this.fastest = this.speed ? this.speed.reduce((most, value) => Math.max(most, value), 0) : 0;
    }

    // Samples on either side of one that make a window.
    width(seconds) { return Math.max(1, Math.round(seconds * this.hz / this.step / 2)); }

    // Speed along the way, over the window around each sample.
    change(seconds) {
        const { places, count, hz, step } = this, found = new Float64Array(count), width = this.width(seconds);
        for (let k = 0; k < count; k++) {
            const from = Math.max(0, k - width), to = Math.min(count - 1, k + width);
            for (const own of places) found[k] += (own[to] - own[from]) ** 2;
            found[k] = Math.sqrt(found[k]) * hz / (step * (to - from));
        }
        return found;
    }

    // Along the way, per second squared.
    get acceleration() {
        if (this._acceleration) return this._acceleration;
        const { count, hz, step } = this, speed = this.change(ACCELERATION_WINDOW), width = this.width(ACCELERATION_WINDOW);
        this._acceleration = speed.map((_, k) => {
            const from = Math.max(0, k - width), to = Math.min(count - 1, k + width);
            return (speed[to] - speed[from]) * hz / (step * (to - from));
        });
        return this._acceleration;
    }

    sample(clock) { return Math.max(0, Math.min(this.count - 1, Math.round((clock - this.min) / this.step))); }

    // Smallest and largest place of an axis.
    extent(n) { return this.places[n].reduce(([low, high], place) => [Math.min(low, place), Math.max(high, place)], [Infinity, -Infinity]); }
}
