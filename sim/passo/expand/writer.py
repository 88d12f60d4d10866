# SPDX-License-Identifier: MIT
"""Motions as plain lines, from where the machine is."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from passo.expand.block import Word, shown
from passo.expand.compensation import Step, arc_length
from passo.gcode import LINEAR

UNSEEN = 1e-9  # mm


@dataclass
class Writer:
    """Writes motions in a plane; `at` is where the last one ended, in mm and work coordinates.

    Axes that do not move are not written, except those of the plane with `whole` and in arcs. An axis whose
    place is not known is at infinity.
    """

    letters: str  # of the axes
    plane: tuple[int, int]
    at: list[float]
    whole: bool = True

    def write(self, step: Step) -> str:
        """A motion."""
        begin = list(self.at)
        end = [step.others[axis] if step.others else at for axis, at in enumerate(begin)]
        end[self.plane[0]], end[self.plane[1]] = step.end.real, step.end.imag
        code = 0 if step.rapid else 1 if step.center is None else 2 if step.clockwise else 3
        words = [Word("G", code)]
        for axis, before in enumerate(begin):
            needed = axis in self.plane and (self.whole or step.center is not None)
            if needed or abs(end[axis] - before) > UNSEEN:
                letter, origin = self.letters[axis], before if step.incremental else 0.0
                scale = step.scale if letter in LINEAR else 1.0
                word = Word(letter, (end[axis] - origin) / scale)
                words.append(word)
                self.at[axis] = float(shown(word.value)) * scale + origin
        if step.center is not None:
            for axis, at in zip(self.plane, (step.center.real, step.center.imag), strict=True):
                words.append(Word("IJK"[axis], (at - begin[axis]) / step.scale))
        if step.speed:
            words.append(Word("F", step.speed / length(step, begin, end, self.plane)))
        return step.label + " ".join(map(str, words))


def flat(place: Sequence[float], plane: tuple[int, int]) -> complex:
    """A place in a plane."""
    return complex(place[plane[0]], place[plane[1]])


def length(step: Step, begin: Sequence[float], end: Sequence[float], plane: tuple[int, int]) -> float:
    """Of a motion from `begin` to `end`, in mm; never 0."""
    away = [b - a for axis, (a, b) in enumerate(zip(begin, end, strict=True)) if axis not in plane]
    start = flat(begin, plane)
    along = abs(step.end - start) if step.center is None else arc_length(start, step)
    return max(math.hypot(along, *away), UNSEEN)
