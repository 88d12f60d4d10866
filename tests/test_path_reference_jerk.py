# SPDX-License-Identifier: MIT
"""The fast motion with limited jerk, against closed forms and the fastest motion without a limit of it."""

from dataclasses import replace

import pytest
from passo.path import PathAxis, PathSettings
from passo.path_rounding import Line

from benchmarks import path_cases
from benchmarks.path_measure import SOFT_AIM
from benchmarks.path_plan import plan
from benchmarks.path_reference import fastest_at
from benchmarks.path_reference_jerk import soft_seconds

AXIS = PathAxis(1600, 200, 1000, jerk=50_000)
MACHINE = PathSettings((AXIS, AXIS, PathAxis(1600, 12, 100, jerk=5000)), profile="jerk")


def line(length: float, feed: float) -> list[Line]:
    """Along the first axis."""
    return [((length, 0.0, 0.0), feed)]


@pytest.mark.parametrize(("length", "feed"), [(50, 100), (20, 100), (20, 60)])
def test_a_line(length: float, feed: float) -> None:
    """Seven phases: the time at the feed, that of the acceleration and of the jerk, as exact as the grid."""
    exact = length / feed + feed / 1000 + 1000 / 50_000
    assert exact * 0.97 < soft_seconds(line(length, feed), MACHINE) < exact * 1.005
    assert soft_seconds(line(length, feed), MACHINE) > fastest_at(line(length, feed), MACHINE, 1.0).seconds


def test_a_short_line() -> None:
    """The jerk alone, four phases: 32 l = j T^3."""
    exact = (32 * 0.2 / 50_000) ** (1 / 3)
    assert exact * 0.85 < soft_seconds(line(0.2, 100), MACHINE) < exact * 1.005


def test_more_jerk_is_faster_and_none_is_as_fast_as_without_a_limit() -> None:
    """On a path with corners and curves."""
    lines = [*path_cases.circle(5, 60), ((0.0, 10.0, 0.0), 100.0), ((10.0, 10.0, 0.0), 100.0)]
    known = [
        soft_seconds(lines, replace(MACHINE, axes=tuple(replace(a, jerk=jerk) for a in MACHINE.axes)))
        for jerk in (5e3, 5e4, 5e6)
    ]
    assert known[0] > known[1] > known[2]
    assert known[2] == pytest.approx(fastest_at(lines, MACHINE, 1.0).seconds, rel=0.03)


def test_a_timid_planner_is_seen() -> None:
    """The planner is within the bound; with a sixteenth of the jerk it is not."""
    lines = path_cases.circle(5, 120)
    fast = soft_seconds(lines, MACHINE)
    timid = replace(MACHINE, axes=tuple(replace(a, jerk=float(a.jerk) / 16) for a in MACHINE.axes))
    assert 0.97 < plan(lines, MACHINE, 200).seconds / fast < SOFT_AIM
    assert plan(lines, timid, 200).seconds / fast > SOFT_AIM
