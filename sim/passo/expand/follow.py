# SPDX-License-Identifier: MIT
"""Lines and arcs that follow a height map: Z gets the height, and what is not straight on the map is cut."""

import cmath
import math
from collections.abc import Sequence
from itertools import pairwise

from passo.expand.block import Word, split, words_of
from passo.expand.compensation import Step
from passo.expand.expander import Options
from passo.expand.height_map import HeightMap
from passo.expand.machine import CYCLES, FEED_MODE, MOTION, SYSTEM, Machine, Motion
from passo.expand.output import PlainLine, parts
from passo.expand.place import ITSELF, ExpandError, LineError, Place, ProgramError
from passo.expand.refusals import explain
from passo.expand.writer import Writer, length
from passo.failure import BadInputError
from passo.gcode import AXIS_LETTERS, GcodeError

CHORD = 0.002  # mm from an arc of another plane, which is cut into lines
XY = (0, 1)
Z = 2
MOVES_THE_MAP = {100, 920, 921}
MACHINE_COORDINATES = {280, 300, 530}


def follow(lines: Sequence[PlainLine], height_map: HeightMap, options: Options) -> list[PlainLine]:
    """Plain lines on a map; raises BadInputError."""
    if missing := next((axis for axis in "XYZ" if axis not in options.gcode.axis_letters), ""):
        raise BadInputError(f"the machine has no axis {missing} to follow a height map")
    follower = _Follower(height_map, options)
    refused: dict[Place, ExpandError] = {}
    for line in lines:
        try:
            follower.take(line)
        except GcodeError as error:
            told = explain(error, words_of(line.text), follower.machine.gcode.settings)
            refused.setdefault(line.place, ExpandError(line.place, told))
        except ExpandError as error:
            refused.setdefault(error.place, error)
    if refused:
        raise ProgramError([*refused.values()])
    return follower.lines


