// SPDX-License-Identifier: MIT
// The page to try Passo: moves or G-code in, the edges at the pins of the C model out.
"use strict";

const CLOCKS = [16e6, 72e6, 100e6];
const GCODE = "G-code", CONSOLE = "moves";
const SHOWN = 40000;  // characters of a program that can be edited; of a longer file the beginning is shown
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

function showVerdict(text, kind) {
    const verdict = by("verdict");
    verdict.textContent = text;
    verdict.className = kind;
}

class Form {
    constructor(runner, machine) {
        Object.assign(this, { runner, machine, whole: null, done: 0, running: false });
        for (const hz of CLOCKS) element(by("clock"), "option", "", `${hz / 1e6} MHz`).value = hz;
        for (const name of [...Object.keys(EXAMPLES), "a part in G-code"]) element(by("example"), "option", "", name);
        by("language").onchange = () => this.chosen();
        by("lines").oninput = () => { this.whole = null; };
        by("go").onclick = by("beside").onchange = () => this.run();
        by("cancel").onclick = () => runner.cancel();
        by("example").onchange = ({ target }) => {
            const text = EXAMPLES[target.value];
            if (target.value) this.put(text ?? machine.program, text ? CONSOLE : GCODE);
            target.value = "";
            return this.run();
        };
        by("open").onclick = () => by("file").click();
        by("file").onchange = ({ target }) => {
            if (target.files.length) this.open(target.files[0]);
            target.value = "";
        };
        by("machine-line").textContent = machineText(machine);
        this.listen();
        for (const [id, make] of Object.entries({
            csv: async () => [(await runner.ask({ kind: "csv" })).blob, "pulses.csv"],
            report: async () => {
                const { facts, edges } = await runner.ask({ kind: "report" });
                return [new Blob([reportPage(facts, edges)], { type: "text/html" }), "report.html"];
            },
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
            if (event.dataTransfer.files.length) this.open(event.dataTransfer.files[0]);
        });
    }

    say(text) { by("told").textContent = text; }

    get language() { return by("language").value; }
    get text() { return this.whole ?? by("lines").value; }

    chosen() {
        const gcode = this.language === GCODE;
        by("clock").hidden = gcode;
        by("machine-line").hidden = !gcode;
        by("lines").rows = gcode ? 12 : 4;
    }

    // Shows a program; a long one cannot be edited here.
    put(text, language) {
        const long = text.length > SHOWN;
        this.whole = long ? text : null;
        by("lines").value = long ? `${text.slice(0, text.lastIndexOf("\n", SHOWN))}\n…` : text;
        by("lines").readOnly = long;
        by("language").value = language;
        this.chosen();
    }

    async open(file) {
        this.put(await file.text(), GCODE);
        this.say(`${file.name}: ${grouped(this.text.split("\n").length)} lines${this.whole ? ", of which the first are shown" : ""}`);
        await this.run();
    }

    get state() {
        return { language: this.language, lines: this.text, clock: Number(by("clock").value), beside: by("beside").value };
    }

    set state({ language, lines, clock, beside = "" }) {
        if (PROFILES.includes(beside)) by("beside").value = beside;
        this.put(lines, language === GCODE ? GCODE : CONSOLE);
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

    progress({ share, seconds }) {
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
            return { kind: "play", text: this.text, machine: { ...machine, numbers } };
        }
        const text = profile ? this.text.replace(/profile=\w+/g, `profile=${profile}`) : this.text;
        return { kind: "type", lines: text.split("\n").map(line => line.trim()).filter(Boolean), hz: Number(by("clock").value) };
    }

    // Cancels what runs, and plays what is typed; with another profile first, so that what is saved is the program's own.
    async run() {
        if (this.running) {
            this.runner.cancel();
            await this.runner.last.catch(() => {});
        }
        this.busy(true);
        try {
            const profile = by("beside").value;
            const other = profile ? await this.runner.ask(this.job(profile)) : null;
            await this.show(await this.runner.ask(this.job()), other, profile);
        } catch (error) {
            clearMotion();
            showFailure(error);
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

    async show({ text, motion }, other, profile) {
        const beside = other?.text.split("\n").find(line => line.startsWith("error"));
        const wrong = [...text.split("\n").filter(line => line.startsWith("error")), ...(beside ? [`${profile}: ${beside}`] : [])];
        by("answer").textContent = text;
        for (const button of document.querySelectorAll(".save")) button.disabled = !motion;
        if (!motion) clearMotion();
        else if (other?.motion) await showMotions([motion, other.motion].map(Motion.from), ["as written", `profile ${profile}`]);
        else await showMotions([Motion.from(motion)]);
        if (wrong.length) showVerdict(wrong.join("; "), "bad");
        else if (!motion) showVerdict("nothing moved", "stopped");
    }
}

async function openWeb() {
    chooseTheme();
    document.querySelector("main").prepend(by("try"));
    try {
        if (typeof WebAssembly === "undefined") throw new Error("this browser has no WebAssembly");
        const module = await inflate(by("wasm").textContent);
        const runner = await Runner.open(by("worker").textContent, module, told => web?.progress(told));
        web = new Form(runner, JSON.parse(by("machine").textContent));
        web.state = await fromFragment(location.hash) ?? { language: CONSOLE, lines: EXAMPLES["three axes"] };
        await web.run();
    } catch (error) {
        showFailure(error);
    }
}
