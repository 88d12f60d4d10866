// SPDX-License-Identifier: MIT
// What to write instead of a line of G-code that is refused, as sim/passo/expand/refusals.py says it. `rules`: the
// member `gcode` of RULES.
"use strict";

class Advice {
    // `errorOf(line)`: of a line alone, or 0; `inputs`: number of those of M66.
    constructor(rules, { letters, inputs, power }, errorOf) {
        Object.assign(this, { rules, letters, inputs, power, errorOf });
    }

    // Whether the interpreter has a command or word.
    isTaken(word) { return !this.rules.not_taken.includes(this.errorOf(word)); }

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

    // Where the words of a line end before it does: the next characters, if they can be shown.
    static unread(bare) {
        const [words] = /^\/?(?:[a-z][-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))*/.exec(bare);
        const rest = bare.slice(words.length).slice(0, 8).toUpperCase();
        return /^[!-~]+$/.test(rest) ? rest : "";
    }

    // The last of the first words that have the same error without the others.
    wrongWord(number, words) {
        const texts = words.map(({ text }) => text);
        return texts.find((_, at) => this.errorOf(texts.slice(0, at + 1).join("")) === number);
    }

    // An error of a line with the word that it is about, where that is known.
    explain(number, error, line) {
        const { rules, letters } = this, bare = Advice.bare(line), words = Advice.words(bare);
        if (number === rules.no_port) return `${error}: ${this.ports}`;
        const printer = words.find(({ letter }) => letter === "E");
        if (number === rules.unused && printer) return `${error}: ${printer.text} (${rules.letters.E})`;
        if (number in rules.instead) {
            const wrong = rules.at_word.includes(number) && this.wrongWord(number, words);
            const place = wrong || (rules.unread.includes(number) && Advice.unread(bare));
            return `${error}: ${place ? `${place}: ` : ""}${rules.instead[number]}`;
        }
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
        return `${error}: ${rules.together}`;
    }

    get ports() {
        const inputs = this.inputs ? `the inputs P0 to P${this.inputs - 1}` : "no inputs (no switch, no probe)";
        return `there are the outputs P0 to P3, ${inputs}, ${this.power ? "the analog output E0" : "no analog output (no spindle_maximum)"}`;
    }
}
