// SPDX-License-Identifier: MIT
// The worker of the page: the core, its planner and its console as WebAssembly. It works in slices, between which it
// hears the page, and answers with motions whose arrays move without being copied.
//
// In: {kind: "load", module, rules}, {kind: "python", packed}, {kind: "play", files, machine, tools, map}, {kind: "type", lines, hz},
//     {kind: "expand", name, files, machine, tools, map}, {kind: "csv"}, {kind: "report"}, {kind: "cancel"}
//     files: {name, text, plays, expands}, as of inTurn(); expands: plain lines of it are played
// Out: {kind: "ready"}, {kind: "progress", share, seconds}, {kind: "progress", doing}, {kind: "result", text, wrong, motion},
//      {kind: "expanded", said, wrong} or {.., lines, places}, {kind: "csv", blob}, {kind: "report", facts, edges}, {kind: "failure", text}
"use strict";

const AXES = 4, LISTS = 3;  // of the console's core; lists of edges per axis
const RUNNING = 8 * LISTS;
const DONE = 0, GOES_ON = 1, SLOW = -2;
const SLICE = 40, TURNS = 16;  // ms between two looks at messages; turns of the main loop in one call
const LINE_MAX = 4000;  // bytes
const SEVERAL = Array.from({ length: AXES }, (_, n) => ({ name: `${n}`, per_step: 1 }));

let canceled = false;

const breathe = () => new Promise(resolve => setTimeout(resolve));
const encoded = text => new TextEncoder().encode(text);

class Core {
    // The C library asks for files and an exit; there are none.
    static async load(bytes) {
        const badFile = () => 8;
        const wasi = new Proxy({}, { get: (_, name) => (name === "proc_exit" ? code => { throw new Error(`exit ${code}`); } : badFile), has: () => true });
        const { instance } = await WebAssembly.instantiate(bytes, { wasi_snapshot_preview1: wasi });
        const core = new Core();
        core.c = instance.exports;
        core.c._initialize?.();
        return core;
    }

    put(bytes, place) {
        if (!place) throw new Error("out of memory");
        new Uint8Array(this.c.memory.buffer).set(bytes, place);
    }

    said() {
        const length = this.c.said();
        return new TextDecoder().decode(new Uint8Array(this.c.memory.buffer, this.c.text(), length));
    }

    // Clocks of edges since reset: a copy.
    list(number) {
        const count = this.c.count(number);
        return new Float64Array(this.c.memory.buffer, this.c.clocks(number), count).slice();
    }

    // Calls `step` until it does not go on or is canceled; `share` of 0 to 1 is done.
    async through(step, hz, share = () => NaN) {
        let status = GOES_ON;
        while (status === GOES_ON && !canceled) {
            const end = performance.now() + SLICE;
            while (status === GOES_ON && performance.now() < end) status = step();
            postMessage({ kind: "progress", share: share(), seconds: this.c.clock() / hz });
            await breathe();
        }
        return status;
    }

    // What is wrong with the lines of programs, a sentence each, behind `others`: pairs of a program's number and a
    // sentence.
    refusals(programs, machine, others = []) {
        const count = this.c.refused() + others.length, told = this.said().split("\n").filter(Boolean);
        const advice = new Advice(this.rules, machine, line => {
            const bytes = encoded(line);
            this.put(bytes, this.c.room(bytes.length));
            return this.c.tries();
        });
        const refused = told.map(line => {
            const [, file, number, error, code] = /^(\d+):(\d+): ((?:error:(\d+))?.*)/.exec(line), program = programs[file];
            const text = code ? advice.explain(Number(code), error, program.lines[number - 1]) : advice.noProbe(error, program.lines[number - 1]);
            return [Number(file), `${program.at(Number(number))}: ${text}`];
        });
        const shown = [...others, ...refused].sort(([a], [b]) => a - b).slice(0, this.rules.most).map(([, text]) => text);
        const more = count - shown.length;
        return more > 0 ? [...shown, `and ${more} more lines`] : shown;
    }

