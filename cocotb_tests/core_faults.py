# SPDX-License-Identifier: MIT
"""Faults: the channel stops, shows the cause, has the exact position, and works after CLEAR."""

import pytest
from passo import registers as r
from passo.cocotb.clocks import read
from passo.host import RATE_ONE
from passo.link import RefusedError
from passo.registers import Cause, State, Verdict

from cocotb_tests.helpers.bench import patience, rng
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
from cocotb_tests.helpers.core_moves import SLOW, check_stopped, clear_and_move


def lost_steps(channel: CoreChannel, axis: int) -> int:
    """Read the number of lost steps of an axis."""
    address = channel.base + r.CHANNEL_AXIS_BASE + axis * r.CHANNEL_AXIS_STRIDE + r.AXIS_LOST_STEPS
    return channel.link.read(address, 1)[0]


@core_test
def line_underrun(core: Core) -> None:
    """A line ends, is not LAST and has no successor: all its steps were made, and none after."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    line = Line(50, (50, -25, 1)[: core.axes])
    ramps = [Ramp(SLOW, 0), Ramp(SLOW, 100), Ramp(0, 0, last=True)]
    channel.lines(line)
    channel.ramps(*ramps)
    channel.start()
    core.run_until(lambda: core.dut.irq.value == 1, 5000)
    check_stopped(core, channel, Cause.LINE_UNDERRUN)
    assert checker.positions == list(line.steps)
    begin = core.motions()[0][0]
    assert [clock - begin for clock in core.steps(0)] == due([line], ramps, core.tick)[0]
    clear_and_move(core, channel)


@core_test
def a_line_that_comes_just_in_time(core: Core) -> None:
    """A line queued shortly before its predecessor ends follows without a lost clock."""
    channel = core.channel()
    core.watch(PinTiming())
    # from chip select to the line in the queue: header, line and crc, and what the link needs to replay them
    frame = (core.axes + 4) * 128 + 98
    for early, cause in ((40, Cause.NONE), (-40, Cause.LINE_UNDERRUN)):
        ramps = [Ramp(SLOW, 0), Ramp(SLOW, 20), Ramp(0, 0, last=True)]
        lines = [
            Line(60, (60, -30, 1)[: core.axes]),
            Line(20, (-20, -10, 1)[: core.axes], last=True),
        ]
        expected = due(lines, ramps, core.tick)[0]
        channel.rest()
        channel.lines(lines[0])
        channel.ramps(*ramps)
        channel.start()
        core.run_until(core.is_running, 1000)
        begin = core.began()
        core.run(begin + expected[59] - early - frame - core.clock)
        channel.lines(lines[1])
        core.run_until(lambda: not core.is_running(), 10_000)
        core.run(50)
        state = channel.state()
        assert (state.state, state.cause) == (State.STOPPED if cause else State.IDLE, cause)
        steps = [clock - begin for clock in core.steps(0, begin)]
        assert steps == (expected[:60] if cause else expected)
    channel.clear()


@core_test
def ramp_underrun(core: Core) -> None:
    """Ramps that run out at speed cause a soft stop with STOP_SLEW; the position is exact."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    channel.link.write(channel.base + r.CHANNEL_STOP_SLEW, RATE_ONE // 8)
    channel.lines(Line(100_000, (100_000, -50_000, 7)[: core.axes], last=True))
    channel.ramps(Ramp(SLOW, 3, Shape.COSINE), Ramp(SLOW, 3))
    channel.start()
    core.run_until(core.is_running, 2000)
    begin = core.clock
    core.run_until(lambda: not core.is_running(), 5000)
    length = core.clock - begin
    assert 11 * core.tick < length < 14 * core.tick
    check_stopped(core, channel, Cause.RAMP_UNDERRUN)
    # it went on at speed while it slowed down
    steps = core.steps(0)
    assert steps[-1] - begin > 10 * core.tick
    assert checker.positions[0] == len(steps)
    clear_and_move(core, channel)


@core_test
def an_endless_line_has_no_ramp_underrun(core: Core) -> None:
    """A jog keeps its speed when the ramps run out."""
    channel = core.channel()
    core.watch(PinTiming())
    channel.lines(Line(7, (7, -7, 1)[: core.axes], endless=True))
    channel.ramps(Ramp(SLOW, 2))
    channel.start()
    core.run_until(core.is_running, 2000)
    core.run(20 * core.tick)
    assert channel.state().state == State.RUN
    assert len(core.steps(0)) > 60
    channel.stop()
    core.run_until(lambda: not core.is_running(), 20_000)
    check_stopped(core, channel, Cause.STOP)
    clear_and_move(core, channel)


