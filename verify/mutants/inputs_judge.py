# SPDX-License-Identifier: MIT
"""Inputs as judge: events at the pins of a machine, as tests/test_inputs.py has them, levels, watchdog."""

import random

from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine
from passo.registers import Cause, State, TriggerAction, TriggerSource

from tests.helpers.closed_form import ONE, Line, Ramp
from tests.helpers.motions import to_line, to_ramp
from tests.test_inputs import KINDS, LATCH, Machine, arm
from verify.mutants.engine_judge import Check

MODULES = (
    *("passo_machine", "passo_estop", "passo_watchdog", "passo_inputs", "passo_input", "passo_limits"),
    *("passo_trigger", "passo_positions", "passo_core", "passo_channel", "passo_axis_registers"),
    *("passo_lines", "passo_channels", "passo_channel_path", "passo_channel_control"),
    "passo_channel_drives",
)
LEVELS = ("limit_low", "limit_high", "home", "alarm")
UNIT = 1 << 16  # clocks of the watchdog
SETTLES = 400  # clocks until any of these filters knows its level


def check_levels(machine: Machine) -> None:
    """Each input, with any polarity, is read as it is; a flag stays until it is cleared."""
    rng, axes, base = machine.rng, machine.axes, machine.channel.base
    machine.link.write(r.ADDRESS_INPUT_FILTER, rng.choice((0, 3, 60)))
    inverted = [rng.getrandbits(4) for _ in range(axes)]
    for axis, bits in enumerate(inverted):
        machine.link.write(machine.channel.axis_base(axis) + r.AXIS_INPUTS, bits)
    for _ in range(3):
        expected = 0
        for n, pin in enumerate(LEVELS):
            level = rng.getrandbits(axes)
            machine.set(pin, level)
            active = level ^ sum((bits >> n & 1) << axis for axis, bits in enumerate(inverted))
            expected |= active << 8 * n
        machine.engine.run(SETTLES)
        machine.link.write(base + r.CHANNEL_INPUT_CLEAR, 0xFFFFFFFF)
        machine.engine.run(10)
        levels, flags = machine.link.read(base + r.CHANNEL_INPUT_LEVELS, 2)
        assert levels == expected, f"INPUT_LEVELS {levels:08X} instead of {expected:08X}"
        assert flags == expected, f"INPUT_FLAGS {flags:08X} instead of {expected:08X}"
    for axis in range(axes):
        machine.link.write(machine.channel.axis_base(axis) + r.AXIS_INPUTS, 0)
    machine.clear()
    machine.engine.run(SETTLES)
    seen = machine.link.read(base + r.CHANNEL_INPUT_LEVELS, 2)
    assert seen[0] == 0 and seen[1] & expected == expected, "flags are kept"
    machine.link.write(base + r.CHANNEL_INPUT_CLEAR, 0xFFFFFFFF)


def trigger_state(machine: Machine) -> r.ChannelTriggerStateWord:
    """As it is read."""
    return r.ChannelTriggerStateWord.unpack(
        machine.link.read(machine.channel.base + r.CHANNEL_TRIGGER_STATE, 1)[0]
    )


def check_probe(machine: Machine) -> None:
    """As the other inputs: its level, with either polarity, and its flag."""
    place = machine.channel.base + r.CHANNEL_PROBE
    for inverted in (0, 1):
        for level in (1, 0):
            machine.link.write(place, inverted << r.CHANNEL_PROBE_INVERTED_LSB)
            machine.set("probe", level)
            machine.engine.run(SETTLES)
            active = bool(level ^ inverted)
            state = trigger_state(machine)
            assert state.probe == active and state.probe_flag >= active, f"{state}"
            machine.link.write(
                place, 1 << r.CHANNEL_PROBE_CLEAR_LSB | inverted << r.CHANNEL_PROBE_INVERTED_LSB
            )
            machine.engine.run(10)
            state = trigger_state(machine)
            assert state.probe_flag == active, f"{state}"
    machine.link.write(place, 1 << r.CHANNEL_PROBE_CLEAR_LSB)
    machine.engine.run(SETTLES)


