# SPDX-License-Identifier: MIT
"""`make bench` measures what it says."""

from fractions import Fraction

import pytest
from passo import bench, link_bench


@pytest.mark.parametrize("sclk_hz", link_bench.SCLK_HZ)
def test_lines_fill_the_link(sclk_hz: int) -> None:
    """A frame of ten lines has four words that carry none, so 15 of 16 words could at most."""
    rate = link_bench.measure(sclk_hz)
    assert 0.92 < rate.share <= 15 / 16
    assert 0.92 * rate.limit < rate.sustained <= rate.burst


def test_the_speed_of_an_engine_is_that_of_its_motion() -> None:
    """It rises with the clocks that are skipped."""
    speeds = [
        bench.Measurement("short", "", (10_000,), Fraction(1, 50), engine).clocks_per_second()
        for engine in (bench._model, bench._advance)
    ]
    assert 0 < speeds[0] < speeds[1]
