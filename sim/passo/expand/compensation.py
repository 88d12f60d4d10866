# SPDX-License-Identifier: MIT
"""Cutter radius compensation: from the programmed contour to the path of the tool's center.

Points of the plane are complex numbers in mm, directions are complex numbers of magnitude 1. The tool's
center is off the contour by `side * 1j * direction * radius`: side 1 is left, -1 right. Corners are as in
LinuxCNC: an arc goes around an outside corner, at an inside corner the paths meet where they intersect.
"""

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from passo.expand.place import NIST, ContourError, LineError, Place

STRAIGHT = 0.05  # rad: a corner that turns less needs no arc
ROUND = 0.004  # mm: the distances of both ends of an arc from its center may differ by this
LONGER = 0.001  # rad by which an arc may become longer at an inside corner
TANGENT = 1e-9  # of a radius: rounding, where paths just touch


@dataclass
class Step:
    """A motion of the tool's center, in work coordinates."""

    place: Place
    end: complex
    others: tuple[float, ...]  # all axes at the end; those of the plane do not count
    rapid: bool
    center: complex | None = None  # of an arc
    clockwise: bool = False
    speed: float = 0.0  # mm/min, with G93 only
    scale: float = 1.0  # mm of a unit, as the line is written
    incremental: bool = False
    label: str = ""  # N word


@dataclass
class _Waiting:
    """A step whose end depends on the next one."""

    step: Step
    start: complex
    direction: complex = 0j  # of a line as programmed; 0: it does not move in the plane
    sweep: float = math.inf  # of an arc as programmed


Taker = Callable[[Step | str, Place], None]


