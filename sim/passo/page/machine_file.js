// SPDX-License-Identifier: MIT
// Machine files on the page: read and checked in the order of sim/passo/machine_file.py, with its messages. Its keys,
// ranges, drives and boards are in RULES; tests/test_web_machine.py compares both readers.
"use strict";

let RULES = null;  // of sim/passo/web_rules.py

class MachineReader {
    // The machine of a text as the page knows it, with the members of web_machine() (tests/helpers/web_machine.py); raises BadValue.
    static read(text) {
        let data;
        try {
            data = Toml.read(text);
        } catch (error) {
            if (error instanceof RangeError) wrong("nested too deeply");
            error.message = MachineReader.unquoted(text, error.message);
            throw error;
        }
        return new MachineReader(data).machine();
    }

    // A word without quotes is named.
    static unquoted(text, said) {
        const place = /\(at line (\d+), /.exec(said);
        const line = place && text.split(/\r\n|[\n\r\v\f\x1c-\x1e\x85\u2028\u2029]/)[place[1] - 1];
        const bare = line && /^\s*([\p{L}\p{N}_-]+)\s*=\s*((?:[.\p{Nd}_]+\s*)?(?!\p{Nd})[\p{L}\p{N}_][\p{L}\p{N}_.µ-]*)\s*(?:#.*)?$/u.exec(line);
        return bare ? `${said}: ${bare[1]} = "${bare[2]}" needs quotes` : said;
    }

    constructor(data) { this.data = data; }

    // The value of a key, or another one without it; `read` checks it.
    static own(table, key, otherwise, read = (own, name) => readNumber(own, name).number) {
        return table.has(key) ? read(table, key) : otherwise;
    }

    machine() {
        const { data } = this, { own } = MachineReader, { defaults } = RULES;
        checkKnown(data, RULES.keys.file);
        const wanted = data.has("clock_hz") || !data.has("board") ? readClock(data) : null;
        const pins = this.pinTable(), tables = readTables(data, "axis");
        if (tables.length < 1 || tables.length > RULES.letters.length) {
            wrong(`there are ${tables.length} axes; must be 1 to ${RULES.letters.length}: [[axis]]`);
        }
        this.tables = tables;
        const profile = own(data, "profile", RULES.profiles[0], (table, key) => readWord(table, key, RULES.profiles));
        this.axes = this.ofAxes(n => MachineReader.axis(tables[n]));
        this.readLetters();
        this.ofAxes(n => profile === "jerk" && !this.axes[n].jerk.number && wrong('profile = "jerk" needs its jerk in mm/s^3'));
        this.ends = this.ofAxes(n => MachineReader.ends(tables[n]));
        this.readMotors();
        this.readSwitches();
        this.checkSquared();
        const spindle = own(data, "spindle_maximum", 0, (table, key) => readInteger(table, key, 1, RULES.whole_max));
        [this.wait, this.atSpeed] = this.readWaits(spindle);
        this.parts = RULES.parts.filter(part => ({
            inputs: this.switches.probe || this.ends.some(end => end.switches.length) || this.atSpeed,
            encoders: data.has("spindle") || this.ends.some(end => end.encoders.length),
            outputs: spindle > 0,
        })[part]);
        this.hz = this.board(wanted);
        this.pins = within("pins", () => this.readPins(pins));
        this.deviation = own(data, "junction_deviation", defaults.junction_deviation);
        this.checkPins();
        this.ofAxes(n => this.checkEncoders(this.axes[n], this.ends[n]));
        if (this.switches.soft_limits && !this.ends.some(end => end.home)) wrong("soft_limits: no axis has a home");
        const tolerance = own(data, "arc_tolerance", defaults.arc_tolerance);
        if (!tolerance) wrong("arc_tolerance must be greater than 0");
        this.spindle = within("spindle", () => this.readSpindle(spindle));
        own(data, "laser", false, readFlag);
        own(data, "chip", "", (table, key) => readWord(table, key, RULES.chips));
        own(data, "host", "", (table, key) => readWord(table, key, RULES.hosts));
        return this.described(profile, tolerance, spindle);
    }

    // What a function returns for each axis; its errors name the axis.
    ofAxes(read) { return this.tables.map((_, n) => within(`axis ${n + 1}`, () => read(n))); }

    // The table [pins] with what the drive needs where it says nothing itself.
    pinTable() {
        const own = readSubtable(this.data, "pins"), has = this.data.has("drive");
        const drive = has ? RULES.drives[readWord(this.data, "drive", Object.keys(RULES.drives))] : {};
        within("pins", () => MachineReader.own(own, RULES.enable_inverted, false, readFlag));
        return new Map([...Object.entries(drive), ...own]);
    }

    static axis(table) {
        checkKnown(table, RULES.keys.axis);
        const limits = { jerk: Exact.of(0), jump: Exact.of(0) };
        for (const key of ["steps_per_mm", "speed", "acceleration"]) {
            limits[key] = readNumber(table, key);
            if (!limits[key].above) wrong(`${key} must be greater than 0`);
        }
        for (const key of ["jerk", "jump"]) if (table.has(key)) limits[key] = readNumber(table, key);
        return limits;
    }

    // A letter for each axis; without a name it is the one that follows.
    readLetters() {
        this.letters = "";
        this.tables.forEach((table, n) => {
            const all = RULES.letters, before = this.letters;
            const left = before ? all.slice(all.indexOf(before.at(-1)) + 1) : all;
            const allowed = before ? left : left.replace(/[YZ]/g, "");
            const name = table.has("name") ? table.get("name") : left.slice(0, 1);
            if (typeof name !== "string" || name.length !== 1 || !allowed.includes(name)) {
                const named = letters(allowed).map(letter => `"${letter}"`).join(", ").replace(/(.*), /, "$1 or ");
                wrong(
                    `axis ${n + 1}: name must be ${named || "left out, C is the last one"}, not ${told(name)}: ` +
                    "axes are X, Y, Z, A, B, C in order; A, B, C may be left out, of X, Y, Z the last ones, or Y",
                );
            }
            this.letters += name;
        });
    }

    static ends(table) {
        const { own } = MachineReader, home = table.get("home") ?? null, switches = table.get("switches") ?? [];
        if (home !== null && !RULES.home_ends.includes(home)) wrong(`home must be "low" or "high", not ${told(home)}`);
        if (!Array.isArray(switches) || !switches.every(one => RULES.switches.includes(one))) {
            wrong(`switches must be an array of ${RULES.switches.join(", ")}`);
        }
        const twice = switches.find((one, n) => switches.indexOf(one, n + 1) > 0);
        if (twice) wrong(`switches has ${twice} twice`);
        if (!own(table, "travel", RULES.defaults.travel)) wrong("travel must be greater than 0");
        const motors = own(table, "motors", 1, (inner, key) => readInteger(inner, key, 1, RULES.motors_most));
        const ofMotors = key => {
            const given = table.get(key) ?? [];
            if (!Array.isArray(given) || ![0, motors].includes(given.length)) wrong(`${key} must be an array of ${motors} numbers, one for each motor`);
            return given.map(value => readSigned(new Map([[key, value]]), key));
        };
        const [offsets, encoders, following] = [ofMotors("offsets"), ofMotors("encoders"), own(table, "following", 0)];
        const ends = { home, switches, motors, offsets, encoders, following };
        MachineReader.checkFollowing(ends);
        ends.homing = home && (switches.includes("home") ? "home" : `limit_${home}`);
        if (home && !switches.includes(ends.homing)) wrong(`home = "${home}" needs "home" or "${ends.homing}" in switches`);
        const given = RULES.backlash.find(key => table.has(key));
        if (given) wrong(`${given}: only passo run, make and console --grbl take backlash up`);
        return ends;
    }

    static checkFollowing({ encoders, following }) {
        if (encoders.some(counts => counts < 0)) wrong("encoders must not be negative: swap A and B");
        if (encoders.length && !encoders.some(Boolean)) wrong("encoders: no motor has one");
        if (encoders.length > 0 !== following > 0) wrong("encoders and following need each other: counts per mm, and mm");
        for (const counts of encoders.filter(Boolean)) {
            const limit = counts * following, most = RULES.following_counts;
            if (!(limit > 0.5 && limit < most + 0.5)) wrong(`following is ${short(limit)} counts; must be 1 to ${most}`);
        }
    }

    // The kinematics, and a row per motor: which axes it moves.
    readMotors() {
        const { data, axes, ends } = this, count = axes.length;
        const kinematics = MachineReader.own(data, "kinematics", "cartesian", (own, key) => readWord(own, key, Object.keys(RULES.kinematics)));
        const shared = RULES.kinematics[kinematics], rows = axes.map((_, n) => axes.map((_, m) => Number(m === n)));
        const table = readSubtable(data, "motors");
        within("motors", () => checkKnown(table, RULES.keys.motors));
        if (shared.length) {
            this.checkShared(kinematics, shared);
            const [one, other] = shared;
            rows[one][other] = rows[other][one] = 1;
            rows[other][other] = -1;
        } else if (table.size) {
            wrong('motors: its limits are those of motors that two axes share: kinematics = "corexy"');
        }
        const more = ends.flatMap((end, n) => Array(end.motors - 1).fill(rows[n]));
        if (count + more.length > RULES.letters.length) wrong(`there are ${count + more.length} motors; must be at most ${RULES.letters.length}`);
        const limits = {};
        for (const key of RULES.keys.motors) limits[key] = table.has(key) ? readNumber(table, key).number : 0;
        for (const key of RULES.keys.motors) if (table.has(key) && !limits[key]) wrong(`motors: ${key} must be greater than 0`);
        this.rows = [...rows, ...more];
        this.map = shared.length || more.length ? this.rows : [];
        this.mixed = { steps_per_mm: 0, jump: 0, ...limits };
    }

    checkShared(kinematics, shared) {
        const { axes, ends } = this, all = letters(RULES.letters), told = `kinematics = "${kinematics}"`;
        const missing = all.slice(0, Math.max(...shared) + 1).find(letter => !this.letters.includes(letter));
        if (missing) wrong(`${told} needs an axis ${missing}`);
        const [one, other] = shared.map(n => axes[n].steps_per_mm), named = shared.map(n => all[n]).join(" and ");
        if (one.isAbove(other) || other.isAbove(one)) {
            wrong(`${told}: ${named} share their motors, but steps_per_mm is ${short(one.number)} and ${short(other.number)}`);
        }
        for (const n of shared) {
            if (ends[n].motors > 1) wrong(`axis ${n + 1}: motors is ${ends[n].motors}, but with ${told} ${named} share two`);
            const limit = ends[n].switches.find(own => own !== "home");
            if (limit) wrong(`axis ${n + 1}: switches: ${limit} would block a motor that also moves another axis: use "home"`);
        }
    }

    readSwitches() {
        const { data } = this, { own } = MachineReader, table = readSubtable(data, "switches"), home = readSubtable(data, "home");
        const { defaults } = RULES, found = {};
        within("switches", () => checkKnown(table, RULES.keys.switches));
        within("home", () => checkKnown(home, [...RULES.keys.home, "racking"]));
        for (const key of RULES.keys.home) found[key] = own(home, key, defaults[key]);
        for (const key of RULES.keys.home) if (!found[key]) wrong(`home: ${key} must be greater than 0`);
        own(table, "inverted", false, readFlag);
        own(table, "debounce", 0);
        own(table, "stop", true, readFlag);
        found.probe = own(data, "probe", false, readFlag);
        found.racking = own(home, "racking", 0);
        found.soft_limits = own(data, "soft_limits", false, readFlag);
        this.switches = found;
    }

    checkSquared() {
        const { switches: { racking, pull_off, speed }, ends, axes } = this;
        const squares = end => end.motors > 1 && end.home !== null;
        if (racking && !ends.some(squares)) wrong("home: racking needs an axis with a home and several motors");
        if (racking && racking < pull_off) wrong(`home: racking must be at least pull_off, ${short(pull_off)} mm`);
        this.ofAxes(n => {
            const end = ends[n], { offsets } = end;
            if (!racking || !squares(end)) {
                if (offsets.length) wrong("offsets are of motors that square: home: racking is missing");
                return;
            }
            if (end.homing === "home") wrong(`${end.motors} motors and one home switch: to square, each has switches = ["limit_${end.home}"]`);
            if (offsets.some(offset => Math.abs(offset) > pull_off)) wrong(`offsets must be at most pull_off, ${short(pull_off)} mm`);
            const apart = offsets.length ? Math.max(...offsets) - Math.min(...offsets) : 0;
            if (apart > racking) wrong(`offsets are ${short(apart)} mm apart; must be at most racking, ${short(racking)}`);
            const slow = Math.min(speed, axes[n].speed.number), stop = slow * slow / 2 / axes[n].acceleration.number;
            if (stop >= racking / 2) wrong(`home: speed needs ${short(stop)} mm to stop; must be less than half of racking`);
        });
    }

    // The clock: that of the board with these parts, or that of the file if the PLL of the board makes it.
    board(wanted) {
        const { data, ends, parts } = this;
        if (!data.has("board")) return wanted;
        const name = readWord(data, "board", Object.keys(RULES.boards)), board = RULES.boards[name];
        const refused = board.refused[`${this.rows.length + Number(data.has("spindle"))} ${parts.join()}`];
        if (refused) wrong(refused);
        let hz = board.hz[Number(parts.length > 0)];
        if (wanted !== null) {
            hz = board.clocks.reduce((best, own) => (Math.abs(own - wanted) < Math.abs(best - wanted) ? own : best));
            if (Math.abs(hz - wanted) > wanted / 100) {
                wrong(`clock_hz: the PLL cannot generate ${short(wanted / 1e6)} MHz from ${short(board.oscillator_mhz)} MHz`);
            }
        }
        ends.forEach(({ switches }, n) => {
            if (board.shared && switches.length > 1) wrong(`axis ${n + 1}: switches: the board ${name} has one pin for ${switches.join(" and ")}`);
            if (board.shared && n + 1 === this.atSpeed && switches.length) {
                wrong(`spindle_at_speed: the board ${name} has one pin for P${n + 1} and ${switches[0]} of axis ${n + 1}`);
            }
        });
        if (wanted !== null && wanted !== hz) wrong(`clock_hz is ${wanted}, but the PLL of the board ${name} makes ${hz}`);
        return hz;
    }

    readPins(table) {
        const { hz } = this, most = RULES.pin_clocks_max;
        checkKnown(table, [...RULES.keys.pins, RULES.enable_inverted]);
        return RULES.keys.pins.map(key => {
            const seconds = table.has(key) ? readTime(table, key, hz) : new Exact(...RULES.pin_default.split("/").map(BigInt));
            if (!seconds.above) wrong(`${key} is 0 clocks; must be 1 to ${most}`);
            const clocks = seconds.times(new Exact(BigInt(hz))).ceiling;
            const hint = seconds.above >= seconds.below ? '; a number is in seconds, a text may have a unit: "2us"' : "";
            return clocks > most ? wrong(`${key} is ${clocks} clocks; must be at most ${most}${hint}`) : clocks;
        });
    }

    // Directions that have limits: axes, then motors that move two of them.
    limits() {
        const found = this.axes.map((axis, n) => [`axis ${n + 1}`, axis]);
        for (const row of this.rows.filter(own => own.filter(Boolean).length > 1)) {
            const moved = this.axes.filter((_, n) => row[n]), size = Math.sqrt(moved.length), own = {};
            for (const key of ["speed", "acceleration", "jerk", "jump"]) {
                own[key] = Exact.of((this.mixed[key] || Math.max(...moved.map(axis => axis[key].number))) / size);
            }
            found.push(["motors", { ...own, steps_per_mm: Exact.of(moved[0].steps_per_mm.number * size) }]);
        }
        return found;
    }

    // Whether the pins can make as many steps as an axis may ask for, and have room for those that come while DIR turns.
    checkPins() {
        const { hz, pins: [high, low, setup, hold], deviation } = this;
        for (const [name, axis] of this.limits()) {
            const highest = new Exact(BigInt(hz), BigInt(high + low)).over(axis.steps_per_mm);
            if (axis.speed.isAbove(highest)) {
                wrong(
                    `${name}: speed is ${short(axis.speed.number)}; the pins allow at most ${short(highest, true)}: ` +
                    `step_high and step_low are ${high + low} clocks`,
                );
            }
            const seconds = (high + low + setup + hold) / hz, acceleration = axis.acceleration.number;
            const fastest = Math.min(axis.speed.number, Math.max(axis.jump.number, Math.sqrt(8 * acceleration * deviation)));
            const allowed = RULES.waiting_steps / axis.steps_per_mm.number / seconds - acceleration * seconds / 2;
            if (fastest > allowed) {
                wrong(
                    `${name}: it may reverse at ${short(fastest)} mm/s (jump, junction_deviation), ` +
                    `the pins allow at most ${short(Math.max(0, allowed), true)}: a step and a change of DIR take ${short(seconds)} s`,
                );
            }
        }
    }

    checkEncoders(axis, { encoders }) {
        const fastest = axis.speed.number * Math.max(0, ...encoders), most = this.hz / RULES.count_clocks;
        if (fastest > most) wrong(`encoders make ${short(fastest)} counts/s at speed; the core can take ${short(most)}`);
        for (const counts of encoders.filter(Boolean)) {
            const ratio = counts / axis.steps_per_mm.number, set = ratio * RULES.ratio_one;
            if (!(set > 0.5 && set < 2 ** 32 - 0.5)) wrong(`encoders: ${short(ratio)} counts per step cannot be set`);
        }
    }

    // Seconds that motions wait for the spindle, and the input that says that it is at its speed, or 0.
    readWaits(maximum) {
        const { data, ends } = this, { own } = MachineReader, most = RULES.spindle_wait_max;
        const wait = own(data, "spindle_wait", 0);
        if (wait && !maximum) wrong("spindle_wait: it needs spindle_maximum");
        if (wait > most) wrong(`spindle_wait must be at most ${most} s`);
        const input = own(data, "spindle_at_speed", 0, (table, key) => readInteger(table, key, 1, this.rows.length));
        if (!input) return [wait, 0];
        if (!wait) wrong("spindle_at_speed: it needs spindle_wait, the seconds after which it is an error");
        if (ends[input - 1]?.switches.includes("home")) wrong(`spindle_at_speed: input P${input} is the home switch of axis ${input}`);
        return [wait, input];
    }

    // Counts per turn of its encoder and what its simulation needs, as spindle_wheel() of sim/passo/grbl_setup.py has them; 0: none.
    readSpindle(maximum) {
        const { data } = this, { own } = MachineReader, one = RULES.ratio_one;
        if (!data.has("spindle")) {
            const ticks = RULES.ticks_per_count * this.hz * one / RULES.spindle_ticks;
            return this.atSpeed ? [0, Math.floor(ticks), 0, rounded(RULES.defaults.start_up * this.hz)] : [0, 0, 0, 0];
        }
        const table = readSubtable(data, "spindle"), [low, high] = RULES.counts, most = RULES.wander_max;
        checkKnown(table, RULES.keys.spindle);
        if (!maximum) wrong("it needs spindle_maximum");
        const counts = readInteger(table, "counts", low, high);
        const startUp = own(table, "start_up", RULES.defaults.start_up), wander = own(table, "wander", 0);
        if (!startUp || wander > most) wrong(`start_up must be greater than 0, wander at most ${most} %`);
        return [counts, rounded(this.hz * 60 * one / (maximum * counts)), rounded(wander * one / 100), rounded(startUp * this.hz)];
    }

    get motors() {
        const count = {};
        return this.rows.map(row => {
            const moved = letters(this.letters).map((letter, n) => [row[n], letter]).filter(([part]) => part);
            const name = moved.map(([part, letter]) => (part < 0 ? "-" : "+") + letter).join("").replace(/^\+/, "");
            if (moved.length > 1) return name;
            count[name] = (count[name] ?? 0) + 1;
            return name + (count[name] > 1 ? count[name] : "");
        });
    }

    // The members of web_machine() (tests/helpers/web_machine.py).
    described(profile, tolerance, spindle) {
        const { axes, rows, map, parts, mixed } = this, count = rows.length, has = part => Number(parts.includes(part));
        const before = RULES.letters.slice(0, RULES.letters.indexOf(this.letters.at(-1)));
        const leftOut = letters(before).reduce((sum, letter, n) => sum + (this.letters.includes(letter) ? 0 : 1 << n), 0);
        const bits = sign => Array.from({ length: RULES.motors }, (_, motor) => (map[motor] ?? []).reduce((sum, part, n) => sum + (part === sign) * (1 << n), 0));
        const limits = own => RULES.limits.map(key => own[key].number ?? own[key]);
        return {
            numbers: [
                this.hz, axes.length, this.deviation, tolerance, RULES.profiles.indexOf(profile),
                RULES.cores.find(own => own >= count + Number(this.spindle[0] > 0)), ...this.pins, spindle, leftOut, has("inputs") * (1 + count), has("outputs"),
                ...this.spindle, rounded(this.wait * 1e6), this.atSpeed, map.length, ...bits(1), ...bits(-1), ...limits(mixed), ...axes.flatMap(limits),
            ],
            clock_hz: this.hz,
            letters: this.letters,
            profile,
            inputs: has("inputs") * (1 + count),
            power: has("outputs"),
            turn_counts: this.spindle[0],
            spindle: [short(this.wait), this.atSpeed],
            rows,
            motors: this.motors.map((name, n) => ({ name, per_step: 1 / axes[rows[n].findIndex(Boolean)].steps_per_mm.number })),
        };
    }
}
