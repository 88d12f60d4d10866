// SPDX-License-Identifier: MIT
// The page to try Passo: lines of the console in, the edges at the pins of the C model out.
"use strict";

const AXES = 4, CLOCKS = [16e6, 72e6, 100e6], LINE_MAX = 4000, ROW_BYTES = 24;
const LINES = Array.from({ length: AXES }, (_, n) => ({ name: `${n}`, per_step: 1 }));
const GCODE = "G-code", CONSOLE = "moves";
const EXAMPLES = {
    "three axes": "move steps=6400,3840,-2560 profile=cosine total_time=0.4 ramp_time=0.2",
    "by speed": "move steps=20000 profile=linear start_speed=400 speed=50000 acceleration=500000 stop_speed=400",
    "there and back": "move steps=3200 profile=sigmoid total_time=0.2 ramp_time=0.08\nmove steps=-3200 profile=sigmoid total_time=0.2 ramp_time=0.08",
};

class Machine {
    static async load(base64) {
        if (typeof WebAssembly === "undefined") throw new Error("this browser has no WebAssembly");
        const bytes = await inflate(base64), machine = new Machine();
        const { module, instance } = await WebAssembly.instantiate(bytes, machine.imports()).then(made => made);
        machine.c = instance.exports;
        machine.module = module;
        machine.c._initialize?.();
        return machine;
    }

    // The C library asks for files and an exit; there are none.
    imports() {
        const none = () => 8;  // errno of a bad file
        const wasi = new Proxy({}, { get: (_, name) => (name === "proc_exit" ? code => { throw new Error(`exit ${code}`); } : none), has: () => true });
        return { wasi_snapshot_preview1: wasi };
    }

    said() {
        const length = this.c.said();
        return new TextDecoder().decode(new Uint8Array(this.c.memory.buffer, this.c.text(), length));
    }

    events() {
        const view = new DataView(this.c.memory.buffer, this.c.rows(), this.c.count() * ROW_BYTES), events = [];
        for (let place = 0; place < view.byteLength; place += ROW_BYTES) {
            const word = n => view.getUint32(place + 8 + 4 * n, true);
            events.push({ clock: view.getFloat64(place, true), step: word(0), dir: word(1), running: word(2) });
        }
        return events;
    }

    // Plays G-code on a machine after reset; returns what is wrong with it, and the events at the pins.
    play(text, numbers) {
        const bytes = new TextEncoder().encode(text), place = this.c.program(bytes.length);
        if (!place) throw new Error("out of memory");
        new Uint8Array(this.c.memory.buffer).set(bytes, place);
        new Float64Array(this.c.memory.buffer, this.c.machine(), numbers.length).set(numbers);
        const bad = this.c.play(), said = this.said();
        const wrong = bad ? `error: ${bad > 0 ? `line ${bad}: ` : ""}${said}` : "";
        return { text: wrong, events: wrong ? [] : this.events() };
    }

    // Executes lines on a core after reset; returns what the console said, and the events at the pins.
    run(lines, axes, hz) {
        if (!this.c.open(axes, hz)) throw new Error("out of memory");
        this.said();
        let text = "";
        for (const line of ["enable", ...lines]) {
            const bytes = new TextEncoder().encode(line + "\n");
            if (bytes.length > LINE_MAX) throw new Error(`a line has more than ${LINE_MAX} bytes`);
            new Uint8Array(this.c.memory.buffer).set(bytes, this.c.line());
            const goes = this.c.type(bytes.length), answer = this.said();
            if (line !== "enable") text += `> ${line}\n${answer}`;
            if (!goes) throw new Error("nothing moves: the motion is held, or waits for sync");
        }
        if (!this.c.wait()) text += "nothing moves: the motion is held, or waits for sync\n";
        text += this.said();
        return { text, events: this.events() };
    }
}