    // Checks programs of these files one after the other, each from where the one before ends, on a machine (struct
    // web_machine), expanded where they need that. Returns the texts of PRINT, the programs, and what is wrong.
    read(files, playing, machine, tools, map) {
        this.said();
        new Float64Array(this.c.memory.buffer, this.c.machine(), machine.numbers.length).set(machine.numbers);
        this.c.reset();
        const programs = [], said = [], wrong = [], texts = () => wrong.map(([, text]) => text);
        for (const { name, text, expands } of playing) {
            const own = expands ? this.python.expand(name, files, machine, tools, programs.length && this.c.gcode(), map) : { said: [], lines: null };
            said.push(...own.said);
            if (own.wrong) wrong.push(...own.wrong.split("\n").map(sentence => [programs.length, sentence]));
            if (own.wrong && !own.lines) return { said, programs, wrong: texts() };
            const whole = own.lines ? own.lines.join("\n") : text, lines = own.lines ?? text.split(/\r\n|\r|\n/);
            if (files.length > 1 && !own.wrong && !lines.some(line => Advice.bare(line))) return { said, programs, wrong: [...texts(), `${name}: the file has no G-code`] };
            const at = n => own.places?.[n - 1] ?? (files.length > 1 ? `${name}:${n}` : `line ${n}`);
            const bytes = encoded(whole.endsWith("\n") ? whole : `${whole}\n`);
            this.put(bytes, this.c.room(bytes.length));
            if (!this.c.add()) return { said, programs, wrong: [...texts(), "there are too many files"] };
            programs.push({ lines, at, kept: this.c.kept(programs.length) });
        }
        return { said, programs, wrong: wrong.length ? this.refusals(programs, machine, wrong) : [] };
    }

    // The plain lines of one of several programs, where each is from, and the texts of PRINT; or what is wrong.
    expanded(name, files, machine, tools, map) {
        const before = files.slice(0, files.findIndex(file => file.name === name)).filter(file => file.plays);
        const { programs, wrong } = this.read(files, before, machine, tools, map);
        return wrong.length ? { said: [], wrong: wrong.join("\n") } : this.python.expand(name, files, machine, tools, programs.length && this.c.gcode(), map);
    }

    // Plays G-code on a machine after reset. Returns what it said, what is wrong with it, and a motion or null.
    async play(files, machine, tools, map) {
        const { said, programs, wrong } = this.read(files, files.filter(file => file.plays), machine, tools, map);
        const played = wrong.length ? { wrong, motion: null } : await this.playRead(programs, machine);
        const unread = wrong.length ? 0 : this.c.unread(), more = unread ? [`${unread} lines behind the end of the program are not read`] : [];
        return { ...played, text: said.length + more.length ? [...said, ...more, ...played.wrong].join("\n") : "" };
    }

    async playRead(programs, machine) {
        const { motors, clock_hz } = machine;
        if (this.c.refused()) return { wrong: this.refusals(programs, machine), motion: null };
        const at = taken => {
            let rest = taken, number = 0;
            while (rest > programs[number].kept && number + 1 < programs.length) rest -= programs[number++].kept;
            return programs[number].at(rest);
        };
        let status = this.c.begin();
        const whole = Math.max(1, this.c.length());
        if (status === GOES_ON) status = await this.through(() => this.c.go(TURNS), clock_hz, () => this.c.taken_bytes() / whole);
        const said = status === SLOW ? this.slow(machine) : this.said().trim(), blamed = this.c.blamed();
        if (status !== DONE && status !== GOES_ON) return { wrong: [blamed ? `${at(blamed)}: ${said}` : said], motion: null };
        return { wrong: [], motion: this.motion(motors, clock_hz, "mm", status === DONE ? "" : `canceled at ${at(this.c.taken())}`) };
    }

    // The spindle was not at its speed in time.
    slow({ spindle: [wait, input] }) { return this.rules.slow.replace("{input}", input).replace("{seconds}", wait); }

    // Executes lines of the console on a core after reset. Returns what it said, and a motion or null.
    async type(lines, hz) {
        if (!this.c.open(AXES, hz)) throw new Error("out of memory");
        this.said();
        let text = "", status = DONE;
        for (const line of ["enable", ...lines]) {
            const bytes = encoded(line + "\n");
            if (bytes.length > LINE_MAX) throw new Error(`a line has more than ${LINE_MAX} bytes`);
            this.put(bytes, this.c.line());
            this.c.type(bytes.length);
            status = await this.through(() => this.c.answer(TURNS), hz);
            const answer = this.said();
            if (line !== "enable") text += `> ${line}\n${answer}`;
            if (status !== DONE) break;
        }
        if (status === DONE) status = await this.through(() => this.c.wait(TURNS), hz);
        if (status !== DONE && status !== GOES_ON) text += "error: nothing moves: the motion is held, or waits for sync\n";
        text += this.said();
        return { text, wrong: text.split("\n").filter(line => line.startsWith("error")), motion: this.motion(SEVERAL, hz, "steps", status === GOES_ON ? "canceled" : "") };
    }

