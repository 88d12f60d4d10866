# SPDX-License-Identifier: MIT
"""Paths for the benchmark and the tests of the path planner; all begin at the origin."""

import math
import random
from collections.abc import Iterator, Sequence

from passo.path_rounding import Line

FEED = 100.0  # mm/s

# Strokes of letters on a grid of 4 x 6, as polylines.
FONT = {
    "P": ["00 06 36 45 44 33 03"],
    "A": ["00 26 40", "12 32"],
    "S": ["01 10 30 41 42 33 13 04 05 16 36 45"],
    "O": ["10 30 41 45 36 16 05 01 10"],
    "T": ["06 46", "26 20"],
    "E": ["40 00 06 46", "03 33"],
    "R": ["00 06 36 45 44 33 03", "23 40"],
    "N": ["00 06 40 46"],
    " ": [],
}


def circle(radius: float = 20, chords: int = 360) -> list[Line]:
    """A full circle of equal chords."""
    angles = (2 * math.pi * i / chords for i in range(1, chords + 1))
    return [((radius * math.cos(a) - radius, radius * math.sin(a), 0.0), FEED) for a in angles]


def square(side: float = 50) -> list[Line]:
    """Four sides."""
    return [((x * side, y * side, 0.0), FEED) for x, y in ((1, 0), (1, 1), (0, 1), (0, 0))]


def star(radius: float = 30, points: int = 11) -> list[Line]:
    """Sharp corners only."""
    angles = (2 * math.pi * (i * (points // 2) % points) / points for i in range(1, points + 1))
    return [((radius * math.cos(a) - radius, radius * math.sin(a), 0.0), FEED) for a in angles]


def spiral(chords: int = 20_000, chord: float = 0.1, pitch: float = 0.5) -> list[Line]:
    """An Archimedean spiral from a radius of 1 mm outwards."""
    lines: list[Line] = []
    angle, radius = 0.0, 1.0
    for _ in range(chords):
        angle += chord / radius
        radius = 1 + pitch * angle / (2 * math.pi)
        lines.append(((radius * math.cos(angle) - 1, radius * math.sin(angle), 0.0), FEED))
    return lines


def text(words: str = "PASSO STEPS NOT STOPS", height: float = 6) -> list[Line]:
    """Engraved letters: the tool is lifted between strokes."""
    lines: list[Line] = []
    unit, left = height / 6, 0.0
    for letter in words:
        for stroke in FONT[letter]:
            points = [(left + int(p[0]) * unit, int(p[1]) * unit) for p in stroke.split()]
            lines.append(((*points[0], 1.0), None))
            lines += [((*point, 0.0), FEED / 2) for point in [points[0], *points[1:]]]
            lines.append(((*points[-1], 1.0), None))
        left += height
    lines.append(((0.0, 0.0, 1.0), None))
    return lines


def trochoid(length: float = 40, radius: float = 3, pitch: float = 0.8, chords: int = 72) -> list[Line]:
    """A slot, milled in circles that advance."""
    lines: list[Line] = []
    for i in range(1, round(length / pitch * chords) + 1):
        angle = 2 * math.pi * i / chords
        x = pitch * i / chords + radius * (1 - math.cos(angle))
        lines.append(((x, -radius * math.sin(angle), 0.0), FEED))
    return lines


def wander(rng: random.Random, count: int) -> list[Line]:
    """A random polyline of long and short lines, sharp and blunt corners, and all axes."""
    x = y = z = 0.0
    heading = 0.0
    longest = rng.choice([0.3, 2, 20])
    bend = rng.choice([0.02, 0.3, 2])
    slope = rng.choice([0.0, 0.0, 0.05])
    lines: list[Line] = []
    for _ in range(count):
        heading += rng.gauss(0, bend)
        size = rng.uniform(0.02, longest)
        x += size * math.cos(heading)
        y += size * math.sin(heading)
        z += size * rng.uniform(-slope, slope)
        feed = rng.choice([FEED, FEED, FEED, 30.0, None])
        lines.append(((x, y, z), feed))
    return lines


def wanderings(count: int = 200, seed: int = 1) -> Iterator[Sequence[Line]]:
    """Random polylines."""
    for number in range(count):
        rng = random.Random(seed * 1_000_003 + number)
        yield wander(rng, rng.randint(2, 300))
