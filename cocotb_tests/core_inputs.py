# SPDX-License-Identifier: MIT
"""Inputs of the machine: limits, alarms, trigger, e-stop, watchdog. The model agrees on every clock."""

from contextlib import suppress

from passo import registers as r
from passo.cocotb.clocks import read
from passo.host import RATE_ONE
from passo.link import RefusedError
from passo.registers import Cause, State, TriggerAction, TriggerSource

from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.core_bench import ONE, Core, CoreChannel, Line, PinTiming, Ramp, core_test
from cocotb_tests.helpers.core_moves import check_stopped, clear_and_move
from tests.helpers.random_inputs import RandomInputs

FILTERED = 4  # clocks from a pin to its level with the shortest filter, at most
LAST_STEP = 4  # clocks from a level to the last edge of STEP after a hard stop
UNIT = 1 << 16  # of the watchdog, clocks


def set_inputs(channel: CoreChannel, axis: int = 0, **bits: bool) -> None:
    """Write the register INPUTS of an axis."""
    address = channel.axis_base(axis) + r.AXIS_INPUTS
    channel.link.write(address, r.AxisInputsWord(**bits).pack())


def arm(
    channel: CoreChannel,
    source: TriggerSource,
    action: TriggerAction = TriggerAction.LATCH,
    axis: int = 0,
    falling: bool = False,
) -> None:
    """Arm the trigger."""
    word = r.ChannelTriggerWord(source=source, axis=axis, falling=falling, action=action, arm=True)
    channel.link.write(channel.base + r.CHANNEL_TRIGGER, word.pack())


def trigger_state(channel: CoreChannel) -> r.ChannelTriggerStateWord:
    """Read TRIGGER_STATE."""
    (word,) = channel.link.read(channel.base + r.CHANNEL_TRIGGER_STATE, 1)
    return r.ChannelTriggerStateWord.unpack(word)


def latched(channel: CoreChannel) -> list[int]:
    """The latched positions."""
    words = channel.link.read(channel.base + r.CHANNEL_TRIGGER_POSITION_BASE, channel.core.axes)
    return [word - (word >> 31 << 32) for word in words]


