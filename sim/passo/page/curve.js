// SPDX-License-Identifier: MIT
// The ideal continuous motion of a plan: velocity, distance and acceleration at any clock, as in sim/passo/curve.py.
"use strict";

// Shapes: of u from 0 to 1 the value, the integral from 0 to u, and the slope.
const linearShape = u => [u, u * u / 2, 1];
const easeShape = u => [u * u, u ** 3 / 3, 2 * u];
const cosineShape = u => [
    (1 - Math.cos(Math.PI * u)) / 2,
    u / 2 - Math.sin(Math.PI * u) / (2 * Math.PI),
    Math.PI / 2 * Math.sin(Math.PI * u),
];

function sigmoidShape(alpha) {
    const logistic = x => 1 / (1 + Math.exp(-x));
    const softplus = x => Math.max(x, 0) + Math.log1p(Math.exp(-Math.abs(x)));
    const low = logistic(-alpha), height = logistic(alpha) - low;
    return u => {
        const x = alpha * (2 * u - 1), y = logistic(x);
        const area = (softplus(x) - softplus(-alpha)) / (2 * alpha) - low * u;
        return [(y - low) / height, area / height, 2 * alpha * y * (1 - y) / height];
    };
}

// Straight lines between points; the last one is 1.
function tableShape(points) {
    const count = points.length - 1, areas = [0];
    for (let k = 0; k < count; k++) areas.push(areas[k] + (points[k] + points[k + 1]) / 2);
    return u => {
        const k = Math.min(Math.floor(u * count), count - 1), part = u * count - k;
        const value = points[k] + (points[k + 1] - points[k]) * part;
        return [value, (areas[k] + (points[k] + value) / 2 * part) / count, (points[k + 1] - points[k]) * count];
    };
}

function mirrored(shape) {
    const whole = shape(1)[1];
    return u => {
        const [value, area, slope] = shape(1 - u);
        return [1 - value, u - (whole - area), slope];
    };
}

class Curve {
    // `ramps`: [ticks, velocity at the end in substeps per clock, shape, whether it is mirrored].
    constructor(plan, alphaReset) {
        const sigmoid = plan.table ? tableShape(plan.table) : sigmoidShape(plan.alpha || alphaReset);
        const shapes = { linear: linearShape, cosine: cosineShape, sigmoid, ease: easeShape };
        this.segments = [];
        let begin = 0, distance = 0, velocity = 0;
        for (const [ticks, end, shape, mirror] of plan.ramps) {
            if (ticks) {
                const own = mirror ? mirrored(shapes[shape]) : shapes[shape];
                const segment = { begin, length: ticks * plan.tick, distance, velocity, change: end - velocity, shape: own };
                this.segments.push(segment);
                begin += segment.length;
                distance += segment.length * (velocity + segment.change * own(1)[1]);
            }
            velocity = end;
        }
        this.clocks = begin;
        this.last = 0;
    }

    // [velocity, distance, acceleration] in substeps and clocks; `clock` counts from the start of the plan.
    at(clock) {
        const segments = this.segments;
        let k = Math.min(this.last, segments.length - 1);
        while (k > 0 && clock < segments[k].begin) k--;
        while (k + 1 < segments.length && clock >= segments[k + 1].begin) k++;
        this.last = k;
        const s = segments[k];
        const u = Math.min(1, Math.max(0, (clock - s.begin) / s.length));
        const [value, area, slope] = s.shape(u);
        const moves = clock >= 0 && clock <= this.clocks;
        return [
            moves ? s.velocity + s.change * value : 0,
            s.distance + s.length * (s.velocity * u + s.change * area),
            moves ? s.change * slope / s.length : 0,
        ];
    }

    // The clock at which a distance is reached; the search starts at `clock`.
    when(distance, clock) {
        let low = 0, high = this.clocks, t = Math.min(high, Math.max(low, clock));
        for (let round = 0; round < 80; round++) {
            const [velocity, reached] = this.at(t);
            const over = reached - distance;
            if (over > 0) high = t;
            else low = t;
            let next = t - over / velocity;
            if (!(next > low && next < high)) next = (low + high) / 2;
            if (Math.abs(next - t) < 1e-4) return next;
            t = next;
        }
        return t;
    }
}