@dataclass
class Compensation:
    """Of a tool with a radius in mm, on a side of the contour."""

    side: int
    radius: float
    programmed: complex  # end of the contour so far
    take: Taker
    first: bool = True
    _center: complex = 0j  # of the tool, if nothing follows
    _begin: complex = 0j  # where the waiting step begins
    _queue: list[tuple[_Waiting | str, Place]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._center = self._begin = self.programmed

    def text(self, text: str, place: Place) -> None:
        """A line without motion: it keeps its place."""
        if self._queue:
            self._queue.append((text, place))
        else:
            self.take(text, place)

    def line(self, step: Step) -> None:
        """A straight line of the contour to `step.end`; raises ExpandError."""
        begin, end = self.programmed, step.end
        if self.first:
            self._enter_line(step)
            return
        if begin == end:  # along other axes
            step.end = self._center
            self._wait(_Waiting(step, self._center))
            return
        direction = (end - begin) / abs(end - begin)
        normal = self._normal(direction)
        self._corner(step, direction, None)
        step.end = end + normal
        self._wait(_Waiting(step, self._begin, direction))
        self.programmed, self._center = end, step.end

    def arc(self, step: Step) -> None:
        """An arc of the contour to `step.end` around `step.center`; raises ExpandError."""
        assert step.center is not None
        if self.first:
            self._enter_arc(step)
            return
        begin, end, turn = self.programmed, step.end, _turn(step)
        radius = abs(end - step.center)
        if self._inside(step) and radius <= self.radius:
            raise ContourError(
                step.place,
                LineError(
                    f"the tool's radius of {self.radius:g} mm does not fit inside the arc's {radius:g}", NIST
                ),
            )
        direction = _unit(begin - step.center) * 1j * turn
        sweep = _sweep(begin, end, step.center, turn)
        beside = self._corner(step, direction, step)
        if beside:
            sweep += 2 * beside / radius
            self._join(step, begin + self._normal(direction))
        step.end = end + self._normal(_unit(end - step.center) * 1j * turn)
        self._wait(_Waiting(step, self._begin, sweep=sweep))
        self.programmed, self._center = end, step.end

    def finish(self) -> None:
        """Nothing follows the last motion; raises ExpandError."""
        self._flush(self._center)

    def _normal(self, direction: complex) -> complex:
        """From the contour to the tool's center."""
        return direction * 1j * self.side * self.radius

    def _inside(self, step: Step) -> bool:
        """Whether the tool is on the inner side of an arc."""
        return _turn(step) == self.side

    def _enter_line(self, step: Step) -> None:
        way = step.end - self.programmed
        if abs(way) <= self.radius:
            raise ContourError(
                step.place,
                LineError(
                    f"the first motion after G41 or G42 is {abs(way):g} mm and must be longer than the "
                    f"tool's radius, {self.radius:g} mm",
                    NIST,
                ),
            )
        self.first, self.programmed = False, step.end
        step.end += self._normal(way / abs(way))
        self._center = step.end
        self._wait(_Waiting(step, self._begin))  # long enough: it cannot turn around

    def _enter_arc(self, step: Step) -> None:
        """The tool keeps touching an arc that ends as programmed and touches the tool at its start."""
        assert step.center is not None
        begin, end, turn = self._center, step.end, _turn(step)
        if abs(end - begin) <= self.radius:
            raise ContourError(
                step.place,
                LineError("the arc after G41 or G42 must end farther away than the tool's radius", NIST),
            )
        if self._inside(step) and abs(begin - step.center) <= self.radius:
            raise ContourError(
                step.place, LineError("the tool does not fit inside the arc after G41 or G42", NIST)
            )
        inward = _unit(step.center - end)
        self.first, self.programmed = False, end
        step.end = end + self._normal(-inward * 1j * turn)
        chord = begin - step.end
        along = (chord * inward.conjugate()).real
        if along < TANGENT * abs(chord):
            raise ContourError(
                step.place, LineError("the arc after G41 or G42 has no center with this tool", NIST)
            )
        step.center = step.end + inward * abs(chord) ** 2 / (2 * along)
        self._center = step.end
        self._wait(_Waiting(step, begin, sweep=_sweep(begin, step.end, step.center, turn)))

    def _corner(self, step: Step, direction: complex, arc: Step | None) -> float:
        """Decide where the waiting step ends, and where the next one in `direction` begins.

        Returns by how much that is beside the tool's path, in mm: at a corner that turns a little.
        """
        here = self.programmed
        normal = self._normal(direction)
        before = (self._center - here) / (1j * self.side * self.radius)  # the direction so far
        inward = cmath.phase(direction / before) * self.side  # turns to the side of the tool
        back = math.pi - abs(inward) < STRAIGHT
        last = self._front()
        if back:  # around a half circle, except beside an arc that the tool is outside of
            beside = arc or (last.step if last and last.step.center is not None else None)
            inside_corner = beside is not None and not self._inside(beside)
        else:
            inside_corner = inward > STRAIGHT
        if inside_corner:
            meet = self._meet(step, direction, arc, last)
            self._flush(meet)
            self._begin = meet
            return 0.0
        self._flush(self._center)
        self._begin = self._center
        if back or inward < -STRAIGHT:
            self._begin = here + normal
            around = replace(step, end=self._begin, others=(), center=None if step.rapid else here)
            around.clockwise, around.label = self.side > 0, ""
            self.take(around, step.place)
        return abs(self._begin - here - normal)

    def _join(self, arc: Step, start: complex) -> None:
        """Lead to the start of an arc, if it is not round from where the corner has left the tool."""
        assert arc.center is not None
        if abs(abs(self._begin - arc.center) - abs(start - arc.center)) > ROUND:
            self.take(replace(arc, end=start, others=(), center=None, label=""), arc.place)
            self._begin = start

    def _meet(self, step: Step, direction: complex, arc: Step | None, last: "_Waiting | None") -> complex:
        """Where the tool's paths on both sides of an inside corner intersect; raises ExpandError."""
        here = self.programmed
        one = _Path(self._center, (self._center - here) / (1j * self.side * self.radius))
        if last and last.step.center is not None:
            one = _Path(last.step.center, radius=abs(last.step.end - last.step.center))
        other = _Path(here + self._normal(direction), direction)
        if arc and arc.center is not None:
            change = -self.radius if self._inside(arc) else self.radius
            other = _Path(arc.center, radius=abs(arc.end - arc.center) + change)
        points = _intersections(one, other)
        if not points:
            raise ContourError(
                step.place,
                LineError(
                    f"the tool's radius of {self.radius:g} mm does not fit into this inside corner", NIST
                ),
            )
        return min(points, key=lambda point: abs(point - here))

    def _front(self) -> _Waiting | None:
        return next((item for item, _ in self._queue if isinstance(item, _Waiting)), None)

    def _wait(self, waiting: _Waiting) -> None:
        self._queue.append((waiting, waiting.step.place))

    def _flush(self, end: complex) -> None:
        """End what waits at `end`; raises ExpandError if the tool would go back and cut the contour."""
        queue, self._queue = self._queue, []
        for item, place in queue:
            if isinstance(item, _Waiting):
                self._check(item, end)
                item.step.end = end
                self.take(item.step, place)
            else:
                self.take(item, place)

    def _check(self, item: _Waiting, end: complex) -> None:
        way = end - item.start
        center = item.step.center
        gouges = (way * item.direction.conjugate()).real < -TANGENT * self.radius
        if center is not None:
            sweep = _sweep(item.start, end, center, _turn(item.step))
            gouges = sweep > item.sweep + LONGER and 2 * math.pi - sweep > LONGER
        if gouges:
            what = "arc" if center is not None else "line"
            raise ContourError(
                item.step.place,
                LineError(
                    f"the tool's radius of {self.radius:g} mm would cut the contour: this {what} is too "
                    "short for the inside corners at its ends",
                    NIST,
                ),
            )


@dataclass
class _Path:
    """A straight path through a point in a direction, or a circle around it."""

    point: complex
    direction: complex = 0j
    radius: float = 0.0


def _intersections(one: _Path, other: _Path) -> list[complex]:
    if one.direction and other.direction:
        across = (one.direction.conjugate() * other.direction).imag
        if abs(across) < TANGENT:
            return []
        far = ((other.point - one.point) * other.direction.conjugate()).imag / -across
        return [one.point + far * one.direction]
    if one.direction or other.direction:
        line, circle = (one, other) if one.direction else (other, one)
        turned = (circle.point - line.point) * line.direction.conjugate()  # along the line, and off it
        return _pair(
            line.point, line.direction, turned.real, circle.radius**2 - turned.imag**2, circle.radius
        )
    way = other.point - one.point
    distance = abs(way)
    if distance < TANGENT:
        return []
    along = (distance**2 + one.radius**2 - other.radius**2) / (2 * distance)
    pair = _pair(0j, 1 + 0j, 0.0, one.radius**2 - along**2, one.radius)
    return [one.point + way / distance * (along + 1j * point.real) for point in pair]


def _pair(point: complex, direction: complex, middle: float, square: float, size: float) -> list[complex]:
    """The points of a line at a distance, given by its square, before and behind the middle."""
    if square < -TANGENT * size**2:
        return []
    half = math.sqrt(max(0.0, square))
    return [point + direction * (middle - half), point + direction * (middle + half)]


def _turn(step: Step) -> int:
    return -1 if step.clockwise else 1


def _unit(vector: complex) -> complex:
    return vector / abs(vector)


def _sweep(begin: complex, end: complex, center: complex, turn: int) -> float:
    """The angle of an arc, up to a full turn, which is also that of an arc that ends where it begins."""
    angle = cmath.phase((end - center) / (begin - center)) * turn
    return angle if angle > TANGENT else angle + 2 * math.pi


def arc_length(begin: complex, step: Step) -> float:
    """Of an arc from a place, in mm."""
    assert step.center is not None
    return _sweep(begin, step.end, step.center, _turn(step)) * abs(step.end - step.center)
