// SPDX-License-Identifier: MIT
// The page's side of the worker: one job at a time.
"use strict";

class Runner {
    // `source`: text of the worker; `module`: bytes of the WebAssembly; `rules`: of G-code; `progress({share, seconds})` hears of a job.
    static async open(source, module, rules, progress) {
        const runner = new Runner();
        runner.worker = new Worker(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
        runner.worker.onmessage = ({ data }) => (data.kind === "progress" ? progress(data) : runner.settle(data));
        runner.worker.onerror = event => runner.settle({ kind: "failure", text: event.message });
        runner.last = Promise.resolve();
        await runner.ask({ kind: "load", module, rules }, [module.buffer]);
        return runner;
    }

    settle(answer) {
        const { resolve, reject } = this.waiting;
        if (answer.kind === "failure") reject(new Error(answer.text));
        else resolve(answer);
    }

    // The answer to a message, after those to the messages before.
    ask(message, moved = []) {
        const asked = this.last.catch(() => {}).then(() => new Promise((resolve, reject) => {
            this.waiting = { resolve, reject };
            this.worker.postMessage(message, moved);
        }));
        this.last = asked;
        return asked;
    }

    cancel() { this.worker.postMessage({ kind: "cancel" }); }
}
