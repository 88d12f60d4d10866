// SPDX-License-Identifier: MIT
// What to write instead of a line of G-code that is refused, as sim/passo/expand/refusals.py says it. `rules`: the
// member `gcode` of RULES.
"use strict";

class Advice {
    // `isTaken(word)`: whether the interpreter has a command or word; `inputs`: number of those of M66.
    constructor(rules, { letters, inputs, power }, isTaken) {
        Object.assign(this, { rules, letters, inputs, power, isTaken });
    }

    // Whether a program has what only expanded ones may have.
    static needsExpanding(text, { expanded }) {
        const patterns = expanded.map(pattern => new RegExp(pattern));
        return text.split(/\r\n|\r|\n/).some(line => patterns.some(pattern => pattern.test(Advice.bare(line))));
    }

    // A line without comments and blanks, in lower case.
    static bare(text) {
        const found = text.replace(/\([^)\r\n]*\)?|;[^\r\n]*/g, "").toLowerCase().replace(/[\x00-\x20]+/g, "");
        return found.replace(/^\ufeff+/, "").replace(/^%+|%+$/g, "");
    }

    static words(bare) {
        return Array.from(bare.matchAll(/([a-z])([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))/g), ([, letter, number]) => {
            const value = Number(number), shown = value.toFixed(6).replace(/\.?0+$/, "");
            return { letter: letter.toUpperCase(), code: Math.round(value * 10), text: letter.toUpperCase() + (shown === "-0" ? "0" : shown) };
        });
    }

    // An error of a line with the word that it is about, where that is known.
    explain(number, error, line) {
        const { rules, letters } = this, words = Advice.words(Advice.bare(line));
        if (number === rules.no_port) return `${error}: ${this.ports}`;
        const printer = words.find(({ letter }) => letter === "E");
        if (number === rules.unused && printer) return `${error}: ${printer.text} (${rules.letters.E})`;
        if (!rules.not_taken.includes(number)) return error;
        for (const { letter, code, text } of words) {
            if (rules.axes.includes(letter) && !letters.includes(letter)) return `${error}: ${text}: the machine has the axes ${[...letters].join(" ")}`;
            if (letter in rules.letters && !this.isTaken(text)) return `${error}: ${text} (${rules.letters[letter]})`;
            if ("GM".includes(letter) && !this.isTaken(text)) {
                const known = rules.advice.find(([own, start, stop]) => own === letter && code >= start && code < stop);
                const [norm, advice] = known ? known.slice(3) : rules.otherwise;
                return `${error}: ${text} (${norm}): ${advice}`;
            }
        }
        return error;
    }

    get ports() {
        const inputs = this.inputs ? `the inputs P0 to P${this.inputs - 1}` : "no inputs (no switch, no probe)";
        return `there are the outputs P0 to P3, ${inputs}, ${this.power ? "the analog output E0" : "no analog output (no spindle_maximum)"}`;
    }
}
