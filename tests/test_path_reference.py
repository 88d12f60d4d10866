# SPDX-License-Identifier: MIT
"""The fastest motion along a path, as a convex problem, against closed forms."""

import math
import random
from dataclasses import replace

import numpy as np
import pytest
from passo.axis_judge import Marks
from passo.axis_judge import shares as axis_shares
from passo.path import PathAxis, PathSettings
from passo.path_rounding import Line, rounded

from benchmarks import path_cases
from benchmarks.path_reference import Motion, fastest, seconds

MACHINE = PathSettings((PathAxis(), PathAxis(), PathAxis(400, 12, 100)))


def test_a_line() -> None:
    """A trapezoid, a triangle, a slow feed, the weakest axis of a diagonal."""
    assert seconds([((50, 0, 0), 100)], MACHINE) == pytest.approx(0.5 + 0.1)
    assert seconds([((4, 0, 0), 100)], MACHINE) == pytest.approx(2 * math.sqrt(4 / 1000))
    assert seconds([((1, 0, 0), 0.05)], MACHINE) == pytest.approx(20.00005)
    assert seconds([((0, 0, 10), None)], MACHINE) == pytest.approx(10 / 12 + 0.12)
    assert seconds([((30, 40, 0), None)], MACHINE) == pytest.approx(50 / 250 + 250 / 1250)
    jumping = replace(MACHINE, axes=(PathAxis(jump=5), *MACHINE.axes[1:]))
    assert seconds([((50, 0, 0), 100)], jumping) == pytest.approx(
        0.6 - 2 * 0.005 + 2 * 0.005**2 * 1000 / 2 / 100
    )


def test_a_fast_line_between_slow_ones() -> None:
    """1 mm at 5 mm/s, 98 mm at 200 mm/s, 1 mm at 5 mm/s."""
    lines: list[Line] = [((1, 0, 0), 5), ((99, 0, 0), None), ((100, 0, 0), 5)]
    slow, rise = 1 / 5 + 0.005 - 0.0025, (200 - 5) / 1000
    fast = (98 - (200**2 - 5**2) / 1000) / 200
    assert seconds(lines, MACHINE) == pytest.approx(2 * slow + 2 * rise + fast)
    assert seconds(lines, MACHINE) == pytest.approx(1.085, abs=5e-4)


def test_two_lines_at_a_right_angle() -> None:
    """The velocity of an axis drops to 0 at the corner, after its whole deceleration: within `d`."""
    speed = math.sqrt(4 * 0.01 * 1000 / math.sqrt(2))
    arc = math.sqrt(2 * 0.01 * (1 + math.sqrt(0.5)) * 1000)
    motion = fastest([((50, 0, 0), 100), ((50, 50, 0), 100)], MACHINE)
    corner = math.sqrt(float(motion.square[np.argmin(np.abs(motion.place - 50))]))
    assert speed < corner <= arc * (1 + 1e-6)
    at_rest = 2 * (50 / 100 + 0.1)
    assert at_rest - 2 * arc / 1000 < motion.seconds < at_rest - 0.8 * 2 * speed / 1000


def test_slivers_beside_corners() -> None:
    """Lines of other feeds within a rounding change little: its slope on a side is that of all of it."""
    plain: list[Line] = []
    split: list[Line] = []
    angle, x, y = math.radians(20), 0.0, 0.0
    for number in range(30):
        along = angle + (math.pi / 2 if number % 2 else 0)
        for part, feed in ((0.001, 100), (0.099, 101), (0.001, 100)):
            x, y = x + part * math.cos(along), y + part * math.sin(along)
            split.append(((x, y, 0), feed))
        plain.append(((x, y, 0), 100))
    assert seconds(split, MACHINE) == pytest.approx(seconds(plain, MACHINE), rel=3e-3)


@pytest.mark.parametrize("chords", [40, 360, 4000])
def test_a_circle_at_a_constant_speed(chords: int) -> None:
    """The centripetal acceleration is all of that of the axes, where the feed does not limit it."""
    radius, feed = 2.0, 1000.0
    angles = np.linspace(0, 20 * math.pi, 10 * chords + 1)[1:]
    lines: list[Line] = [
        ((radius * math.sin(a), radius - radius * math.cos(a)), feed) for a in angles.tolist()
    ]
    machine = PathSettings((PathAxis(80, 5000), PathAxis(80, 5000)))
    motion = fastest(lines[: 4 * chords], machine)
    middle = np.abs(motion.place - motion.place[-1] / 2) < motion.place[-1] / 8
    speed = np.sqrt(motion.square[middle])
    assert speed.min() == pytest.approx(math.sqrt(1000 * radius), rel=0.02)


def shares(motion: Motion, machine: PathSettings) -> np.ndarray:
    """Of the acceleration of the axes that both parts take together, within each cell of a curve."""
    along = np.diff(motion.square) / (2 * np.diff(motion.place))
    path, middle = motion.path, (motion.place[1:] + motion.place[:-1]) / 2
    which = np.clip(np.searchsorted(path.corner + path.behind, middle), 0, len(path.corner) - 1)
    inside = middle >= path.corner[which] - path.before[which]
    direction = path.unit[which] + (0.5 * path.turn[which])
    bend = path.turn[which] / path.over[which, None]
    square = (motion.square[1:] + motion.square[:-1]) / 2
    limits = np.array([float(axis.acceleration) for axis in machine.axes])
    return (np.abs(along[:, None] * direction + square[:, None] * bend) / limits)[inside]


