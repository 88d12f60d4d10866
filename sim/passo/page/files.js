// SPDX-License-Identifier: MIT
// Several files: which of them are programs, and in which order.
"use strict";

const OF_SUBROUTINES = /^\/?(?:n[0-9]+)?o(?:<([^>]*)>|([0-9]+))(sub|endsub)/;
const ENDS_FILE = /^\/?(?:n[0-9]+)?m0*(?:2|30)$/;

// Whether a file has nothing but subroutines, one of which has its name: another file calls it (sim/passo/expand/expander.py).
function hasOnlySubroutines({ name, text }) {
    let inside = false, own = false;
    for (const line of text.split(/\r\n|\r|\n/)) {
        const bare = Advice.bare(line), [, named, numbered, keyword] = OF_SUBROUTINES.exec(bare) ?? [];
        own ||= keyword === "sub" && name === `${named ?? numbered}.ngc`;
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

// Files in the order of their names, with those marked that play.
function inTurn(files) {
    const sorted = [...files].sort((one, other) => (one.name < other.name ? -1 : 1));
    const playing = sorted.filter(file => !hasOnlySubroutines(file));
    return sorted.map(file => ({ ...file, plays: !playing.length || playing.includes(file) }));
}
