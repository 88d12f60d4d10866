# SPDX-License-Identifier: MIT
"""Plain lines: what a line without parameters and expressions becomes, with cutter compensation."""

from collections.abc import Sequence
from dataclasses import dataclass

from passo.expand.block import Word, words_of
from passo.expand.compensation import Compensation, Step
from passo.expand.height_map import HeightMap
from passo.expand.lathe import DIAMETERS, Lathe, Said
from passo.expand.machine import CYCLES, FEED_MODE, LINES_AND_ARCS, MOTION, PLANE, SYSTEM, Machine, Motion
from passo.expand.place import BOTH, ExpandError, LineError, Place, StateError
from passo.expand.refusals import explain
from passo.expand.surface import PROBES
from passo.expand.writer import Writer, flat, length
from passo.gcode import AXIS_LETTERS, LINEAR, Gcode, GcodeError

OFF, ON = 400, {410: 1, 411: 1, 420: -1, 421: -1}
# Commands that may be used while compensation is on, besides those that change nothing.
ALLOWED = {*LINES_AND_ARCS, 40, 610, 611, 640, 800, 200, 210, 900, 910, 911, 930, 940, OFF}
FROM_TABLE, UNITS = {430, 432}, (200, 210)  # G43 and G43.2; G20 and G21
MOVES = {*LINES_AND_ARCS, *CYCLES, 40, 100, 280, 300, 431, 800, 920}  # other commands for the axis words
TOOL_CHANGES, PAUSES, ENDS = (6, 61), (0, 1, 60), (2, 30)
# Commands that use the position, which is not that of the contour before the first motion after G40.
USES_POSITION = {100, 281, 301, 920, *range(382, 386)}
FIRST_AFTER = "the first motion after G40 must be a straight line: G0 or G1"


@dataclass(frozen=True)
class PlainLine:
    """A line that any Passo takes, and where it is from."""

    text: str
    place: Place