// What the charts need, from the events at the pins. `names` are the axes with their units per step.
function motionOf(events, names, hz, unit) {
    const axes = names.length, starts = events.findIndex(event => event.running);
    if (starts < 0) return null;
    const start = events[starts].clock, edges = Array.from({ length: axes }, () => [[], [], []]);
    const times = [], before = { step: 0, dir: 0, running: 0 };
    for (const { clock, step, dir, running } of events) {
        for (let n = 0; n < axes; n++) {
            const bit = 1 << n;
            if ((step ^ before.step) & bit) edges[n][step & bit ? 0 : 1].push(clock - start);
            if ((dir ^ before.dir) & bit) edges[n][2].push(clock - start);
        }
        if (running !== before.running) times.push({ clock: clock - start, text: running ? "a motion begins" : "the motion ends", kind: "" });
        Object.assign(before, { step, dir, running });
    }
    const used = edges.map((_, n) => n).filter(n => edges[n][0].length || n === 0);
    const own = used.map(n => edges[n].map(list => Float64Array.from(list)));
    const clocks = times[times.length - 1].clock;
    const ended = !before.running;
    const facts = {
        clock_hz: hz, clocks, events: times, alpha_reset: 5, file: "", version: document.body.dataset.version,
        parameters: { channels: 1, axes, tick_log2: 7, line_queue_log2: 8, ramp_queue_log2: 4 },
        runs: [{ channel: 0, start: 0, clocks, unit, plans: [], pins: null }],
        axes: used.map(n => ({ run: 0, axis: n, ...names[n] })),
        summary: {
            name: "Try Passo", outcome: ended ? "complete" : "stopped", verdict: ended ? "done" : "the motion has not ended", engine: "model", matched_edges: null, moves: [],
            axes: own.map(([rises]) => ({ pulses: rises.length })),
        },
    };
    return new Motion(facts, [own, []]);
}

function machineText({ axes, clock_hz, numbers }) {
    const limits = axes.map(({ name, speed, per_step }) => `${name} ${plain(1 / per_step)} steps/mm, ${plain(speed)} mm/s`).join("; ");
    return `On examples/gcode/machine.toml: ${limits}; junction deviation ${plain(numbers[2])} mm; ${clock_hz / 1e6} MHz.`;
}

async function openWeb() {
    chooseTheme();
    const main = document.querySelector("main"), form = element(main, "section", "panel");
    main.prepend(form);
    const facts = JSON.parse(document.getElementById("machine").textContent);
    element(form, "p", "hint", "Type moves as on the console of the board, or G-code. The C model of the core, the planner and the firmware run in this page; every edge below left its pins.");
    const lines = element(form, "textarea", "lines");
    lines.rows = 4;
    lines.spellcheck = false;
    lines.value = EXAMPLES["three axes"];
    const bar = element(form, "p", "bar"), language = element(bar, "select", "language"), clock = element(bar, "select");
    for (const name of [CONSOLE, GCODE]) element(language, "option", "", name);
    for (const hz of CLOCKS) element(clock, "option", "", `${hz / 1e6} MHz`).value = hz;
    const go = element(bar, "button", "go", "run"), machineLine = element(form, "p", "hint", machineText(facts));
    language.onchange = () => {
        clock.hidden = language.value === GCODE;
        machineLine.hidden = !clock.hidden;
        lines.rows = clock.hidden ? 12 : 4;
    };
    language.onchange();
    const example = (name, text, kind) => {
        element(bar, "button", "", name).onclick = () => {
            lines.value = text;
            language.value = kind;
            language.onchange();
            go.click();
        };
    };
    for (const [name, text] of Object.entries(EXAMPLES)) example(name, text, CONSOLE);
    example("a part in G-code", facts.program, GCODE);
    const answer = element(form, "pre", "answer");
    try {
        const machine = await Machine.load(document.getElementById("wasm").textContent);
        const runLines = () => {
            const hz = Number(clock.value), own = lines.value.split("\n").map(line => line.trim()).filter(Boolean);
            const { text, events } = machine.run(own, AXES, hz);
            return { text, motion: motionOf(events, LINES, hz, "steps") };
        };
        const playGcode = () => {
            const { text, events } = machine.play(lines.value, facts.numbers);
            return { text, motion: motionOf(events, facts.axes, facts.clock_hz, "mm") };
        };
        go.onclick = () => {
            try {
                const { text, motion } = language.value === GCODE ? playGcode() : runLines();
                answer.textContent = text;
                const wrong = text.split("\n").filter(line => line.startsWith("error"));
                if (motion) showMotion(motion);
                if (wrong.length || !motion) {
                    const verdict = document.getElementById("verdict");
                    verdict.textContent = wrong.join("; ") || "nothing moved";
                    verdict.className = wrong.length ? "bad" : "stopped";
                }
            } catch (error) {
                showFailure(error);
            }
        };
        go.click();
    } catch (error) {
        showFailure(error);
    }
}
