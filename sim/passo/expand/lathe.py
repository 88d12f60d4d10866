# SPDX-License-Identifier: MIT
"""Words that plain lines do not have: diameters become radii; threads and taps, G33 and G33.1."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from passo.expand.block import Word
from passo.expand.machine import FEED_MODE, PLANE, RETRACT, SPINDLE, Machine
from passo.expand.place import LineError, StateError
from passo.gcode import AXIS_LETTERS, NANOMETERS

DIAMETERS, RADII = 70, 80
THREADING, TAPPING = 760, {840: 30, 740: 40}  # and the M that taps need, in tenths
MOTIONS = {0, 10, 20, 30, 330, 331, *range(382, 386), 730, *range(800, 900)}
NORMAL = {170: "Z", 180: "Y", 190: "X"}  # axis of the holes, by the plane
PASSES_MAX = 1000
NOTHING = 1e-9


class Said(NamedTuple):
    """A line: as text, its words, its comments."""

    text: str
    words: Sequence[Word]
    comments: Sequence[str]


def said(words: Sequence[Word], comments: Sequence[str] = ()) -> Said:
    """A line of these words."""
    return Said(" ".join([*map(str, words), *comments]), words, comments)


@dataclass(frozen=True)
class _Tap:
    """What G84 or G74 keeps, in the units in force."""

    code: int
    bottom: float
    level: float
    initial: float  # before the first hole
    pitch: float


class Lathe:
    """Rewrites the lines of a program for `machine`, which has taken those before."""

    def __init__(self, machine: Machine):
        self.machine = machine
        self._tap: _Tap | None = None

    def becomes_others(self, words: Sequence[Word]) -> bool:
        """Whether a line is a thread or a tap, by its command or that in force, which other motions end."""
        codes = {word.code for word in words if word.letter == "G"}
        if codes & MOTIONS:
            self._tap = None
        moves = any(word.letter in AXIS_LETTERS for word in words)
        return bool(codes & {THREADING, *TAPPING}) or (self._tap is not None and moves)

    def plain(self, line: Said) -> Iterator[Said]:
        """The lines that a line becomes, each to be taken before the next; raises LineError."""
        line = self._radii(line)
        codes = {word.code for word in line.words if word.letter == "G"}
        if codes & (MOTIONS | {THREADING}):
            self._tap = None
        if THREADING in codes:
            yield from self._thread(line)
        elif codes & TAPPING.keys():
            yield from self._taps(line, min(codes & TAPPING.keys()))
        elif self._tap and any(word.letter in AXIS_LETTERS for word in line.words):
            yield from self._taps(line, self._tap.code)
        elif line.text:
            yield line

    def _radii(self, line: Said) -> Said:
        codes = {word.code for word in line.words if word.letter == "G"} & {DIAMETERS, RADII}
        if len(codes) == 1:
            self.machine.diameters = codes == {DIAMETERS}
            line = said([word for word in line.words if not _is_g(word, codes)], line.comments)
        if self.machine.diameters and any(word.letter == "X" for word in line.words):
            shares = [0.5 if word.letter == "X" else 1 for word in line.words]
            halved = zip(line.words, shares, strict=True)
            line = said([replace(word, value=word.value * share) for word, share in halved], line.comments)
        return line

    def _split(
        self, line: Said, codes: set[int], letters: str, name: str
    ) -> tuple[dict[str, float], Said | None]:
        """The words of a cycle, and what else the line says, which comes first."""
        values = {word.letter: word.value for word in line.words if word.letter in letters}
        rest = [word for word in line.words if word.letter not in letters and not _is_g(word, codes)]
        if clash := [word for word in rest if word.letter == "G" and word.code in MOTIONS]:
            raise LineError(f"{name} and {clash[0]} are both motions")
        return values, said(rest, line.comments) if rest or line.comments else None

    def _thread(self, line: Said) -> Iterator[Said]:
        """G76, as LinuxCNC 2.9 has it, but that the way in to a tapered end is a rapid."""
        machine = self.machine
        values, rest = self._split(line, {THREADING}, "XZPIJKRQHEL", "G76")
        if rest:
            yield rest
        for letter in "ZPIJK":
            if letter not in values:
                raise LineError(f"G76 lacks {letter}")
        ends, taper = values.get("L", 0), max(0.0, values.get("E", 0))
        if ends not in range(4):
            raise LineError("G76: L must be 0 to 3: 1, the beginning is tapered, 2, the end, 3, both")
        share = 2 if machine.diameters else 1
        peak, first, height = (abs(values[letter]) / share for letter in "IJK")
        if height <= first or not first:
            raise LineError("G76: K must be greater than J, and J greater than 0")
        x, z = (self._place(letter, "G76") for letter in "XZ")
        base_x, base_z = (x, z) if machine.incremental else (0.0, 0.0)
        end_x, end_z = base_x + values["X"] if "X" in values else x, base_z + values["Z"]
        sense = 1 if end_z > z else -1
        slope = -sense * math.tan(math.radians(values.get("Q", 0)))
        tapered = [taper if int(ends) & end else 0.0 for end in (1, 2)]
        if sum(tapered) > abs(end_z - z):
            raise LineError("G76: E: the tapered ends are longer than the thread")
        pitch = Word("K", values["P"])
        steep = Word("K", values["P"] * (math.hypot(taper, height) / taper if taper else 1))
        outward = 1 if values["I"] > 0 else -1  # into the work
        absolute = [Word("G", 90)] if machine.incremental else []
        back = [Word("G", 91)] if machine.incremental else []
        for depth in _depths(first, height, max(1.0, values.get("R", 1)), round(values.get("H", 0))):
            clear, cut = (x + outward * way for way in (depth - height, peak + depth))
            touch = Word("X", cut - outward * height)
            begin, end = z - depth * slope, end_z + (height - depth) * slope
            yield said([*absolute, Word("G", 0), Word("X", clear), Word("Z", begin)])
            absolute = []
            if tapered[0]:
                yield said([touch])
                yield said([Word("G", 33), Word("X", cut), Word("Z", begin + sense * taper), steep])
            else:
                yield said([Word("X", cut)])
            yield said([Word("G", 33), Word("Z", end - sense * tapered[1]), pitch])
            if tapered[1]:
                yield said([touch, Word("Z", end), steep])
            yield said([Word("G", 0), Word("X", clear)])
        yield said([Word("X", end_x), Word("Z", end_z)])
        if back:
            yield said(back)

    def _taps(self, line: Said, code: int) -> Iterator[Said]:
        """Holes of G84 or G74: each is G33.1, with F as that of the speed of the spindle."""
        machine, name = self.machine, f"G{code // 10}"
        values, rest = self._split(line, set(TAPPING), f"{AXIS_LETTERS[:3]}RL", name)
        if any(word.letter in "PQK" for word in line.words):
            raise LineError(f"{name} takes neither P nor Q nor K: its pitch is F / S, and it does not dwell")
        if rest:
            yield rest
        letter, holes = NORMAL[machine.mode(PLANE)], round(values.pop("L", 1))
        if machine.mode(SPINDLE) != TAPPING[code]:
            raise StateError(f"{name} needs M{TAPPING[code] // 10}")
        height, tap = self._place(letter, name), self._tap
        initial = tap.initial if tap else height
        if not tap and (letter not in values or "R" not in values):
            raise LineError(f"{name} lacks {letter} or R")
        level, bottom = values.pop("R", None), values.pop(letter, None)
        if machine.incremental:
            level = tap.level if tap and level is None else initial + (level or 0)
            bottom = level + bottom if bottom is not None else tap.bottom if tap else level
        else:
            level = tap.level if tap and level is None else level or 0.0
            bottom = tap.bottom if tap and bottom is None else bottom or 0.0
        if bottom > level or holes < 1:
            raise LineError(f"{name}: {letter} must not be above R, nor L below 1")
        self._tap = tap = _Tap(code, bottom, level, initial, self._pitch(name))
        places = [Word(place, value) for place, value in values.items()]
        clear = max(initial, level) if machine.mode(RETRACT) == 980 else level
        modes = [Word("G", 90)] if machine.incremental else []
        back = [Word("G", 91)] if machine.incremental else []
        if height < level:
            yield said([*modes, Word("G", 0), Word(letter, level), *back])
        for _ in range(holes):
            yield said([*back, Word("G", 0), *places])
            yield said([*modes, Word("G", 0), Word(letter, level)])
            yield said([Word("G", 33.1), Word(letter, bottom), Word("K", tap.pitch)])
            yield said([Word("G", 0), Word(letter, clear)])
        if back:
            yield said(back)

    def _place(self, letter: str, name: str) -> float:
        """The work coordinate of an axis, in the units in force."""
        if letter not in self.machine.letters:
            raise LineError(f"{name}: the machine has no axis {letter}")
        axis = self.machine.letters.index(letter)
        if not self.machine.knows(axis):
            raise StateError(f"{name}: {letter} is not known: move it before")
        return self.machine.work[axis] / self.machine.scale

    def _pitch(self, name: str) -> float:
        """In the units in force."""
        machine, c = self.machine, self.machine.gcode.c
        feed, speed = c.feed / NANOMETERS / machine.scale, c.spindle / 1e6
        if not feed or not speed:
            raise StateError(f"{name} needs F and S: the pitch is F / S, or F after G95")
        return float(feed if machine.mode(FEED_MODE) == 950 else feed / speed)


def _is_g(word: Word, codes: set[int]) -> bool:
    return word.letter == "G" and word.code in codes


def _depths(first: float, height: float, degression: float, spring: int) -> Iterator[float]:
    """Of the passes of a thread."""
    depth, number = first, 1
    while depth < height - NOTHING:
        yield depth
        number += 1
        if number > PASSES_MAX:
            raise LineError(f"G76 makes more than {PASSES_MAX} passes")
        depth = first * number ** (1 / degression)
    for _ in range(spring + 1):
        yield height
