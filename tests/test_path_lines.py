# SPDX-License-Identifier: MIT
"""Lines that become known one by one, and lines that are merged."""

import math
import random
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from passo import random_cases
from passo.build import Parameters
from passo.path import Path, PathAxis, PathSettings
from passo.path_rounding import Line

from tests.test_path_relations import PROFILES, drawn

FINE = 100_000  # steps/mm
SHORTEST = 1 / 128  # s: longer lines are not merged


def planned(lines: Sequence[Line], settings: PathSettings, early: bool) -> list[tuple[int, int]]:
    """Ticks and velocities of all ramps, taken as soon as there is one, or at the end."""
    path = Path(settings, Parameters(), len(lines) + 4)
    ramps = []

    def take() -> None:
        while path.next_line() is not None:
            pass
        ramps.extend((ramp.ticks, ramp.velocity_end) for ramp in iter(path.next_ramp, None))

    for target, feed in lines:
        path.add(target, feed)
        if early:
            take()
    path.end()
    take()
    return ramps


@pytest.mark.parametrize("profile", PROFILES)
def test_the_ramps_are_the_same_whenever_they_are_asked_for(profile: str) -> None:
    """Nearly always; with a limit of jerk some are divided, which takes no time."""
    times, others = [], 0
    for lines, settings in drawn(profile)[:60]:
        early, late = (planned(lines, settings, early) for early in (True, False))
        times.append(sum(ticks for ticks, _ in early) / sum(ticks for ticks, _ in late))
        others += early != late
    assert max(times) < 1.01 and np.quantile(times, 0.9) < 1.0001
    assert others < 15 or profile == "jerk"


def ends_of(lines: Sequence[Line], settings: PathSettings) -> np.ndarray:
    """The ends of the lines that are made of these, in mm, from the origin on."""
    path = Path(settings, Parameters(), len(lines) + 4)
    for target, feed in lines:
        path.add(target, feed)
    path.end()
    axes = range(len(settings.axes))
    steps = [
        [-int(line.steps[i]) if line.directions >> i & 1 else int(line.steps[i]) for i in axes]
        for line in iter(path.next_line, None)
    ]
    return np.cumsum([[0] * len(axes), *steps], axis=0) / float(settings.axes[0].steps_per_mm)


def left_out(lines: Sequence[Line], settings: PathSettings) -> tuple[int, float]:
    """The number of ends left out, and how far the farthest is from its line, in mm. The others are exact."""
    points = np.array([(0.0,) * len(settings.axes), *(target for target, _ in lines)])
    ends = ends_of(lines, settings)
    at = [int(np.abs(points - end).sum(axis=1).argmin()) for end in ends]
    assert np.abs(points[at] - ends).max() < 1 / FINE and at == sorted(set(at)) and at[-1] == len(lines)
    farthest = 0.0
    for first, last in pairwise(at):
        unit = (points[last] - points[first]) / np.linalg.norm(points[last] - points[first])
        off = points[first : last + 1] - points[first]
        farthest = max(farthest, np.linalg.norm(off - np.outer(off @ unit, unit), axis=1).max())
    return len(points) - len(ends), farthest


def test_what_is_left_out_is_within_the_tolerance() -> None:
    """Random bends of tiny lines: all ends are near the lines that replace them; those that stay, exact."""
    merged = 0
    for seed in range(40):
        rng = random.Random(f"{random_cases.seed()} merged {seed}")
        tolerance = math.exp(rng.uniform(math.log(1e-4), math.log(0.05)))
        settings = PathSettings((PathAxis(FINE, 20, 1000),) * 2, tolerance=tolerance)
        bend, x, y, heading = rng.choice((0.02, 0.1, 0.5)), 0.0, 0.0, rng.uniform(0, 7)
        lines: list[Line] = []
        for _ in range(120):
            size = rng.uniform(0.001, 0.03)
            heading += rng.gauss(0, bend)
            x, y = x + size * math.cos(heading), y + size * math.sin(heading)
            lines.append(((x, y), 10.0))
        count, off = left_out(lines, settings)
        assert off <= tolerance + 2 / FINE
        merged += count
    assert merged > 500


@pytest.mark.parametrize("axes", [1, 2, 3, 8])
def test_noise_does_not_keep_lines_apart(axes: int) -> None:
    """Ends on a straight, off by up to a third of the tolerance each way, as rounded coordinates are."""
    for seed in range(10):
        rng = np.random.default_rng(random_cases.seed() * 10 + seed)
        tolerance = 0.001
        settings = PathSettings((PathAxis(FINE, 20, 1000),) * axes, tolerance=tolerance)
        unit = rng.normal(size=axes)
        straight = np.outer(np.arange(1, 201) * 0.01, unit / np.linalg.norm(unit))
        noise = rng.uniform(-1, 1, straight.shape) * tolerance / 3 / math.sqrt(axes)
        lines: list[Line] = [(tuple(map(float, point)), 100.0) for point in straight + noise]
        count, off = left_out(lines, settings)
        assert off <= tolerance + axes / FINE
        assert count >= 196


@pytest.mark.parametrize("share", [0.97, 1.03])
def test_short_lines_alone_are_merged(share: float) -> None:
    """Straight on; a line that takes long enough to be sent is none of them."""
    size = share * SHORTEST * 10
    lines: list[Line] = [((size * i, 0.0, 0.0, 0.0), 10.0) for i in range(1, 41)]
    made = len(ends_of(lines, PathSettings((PathAxis(FINE, 20, 1000),) * 4))) - 1
    assert made == 40 if share > 1 else made <= 20
