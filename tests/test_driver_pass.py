# SPDX-License-Identifier: MIT
"""Passes in step with a spindle (stm32_bridge/driver/passo_encoder.h): lines, ramps in and out, refusals."""

from collections.abc import Sequence
from typing import Any

import pytest
from passo.driver import Driver
from passo.native import ffi

from tests.helpers.driver_wire import Q32, Wire, by_speed, error_of, open_driver, struct
from tests.test_driver_encoder import PER_TURN, SPINDLE, Shafts, machine, spin

Lines = Sequence[tuple[int, int]]  # steps of axis 0, half counts
TOP = 300_000  # counts/s


def the_pass(lines: Lines, **fields: Any) -> Any:
    """Of axis 0, and a third of that of axis 1."""
    made = struct("pass", encoder=SPINDLE, lines=len(lines), top_speed=TOP * Q32, **fields)
    for n, (steps, half_counts) in enumerate(lines):
        made.line[n].steps[0], made.line[n].steps[1] = steps, steps // 3
        made.line[n].half_counts = half_counts
    return made


def angles(lines: Lines) -> list[float]:
    """Where each step of axis 0 belongs, counts from the index."""
    found, begin = [], 0.0
    for steps, half_counts in lines:
        found += [begin + half_counts / 2 * (k + 0.5) / abs(steps) for k in range(abs(steps))]
        begin += half_counts / 2
    return found


def made(driver: Driver, shafts: Shafts, lines: Lines, **fields: Any) -> list[int]:
    """The counts at the steps of axis 0, from the index at which the pass begins."""
    shafts.moves = spin(shafts)
    driver.call("move_to_by_speed", 3, by_speed([0, 0, 0, 0]))
    driver.wait(1)
    shafts.steps.clear()
    driver.call("pass", the_pass(lines, wait_index=True, **fields))
    driver.wait(5)
    assert driver.positions()[:2] == shafts.positions[:2]
    assert driver.positions()[:2] == [sum(s for s, _ in lines), sum(s // 3 for s, _ in lines)]
    state = struct("thread_state")
    driver.call("read_thread", state)
    assert not state.lost and driver.fault == "OK"
    index = shafts.steps[0][1] // PER_TURN * PER_TURN
    return [at - index for _, at in shafts.steps]


@pytest.mark.parametrize(
    "lines",
    [
        [(700, 6000)],
        [(-333, 4000)],
        [(300, 2400), (100, 3200)],
        [(120, 2000), (90, 1000), (-60, 900), (200, 2001)],
    ],
)
@pytest.mark.parametrize(("run_in", "run_out"), [(0, 0), (60, 0), (40, 50), (0, 80)])
def test_each_step_is_at_its_angle(lines: Lines, run_in: int, run_out: int) -> None:
    """Within a count once it has caught up, half a count either way; behind where it comes to rest."""
    driver, shafts = machine()
    passes = [made(driver, shafts, lines, run_in=run_in, run_out=run_out) for _ in range(2)]
    wanted, length = angles(lines), sum(half for _, half in lines) / 2
    steady = [
        at - angle
        for at, angle in zip(passes[0], wanted, strict=True)
        if 3 * run_in + 20 < angle < length - run_out - 2
    ]
    assert len(steady) > 100 and max(steady) - min(steady) <= 1.01 and max(map(abs, steady)) <= 1
    late = [at - angle for at, angle in zip(passes[0], wanted, strict=True)]
    assert max(late) <= run_in + run_out / 2 + 2 and min(late) >= -2
    assert max(abs(a - b) for a, b in zip(*passes, strict=True)) <= 1


@pytest.mark.parametrize(("behind", "turns"), [(2, 1), (40, 1), (100, 1), (9000, 9)])
def test_a_pass_that_begins_late_catches_up(behind: int, turns: int) -> None:
    """What should have begun some half counts before the index is in step after four times as many."""
    driver, shafts = machine()
    lines = [(600 * turns, 6000 * turns)]
    late = [
        at - angle + behind / 2
        for at, angle in zip(made(driver, shafts, lines, behind=behind), angles(lines), strict=True)
    ]
    # ten half counts are a step; the path also makes what it is late
    there = late[4 * behind // 10 + max(10, behind // 10 + 1) :]
    assert len(there) > 300 and max(map(abs, there)) <= 1
    assert max(late) <= behind / 2 + 1 and min(late) >= -1


def test_what_a_pass_refuses() -> None:
    """Nothing moves."""
    driver, shafts = machine()
    for name, one in {
        "ARGUMENT": the_pass([]),
        "NO_COUNTS": the_pass([(9, 900), (9, 0)]),
        "STEEP": the_pass([(50_000, 900)]),
        "RAMP_TOO_LONG": the_pass([(9, 900)], run_in=300),
    }.items():
        assert error_of(driver, "pass", one) == name
    many, other, wide = the_pass([(9, 900)] * 4), the_pass([(9, 900)]), the_pass([(9, 900)] * 4)
    many.lines, other.encoder, wide.line[3].steps[4] = 5, 4, -1
    for one in (many, other, wide):
        assert error_of(driver, "pass", one) == "ARGUMENT"
    assert error_of(driver, "pass", ffi().NULL) == "ARGUMENT"
    assert error_of(driver, "pass", the_pass([(9, 900)], run_in=100, run_out=520)) == "RAMP_TOO_LONG"
    fast = the_pass([(880, 900)])
    fast.top_speed = 3_000_000 * Q32
    assert error_of(driver, "pass", fast) == "PINS_TOO_SLOW"
    assert error_of(open_driver(Wire()), "pass", the_pass([(9, 900)])) == "NO_ENCODERS"
    shafts.run(100_000)
    assert shafts.positions == [0, 0, 0, 0]
