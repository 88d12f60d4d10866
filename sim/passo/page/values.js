// SPDX-License-Identifier: MIT
// Values of a machine file, exact and checked as in sim/passo/table_values.py and sim/passo/values.py, with their messages.
// `RULES` holds what Python says of them: largest numbers, units, keys (sim/passo/web_rules.py).
"use strict";

// A fraction of integers.
class Exact {
    constructor(above, below = 1n) { Object.assign(this, { above, below }); }

    // A number of the language, whose bits are exact.
    static of(number) {
        let below = 1n;
        while (!Number.isInteger(number)) {
            number *= 2;
            below *= 2n;
        }
        return new Exact(BigInt(number), below);
    }

    static power(digits, exponent) {
        return exponent < 0 ? new Exact(digits, 10n ** BigInt(-exponent)) : new Exact(digits * 10n ** BigInt(exponent));
    }

    times(other) { return new Exact(this.above * other.above, this.below * other.below); }

    over(other) { return new Exact(this.above * other.below, this.below * other.above); }

    isAbove(other) { return this.above * other.below > other.above * this.below; }

    get ceiling() { return Number((this.above + this.below - 1n) / this.below); }

    // The nearest number of the language.
    get number() {
        const scale = 10n ** 40n, size = this.above < 0n ? -this.above : this.above;
        const [whole, rest] = [size / this.below, size % this.below];
        return (this.above < 0n ? -1 : 1) * Number(`${whole}.${String(rest * scale / this.below).padStart(40, "0")}`);
    }

    // The first six digits of it, which is not negative, and the power of ten of the first one; the rest is
    // rounded to even, or dropped.
    digits(drop) {
        let power = String(this.above / this.below).length - 1;
        if (this.above < this.below) while (Exact.power(1n, power).isAbove(this)) power--;
        const scaled = this.times(Exact.power(1n, 5 - power)), twice = 2n * (scaled.above % scaled.below);
        let six = scaled.above / scaled.below;
        if (!drop && (twice > scaled.below || (twice === scaled.below && six % 2n))) six++;
        return six < 1000000n ? [String(six), power] : ["100000", power + 1];
    }
}

// A number as Python's format "g" has it: six digits; `drop`: as a decimal without exponent, rounded down.
function short(number, drop = false) {
    const exact = number instanceof Exact ? number : Exact.of(number);
    if (!exact.above) return "0";
    if (exact.above < 0n) return `-${short(new Exact(-exact.above, exact.below), drop)}`;
    const [six, power] = exact.digits(drop), kept = six.replace(/0+$/, "");
    if (!drop && (power < -4 || power > 5)) {
        const rest = kept.length > 1 ? `.${kept.slice(1)}` : "";
        return `${kept[0]}${rest}e${power < 0 ? "-" : "+"}${String(Math.abs(power)).padStart(2, "0")}`;
    }
    if (power < 0) return `0.${"0".repeat(-power - 1)}${kept}`;
    const whole = six.padEnd(power + 1, "0").slice(0, power + 1), rest = kept.slice(power + 1);
    return rest ? `${whole}.${rest}` : whole;
}

// The nearest integer, or the even one of two.
function rounded(number) {
    const below = Math.floor(number), rest = number - below;
    return below + Number(rest > 0.5 || (rest === 0.5 && below % 2 === 1));
}

const letters = text => Array.from(text);

// A value in an array or a table, as Python shows it there.
function inside(value) {
    if (typeof value === "string") return quoted(value);
    if (typeof value === "boolean") return value ? "True" : "False";
    if (value instanceof Written) return `Decimal('${value.name}')`;
    if (Array.isArray(value)) return `[${value.map(inside).join(", ")}]`;
    if (value instanceof Map) return `{${Array.from(value, ([key, own]) => `${quoted(key)}: ${inside(own)}`).join(", ")}}`;
    return value.text ?? String(value);
}

// A value in a message.
function told(value) {
    const text = value instanceof Written ? value.text : typeof value === "boolean" ? String(value) : inside(value);
    return letters(text).length <= 40 ? text : `${letters(text).slice(0, 37).join("")}...`;
}

// How alike two words are, 0 to 1, by their longest common parts (difflib).
function likeness(one, other) {
    const common = (a, aEnd, b, bEnd) => {
        let best = [a, b, 0];
        for (let i = a; i < aEnd; i++) {
            for (let j = b; j < bEnd; j++) {
                let size = 0;
                while (i + size < aEnd && j + size < bEnd && one[i + size] === other[j + size]) size++;
                if (size > best[2]) best = [i, j, size];
            }
        }
        const [i, j, size] = best;
        return size && size + common(a, i, b, j) + common(i + size, aEnd, j + size, bEnd);
    };
    return one.length + other.length ? 2 * common(0, one.length, 0, other.length) / (one.length + other.length) : 1;
}

const LIKE = 0.6;

// "; did you mean ...?" if a known word is like this one, else empty.
function meant(word, known) {
    if (typeof word !== "string" || word.length > 100) return "";
    const near = known.map(own => [likeness(own, word), own]).filter(([like]) => like >= LIKE);
    near.sort(([one, a], [other, b]) => other - one || (a < b ? 1 : -1));
    return near.length ? `; did you mean ${near[0][1]}?` : "";
}

function wrong(text) { throw new BadValue(text); }

