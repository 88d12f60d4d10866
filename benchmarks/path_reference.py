# SPDX-License-Identifier: MIT
"""The fastest motion along a path, as a convex problem from the limits alone (scipy's HiGHS).

The unknowns are the squares of the speed at the nodes of a grid over the rounded path (path_rounding.py).
Between two nodes the acceleration along the path is constant, `(b' - b) / 2h`; that of an axis is `t`
times that plus its curvature times `b`, both signed, at either end within the limit of the axis; where a
motor moves two axes, the same holds along the direction between them. The largest squares are the
shortest time. It knows nothing of steps, substeps, ticks, look-ahead, or of how a
planner chooses its speeds.

A shaped ramp has its peak acceleration in the middle: the part along the path counts by how much steeper
it is there. Jerk is not a part of it: of profile jerk the result is a bound, that of cosine ramps.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from passo.path import PathSettings
from passo.path_rounding import STRAIGHT, Line, Rounded, rounded
from scipy.optimize import linprog
from scipy.sparse import csr_array

TINY = 1e-9  # mm
METHOD = "highs-ds"
CELL = 0.05  # mm: cells of a rounding are not longer, unless there would be too many
CELLS = 8  # of a rounding at most
# how much steeper the shapes are in the middle than a straight ramp: half of pi; 5 / 2 / tanh(5 / 2)
STEEPER = {"linear": 1.0, "cosine": pi / 2, "sigmoid": 2.5336, "jerk": pi / 2}


@dataclass(frozen=True)
class Motion:
    """The fastest motion: squares of the speed at the nodes, and what is between them."""

    path: Rounded
    place: np.ndarray  # of each node
    square: np.ndarray
    along: np.ndarray  # of each cell: highest acceleration along the path, without curvature
    top: np.ndarray  # of each cell: highest square
    bent: np.ndarray  # of each cell: it has a curvature
    most: np.ndarray  # of each node: highest square

    @property
    def times(self) -> np.ndarray:
        """Of each cell. Within a straight one the speed may rise and fall again."""
        size, low, high = np.diff(self.place), self.square[:-1], self.square[1:]
        speed, after = np.sqrt(low), np.sqrt(high)
        plain = 2 * size / np.maximum(speed + after, 1e-12)
        peak = np.minimum(self.top, (low + high) / 2 + self.along * size)
        fast = np.sqrt(np.maximum(peak, np.maximum(low, high)))
        flat = size - (2 * peak - low - high) / (2 * self.along)
        risen = (2 * fast - speed - after) / self.along + np.maximum(flat, 0) / np.maximum(fast, 1e-12)
        return np.where(self.bent, plain, np.minimum(risen, plain))

    @property
    def seconds(self) -> float:
        """Of all."""
        return float(self.times.sum())

    def fits(self, look_ahead: int, spare: int = 4) -> bool:
        """Whether the braking distance is always within this number of lines, each of one feed.

        From the highest speed on an arc it is pi / 2 times that on a straight line: with `w` the share of the
        acceleration that the curve takes, `dw/ds = -2 sqrt(1 - w^2) / r`.
        """
        ends = np.union1d(self.path.end, _feeds(self.path)[0])
        line = np.searchsorted(ends, self.place[:-1], "right")
        last = np.minimum(line + look_ahead - spare, len(ends) - 1)
        along = np.where(self.bent, self.along * 2 / pi, self.along)
        weakest = np.minimum.accumulate(along[::-1])[::-1]
        reach = np.where(last == len(ends) - 1, np.inf, ends[last] - self.place[:-1])
        return bool((self.square[:-1] <= 2 * weakest * reach).all())


def _grid(path: Rounded, marks: np.ndarray) -> np.ndarray:
    """Nodes: ends of lines and of roundings, and some within these; `marks` are ends of feeds."""
    edges = np.concatenate([[0], path.end, path.corner - path.before, path.corner + path.behind, marks])
    edges = np.unique(np.clip(edges, 0, path.end[-1]))
    edges = edges[np.diff(edges, append=np.inf) > TINY]
    edges[-1] = path.end[-1]
    size = np.diff(edges)
    which = _corner_at(path, (edges[1:] + edges[:-1]) / 2)
    bent = (which >= 0) & ~np.append(path.alone, False)[which]
    count = np.where(bent, np.clip(np.ceil(size / CELL), 1, CELLS), 1).astype(int)
    start = np.repeat(edges[:-1], count)
    number = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    return np.append(start + number * np.repeat(size / count, count), edges[-1])


def _corner_at(path: Rounded, places: np.ndarray) -> np.ndarray:
    """The corner whose rounding covers each place, or -1."""
    if not len(path.corner):
        return np.full(len(places), -1)
    which = np.clip(np.searchsorted(path.corner + path.behind, places), 0, len(path.corner) - 1)
    covered = (places >= path.corner[which] - path.before[which]) & (path.over[which] > TINY)
    return np.where(covered & (places <= path.corner[which] + path.behind[which]), which, -1)


def _feeds(path: Rounded) -> tuple[np.ndarray, np.ndarray]:
    """Places at which the feed changes, and the feeds between them."""
    size = np.linalg.norm(np.diff(path.points, axis=0), axis=1)
    ends = np.cumsum(size)
    known = ends[path.kept[1:] - 1]
    places = np.interp(ends, np.concatenate([[0], known]), np.concatenate([[0], path.end]))
    change = np.flatnonzero(path.feed[1:] != path.feed[:-1])
    return places[change], path.feed[np.append(change, len(path.feed) - 1)]


def fastest(lines: Sequence[Line], settings: PathSettings, begin: Sequence[float] | None = None) -> Motion:
    """The fastest motion from rest to rest."""
    return fastest_at(lines, settings, STEEPER[settings.profile], begin)


def fastest_at(
    lines: Sequence[Line], settings: PathSettings, steeper: float, begin: Sequence[float] | None = None
) -> Motion:
    """The same with ramps that are so much steeper in the middle."""
    path = rounded(lines, settings, begin)
    limits = settings.limits()
    speed, acceleration, jump = (
        np.array([float(getattr(limit, name)) for _, limit in limits])
        for name in ("speed", "acceleration", "jump")
    )
    along_limits = np.array([direction for direction, _ in limits]).T
    unit, change = path.unit @ along_limits, path.turn @ along_limits
    marks, feeds = _feeds(path)
    place = _grid(path, marks)
    size, middle = np.diff(place), (place[1:] + place[:-1]) / 2
    line = np.minimum(np.searchsorted(path.end, middle), len(path.end) - 1)
    share = np.maximum(np.abs(unit), 1e-12)
    along = (acceleration / share).min(axis=1)
    if settings.acceleration:
        along = np.minimum(along, float(settings.acceleration))
    top = np.minimum((speed / share).min(axis=1)[line], feeds[np.searchsorted(marks, middle)]) ** 2
    most = np.minimum(np.append(top, np.inf), np.insert(top, 0, np.inf))
    halt = np.where(unit[[0, -1]] == 0, np.inf, jump / share[[0, -1]]).min(axis=1) ** 2
    most[0], most[-1] = np.minimum(halt, most[[0, -1]])
    node = np.searchsorted(place, path.corner - TINY)
    turn = np.maximum(np.abs(change), 1e-12)
    np.minimum.at(most, node, (acceleration / turn).min(axis=1) * path.arc)
    most[node[(np.linalg.norm(path.turn, axis=1) > STRAIGHT) & (path.over < TINY)]] = 0
    jumping = np.where((jump > 0) & (change != 0), jump / turn, np.inf)
    np.minimum.at(most, node, jumping.min(axis=1) ** 2)
    stage = _Stage(path, unit, change, place, size, _corner_at(path, middle), along[line] / steeper, most)
    square = stage.solve(acceleration, steeper)
    return Motion(path, place, square, stage.along, top, stage.corner >= 0, most)


@dataclass(frozen=True)
class _Stage:
    """The cells, and what the squares at the nodes between them may be."""

    path: Rounded
    unit: np.ndarray  # line x limit, as the direction of the path
    turn: np.ndarray  # corner x limit
    place: np.ndarray
    size: np.ndarray
    corner: np.ndarray  # that covers each cell, or -1
    along: np.ndarray
    most: np.ndarray

    def rows(self, acceleration: np.ndarray, steeper: float) -> tuple[np.ndarray, ...]:
        """Cell, factors of the squares at its two ends, and the bound of their sum."""
        every, ones = np.arange(len(self.size)), np.ones(len(self.size))
        reach = 2 * self.along * self.size
        found = [(every, -ones, ones, reach), (every, ones, -ones, reach)]
        path = self.path
        bent = np.flatnonzero((self.corner >= 0) & ~np.append(path.alone, False)[self.corner])
        which = self.corner[bent]
        begin = path.corner[which] - path.before[which]
        for axis, limit in enumerate(acceleration):
            curvature = self.turn[which, axis] / path.over[which]
            for end in (0, 1):
                share = np.clip((self.place[bent + end] - begin) / path.over[which], 0, 1)
                direction = self.unit[which, axis] + share * self.turn[which, axis]
                slope = direction * steeper / (2 * self.size[bent])
                low, high = -slope + curvature * (1 - end), slope + curvature * end
                for sign in (1.0, -1.0):
                    found.append((bent, sign * low, sign * high, np.full(len(bent), limit)))
        return tuple(np.concatenate(column) for column in zip(*found, strict=True))

    def lone(self, acceleration: np.ndarray, steeper: float) -> tuple[np.ndarray, ...]:
        """Nodes where the rounding of a corner begins, at the corner, and where it ends; factors of the
        squares there, and the bound of their sum.

        With `f` and `g`, what the acceleration along the path leaves of that of an axis before and behind the
        corner, its velocity changes by `2 sqrt(d) (sqrt(f) + sqrt(g))` at most while it stays within `d`.
        The square is `4 d (f + g + 2 sqrt(f g))`; the root is at least the smaller one. And it changes by
        no more than `f + g` in the time that the path takes for `l`.
        """
        path, found = self.path, []
        which = np.flatnonzero(path.alone & (path.arc > TINY))
        node = np.searchsorted(self.place, path.corner[which] - TINY)
        size = np.linalg.norm(path.turn[which], axis=1)
        first = np.searchsorted(self.place, path.corner[which] - path.before[which] - TINY)
        last = np.searchsorted(self.place, path.corner[which] + path.behind[which] - TINY)
        for axis, limit in enumerate(acceleration):
            turn = self.turn[which, axis]
            sign = np.sign(turn) * steeper
            before = sign * self.unit[which, axis] / (2 * (self.place[node] - self.place[first]))
            behind = sign * self.unit[which + 1, axis] / (2 * (self.place[last] - self.place[node]))
            needed = np.abs(turn) * size / (4 * path.deviation) if path.deviation else np.abs(turn)
            for one, other in ((3, 1), (1, 3)):
                row = (-one * before, needed + one * before - other * behind, other * behind)
                found.append((first, node, last, *row, np.full(len(node), 4 * limit)))
            within = np.abs(turn) / path.arc[which]
            row = (-before, within + before - behind, behind)
            found.append((first, node, last, *row, np.full(len(node), 2 * limit)))
        return tuple(np.concatenate(column) for column in zip(*found, strict=True))

    def solve(self, acceleration: np.ndarray, steeper: float) -> np.ndarray:
        """The largest squares."""
        cell, low, high, bound = self.rows(acceleration, steeper)
        first, node, last, before, there, behind, limit = self.lone(acceleration, steeper)
        own = len(cell) + np.arange(len(node))
        row = np.concatenate([np.arange(len(cell)), np.arange(len(cell)), own, own, own])
        column = np.concatenate([cell, cell + 1, first, node, last])
        value, bound = np.concatenate([low, high, before, there, behind]), np.concatenate([bound, limit])
        scale = np.full(len(bound), TINY)
        np.maximum.at(scale, row, np.abs(value))
        matrix = csr_array((value / scale[row], (row, column)), (len(bound), len(self.place)))
        unit = max(float(self.most.max()), 1e-6)
        found = linprog(
            -np.ones(len(self.place)),
            matrix,
            bound / scale / unit,
            bounds=np.stack([np.zeros(len(self.place)), self.most / unit], axis=1),
            method=METHOD,
        )
        if not found.success:
            raise ArithmeticError(found.message)
        return np.maximum(found.x, 0) * unit


def seconds(lines: Sequence[Line], settings: PathSettings, begin: Sequence[float] | None = None) -> float:
    """Duration of the fastest motion."""
    return fastest(lines, settings, begin).seconds
