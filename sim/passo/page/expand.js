// SPDX-License-Identifier: MIT
// Python in the worker, which expands what plain lines do not have (sim/passo/web_python.py).
"use strict";

const SPINDLE_MAXIMUM = 10;  // its place in `struct web_machine`
const NOWHERE = "https://passo.invalid/";  // Pyodide asks for its files there

class Python {
    // `packed`: files by name, deflated and in base64; `c`: exports of the WebAssembly with the interpreter.
    static async load(packed, c) {
        const files = {}, fetched = globalThis.fetch;
        for (const [name, text] of Object.entries(packed)) {
            files[name] = await through(new Blob([fromBase64(text)]), new DecompressionStream("deflate"));
        }
        const part = async name => {
            const address = URL.createObjectURL(new Blob([files[name]], { type: "text/javascript" }));
            try {
                return await import(address);
            } finally {
                URL.revokeObjectURL(address);
            }
        };
        // Pyodide takes this for a worker that is a module, which no browser starts for a page without a server.
        globalThis.importScripts = () => { throw new Error("not here"); };
        const [{ loadPyodide }, asm] = [await part("pyodide.mjs"), await part("pyodide.asm.mjs")];
        globalThis.fetch = async address => {
            const name = String(address).slice(NOWHERE.length);
            return new Response(files[name], { headers: { "Content-Type": name.endsWith(".wasm") ? "application/wasm" : "application/zip" } });
        };
        const python = new Python();
        try {
            const pyodide = await loadPyodide({
                indexURL: NOWHERE, createPyodideModule: asm.default,
                lockFileContents: new TextDecoder().decode(files["pyodide-lock.json"]),
            });
            pyodide.registerJsModule("passo_wasm", { c });
            pyodide.unpackArchive(files["passo.zip"], "zip", { extractDir: pyodide.runPython("import site; site.getsitepackages()[0]") });
            python.expanding = pyodide.pyimport("passo.expanding");
        } finally {
            globalThis.fetch = fetched;
        }
        return python;
    }

    // The answer of sim/passo/page/expanding.py for one of several files on a machine, with a table of tools; `begin`: place
    // of the interpreter behind the programs before, or 0; `map`: a height map, and whether Z follows it, or null.
    expand(name, files, { numbers, letters, inputs, power, turn_counts }, tools, begin, map) {
        const [, , , arc_tolerance] = numbers, axes = letters.length;
        const settings = { axes, arc_tolerance, spindle_maximum: numbers[SPINDLE_MAXIMUM], turn_counts, letters, inputs, power: Boolean(power) };
        const all = Object.fromEntries(files.map(file => [file.name, file.text]));
        return JSON.parse(this.expanding.expand(name, JSON.stringify(all), JSON.stringify(settings), tools, begin, map?.text ?? "", Boolean(map?.follows)));
    }
}
