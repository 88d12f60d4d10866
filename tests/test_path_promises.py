# SPDX-License-Identifier: MIT
"""Single sentences of passo_path.h that no other test of the path planner needs."""

import pytest
from passo.build import Parameters
from passo.native import planner
from passo.path import Path, PathAxis, PathSettings
from passo.plan import PlanError

FINE = 10_000  # steps/mm
TOLERANCE = 0.002  # mm
AXES = (PathAxis(FINE, 20, 1000),) * 2
SETTINGS = PathSettings(AXES, tolerance=TOLERANCE)
TICK = 128  # clocks


def ramps_of(path: Path) -> list[tuple[int, int]]:
    """Ticks and velocities."""
    path.end()
    return [(ramp.ticks, ramp.velocity_end) for ramp in iter(path.next_ramp, None)]


@pytest.mark.parametrize("clocks", [0, 1, TICK - 1, TICK, TICK + 1, 100 * TICK + 5])
def test_a_dwell_is_never_too_short(clocks: int) -> None:
    """It takes whole ticks, as many as its clocks need."""
    path = Path(SETTINGS, Parameters())
    path.add((1, 0), 10)
    planner().passo_path_dwell(path.c, clocks)
    path.add((2, 0), 10)
    ramps = ramps_of(path)
    rests = [n for n, (_, velocity) in enumerate(ramps) if velocity == 0]
    assert [ticks for n, (ticks, _) in enumerate(ramps) if n - 1 in rests and n in rests] == (
        [-(-clocks // TICK)] if clocks else []
    )


def test_a_path_begins_with_its_first_line() -> None:
    """Without a dwell, also after it was given another place."""
    path = Path(SETTINGS, Parameters())
    for places in (None, (7, -5)):
        if places:
            path.restart([place * FINE for place in places])
        path.add((1, 2), 10)
        assert min(velocity for _, velocity in ramps_of(path)[:1]) > 0
        while path.next_line() is not None:
            pass


@pytest.mark.parametrize(("off", "lines"), [(0.1, 1), (0.9, 1), (1.5, 2), (3.0, 2)])
def test_a_long_line_is_no_farther_off_than_the_tolerance(off: float, lines: int) -> None:
    """A short one behind it is a part of it only within that."""
    path = Path(SETTINGS, Parameters())
    path.add((10, 0), 10)
    path.add((10.02, off * TOLERANCE), 10)
    path.end()
    assert len(list(iter(path.next_line, None))) == lines


def test_a_line_that_is_refused_leaves_a_dwell_as_it_was() -> None:
    """It is not made twice, although the line would have been a part of the one before."""
    path = Path(SETTINGS, Parameters())
    path.add((1, 0), 10)
    planner().passo_path_dwell(path.c, 100 * TICK)
    path.add((1.01, 0), 10)
    with pytest.raises(PlanError, match="TOO_FAR"):
        path.add((2**30, 0), 10)
    path.add((1.01, 5), 10)
    assert [ticks for ticks, velocity in ramps_of(path) if velocity == 0].count(100) == 1


@pytest.mark.parametrize(("steps", "passes"), [(2**20, True), (2**20 + 1, False)])
def test_the_finest_axis(steps: int, passes: bool) -> None:
    """2^20 steps/mm, at any speed."""
    settings = PathSettings((PathAxis(steps, 0.01, 1),) * 2)
    if passes:
        Path(settings, Parameters())
        return
    with pytest.raises(PlanError, match="TOO_FAST"):
        Path(settings, Parameters())
