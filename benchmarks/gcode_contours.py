# SPDX-License-Identifier: MIT
"""Random contours with cutter compensation: lines and arcs, left and right, in both planes and all modes."""

import cmath
import math
import random

INCH = 25.4
LETTERS = {"G17": ("X", "Y", "Z", "I", "J"), "G18": ("Z", "X", "Y", "K", "I")}


class Contours:
    """Makes the lines of a contour from where the tool is to a line that leaves it."""

    def __init__(self, rng: random.Random):
        self.rng, self.lines = rng, [""]
        self.plane = rng.choice(sorted(LETTERS))
        self.unit = rng.choice((1.0, 1.0, INCH))
        self.incremental, self.inverse = rng.random() < 0.3, rng.random() < 0.2
        self.at = complex(rng.uniform(-5, 5), rng.uniform(-5, 5))
        self.heading = rng.uniform(0, math.tau)

    def words(self, first: str, second: str, value: complex) -> str:
        """Two words of a length in mm."""
        return f"{first}{value.real / self.unit:.6f} {second}{value.imag / self.unit:.6f}"

    def feed(self) -> str:
        """An F, where one is needed."""
        return f" F{self.rng.uniform(2, 90):.3f}" if self.inverse else ""

    def go(self, command: str, end: complex, more: str = "") -> None:
        """A motion to a place, sometimes with the third axis."""
        first, second, third, *_ = LETTERS[self.plane]
        aside = f" {third}{self.rng.uniform(-3, 3) / self.unit:.4f}" if self.rng.random() < 0.2 else ""
        feed = "" if command == "G0" else self.feed()
        target = end - self.at if self.incremental else end
        self.lines.append(f"{command} {self.words(first, second, target)}{aside}{more}{feed}")
        self.at = end

    def straight(self) -> None:
        """In any direction, often on or at a right angle."""
        rng = self.rng
        turn = rng.choice((0.0, rng.uniform(-3.1, 3.1), rng.uniform(-1.6, 1.6), math.pi / 2, -math.pi / 2))
        end = self.at + cmath.rect(rng.uniform(3, 25), self.heading + turn)
        self.heading = cmath.phase(end - self.at)
        self.go(rng.choice(("G1", "G1", "G1", "G0")), end)

    def arc(self) -> None:
        """Tangent, or at an angle: of flat corners before narrow arcs Passo makes one motion more."""
        rng = self.rng
        radius, turn, sweep = rng.uniform(1, 15), rng.choice((1, -1)), rng.uniform(0.2, 4)
        heading = self.heading + rng.choice((0.0, rng.uniform(0.06, 2), rng.uniform(-2, -0.06)))
        offset = cmath.rect(radius, heading + turn * math.pi / 2)
        center, begin = self.at + offset, cmath.phase(-offset)
        self.heading = begin + turn * (sweep + math.pi / 2)
        _, _, _, first, second = LETTERS[self.plane]
        end = center + cmath.rect(radius, begin + turn * sweep)
        self.go("G3" if turn > 0 else "G2", end, f" {self.words(first, second, offset)}")

    def other(self) -> None:
        """Nothing in the plane."""
        rng, third = self.rng, LETTERS[self.plane][2]
        lines = [
            "M3 S100",
            "M8",
            "G4 P0.5",
            "(a comment)",
            f"G1 {third}{rng.uniform(-3, 3) / self.unit:.4f}{self.feed()}",
        ]
        self.lines.append(rng.choice(lines if self.inverse else [*lines, "F700"]))


def contour_program(rng: random.Random) -> list[str]:
    """A program; in some the tool does not fit."""
    made = Contours(rng)
    first, second, *_ = LETTERS[made.plane]
    diameter = rng.uniform(0.5, 6) / made.unit
    made.lines = [
        f"{'G21' if made.unit == 1 else 'G20'} G90 G94 {made.plane}",
        f"G0 {made.words(first, second, made.at)}",
        rng.choice((f"G41.1 D{diameter:.4f}", f"G42.1 D{diameter:.4f}", f"G41 D{rng.randint(2, 20)}")),
        f"{'G91' if made.incremental else 'G90'} {'G93' if made.inverse else 'F500'}",
    ]
    (made.straight if rng.random() < 0.8 else made.arc)()
    for _ in range(rng.randint(2, 8)):
        rng.choices((made.straight, made.arc, made.other), (6, 3, 1))[0]()
    made.lines.append("G40")
    made.go("G1", made.at + complex(rng.uniform(-9, 9), rng.uniform(-9, 9)))
    return [*made.lines, "G90 G0 X0 Y0 Z0"]