def jog(core: Core, way: int = 1, gap: int = 20) -> CoreChannel:
    """Move axis 0 on and on, a step every `gap` clocks; axis 1 the other way."""
    channel = core.channel()
    if core.checker is None:
        core.watch(PinTiming())
    since = core.clock
    channel.lines(Line(10, (10 * way, -5 * way, way)[: core.axes], endless=True))
    channel.ramps(Ramp(ONE // gap, 0), Ramp(ONE // gap, 60_000))
    channel.start()
    core.run_until(lambda: core.motions_begun(since) or channel.state().state == State.STOPPED, 4000)
    core.run(300)
    return channel


def last_step(core: Core) -> int:
    """Clock of the last rising edge of STEP of any axis."""
    return max(clock for axis in range(core.axes) for clock in core.steps(axis)[-1:])


def positions_at(core: Core, clock: int) -> list[int]:
    """Edges that have left the pins of channel 0 up to a clock, by direction."""
    positions = []
    for axis in range(core.axes):
        levels = [(0, 0), *core.changes("dir", axis)]
        made = 0
        for step in core.steps(axis):
            if step <= clock:
                made += -1 if max(level for level in levels if level[0] <= step)[1] else 1
        positions.append(made)
    return positions


@core_test
def a_hard_limit_ends_steps_and_lets_the_axis_be_driven_off(core: Core) -> None:
    """No step toward it begins; the axis is named; a motion toward it is refused, one away is made."""
    channel = jog(core)
    pressed = core.clock
    core.set("limit_high", 1)
    core.run(200)
    assert last_step(core) <= pressed + FILTERED + 20 + LAST_STEP
    check_stopped(core, channel, Cause.LIMIT)
    assert trigger_state(channel).axes == 1
    where = channel.positions()
    channel.clear()
    jog(core)
    check_stopped(core, channel, Cause.LIMIT)
    assert channel.positions()[0] == where[0], "further in"
    channel.clear()
    assert trigger_state(channel).axes == 0
    jog(core, way=-1)
    assert channel.state().state == State.RUN
    channel.abort()
    core.run(100)
    assert channel.positions()[0] < where[0]
    core.set("limit_high", 0)
    channel.clear()
    clear_and_move(core, channel)


@core_test
def a_soft_limit_makes_the_steps_of_the_stop_and_none_after(core: Core) -> None:
    """The rate goes to 0; then the switch is as a hard one."""
    set_inputs(core.channel(), limit_soft=True)
    core.channel().link.write(core.channel().base + r.CHANNEL_STOP_SLEW, RATE_ONE // 20)
    channel = jog(core)
    core.set("limit_high", 1)
    before = len(core.steps(0))
    core.run_until(lambda: channel.state().state == State.STOPPED, 20_000)
    check_stopped(core, channel, Cause.LIMIT)
    assert len(core.steps(0)) > before + 20
    where = channel.positions()
    for _ in range(2):
        channel.clear()
        jog(core)
        check_stopped(core, channel, Cause.LIMIT)
        assert channel.positions()[0] == where[0], "further in"
    channel.clear()
    jog(core, way=-1)
    assert channel.state().state == State.RUN
    core.set("limit_high", 0)
    channel.abort()


@core_test
def an_alarm_stops_and_takes_the_enable_away(core: Core) -> None:
    """Hard, or soft if wanted; the channel stays STOPPED while it is active; EN stays off after it."""
    core.channel().pins(PinTiming())
    set_inputs(core.channel(), 1, alarm_disables=True)
    channel = jog(core)
    raised = core.clock
    core.set("alarm", 2)
    core.run(40)
    assert last_step(core) <= raised + FILTERED + LAST_STEP
    check_stopped(core, channel, Cause.ALARM)
    assert trigger_state(channel).axes == 2
    assert read(core.dut.enable) == (1 << core.axes) - 1 - 2
    channel.clear()
    assert channel.state().state == State.STOPPED
    core.set("alarm", 0)
    core.run(20)
    channel.clear()
    core.run(20)
    assert channel.state().state == State.IDLE
    assert read(core.dut.enable) == (1 << core.axes) - 1 - 2
    set_inputs(channel, 1, alarm_soft=True)
    channel = jog(core)
    core.set("alarm", 2)
    before = len(core.steps(0))
    core.run_until(lambda: channel.state().state == State.STOPPED, 20_000)
    assert channel.state().cause == Cause.ALARM and len(core.steps(0)) > before + 5
    core.set("alarm", 0)


@core_test
def the_trigger_latches_the_positions_of_its_clock(core: Core) -> None:
    """Whatever its source, edge and action; never armed it does nothing."""
    channel = jog(core, gap=7)
    core.set("probe", 1)
    core.run(50)
    assert not trigger_state(channel).fired
    offsets = set()
    for filter_clocks in (0, 3, 50):
        core.link.write(r.ADDRESS_INPUT_FILTER, filter_clocks)
        for source, pin in ((TriggerSource.PROBE, "probe"), (TriggerSource.HOME, "home")):
            for falling in (False, True):
                core.set(pin, int(falling))
                core.run(130)
                arm(channel, source, falling=falling)
                core.run(37)
                assert trigger_state(channel).armed
                edge = core.clock
                core.set(pin, int(not falling))
                core.run(filter_clocks + 400)
                state = trigger_state(channel)
                assert state.fired and not state.armed
                found = latched(channel)
                fits = [n for n in range(12) if positions_at(core, edge + filter_clocks + n) == found]
                assert fits, f"latched {found}"
                offsets.update([frozenset(fits)])
    assert frozenset.intersection(*offsets), "not always the same clock"
    core.set("home", 0)
    core.set("probe", 0)
    core.run(200)
    arm(channel, TriggerSource.HOME, TriggerAction.HARD_STOP)
    core.run(50)
    edge = core.clock
    core.set("home", 1)
    core.run(500)
    assert last_step(core) <= edge + 50 + 4 + LAST_STEP
    check_stopped(core, channel, Cause.TRIGGER)
    channel.clear()
    core.link.write(r.ADDRESS_INPUT_FILTER, 0)
    channel = jog(core, gap=7)
    arm(channel, TriggerSource.HOME, TriggerAction.SOFT_STOP, falling=True)
    core.set("home", 0)
    core.run_until(lambda: channel.state().state == State.STOPPED, 20_000)
    check_stopped(core, channel, Cause.TRIGGER)


@core_test
def the_trigger_ends_an_endless_line(core: Core) -> None:
    """The line after it follows without a gap, when the repetition is complete."""
    channel = jog(core)
    channel.lines(Line(30, (0, 30, 0)[: core.axes], last=True))
    core.run(500)
    arm(channel, TriggerSource.PROBE, TriggerAction.END_ENDLESS)
    core.set("probe", 1)
    core.run(1500)
    axis_0, axis_1 = core.steps(0), core.steps(1)
    assert len(axis_0) % 10 == 0
    assert len([clock for clock in axis_1 if clock > axis_0[-1] + 10]) == 30
    assert channel.state().state == State.RUN
    channel.abort()
    core.set("probe", 0)


@core_test
def e_stop_takes_the_enables_away_and_stays(core: Core) -> None:
    """Immediately; it must be released and cleared, then enabled again."""
    core.channel().pins(PinTiming())
    channel = jog(core)
    pressed = core.clock
    assert read(core.dut.enable) == (1 << core.axes) - 1
    core.set("estop_n", 0)
    core.run(1)
    assert read(core.dut.enable) == 0
    core.run(100)
    assert last_step(core) <= pressed + 2 + LAST_STEP
    check_stopped(core, channel, Cause.ESTOP)
    core.link.write(r.ADDRESS_ESTOP_CLEAR, 1)
    channel.clear()
    assert core.link.read(r.ADDRESS_ESTOP, 1) == [1]
    assert channel.state().state == State.STOPPED
    core.set("estop_n", 1)
    core.run(20)
    assert core.link.read(r.ADDRESS_ESTOP, 1) == [1]
    channel.link.write(channel.axis_base(0) + r.AXIS_ENABLE, 1)
    assert read(core.dut.enable) == 0
    core.link.write(r.ADDRESS_ESTOP_CLEAR, 1)
    assert core.link.read(r.ADDRESS_ESTOP, 1) == [0]
    assert read(core.dut.enable) == 0
    channel.link.write(channel.axis_base(0) + r.AXIS_ENABLE, 1)
    core.run(20)
    assert read(core.dut.enable) == 1
    clear_and_move(core, channel)


@core_test
def the_watchdog_stops_a_motion_when_the_host_is_silent(core: Core) -> None:
    """Softly, and takes the enables away later; not at rest, and not while frames come."""
    core.link.write(r.ADDRESS_WATCHDOG, r.WatchdogWord(stop_after=1, disable_after=1).pack())
    core.channel().pins(PinTiming())
    core.run(UNIT + 100)
    channel = jog(core, gap=200)
    for _ in range(3):
        core.run(UNIT * 2 // 3)
        assert channel.state().state == State.RUN
    core.run(UNIT + 100)
    assert len(core.steps(0)) > 900
    core.run(UNIT - 1000)
    assert read(core.dut.enable) == (1 << core.axes) - 1
    core.run(1000)
    assert read(core.dut.enable) == 0
    check_stopped(core, channel, Cause.WATCHDOG)
    core.link.write(r.ADDRESS_WATCHDOG, 0)


@core_test
def short_glitches_do_nothing_and_long_levels_act(core: Core) -> None:
    """Of limits and trigger alike; a flag remembers."""
    length = 30
    core.link.write(r.ADDRESS_INPUT_FILTER, length)
    channel = jog(core)
    arm(channel, TriggerSource.HOME)
    for clocks in (1, 2, 7, length - 1, length):
        core.set("alarm", 1)
        core.set("home", 1)
        core.run(clocks)
        core.set("alarm", 0)
        core.set("home", 0)
        core.run(3 * length)
    assert channel.state().state == State.RUN
    assert not trigger_state(channel).fired
    (flags,) = core.link.read(channel.base + r.CHANNEL_INPUT_FLAGS, 1)
    assert flags == 0
    core.set("home", 1)
    core.run(length + 1)
    core.set("home", 0)
    core.run(10)
    assert trigger_state(channel).fired
    core.set("alarm", 1)
    core.run(2 * length)
    core.set("alarm", 0)
    core.run(3 * length)
    check_stopped(core, channel, Cause.ALARM)
    (flags,) = core.link.read(channel.base + r.CHANNEL_INPUT_FLAGS, 1)
    assert r.ChannelInputFlagsWord.unpack(flags).alarm == 1
    core.link.write(channel.base + r.CHANNEL_INPUT_CLEAR, flags)
    assert core.link.read(channel.base + r.CHANNEL_INPUT_FLAGS, 1) == [0]


@core_test
def the_first_cause_stays(core: Core) -> None:
    """A soft stop that is overtaken by a hard one is a hard stop with the cause of the soft one."""
    core.channel().link.write(core.channel().base + r.CHANNEL_STOP_SLEW, 100)
    for hurry in ("abort", "alarm", "estop"):
        channel = jog(core)
        channel.stop()
        core.run(500)
        assert channel.state().stopping
        if hurry == "abort":
            channel.abort()
        else:
            core.set("alarm" if hurry == "alarm" else "estop_n", int(hurry == "alarm"))
        core.run(10)
        core.set("alarm", 0)
        core.set("estop_n", 1)
        core.run(10)
        core.link.write(r.ADDRESS_ESTOP_CLEAR, 1)
        check_stopped(core, channel, Cause.STOP)
        channel.clear()


@core_test
def random_events_match_the_model(core: Core) -> None:
    """Pins and registers of inputs at random, with random jogs and commands."""
    random = rng("inputs")
    events = RandomInputs(random, core.parameters)
    channel = core.channel()
    core.link.write(r.ADDRESS_RUN, 1)
    for _ in range(60):
        with suppress(RefusedError):
            steps = tuple(random.randint(-40, 40) for _ in range(core.axes))
            channel.lines(Line(40, steps, endless=random.random() < 0.7))
            channel.ramps(Ramp(ONE // random.randint(2, 60), random.randint(0, 3)), Ramp(ONE // 30, 500))
        for _ in range(3):
            with suppress(RefusedError):
                core.link.write(*events.write())
            for _ in range(random.randrange(5)):
                core.set(*events.pin())
                core.run(random.randint(1, random.choice([3, 40, 400])))
        with suppress(RefusedError):
            command = 1 << r.CHANNEL_COMMAND_CLEAR_LSB if random.random() < 0.8 else random.randrange(16)
            core.link.write(channel.base + r.CHANNEL_COMMAND, command)
        core.link.read(channel.base + r.CHANNEL_INPUT_LEVELS, 2)
        core.link.read(channel.base + r.CHANNEL_TRIGGER_STATE, 2)
        core.link.read(channel.base + r.CHANNEL_TRIGGER_POSITION_BASE, core.axes)
