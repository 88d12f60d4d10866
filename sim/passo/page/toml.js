// SPDX-License-Identifier: MIT
// Reads TOML as Python's tomllib does, with its messages: tables as Map, integers as BigInt, other numbers as Written.
"use strict";

class BadValue extends Error {}

// A decimal number as it was written; an integer as its digits times a power of ten.
class Written {
    constructor(text) {
        this.text = text;
        const [, sign, digits, decimals = "", power = "0"] = /^([+-]?)(\d*|inf|nan)\.?(\d*)(?:e([+-]?\d+))?$/i.exec(text.replaceAll("_", ""));
        Object.assign(this, { finite: !/[in]/i.test(digits), negative: sign === "-" });
        if (!this.finite) return;
        this.exponent = Number(power) - decimals.length;
        this.digits = BigInt(digits + decimals) * (this.negative ? -1n : 1n);
    }

    get name() {
        return this.finite ? this.text : (this.negative ? "-" : "") + (/n$/.test(this.text) ? "NaN" : "Infinity");
    }
}

// A date or a time: nothing here takes one.
class Moment {
    constructor(text) { this.text = text; }
}

// A text as Python shows it in quotes.
function quoted(text) {
    const quote = text.includes("'") && !text.includes('"') ? '"' : "'";
    const known = { "\n": "\\n", "\r": "\\r", "\t": "\\t", "\\": "\\\\", [quote]: `\\${quote}` };
    const hex = (letter, width) => letter.codePointAt(0).toString(16).padStart(width, "0");
    const made = Array.from(text, letter => {
        if (letter in known) return known[letter];
        if (letter === " " || !/[\p{C}\p{Z}]/u.test(letter)) return letter;
        const code = letter.codePointAt(0);
        return code < 256 ? `\\x${hex(letter, 2)}` : code < 65536 ? `\\u${hex(letter, 4)}` : `\\U${hex(letter, 8)}`;
    });
    return quote + made.join("") + quote;
}

const TIME = "([01]\\d|2[0-3]):([0-5]\\d):([0-5]\\d)(?:\\.(\\d{1,6})\\d*)?";
const SHAPES = {
    number: /0(?:x[\dA-Fa-f](?:_?[\dA-Fa-f])*|b[01](?:_?[01])*|o[0-7](?:_?[0-7])*)|[+-]?(?:0|[1-9](?:_?\d)*)((?:\.\d(?:_?\d)*)?(?:[eE][+-]?\d(?:_?\d)*)?)/y,
    special: /[+-]?(?:inf|nan)/y,
    date: new RegExp(`(\\d{4})-(0[1-9]|1[0-2])-(0[1-9]|[12]\\d|3[01])(?:[Tt ]${TIME}(?:[Zz]|[+-](?:[01]\\d|2[0-3]):[0-5]\\d)?)?`, "y"),
    time: new RegExp(TIME, "y"),
    bare: /[A-Za-z0-9_-]+/y,
    blank: /[ \t]*/y,
    comment: /#[^\n]*/y,
};
const CONTROL = /[\x00-\x08\x0a-\x1f\x7f]/, CONTROL_IN_LINES = /[\x00-\x08\x0b-\x1f\x7f]/;
const ESCAPES = { b: "\b", t: "\t", n: "\n", f: "\f", r: "\r", '"': '"', "\\": "\\" };

// Which tables and arrays a text has declared, by their keys.
class Declared {
    constructor() { Object.assign(this, { tables: new Set(), fixed: new Set(), pending: [] }); }

    static of(key) { return JSON.stringify(key); }

    isTable(key) { return this.tables.has(Declared.of(key)); }

    // Whether it is of a value in one piece, which nothing can be added to.
    isFixed(key) { return key.some((_, n) => this.fixed.has(Declared.of(key.slice(0, n + 1)))); }

    forget(key) {
        const begin = Declared.of(key).slice(0, -1);
        for (const set of [this.tables, this.fixed]) {
            for (const known of [...set]) if (known === `${begin}]` || known.startsWith(`${begin},`)) set.delete(known);
        }
    }

    settle() { for (const key of this.pending.splice(0)) this.tables.add(Declared.of(key)); }
}

class Toml {
    // The tables of a text; raises BadValue.
    static read(text) {
        const toml = new Toml(text.replace(/^\ufeff/, "").replace(/\r\n?/g, "\n"));
        return toml.document();
    }

    constructor(text) { Object.assign(this, { text, at: 0, root: new Map(), declared: new Declared() }); }

    get next() { return this.text[this.at]; }

    begins(word) { return this.text.startsWith(word, this.at); }

    fail(told, at = this.at) {
        const before = this.text.slice(0, at), line = before.split("\n").length;
        const column = [...before.slice(before.lastIndexOf("\n") + 1)].length + 1;
        throw new BadValue(`${told} (at ${at >= this.text.length ? "end of document" : `line ${line}, column ${column}`})`);
    }

