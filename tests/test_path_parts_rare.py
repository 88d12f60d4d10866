# SPDX-License-Identifier: MIT
"""The parts of the path planner where random cases seldom come: see test_path_parts.py."""

import pytest

from tests.helpers.core_steps import sum_of_velocities
from tests.helpers.path_parts import Planner, parts
from tests.helpers.plans import LINEAR, Ramp
from tests.test_path_parts import VELOCITY_MAX, ahead, ramp_of

__all__ = ["ahead"]

HALF, UNIT = 1 << 23, 1 << 24  # of the progress of a tick, which is rounded to 24 bits


def excess(ticks: int, progress_step: int) -> int:
    """By how much the progress of all ticks is more than half of them, units of 2^-24."""
    return sum(((2 * k + 1) * progress_step + UNIT) // (2 * UNIT) for k in range(ticks)) - ticks * HALF


@pytest.mark.parametrize(("ticks", "more"), [(4807, 1), (4811, -1), (5005, 1), (8197, -1), (8201, -2)])
@pytest.mark.parametrize("way", [1, -1])
def test_the_rounding_of_the_progress_counts(ticks: int, more: int, way: int) -> None:
    """The mean progress of a long ramp is not exactly a half: of the greatest change it is many substeps."""
    ramp, start = ramp_of(ticks, LINEAR, VELOCITY_MAX if way > 0 else 0), 0 if way > 0 else VELOCITY_MAX
    assert excess(ticks, ramp.progress_step) == more
    path = Planner(7)
    made = Ramp(ticks, LINEAR, False, start, ramp.velocity_end, ramp.progress_step)
    exact = sum_of_velocities(made) << 8 >> 17
    found = parts().passo_path_distance(path.c, start, ramp)
    assert abs(found - exact) <= (ticks + 2 << 7 >> 17) + 1 < VELOCITY_MAX * abs(more) >> 24 - 7 + 17
