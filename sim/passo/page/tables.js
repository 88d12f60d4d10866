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

function addTables(parent, view) {
    const { facts, hz, axes } = view.motion, { summary } = facts;
    const near = clock => () => view.set(clock - hz / 2000, clock + hz / 2000);
    addTable(parent, `Events and faults (${facts.events.length})`, ["time", "clock", "event"], facts.events.map(event => ({
        cells: [duration(event.clock, hz, 9), event.clock, event.text], kind: event.kind, show: near(event.clock),
    }))).id = "events";

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

    addTable(parent, "Axes", ["axis", "steps commanded", "steps made (sum)", "pulses", "position at the end", "largest error, steps", "STEP high", "STEP low", "DIR setup", "DIR hold"],
        summary.axes.map((own, n) => {
            const pins = axes[n].motion.pins, time = clocks => `${grouped(clocks)} clk, ${duration(clocks, hz, 4)}`;
            return { cells: [axes[n].name, own.commanded, own.emitted, own.pulses, own.position, plain(own.largest_error_steps, 3),
                time(pins.step_high), time(pins.step_low), time(pins.dir_setup), time(pins.dir_hold)] };
        })).id = "axes";

    const settings = [
        ["move file", facts.file], ["engine", { both: "RTL and C model, compared edge for edge", rtl: "RTL", model: "C model" }[summary.engine] ?? summary.engine],
        ["clock", `${grouped(hz)} Hz`], ["tick", `${grouped(1 << facts.parameters.tick_log2)} clocks`],
        ["core", `${facts.parameters.channels} × ${facts.parameters.axes} axes, queues of ${1 << facts.parameters.line_queue_log2} lines and ${1 << facts.parameters.ramp_queue_log2} ramps`],
        ["Passo", facts.version],
    ];
    addTable(parent, "Settings", ["", ""], settings.map(cells => ({ cells }))).id = "settings";
}
