# SPDX-License-Identifier: MIT
"""Tests of the pulse checker: it accepts limit cases and reports violations. Without a simulator."""

from dataclasses import replace

import pytest
from passo.cocotb.pulses import AxisPins, PinTiming, PulseError

TIMING = PinTiming(high=4, low=3, setup=5, hold=6)
BOTH = replace(TIMING, both_edges=True)

# changes of the pins: clock, "s" STEP or "d" DIR
FITTING = [
    (TIMING, [(10, "s"), (14, "s"), (17, "s"), (21, "s")]),
    (TIMING, [(10, "s"), (14, "s"), (23, "d"), (28, "s"), (32, "s")]),
    (TIMING, [(1, "d"), (2, "d"), (7, "s"), (11, "s")]),
    (BOTH, [(10, "s"), (14, "s"), (17, "s"), (27, "d"), (32, "s"), (41, "d")]),
    (PinTiming(0, 0, 0, 0), [(1, "s"), (2, "s"), (3, "s"), (4, "s"), (6, "d"), (7, "s"), (8, "s")]),
]
BREAKING = [
    (TIMING, [(10, "s"), (13, "s")], "STEP step_high"),
    (TIMING, [(10, "s"), (15, "s")], "STEP step_high"),
    (TIMING, [(10, "s")], "STEP step_high"),
    (TIMING, [(10, "s"), (14, "s"), (16, "s")], "STEP step_low"),
    (TIMING, [(6, "d"), (10, "s")], "DIR dir_setup"),
    (TIMING, [(10, "d"), (10, "s")], "DIR dir_setup"),
    (TIMING, [(10, "s"), (10, "d")], "DIR dir_hold"),
    (TIMING, [(10, "s"), (12, "d")], "DIR dir_hold"),
    (TIMING, [(10, "s"), (14, "s"), (22, "d")], "DIR dir_hold"),
    (BOTH, [(10, "s"), (13, "s")], "STEP step_high"),
    (BOTH, [(10, "s"), (14, "s"), (16, "s")], "STEP step_low"),
    (BOTH, [(10, "s"), (19, "d")], "DIR dir_hold"),
    (BOTH, [(10, "s"), (14, "s"), (22, "d")], "DIR dir_hold"),
    (BOTH, [(10, "s"), (14, "s"), (23, "d"), (27, "s")], "DIR dir_setup"),
]


def tell(pins: AxisPins, changes: list[tuple[int, str]]) -> None:
    for clock, pin in changes:
        (pins.step_changed if pin == "s" else pins.dir_changed)(clock)
    pins.finish(1000)


@pytest.mark.parametrize(("timing", "changes"), FITTING)
def test_what_just_fits_is_accepted(timing: PinTiming, changes: list[tuple[int, str]]) -> None:
    pins = AxisPins(0, timing)
    tell(pins, changes)
    steps = [clock for clock, pin in changes if pin == "s"]
    assert [clock for clock, _ in pins.steps] == (steps if timing.both_edges else steps[::2])
    for clock, direction in pins.steps:
        turns = sum(pin == "d" and at < clock for at, pin in changes)
        assert direction == (-1) ** turns


@pytest.mark.parametrize(("timing", "changes", "signal"), BREAKING)
def test_what_does_not_fit_is_named(timing: PinTiming, changes: list[tuple[int, str]], signal: str) -> None:
    pins = AxisPins(3, timing)
    with pytest.raises(PulseError) as caught:
        tell(pins, changes)
    assert (caught.value.axis, caught.value.signal) == (3, signal)
    assert caught.value.clock in (changes[-1][0], 1000)


@pytest.mark.parametrize("inverted", [False, True])
def test_polarity_is_that_of_the_pins(inverted: bool) -> None:
    pins = AxisPins(0, TIMING)
    pins.stand(replace(TIMING, step_inverted=inverted, direction_inverted=inverted), inverted, not inverted)
    assert (pins.active, pins.direction) == (False, -1)