def check_polarity(machine: Machine) -> None:
    """Another polarity is no edge: it arms the trigger again, at the new level."""
    rng, link, base = machine.rng, machine.link, machine.channel.base
    axis, falling = rng.randrange(machine.axes), bool(rng.getrandbits(1))
    link.write(r.ADDRESS_INPUT_FILTER, 0)
    machine.engine.run(SETTLES)
    word = r.ChannelTriggerWord(
        source=TriggerSource.HOME, axis=axis, falling=falling, action=TriggerAction.LATCH, arm=True
    )
    link.write(base + r.CHANNEL_TRIGGER, word.pack())
    for active in (False, True, False, True, False):
        settings = machine.channel.axis_base(axis) + r.AXIS_INPUTS
        link.write(settings, int(active) << r.AXIS_INPUTS_HOME_INVERTED_LSB)
        machine.engine.run(SETTLES)
        state = trigger_state(machine)
        assert (state.armed, state.fired, state.source_active) == (True, False, active), f"{state}"
    link.write(base + r.CHANNEL_TRIGGER, 0)
    machine.clear()


def check_trigger(machine: Machine) -> None:
    """Any edge of any source: no glitch fires it, and it latches the positions of its clock."""
    rng, link, base = machine.rng, machine.link, machine.channel.base
    source, pin = rng.choice(((TriggerSource.HOME, "home"), (TriggerSource.PROBE, "probe")))
    axis = 0 if pin == "probe" else rng.randrange(machine.axes)
    falling, length = bool(rng.getrandbits(1)), rng.choice((1, 6, 45))
    before, after = falling << axis, (not falling) << axis
    link.write(r.ADDRESS_INPUT_FILTER, length)
    machine.set(pin, before)
    word = r.ChannelTriggerWord(
        source=source, axis=axis, falling=falling, action=TriggerAction.LATCH, arm=True
    )
    link.write(base + r.CHANNEL_TRIGGER, word.pack())
    machine.engine.run(SETTLES)
    machine.set(pin, after)
    machine.engine.run(length)
    machine.set(pin, before)
    machine.move([rng.choice((-8, 8)) for _ in range(machine.axes)], rng.randint(4, 9))
    state = trigger_state(machine)
    assert (state.armed, state.fired, state.source_active) == (True, False, falling), f"{state}"
    at = machine.engine.clock
    machine.set(pin, after)
    machine.engine.run(length + 300)
    words = link.read(base + r.CHANNEL_TRIGGER_POSITION_BASE, machine.axes)
    state = trigger_state(machine)
    assert (state.armed, state.fired) == (False, True), f"{state}"
    machine.channel.abort()
    machine.check_position()
    latched = [word - (word >> 31 << 32) for word in words]
    assert latched == machine.positions(at + LATCH + length), "the latched positions"
    machine.clear()