    // What the charts need, or null if nothing has moved. `names` are the axes with their units per step.
    motion(names, hz, unit, stopped) {
        const running = this.list(RUNNING), start = running[0];
        if (!running.length) return null;
        const since = list => {
            for (let i = 0; i < list.length; i++) list[i] -= start;
            return list;
        };
        const used = names.map((_, n) => n).filter(n => n === 0 || this.c.count(LISTS * n));
        const edges = used.map(n => [0, 1, 2].map(kind => since(this.list(LISTS * n + kind))));
        const times = Array.from(since(running));
        const ended = running.length % 2 === 0, clocks = ended ? times[times.length - 1] : this.c.clock() - start;
        const facts = {
            clock_hz: hz, clocks, alpha_reset: 5, file: "", parameters: {},
            events: times.map((clock, n) => ({ clock, text: n % 2 ? "the motion ends" : "a motion begins", kind: "" })),
            runs: [{ channel: 0, start: 0, clocks, unit, plans: [], pins: null }],
            axes: used.map(n => ({ run: 0, axis: n, ...names[n] })),
            summary: {
                name: "Try Passo", outcome: ended && !stopped ? "complete" : "stopped",
                verdict: stopped || (ended ? "done" : "the motion has not ended"), engine: "model", matched_edges: null, moves: [],
                axes: edges.map(([rises]) => ({ pulses: rises.length })),
            },
        };
        this.facts = facts;
        return new Motion(facts, [edges, []]);
    }
}

// The last motion for a report page, as page_data() of sim/passo/report_data.py.
async function reportOf(core) {
    const start = core.list(RUNNING)[0], streams = [];
    const axes = core.facts.axes.map(own => {
        const edges = [0, 1, 2].map(kind => core.list(LISTS * own.axis + kind).map(clock => clock - start));
        streams.push(...packed(edges));
        return { ...own, edges: edges.map(list => list.length) };
    });
    const bytes = await through(new Blob(streams), new CompressionStream("deflate"));
    return { facts: { ...core.facts, axes }, edges: toBase64(bytes) };
}

// The streams of an axis: varints in zigzag, the inverse of unpack().
function packed([rises, falls, turns]) {
    const differences = list => list.map((value, i) => value - (i ? list[i - 1] : 0));
    return [differences(differences(rises)), differences(falls.map((clock, i) => clock - rises[i])), differences(turns)].map(varints);
}

function varints(numbers) {
    const bytes = new Uint8Array(8 * numbers.length);
    let at = 0;
    for (const number of numbers) {
        let rest = number < 0 ? -2 * number - 1 : 2 * number;
        for (; rest > 127; rest = Math.floor(rest / 128)) bytes[at++] = rest % 128 + 128;
        bytes[at++] = rest;
    }
    return bytes.subarray(0, at);
}

// The rows of pulses.csv as `passo run` writes them: clocks since the start of the first motion.
function csvOf(core) {
    const start = core.list(RUNNING)[0] ?? 0, axes = [];
    for (let n = 0; n < 8; n++) {
        const [rises, turns] = [core.list(LISTS * n), core.list(LISTS * n + 2)];
        if (rises.length) axes.push({ n, rises, turns, at: 0, turn: 0 });
    }
    const parts = ["clock,axis,direction\n"];
    let text = "";
    for (;;) {
        const next = axes.reduce((first, own) => (own.at < own.rises.length && !(first && first.rises[first.at] <= own.rises[own.at]) ? own : first), null);
        if (!next) break;
        const clock = next.rises[next.at++];
        while (next.turn < next.turns.length && next.turns[next.turn] <= clock) next.turn++;
        text += `${clock - start},${next.n},${next.turn % 2 ? -1 : 1}\n`;
        if (text.length > 1e6) {
            parts.push(text);
            text = "";
        }
    }
    return new Blob([...parts, text], { type: "text/csv" });
}

function buffersOf(value, found = new Set()) {
    if (ArrayBuffer.isView(value)) found.add(value.buffer);
    else if (value && typeof value === "object") Object.values(value).forEach(part => buffersOf(part, found));
    return found;
}

let core = null;
const answers = {
    async load({ module, rules }) {
        core = await Core.load(module);
        core.rules = rules;
        return { kind: "ready" };
    },
    async python({ packed }) {
        core.python = await Python.load(packed, core.c);
        return { kind: "ready" };
    },
    async play({ files, machine, tools, map }) {
        if (files.some(file => file.plays && file.expands)) postMessage({ kind: "progress", doing: "expanding the program" });
        return { kind: "result", ...await core.play(files, machine, tools, map) };
    },
    type: async ({ lines, hz }) => ({ kind: "result", ...await core.type(lines, hz) }),
    expand: async ({ name, files, machine, tools, map }) => ({ kind: "expanded", ...core.expanded(name, files, machine, tools, map) }),
    report: async () => ({ kind: "report", ...await reportOf(core) }),
    csv: async () => ({ kind: "csv", blob: csvOf(core) }),
};

onmessage = async ({ data }) => {
    canceled = data.kind === "cancel";
    if (canceled) return;
    try {
        const answer = await answers[data.kind](data);
        postMessage(answer, [...buffersOf(answer.motion)]);
    } catch (error) {
        postMessage({ kind: "failure", text: error.message });
    }
};
