# SPDX-License-Identifier: MIT
"""Motions from first to last clock: lines, ramps, axes and `running`."""

from collections.abc import Sequence
from itertools import pairwise

from passo import registers as r
from passo.cocotb.clocks import read
from passo.registers import Cause, State

from cocotb_tests.helpers.core_bench import (
    ONE,
    V_MAX,
    Core,
    CoreChannel,
    Line,
    PinTiming,
    Ramp,
    Shape,
    core_test,
)
from cocotb_tests.helpers.core_expected import distance, due, totals
from cocotb_tests.helpers.core_moves import SLOW

FAST = (Ramp(V_MAX, 0), Ramp(V_MAX, 6), Ramp(0, 0, last=True))  # 6 ticks of a substep every second clock


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


def check_clocks(core: Core, begin: int, expected: Sequence[Sequence[int]], factor: int = 1) -> None:
    """Check that each step leaves its pin as many clocks after `running` rose as it is due."""
    for axis, clocks in enumerate(expected):
        actual = [clock - begin for clock in core.steps(axis, begin)]
        assert actual == [factor * clock for clock in clocks], f"axis {axis}"


def make_on_time(core: Core, channel: CoreChannel, lines: Sequence[Line], ramps: Sequence[Ramp]) -> None:
    """Make a motion whose every step leaves its pin on the clock on which it is due."""
    begin = make(core, channel, lines, ramps)
    check_clocks(core, begin, due(lines, ramps, core.tick))


