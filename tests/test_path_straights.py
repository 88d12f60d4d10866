# SPDX-License-Identifier: MIT
"""Straights of several lines: what is near one is no corner, and what is not near it stays one."""

import math
from collections.abc import Sequence
from dataclasses import replace

import pytest
from passo.path import PathAxis, PathSettings
from passo.path_rounding import Line, rounded

from benchmarks.path_cases import circle
from benchmarks.path_measure import FAST_POLLS, Measured, play
from benchmarks.path_paths import Case, Piece
from benchmarks.path_plan import plan
from benchmarks.path_reference import fastest

DEVIATION = 0.01  # mm
MACHINE = PathSettings((PathAxis(1600), PathAxis(1600)), junction_deviation=DEVIATION, polls=FAST_POLLS)
MM, INCH = 0.001, 0.00254  # what files have
LITTLE = 1e-5  # mm
CORNERS = {
    "three lines": Case("router", (Piece(30, (1.0, 0.3), (10.0, 0.0, 0.0), (6000.0, 30_000.0)),)),
    "slivers": Case("router", (Piece(30, (5.0, 0.01, 1.0), (3.4, 0.0, 0.0, 0.0), (0.0, 30_000.0)),)),
    "slivers of one feed": Case("router", (Piece(30, (0.01, 5.0), (3.4, 0.0, 0.0, 0.0)),)),
    "to both sides": Case("laser", (Piece(40, (0.3, 0.1), (30.0, 0.0, -30.0, 0.0), (0.0, 6000.0)),)),
    "a zigzag that is none": Case("router", (Piece(100, (0.05,), (1.0, -1.0), (0.0, 30_000.0)),)),
}


def seconds(lines: Sequence[Line], settings: PathSettings) -> float:
    """Of the plan."""
    return plan(lines, replace(settings, polls=FAST_POLLS), len(lines) + 4).seconds


@pytest.mark.parametrize("name", CORNERS)
@pytest.mark.parametrize("heading", [17.0, 33.0])
def test_coordinates_of_a_file_make_no_corner(name: str, heading: float) -> None:
    """They take as long as exact ones; in inches, which change the shape, as long as they have to."""
    exact = replace(CORNERS[name], heading=heading)
    file = replace(exact, grid=MM)
    assert seconds(file.lines, file.settings) < 1.02 * seconds(exact.lines, exact.settings)
    if name != "slivers of one feed":
        inches = replace(exact, grid=INCH)
        optimum = fastest(inches.lines, inches.settings).seconds
        assert seconds(inches.lines, inches.settings) < 1.03 * optimum


@pytest.mark.parametrize("name", CORNERS)
def test_the_axes_keep_their_limits_on_them(name: str) -> None:
    """At the pins, but for what the points are off the straight; steps of less than a micrometer show it."""
    case = replace(CORNERS[name], machine="fine", heading=33.0, grid=INCH)
    measured = Measured()
    play(case, measured)
    assert measured.faults == {} and measured.share("acceleration") > 0.8


def bent(off: float, feed: float) -> list[Line]:
    """Right angles, and between them two lines that meet so far off the straight past them."""
    lines: list[Line] = []
    x = 0.0
    for sign in (1, -1) * 5:
        for y in (0.0, sign * 0.4):
            lines += [((x + 0.38, y + off), 100.0), ((x + 0.4, y), feed), ((x + 0.4, sign * 0.4 - y), 100.0)]
            x += 0.4
    return lines


@pytest.mark.parametrize(("feed", "share"), [(100.0, 1 / 8), (90.0, 1 / 2)])
def test_how_far_off_a_straight_is_one(feed: float, share: float) -> None:
    """An eighth of the junction deviation, half of it where the feed changes; the judge agrees."""
    within, beyond = (bent(share * DEVIATION + off, feed) for off in (-LITTLE, LITTLE))
    assert seconds(beyond, MACHINE) > 1.01 * seconds(within, MACHINE)
    assert len(rounded(within, MACHINE).corner) < len(rounded(beyond, MACHINE).corner)
    assert seconds(within, MACHINE) == pytest.approx(seconds(bent(0.0, feed), MACHINE), rel=0.01)


def test_a_tolerance_does_not_drift() -> None:
    """Lines of changing feeds that bend by less each, but add up, are a curve as any other."""
    lines: list[Line] = [
        (target[:2], 1000.0 + 100 * (n % 2)) for n, (target, _) in enumerate(circle(2, 1000))
    ]
    fast = PathSettings((PathAxis(1600, 500), PathAxis(1600, 500)))
    took = seconds(lines, fast)
    assert took > 0.98 * 2 * math.pi * 2 / math.sqrt(1000 * 2)
    assert took < 1.02 * fastest(lines, fast).seconds


def test_a_line_back_is_a_corner() -> None:
    """However short it is."""
    ahead: list[Line] = [((1.0, 0.0), 100.0), ((1.001, 0.0), 90.0), ((2.0, 0.0), 100.0)]
    back: list[Line] = [((1.0, 0.0), 100.0), ((0.999, 0.0), 90.0), ((2.0, 0.0), 100.0)]
    assert seconds(back, MACHINE) > 1.2 * seconds(ahead, MACHINE)
    assert len(rounded(back, MACHINE).corner) == 2 and len(rounded(ahead, MACHINE).corner) == 0
