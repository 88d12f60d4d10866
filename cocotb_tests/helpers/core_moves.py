# SPDX-License-Identifier: MIT
"""Motions that are made with everything checked but their steps, a standard one, and checks after a stop."""

from collections.abc import Sequence

from passo.registers import Cause, State

from cocotb_tests.helpers.core_bench import ONE, Core, CoreChannel, Line, Ramp, Shape
from cocotb_tests.helpers.core_expected import distance, totals

SLOW = ONE // 32  # velocity


def make(core: Core, channel: CoreChannel, lines: Sequence[Line], ramps: Sequence[Ramp]) -> int:
    """Make a motion at rate 1.0 and check everything except its steps; return the clock of its start."""
    since = core.clock
    before = channel.positions()
    channel.rest()  # everything must be queued before it starts
    channel.lines(*lines)
    channel.ramps(*ramps)
    channel.start()
    core.wait_end()
    ((begin, end),) = core.motions(channel.number, since)
    assert end - begin == sum(ramp.ticks for ramp in ramps) * core.tick
    core.run(200)
    state = channel.state()
    assert (state.state, state.cause, state.drained) == (State.IDLE, Cause.NONE, 0)
    moved = [after - b for after, b in zip(channel.positions(), before, strict=True)]
    assert moved == totals(lines)
    assert channel.room() == (
        1 << core.parameters.line_queue_log2,
        1 << core.parameters.ramp_queue_log2,
    )
    return begin


def check_clocks(core: Core, begin: int, expected: Sequence[Sequence[int]]) -> None:
    """Check that each step leaves its pin as many clocks after `running` rose as it is due."""
    for axis, clocks in enumerate(expected):
        actual = [clock - begin for clock in core.steps(axis, begin)]
        assert actual == list(clocks), f"axis {axis}"


def a_motion(core: Core, ticks: int = 5) -> tuple[list[Line], list[Ramp]]:
    """Acceleration, cruise and deceleration over three lines."""
    ramps = [
        Ramp(ONE // 10, ticks, Shape.COSINE),
        Ramp(ONE // 10, ticks),
        Ramp(0, ticks, Shape.COSINE, last=True),
    ]
    total = distance(ramps, core.tick)
    first, second = total // 3, total // 4
    rest = total - first - second
    return [
        Line(first, (first, -7, first - 1)[: core.axes]),
        Line(second, (-second // 3, -second, 0)[: core.axes]),
        Line(rest, (5, rest // 2, -rest)[: core.axes], last=True),
    ], ramps


def pulse_groups(core: Core, since: int) -> list[tuple[int, ...]]:
    """The rising edges of STEP in order, grouped by clock."""
    clocks: dict[int, list[int]] = {}
    for axis in range(core.axes):
        for clock in core.steps(axis, since):
            clocks.setdefault(clock, []).append(axis)
    return [tuple(clocks[clock]) for clock in sorted(clocks)]


def check_stopped(core: Core, channel: CoreChannel, cause: Cause) -> None:
    """Check for a stop with this cause, exact position and empty queues."""
    core.run(200)
    state = channel.state()
    assert (state.state, state.cause, state.stopping) == (State.STOPPED, cause, False)
    assert core.dut.irq.value == 1
    assert not core.is_running()
    assert core.checker is not None and channel.positions() == core.checker.positions
    assert channel.room() == (
        1 << core.parameters.line_queue_log2,
        1 << core.parameters.ramp_queue_log2,
    )
    pulses = len(pulse_groups(core, 0))
    core.run(300)
    assert len(pulse_groups(core, 0)) == pulses


def clear_and_move(core: Core, channel: CoreChannel) -> None:
    """Check that after CLEAR the channel makes a normal motion."""
    channel.clear()
    channel.rest()
    before = channel.positions()
    lines, ramps = a_motion(core, 2)
    since = core.clock
    channel.lines(*lines)
    channel.ramps(*ramps)
    channel.start()
    core.wait_end()
    core.run(100)
    assert core.dut.irq.value == 0
    ((begin, end),) = core.motions(0, since)
    assert end - begin == 6 * core.tick
    assert [a - b for a, b in zip(channel.positions(), before, strict=True)] == totals(lines)
    assert channel.state().cause == Cause.NONE
