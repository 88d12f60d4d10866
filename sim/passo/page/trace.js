// SPDX-License-Identifier: MIT
// Draws traces: every step where there is room, otherwise the smallest and largest value of each column of pixels.
"use strict";

// Clocks of the visible range to pixels of the canvas, and back.
class Scale {
    constructor(chart) {
        const { left, top, width, height } = chart.bbox;
        Object.assign(this, { left, top, width, height, min: chart.scales.x.min, max: chart.scales.x.max });
        this.y = value => chart.valToPos(value, "y", true);
        this.perPixel = (this.max - this.min) / width;
    }

    x(clock) { return this.left + (clock - this.min) / this.perPixel; }
    clock(column) { return this.min + column * this.perPixel; }
}

function clipped(chart, draw) {
    const { left, top, width, height } = chart.bbox;
    chart.ctx.save();
    chart.ctx.beginPath();
    chart.ctx.rect(left, top, width, height);
    chart.ctx.clip();
    draw(chart.ctx, new Scale(chart));
    chart.ctx.restore();
}

// Values that hold from a clock to the next one, or with `points` only at that clock; NaN is a gap. The value before the
// first clock is `before`. Returns the most steps that share a column: 1 where all are drawn.
function drawTrace(ctx, scale, clocks, values, extremes, { points = false, before = NaN, factor = 1, end = Infinity } = {}) {
    const first = Math.max(0, lower(clocks, scale.min) - 1), last = Math.min(clocks.length, lower(clocks, scale.max) + 1);
    if (last - first > scale.width / 2) return drawColumns(ctx, scale, clocks, extremes, points, factor, end);
    ctx.beginPath();
    if (points) {
        const size = Math.max(2, Math.min(6, scale.width / (last - first + 1) / 3)) * devicePixelRatio;
        for (let i = first; i < last; i++) {
            if (!isNaN(values[i])) ctx.rect(scale.x(clocks[i]) - size / 2, scale.y(values[i] * factor) - size / 2, size, size);
        }
        ctx.fill();
        return 1;
    }
    let y = first || isNaN(before) ? NaN : scale.y(before * factor);
    if (!isNaN(y)) ctx.moveTo(scale.x(Math.min(0, scale.min)), y);
    for (let i = first; i < last; i++) {
        const x = scale.x(clocks[i]), next = scale.y(values[i] * factor);
        if (isNaN(next)) {
            y = NaN;
            continue;
        }
        if (isNaN(y)) ctx.moveTo(x, next);
        else ctx.lineTo(x, y);
        ctx.lineTo(x, next);
        ctx.lineTo(scale.x(i + 1 < clocks.length ? clocks[i + 1] : Math.max(end, clocks[i])), next);
        y = next;
    }
    ctx.stroke();
    return 1;
}

// Values hold until `last`.
function drawColumns(ctx, scale, clocks, extremes, points, factor, last) {
    let most = 1, begin = lower(clocks, scale.min), before = Math.max(0, begin - 1);
    const thin = ctx.lineWidth;
    ctx.beginPath();
    for (let column = 0; column < scale.width; column++) {
        const end = lower(clocks, scale.clock(column + 1));
        most = Math.max(most, end - begin);
        // A value holds until the next step: the one before a column shows in it.
        const [least, greatest] = extremes.of(points ? begin : before, end);
        if (least <= greatest && (end > begin || scale.clock(column) < last)) {
            const [bottom, top] = [least, greatest].map(value => scale.y(value * factor));
            ctx.rect(scale.left + column, top - thin / 2, 1, Math.max(thin, bottom - top + thin));
        }
        before = Math.max(0, end - 1);
        begin = end;
    }
    ctx.fill();
    return most;
}

// A logic level between `base` (low) and `base` + 1. Of a signal, `at(n)` is the clock of edge n, `count(clock)` the number
// of edges before a clock; it is low at first. Returns the most edges in a column.
function drawLevel(ctx, scale, signal, base) {
    const low = scale.y(base), high = scale.y(base + 1), level = n => (n % 2 ? high : low);
    let begin = signal.count(scale.min), most = 1;
    const last = signal.count(scale.max);
    ctx.beginPath();
    ctx.moveTo(scale.left, level(begin));
    if (last - begin < scale.width / 2) {
        for (let n = begin; n < last; n++) {
            const x = scale.x(signal.at(n));
            ctx.lineTo(x, level(n));
            ctx.lineTo(x, level(n + 1));
        }
        ctx.lineTo(scale.left + scale.width, level(last));
        ctx.stroke();
        return most;
    }
    const blocks = new Path2D();
    for (let column = 0; column < scale.width; column++) {
        const end = signal.count(scale.clock(column + 1)), x = scale.left + column;
        most = Math.max(most, end - begin);
        if (end - begin > 1) {
            blocks.rect(x, high, 1, low - high);
            ctx.moveTo(x + 1, level(end));
        } else {
            ctx.lineTo(x, level(begin));
            ctx.lineTo(x + (end > begin ? 0 : 1), level(end));
        }
        begin = end;
    }
    ctx.stroke();
    ctx.save();
    ctx.globalAlpha *= 0.55;
    ctx.fill(blocks);
    ctx.restore();
    return most;
}
