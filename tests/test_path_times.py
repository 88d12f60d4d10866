# SPDX-License-Identifier: MIT
"""Kept paths against the fastest motion along each, which a solver has found; and their ramps."""

import math
from dataclasses import replace

import numpy as np
import pytest
from passo.path import PathAxis, PathSettings
from passo.path_rounding import Line

from benchmarks.path_measure import FAST_POLLS
from benchmarks.path_paths import Case, Piece
from benchmarks.path_plan import plan
from benchmarks.path_times import BOUNDS, SPARE, read
from tests.helpers.path_limits import limits_of
from tests.test_path_lines import planned as ramps_of
from tests.test_path_ramps import BOUNDS as LIMITS
from tests.test_path_ramps import Host, worst

KEPT = read()


@pytest.mark.parametrize("name", KEPT)
def test_a_kept_path_is_nearly_as_fast_as_possible(name: str) -> None:
    """Within the bound of its profile."""
    assert KEPT[name].ratio < BOUNDS[KEPT[name].case.profile]


@pytest.mark.parametrize("name", KEPT)
def test_the_solver_finds_the_same_time_again(name: str) -> None:
    """As `python -m benchmarks.path_times` does."""
    assert KEPT[name].solved() == pytest.approx(KEPT[name].seconds, rel=2e-3)


LIMITED = {
    "corners and feeds": Case(
        "fast",
        (
            Piece(15, (0.0335, 0.6453, 0.0167), (-10.0,), (3000.0, 600.0), (0.1,)),
            Piece(1, (0.3486,), (-2.0,), slopes=(0.1,)),
            Piece(1, (0.3632,), (-0.5,), (3000.0,), (1.0,)),
        ),
        heading=45.0,
    ),
    "corners that climb": Case(
        "laser",
        (
            Piece(5, (0.2396,), (10.0, -30.0), (600.0,), (0.0, 0.3)),
            Piece(2, (0.7731,), (5.0,)),
            Piece(2, (0.4627, 2.2642), (-30.0,), (3000.0, 0.0), (0.1,)),
        ),
    ),
}


def fed(case: Case, settings: PathSettings) -> Host:
    """All lines known, all ramps taken."""
    host = Host(settings, len(case.lines) + SPARE)
    for target, feed in case.lines:
        host.path.add(target, feed)
    host.path.end()
    while host.take() is not None:
        pass
    return host


@pytest.mark.parametrize("name", LIMITED)
def test_no_ramp_over_lines_of_unequal_slopes_exceeds_a_limit(name: str) -> None:
    """One that has the slope of its first line alone comes down too late for a slower one."""
    case = LIMITED[name]
    settings = replace(case.settings, polls=FAST_POLLS, tolerance=0)
    found = worst(fed(case, settings), limits_of(case.lines, settings), settings)
    assert all(found[name] < bound for name, bound in LIMITS.items()), found


@pytest.mark.parametrize(("bend", "least"), [(2.0, 0.5), (3.0, 0.5), (4.0, 0.5), (5.0, 0.45)])
def test_a_ramp_over_a_lone_corner_leaves_it_what_it_needs(bend: float, least: float) -> None:
    """Profile jerk, long lines: what the ramp takes of an axis there, and half of v^2 c / l."""
    case = Case("fast", (Piece(15, (7.6,), (bend,)),), "jerk")
    settings = replace(case.settings, polls=FAST_POLLS)
    host = fed(case, settings)
    points = np.array([(0.0, 0.0, 0.0), *(target for target, _ in case.lines)])
    size = np.linalg.norm(np.diff(points, axis=0), axis=1)
    units, ends = np.diff(points, axis=0) / size[:, None], np.cumsum(size)
    turn = 2 * math.sin(math.radians(bend) / 2)
    near = math.cos(math.radians(bend) / 2)
    over = 4 * float(settings.junction_deviation) * near * (1 + near) / turn
    found = [0.0]
    for number, end in enumerate(ends[:-1]):
        for ramp in host.ramps:
            if ramp.begin < end < ramp.begin + ramp.length:
                places, speeds, steep = ramp.at()
                speed, along = np.interp(end, places, speeds), abs(np.interp(end, places, steep))
                before, behind = units[number : number + 2]
                share = along * np.maximum(np.abs(before), np.abs(behind))
                share += speed**2 * np.abs(behind - before) / over / 2
                found.append(float(share.max()) / float(settings.axes[0].acceleration))
    assert least < max(found) < 1.01  # the sharper, the more its jerk limits it


