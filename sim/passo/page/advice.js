// SPDX-License-Identifier: MIT
// What to write instead of a line of G-code that is refused, as sim/passo/expand/refusals.py says it. `rules`: the
// member `gcode` of RULES.
"use strict";

class Advice {
    // `number(line)`: the error of a line alone; `inputs`: number of those of M66.
    constructor(rules, { letters, inputs, power }, number) {
        Object.assign(this, { rules, letters, inputs, power, number });
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

    // An error of a line with the word that it is about, the norm of that, and what to do.
    explain(number, error, line) {
        const { rules, letters } = this, bare = Advice.bare(line), words = Advice.words(bare);
        const [bad] = bare.replace(new RegExp(rules.good, "g"), " ").split(" ").filter(Boolean), known = rules.said[number] ?? ["", "see docs/gcode.md"];
        if (rules.unread.includes(number) && bad) return `${error}: ${bad.toUpperCase()} (${rules.nist}): ${known[1]}`;
        for (const { letter, code, text } of rules.not_taken.includes(number) ? words : []) {
            if (rules.axes.includes(letter) && !letters.includes(letter)) return `${error}: ${text} (${rules.nist}): the machine has the axes ${[...letters].join(" ")}`;
            if (letter in rules.letters && !this.isTaken(text)) return `${error}: ${text} (${rules.letters[letter]})`;
            if ("GM".includes(letter) && !this.isTaken(text)) {
                const own = rules.advice.find(([first, start, stop]) => first === letter && code >= start && code < stop);
                const [norm, advice] = own ? own.slice(3) : rules.otherwise;
                return `${error}: ${text} (${norm}): ${advice}`;
            }
        }
        const word = this.culprit(number, known[0].split("|"), words), needed = rules.needed[word?.text] ?? "what it needs";
        if (number === rules.unused && word && word.letter in rules.letters) return `${error}: ${word.text} (${rules.letters[word.letter]})`;
        const named = word ? `${word.text} (${this.norm(word)})` : `the line (${rules.nist})`;
        return `${error}: ${named}: ${number === rules.no_port ? this.ports : known[1].replace("{}", needed)}`;
    }

    // The same of a line that probes, on a machine without a probe.
    noProbe(error, line) {
        const pattern = new RegExp(`^(?:${this.rules.said[this.rules.no_probe][0]})$`);
        const word = Advice.words(Advice.bare(line)).find(({ text }) => pattern.test(text)) ?? { text: "G38" };
        return `${error}: ${word.text} (${this.rules.norms["G38.2"]}): a height map simulates one`;
    }

    norm({ letter, text }) { return this.rules.norms["GM".includes(letter) ? text : letter] ?? this.rules.nist; }

    isTaken(text) { return !this.rules.not_taken.includes(this.number(text)); }

    // The word that an error is about, if one is known.
    culprit(number, patterns, words) {
        const found = patterns.flatMap(kind => words.filter(({ text }) => kind && new RegExp(`^(?:${kind})$`).test(text)));
        const left = found.map(word => this.number(words.filter(own => own !== word).map(({ text }) => text).join(" ")));
        return found.find((_, n) => left[n] === 0) ?? found.find((_, n) => left[n] !== number) ?? found[0];
    }

    get ports() {
        const inputs = this.inputs ? `the inputs P0 to P${this.inputs - 1}` : "no inputs (no switch, no probe)";
        return `there are the outputs P0 to P3, ${inputs}, ${this.power ? "the analog output E0" : "no analog output (no spindle_maximum)"}`;
    }
}
