# SPDX-License-Identifier: MIT
"""Rests, overrides, recovery: what changes a path while it is planned, against plans of what it becomes."""

import itertools
import random
from collections.abc import Sequence
from dataclasses import replace

import pytest
from passo import random_cases
from passo.build import Parameters
from passo.native import ffi
from passo.path import Path, PathAxis, PathSettings
from passo.path_rounding import Line

from benchmarks.path_plan import plan

MACHINE = PathSettings((PathAxis(), PathAxis(), PathAxis(400, 12, 100)), tolerance=0)
SOFT = replace(MACHINE, axes=tuple(replace(axis, jerk=50_000) for axis in MACHINE.axes), profile="jerk")
MACHINES = {
    "linear": MACHINE,
    "jump": replace(MACHINE, axes=(PathAxis(jump=3), PathAxis(jump=2), PathAxis(400, 12, 100, 1))),
    "sigmoid": replace(MACHINE, profile="sigmoid"),
    "jerk": SOFT,
}
LOOK_AHEAD = 64
TICK = 128 / MACHINE.clock_hz


@pytest.fixture(params=MACHINES)
def settings(request: pytest.FixtureRequest) -> PathSettings:
    """A machine."""
    return MACHINES[request.param]


def stairs(count: int, seed: int) -> list[Line]:
    """Lines of whole steps, along one axis each, forward and backward."""
    rng = random.Random(f"{random_cases.seed()} {seed}")
    places = [0.0, 0.0, 0.0]
    lines: list[Line] = []
    for _ in range(count):
        axis = rng.choice((0, 0, 1, 1, 2))
        places[axis] += rng.choice((1, -1)) * rng.randint(40, 1200) / 80
        lines.append((tuple(places), rng.choice((None, 20.0, 60.0))))
    return lines


def opened(lines: Sequence[Line], settings: PathSettings) -> Path:
    """A path that has these lines."""
    path = Path(settings, Parameters(), LOOK_AHEAD)
    for target, feed in lines:
        path.add(target, feed)
    return path


def seconds_of(path: Path) -> float:
    """Of all ramps to its end."""
    path.end()
    while path.next_line() is not None:
        pass
    ramps = list(iter(path.next_ramp, None))
    assert ramps[-1].last
    return (sum(ramp.ticks for ramp in ramps) << path.parameters.tick_log2) / path.settings.clock_hz


@pytest.mark.parametrize("rest", [0.0, 1e-5, 0.25, 30.0])
def test_a_rest_takes_its_time(settings: PathSettings, rest: float) -> None:
    """The ways to it and from it are those of two paths; but an exact stop has no start-stop speed."""
    before: list[Line] = [((20.0, 0.0, 0.0), 80.0)]
    behind: list[Line] = [((45.0, 0.0, 0.0), 60.0), ((45.0, 10.0, 0.0), None)]
    path = opened(before, settings)
    path.dwell(rest)
    for target, feed in behind:
        path.add(target, feed)
    moved: list[Line] = [((x - 20.0, y, z), feed) for (x, y, z), feed in behind]
    apart = seconds_of(opened(before, settings)) + seconds_of(opened(moved, settings))
    assert seconds_of(path) == pytest.approx(apart + rest, abs=4 * TICK if rest else 0.01)


@pytest.mark.parametrize("first", [False, True])
@pytest.mark.parametrize("factor", [1.0, 1.3, 2.0, 10.0])
def test_an_override_is_a_higher_feed(settings: PathSettings, factor: float, first: bool) -> None:
    """Of lines that are known and of those that follow; rapids stay as they are."""
    for seed in range(6):
        lines = stairs(40, seed)
        path = opened([] if first else lines, settings)
        path.override(factor)
        for target, feed in lines if first else []:
            path.add(target, feed)
        faster = [(target, feed and feed * factor) for target, feed in lines]
        assert seconds_of(path) == pytest.approx(seconds_of(opened(faster, settings)), rel=5e-4, abs=TICK)


@pytest.mark.parametrize("share", [656, 1 << 15, 1 << 16])
def test_an_override_of_rapids_is_their_feed(share: int) -> None:
    """Of those along one axis, to a share of its highest speed."""
    for seed in range(6):
        lines = stairs(40, seed)
        path = opened(lines, MACHINE)
        path._c.passo_path_rapid(path.c, share)
        axes, ends = MACHINE.axes, [(0.0,) * 3, *(target for target, _ in lines)]
        slower: list[Line] = []
        for (a, b), (_, feed) in zip(itertools.pairwise(ends), lines, strict=True):
            axis = next(i for i in range(3) if a[i] != b[i])
            slower.append((b, share / 65536 * float(axes[axis].speed) if feed is None else feed))
        assert seconds_of(path) == pytest.approx(seconds_of(opened(slower, MACHINE)), rel=1e-4)


def test_what_is_left_after_a_stop_is_a_path_of_its_own(settings: PathSettings) -> None:
    """From a step in the first half of any line: as if nothing had been before it."""
    scales = [int(axis.steps_per_mm) for axis in settings.axes]
    for seed in range(20):
        lines = stairs(30, seed)
        rng = random.Random(seed)
        path = opened(lines, settings)
        while path.next_line() is not None:
            path.next_ramp()
        ends = [(0.0,) * 3, *(target for target, _ in lines)]
        stopped = rng.randrange(len(lines))
        steps = [
            (round(a * scale), round(b * scale))
            for a, b, scale in zip(ends[stopped], ends[stopped + 1], scales, strict=True)
        ]
        at = [a + int(rng.random() / 2 * (b - a)) for a, b in steps]
        assert path._c.passo_path_recover(path.c, ffi().new("int32_t[8]", at), stopped)
        begin = [place / scale for place, scale in zip(at, scales, strict=True)]
        rest: list[Line] = [
            (tuple(b - a for a, b in zip(begin, target, strict=True)), feed)
            for target, feed in lines[stopped:]
        ]
        wanted = plan(rest, settings, LOOK_AHEAD)
        path.end()
        made = list(iter(path.next_line, None))
        assert [(list(line.steps), line.directions) for line in made] == [
            (list(line.steps), line.directions) for line in wanted.lines
        ]
        ticks = sum(ramp.ticks for ramp in iter(path.next_ramp, None))
        assert ticks * TICK == pytest.approx(wanted.seconds, rel=1e-3, abs=4 * TICK)
