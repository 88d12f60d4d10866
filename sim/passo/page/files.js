// SPDX-License-Identifier: MIT
// Several files: which of them are programs, and in which order.
"use strict";

const OF_SUBROUTINES = /^\/?(?:n[0-9]+)?o(?:<([^>]*)>|([0-9]+))(sub|endsub)/;
const ENDS_FILE = /^\/?(?:n[0-9]+)?m0*(?:2|30)$/;

// Whether a file has nothing but subroutines, one of which has its name: another file calls it (sim/passo/expand/expander.py).
function hasOnlySubroutines({ given, text }) {
    let inside = false, own = false;
    for (const line of text.split(/\r\n|\r|\n/)) {
        const bare = Advice.bare(line), [, named, numbered, keyword] = OF_SUBROUTINES.exec(bare) ?? [];
        own ||= keyword === "sub" && given === `${named ?? numbered}.ngc`;
        if (keyword) inside = keyword === "sub";
        else if (!inside && bare && !ENDS_FILE.test(bare)) return false;
    }
    return own;
}

const MOVE_FILE = /^\s*\[\[\s*move\s*\]\]/m;
const OF_MOVE_FILE = ["clock_hz", "pins", "move"];  // that the page knows

// A move file as lines of the console, with its clock; throws for what they do not say.
function linesOfMoves(text) {
    const table = Toml.read(text), other = [...table.keys()].find(key => !OF_MOVE_FILE.includes(key));
    if (other !== undefined) throw new BadValue(`${other}: the page has no machines in move files: passo run plays it`);
    const shown = value => (Array.isArray(value) ? value.map(shown).join(",") : value instanceof Written ? value.text : String(value).replaceAll(" ", ""));
    const lines = table.get("move").map(move => ["move", ...[...move].map(([key, value]) => `${key}=${shown(value)}`)].join(" "));
    return { lines: lines.join("\n"), hz: Number(table.get("clock_hz")), pins: table.has("pins") };
}

// A name without the number that tells files of one name apart, that number, and the name with another one.
function numbered(name) {
    const [, stem, number = 1, end = ""] = /^(.*?)(?: \((\d+)\))?(\.[^.]*)?$/s.exec(name);
    return { name: stem + end, number: Number(number), as: n => `${stem} (${n})${end}` };
}

function byName(one, other) {
    const [own, next] = [one, other].map(file => numbered(file.name));
    return own.name === next.name ? own.number - next.number : own.name < next.name ? -1 : 1;
}

// Files in the order of their names, with those marked that play. Programs of one name, as of several folders, play in the
// order in which they are given; of files of subroutines, which others call by name, `clashes` marks one that differs.
function inTurn(files) {
    const sorted = files.map(file => ({ given: file.name, ...file })).sort(byName), called = new Set(sorted.filter(hasOnlySubroutines));
    const taken = new Map(), kept = new Map();
    for (const file of [...called, ...sorted.filter(own => !called.has(own))]) {
        const clashes = called.has(file) && taken.has(file.given);
        if (clashes && taken.get(file.given) === file.text) continue;
        let name = file.given;
        for (let n = 2; taken.has(name); n++) name = numbered(file.given).as(n);
        taken.set(name, file.text);
        kept.set(file, { ...file, name, clashes, plays: !called.has(file) || (!clashes && called.size === sorted.length) });
    }
    return sorted.flatMap(file => kept.get(file) ?? []);
}
