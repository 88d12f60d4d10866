# SPDX-License-Identifier: MIT
"""The path planner judged by relations between plans of random paths, and against the fastest motion.

What changes nothing for the machine (a mirror, other units, a longer look-ahead) must change no tick. What
makes it stronger must not make it slower.
"""

import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from passo import random_cases
from passo.path import PathAxis, PathSettings
from passo.path_rounding import Line
from passo.random_cases import log_uniform

from benchmarks.path_paths import JERKS, MACHINES, Case, Piece
from benchmarks.path_plan import plan
from benchmarks.path_reference import seconds
from benchmarks.path_reference_jerk import soft_seconds

PATHS = 150
SOFT = 40  # paths with a limit of jerk: their fastest motion takes long to find
SIMPLE = ", unrounded"
PROFILES = ("linear", f"linear{SIMPLE}", "cosine", "sigmoid", "jerk")
STRONGER = 1.01
TICK = 2e-6  # s
SHORTEST = 0.03  # s: in less, ticks count


def some_feeds(rng: random.Random) -> tuple[float, ...]:
    return tuple(rng.choice((0.0, log_uniform(rng, 100, 20_000))) for _ in range(2))


def some_piece(rng: random.Random) -> Piece:
    """Lines and corners of all kinds; an arc of chords; lines nearly straight on, whose feeds alternate."""
    kind = rng.choice(("corners", "arc", "fan"))
    if kind == "arc":
        bend = log_uniform(rng, 0.5, 20)
        count = min(60, int(rng.choice((45, 90, 180)) / bend) + 1)
        return Piece(count, (log_uniform(rng, 0.02, 1),), (rng.choice((1, -1)) * bend,), some_feeds(rng)[:1])
    if kind == "fan":
        bends = (rng.choice((0.0, 0.5, 3.0, 5.0)),)
        return Piece(rng.randint(2, 20), (log_uniform(rng, 0.2, 10),), bends, some_feeds(rng))
    sizes = tuple(log_uniform(rng, 0.1, 30) for _ in range(rng.randint(1, 3)))
    bends = tuple(rng.choice((1, -1)) * log_uniform(rng, 0.1, 170) for _ in range(rng.randint(1, 3)))
    slopes = rng.choice(((0.0,), (0.1,), (1.0, -1.0)))
    return Piece(rng.randint(1, 6), sizes, bends, some_feeds(rng), slopes)


@cache
def drawn(profile: str) -> list[tuple[list[Line], PathSettings]]:
    """Paths and machines."""
    found = []
    rng = random.Random(f"{random_cases.seed()} {profile}")
    for _ in range(PATHS):
        machine = rng.choice(JERKS if profile == "jerk" else sorted(MACHINES))
        pieces = tuple(some_piece(rng) for _ in range(rng.randint(1, 3)))
        case = Case(machine, pieces, profile.removesuffix(SIMPLE), heading=rng.uniform(0, 360))
        found.append((case.lines, replace(case.settings, unrounded=profile.endswith(SIMPLE))))
    return found


@cache
def fastest(profile: str) -> list[float]:
    """Seconds of the fastest motion along the first of these paths."""
    if profile == "jerk":
        return [soft_seconds(*path) for path in drawn(profile)[:SOFT]]
    return [seconds(*path) for path in drawn(profile)]


def ahead() -> None:
    """What takes long and does not depend on the planner."""
    for profile in PROFILES:
        fastest(profile)


@cache
def paths(profile: str) -> list[tuple[list[Line], PathSettings, float]]:
    """Paths and machines, and the time that is planned."""
    return [(lines, settings, planned(lines, settings)) for lines, settings in drawn(profile)]


def planned(lines: Sequence[Line], settings: PathSettings, more: int = 4) -> float:
    """Seconds, with all lines at hand."""
    return plan(lines, settings, max(len(lines) + more, 48)).seconds


def of_axes(settings: PathSettings, change: Callable[[PathAxis], PathAxis]) -> PathSettings:
    return replace(settings, axes=tuple(change(axis) for axis in settings.axes))


@pytest.mark.parametrize("profile", PROFILES)
def test_what_changes_nothing_changes_no_tick(profile: str) -> None:
    """All axes the other way, two of them swapped, finer steps, a longer look-ahead, twice the clock."""
    for lines, settings, before in paths(profile):
        mirrored: list[Line] = [(tuple(-place for place in target), feed) for target, feed in lines]
        assert planned(mirrored, settings) == before
        if settings.axes[0] == settings.axes[1]:
            swapped: list[Line] = [((y, x, *others), feed) for (x, y, *others), feed in lines]
            assert planned(swapped, settings) == before
        finer = of_axes(settings, lambda axis: replace(axis, steps_per_mm=4 * float(axis.steps_per_mm)))
        assert planned(lines, finer) == pytest.approx(before, rel=1e-6, abs=TICK)
        assert planned(lines, settings, more=3 * len(lines)) == before


