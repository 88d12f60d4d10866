# SPDX-License-Identifier: MIT
"""A probed grid of heights, bilinear between its points, and lines that follow it.

The file has a point in each line, `x,y,z` in mm and work coordinates, in any order; the points are a complete
grid. Lines of a sender's log, `[PRB:x,y,z:1]`, do as well: these are in machine coordinates.
"""

import cmath
import math
import re
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from passo.expand.block import shown
from passo.failure import BadInputError

ERROR = 0.001  # mm: by which a line may deviate from the map
SAME = 0.01  # mm: coordinates of a grid line
PLACE_MAX = 100_000  # mm
POINTS_MAX = 1_000_000  # that are probed
EDGE = 1e-6  # mm outside the map that are rounding
NUMBER = r"\s*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*"
POINT = re.compile(rf"{NUMBER}[,;\s]{NUMBER}[,;\s]{NUMBER}")
PROBED = re.compile(rf"\[PRB:{NUMBER},{NUMBER},{NUMBER}(?:,[^:]*)?:([01])\]")


@dataclass(frozen=True)
class HeightMap:
    """Heights in mm: `heights[j][i]` is at `x[i]`, `y[j]`; both ascend and have two values or more."""

    x: tuple[float, ...]
    y: tuple[float, ...]
    heights: tuple[tuple[float, ...], ...]

    def __str__(self) -> str:
        return f"X {self.x[0]:g} to {self.x[-1]:g}, Y {self.y[0]:g} to {self.y[-1]:g}"

    def contains(self, place: complex) -> bool:
        """Whether a place is within the map."""
        inside_x = self.x[0] - EDGE <= place.real <= self.x[-1] + EDGE
        return inside_x and self.y[0] - EDGE <= place.imag <= self.y[-1] + EDGE

    def height(self, place: complex) -> float:
        """At a place; outside the map, of its nearest edge."""
        i, u = _cell(self.x, place.real)
        j, v = _cell(self.y, place.imag)
        low, high = self.heights[j], self.heights[j + 1]
        return (1 - v) * ((1 - u) * low[i] + u * low[i + 1]) + v * ((1 - u) * high[i] + u * high[i + 1])

    def cuts_of_line(self, begin: complex, end: complex) -> list[float]:
        """Shares of a line, up to 1, at which it is to be cut: its pieces are straight within ERROR."""
        way = end - begin
        crossings = [
            (line - start) / along
            for lines, start, along in ((self.x, begin.real, way.real), (self.y, begin.imag, way.imag))
            if along
            for line in lines
        ]
        return self._cuts(
            crossings,
            lambda at: begin + at * way,
            lambda place, share: self._bend(place, way) * share**2,
        )

    def cuts_of_arc(self, begin: complex, center: complex, sweep: float) -> list[float]:
        """The same for an arc, counterclockwise with a positive sweep."""
        spoke = begin - center
        radius, first = abs(spoke), cmath.phase(spoke)
        angles = []
        for lines, middle, turned in ((self.x, center.real, 0.0), (self.y, center.imag, math.pi / 2)):
            for line in lines:
                if abs(line - middle) < radius:
                    angle = math.acos((line - middle) / radius)
                    angles += [turned + angle, turned - angle]
        crossings = [((angle - first) * math.copysign(1, sweep) % math.tau) / abs(sweep) for angle in angles]
        return self._cuts(
            crossings,
            lambda at: center + spoke * cmath.exp(1j * sweep * at),
            lambda place, share: self._curve(place, radius) * (sweep * share) ** 2 / 8,
        )

    def _cuts(
        self,
        crossings: list[float],
        place_at: Callable[[float], complex],
        deviation: Callable[[complex, float], float],
    ) -> list[float]:
        """Cut between crossings of the grid, `deviation` is of an uncut share in the cell of a place."""
        edges = [0.0, *sorted(at for at in crossings if EDGE < at < 1 - EDGE), 1.0]
        cuts: list[float] = []
        for a, b in pairwise(edges):
            if b - a > EDGE:
                pieces = max(1, math.ceil(math.sqrt(deviation(place_at((a + b) / 2), b - a) / ERROR)))
                cuts += [a + (b - a) * k / pieces for k in range(1, pieces + 1)]
        return cuts

    def _corners(self, place: complex) -> tuple[float, float, float, float, float, float]:
        """Size of the cell of a place, and its four heights."""
        i, j = _cell(self.x, place.real)[0], _cell(self.y, place.imag)[0]
        low, high = self.heights[j], self.heights[j + 1]
        size = self.x[i + 1] - self.x[i], self.y[j + 1] - self.y[j]
        return *size, low[i], low[i + 1], high[i], high[i + 1]

    def _bend(self, place: complex, way: complex) -> float:
        """How far a line over a whole way would be from the map, in the cell of a place."""
        width, depth, a, b, c, d = self._corners(place)
        return abs((a - b - c + d) / (width * depth) * way.real * way.imag) / 4

    def _curve(self, place: complex, radius: float) -> float:
        """The greatest second derivative of the height by the angle of an arc, in the cell of a place."""
        width, depth, a, b, c, d = self._corners(place)
        slope = math.hypot(max(abs(b - a), abs(d - c)) / width, max(abs(c - a), abs(d - b)) / depth)
        return slope * radius + abs(a - b - c + d) / (width * depth) * radius**2