function within(place, check) {
    try {
        return check();
    } catch (error) {
        if (error instanceof BadValue) error.message = `${place}: ${error.message}`;
        throw error;
    }
}

function checkKnown(table, keys) {
    for (const key of table.keys()) {
        if (!keys.includes(key)) wrong(`unknown key ${told(key)}${meant(key, keys) || `; must be one of ${keys.join(", ")}`}`);
    }
}

function valueOf(table, key) { return table.has(key) ? table.get(key) : wrong(`${key} is missing`); }

const grouping = whole => String(whole).replace(/\B(?=(\d{3})+$)/g, "_");

// Digits times a power of ten against a limit, without making powers that no memory holds.
function exceeds(digits, exponent, largest) {
    if (digits <= 0n) return false;
    if (exponent + String(digits).length > 12) return true;
    return exponent >= -1000 && Exact.power(digits, exponent).isAbove(new Exact(BigInt(largest)));
}

// Digits times a power of ten, not larger than `largest` and not too fine.
function checkNumber(key, digits, exponent, largest) {
    if (exceeds(digits, exponent, largest)) wrong(`${key} must be at most ${largest}`);
    if (exceeds(-digits, exponent, largest)) wrong(`${key} must be at least -${largest}`);
    if (exponent < -RULES.decimals_max) wrong(`${key} must have at most ${RULES.decimals_max} decimals`);
    return digits ? Exact.power(digits, exponent) : new Exact(0n);
}

function readInteger(table, key, low, high) {
    const value = valueOf(table, key);
    if (typeof value !== "bigint") {
        let hint = "";
        if (value instanceof Written && value.finite && Math.abs(value.exponent) < 1000) {
            const { above, below } = Exact.power(value.digits, value.exponent), whole = above / below;
            if (!(above % below) && whole >= low && whole <= high) hint = `; write ${grouping(whole)}`;
        }
        wrong(`${key} must be a whole number, not ${told(value)}${hint}`);
    }
    if (value < low || value > high) wrong(`${key} must be ${low} to ${high}`);
    return Number(value);
}

// Digits and exponent of a number.
function numberOf(table, key, others = "") {
    const value = valueOf(table, key);
    if (typeof value === "bigint") return [value, 0];
    if (!(value instanceof Written)) wrong(`${key} must be a number${others}, not ${told(value)}`);
    if (!value.finite) wrong(`${key} must be finite, not ${value.name}`);
    return [value.digits, value.exponent];
}

// A number that is not negative, exact.
function readNumber(table, key, others) {
    const [digits, exponent] = numberOf(table, key, others);
    if (digits < 0n) wrong(`${key} must not be negative`);
    return checkNumber(key, digits, exponent, RULES.number_max);
}

function readSigned(table, key) { return checkNumber(key, ...numberOf(table, key), RULES.signed_max).number; }

// Seconds, exact, or a text with a unit.
function readTime(table, key, hz) {
    const value = valueOf(table, key);
    return typeof value === "string" ? parseTime(key, value, hz) : readNumber(table, key, ' or a text such as "400ms"');
}

const NUMBER = /^([+-]?)(\d(?:_?\d)*\.?(?:\d(?:_?\d)*)?|\.\d(?:_?\d)*)(?:[eE]([+-]?0*\d{1,5}))?$/;

function parseTime(key, text, hz) {
    const trimmed = text.trim().replace(/[\u00b5\u03bc]/g, "u");
    const unit = Object.keys(RULES.units).find(own => trimmed.endsWith(own) && trimmed.length > own.length);
    const found = NUMBER.exec(unit ? trimmed.slice(0, -unit.length).trimEnd() : text);
    if (!found) wrong(`${key} must be a number or a text such as "400ms", not ${told(text)}`);
    const [, sign, number, power = "0"] = found, [whole, decimals = ""] = number.replaceAll("_", "").split(".");
    const digits = BigInt(whole + decimals) * (sign === "-" ? -1n : 1n);
    const value = checkNumber(key, digits, Number(power) - decimals.length + (RULES.units[unit] ?? 0), RULES.number_max);
    if (value.above < 0n) wrong(`${key} must not be negative`);
    return unit === "clocks" ? value.over(new Exact(BigInt(hz))) : value;
}

function readWord(table, key, choices) {
    const word = valueOf(table, key);
    if (!choices.includes(word)) wrong(`${key} must be one of ${choices.join(", ")}, not ${told(word)}${meant(word, choices)}`);
    return word;
}

function readFlag(table, key) {
    const flag = valueOf(table, key);
    return typeof flag === "boolean" ? flag : wrong(`${key} must be true or false, not ${told(flag)}`);
}

function readSubtable(table, key) {
    const inner = table.get(key) ?? new Map();
    return inner instanceof Map ? inner : wrong(`${key} must be a table: [${key}]`);
}

function readTables(table, key) {
    const tables = table.get(key) ?? [];
    if (!Array.isArray(tables) || !tables.every(inner => inner instanceof Map)) wrong(`${key} must be an array of tables: [[${key}]]`);
    return tables;
}

function readClock(table) {
    const hz = readInteger(table, "clock_hz", 1, RULES.whole_max);
    return hz >= RULES.clock_hz_min ? hz : wrong(`clock_hz = ${hz} is in Hz: write ${hz}_000_000 for ${hz} MHz`);
}