@core_test
def step_overrun(core: Core) -> None:
    """Pins that cannot follow: the axis reports and counts overruns; the position counts the pulses made."""
    channel = core.channel()
    slow_axis = core.axes - 1
    timings = [PinTiming()] * slow_axis + [PinTiming(30, 20, 4, 4)]
    channel.pins(*timings)
    checker = core.watch(*timings)
    channel.lines(Line(3000, (3000,) * core.axes, last=True))
    channel.ramps(Ramp(ONE // 20, 6), Ramp(ONE // 20, 100), Ramp(0, 0, last=True))
    channel.start()
    core.run_until(lambda: core.dut.irq.value == 1, 10_000)
    core.run(6 * 50)
    check_stopped(core, channel, Cause.STEP_OVERRUN)
    assert channel.state().overrun == 1 << slow_axis
    lost = [lost_steps(channel, axis) for axis in range(core.axes)]
    assert lost[:slow_axis] == [0] * slow_axis and lost[slow_axis] == 1
    # every step is accounted for: made or lost
    assert checker.positions[slow_axis] + lost[slow_axis] == checker.positions[0]
    channel.times(PinTiming())
    core.watch(PinTiming())
    clear_and_move(core, channel)
    assert channel.state().overrun == 0


@core_test
def every_axis_can_overrun_simultaneously(core: Core) -> None:
    """At velocity 1/2 with slow pins several steps are lost before the motion stops; all are counted."""
    channel = core.channel()
    timing = PinTiming(3, 2, 1, 1)
    channel.pins(timing)
    checker = core.watch(timing)
    channel.lines(Line(3000, (3000, -3000, 3000)[: core.axes], last=True))
    channel.ramps(Ramp(V_MAX, 0), Ramp(V_MAX, 100), Ramp(0, 0, last=True))
    channel.start()
    core.run_until(lambda: core.dut.irq.value == 1, 10_000)
    check_stopped(core, channel, Cause.STEP_OVERRUN)
    assert channel.state().overrun == (1 << core.axes) - 1
    assert {abs(position) for position in checker.positions} == {abs(checker.positions[0])}
    # a step every second clock, and the line is stopped a few clocks after the first one that is lost
    assert [lost_steps(channel, axis) for axis in range(core.axes)] == [2] * core.axes
    channel.clear()
    assert [lost_steps(channel, axis) for axis in range(core.axes)] == [0] * core.axes


@core_test
def the_first_reason_of_a_soft_stop_counts(core: Core) -> None:
    """STOP, and ramps that run out during the soft stop: the cause is whichever came first."""
    channel = core.channel()
    core.watch(PinTiming())
    line = Line(100_000, (100_000, -50_000, 7)[: core.axes], last=True)
    ramps = [Ramp(SLOW, 0), Ramp(SLOW, 12)]
    channel.link.write(channel.base + r.CHANNEL_STOP_SLEW, RATE_ONE // 30)
    for stop_at, cause in ((3, Cause.STOP), (13, Cause.RAMP_UNDERRUN)):
        channel.rest()
        channel.lines(line)
        channel.ramps(*ramps)
        channel.start()
        core.run_until(core.is_running, 1000)
        core.run(stop_at * core.tick)
        channel.stop()
        core.run_until(lambda: not core.is_running(), 50 * core.tick)
        check_stopped(core, channel, cause)
        channel.clear()


@core_test
def a_stopped_channel_is_busy(core: Core) -> None:
    """Until CLEAR it accepts neither lines nor ramps; RUN stays set and starts nothing by itself."""
    channel = core.channel()
    core.watch(PinTiming())
    channel.start()
    channel.abort()
    for push in (
        lambda: channel.lines(Line(1, (1,) * core.axes, last=True)),
        lambda: channel.ramps(Ramp(0, 1, last=True)),
    ):
        with pytest.raises(RefusedError) as refused:
            push()
        assert refused.value.verdict == Verdict.BUSY
    channel.clear()
    core.run(1000)
    assert channel.state().state == State.IDLE
    assert not core.motions()
    clear_and_move(core, channel)


@core_test
def commands_in_one_write(core: Core) -> None:
    """CLEAR and ZERO together; ABORT overrides STOP."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    command = channel.base + r.CHANNEL_COMMAND
    channel.lines(Line(100, (100, -30, 5)[: core.axes], endless=True))
    channel.ramps(Ramp(SLOW, 2))
    channel.start()
    core.run(2000)
    channel.link.write(command, 1 << r.CHANNEL_COMMAND_STOP_LSB | 1 << r.CHANNEL_COMMAND_ABORT_LSB)
    check_stopped(core, channel, Cause.ABORT)
    assert checker.positions[0] > 10
    channel.link.write(command, 1 << r.CHANNEL_COMMAND_CLEAR_LSB | 1 << r.CHANNEL_COMMAND_ZERO_LSB)
    assert channel.state().state == State.IDLE
    assert channel.positions() == [0] * core.axes
    clear_and_move(core, channel)


def slow_motion(core: Core, sign: int) -> tuple[Line, list[Ramp]]:
    """One line, whose first axis makes a step every 128 clocks, the others fewer."""
    ramps = [Ramp(SLOW, 0), Ramp(SLOW, 8), Ramp(0, 0, last=True)]
    total = distance(ramps, core.tick)
    steps = total // 4
    return Line(total, (sign * steps, -sign * (steps // 2), 1)[: core.axes], last=True), ramps


@core_test
def a_reset_at_any_time(core: Core) -> None:
    """It causes no step: a pulse in progress is completed. Pin settings are kept, all else is reset."""
    random = rng("a_reset_at_any_time")
    channel = core.channel()
    timing = PinTiming(9, 5, 30, 7, step_inverted=True)
    channel.pins(timing)
    for _ in range(patience(12, 3)):
        channel.lines(
            Line(100, (100, -30, 5)[: core.axes]), Line(100, (-100, 30, 5)[: core.axes], endless=True)
        )
        channel.ramps(Ramp(ONE // 40, random.randint(0, 3), Shape.COSINE), Ramp(ONE // 60, 1000))
        channel.start()
        core.run_until(core.is_running, 2000)
        core.run(random.randrange(6000))
        before = core.clock
        pulse = not read(core.dut.step) & 1
        core.reset(random.choice((1, 2, 30)))
        core.run(300)
        assert len(core.changes("step", 0, before)) == pulse
        assert not core.is_running() and not read(core.dut.enable) and not read(core.dut.irq)
        assert channel.state().state == State.IDLE and channel.state().quiet
        assert channel.positions() == [0] * core.axes
        assert channel.room() == (1 << core.parameters.line_queue_log2, 1 << core.parameters.ramp_queue_log2)
        checker = core.watch(timing)
        line, ramps = slow_motion(core, random.choice((1, -1)))
        channel.lines(line)
        channel.ramps(*ramps)
        channel.start()
        core.wait_end()
        core.run(400)
        assert checker.positions[: core.axes] == channel.positions() == list(line.steps)
        channel.rest()
        core.finish_watch()


@core_test
def what_needs_rest_meets_it(core: Core) -> None:
    """ZERO at any clock around the ends of motions behind one another: refused, or done between them."""
    channel = core.channel()
    timing = PinTiming(2, 2, 200, 2)
    channel.pins(timing)
    there, ramps = slow_motion(core, 1)
    back, _ = slow_motion(core, -1)
    zero = channel.base + r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_ZERO_LSB
    verdicts = set()
    for delay in range(0, 1700, patience(53, 430)):
        core.link.write(*zero)
        checker = core.watch(timing)
        channel.rest()
        channel.lines(there, back, there)
        channel.ramps(*ramps, *ramps, *ramps)
        channel.start()
        core.run_until(core.is_running, 2000)
        core.run(delay)
        try:
            core.link.write(*zero)
            verdicts.add(Verdict.OK)
        except RefusedError as refused:
            verdicts.add(refused.verdict)
        core.run_until(lambda: channel.state().quiet and len(core.motions(0, core.started)) == 3, 20_000)
        rests = [totals([there, back, there][zeroed:]) for zeroed in range(3)]
        assert checker.positions[: core.axes] == rests[0]
        assert channel.positions() in [*rests, [0] * core.axes]
        core.finish_watch()
    assert Verdict.BUSY in verdicts
