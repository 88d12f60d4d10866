# SPDX-License-Identifier: MIT
"""A fast motion along a path with limited jerk, by linear programs (scipy's HiGHS): what a planner can be
compared with. It is a motion that keeps all limits, and about as fast as any: not a bound.

With the square of the speed `b` over the path `s`, the jerk of an axis is

    sqrt(b) (u b'' / 2 + 3 k b' / 2 - K^2 u b)

`u` its share of the direction, `k` its curvature and `K` that of the path. So the sum in brackets is at most
`j / sqrt(b)`, which is no convex limit. But its tangents, at whatever `b`, are below it: between those at a
motion the problem is linear, and all that it allows keeps the limit. So each program makes the motion faster,
from half of the squares without a limit of jerk on, until nothing changes.

Where two lines meet, the direction changes over the rounding of the corner, as in path_rounding.py; that the
curvature itself begins and ends abruptly is left out, since no planner of lines has another one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from passo.path import PathSettings
from passo.path_rounding import Line
from scipy.optimize import linprog
from scipy.sparse import csr_array, diags_array, eye_array, vstack

from benchmarks.path_reference import METHOD, Motion, fastest_at

CELLS = 500
FINE = 16  # places within a cell of the motion without a limit of jerk
ROUNDS = 60
SETTLED = 1e-3  # gain of a round that is the last
GROWTH = 3.0  # a tangent to 1 / sqrt(b) is 0 at three times b
SLOWEST = 1e-9  # of the greatest square


@dataclass(frozen=True)
class Grid:
    """Nodes, and the sums in brackets at those between the first and the last, for each limit."""

    place: np.ndarray
    most: np.ndarray
    accelerations: csr_array
    bounds: np.ndarray
    jerks: list[csr_array]

    def seconds(self, square: np.ndarray) -> float:
        """Duration."""
        speed = np.sqrt(np.maximum(square, 0))
        return float((2 * np.diff(self.place) / np.maximum(speed[1:] + speed[:-1], 1e-12)).sum())


def _fine(motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Places, and the squares there: within a straight cell the speed may rise and fall again."""
    share = (1 - np.cos(np.linspace(0, np.pi, FINE + 1)[:-1])) / 2
    size, low, high = np.diff(motion.place), motion.square[:-1], motion.square[1:]
    reach = 2 * motion.along * size
    place = motion.place[:-1, None] + size[:, None] * share
    rise, fall = low[:, None] + reach[:, None] * share, high[:, None] + reach[:, None] * (1 - share)
    straight = np.minimum(np.minimum(rise, fall), np.maximum(motion.top, low)[:, None])
    square = np.where(motion.bent[:, None], low[:, None] + (high - low)[:, None] * share, straight)
    return np.append(place.ravel(), motion.place[-1]), np.append(square.ravel(), motion.square[-1])


def _places(motion: Motion) -> np.ndarray:
    """Nodes at about equal times of the motion without a limit of jerk, and those where limits change."""
    place, square = _fine(motion)
    speed = np.sqrt(np.maximum(square, 0))
    time = np.insert(np.cumsum(2 * np.diff(place) / np.maximum(speed[1:] + speed[:-1], 1e-9)), 0, 0)
    even = np.interp(np.linspace(0, time[-1], CELLS + 1), time, place)
    near = np.searchsorted(even, motion.place)
    apart = np.diff(even, prepend=-np.inf, append=np.inf)
    after, before = even[np.minimum(near, CELLS)], even[near - 1]
    gap = np.minimum(np.abs(motion.place - after), np.abs(motion.place - before))
    kept = motion.place[(gap > apart[near] / 8) | (motion.most < motion.square.max() / 4)]
    found = np.unique(np.concatenate([kept, even]))
    return found[np.diff(found, append=np.inf) > 1e-9]


