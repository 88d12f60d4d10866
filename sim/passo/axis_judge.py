# SPDX-License-Identifier: MIT
"""Checks speed, acceleration and jerk of each axis from its STEP times, independently of planner and core.

A motion `y` whose acceleration is at most `a` has `|y(t + w) - 2 y(t) + y(t - w)| <= a w^2` for every
window `w`. The steps `x` follow such a motion to within `e`, so theirs is at most `a w^2 + 4 e`; of first
differences and speed it is `v w + 2 e`, of third ones and jerk `j w^3 + 8 e`. The share of a limit is the
greatest of what the steps need,

    (|x(t + w) - 2 x(t) + x(t - w)| - 4 e) / (a w^2)

over all times and windows. The windows grow by half an octave, `a` from where `e` of rounding hides half
of the limit, `w = sqrt(8 e / a)`, and `j` likewise, to where it hides a hundredth even in a corner; `v`
to where it hides a thousandth. Times are an eighth of the shortest window apart. `e` is

* half a step, since steps are rounded; a place between two steps is between their places;
* where the path has a corner within the window: by how much it may be rounded there, along the axis;

Where a step of the other direction left as soon as the pins allow, it may have been asked for earlier by as
long as they take to change DIR, with those behind it: at these times the axis may be where it is so much
later.

An axis with a start-stop speed may also jump by that, once in a window.

The axes of a machine whose motors move two of them are the means of their motors, and so is their `e`;
beside the axes it has the limits of these motors, along the directions between the two axes.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from passo.path import PathAxis, PathSettings
from passo.path_rounding import Line, rounded

NAMES = ("speed", "acceleration", "jerk")
BOUND = 1.03  # share of a limit that is a fault
JERK_BOUND = 1.05
STEP = 0.5  # of a step: rounding
VISIBLE, HIDDEN = 0.5, 0.01  # share of a limit that rounding hides in the shortest window, and in the longest
VISIBLE_SPEED, HIDDEN_SPEED = 0.008, 0.001
SAMPLES = 8  # in the shortest window
OCTAVE = 2  # windows
MOST_SAMPLES = 1 << 23
NEARLY = 1.01  # of the time that a change of DIR takes: a step that left later than that did not wait


@dataclass(frozen=True)
class Share:
    """The greatest share of a limit: of which axis or, behind these, motor, in which window, and when."""

    name: str
    axis: int
    share: float = 0.0
    window: float = 0.0  # s
    time: float = 0.0  # s since the start of the first motion, in the middle of the window

    @property
    def bound(self) -> float:
        """Above which it is a fault."""
        return JERK_BOUND if self.name == "jerk" else BOUND

    def __str__(self) -> str:
        return (
            f"axis {self.axis}: {self.share:.3f} of its {self.name}, "
            f"at {self.time:.6g} s over {self.window * 1000:.3g} ms"
        )


@dataclass(frozen=True)
class Marks:
    """Times (s, ascending), as of corners, and time x limit: by how much the axis may be off then (mm)."""

    time: np.ndarray
    off: np.ndarray

    @classmethod
    def none(cls, axes: int) -> "Marks":
        """A path without corners, with this number of limits."""
        return cls(np.empty(0), np.empty((0, axes)))

    def with_more(self, more: Sequence[tuple[np.ndarray, np.ndarray]]) -> "Marks":
        """With further times, and how far each limit may be off then."""
        time = np.concatenate([self.time, *(times for times, _ in more)])
        off = np.concatenate([self.off, *(offs for _, offs in more)])
        order = np.argsort(time, kind="stable")
        return Marks(time[order], off[order])

    @classmethod
    def of(
        cls,
        lines: Sequence[Line],
        settings: PathSettings,
        clocks: Sequence[np.ndarray],
        positions: Sequence[np.ndarray],
    ) -> "Marks":
        """The corners of a path of lines from the origin: each between its last step and the next one.

        Where a merged line passes a corner, a motor may make its last step there later than another one makes
        the next.
        """
        path = rounded(lines, settings)
        own = path.points @ settings.motors.map(len(settings.axes)).T
        places = np.round(own * settings.scales).astype(int)
        corners = path.kept[1:-1]
        begin, end = np.zeros(len(path.corner)), np.full(len(path.corner), np.inf)
        for motor, clock in enumerate(clocks):
            time = clock / settings.clock_hz
            wanted = np.cumsum(np.abs(np.diff(places[:, motor])))[corners - 1]
            done = _steps_until(places[corners, motor], wanted, positions[motor])
            begin = np.maximum(begin, np.concatenate([[0.0], time])[done])
            end = np.minimum(end, np.append(time, np.inf)[done])
        end = np.where(np.isinf(end), begin, end)
        order = np.argsort(np.concatenate([begin, end]))
        off = path.off_along(np.array([direction for direction, _ in settings.limits()]))
        return cls(np.concatenate([begin, end])[order], np.concatenate([off, off])[order])


def _steps_until(places: np.ndarray, wanted: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """How many steps a motor has made when it is at each of these places, in turn; `wanted`: of the lines.

    It makes fewer where lines are merged: at the far end of a curve it need not go there and back. So of all
    times at which it is at a place it is the one nearest to that, less what was missing at the last place.
    """
    own = np.concatenate([[0], positions]).astype(int)
    order = np.argsort(own, kind="stable")
    first, last = (np.searchsorted(own[order], places, side) for side in ("left", "right"))
    done, missing = np.zeros(len(places), int), 0
    for i in range(len(places)):
        near, done[i] = order[first[i] : last[i]], wanted[i] - missing
        if len(near):
            done[i] = near[np.argmin(np.abs(near - done[i]))]
            missing = wanted[i] - done[i]
    return np.clip(done, 0, len(own) - 1)


def shares(
    clocks: Sequence[np.ndarray],
    positions: Sequence[np.ndarray],
    settings: PathSettings,
    marks: Marks | None = None,
    names: Sequence[str] = NAMES,
    turning: int = 0,
) -> list[Share]:
    """The greatest share of each limit, by the clocks of the steps of the motors and the positions after.

    `turning`: clocks by which a step may leave late where DIR changes, those of all its intervals.
    """
    limits, found = settings.limits(), []
    known = marks or Marks.none(len(limits))
    motors = [
        Places.of(clock / settings.clock_hz, position, scale)
        for clock, position, scale in zip(clocks, positions, settings.scales, strict=True)
    ]
    end = max((float(own[-1]) for own in clocks if len(own)), default=0.0) / settings.clock_hz
    for number, (direction, axis) in enumerate(limits):
        place = Mean.of(direction, motors, settings)
        off = Most.of(known.time, known.off[:, number])
        for order, name in enumerate(NAMES, 1):
            limit = float(getattr(axis, name))
            if name in names and limit > 0 and (name != "jerk" or settings.profile == "jerk"):
                found.append(_greatest(place, off, turning / settings.clock_hz, axis, number, order, end))
    return found


def faults(found: Sequence[Share]) -> list[str]:
    """Shares above their bound, one sentence each."""
    return [str(share) for share in found if share.share > share.bound]


@dataclass(frozen=True)
class Places:
    """Times and places of an axis: between two steps of one direction it moves evenly, else it rests."""

    time: np.ndarray
    place: np.ndarray
    rounding: float  # mm

    @classmethod
    def of(cls, time: np.ndarray, position: np.ndarray, steps_per_mm: float) -> "Places":
        """A step is half-way between the positions before and after it."""
        before = np.concatenate([[0], position[:-1]])
        place = (position + before) / 2 / steps_per_mm
        first, last = ([time[0] - 1e-9], [time[-1] + 1e-9]) if len(time) else ([0.0], [1e-9])
        return cls(
            np.concatenate([first, time, last]),
            np.concatenate([[0.0], place, [position[-1] / steps_per_mm if len(position) else 0.0]]),
            STEP / steps_per_mm,
        )

    def at(self, times: np.ndarray) -> np.ndarray:
        """Places at these times."""
        return np.interp(times, self.time, self.place)

    def late(self, times: np.ndarray, turning: float) -> np.ndarray:
        """How far the axis is late at these times, at most: what it moves while DIR changes."""
        stands = np.flatnonzero(np.diff(self.place[1:-1]) == 0) + 2  # steps back, over the same place
        first = self.time[stands]
        first = first[first - self.time[stands - 1] <= turning * NEARLY]
        if turning <= 0 or not len(first):
            return np.zeros(len(times))
        behind = np.searchsorted(first, times - turning)
        near = first[np.minimum(behind, len(first) - 1)] <= times + turning
        return np.where((behind < len(first)) & near, np.abs(self.at(times + turning) - self.at(times)), 0)


@dataclass(frozen=True)
class Mean:
    """What moves along a direction: the motors that say so, each by its weight."""

    motors: list[tuple[float, Places]]

    @classmethod
    def of(cls, direction: np.ndarray, motors: Sequence[Places], settings: PathSettings) -> "Mean":
        """Each axis is the mean of its motors."""
        rows = settings.motors.map(len(direction))
        weights = rows @ (direction / np.abs(rows).sum(axis=0))
        return cls(
            [
                (float(weight), motor)
                for weight, motor in zip(weights, motors, strict=True)
                if abs(weight) > 1e-9
            ]
        )

    @property
    def rounding(self) -> float:
        """Of all together, mm."""
        return sum(abs(weight) * motor.rounding for weight, motor in self.motors)

    def at(self, times: np.ndarray) -> np.ndarray:
        """Places at these times."""
        return np.sum([weight * motor.at(times) for weight, motor in self.motors], axis=0)

    def late(self, times: np.ndarray, turning: float) -> np.ndarray:
        """How far it is late at these times, at most."""
        return np.sum([abs(weight) * motor.late(times, turning) for weight, motor in self.motors], axis=0)


@dataclass(frozen=True)
class Most:
    """The greatest of values within an interval of time."""

    time: np.ndarray
    table: list[np.ndarray]

    @classmethod
    def of(cls, time: np.ndarray, values: np.ndarray) -> "Most":
        """A table for each power of two."""
        table = [values]
        while len(table[-1]) > 1 << (len(table) - 1):
            step = 1 << (len(table) - 1)
            table.append(np.maximum(table[-1][:-step], table[-1][step:]))
        return cls(time, table)

    @property
    def highest(self) -> float:
        """Of all."""
        return float(self.table[0].max(initial=0))

    def between(self, begin: np.ndarray, end: np.ndarray) -> np.ndarray:
        """The greatest of those from `begin` to `end`; 0: there are none."""
        found = np.zeros(len(begin))
        if self.highest == 0:
            return found
        first, last = np.searchsorted(self.time, begin), np.searchsorted(self.time, end, "right")
        level = np.log2(np.maximum(last - first, 1)).astype(int)
        for k in range(level.min(initial=0), level.max(initial=0) + 1):
            chosen = np.flatnonzero((level == k) & (last > first))
            one, other = first[chosen], last[chosen] - (1 << k)
            found[chosen] = np.maximum(self.table[k][one], self.table[k][other])
        return found


def windows(order: int, limit: float, rounding: float, off: float) -> tuple[float, float]:
    """The shortest and the longest window of a limit, in seconds."""
    noise = 2.0**order / limit
    visible, hidden = (VISIBLE_SPEED, HIDDEN_SPEED) if order == 1 else (VISIBLE, HIDDEN)
    first, last = noise * rounding / visible, noise * (rounding + off) / hidden
    return first ** (1 / order), last ** (1 / order)


def _greatest(
    place: Mean, off: Most, turning: float, axis: PathAxis, number: int, order: int, end: float
) -> Share:
    limit, jump = float(getattr(axis, NAMES[order - 1])), float(axis.jump) if order > 1 else 0.0
    highest = off.highest if order > 1 else 0.0
    first, last = windows(order, limit, place.rounding, highest)
    count = int(np.ceil(np.log2(last / first) * OCTAVE)) + 1
    sizes = np.round(SAMPLES * 2.0 ** (np.arange(count) / OCTAVE)).astype(int)
    gap = max(first / SAMPLES, (end + 2 * order * last) / MOST_SAMPLES)
    times = np.arange(-order * last, end + order * last + gap, gap)
    places, late = place.at(times), place.late(times, turning)
    best = Share(NAMES[order - 1], number)
    for size in sizes.tolist():
        made, lateness, window = places, late, size * gap
        for _ in range(order):
            made, lateness = made[size:] - made[:-size], lateness[size:] + lateness[:-size]
        if not len(made):
            break
        hidden: np.ndarray | float = place.rounding
        if highest > 0:
            hidden = hidden + off.between(times[: len(made)], times[order * size :])
        needed = np.abs(made) - 2**order * hidden - lateness - jump * window
        k = int(np.argmax(needed))
        share = float(needed[k]) / (limit * window**order)
        if share > best.share:
            best = Share(best.name, number, share, window, float(times[k]) + order * window / 2)
    return best