def _cell(lines: Sequence[float], at: float) -> tuple[int, float]:
    """The cell between two lines, and the share of it."""
    index = min(max(bisect_right(lines, at) - 1, 0), len(lines) - 2)
    share = (at - lines[index]) / (lines[index + 1] - lines[index])
    return index, min(max(share, 0.0), 1.0)


def read_height_map(path: Path, origin: Sequence[float] = (0.0, 0.0, 0.0)) -> HeightMap:
    """A map from a file; for a log `origin` is the work zero in machine coordinates. Raises BadInputError."""
    try:
        lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    except OSError as error:
        raise BadInputError(f"{path}: {error.strerror}") from None
    points = list(_points(path, lines, origin))
    if not points:
        raise BadInputError(f"{path}: there is no point: x,y,z")
    x, y = (_lines([point[axis] for point in points]) for axis in (0, 1))
    found: dict[tuple[int, int], float] = {}
    for point in points:
        place = _nearest(x, point[0]), _nearest(y, point[1])
        if place in found:
            raise BadInputError(f"{path}: X{point[0]:g} Y{point[1]:g} is there twice")
        found[place] = point[2]
    if len(x) < 2 or len(y) < 2 or len(found) != len(x) * len(y):
        places = ((i, j) for j in range(len(y)) for i in range(len(x)))
        missing = next((f": X{x[i]:g} Y{y[j]:g} is missing" for i, j in places if (i, j) not in found), "")
        raise BadInputError(f"{path}: {len(points)} points are no grid of {len(x)} by {len(y)}{missing}")
    return HeightMap(x, y, tuple(tuple(found[i, j] for i in range(len(x))) for j in range(len(y))))


def _points(
    path: Path, lines: Sequence[str], origin: Sequence[float]
) -> Iterator[tuple[float, float, float]]:
    is_log = any("[PRB:" in line for line in lines)
    for number, line in enumerate(lines, 1):
        text = line.split("#")[0].strip()
        if is_log:
            if found := PROBED.search(line):
                if found[4] == "0":
                    raise BadInputError(f"{path}:{number}: the probe did not touch")
                place = _place(path, number, found)
                yield place[0] - origin[0], place[1] - origin[1], place[2] - origin[2]
        elif found := POINT.fullmatch(text):
            yield _place(path, number, found)
        elif text and not (number == 1 and text[:1].isalpha()):
            raise BadInputError(f"{path}:{number}: no point: {text}; x,y,z is wanted")


def _place(path: Path, number: int, found: re.Match[str]) -> tuple[float, float, float]:
    x, y, z = (float(found[axis]) for axis in (1, 2, 3))
    if not max(abs(x), abs(y), abs(z)) <= PLACE_MAX:
        raise BadInputError(f"{path}:{number}: x,y,z must be within {PLACE_MAX:,} mm")
    return x, y, z


def _lines(values: list[float]) -> tuple[float, ...]:
    made: list[float] = []
    for value in sorted(values):
        if not made or value - made[-1] > SAME:
            made.append(value)
    return tuple(made)


def _nearest(lines: Sequence[float], at: float) -> int:
    return min(range(len(lines)), key=lambda index: abs(lines[index] - at))


@dataclass(frozen=True)
class Grid:
    """Where to probe; mm and mm/min."""

    x: tuple[float, float]
    y: tuple[float, float]
    step: float = 10.0
    clearance: float = 2.0  # over the work zero, between points
    depth: float = 2.0  # below it, where probing ends
    feed: float = 50.0


def probing_program(grid: Grid) -> list[str]:
    """Plain lines that probe a grid, to and fro; what the sender logs of them is a map."""
    columns, rows = (_pieces(low, high, grid.step) for low, high in (grid.x, grid.y))
    if (columns + 1) * (rows + 1) > POINTS_MAX:
        raise BadInputError(f"a grid in steps of {grid.step:g} mm has more than {POINTS_MAX:,} points")
    xs, ys = _spread(grid.x, columns), _spread(grid.y, rows)
    made = ["G21 G90 G94", f"G0 Z{shown(grid.clearance)}"]
    for row, y in enumerate(ys):
        for x in xs if row % 2 == 0 else reversed(xs):
            made += [
                f"G0 X{shown(x)} Y{shown(y)}",
                f"G38.2 Z{shown(-grid.depth)} F{shown(grid.feed)}",
                f"G0 Z{shown(grid.clearance)}",
            ]
    return [*made, "M2"]


def _pieces(low: float, high: float, step: float) -> int:
    """How many, of at most a step, are from one end to the other."""
    if not high - low > SAME or not step > 0:
        raise BadInputError(f"the grid from {low:g} to {high:g} in steps of {step:g} mm has no points")
    return max(1, math.ceil((high - low) / step - EDGE))


def _spread(ends: tuple[float, float], pieces: int) -> list[float]:
    low, high = ends
    return [low + (high - low) * k / pieces for k in range(pieces + 1)]
