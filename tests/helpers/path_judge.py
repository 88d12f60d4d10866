# SPDX-License-Identifier: MIT
"""Judges a path by the steps that left the pins: nothing here knows the planner or the core.

Each axis makes the steps of each line in order, so every step has a known place on the path. Places and
times give speeds and accelerations along the path, and with the directions of the lines those of each
axis. All parts of the acceleration of an axis together are those of the judge of axes.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from passo.axis_judge import Marks, faults, shares
from passo.move_forms import UNIT_Q32
from passo.moves import q32
from passo.path import PathSettings
from passo.path_rounding import Line

from tests.helpers.path_limits import Limits, limits_of
from tests.helpers.path_player import Played

WINDOW = 2e-3  # seconds over which speeds are measured
CORNER_WINDOW = 5e-4
JERK_WINDOW = 8e-3
JERK_GAP = 5e-4  # seconds between two steps: with more, their places say too little
PLACE = 5e-5  # mm: a step is placed to a few substeps
LATE = 16  # clocks that a step may wait for its pins
SPEED_BOUND = 1.001
ACCELERATION_BOUND = 1.02
JERK_BOUND = 1.03
AXIS_NAMES = ("speed", "acceleration")  # of the judge of axes
TICKS_BOUND = 4  # ticks of acceleration by which the speed at a corner may be off


@dataclass(frozen=True)
class Verdict:
    """How near the limits were: highest ratio of what was measured to what is allowed."""

    speed: float
    acceleration: float
    corner: float
    jump: float
    problems: list[str]
    jerk: float = 0.0
    peak_jerk: float = 0.0  # mm/s^3 along the path


def steps_at(target: Sequence[float], settings: PathSettings) -> list[int]:
    """The position of each axis at a target in mm, rounded to the nearest step."""
    found = []
    for mm, axis in zip(target, settings.axes, strict=True):
        size = (abs(q32(mm)) * q32(axis.steps_per_mm) + UNIT_Q32 * UNIT_Q32 // 2) // (UNIT_Q32 * UNIT_Q32)
        found.append(size if mm > 0 else -size)
    return found


@dataclass(frozen=True)
class Samples:
    """Times (s) and places (mm) of all steps in the order of the path; places of the lines' ends."""

    time: np.ndarray
    place: np.ndarray
    ends: np.ndarray


def place_steps(
    lines: Sequence[Line], settings: PathSettings, limits: Limits, played: Played, problems: list[str]
) -> Samples | None:
    """Assign each step to its line; the counts, directions and order must be those of the lines."""
    hz = settings.clock_hz
    points = np.array([[0] * len(settings.axes), *(steps_at(target, settings) for target, _ in lines)])
    counts = np.diff(points, axis=0)
    here = [(0.0,) * len(settings.axes), *(tuple(target) for target, _ in lines)]
    counts = counts[[here[i] != here[i + 1] for i in range(len(lines))]]
    ends = np.concatenate(([0.0], np.cumsum(limits.length)))
    last = np.full(len(counts), -np.inf)
    first = np.full(len(counts), np.inf)
    times, places = [], []
    for axis in range(len(settings.axes)):
        size = np.abs(counts[:, axis])
        after = np.cumsum(size)
        clocks, steps = played.clocks[axis], played.steps[axis]
        if len(clocks) != after[-1]:
            problems.append(f"axis {axis}: {len(clocks)} steps instead of {after[-1]}")
            return None
        line = np.repeat(np.arange(len(size)), size)
        signs = np.diff(np.concatenate(([0], steps)))
        if not np.array_equal(signs, np.sign(counts[line, axis])):
            problems.append(f"axis {axis}: a step in the wrong direction")
        number = np.arange(len(clocks)) - (after - size)[line]
        share = (number + 0.5) / np.maximum(size[line], 1)
        times.append(clocks)
        places.append(ends[line] + share * limits.length[line])
        np.maximum.at(last, line, clocks / hz)
        np.minimum.at(first, line, clocks / hz)
    time, place = np.concatenate(times), np.concatenate(places)
    order = np.lexsort((place, time))
    time, place = time[order] / hz, place[order]
    back = np.flatnonzero(np.diff(place) < -PLACE)
    if len(back):
        problems.append(
            f"{len(back)} steps out of the order of the path, the first at {place[back[0]]:.4f} mm"
        )
    before = np.maximum.accumulate(last)
    behind = np.minimum.accumulate(first[::-1])[::-1]
    if (before[:-1] > behind[1:] + LATE / hz).any():
        problems.append("a step of a line before the end of the line before")
    return Samples(time, place, ends)


