// SPDX-License-Identifier: MIT
// The page to try Passo: moves or G-code in, the edges at the pins of the C model out.
"use strict";

const CLOCKS = [16e6, 72e6, 100e6];
const GCODE = "G-code", CONSOLE = "moves";
const PROGRAM = "program";  // name of what is typed
// Characters of a program that can be edited, and of the beginning that is shown of a longer one: the browser lays them out in one task.
const EDITED = 40000, SHOWN = 8000;
const PROFILES = ["linear", "cosine", "sigmoid", "jerk"], PROFILE = 4;  // its place in `struct web_machine`
const LONG_LINK = 32000;
const EXAMPLES = {
    "three axes": "move steps=6400,3840,-2560 profile=cosine total_time=0.4 ramp_time=0.2",
    "by speed": "move steps=20000 profile=linear start_speed=400 speed=50000 acceleration=500000 stop_speed=400",
    "there and back": "move steps=3200 profile=sigmoid total_time=0.2 ramp_time=0.08\nmove steps=-3200 profile=sigmoid total_time=0.2 ramp_time=0.08",
};

let web = null;  // what runs in the page: the form

const by = id => document.getElementById(id);

function machineText({ letters, clock_hz, motors, numbers }) {
    const limits = motors.map(({ name, per_step }) => `${name} ${plain(1 / per_step)} steps/mm`).join(", ");
    return `Machine: axes ${[...letters].join(" ")}; ${limits}; junction deviation ${plain(numbers[2])} mm; ${clock_hz / 1e6} MHz.`;
}

// A machine file with other bytes would be another one.
async function textOf(file) {
    try {
        return new TextDecoder("utf-8", { fatal: true }).decode(await file.arrayBuffer());
    } catch {
        throw new BadValue(`${file.name}: not a UTF-8 text file`);
    }
}

function showVerdict(text, kind) {
    const verdict = by("verdict");
    verdict.textContent = text;
    verdict.className = kind;
}

class Form {
    // `example`: a program in G-code and the file of its machine.
    constructor(runner, example) {
        Object.assign(this, { runner, example, machine: null, whole: null, files: [], done: 0, running: false });
        for (const hz of CLOCKS) element(by("clock"), "option", "", `${hz / 1e6} MHz`).value = hz;
        for (const name of [...Object.keys(EXAMPLES), "a part in G-code"]) element(by("example"), "option", "", name);
        by("language").onchange = () => this.chosen();
        by("lines").oninput = () => { this.whole = null; };
        by("go").onclick = by("beside").onchange = () => this.run();
        by("cancel").onclick = () => runner.cancel();
        by("example").onchange = ({ target }) => {
            const text = EXAMPLES[target.value];
            if (target.value) this.put(text ?? example.program, text ? CONSOLE : GCODE);
            target.value = "";
            return this.run();
        };
        by("open").onclick = () => by("file").click();
        by("file").onchange = ({ target }) => {
            const files = [...target.files];
            target.value = "";
            if (files.length) this.open(files);
        };
        by("files").onchange = ({ target }) => this.choose(Number(target.value));
        by("tools").onchange = by("map").onchange = by("map-use").onchange = () => this.run();
        by("machine-text").oninput = () => this.readMachine();
        by("machine-text").onchange = () => this.run();
        by("machine-example").onclick = () => {
            this.putMachine(example.machine);
            return this.run();
        };
        by("machine-save").onclick = () => save(new Blob([by("machine-text").value], { type: "application/toml" }), "machine.toml");
        this.putMachine(example.machine);
        this.listen();
        for (const [id, make] of Object.entries({
            csv: async () => [(await runner.ask({ kind: "csv" })).blob, "pulses.csv"],
            report: async () => {
                const { facts, edges } = await runner.ask({ kind: "report" });
                return [new Blob([reportPage(facts, edges)], { type: "text/html" }), "report.html"];
            },
            plain: async () => [new Blob([await this.plain()], { type: "text/plain" }), "plain.nc"],
            png: async () => [await picture(), "passo.png"],
        })) {
            by(id).onclick = () => make().then(([blob, name]) => save(blob, name)).catch(error => this.say(error.message));
        }
        by("link").onclick = () => this.link();
    }

