# SPDX-License-Identifier: MIT
"""Commands while a motion is prepared or running: jog, sync, chaining, hold, override, stop."""

from itertools import pairwise

from passo import registers as r
from passo.cocotb.clocks import read
from passo.host import RATE_ONE
from passo.registers import Cause, State

from cocotb_tests.helpers.core_bench import ONE, Core, CoreChannel, Line, PinTiming, Ramp, Shape, core_test
from cocotb_tests.helpers.core_expected import distance, due, totals
from cocotb_tests.helpers.core_moves import SLOW, a_motion, check_stopped, clear_and_move, pulse_groups

AT_ONCE = RATE_ONE


def set_slews(channel: CoreChannel, rate_slew: int, stop_slew: int = AT_ONCE) -> None:
    """Set the slews of hold and stop, per tick."""
    channel.link.write(channel.base + r.CHANNEL_RATE_SLEW, rate_slew, stop_slew)


@core_test
def jog(core: Core) -> None:
    """An ENDLESS line continues after its ramps; NOW changes the speed immediately, LAST and NOW end it."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    channel.lines(Line(10, (10, -5, 1)[: core.axes], endless=True))
    channel.ramps(Ramp(ONE // 20, 2, Shape.COSINE))
    channel.start()
    core.run_until(core.is_running, 2000)
    core.run(1500)
    assert channel.state().state == State.RUN
    clocks = core.steps(0)[-5:]
    assert all(b - a == 20 for a, b in pairwise(clocks))
    # the long ramp is dropped by the NOW behind it
    channel.ramps(Ramp(ONE // 200, 60_000), Ramp(ONE // 50, 1, now=True))
    core.run(1000)
    clocks = core.steps(0)[-4:]
    assert all(b - a == 50 for a, b in pairwise(clocks))
    channel.ramps(Ramp(0, 3, Shape.EASE, mirror=True, last=True, now=True))
    core.run_until(lambda: not core.is_running(), 2000)
    core.run(100)
    state = channel.state()
    assert (state.state, state.cause, state.drained) == (State.IDLE, Cause.NONE, 0)
    assert channel.positions() == checker.positions
    up = checker.positions[0]
    assert up > 80
    # every 10 substeps again: e begins in the middle
    assert channel.positions() == [up, -((up + 1) // 2), (up + 5) // 10][: core.axes]


@core_test
def sync_starts_an_armed_channel(core: Core) -> None:
    """With WAIT_SYNC a prepared motion starts with a rising edge of the pin, on a fixed clock after it."""
    channel = core.channel()
    core.watch(PinTiming())
    begins = []
    core.sync(True)
    for wait in (777, 778):
        lines, ramps = a_motion(core, 2)
        channel.rest()
        channel.lines(*lines)
        channel.ramps(*ramps)
        core.link.write(r.ADDRESS_RUN, 1 | 1 << r.RUN_WAIT_SYNC_LSB)
        core.run(wait)
        assert channel.state().state == State.ARMED
        core.sync(False)
        core.run(50)
        assert channel.state().state == State.ARMED
        edge = core.clock
        core.sync(True)
        core.wait_end()
        begins.append(core.motions()[-1][0] - edge)
        assert channel.state().state == State.IDLE
    assert begins[0] == begins[1]


@core_test
def a_motion_without_ramps_at_velocity_0_waits(core: Core) -> None:
    """No step is lost and there is no fault: the next ramp continues."""
    channel = core.channel()
    core.watch(PinTiming())
    ramps = [Ramp(SLOW, 2), Ramp(0, 2), Ramp(SLOW, 2), Ramp(0, 2, last=True)]
    total = distance(ramps, core.tick)
    channel.lines(Line(total, (total, -total, 1)[: core.axes], last=True))
    channel.ramps(*ramps[:2])
    channel.start()
    core.run_until(core.is_running, 2000)
    core.run(3000)
    assert channel.state().state == State.RUN
    pulses = len(core.steps(0))
    core.run(2000)
    assert len(core.steps(0)) == pulses
    channel.ramps(*ramps[2:])
    core.run_until(lambda: not core.is_running(), 2000)
    core.run(50)
    state = channel.state()
    assert (state.state, state.cause, state.drained) == (State.IDLE, Cause.NONE, 0)
    assert channel.positions() == [total, -total, 1][: core.axes]


@core_test
def the_next_motion_starts_by_itself(core: Core) -> None:
    """While RUN is set, motions follow each other; when it is cleared, the running one finishes."""
    channel = core.channel()
    core.watch(PinTiming())
    lines, ramps = a_motion(core, 20)
    channel.lines(*lines)
    channel.ramps(*ramps)
    channel.start()
    core.run_until(core.is_running, 2000)
    channel.ramps(*ramps)
    channel.lines(*lines)
    assert core.is_running()
    core.run_until(lambda: core.motions(), 10_000)
    core.run_until(core.is_running, 300)
    channel.ramps(*ramps)
    channel.lines(*lines)
    channel.rest()
    assert core.is_running()
    core.run_until(lambda: not core.is_running(), 10_000)
    core.run(1000)
    assert not core.is_running()
    assert channel.positions() == [2 * total for total in totals(lines)]
    channel.start()
    core.wait_end()
    assert channel.positions() == [3 * total for total in totals(lines)]
    assert [end - begin for begin, end in core.motions()] == [60 * core.tick] * 3


@core_test
def hold_resume_and_override_make_the_same_pulses_later(core: Core) -> None:
    """Feed holds and overrides stretch time; the sequence of pulses stays the same."""
    channel = core.channel()
    lines, ramps = a_motion(core, 8)
    core.watch(PinTiming())

    def run(interfere: bool) -> tuple[list[tuple[int, ...]], int]:
        since = core.clock
        channel.rest()
        channel.lines(*lines)
        channel.ramps(*ramps)
        channel.start()
        core.run_until(core.is_running, 2000)
        if interfere:
            for rate, slew, wait in (
                (0, RATE_ONE // 5, 3000),
                (RATE_ONE // 3, RATE_ONE // 4, 300),
                (0, AT_ONCE, 500),
                (RATE_ONE - 1, AT_ONCE, 100),
                (1234, 5000, 200),
                (RATE_ONE, 0x3000, 0),
            ):
                set_slews(channel, slew)
                channel.set_rate(rate)
                core.run(wait)
        core.run_until(lambda: not core.is_running(), 20_000)
        core.run(100)
        assert channel.state().cause == Cause.NONE
        ((begin, end),) = core.motions(0, since)
        return pulse_groups(core, since), end - begin

    expected, length = run(interfere=False)
    assert length == 24 * core.tick
    actual, longer = run(interfere=True)
    assert actual == expected
    assert longer > length + 3000
    assert channel.positions() == [2 * total for total in totals(lines)]
    # the hold was a rest
    clocks = [clock for axis in range(core.axes) for clock in core.steps(axis, core.motions()[1][0])]
    assert max(b - a for a, b in pairwise(sorted(clocks))) > 2000


@core_test
def a_constant_rate_stretches_every_clock(core: Core) -> None:
    """At rate x the n-th enabled clock is the first on which n clocks have summed up."""
    channel = core.channel()
    core.watch(PinTiming())
    lines, ramps = a_motion(core, 2)
    for rate in (RATE_ONE // 4, 40_000, 65_535):
        channel.rest()
        channel.set_rate(rate)
        since = core.clock
        channel.lines(*lines)
        channel.ramps(*ramps)
        channel.start()
        core.wait_end()
        ((begin, end),) = core.motions(0, since)
        for axis, clocks in enumerate(due(lines, ramps, core.tick)):
            expected = [-(-clock * RATE_ONE // rate) for clock in clocks]
            assert [clock - begin for clock in core.steps(axis, since)] == expected
        assert end - begin == -(-6 * core.tick * RATE_ONE // rate)


@core_test
def soft_stop(core: Core) -> None:
    """COMMAND.STOP slows down with STOP_SLEW; the position is exact, and CLEAR allows new motions."""
    channel = core.channel()
    core.watch(PinTiming())
    set_slews(channel, AT_ONCE, RATE_ONE // 8)
    channel.lines(*a_motion(core, 30)[0])
    channel.ramps(Ramp(SLOW, 0), Ramp(SLOW, 100))
    channel.start()
    core.run_until(core.is_running, 2000)
    core.run(1000)
    before = core.clock
    channel.stop()
    assert channel.state().stopping
    core.run_until(lambda: not core.is_running(), 2000)
    after = core.clock
    # 8 slew ticks, half of the pulses
    assert 7 * core.tick < after - before < 10 * core.tick + 1500
    slowing = core.steps(0, before + 700)
    assert slowing[-1] - slowing[-2] > 40
    check_stopped(core, channel, Cause.STOP)
    clear_and_move(core, channel)


@core_test
def soft_stop_in_a_hold_and_before_the_start(core: Core) -> None:
    """At rate 0, in IDLE and in ARMED a soft stop acts immediately."""
    channel = core.channel()
    core.watch(PinTiming())
    set_slews(channel, AT_ONCE, 1)
    lines, ramps = a_motion(core)
    channel.lines(*lines)
    channel.ramps(*ramps)
    channel.start()
    core.run_until(core.is_running, 2000)
    core.run(300)
    channel.set_rate(0)
    core.run(300)
    channel.stop()
    check_stopped(core, channel, Cause.STOP)
    channel.clear()
    channel.set_rate(RATE_ONE)
    channel.stop()
    check_stopped(core, channel, Cause.STOP)
    channel.clear()
    channel.rest()
    channel.lines(*lines)
    channel.ramps(*ramps)
    core.link.write(r.ADDRESS_RUN, 1 | 1 << r.RUN_WAIT_SYNC_LSB)
    core.run(300)
    assert channel.state().state == State.ARMED
    channel.stop()
    check_stopped(core, channel, Cause.STOP)
    clear_and_move(core, channel)


@core_test
def abort(core: Core) -> None:
    """A pulse in progress is completed, queued steps are dropped, the position counts the steps made."""
    channel = core.channel()
    timing = PinTiming(300, 2, 3, 2)
    channel.pins(timing)
    core.watch(timing)
    # a step every 250 clocks, which the pins cannot follow: soon there are steps waiting
    channel.lines(Line(300, (30, -15, 3)[: core.axes], last=True))
    channel.ramps(Ramp(ONE // 25, 0), Ramp(ONE // 25, 100), Ramp(0, 0, last=True))
    channel.start()
    core.run_until(lambda: len(core.steps(0)) == 3, 3000)
    core.run(200)
    assert read(core.dut.step) & 1
    channel.abort()
    check_stopped(core, channel, Cause.ABORT)
    assert 3 <= channel.positions()[0] < 12
    channel.times(PinTiming())
    core.watch(PinTiming())
    clear_and_move(core, channel)
    # in IDLE too
    channel.abort()
    core.run(20)
    assert channel.state().cause == Cause.ABORT
    assert core.dut.irq.value == 1