class _Follower:
    def __init__(self, height_map: HeightMap, options: Options):
        self.map = height_map
        self.machine = Machine(options.gcode, {}, options.at_zero, options.begin)
        self.lines: list[PlainLine] = []
        self.added = 0.0  # height of where the machine is, if its Z has it
        self.followed = False

    def take(self, line: PlainLine) -> None:
        """One line; raises GcodeError, ExpandError."""
        words = words_of(line.text)
        codes = {word.code for word in words if word.letter == "G"}
        system = self.machine.mode(SYSTEM)
        known = [self.machine.knows(axis) for axis in (*XY, Z)]
        motion = self.machine.execute(line.text, words)
        if self.followed and (codes & MOVES_THE_MAP or self.machine.mode(SYSTEM) != system):
            raise ExpandError(
                line.place,
                LineError("the origin of the height map cannot be moved behind its first motion", ITSELF),
            )
        if self.machine.mode(MOTION) in CYCLES and any(word.letter in AXIS_LETTERS for word in words):
            raise ExpandError(
                line.place, LineError("cycles do not follow a height map: write out their motions", ITSELF)
            )
        if motion is None or codes & MACHINE_COORDINATES:
            self.lines.append(line)
            axes = {word.letter for word in words} & set(AXIS_LETTERS)
            if not self.machine.knows(Z) or (codes & MACHINE_COORDINATES and ("Z" in axes or not axes)):
                self.added = 0.0
            return
        if not all(self.machine.knows(axis) for axis in (*XY, Z)):
            if not motion.rapid:
                missing = next("XYZ"[axis] for axis in (*XY, Z) if not self.machine.knows(axis))
                raise ExpandError(
                    line.place,
                    LineError(f"{missing} is not known: move it before, for the height map", ITSELF),
                )
            self.lines.append(line)
            return
        self._motion(line, words, motion, known)

    def _motion(self, line: PlainLine, words: Sequence[Word], motion: Motion, known: Sequence[bool]) -> None:
        machine = self.machine
        if not all(known) and not motion.rapid:
            raise ExpandError(
                line.place, LineError("where this motion begins is not known: move X, Y, Z before", ITSELF)
            )
        lead, tail = parts(list(words), motion, machine.mode(FEED_MODE) == 930)
        begin = [at + self.added * (axis == Z) for axis, at in enumerate(motion.start)]
        for axis, is_known in zip((*XY, Z), known, strict=True):
            begin[axis] = begin[axis] if is_known else math.inf
        writer = Writer(machine.letters, XY, begin, whole=False)
        speed = 0.0
        if machine.mode(FEED_MODE) == 930 and not motion.rapid:
            rate = next(word.value for word in words if word.letter == "F")
            whole = Step(line.place, _flat(motion.end), (), False, motion.center, motion.clockwise)
            speed = rate * length(whole, motion.start, motion.end, motion.plane)
        label = " ".join([*map(str, lead), *split(line.text)[1], ""])
        for place, center in self._pieces(line, motion, all(known)):
            flat = _flat(place)
            self.added = self.map.height(flat)
            step = Step(
                line.place, flat, tuple(at + self.added * (axis == Z) for axis, at in enumerate(place)),
                motion.rapid, center, motion.clockwise, speed, machine.scale, machine.incremental, label,
            )  # fmt: skip
            self.lines.append(PlainLine(writer.write(step), line.place))
            label = ""
        if tail:
            self.lines.append(PlainLine(" ".join(map(str, tail)), line.place))
        self.followed = True

    def _pieces(
        self, line: PlainLine, motion: Motion, known: bool
    ) -> list[tuple[tuple[float, ...], complex | None]]:
        """Ends of the pieces of a motion, without heights, and their center."""
        made: list[tuple[tuple[float, ...], complex | None]] = []
        corners = [motion.start, *_chords(motion)]
        for begin, end in pairwise(corners):
            center = motion.center if motion.plane == XY else None
            if not motion.rapid:
                self._check(line, [_flat(begin), _flat(end)])
            cuts = [1.0]
            sweep = _sweep(motion) if center is not None else 0.0
            if center is not None:
                cuts = self.map.cuts_of_arc(_flat(begin), center, sweep)
                middles = [(a + b) / 2 for a, b in zip([0.0, *cuts], cuts, strict=False)]
                self._check(
                    line, [center + (_flat(begin) - center) * cmath.exp(1j * sweep * m) for m in middles]
                )
            elif known:
                cuts = self.map.cuts_of_line(_flat(begin), _flat(end))
            for share in cuts:
                place = (
                    [a + (b - a) * share for a, b in zip(begin, end, strict=True)] if share < 1 else list(end)
                )
                if center is not None and share < 1:
                    spoke = (_flat(begin) - center) * cmath.exp(1j * sweep * share)
                    spoke *= 1 + share * (abs(_flat(end) - center) / abs(_flat(begin) - center) - 1)
                    place[0], place[1] = (center + spoke).real, (center + spoke).imag
                made.append((tuple(place), center))
        return made

    def _check(self, line: PlainLine, places: Sequence[complex]) -> None:
        if not all(map(self.map.contains, places)):
            raise ExpandError(line.place, LineError(f"this motion leaves the height map: {self.map}", ITSELF))


def _flat(place: Sequence[float]) -> complex:
    return complex(place[0], place[1])


def _sweep(motion: Motion) -> float:
    """Of an arc, in its plane; clockwise is negative."""
    assert motion.center is not None
    begin, end = (motion.flat(place) - motion.center for place in (motion.start, motion.end))
    turn = -1 if motion.clockwise else 1
    angle = cmath.phase(end / begin) * turn
    return turn * (angle if angle > 1e-9 else angle + math.tau)


def _chords(motion: Motion) -> list[tuple[float, ...]]:
    """The ends of the lines that an arc of another plane is cut into; else the end."""
    if motion.center is None or motion.plane == XY:
        return [motion.end]
    sweep, spoke = _sweep(motion), motion.flat(motion.start) - motion.center
    most = 2 * math.acos(max(0.0, 1 - CHORD / abs(spoke)))
    count = max(1, math.ceil(abs(sweep) / most))
    made = []
    for k in range(1, count):
        place = [a + (b - a) * k / count for a, b in zip(motion.start, motion.end, strict=True)]
        turned = motion.center + spoke * cmath.exp(1j * sweep * k / count)
        place[motion.plane[0]], place[motion.plane[1]] = turned.real, turned.imag
        made.append(tuple(place))
    return [*made, motion.end]
