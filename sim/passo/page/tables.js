// SPDX-License-Identifier: MIT
// The tables of a page: events, moves, axes, settings.
"use strict";

function addTable(parent, title, columns, rows, { open = true } = {}) {
    const panel = element(parent, "details", "panel");
    panel.open = open;
    element(panel, "summary", "", title);
    const table = element(element(panel, "div", "scroll"), "table");
    const head = element(element(table, "thead"), "tr");
    for (const column of columns) element(head, "th", "", column);
    const body = element(table, "tbody");
    for (const { cells, kind = "", show } of rows) {
        const row = element(body, "tr", kind);
        for (const cell of cells) element(row, "td", typeof cell === "number" ? "number" : "", typeof cell === "number" ? plain(cell, 12) : cell);
        if (show) {
            row.classList.add("link");
            row.tabIndex = 0;
            row.onclick = show;
            row.onkeydown = event => event.key === "Enter" && show();
        }
    }
    return panel;
}

const pinTimes = ({ pins }, hz) => [pins.step_high, pins.step_low, pins.dir_setup, pins.dir_hold].map(clocks => `${grouped(clocks)} clk, ${duration(clocks, hz, 4)}`);
const PIN_TIMES = ["STEP high", "STEP low", "DIR setup", "DIR hold"];

// Moves as planned, and what came out.
function addPlans(parent, view) {
    const { facts, hz, axes } = view.motion, { summary } = facts;
    const moves = facts.runs.flatMap(run => {
        let begin = run.start;
        return run.plans.map(plan => {
            const from = begin, clocks = plan.ramps.reduce((sum, [ticks]) => sum + ticks, 0) * plan.tick;
            begin += clocks;
            return { run, plan, from, clocks };
        });
    });
    addTable(parent, `Moves (${moves.length})`, ["move", "steps", "profile", "starts at", "takes", "peak, longest axis", "substeps a step"],
        moves.map(({ run, plan, from, clocks }, n) => ({
            cells: [
                facts.runs.length > 1 ? `${plan.number}, channel ${run.channel}` : `${plan.number}`, plan.steps.map(grouped).join(", "), plan.profile,
                duration(from, hz), duration(clocks, hz), `${plain(summary.moves[n]?.peak_speed ?? NaN, 7)} steps/s`, summary.moves[n]?.oversampling ?? "–",
            ],
            show: () => view.set(from - 0.02 * clocks, from + 1.02 * clocks),
        })), { open: moves.length <= 40 }).id = "moves";

    addTable(parent, "Axes", ["axis", "steps commanded", "steps made (sum)", "pulses", "position of the core", "largest error, steps", ...PIN_TIMES],
        summary.axes.map((own, n) => ({
            cells: [axes[n].name, own.commanded, own.emitted, own.pulses, own.position, plain(own.largest_error_steps, 3), ...pinTimes(axes[n].motion, hz)],
        }))).id = "axes";
}

// Motions, homes, probes and threads of a move file with a machine.
function addScene(parent, view) {
    const { facts: { summary }, hz, axes } = view.motion;
    const figures = own => (own.phase_counts === undefined ? "" : `within ${plain(own.largest_distance_counts, 3)} counts of the pitch, phase ${own.phase_counts} counts`);
    addTable(parent, `Moves (${summary.moves.length})`, ["moves", "kind", "starts at", "takes", "steps asked", "steps made", "result", "thread"], summary.moves.map(own => ({
        cells: [own.numbers.join(", "), own.kind, duration(own.start_clock, hz), duration(own.end_clock - own.start_clock, hz), own.steps_asked ?? "–", own.steps_made ?? "–", own.result, figures(own)],
        show: () => view.set(1.02 * own.start_clock - 0.02 * own.end_clock, 1.02 * own.end_clock - 0.02 * own.start_clock),
    }))).id = "moves";
    addTable(parent, "Axes", ["axis", "steps made (sum)", "pulses", "position of the driver", "position of the machine", ...PIN_TIMES], summary.axes.map((own, n) => ({
        cells: [axes[n].name, own.emitted, own.pulses, own.position, own.machine_position, ...pinTimes(axes[n].motion, hz)],
    }))).id = "axes";
    if (summary.energy.length) {
        addTable(parent, "Energy per step, less the wanted one", ["move", "windows", "least", "most", "whole move"], summary.energy.map(own => ({
            cells: [own.number, own.windows, ...[own.least_percent, own.most_percent, own.whole_percent].map(value => `${plain(value ?? NaN, 3)} %`)],
        }))).id = "energy";
    }
    if (summary.encoders.length) {
        addTable(parent, "Encoders", ["axis", "samples", "largest error, steps", "rms", "greatest following error"], summary.encoders.map(own => ({
            cells: [own.axis, own.samples, ...[own.largest_error_steps, own.rms_error_steps, own.greatest_following_error_steps].map(value => plain(value ?? NaN, 3))],
        }))).id = "encoders";
    }
}

function addTables(parent, view) {
    const { facts, hz } = view.motion, { summary } = facts;
    const near = clock => () => view.set(clock - hz / 2000, clock + hz / 2000);
    addTable(parent, `Events and faults (${facts.events.length})`, ["time", "clock", "event"], facts.events.map(event => ({
        cells: [duration(event.clock, hz, 9), event.clock, event.text], kind: event.kind, show: near(event.clock),
    }))).id = "events";

    if (view.motion.machine) addScene(parent, view);
    else addPlans(parent, view);

    const settings = [
        ["move file", facts.file], ["engine", summary.matched_edges !== null ? "RTL and C model, compared edge for edge" : { rtl: "RTL", model: "C model" }[summary.engine] ?? summary.engine],
        ["clock", `${grouped(hz)} Hz`], ["tick", `${grouped(1 << facts.parameters.tick_log2)} clocks`],
        ["core", `${facts.parameters.channels} × ${facts.parameters.axes} axes, queues of ${1 << facts.parameters.line_queue_log2} lines and ${1 << facts.parameters.ramp_queue_log2} ramps`],
        ["Passo", facts.version],
    ];
    addTable(parent, "Settings", ["", ""], settings.map(cells => ({ cells }))).id = "settings";
}
