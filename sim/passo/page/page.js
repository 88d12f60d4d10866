// SPDX-License-Identifier: MIT
// Puts a page together. `passo` is what runs in it: motion, view, errors, histogram.
"use strict";

let passo = null;

async function inflate(base64) {
    if (typeof DecompressionStream === "undefined") throw new Error("this browser is too old: it has no DecompressionStream");
    return through(new Blob([fromBase64(base64)]), new DecompressionStream("deflate"));
}

function chooseTheme() {
    const dark = matchMedia("(prefers-color-scheme: dark)");
    const apply = name => {
        document.documentElement.dataset.theme = name;
        for (const view of passo?.views ?? []) view.changed();
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

function addToolbar(bar, view, player) {
    const { motion } = view, { hz } = motion;
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
    const keys = { "+": () => view.zoom(0.5), "-": () => view.zoom(2), 0: () => view.all(), ArrowLeft: () => view.pan(-0.25), ArrowRight: () => view.pan(0.25), " ": () => player.toggle() };
    document.onkeydown = event => {
        const typed = event.key === " " ? /INPUT|SELECT|TEXTAREA|BUTTON|SUMMARY|TR/ : /INPUT|SELECT|TEXTAREA/;
        if (!keys[event.key] || event.ctrlKey || event.altKey || typed.test(event.target.tagName)) return;
        event.preventDefault();
        keys[event.key]();
    };
}

const PARTS = ["charts", "side", "tables"];

function clearMotion() {
    passo?.player.stop();
    passo?.views.forEach(view => view.close());
    passo = null;
    for (const id of [...PARTS, "tiles", "toolbar"]) document.getElementById(id).textContent = "";
}

// The largest values along the path, of several motions.
function scalesOf(views) {
    const most = list => list.reduce((sum, value) => Math.max(sum, Math.abs(value)), 0);
    const courses = views.map(view => view.course).filter(course => course.unit);
    return { speed: most(courses.map(course => course.fastest)), acceleration: Math.max(0, ...courses.map(course => most(course.acceleration))) };
}

const pause = () => new Promise(resolve => setTimeout(resolve));

// Shows a motion, or several beside each other at the same time, each with its `title`; pauses for the browser to paint.
async function showMotions(motions, titles = []) {
    clearMotion();
    addSummary(motions[0]);
    const [charts, side, tables] = PARTS.map(id => document.getElementById(id));
    const views = motions.map(motion => new View(motion));
    View.join(views);
    document.getElementById("curves").hidden = !motions[0].planned;
    const bar = document.getElementById("toolbar"), player = new Player(bar, views);
    addToolbar(bar, views[0], player);
    await pause();
    const scales = scalesOf(views), several = views.length > 1;
    charts.classList.toggle("several", several);
    const shown = [];
    for (const [n, view] of views.entries()) {
        const { motion } = view, column = element(charts, "div", "column"), beside = several || !motion.planned ? column : side;
        if (several) element(column, "h2", "title", titles[n]);
        await pause();
        const path = motion.axes.length > 1 ? new ToolPath(beside, view) : null;
        await pause();
        if (!motion.planned) addCourse(column, view, scales);
        await pause();
        addMotionCharts(column, view);
        await pause();
        addPins(column, view);
        addMachine(column, view);
        const errors = motion.planned ? addErrors(column, view) : null;
        shown.push({ motion, view, errors, histogram: errors && new Histogram(side, view, errors), path });
        await pause();
    }
    if (motions[0].facts.file) addTables(tables, views[0]);
    passo = { ...shown[0], views, player, shown };
    for (const view of views) view.changed();
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
        await showMotions([new Motion(facts, unpack(bytes, facts.axes, facts.machine?.signals))]);
        const wait = () => (passo.view.isDrawn ? (passo.ready = performance.now()) : requestAnimationFrame(wait));
        wait();
    } catch (error) {
        showFailure(error);
    }
}
