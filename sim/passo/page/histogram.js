// SPDX-License-Identifier: MIT
// Beside the charts over time: the histogram of the timing error.
"use strict";

const BINS = 61;

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
