// SPDX-License-Identifier: MIT
// The page's side of the worker: one job at a time.
"use strict";

const PYTHON = "python.js";  // beside the page
const CANCELED = { kind: "result", text: "", wrong: ["canceled while the program was expanded"], motion: null };

class Runner {
    // `source`: text of the worker; `module`: bytes of the WebAssembly; `rules`: of G-code; `progress({share, seconds})`, or
    // `progress({doing})`, hears of a job.
    static async open(source, module, rules, progress) {
        const runner = new Runner();
        Object.assign(runner, { source, module, rules, progress, last: Promise.resolve() });
        runner.start();
        await runner.ask(runner.loading);
        return runner;
    }

    get loading() { return { kind: "load", module: this.module, rules: this.rules }; }

    start() {
        this.hasPython = this.isDeaf = false;
        this.worker = new Worker(URL.createObjectURL(new Blob([this.source], { type: "text/javascript" })));
        this.worker.onmessage = ({ data }) => {
            if (data.kind !== "progress") return this.settle(data);
            this.isDeaf = "doing" in data;
            this.progress(data);
        };
        this.worker.onerror = event => this.settle({ kind: "failure", text: event.message });
    }

    settle(answer) {
        const { resolve, reject } = this.waiting, told = this.instead ?? answer;
        this.instead = null;
        if (told.kind === "failure") reject(new Error(told.text));
        else resolve(told);
    }

    // The answer to a message, after those to the messages before.
    ask(message) { return this.after(() => this.send(message)); }

    after(job) { return this.last = this.last.catch(() => {}).then(job); }

    send(message) {
        return new Promise((resolve, reject) => {
            this.waiting = { resolve, reject };
            this.worker.postMessage(message);
        });
    }

    // Loads Python, once.
    python() { return this.after(() => this.hasPython || this.loadPython()); }

    async loadPython() {
        this.isStopped = false;
        this.progress({ doing: "loading Python, which expands the program" });
        if (!globalThis.passoPython) await Runner.load(PYTHON);
        await this.send({ kind: "python", packed: passoPython });
        this.hasPython = true;
        if (this.isStopped) throw new BadValue("canceled while Python was loaded");
    }

    static load(name) {
        return new Promise((resolve, reject) => {
            const script = element(document.body, "script");
            script.onload = resolve;
            script.onerror = () => {
                script.remove();
                reject(new BadValue(`${name} is missing beside this page: it expands parameters, expressions, O words, cycles and cutter compensation`));
            };
            script.src = name;
        });
    }

    // A worker that expands hears nothing: another one takes its place.
    cancel() {
        this.isStopped = true;
        if (!this.isDeaf) return this.worker.postMessage({ kind: "cancel" });
        this.worker.terminate();
        this.start();
        this.instead = CANCELED;
        this.worker.postMessage(this.loading);
    }
}