@core_test
def every_step_leaves_its_pin_on_its_clock(core: Core) -> None:
    """Four shapes, up and down, mirrored and not, over lines that end in the middle of ramps."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    ramps = [
        Ramp(ONE // 12, 7, Shape.COSINE),
        Ramp(ONE // 12, 3),
        Ramp(ONE // 30, 6, Shape.EASE, mirror=True),
        Ramp(ONE // 9, 5, Shape.SIGMOID, mirror=True),
        Ramp(ONE // 15, 0),
        Ramp(ONE // 50, 5, Shape.EASE),
        Ramp(0, 6, Shape.SIGMOID, last=True),
    ]
    total = distance(ramps, core.tick)
    shares = [(100, -50, 1), (3, 99, -100), (0, 100, 0), (-100, -7, 0), (50, 0, 33)]
    lengths = [total // 5 - 7, total // 5 - 1, total // 5, total // 5 + 3]
    lengths.append(total - sum(lengths))
    lines = [
        Line(m, tuple(m * share // 100 for share in shares[i]), last=i == 4) for i, m in enumerate(lengths)
    ]
    make_on_time(core, channel, lines, ramps)
    assert checker.positions == totals(lines)


@core_test
def short_lines_follow_each_other_without_a_lost_clock(core: Core) -> None:
    """Lines of 1 to 9 substeps, a substep every second clock: the steps come every second clock."""
    channel = core.channel()
    count = 1 << core.parameters.line_queue_log2
    lengths = [1, 1, 1, 2, *(i * 5 % 9 + 1 for i in range(count - 6)), 1]
    lengths.append(6 * core.tick // 2 - sum(lengths))
    lines = [Line(m, (m,) * core.axes, last=i == count - 1) for i, m in enumerate(lengths)]
    begin = make(core, channel, lines, FAST)
    # substep k is due when 1/4 + n/2 reaches k: on clock 2k
    check_clocks(core, begin, [[2 * k for k in range(1, sum(lengths) + 1)]] * core.axes)


@core_test
def lines_of_one_substep_turn_the_axes(core: Core) -> None:
    """Each line reverses; the profile continues after the last one."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    ramps = [Ramp(ONE // 7, 0), Ramp(ONE // 7, 3), Ramp(0, 0, last=True)]
    total = distance(ramps, core.tick)
    signs = [[1, -1, 1], [-1, -1, 1], [1, 1, -1], [-1, 1, 0]] * 2
    lines = [Line(1, tuple(sign[: core.axes])) for sign in signs]
    lines.append(Line(total - len(lines), (0,) * core.axes, last=True))
    begin = make(core, channel, lines, ramps)
    assert [len(checker.steps(axis)) for axis in range(core.axes)] == [8, 8, 6][: core.axes]
    # 1/4 + n/7 reaches k
    clocks = [-(-(4 * k - 1) * 7 // 4) for k in range(1, 9)]
    assert [clock - begin for clock in core.steps(0, begin)] == clocks


@core_test
def every_axis_steps_every_second_clock(core: Core) -> None:
    """N = M at velocity 1/2 with step_high = step_low = 1: none of thousands of steps is lost or late."""
    channel = core.channel()
    channel.pins(PinTiming())
    checker = core.watch(PinTiming())
    ramps = [Ramp(V_MAX, 0), Ramp(V_MAX, 20), Ramp(0, 0, last=True)]
    count = 10 * core.tick
    begin = make(core, channel, [Line(count, (count, -count, count)[: core.axes], last=True)], ramps)
    check_clocks(core, begin, [[2 * k for k in range(1, count + 1)]] * core.axes)
    assert checker.positions[: core.axes] == [count, -count, count][: core.axes]


@core_test
def reversals_keep_all_pin_timings(core: Core) -> None:
    """Steps that have to wait for DIR are made later, in order, each with its own direction."""
    channel = core.channel()
    timings = [PinTiming(3, 4, 7, 5), PinTiming(1, 9, 2, 11), PinTiming(10, 1, 20, 1)][: core.axes]
    channel.pins(*timings)
    checker = core.watch(*timings)
    ramps = [Ramp(ONE // 14, 4, Shape.COSINE), Ramp(ONE // 14, 12), Ramp(0, 4, Shape.COSINE, last=True)]
    total = distance(ramps, core.tick)
    count = 12
    lines = [
        Line(total // count, (total // count * (-1) ** i, -5 * (-1) ** (i // 2), 3 * (-1) ** i)[: core.axes])
        for i in range(count - 1)
    ]
    lines.append(Line(total - (count - 1) * (total // count), (-2, 1, 0)[: core.axes], last=True))
    make(core, channel, lines, ramps)
    assert checker.positions == totals(lines)
    for axis in range(core.axes):
        ups = sum(max(0, line.steps[axis]) for line in lines)
        assert sum(direction > 0 for _, direction in checker.steps(axis)) == ups
    assert checker.turns(0) == count - 1


@core_test
def both_edges_and_polarities(core: Core) -> None:
    """Every edge is a step, and every pin can be active low."""
    channel = core.channel()
    timings = [
        PinTiming(2, 5, 3, 4, both_edges=True),
        PinTiming(3, 2, 4, 3, step_inverted=True, direction_inverted=True),
        PinTiming(4, 3, 2, 5, both_edges=True, step_inverted=True),
    ]
    ramps = [Ramp(ONE // 11, 3, Shape.COSINE), Ramp(ONE // 11, 7), Ramp(0, 2, last=True)]
    total = distance(ramps, core.tick)
    # of even numbers, so that STEP is inactive in the end
    first, rest = total // 4 * 2, total - total // 4 * 2
    lines = [
        Line(first, (first, -(first // 4 * 2), first - 2)[: core.axes]),
        Line(rest, (-12, 12, -(rest // 2 * 2))[: core.axes], last=True),
    ]
    for _ in range(core.axes):
        timings = [*timings[1:], timings[0]]
        core.finish_watch()
        channel.pins(*timings[: core.axes])
        checker = core.watch(*timings[: core.axes])
        make(core, channel, lines, ramps)
        assert checker.positions == totals(lines)


@core_test
def pins_follow_their_registers(core: Core) -> None:
    """EN is what ENABLE says, and each pin of each axis has its own polarity."""
    channel = core.channel()
    channel.pins(PinTiming())
    for axis in range(core.axes):
        core.link.write(channel.axis_base(axis) + r.AXIS_ENABLE, 0)
    for axis in range(core.axes):
        address = channel.axis_base(axis)
        table = (
            (0, 1, 4),
            (0, 0, 0),
            (8, 0, 4),
            (8, 1, 0),
            (8, 0, 4),
            (2, 0, 1),
            (4, 0, 2),
            (0xE, 0, 7),
            (0, 0, 0),
        )
        for flags, enable, pins in table:
            core.link.write(address, flags)
            core.link.write(address + r.AXIS_ENABLE, enable)
            core.run(4)
            levels = [read(signal) for signal in (core.dut.step, core.dut.dir, core.dut.enable)]
            assert levels == [(pins >> bit & 1) << axis for bit in range(3)]


@core_test
def axes_without_steps_stand(core: Core) -> None:
    """A line without steps takes its time and moves nothing; a single step is in the middle of its line."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    ramps = [Ramp(SLOW, 0), Ramp(SLOW, 8), Ramp(0, 0, last=True)]
    total = distance(ramps, core.tick)
    make(core, channel, [Line(total, (0,) * core.axes, last=True)], ramps)
    assert checker.positions == [0] * core.axes
    one = [Line(total, (1, -1, 0)[: core.axes], last=True)]
    begin = make(core, channel, one, ramps)
    assert checker.positions == totals(one)
    # e reaches M on substep ceil(M / 2)
    middle = -(-total // 2)
    assert [clock - begin for clock in core.steps(0, begin)] == [-(-(4 * middle - 1) * 32 // 4)]


@core_test
def shortest_motions(core: Core) -> None:
    """One line of one substep; profiles of one tick, and of none, whose substeps are drained."""
    channel = core.channel()
    one_tick = [Ramp(ONE // 80, 0), Ramp(0, 1, last=True)]
    make(core, channel, [Line(1, (1, -1, 0)[: core.axes], last=True)], one_tick)
    since = core.clock
    core.link.write(channel.base + r.CHANNEL_DRAIN_VELOCITY, (1 << 32) // 10)
    channel.ramps(Ramp(SLOW, 0, last=True))
    channel.lines(Line(7, (7, -1, 0)[: core.axes], last=True))
    core.run_until(lambda: channel.state().state == State.IDLE, 10_000)
    core.run(200)
    assert channel.state().drained == 7
    assert channel.positions() == [8, -2, 0][: core.axes]
    clocks = core.steps(0, since)
    assert all(b - a in (10, 11) for a, b in pairwise(clocks))


@core_test
def missing_substeps_are_drained_and_counted(core: Core) -> None:
    """The LAST ramp ends before the LAST line: all steps are made while `running` is still high."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    core.link.write(channel.base + r.CHANNEL_DRAIN_VELOCITY, (1 << 32) // 20)
    ramps = [Ramp(ONE // 16, 3), Ramp(0, 3, last=True)]
    total = distance(ramps, core.tick)
    lines = [Line(total + 9, (total + 9, -(total // 2), 3)[: core.axes], last=True)]
    channel.lines(*lines)
    channel.ramps(*ramps)
    channel.start()
    core.wait_end()
    ((begin, end),) = core.motions()
    core.run(100)
    state = channel.state()
    assert (state.state, state.cause, state.drained) == (State.IDLE, Cause.NONE, 9)
    assert checker.positions == channel.positions() == totals(lines)
    steps = [clock - begin for clock in core.steps(0)]
    assert steps[:total] == due(lines, ramps, core.tick)[0]
    assert all(b - a in (19, 20, 21) for a, b in pairwise(steps[-9:]))
    assert steps[-9] > 6 * core.tick
    assert 0 <= end - begin - steps[-1] < 8


@core_test
def ramps_run_on_when_the_last_line_has_ended(core: Core) -> None:
    """The profile takes its time, without steps."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    ramps = [Ramp(SLOW, 4), Ramp(SLOW, 4), Ramp(0, 4, last=True)]
    lines = [Line(20, (20, -10, 1)[: core.axes], last=True)]
    make_on_time(core, channel, lines, ramps)
    assert checker.positions == totals(lines)


@core_test
def ramps_that_do_not_fit_into_a_tick_make_the_rest_later(core: Core) -> None:
    """Ten consecutive ramps without ticks stall the profile: the same steps, delayed by the stall."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    idle = [Ramp(ONE // 9 - n, 0) for n in range(10)]
    ramps = [Ramp(ONE // 8, 3), *idle, Ramp(ONE // 11, 3, Shape.COSINE), Ramp(0, 0, last=True)]
    total = distance(ramps, core.tick)
    lines = [Line(total, (total, -(total // 2), 1)[: core.axes], last=True)]
    channel.lines(*lines)
    channel.ramps(*ramps)
    channel.start()
    core.wait_end()
    ((begin, end),) = core.motions()
    late = end - begin - 6 * core.tick
    assert 0 < late < core.tick
    for axis, expected in enumerate(due(lines, ramps, core.tick)):
        held = [clock if clock < 3 * core.tick else clock + late for clock in expected]
        assert [clock - begin for clock in core.steps(axis)] == held
    assert checker.positions == totals(lines)
    assert channel.state().cause == Cause.NONE
