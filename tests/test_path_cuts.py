# SPDX-License-Identifier: MIT
"""Lines of several feeds that go straight on count as one: corners are as fast as if they were one."""

import math
import random
from dataclasses import replace

import numpy as np
import pytest
from passo.path import PathAxis, PathSettings
from passo.path_rounding import Line

from benchmarks.path_measure import FAST_POLLS
from benchmarks.path_plan import plan

SETTINGS = PathSettings((PathAxis(1600),) * 2, polls=FAST_POLLS)
KNOWN = 100  # lines: all of a path
BARELY = 1 + 1e-6  # so much the feeds differ, so that no line is merged with another one
SHORTEST = 0.03  # s: in less, ticks count


def drawn(seed: int) -> tuple[list[Line], list[Line]]:
    """Straights and corners; and the same with the straights cut in up to five lines."""
    rng = random.Random(f"straights {seed}")
    feed, heading, x, y = rng.choice((50.0, 100.0, 200.0)), rng.uniform(0, 6), 0.0, 0.0
    whole: list[Line] = []
    cut: list[Line] = []
    for _ in range(rng.choice((3, 6, 12))):
        size = math.exp(rng.uniform(math.log(0.02), math.log(5)))
        along = size * math.cos(heading), size * math.sin(heading)
        near = rng.choice((1, 3))
        places = sorted(rng.uniform(0, 1) ** near for _ in range(rng.choice((0, 1, 2, 4))))
        for place in (*places, 1.0):
            target = x + along[0] * place, y + along[1] * place
            cut.append((target, feed * (BARELY if len(cut) % 2 else 1)))
        x, y = x + along[0], y + along[1]
        whole.append(((x, y), feed))
        heading += math.radians(rng.choice((-1, 1)) * rng.choice((1, 3, 10, 30, 60, 90)))
    return whole, cut


def ratio(seed: int) -> float:
    """Of the times, cut to whole; 0: too short."""
    whole, cut = (plan(lines, SETTINGS, KNOWN).seconds for lines in drawn(seed))
    return cut / whole if whole > SHORTEST else 0.0


def test_a_straight_that_is_cut_takes_as_long() -> None:
    """Of random paths half nearly exactly, and few longer: a ramp may end at a cut."""
    found = [found for seed in range(300) if (found := ratio(seed))]
    half, most = np.quantile(found, (0.5, 0.95))
    assert 0.998 < half < 1.001 and most < 1.02


SEEDS = (22, 168, 199, 207, 211, 231, 240, 267, 302, 341, 369, 382, 384, 442, 559, 609, 671, 747, 885)
HARDLY = 1e-9  # mm: a junction deviation, less than the targets' last bits


@pytest.mark.parametrize("seed", SEEDS)
def test_a_straight_that_was_slower_or_faster_once(seed: int) -> None:
    """Paths that a planner which forgets what a straight is made of plans otherwise by a hundredth or more:
    it brakes at a cut, or passes a corner faster than its rounding permits."""
    assert ratio(seed) == pytest.approx(1, abs=0.003)


@pytest.mark.parametrize("seed", [3, 7, 8, 9, 10])
def test_hardly_rounded_a_straight_that_is_cut_takes_as_long(seed: int) -> None:
    """Corners are slow then, and cuts are none of them."""
    settings = replace(SETTINGS, junction_deviation=HARDLY)
    whole, cut = (plan(lines, settings, KNOWN).seconds for lines in drawn(seed))
    assert cut == pytest.approx(whole, rel=1e-3)
    assert whole > plan(drawn(seed)[0], SETTINGS, KNOWN).seconds


@pytest.mark.parametrize("tilt", [1e-4, -1e-4])
def test_unrounded_no_line_is_part_of_a_straight(tilt: float) -> None:
    """A short line behind a corner rounds it no farther, whether the next one goes exactly on or not."""
    settings = replace(SETTINGS, unrounded=True)
    begun: list[Line] = [((10.0, 0.0), 100.0), ((10.0, 0.02), 100.0)]
    exact, tilted = (
        plan([*begun, ((10.0 + off, 10.0), 99.0)], settings, KNOWN).seconds for off in (0.0, tilt)
    )
    assert exact == pytest.approx(tilted, rel=3e-4)