def windows(samples: Samples, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of samples that are at least so far apart in time, but as little as possible."""
    first = np.arange(len(samples.time))
    second = np.searchsorted(samples.time, samples.time + width)
    inside = second < len(samples.time)
    return first[inside], second[inside]


def most_between(values: np.ndarray, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Highest of values[first .. last], both included."""
    table = [values]
    while len(table[-1]) > 1 << (len(table) - 1):
        step = 1 << (len(table) - 1)
        table.append(np.maximum(table[-1][:-step], table[-1][step:]))
    level = np.minimum(np.log2(last - first + 1).astype(int), len(table) - 1)
    found = np.empty(len(first))
    for k in np.unique(level):
        chosen = level == k
        begin, end = first[chosen], last[chosen] + 1 - (1 << int(k))
        found[chosen] = np.maximum(table[k][begin], table[k][end])
    return found


def judge(lines: Sequence[Line], settings: PathSettings, played: Played, rests: bool = False) -> Verdict:
    """Compare what was played with the limits; with `rests` the path may have rested on the way.

    A corner at which it rested is none, so neither its jump nor the arc that it is part of is judged.
    """
    problems: list[str] = []
    limits = limits_of(lines, settings, arcs=not rests)
    if played.positions != steps_at(lines[-1][0], settings):
        problems.append(f"the end is {played.positions} instead of {steps_at(lines[-1][0], settings)}")
    if played.drained:
        problems.append(f"{played.drained} substeps were drained")
    samples = place_steps(lines, settings, limits, played, problems)
    if samples is None or len(samples.time) < 3:
        return Verdict(0, 0, 0, 0, problems)

    def line_of(place: np.ndarray) -> np.ndarray:
        return np.clip(np.searchsorted(samples.ends, place, "right") - 1, 0, len(limits.length) - 1)

    tick = 128 / settings.clock_hz
    first, second = windows(samples, WINDOW)
    speed_ratio = acceleration_ratio = 0.0
    if len(first):
        width = samples.time[second] - samples.time[first]
        speed = (samples.place[second] - samples.place[first]) / width
        a, b = line_of(samples.place[first]), line_of(samples.place[second])
        allowed = np.sqrt(most_between(limits.top, a, b)) + PLACE / width
        speed_ratio = float((speed / allowed).max())
        middle = (samples.time[first] + samples.time[second]) / 2
        pair = np.searchsorted(first, second)
        inside = pair < len(first)
        one, two = np.flatnonzero(inside), pair[inside]
        if len(one):
            change = np.abs(speed[two] - speed[one]) / (middle[two] - middle[one])
            noise = 2 * PLACE / np.minimum(width[one], width[two]) / (middle[two] - middle[one])
            most = most_between(limits.acceleration, a[one], b[two])
            acceleration_ratio = float(((change - noise) / most).max())
    peak_jerk, jerk_ratio = jerks(limits, samples, line_of)
    corner_ratio, jump_ratio = corners(settings, limits, samples, tick, rests)
    for name, ratio, bound in (
        ("speed", speed_ratio, SPEED_BOUND),
        ("acceleration", acceleration_ratio, ACCELERATION_BOUND),
        ("corner", corner_ratio, 1),
        ("jump", jump_ratio, 1),
        ("jerk", jerk_ratio, JERK_BOUND),
    ):
        if ratio > bound:
            problems.append(f"the {name} is {ratio:.4f} of its limit")
    marks = Marks.of(lines, settings, played.clocks, played.steps)
    if settings.profile == "linear":
        problems += faults(shares(played.clocks, played.steps, settings, marks, AXIS_NAMES))
    return Verdict(speed_ratio, acceleration_ratio, corner_ratio, jump_ratio, problems, jerk_ratio, peak_jerk)


def jerks(
    limits: Limits, samples: Samples, line_of: Callable[[np.ndarray], np.ndarray]
) -> tuple[float, float]:
    """Highest mean jerk along the path over windows with dense steps: mm/s^3, and a ratio of its limit."""
    times = np.arange(samples.time[0], samples.time[-1] - 3 * JERK_WINDOW, JERK_WINDOW / 16)
    edges = times[:, None] + JERK_WINDOW * np.arange(4)
    wide = np.concatenate(([0], np.cumsum(np.diff(samples.time) > JERK_GAP)))
    first, last = (np.searchsorted(samples.time, edges[:, k]) for k in (0, 3))
    dense = wide[np.minimum(last, len(wide) - 1)] == wide[np.maximum(first - 1, 0)]
    edges = edges[dense]
    if not len(edges):
        return 0.0, 0.0
    places = np.interp(edges, samples.time, samples.place)
    mean = np.abs(places @ np.array([-1, 3, -3, 1])) / JERK_WINDOW**3
    allowed = most_between(limits.jerk, line_of(places[:, 0]), line_of(places[:, 3]))
    noise = 8 * PLACE / JERK_WINDOW**3
    return float(mean.max()), float((np.maximum(mean - noise, 0) / allowed).max())


def corners(
    settings: PathSettings, limits: Limits, samples: Samples, tick: float, rests: bool
) -> tuple[float, float]:
    """The speed at each corner, at least: the mean around it, less what the acceleration makes of it."""
    worst = worst_jump = 0.0
    jumps = np.array([float(axis.jump) for axis in settings.axes])
    for i in range(1, len(limits.length)):
        place = samples.ends[i]
        k = int(np.searchsorted(samples.place, place))
        if k == 0 or k == len(samples.place):
            continue
        after = max(k, int(np.searchsorted(samples.time, samples.time[k - 1] + CORNER_WINDOW)))
        before = int(np.searchsorted(samples.time, samples.time[k] - CORNER_WINDOW, "right")) - 1
        before, after = max(0, min(before, k - 1)), min(after, len(samples.time) - 1)
        width = samples.time[after] - samples.time[before]
        if width <= 0:
            continue
        around = np.searchsorted(samples.ends, samples.place[[before, after]], "right") - 1
        steepest = limits.acceleration[around[0] : around[1] + 1].max()
        speed = (samples.place[after] - samples.place[before] - PLACE) / width - steepest * width / 2
        allowed = limits.corner[i] ** 0.5 + TICKS_BOUND * tick * steepest
        worst = max(worst, speed / allowed)
        change = np.abs(limits.unit[i] - limits.unit[i - 1])
        limited = jumps > 0
        if limited.any() and not rests:
            made = (speed - TICKS_BOUND * tick * steepest) * change[limited]
            worst_jump = max(worst_jump, float((made / jumps[limited]).max()))
    return worst, worst_jump