    // Keys and dropped files, anywhere on the page.
    listen() {
        addEventListener("keydown", event => {
            if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) this.run();
            else if (event.key === "Escape" && this.running) this.runner.cancel();
        });
        addEventListener("dragover", event => {
            event.preventDefault();
            document.body.classList.add("dropping");
        });
        for (const kind of ["dragleave", "drop"]) addEventListener(kind, () => document.body.classList.remove("dropping"));
        addEventListener("drop", event => {
            event.preventDefault();
            if (event.dataTransfer.files.length) this.open([...event.dataTransfer.files]);
        });
    }

    say(text) { by("told").textContent = text; }

    get language() { return by("language").value; }
    get text() { return this.whole ?? by("lines").value; }

    chosen() {
        const gcode = this.language === GCODE;
        by("clock").hidden = gcode;
        by("plain").hidden = !gcode;
        by("machine-file").hidden = by("tool-table").hidden = by("height-map").hidden = by("machine-told").hidden = !gcode;
        by("lines").rows = gcode ? 12 : 4;
    }

    // Shows a program, the only one.
    put(text, language) { this.putFiles([{ name: PROGRAM, text }], language); }

    // Shows the first one of several files, or another.
    putFiles(files, language, number = 0) {
        this.files = files;
        const list = by("files");
        list.textContent = "";
        files.forEach(({ name, plays = true }, n) => { element(list, "option", "", plays ? name : `${name} (subroutines)`).value = n; });
        list.hidden = files.length < 2;
        list.value = number;
        this.putText(files[number].text, language);
    }

    // Shows another one of the files; this one is kept as it was edited.
    choose(number) { this.putFiles(this.edited, GCODE, number); }

    // The files, as inTurn() has them; that which is shown as it was edited.
    get edited() {
        const shown = Number(by("files").value);
        const files = this.files.map((file, n) => (n === shown ? { ...file, text: this.text } : file));
        return files.length > 1 ? inTurn(files) : files.map(file => ({ ...file, plays: true }));
    }

    // A long text cannot be edited here.
    putText(text, language) {
        const long = text.length > EDITED;
        this.whole = long ? text : null;
        by("lines").value = long ? `${text.slice(0, text.lastIndexOf("\n", SHOWN))}\n…` : text;
        by("lines").readOnly = long;
        by("language").value = language;
        this.chosen();
    }

    putMachine(text) {
        by("machine-text").value = text;
        this.readMachine();
    }

    // The machine of the file that is shown; what is wrong with that is said as the command says it.
    readMachine() {
        try {
            this.machine = MachineReader.read(by("machine-text").value);
            this.refuse("");
        } catch (error) {
            this.refuse(`machine.toml: ${error.message}`);
        }
    }

    refuse(text) {
        this.refused = text;
        by("machine-line").textContent = text ? "Machine: the file has an error" : machineText(this.machine);
        by("machine-told").textContent = text;
        by("machine-text").ariaInvalid = String(text !== "");
    }

    // Programs, files of subroutines, a machine for G-code, a table of tools, a height map; of the latter three the last one.
    async open(files) {
        const has = (file, end) => file.name.toLowerCase().endsWith(end), own = end => files.filter(file => has(file, end)).at(-1);
        const programs = files.filter(file => ![".toml", ".tbl", ".csv"].some(end => has(file, end)));
        const [machine, tools, map] = [".toml", ".tbl", ".csv"].map(own);
        if (machine && MOVE_FILE.test(await machine.text())) return this.openMoves(machine);
        if (machine) await this.openMachine(machine);
        if (tools) by("tools").value = await tools.text();
        if (map) by("map").value = await map.text();
        if (programs.length) {
            const texts = await Promise.all(programs.map(async file => ({ name: file.name, text: await file.text() })));
            this.putFiles(texts.length > 1 ? inTurn(texts) : texts, GCODE);
            const lines = texts.reduce((sum, { text }) => sum + text.split("\n").length, 0);
            const what = texts.length > 1 ? `${texts.length} files` : texts[0].name;
            this.say(`${what}: ${grouped(lines)} lines${this.whole ? ", of which the first are shown" : ""}`);
        }
        return this.run();
    }

    async openMoves(file) {
        try {
            const { lines, hz, pins } = linesOfMoves(await textOf(file));
            if (!CLOCKS.includes(hz)) throw new BadValue(`clock_hz: the page has ${CLOCKS.map(own => grouped(own)).join(", ")}`);
            this.put(lines, CONSOLE);
            by("clock").value = hz;
            await this.run();
            if (pins) this.say(`${file.name}: without its [pins]`);
        } catch (error) {
            this.say(`${file.name}: ${error.message}`);
        }
    }

    async openMachine(file) {
        if (this.language !== GCODE) this.put(this.example.program, GCODE);
        by("machine-file").open = true;
        try {
            this.putMachine(await textOf(file));
        } catch (error) {
            this.putMachine("");
            this.refuse(error.message);
        }
    }

    get state() {
        const { language, edited } = this, lines = edited.length > 1 ? "" : this.text, machine = by("machine-text").value;
        const own = { ...(machine === this.example.machine ? {} : { machine }), ...(this.tools ? { tools: this.tools } : {}) };
        if (this.map) own.map = this.map;
        if (edited.length > 1) own.files = edited.map(({ name, text }) => ({ name, text }));
        return { language, lines, clock: Number(by("clock").value), beside: by("beside").value, ...own };
    }

    set state({ language, lines, clock, beside = "", machine = this.example.machine, tools = "", map = null, files = [] }) {
        this.putMachine(machine);
        by("tools").value = tools;
        by("map").value = map?.text ?? "";
        by("map-use").value = map?.follows ? "follows" : "";
        if (PROFILES.includes(beside)) by("beside").value = beside;
        if (files.length) this.putFiles(inTurn(files), GCODE);
        else this.put(lines, language === GCODE ? GCODE : CONSOLE);
        if (CLOCKS.includes(clock)) by("clock").value = clock;
    }

    async link() {
        history.replaceState(null, "", await toFragment(this.state));
        const long = location.href.length > LONG_LINK ? ": some programs cut links as long as this" : "";
        try {
            await navigator.clipboard.writeText(location.href);
            this.say(`link copied, ${grouped(location.href.length)} characters${long}`);
        } catch {
            this.say(`the link is in the address line, ${grouped(location.href.length)} characters${long}`);
        }
    }

    progress({ share, seconds, doing }) {
        if (doing) return this.say(doing);
        const bar = by("progress"), spent = (performance.now() - this.began) / 1000;
        if (share > 0) bar.value = share;
        else bar.removeAttribute("value");
        const left = share > 0.02 && spent > 2 ? `, about ${plain(spent / share - spent, 2)} s left` : "";
        this.say(`${plain(seconds, 4)} s of motion played${left}`);
    }

    // The message that plays what is typed, with a profile instead of its own.
    job(profile) {
        if (this.language === GCODE) {
            const { machine } = this, numbers = [...machine.numbers];
            if (profile) numbers[PROFILE] = PROFILES.indexOf(profile);
            return { kind: "play", files: this.programs, machine: { ...machine, numbers }, tools: this.tools, map: this.map };
        }
        const text = profile ? this.text.replace(/profile=\w+/g, `profile=${profile}`) : this.text;
        return { kind: "type", lines: text.split("\n").map(line => line.trim()).filter(Boolean), hz: Number(by("clock").value) };
    }

    get map() { return by("map").value.trim() ? { text: by("map").value, follows: by("map-use").value !== "" } : null; }
    get tools() { return by("tools").value.trim() && by("tools").value; }

    // The files with those marked that plain lines are made of.
    get programs() {
        return this.edited.map(file => ({ ...file, expands: Boolean(this.tools || this.map) || Advice.needsExpanding(file.text, RULES.gcode) }));
    }

    get expands() { return this.language === GCODE && this.programs.some(file => file.plays && file.expands); }

    // The program that is shown as plain lines.
    async plain() {
        const { machine, tools, map, programs: files } = this, { name, text, plays, expands } = files[Number(by("files").value)];
        if (!plays) throw new BadValue(`${name} has subroutines: show the program that calls them`);
        if (!expands) return text;
        await this.runner.python();
        const { lines, wrong } = await this.runner.ask({ kind: "expand", name, files, machine, tools, map });
        if (wrong) throw new BadValue(wrong);
        return lines.map(line => `${line}\n`).join("");
    }

    // Cancels what runs, and plays what is typed; with another profile first, so that what is saved is the program's own.
    async run() {
        if (this.running) {
            this.runner.cancel();
            await this.runner.last.catch(() => {});
        }
        this.busy(true);
        try {
            if (this.language === GCODE && this.refused) throw new BadValue(this.refused);
            const clash = this.edited.find(file => file.clashes);
            if (clash) throw new BadValue(`two files ${clash.given} have subroutines: open one of them`);
            const profile = by("beside").value;
            if (this.expands) await this.runner.python();
            const other = profile ? await this.runner.ask(this.job(profile)) : null;
            await this.show(await this.runner.ask(this.job("")), other, profile);
        } catch (error) {
            clearMotion();
            by("answer").textContent = "";
            for (const button of document.querySelectorAll(".save")) button.disabled = true;
            if (error instanceof BadValue) showVerdict(`error: ${error.message}`, "bad");
            else showFailure(error);
        }
        this.busy(false);
        this.done++;
    }

    busy(running) {
        this.running = running;
        this.began = performance.now();
        by("cancel").hidden = by("progress").hidden = !running;
        by("progress").removeAttribute("value");
        if (running) showVerdict("running", "");
        else this.say("");
    }

    async show({ text, wrong, motion }, other, profile) {
        const all = [...wrong, ...(other?.wrong ?? []).filter(line => !wrong.includes(line)).map(line => `${profile}: ${line}`)];
        by("answer").textContent = text || all.join("\n");
        for (const button of document.querySelectorAll(".save")) button.disabled = !motion;
        if (!motion) clearMotion();
        else if (other?.motion) await showMotions([motion, other.motion].map(Motion.from), ["as written", `profile ${profile}`]);
        else await showMotions([Motion.from(motion)]);
        if (all.length) showVerdict(`error: ${all[0]}${all.length > 1 ? ` (${all.length} errors, listed below)` : ""}`.replace("error: error", "error"), "bad");
        else if (!motion) showVerdict("nothing moved", "stopped");
    }
}

async function openWeb() {
    chooseTheme();
    document.querySelector("main").prepend(by("try"));
    try {
        if (typeof WebAssembly === "undefined") throw new Error("this browser has no WebAssembly");
        const module = await inflate(by("wasm").textContent);
        const { rules, ...example } = JSON.parse(by("machine").textContent);
        RULES = rules;
        const runner = await Runner.open(by("worker").textContent, module, rules.gcode, told => web?.progress(told));
        web = new Form(runner, example);
        web.state = await fromFragment(location.hash) ?? { language: CONSOLE, lines: EXAMPLES["three axes"] };
        await web.run();
    } catch (error) {
        showFailure(error);
    }
}