    // What a shape matches here, or null; goes behind it.
    take(shape) {
        shape.lastIndex = this.at;
        const found = shape.exec(this.text);
        if (found) this.at += found[0].length;
        return found;
    }

    check(text, begin, refused, told) {
        const wrong = text.search(refused);
        if (wrong >= 0) this.fail(`${told} ${quoted(text[wrong])}`, begin + wrong);
    }

    comment() {
        const begin = this.at, found = this.take(SHAPES.comment);
        if (found) this.check(found[0].slice(1), begin + 1, CONTROL, "Found invalid character");
    }

    // Blanks, new lines and comments of an array.
    blanks() {
        for (let before = -1; before !== this.at;) {
            before = this.at;
            while (" \t\n".includes(this.next ?? "-")) this.at++;
            this.comment();
        }
    }

    document() {
        let header = [];
        while (this.at < this.text.length) {
            this.take(SHAPES.blank);
            const next = this.next;
            if (next === undefined) break;
            if (next === "[") header = this.header();
            else if (/[\w"'-]/.test(next)) this.pair(header);
            else if (next !== "#" && next !== "\n") this.fail("Invalid statement");
            this.take(SHAPES.blank);
            this.comment();
            if (this.next !== "\n" && this.next !== undefined) this.fail("Expected newline or end of document after a statement");
            this.at++;
        }
        return this.root;
    }

    static tuple(key) { return `(${key.map(quoted).join(", ")}${key.length === 1 ? "," : ""})`; }

    // [table] or [[array of tables]].
    header() {
        const { declared } = this, several = this.begins("[[");
        declared.settle();
        this.at += several ? 2 : 1;
        this.take(SHAPES.blank);
        const key = this.key(), named = Toml.tuple(key);
        if (several) {
            if (declared.isFixed(key)) this.fail(`Cannot mutate immutable namespace ${named}`);
            declared.forget(key);
        } else if (declared.isTable(key) || declared.isFixed(key)) {
            this.fail(`Cannot declare ${named} twice`);
        }
        declared.tables.add(Declared.of(key));
        if (several) {
            const above = this.inner(this.root, key.slice(0, -1)), last = key.at(-1);
            if (!above.has(last)) above.set(last, []);
            if (!Array.isArray(above.get(last))) this.fail("Cannot overwrite a value");
            above.get(last).push(new Map());
        } else {
            this.inner(this.root, key);
        }
        if (!this.begins(several ? "]]" : "]")) this.fail(several ? "Expected ']]' at the end of an array declaration" : "Expected ']' at the end of a table declaration");
        this.at += several ? 2 : 1;
        return key;
    }

    // The table below a key, made if it is missing; of an array of tables the last one.
    inner(table, key, lists = true) {
        for (const part of key) {
            if (!table.has(part)) table.set(part, new Map());
            table = table.get(part);
            if (lists && Array.isArray(table)) table = table.at(-1);
            if (!(table instanceof Map)) this.fail("Cannot overwrite a value");
        }
        return table;
    }

    pair(header) {
        const { declared } = this, [key, value] = this.keyAndValue();
        const whole = [...header, ...key], above = whole.slice(0, -1), last = key.at(-1);
        for (let n = 1; n < key.length; n++) {
            const part = [...header, ...key.slice(0, n)];
            if (declared.isTable(part)) this.fail(`Cannot redefine namespace ${Toml.tuple(part)}`);
            declared.pending.push(part);
        }
        if (declared.isFixed(above)) this.fail(`Cannot mutate immutable namespace ${Toml.tuple(above)}`);
        const table = this.inner(this.root, above);
        if (table.has(last)) this.fail("Cannot overwrite a value");
        if (typeof value === "object" && !(value instanceof Written || value instanceof Moment)) declared.fixed.add(Declared.of(whole));
        table.set(last, value);
    }

    keyAndValue() {
        const key = this.key();
        if (this.next !== "=") this.fail("Expected '=' after a key in a key/value pair");
        this.at++;
        this.take(SHAPES.blank);
        return [key, this.value()];
    }

    key() {
        const key = [];
        for (;;) {
            const bare = this.take(SHAPES.bare);
            if (bare) key.push(bare[0]);
            else if (this.next === "'") key.push(this.literal());
            else if (this.next === '"') key.push(this.basic());
            else this.fail("Invalid initial character for a key part");
            this.take(SHAPES.blank);
            if (this.next !== ".") return key;
            this.at++;
            this.take(SHAPES.blank);
        }
    }

    value() {
        if (this.begins('"""')) return this.lines('"');
        if (this.begins("'''")) return this.lines("'");
        if (this.next === '"') return this.basic();
        if (this.next === "'") return this.literal();
        if (this.next === "[") return this.array();
        if (this.next === "{") return this.table();
        for (const [word, value] of [["true", true], ["false", false]]) {
            if (this.begins(word)) {
                this.at += word.length;
                return value;
            }
        }
        return this.moment() ?? this.number() ?? this.fail("Invalid value");
    }

    moment() {
        const begin = this.at, date = this.take(SHAPES.date);
        if (!date) {
            const time = this.take(SHAPES.time);
            return time && new Moment(time[0]);
        }
        const [year, month, day] = date.slice(1, 4).map(Number);
        if (!year || new Date(Date.UTC(2000 + year % 400, month - 1, day)).getUTCDate() !== day) this.fail("Invalid date or datetime", begin);
        return new Moment(date[0]);
    }

    number() {
        const found = this.take(SHAPES.number);
        if (!found) {
            const special = this.take(SHAPES.special);
            return special && new Written(special[0]);
        }
        if (found[1]) return new Written(found[0]);
        const text = found[0].replaceAll("_", ""), whole = BigInt(text.replace(/^[+-]/, ""));
        return text.startsWith("-") ? -whole : whole;
    }

    array() {
        const made = [];
        this.at++;
        for (;;) {
            this.blanks();
            if (this.next === "]") break;
            made.push(this.value());
            this.blanks();
            if (this.next === "]") break;
            if (this.next !== ",") this.fail("Unclosed array");
            this.at++;
        }
        this.at++;
        return made;
    }

    table() {
        const made = new Map(), declared = new Declared();
        this.at++;
        this.take(SHAPES.blank);
        if (this.next === "}") {
            this.at++;
            return made;
        }
        for (;;) {
            const [key, value] = this.keyAndValue(), last = key.at(-1);
            if (declared.isFixed(key)) this.fail(`Cannot mutate immutable namespace ${Toml.tuple(key)}`);
            const above = this.inner(made, key.slice(0, -1), false);
            if (above.has(last)) this.fail(`Duplicate inline table key ${quoted(last)}`);
            above.set(last, value);
            this.take(SHAPES.blank);
            const next = this.next;
            if (next !== "}" && next !== ",") this.fail("Unclosed inline table");
            this.at++;
            if (next === "}") return made;
            if (value instanceof Map || Array.isArray(value)) declared.fixed.add(Declared.of(key));
            this.take(SHAPES.blank);
        }
    }

    // Goes behind the quotes, and behind the end of their line where a text of several lines begins.
    open(quote) {
        this.at += quote.length;
        if (quote.length > 1 && this.next === "\n") this.at++;
    }

    // Up to a quote; there are no escapes.
    literal(quote = "'", refused = CONTROL) {
        this.open(quote);
        const begin = this.at, end = this.text.indexOf(quote, begin);
        if (end < 0) this.fail(`Expected ${quoted(quote)}`, this.text.length);
        const text = this.text.slice(begin, end);
        this.check(text, begin, refused, "Found invalid character");
        this.at = end + quote.length;
        return text;
    }

    basic(quote = '"', refused = CONTROL) {
        let text = "";
        this.open(quote);
        for (;;) {
            const next = this.next;
            if (next === undefined) this.fail("Unterminated string");
            if (this.begins(quote)) break;
            if (refused.test(next)) this.fail(`Illegal character ${quoted(next)}`);
            text += next === "\\" ? this.escape(quote.length > 1) : next;
            if (next !== "\\") this.at++;
        }
        this.at += quote.length;
        return text;
    }

    escape(lines) {
        const letter = this.text[this.at + 1];
        this.at += 2;
        if (lines && " \t\n".includes(letter ?? "-")) {
            if (letter !== "\n") {
                this.take(SHAPES.blank);
                if (this.next === undefined) return "";
                if (this.next !== "\n") this.fail("Unescaped '\\' in a string");
                this.at++;
            }
            while (" \t\n".includes(this.next ?? "-")) this.at++;
            return "";
        }
        if (letter === "u" || letter === "U") {
            const count = letter === "u" ? 4 : 8, digits = this.text.slice(this.at, this.at + count);
            if (digits.length !== count || /[^\dA-Fa-f]/.test(digits)) this.fail("Invalid hex value");
            const code = parseInt(digits, 16);
            this.at += count;
            if (code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) this.fail("Escaped character is not a Unicode scalar value");
            return String.fromCodePoint(code);
        }
        return ESCAPES[letter] ?? this.fail("Unescaped '\\' in a string");
    }

    // A text of several lines; up to two quotes more at its end belong to it.
    lines(quote) {
        const three = quote.repeat(3);
        let text = quote === "'" ? this.literal(three, CONTROL_IN_LINES) : this.basic(three, CONTROL_IN_LINES);
        for (let more = 0; more < 2 && this.next === quote; more++, this.at++) text += quote;
        return text;
    }
}