def check_end_endless(machine: Machine) -> None:
    """The line that repeats is made to its end once the trigger fires; the next one repeats as well."""
    rng, channel = machine.rng, machine.channel
    size, other, gap = rng.randint(5, 12), rng.randint(5, 12), rng.randint(8, 14)
    none = (0,) * (machine.axes - 2)
    begin = channel.positions()
    machine.link.write(r.ADDRESS_INPUT_FILTER, 0)
    arm(machine, TriggerAction.END_ENDLESS)
    lines = Line(size, (size, 0, *none), endless=True), Line(other, (0, -other, *none), endless=True)
    channel.push_lines([to_line(line) for line in lines])
    channel.push_ramps([to_ramp(Ramp(ONE // gap, 0)), to_ramp(Ramp(ONE // gap, 60_000))])
    channel.start()
    machine.engine.run(400 + 10 * size * gap + rng.randrange(size * gap))
    before = [place - first for place, first in zip(channel.positions(), begin, strict=True)]
    assert before[0] > 5 * size and before[1] == 0, "a line repeats until the trigger fires"
    machine.set("probe", 1)
    machine.engine.run((size + 6 * other) * gap + 200)
    channel.abort()
    machine.check_position()
    after = [place - first for place, first in zip(channel.positions(), begin, strict=True)]
    assert after[0] % size == 0 and 0 <= after[0] - before[0] < size + 1500 // gap, "it ends whole"
    assert after[1] < -3 * other, "the next one repeats"
    machine.clear()


def wait_for_sync(machine: Machine, steps: list[int]) -> None:
    """Repeat a line of these steps from the next edge of `sync` on."""
    machine.link.write(r.ADDRESS_RUN, 1 << r.RUN_RUN_LSB | 1 << r.RUN_WAIT_SYNC_LSB)
    machine.queue(steps, 20)
    machine.engine.run(600)
    assert machine.channel.state().state == State.ARMED


def check_unknown(machine: Machine) -> None:
    """An edge of `sync` while the inputs are unknown begins nothing; the next one does."""
    wait_for_sync(machine, [8] * machine.axes)
    machine.link.write(r.ADDRESS_INPUT_FILTER, 2000)
    for clocks, state in ((6000, State.ARMED), (100, State.RUN)):
        machine.engine.sync(True)
        machine.engine.run(clocks)
        machine.engine.sync(False)
        machine.engine.run(100)
        assert machine.channel.state().state == state, f"{state.name} after an edge of sync"
    machine.channel.abort()
    machine.check_position()
    machine.link.write(r.ADDRESS_INPUT_FILTER, 0)
    machine.clear()


def check_soft_limit(machine: Machine) -> None:
    """The axis brakes beyond it; a motion that is prepared when it closes makes no step toward it."""
    rng, link, axis, way = machine.rng, machine.link, machine.rng.randrange(machine.axes), 1
    pin = "limit_low"
    if rng.getrandbits(1):
        way, pin = -way, "limit_high"
    steps = [0] * machine.axes
    steps[axis] = -8 * way
    settings = machine.channel.axis_base(axis) + r.AXIS_INPUTS
    link.write(r.ADDRESS_INPUT_FILTER, 0)
    link.write(settings, 1 << r.AXIS_INPUTS_LIMIT_SOFT_LSB)
    link.write(machine.channel.base + r.CHANNEL_STOP_SLEW, 2000)
    machine.move(steps, 20)
    machine.set(pin, 1 << axis)
    machine.see()
    closed = machine.positions()[axis]
    machine.engine.run(128 * 60)
    machine.check_position()
    assert machine.channel.state().cause == Cause.LIMIT
    assert abs(machine.positions()[axis] - closed) > 40, "a soft limit lets the axis brake"
    machine.clear()
    wait_for_sync(machine, steps)
    where = machine.positions()[axis]
    machine.set(pin, 1 << axis)
    machine.engine.run(50)
    machine.engine.sync(True)
    machine.engine.run(3000)
    machine.engine.sync(False)
    machine.check_position()
    assert machine.channel.state().cause == Cause.LIMIT
    assert machine.positions()[axis] == where, "a step into a switch that closed before the motion began"
    machine.clear()
    link.write(settings, 0)


def check_watchdog(machine: Machine) -> None:
    """Silence stops a motion after its time, and then disables the drives."""
    for axis in range(machine.axes):
        machine.link.write(machine.channel.axis_base(axis) + r.AXIS_ENABLE, 1)
    word = r.WatchdogWord(stop_after=1, disable_after=1)
    machine.link.write(machine.channel.base + r.CHANNEL_STOP_SLEW, 1 << 16)
    machine.move([8] * machine.axes, 40)
    machine.link.write(r.ADDRESS_WATCHDOG, word.pack())
    fed = machine.engine.clock
    machine.engine.drain()
    left = 2 * UNIT + 1000
    while left > 0:
        left -= machine.engine.run(left)
    events = machine.engine.drain()
    stopped = events["clock"][events["running"] == 0][:1]
    assert len(stopped) and abs(int(stopped[0]) - fed - UNIT) < 1200, "when the watchdog stops the motion"
    disabled = events["clock"][events["enable"] == 0][:1]
    assert len(disabled) and abs(int(disabled[0]) - fed - 2 * UNIT) < 600, "when it disables the drives"
    assert machine.channel.state().cause == Cause.WATCHDOG
    machine.link.write(r.ADDRESS_WATCHDOG, 0)
    machine.clear()


def check(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
    """Some rounds of all kinds.

    Raises:
        AssertionError: Something is not as it is known to be.
    """
    if not parameters.inputs:
        return
    machine = Machine(engine, rng, parameters)
    check_levels(machine)
    check_probe(machine)
    check_polarity(machine)
    for kind in (*KINDS, *3 * [check_trigger], check_end_endless, check_unknown, check_soft_limit):
        kind(machine)
    check_watchdog(machine)


CHECK = Check("inputs", "motions", check, MODULES)
