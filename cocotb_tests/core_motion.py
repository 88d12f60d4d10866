# SPDX-License-Identifier: MIT
"""Motions from first to last clock: lines, ramps, axes and `running`."""

from collections.abc import Sequence
from itertools import pairwise

from passo import registers as r
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
from cocotb_tests.helpers.core_moves import SLOW, check_clocks, make

FAST = (Ramp(V_MAX, 0), Ramp(V_MAX, 6), Ramp(0, 0, last=True))  # 6 ticks of a substep every second clock


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