def arc(chord: float, bend: float, count: int, machine: str = "router", heading: float = 0.0) -> Case:
    """Chords of a curve, as fast as the axes allow."""
    return Case(machine, (Piece(count, (chord,), (bend,)),), heading=heading)


@pytest.mark.parametrize(
    "case",
    [arc(0.742, 5, 9, heading=218.3), arc(0.3, 3, 30), arc(0.05, 1, 90, "laser", 20), arc(2, 10, 12, "fine")],
)
def test_a_line_is_no_more_than_a_few_ramps(case: Case) -> None:
    """Parts of less than 32 ticks share one: up, level and down in each half of a line are the most."""
    lines = case.lines
    ramps = plan(lines, replace(case.settings, polls=FAST_POLLS), len(lines) + SPARE).ramps
    assert len(ramps) <= 6 * len(lines) + 2
    shorter = sum(ramp.ticks < 8 for ramp in ramps)
    assert shorter <= len(ramps) / 4 + 2


SAME = (
    Case("fine", (Piece(8, (1.0,), (-2.0,), (6000.0,)), Piece(20, (0.5,), (5.0,)))),
    Case(
        "router",
        (
            Piece(3, (1.0,), (2.0,), (6000.0, 600.0)),
            Piece(20, (0.1,), (0.0,), (3000.0,)),
            Piece(20, (0.2,), (-5.0,), (6000.0,)),
        ),
        heading=45.0,
    ),
)


@pytest.mark.parametrize("case", SAME)
def test_a_ramp_is_the_same_whenever_it_is_asked_for(case: Case) -> None:
    """None is made early that a further line would make another one."""
    settings = replace(case.settings, unrounded=True)
    early, late = (ramps_of(case.lines, settings, early) for early in (True, False))
    assert early == late


def turning_back(radius: float, chord: float, degrees: float) -> list[Line]:
    """An arc to one side, and one to the other, of chords."""
    lines: list[Line] = []
    x = y = heading = 0.0
    count = int(math.radians(degrees) * radius / chord)
    for side in (1, -1):
        for number in range(count):
            heading += side * chord / radius * (number > 0)
            x, y = x + chord * math.cos(heading), y + chord * math.sin(heading)
            lines.append(((x, y), 200.0))
    return lines


@pytest.mark.parametrize(("radius", "chord", "deviation"), [(3, 0.05, 0.02), (3, 0.05, 0.05)])
def test_the_speed_where_a_curve_turns_to_the_other_side(
    radius: float, chord: float, deviation: float
) -> None:
    """v^3 = 4 j sqrt(e r^3): `e` is what merging permits, a twentieth of the junction deviation, and half of
    what the chords are off their arc."""
    jerk = 50_000
    axes = (PathAxis(1600, 400, 5000, jerk=jerk),) * 2
    settings = PathSettings(axes, profile="jerk", junction_deviation=deviation, tolerance=0, polls=FAST_POLLS)
    lines = turning_back(radius, chord, 70)
    made = plan(lines, settings, len(lines) + SPARE)
    unit = made.path.settings.clock_hz / made.path.substeps_per_mm / 2**48
    speeds = [ramp.velocity_end * unit for ramp in made.ramps]
    valleys = [b for a, b, c in zip(speeds, speeds[1:], speeds[2:], strict=False) if b <= a and b <= c]
    off = deviation / 20 + chord**2 / radius / 16
    speed = (4 * jerk * math.sqrt(off * radius**3)) ** (1 / 3)
    assert valleys and min(valleys) == pytest.approx(speed, rel=4e-3)
