// SPDX-License-Identifier: MIT
// Times on axes and in texts: clocks in, seconds with a fitting unit out.
"use strict";

const UNITS = [["s", 1], ["ms", 1e-3], ["µs", 1e-6], ["ns", 1e-9]];

function unitOf(seconds) {
    return UNITS.find(([, size]) => Math.abs(seconds) >= 0.9999 * size) || UNITS[UNITS.length - 1];
}

const grouped = number => number.toLocaleString("en-US", { maximumFractionDigits: 3 });

// At most `digits` significant digits, without exponents for the usual sizes.
function plain(number, digits = 5) {
    if (!isFinite(number)) return "–";
    const size = Math.abs(number);
    if (size && size < 1e-4) return number.toExponential(2);
    return Number(number.toPrecision(digits)).toLocaleString("en-US", { maximumFractionDigits: 9 });
}

function duration(clocks, hz, digits = 6) {
    const seconds = clocks / hz, [unit, size] = unitOf(seconds);
    return seconds ? `${plain(seconds / size, digits)} ${unit}` : "0 s";
}

// The ticks of a time axis: 1, 2 or 5 times a power of ten seconds, not closer than a clock.
function timeTicks(min, max, hz, room) {
    const wanted = Math.max((max - min) / hz / Math.max(2, room), 1 / hz);
    const power = 10 ** Math.floor(Math.log10(wanted) + 1e-9);
    const step = [1, 2, 5, 10].find(factor => factor * power >= wanted * 0.9999) * power;
    const ticks = [];
    for (let n = Math.ceil(min / hz / step - 1e-9); n * step * hz <= max; n++) ticks.push(n * step * hz);
    const [unit, size] = unitOf((max - min) / hz / 2);
    // Far from zero, long numbers are split: a base in the label, the rest at the ticks.
    const grain = 10 ** Math.ceil(Math.log10((max - min) / hz) + 1e-9);
    const base = Math.abs(max) / hz >= 100 * grain ? Math.floor(min / hz / grain + 1e-9) * grain : 0;
    const digits = Math.max(0, -Math.floor(Math.log10(step / size) + 1e-9));
    const places = Math.max(0, Math.min(12, -Math.floor(Math.log10(grain) + 1e-9)));
    return {
        ticks,
        texts: ticks.map(tick => ((tick / hz - base) / size).toFixed(Math.min(digits, 6))),
        label: base ? `${unit} after ${base.toFixed(places)} s` : unit,
    };
}