class Output:
    """Collects plain lines."""

    def __init__(self, machine: Machine, surface: HeightMap | None = None):
        self.machine, self.surface = machine, surface
        self._lathe = Lathe(machine)
        self.lines: list[PlainLine] = []
        self._compensation: Compensation | None = None
        self._leaving = False  # the first motion after G40 is due
        # In the plane of the compensation, while the tool is not where the program says.
        self._writer = Writer(machine.letters, machine.plane, [])
        self._compensated = False

    def begin(self, place: Place) -> None:
        """Plain lines have radii; where G7 is in force, a G8 comes first."""
        if self.machine.mode("DIAMETER") == DIAMETERS:
            self.machine.gcode.execute("G8")
            self.machine.diameters = True
            self.lines.append(PlainLine("G8", place))

    def take(self, text: str, words: Sequence[Word], comments: Sequence[str], place: Place) -> None:
        """A line as text, and its words; raises ExpandError."""
        try:
            for line in self._lathe.plain(Said(text, words, comments)):
                self._take(*line, place)
        except LineError as error:
            raise ExpandError(place, error) from None

    def _take(self, text: str, words: Sequence[Word], comments: Sequence[str], place: Place) -> None:
        codes = {word.code for word in words if word.letter == "G"}
        if codes & FROM_TABLE and self._knows_length(codes, words):
            units = [word for word in words if word.letter == "G" and word.code in UNITS]
            table = [word for word in words if _is_of_table(word)]
            self._advance(" ".join(map(str, [*units, *table])), table, place)
            made = [*units, Word("G", 43.1), Word("Z", self.machine.tool_length)]
            self.lines.append(PlainLine(" ".join(map(str, made)), place))
            words = [word for word in words if word not in [*units, *table]]
            text, codes = " ".join([*map(str, words), *comments]), codes - FROM_TABLE
            if not text:
                return
        if self.surface and self._probes(codes, words) and not self._compensation:
            self._probe(self.surface, text, words, comments, place)
        elif self._compensation or self._leaving or codes & ON.keys():
            self._take_compensated(text, words, comments, place, codes)
        else:
            if OFF in codes:
                self.machine.compensation = OFF
            self._advance(text, words, place)
            self.lines.append(PlainLine(text, place))

    def _probes(self, codes: set[int], words: Sequence[Word]) -> bool:
        """Whether a line is a probe, by its command or by the one in force."""
        moves = any(word.letter in self.machine.letters for word in words)
        in_force = self.machine.mode(MOTION) in PROBES and not codes & MOVES and moves
        return bool(codes & set(PROBES)) or in_force

    def _probe(
        self, surface: HeightMap, text: str, words: Sequence[Word], comments: Sequence[str], place: Place
    ) -> None:
        """A line to where a probe would end."""
        machine = self.machine
        try:
            end = machine.probe(surface, text, words)
        except GcodeError as error:
            raise ExpandError(place, explain(error, words, machine.gcode.settings)) from None
        rest = [word for word in words if word.letter not in machine.letters and not _is_probe(word)]
        scales = [machine.scale if letter in LINEAR else 1.0 for letter in machine.letters]
        moved = map(Word, machine.letters, (at / scale for at, scale in zip(end, scales, strict=True)))
        made = [*rest, Word("G", 53), Word("G", 1), *moved]
        self.lines.append(PlainLine(" ".join([*map(str, made), *comments]), place))

    def _knows_length(self, codes: set[int], words: Sequence[Word]) -> bool:
        """Whether that of G43 or G43.2 is in the table of tools, and its line changes no tool."""
        changes = any(word.letter == "M" and word.code // 10 in TOOL_CHANGES for word in words)
        tool = next((round(word.value) for word in words if word.letter == "H"), self.machine.tool)
        sure = 432 not in codes or self.machine.knows_length
        return sure and not changes and tool in self.machine.tools

    def _advance(self, text: str, words: Sequence[Word], place: Place) -> None:
        try:
            self.machine.advance(text, words)
        except GcodeError as error:
            raise ExpandError(place, explain(error, words, self.machine.gcode.settings)) from None

    def drop_contour(self) -> None:
        """A line is left out: the tool goes on as if G40 had been before."""
        self._compensation, self._leaving, self.machine.compensation = None, False, OFF

    def finish(self, check: bool = True) -> None:
        """The program has ended; raises ExpandError. Without `check`, lines were left out."""
        if self._compensation:
            self._compensation.finish()
        if self._compensated and check:
            self._check()

    def _check(self) -> None:
        """Whether an interpreter takes all lines."""
        gcode = Gcode(self.machine.gcode.settings)
        for line in self.lines:
            try:
                gcode.execute(line.text)
            except GcodeError as error:
                told = explain(error, words_of(line.text), gcode.settings)
                raise ExpandError(line.place, f"{told}; {line.text}") from None
            for _ in gcode.actions():
                pass

    def _execute(self, text: str, words: Sequence[Word], place: Place) -> Motion | None:
        try:
            return self.machine.execute(text, words)
        except GcodeError as error:
            raise ExpandError(place, explain(error, words, self.machine.gcode.settings)) from None

    def _take_compensated(
        self, text: str, words: Sequence[Word], comments: Sequence[str], place: Place, codes: set[int]
    ) -> None:
        commands = {word.code // 10 for word in words if word.letter == "M"}
        turned_on = codes & ON.keys()
        if OFF in codes:
            self._end()
        if self._compensation:
            self._refuse(codes, commands, place)
        elif self._leaving and not turned_on and self._passes(text, words, place, codes):
            return
        start = self.machine.work
        known = [self.machine.knows(axis) for axis in range(self.machine.axes)]
        rest = [word for word in words if not _of_compensation(word, bool(turned_on))]
        motion = self._execute(" ".join(map(str, rest)), rest, place)
        drills = self.machine.mode(MOTION) in CYCLES and any(word.letter in AXIS_LETTERS for word in rest)
        if self._leaving and drills:
            raise ExpandError(place, StateError(FIRST_AFTER, BOTH))
        if turned_on:
            self._begin(min(turned_on), words, start, place)
            self._refuse(codes - turned_on, commands, place)
        lead, tail = parts(rest, motion, self.machine.mode(FEED_MODE) == 930)
        label = ""
        if motion and not comments and [word.letter for word in lead] == ["N"]:
            label, lead = f"{lead[0]} ", []
        self._text(" ".join([*map(str, lead), *comments]), place)
        if motion:
            if self._compensation and self._compensation.first and not self.machine.incremental:
                self._need_known(known, place)
            self._move(motion, words, place, label)
        if tail:
            if self._compensation and commands & {*PAUSES, *ENDS}:
                self._compensation.finish()
            self._text(" ".join(map(str, tail)), place)

    def _passes(self, text: str, words: Sequence[Word], place: Place, codes: set[int]) -> bool:
        """Whether a line after G40 is not its last motion; it is taken then."""
        letters = {word.letter for word in words}
        plane = {self.machine.letters[axis] for axis in self._writer.plane}
        if codes & USES_POSITION:
            raise ExpandError(place, StateError(FIRST_AFTER, BOTH))
        if not codes & {280, 300, 530}:
            return False
        all_axes = plane <= letters or (not letters & set(AXIS_LETTERS) and 530 not in codes)
        if not all_axes and letters & plane:
            raise ExpandError(place, StateError(FIRST_AFTER, BOTH))
        self._execute(text, words, place)
        self.lines.append(PlainLine(text, place))
        self._leaving = not all_axes
        for axis, at in enumerate(self.machine.work):
            if axis not in self._writer.plane:
                self._writer.at[axis] = at
        return True

    def _refuse(self, codes: set[int], commands: set[int], place: Place) -> None:
        machine = self.machine
        refused = [
            _name(code) for code in sorted(codes - ALLOWED - {machine.mode(PLANE), machine.mode(SYSTEM)})
        ]
        refused += [f"M{command}" for command in TOOL_CHANGES if command in commands]
        if machine.mode(MOTION) not in (*LINES_AND_ARCS, 800):
            refused.append(_name(machine.mode(MOTION)))
        if refused:
            raise ExpandError(
                place,
                LineError(
                    f"{refused[0]} cannot be used while {self._command} is in force: write G40 before", BOTH
                ),
            )

    def _begin(self, code: int, words: Sequence[Word], start: tuple[float, ...], place: Place) -> None:
        machine, side = self.machine, ON[code]
        if machine.mode(PLANE) == 190:
            raise ExpandError(
                place, LineError(f"{_name(code)} is for the planes XY and ZX: write G17 or G18", BOTH)
            )
        if max(machine.plane) >= machine.axes:
            raise ExpandError(
                place, LineError(f"{_name(code)}: the machine has only one axis of this plane", BOTH)
            )
        radius = self._radius(code, words, place)
        if radius < 0:
            side, radius = -side, -radius
        machine.compensation = 410 if side > 0 else 420
        if not self._leaving:
            self._writer = Writer(machine.letters, machine.plane, list(start))
        if not radius:
            return
        if self._writer.plane != machine.plane:
            raise ExpandError(place, StateError(FIRST_AFTER, BOTH))
        self._leaving, self._compensated = False, True
        self._compensation = Compensation(side, radius, flat(start, self._writer.plane), self._emit)

    def _radius(self, code: int, words: Sequence[Word], place: Place) -> float:
        values = {word.letter: word.value for word in words}
        machine = self.machine
        if code in (411, 421):
            if "D" not in values:
                raise ExpandError(place, LineError(f"{_name(code)} needs the diameter of the tool: D", BOTH))
            if values.get("L", 0) not in (0, 9):
                raise ExpandError(
                    place, LineError(f"{_name(code)}: L: edges of lathe tools are not supported", BOTH)
                )
            return values["D"] * machine.scale / 2
        number = round(values["D"]) if "D" in values else machine.tool
        if number == 0:
            return 0.0
        if number is None:
            raise ExpandError(
                place, LineError(f"{_name(code)}: which tool? Write M6, D or {_name(code + 1)} D", BOTH)
            )
        if number not in machine.tools:
            raise ExpandError(
                place,
                LineError(
                    f"{_name(code)}: no tool table has T{number}: --tools, or {_name(code + 1)} D", BOTH
                ),
            )
        return machine.tools[number].diameter / 2

    def _end(self) -> None:
        self.machine.compensation = OFF
        if self._compensation:
            self._compensation.finish()
            self._leaving = not self._compensation.first
            self._compensation = None

    def _need_known(self, known: list[bool], place: Place) -> None:
        for axis in self._writer.plane:
            if not known[axis]:
                letter = self.machine.letters[axis]
                raise ExpandError(
                    place,
                    StateError(
                        f"{letter} is not known at its beginning: move {letter} before {self._command}", BOTH
                    ),
                )

    @property
    def _command(self) -> str:
        return _name(self.machine.compensation)

    def _move(self, motion: Motion, words: Sequence[Word], place: Place, label: str) -> None:
        machine, plane = self.machine, self._writer.plane
        step = Step(
            place, flat(motion.end, plane), motion.end, motion.rapid, motion.center, motion.clockwise,
            scale=machine.scale, incremental=machine.incremental, label=label,
        )  # fmt: skip
        if machine.mode(FEED_MODE) == 930 and not motion.rapid:
            rate = next(word.value for word in words if word.letter == "F")
            step.speed = rate * length(step, motion.start, motion.end, plane)
        if self._compensation is None:
            if motion.center is not None:
                raise ExpandError(place, StateError(FIRST_AFTER, BOTH))
            self._leaving = False
            self._emit(step, place)
        elif motion.center is None:
            self._compensation.line(step)
        else:
            self._compensation.arc(step)

    def _text(self, text: str, place: Place) -> None:
        if not text:
            return
        if self._compensation:
            self._compensation.text(text, place)
        else:
            self.lines.append(PlainLine(text, place))

    def _emit(self, item: Step | str, place: Place) -> None:
        """Write a line, or a motion of the tool's center."""
        if isinstance(item, str):
            self.lines.append(PlainLine(item, place))
            return
        self.lines.append(PlainLine(self._writer.write(item), place))


def _is_probe(word: Word) -> bool:
    return word.letter == "G" and word.code in PROBES


def _is_of_table(word: Word) -> bool:
    return word.letter == "H" or (word.letter == "G" and word.code in FROM_TABLE)


def _of_compensation(word: Word, turned_on: bool) -> bool:
    """Whether a word is for the compensation alone."""
    return (word.letter == "G" and word.code in {*ON, OFF}) or (turned_on and word.letter in "DL")


def parts(words: list[Word], motion: Motion | None, inverse: bool) -> tuple[list[Word], list[Word]]:
    """What of a line is before its motion, which is written again, and what is behind it."""
    lead, tail = [], []
    for word in words:
        if word.letter == "M" and word.code // 10 in (*PAUSES, *ENDS):
            tail.append(word)
        elif motion and (
            word.letter in AXIS_LETTERS + "IJKR"
            or (word.letter == "G" and word.code in LINES_AND_ARCS)
            or (word.letter == "F" and inverse)
        ):
            continue
        else:
            lead.append(word)
    return lead, tail


def _name(code: int) -> str:
    return f"G{code // 10}" + (f".{code % 10}" if code % 10 else "")
