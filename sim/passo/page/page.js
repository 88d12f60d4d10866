// SPDX-License-Identifier: MIT
// Puts a page together. `passo` is what runs in it: motion, view, errors, histogram.
"use strict";

let passo = null;

async function inflate(base64) {
    if (typeof DecompressionStream === "undefined") throw new Error("this browser is too old: it has no DecompressionStream");
    const packed = Uint8Array.from(atob(base64), letter => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

function chooseTheme() {
    const dark = matchMedia("(prefers-color-scheme: dark)");
    const apply = name => {
        document.documentElement.dataset.theme = name;
        passo?.view.changed();
    };
    apply(dark.matches ? "dark" : "light");
    dark.addEventListener("change", () => apply(dark.matches ? "dark" : "light"));
    document.getElementById("theme").onclick = () => apply(theme() === "dark" ? "light" : "dark");
}

function addSummary(motion) {
    const { facts, hz } = motion, { summary } = facts;
    document.getElementById("name").textContent = summary.name;
    const verdict = document.getElementById("verdict");
    verdict.textContent = summary.verdict;
    verdict.className = { complete: "good", stopped: "stopped" }[summary.outcome] ?? "bad";
    const tiles = document.getElementById("tiles");
    tiles.textContent = "";
    const tile = (value, text) => {
        const box = element(tiles, "div", "tile");
        element(box, "b", "", value);
        element(box, "span", "", text);
    };
    tile(grouped(summary.axes.reduce((sum, axis) => sum + axis.pulses, 0)), "steps");
    tile(duration(facts.clocks, hz), `${grouped(facts.clocks)} clocks at ${plain(hz / 1e6)} MHz`);
    tile(`${motion.axes.length}`, facts.runs.length > 1 ? `axes on ${facts.runs.length} channels` : motion.axes.length > 1 ? "axes" : "axis");
    if (summary.matched_edges !== null) tile(grouped(summary.matched_edges), "edges equal in RTL and C model");
    if (motion.planned && summary.axes.some(axis => axis.pulses)) tile(plain(Math.max(0, ...summary.axes.map(axis => axis.largest_error_steps)), 2), "steps, largest timing error");
}

function addToolbar(bar, view) {
    const { motion } = view, { hz } = motion;
    bar.textContent = "";
    motion.axes.forEach((axis, n) => {
        const button = element(bar, "button", "axis on", `axis ${axis.name}`);
        button.onclick = () => {
            view.toggle(n);
            button.classList.toggle("on", !view.hidden.has(n));
        };
        view.listeners.push({ update: () => button.style.setProperty("--own", colorOf(n)) });
    });
    const button = (text, hint, action) => {
        const made = element(bar, "button", "", text);
        made.title = hint;
        made.onclick = action;
        return made;
    };
    element(bar, "span", "gap");
    const steps = motion.axes.filter(axis => axis.rises.length);
    const first = Math.min(...steps.map(axis => axis.rises[0])), last = Math.max(...steps.map(axis => axis.rises[axis.rises.length - 1]));
    button("all", "the whole motion (double click, 0)", () => view.all());
    button("+", "closer (+)", () => view.zoom(0.5));
    button("−", "wider (−)", () => view.zoom(2));
    button("◀", "back (left arrow)", () => view.pan(-0.5));
    button("▶", "on (right arrow)", () => view.pan(0.5));
    if (steps.length) {
        button("first step", "the first pulse, clock by clock", () => view.set(first - 20, first + 100));
        button("last step", "the last pulse, clock by clock", () => view.set(last - 20, last + 100));
    }
    const range = element(bar, "span", "range");
    view.listeners.push({
        update() {
            range.textContent = `${duration(view.max - view.min, hz, 4)} shown = ${grouped(Math.round(view.max - view.min))} clocks from clock ${grouped(Math.round(view.min))}`;
        },
    });
    const keys = { "+": () => view.zoom(0.5), "-": () => view.zoom(2), 0: () => view.all(), ArrowLeft: () => view.pan(-0.25), ArrowRight: () => view.pan(0.25) };
    document.onkeydown = event => {
        if (!keys[event.key] || event.ctrlKey || event.altKey || /INPUT|SELECT|TEXTAREA/.test(event.target.tagName)) return;
        event.preventDefault();
        keys[event.key]();
    };
}

function showMotion(motion) {
    addSummary(motion);
    const [charts, side, tables] = ["charts", "side", "tables"].map(id => document.getElementById(id));
    for (const part of [charts, side, tables]) part.textContent = "";
    const view = new View(motion), { facts } = motion;
    document.getElementById("curves").hidden = !motion.planned;
    addToolbar(document.getElementById("toolbar"), view);
    addMotionCharts(charts, view);
    addPins(charts, view);
    addMachine(charts, view);
    const errors = motion.planned ? addErrors(charts, view) : null;
    const histogram = errors && new Histogram(side, view, errors);
    const path = motion.axes.length > 1 ? new ToolPath(side, view) : null;
    if (facts.file) addTables(tables, view);
    passo = { motion, view, errors, histogram, path };
    view.changed();
}

function showFailure(error) {
    const verdict = document.getElementById("verdict");
    verdict.textContent = `This page cannot be shown: ${error.message}`;
    verdict.className = "bad";
}

async function openReport() {
    try {
        const facts = JSON.parse(document.getElementById("facts").textContent);
        chooseTheme();
        const bytes = await inflate(document.getElementById("edges").textContent);
        showMotion(new Motion(facts, unpack(bytes, facts.axes, facts.machine?.signals)));
        requestAnimationFrame(() => requestAnimationFrame(() => { passo.ready = performance.now(); }));
    } catch (error) {
        showFailure(error);
    }
}
