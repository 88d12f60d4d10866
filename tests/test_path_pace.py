# SPDX-License-Identifier: MIT
"""The pace of a path, as the documents promise it: what a host with a lowest rate of polls can send."""

import cmath

import pytest
from passo.path import PathAxis, PathSettings
from passo.path_rounding import Line

from benchmarks.path_plan import Planned, plan

POLLS = 3  # that the ramps of a window last
SMALL = (2, 4, 2)  # ramps and lines that a small core holds, and lines of a frame
LARGE = (16, 32, 8)
QUEUED = 8  # entries that a poll refills, of as many ramps in a row
ROUNDED = 0.998  # a poll in whole ticks


def machine(acceleration: float, polls: int) -> PathSettings:
    """Two axes; no line is merged with another one."""
    return PathSettings((PathAxis(80, 400, acceleration),) * 2, tolerance=0, polls=polls)


def chords(count: int, size: float, bend: float, first: float = 30, feed: float = 200) -> list[Line]:
    """Short lines behind a long one, each turned by an angle in radians."""
    place = complex(first)
    lines: list[Line] = [((place.real, 0.0), feed)] if first else []
    for number in range(1, count + 1):
        place += cmath.rect(size, number * bend)
        lines.append(((place.real, place.imag), feed))
    return lines


def shortest(made: Planned, count: int) -> float:
    """Seconds of any `count` ramps in a row, at least."""
    ticks: list[int] = [ramp.ticks for ramp in made.ramps]
    sums = (sum(ticks[first : first + count]) for first in range(len(ticks) - count))
    return float(min(sums) << made.path.parameters.tick_log2) / made.path.settings.clock_hz


@pytest.mark.parametrize(
    ("acceleration", "size", "bend", "polls", "look_ahead"),
    [
        (1000, 0.02, 0.002, 200, 8),
        (1000, 0.005, 0.01, 300, 8),
        (1000, 0.005, 0.01, 300, 16),
        (1000, 0.05, 0.02, 200, 8),
        (1000, 0.05, 0.02, 300, 16),
        (1000, 0.05, 0.005, 300, 16),
        (1000, 0.2, 0.01, 200, 8),
        (2000, 0.02, 0.0, 200, 8),
        (2000, 0.2, 0.01, 300, 8),
        (4000, 0.02, 0.0, 200, 8),
        (4000, 0.05, 0.02, 200, 8),
        (8000, 0.02, 0.0, 300, 8),
        (8000, 0.05, 0.02, 300, 8),
    ],
)
def test_a_small_core_is_sent_no_more_ramps_than_polls_refill(
    acceleration: float, size: float, bend: float, polls: int, look_ahead: int
) -> None:
    """It holds two; any two in a row last three polls, in curves and on straights of short lines, and there
    always is a next one."""
    made = plan(chords(200, size, bend), machine(acceleration, polls), look_ahead, pace=SMALL)
    assert shortest(made, SMALL[0]) >= POLLS * ROUNDED / polls


@pytest.mark.parametrize("size", [0.0155, 0.0175, 0.022])
@pytest.mark.parametrize("polls", [200, 250])
def test_a_path_of_one_short_line_is_no_exception(size: float, polls: int) -> None:
    """Up and down again."""
    made = plan(chords(1, size, 0.0, first=0), machine(1000, polls), 48, pace=SMALL)
    assert shortest(made, SMALL[0]) >= POLLS * ROUNDED / polls


@pytest.mark.parametrize("polls", [300, 500])
def test_eight_ramps_in_a_row_last_three_polls(polls: int) -> None:
    """Of a core with room for 16, on lines whose feeds alternate."""
    lines: list[Line] = [((0.01 * n, 0.0), (20.0, 100.0)[n % 2]) for n in range(1, 401)]
    made = plan(lines, machine(20_000, polls), 48, pace=LARGE)
    assert shortest(made, QUEUED) >= POLLS * ROUNDED / polls


def test_a_line_takes_its_share_of_two_polls() -> None:
    """And no more, but for a tick: a trapezoid at that speed."""
    polls, per_frame, acceleration, count, tick = 8000, 8, 20_000, 1000, 128 / 64e6
    share = 2 / polls / per_frame
    size = 40 * share  # mm; the feed is five times as high
    lines = chords(count, size, 0.0, first=0)
    made = plan(lines, machine(acceleration, polls), 300, pace=LARGE)
    least = count * share + size / share / acceleration
    assert least * 0.99 < made.seconds < least + 1.3 * count * tick