@pytest.mark.parametrize("profile", PROFILES)
def test_a_machine_twice_as_fast_takes_half_the_time(profile: str) -> None:
    """Twice the speeds, four times the acceleration, eight times the jerk, at twice the clock and polls."""

    def faster(axis: PathAxis) -> PathAxis:
        return replace(
            axis,
            speed=2 * float(axis.speed),
            acceleration=4 * float(axis.acceleration),
            jerk=8 * float(axis.jerk),
        )

    found = []
    for lines, settings, before in paths(profile):
        twice = replace(of_axes(settings, faster), clock_hz=2 * settings.clock_hz, polls=2 * settings.polls)
        hurried = [(target, feed and 2 * feed) for target, feed in lines]
        found.append(abs(2 * planned(hurried, twice) / before - 1))
    # in a few a rounding decides which lines share a ramp
    assert np.quantile(found, 0.95) < 4e-5 and max(found) < 0.03


@pytest.mark.parametrize("profile", PROFILES)
def test_stronger_axes_make_no_path_slower(profile: str) -> None:
    """Nor faster than by the root of what they have more; in a few a ramp then ends with another line."""
    found = []
    for lines, settings, before in paths(profile):
        stronger = of_axes(
            settings, lambda axis: replace(axis, acceleration=STRONGER * float(axis.acceleration))
        )
        found.append(planned(lines, stronger) / before)
    fast, half, slow = np.quantile(found, (0.05, 0.5, 0.95))
    assert 0.9949 < fast < 0.9956 and fast < half and slow < 1.0003


def reversed_path(lines: Sequence[Line]) -> list[Line]:
    """From the end to the begin, which is the origin then."""
    points = [(0.0,) * 3, *(target for target, _ in lines)]
    moved = [tuple(a - b for a, b in zip(point, points[-1], strict=True)) for point in reversed(points)]
    return list(zip(moved[1:], [feed for _, feed in reversed(lines)], strict=True))


@pytest.mark.parametrize("profile", PROFILES)
def test_the_way_back_takes_as_long(profile: str) -> None:
    """Half of the paths to a thousandth; ramps that are shaped, or end where a line ends, differ in some."""
    found = [
        abs(planned(reversed_path(lines), settings) / time - 1) for lines, settings, time in paths(profile)
    ]
    half, most = np.quantile(found, (0.5, 0.9))
    assert half < 7e-4 and most < (5e-2 if profile == "jerk" else 6e-3)


@pytest.mark.parametrize("profile", PROFILES)
def test_few_polls_cost_little(profile: str) -> None:
    """A poll in four milliseconds, of ramps of some: most of these paths have no shorter ones."""
    found = [planned(lines, replace(settings, polls=250)) / time for lines, settings, time in paths(profile)]
    fast, half, most = np.quantile(found, (0.05, 0.5, 0.9))
    assert fast > 0.98 and half == pytest.approx(1, rel=1e-4) and most < 1.02


# What a tenth of the paths, a quarter, half, three quarters and nine tenths take at most, of the fastest
# motion; and the tenth at least: on either side of a lone corner the reference knows one acceleration, and
# unrounded a corner is faster than it has it.
SHARES = (0.1, 0.25, 0.5, 0.75, 0.9)
TAKES = {
    "linear": (0.98, (1, 1, 1.0006, 1.002, 1.006)),
    f"linear{SIMPLE}": (0.95, (1, 1, 1.0012, 1.0025, 1.012)),
    "cosine": (0.999, (1.006, 1.02, 1.08, 1.25, 1.55)),
    "sigmoid": (0.999, (1.008, 1.025, 1.1, 1.25, 1.55)),
    "jerk": (0.999, (1.012, 1.035, 1.1, 1.45, 1.65)),
}


@pytest.mark.parametrize("profile", PROFILES)
def test_it_is_nearly_the_fastest_motion(profile: str) -> None:
    """Of linear ramps it is; of the others the reference is a bound."""
    both = zip(drawn(profile), fastest(profile), strict=False)
    found = [planned(*path) / least for path, least in both if least > SHORTEST]
    least, most = TAKES[profile]
    shares = np.quantile(found, SHARES)
    assert shares[0] > least and (shares < most).all(), shares