def test_both_parts_of_a_curve_are_within_the_limit_of_each_axis() -> None:
    """And somewhere on the whole of it one axis is at its limit: nothing is given away."""
    machine = PathSettings((PathAxis(), PathAxis(80, 200, 700)))
    lines: list[Line] = [(target[:2], None) for target, _ in path_cases.circle(5, 240)]
    share = shares(fastest(lines, machine), machine)
    assert share.max() < 1.05
    assert np.median(share.max(axis=1)) > 0.97


def test_a_finer_division_of_a_curve_changes_nothing() -> None:
    """Nor do short lines of any length among long ones, nor a line that is cut in pieces."""
    coarse, fine = (seconds(path_cases.circle(5, chords), MACHINE) for chords in (120, 3000))
    assert fine == pytest.approx(coarse, rel=0.01)
    rng = random.Random(3)
    cuts = sorted(rng.uniform(0, 100) for _ in range(50))
    whole = seconds([((100, 0, 0), 100)], MACHINE)
    assert seconds([((x, 0, 0), 100) for x in [*cuts, 100.0]], MACHINE) == pytest.approx(whole)
    turn: list[Line] = [((10, 0, 0), None), ((20, 10, 0), None)]
    clipped: list[Line] = [((9.9995, 0, 0), None), ((10.0004, 0.0002, 0), None), ((20, 10, 0), None)]
    assert seconds(clipped, MACHINE) == pytest.approx(seconds(turn, MACHINE), rel=0.01)


def test_the_rounding_is_within_the_junction_deviation() -> None:
    """Whatever the lines; a reversal has none."""
    for lines in path_cases.wanderings(20, 5):
        path = rounded(lines, MACHINE)
        assert (np.linalg.norm(path.off_along(np.eye(path.points.shape[1])), axis=1) <= 0.01 * 1.0001).all()
        ends = np.concatenate([path.corner - path.before, path.corner + path.behind])
        assert (path.corner[:-1] + path.behind[:-1] <= path.corner[1:] - path.before[1:] + 1e-9).all()
        assert ends.min() >= 0 and ends.max() <= path.end[-1]
    assert rounded([((5, 0, 0), None), ((0, 0, 0), None)], MACHINE).over.max() < 1e-6


def test_shapes_are_steeper() -> None:
    """A cosine ramp from rest takes half of pi times as long."""
    cosine = seconds([((4, 0, 0), None)], replace(MACHINE, profile="cosine"))
    assert cosine == pytest.approx(2 * math.sqrt(4 / 1000 * math.pi / 2))


def pulses(motion: Motion, settings: PathSettings) -> list[tuple[np.ndarray, np.ndarray]]:
    """Clocks and positions of the steps of each axis that moves so along the lines."""
    places, squares = [np.array([0.0])], [motion.square[:1]]
    for k, size in enumerate(np.diff(motion.place)):
        share = (1 - np.cos(np.linspace(0, math.pi, 9 if motion.bent[k] else 200)[1:])) / 2
        low, high, rise = motion.square[k], motion.square[k + 1], 2 * motion.along[k] * size
        straight = np.minimum(np.minimum(low + rise * share, high + rise * (1 - share)), motion.top[k])
        places.append(motion.place[k] + share * size)
        squares.append(low + (high - low) * share if motion.bent[k] else straight)
    place, speed = np.concatenate(places), np.sqrt(np.maximum(np.concatenate(squares), 0))
    took = 2 * np.diff(place) / np.maximum(speed[1:] + speed[:-1], 1e-9)
    begin = np.concatenate([[0.01], 0.01 + np.cumsum(took)])
    times = np.arange(0, begin[-1], 1e-5)
    k = np.clip(np.searchsorted(begin, times, "right") - 1, 0, len(took) - 1)
    since = np.clip(times - begin[k], 0, None)
    along = place[k] + speed[k] * since + (speed[k + 1] - speed[k]) / took[k] * since**2 / 2
    found = []
    ends, corners = np.concatenate([[0], motion.path.end]), motion.path.points[motion.path.kept]
    for axis, one in enumerate(settings.axes):
        exact = np.interp(along, ends, corners[:, axis]) * float(one.steps_per_mm)
        near = np.floor(exact + 0.5).astype(int)
        at = np.flatnonzero(np.diff(near))
        count, sign = np.abs(np.diff(near))[at], np.sign(np.diff(near))[at]
        at, sign = np.repeat(at, count), np.repeat(sign, count)
        number = np.arange(len(at)) - np.repeat(np.cumsum(count) - count, count)
        level = near[at] + sign * (number + 0.5)
        share = (level - exact[at]) / (exact[at + 1] - exact[at])
        clocks = np.round((times[at] + share * 1e-5) * settings.clock_hz).astype(np.int64)
        found.append((clocks, np.round(level + sign / 2).astype(np.int64)))
    return found


@pytest.mark.parametrize("name", ["circle", "star", "text", "trochoid", "wander 4", "wander 6", "wander 7"])
def test_the_fastest_motion_keeps_the_limits_at_the_pins(name: str) -> None:
    """The judge of axes, which knows nothing of it, finds all of the limits used, and nothing beyond."""
    machine = PathSettings((PathAxis(800), PathAxis(800), PathAxis(1600, 12, 100)))
    word, _, number = name.partition(" ")
    wander = list(path_cases.wanderings(8))
    lines = {
        "circle": lambda: path_cases.circle(5, 120),
        "star": lambda: path_cases.star(10, 7),
        "text": lambda: path_cases.text("A"),
        "trochoid": lambda: path_cases.trochoid(1),
        "wander": lambda: wander[int(number)][:50],
    }[word]()
    motion = fastest(lines, machine)
    clocks, positions = zip(*pulses(motion, machine), strict=True)
    marks = Marks.of(lines, machine, clocks, positions)
    found = axis_shares(clocks, positions, machine, marks, ("acceleration",))
    assert 0.9 < max(share.share for share in found) < 1.01