def _course(motion: Motion, middle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of each cell: the direction, and the curvature of each axis."""
    path = motion.path
    line = np.minimum(np.searchsorted(path.end, middle), len(path.end) - 1)
    unit, bend = path.unit[line].copy(), np.zeros((len(middle), path.unit.shape[1]))
    if len(path.corner):
        corner = np.clip(np.searchsorted(path.corner + path.behind, middle), 0, len(path.corner) - 1)
        begin, over = path.corner[corner] - path.before[corner], path.over[corner]
        inside = (middle >= begin) & (middle <= begin + over) & (over > 0)
        which = corner[inside]
        share = (middle[inside] - begin[inside]) / path.over[which]
        unit[inside] = path.unit[which] + share[:, None] * path.turn[which]
        bend[inside] = path.turn[which] / path.over[which][:, None]
    return unit, bend


def _most(motion: Motion, settings: PathSettings, place: np.ndarray, unit: np.ndarray) -> np.ndarray:
    """Highest square at each node; next to rest, what the jerk makes in one cell."""
    gap, middle = np.diff(place), (place[1:] + place[:-1]) / 2
    top = motion.top[np.clip(np.searchsorted(motion.place, middle) - 1, 0, len(motion.top) - 1)]
    most = np.minimum(np.append(top, np.inf), np.insert(top, 0, np.inf))
    known = np.minimum(np.searchsorted(motion.place, place - 1e-12), len(motion.most) - 1)
    at_node = np.abs(motion.place[known] - place) < 1e-9
    most[at_node] = np.minimum(most[at_node], motion.most[known[at_node]])
    weakest = np.min(
        [
            float(own.jerk) / np.maximum(np.abs(unit @ direction), 1e-12)
            for direction, own in settings.limits()
        ],
        axis=0,
    )
    risen = (weakest / 2) ** 2 * (6 * gap / weakest) ** (4 / 3)
    rests = most <= 0
    most[1:][rests[:-1]] = np.minimum(most[1:], risen)[rests[:-1]]
    most[:-1][rests[1:]] = np.minimum(most[:-1], risen)[rests[1:]]
    return most


def _grid(motion: Motion, settings: PathSettings) -> Grid:
    place = _places(motion)
    unit, bend = _course(motion, (place[1:] + place[:-1]) / 2)
    gap, cells = np.diff(place), len(place) - 1
    low, high = eye_array(cells, cells + 1).tocsr(), eye_array(cells, cells + 1, k=1).tocsr()
    rise = diags_array(1 / gap) @ (high - low)
    before, behind = eye_array(cells - 1, cells).tocsr(), eye_array(cells - 1, cells, k=1).tocsr()
    mean, width = (before + behind) / 2, (gap[1:] + gap[:-1]) / 2
    here = eye_array(cells - 1, cells + 1, k=1).tocsr()
    rows, bounds, jerks = [], [], []
    whole = (bend**2).sum(axis=1)
    for direction, own in settings.limits():
        along, across = unit @ direction, bend @ direction
        for end in (low, high):
            row = diags_array(along / 2) @ rise + diags_array(across) @ end
            rows += [row, -row]
            bounds += [np.full(cells, float(own.acceleration))] * 2
        jerk = diags_array(mean @ along / 2 / width) @ ((behind - before) @ rise)
        jerk = jerk + diags_array(1.5 * (mean @ across)) @ (mean @ rise)
        jerks.append((jerk - diags_array(mean @ (whole * along)) @ here).tocsr())
    most = _most(motion, settings, place, unit)
    return Grid(place, most, vstack(rows).tocsr(), np.concatenate(bounds), jerks)


def _faster(grid: Grid, settings: PathSettings, square: np.ndarray) -> np.ndarray:
    """The fastest of the motions between the tangents at one that is known."""
    at = np.maximum(square[1:-1], SLOWEST * grid.most[1:-1].max())
    slope = diags_array(0.5 * at**-1.5)
    rows, bounds = [grid.accelerations], [grid.bounds]
    here = eye_array(len(at), len(square), k=1).tocsr()
    for (_, own), jerk in zip(settings.limits(), grid.jerks, strict=True):
        tangent = float(own.jerk) * (slope @ here)
        for sign in (1, -1):
            rows.append(sign * jerk + tangent)
            bounds.append(float(own.jerk) * 1.5 * at**-0.5)
    matrix, bound = vstack(rows).tocsr(), np.concatenate(bounds)
    scale = np.maximum(abs(matrix).max(axis=1).toarray().ravel(), 1e-12)
    unit = np.maximum(square, SLOWEST * grid.most.max())  # of each unknown
    scaled = diags_array(1 / scale) @ matrix @ diags_array(unit)
    again = np.maximum(abs(scaled).max(axis=1).toarray().ravel(), 1e-12)
    weight = np.zeros(len(square))
    gap = np.diff(grid.place) / np.sqrt(np.maximum((unit[1:] + unit[:-1]) / 2, 1e-12))
    weight[:-1] += gap
    weight[1:] += gap
    found = linprog(
        -weight,
        diags_array(1 / again) @ scaled,
        bound / scale / again,
        bounds=np.stack([np.zeros(len(square)), np.minimum(grid.most / unit, GROWTH)], axis=1),
        method=METHOD,
    )
    if not found.success:
        raise ArithmeticError(found.message)
    return np.maximum(found.x, 0) * unit


def soft_seconds(lines: Sequence[Line], settings: PathSettings) -> float:
    """Duration of a fast motion that keeps speed, acceleration and jerk of each axis."""
    motion = fastest_at(lines, settings, 1.0)
    grid = _grid(motion, settings)
    place, start = _fine(motion)
    square = np.interp(grid.place, place, start) / 2
    best = np.inf
    for _ in range(ROUNDS):
        square = _faster(grid, settings, square)
        took = grid.seconds(square)
        if took > best * (1 - SETTLED):
            break
        best = took
    return min(best, took)
