# SPDX-License-Identifier: MIT
"""A core with all its parts: how inputs, encoders and outputs interact."""

from collections.abc import Iterator
from contextlib import suppress
from random import Random

from passo import registers as r
from passo.cocotb.clocks import read
from passo.link import RefusedError
from passo.registers import Cause, LineOutputWord, State, TriggerAction, TriggerSource

from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.core_bench import ONE, Core, CoreChannel, Line, PinTiming, Ramp, core_test
from cocotb_tests.helpers.core_moves import check_stopped
from cocotb_tests.helpers.core_shaft import Shafts, encoder_address, follow_word, positions
from tests.helpers.random_inputs import RandomInputs

SPINDLE = 2  # the axis with its encoder
RATIO_ONE = 1 << 16
HARD = 1 << r.ENCODER_SETUP_STOP_HARD_LSB
FULL = LineOutputWord(raster=False, proportional=False, levels=0x55, power=0xFFFF)
LAST_STEP = 20  # clocks from the end of what is owed to the last step, or to the end of the power
UNIT = 1 << 16  # of the watchdog, clocks
SETTINGS = range(r.CHANNEL_PWM_STEP, r.CHANNEL_RASTER_PITCH + 1)


def arm(channel: CoreChannel, source: TriggerSource, axis: int, action: TriggerAction) -> None:
    """Arm the trigger."""
    word = r.ChannelTriggerWord(source=source, axis=axis, falling=False, action=action, arm=True)
    channel.link.write(channel.base + r.CHANNEL_TRIGGER, word.pack())


def jog(core: Core, speed: int = ONE // 20) -> CoreChannel:
    """Move axes 0 and 1 on and on, with full power."""
    channel = core.channel()
    if core.checker is None:
        core.watch(PinTiming())
    channel.rest()
    channel.lines(Line(10, (10, -10, 0), endless=True), outputs=[FULL])
    channel.ramps(Ramp(speed, 0), Ramp(speed, 60_000))
    since = core.clock
    channel.start()
    core.run_until(lambda: core.motions_begun(since), 4000)
    return channel


def level_changes(core: Core, signal: str) -> Iterator[tuple[int, int]]:
    """Begin and end of the times in which a pin of channel 0 was high."""
    begin = None
    for clock, level in [*core.changes(signal, 0), (core.clock + 1, 0)]:
        if level:
            begin = clock
        elif begin is not None:
            yield begin, clock
            begin = None


def check_power(core: Core) -> None:
    """There was power, and only in clocks in which a motion ran."""
    powers, motions = list(level_changes(core, "power")), list(level_changes(core, "running"))
    assert powers
    for begin, end in powers:
        assert any(first <= begin and end <= last for first, last in motions), f"power at {begin} .. {end}"


@core_test
def a_stop_of_any_part_ends_steps_and_power(core: Core) -> None:
    """Limit, alarm, trigger, e-stop, following error, ABORT: cause, position, no power from STOPPED on."""
    channel = core.channel()
    shafts = Shafts(core)
    for cause in (Cause.LIMIT, Cause.ALARM, Cause.TRIGGER, Cause.ESTOP, Cause.FOLLOWING_ERROR, Cause.ABORT):
        jog(core)
        core.run(500)
        if cause == Cause.LIMIT:
            core.set("limit_high", 1)
        elif cause == Cause.ALARM:
            core.set("alarm", 2)
        elif cause == Cause.ESTOP:
            core.set("estop_n", 0)
        elif cause == Cause.TRIGGER:
            arm(channel, TriggerSource.INDEX, SPINDLE, TriggerAction.HARD_STOP)
            shafts.turn(SPINDLE, [(10, 1)] * shafts.per_turn)
            core.run(10 * shafts.per_turn)
        elif cause == Cause.FOLLOWING_ERROR:
            channel.link.write(encoder_address(channel, 1, r.ENCODER_SETUP), HARD, RATIO_ONE, 16)
        else:
            channel.abort()
        core.run_until(lambda: core.dut.irq.value == 1, 5000)
        for pin, idle in (("limit_high", 0), ("alarm", 0), ("estop_n", 1)):
            core.set(pin, idle)
        core.run(20)
        core.link.write(r.ADDRESS_ESTOP_CLEAR, 1)
        check_stopped(core, channel, cause)
        channel.link.write(encoder_address(channel, 1, r.ENCODER_SETUP), 0)
        channel.clear()
    check_power(core)


@core_test
def the_e_stop_needs_no_clock(core: Core) -> None:
    """Drives and power are off before the next edge of the clock."""
    core.channel().pins(PinTiming())
    channel = jog(core)
    core.run_until(lambda: read(core.dut.power), 4000)
    assert read(core.dut.enable) != 0
    pressed = core.clock
    core.set("estop_n", 0)
    core.run_quarters(1)
    assert core.clock == pressed and read(core.dut.power) == 0 and read(core.dut.enable) == 0
    core.run_quarters(3)
    core.run(100)
    core.set("estop_n", 1)
    core.run(20)
    core.link.write(r.ADDRESS_ESTOP_CLEAR, 1)
    check_stopped(core, channel, Cause.ESTOP)


@core_test
def the_index_of_an_encoder_latches_positions(core: Core) -> None:
    """On the clock of its pin, of the level that the setup names."""
    shafts = Shafts(core, per_turn=16)
    channel = jog(core, ONE // 7)
    turns = 0
    offsets = set()
    for inverted in (0, 1):
        setup = r.EncoderSetupWord(index_inverted=bool(inverted)).pack()
        channel.link.write(encoder_address(channel, SPINDLE, r.ENCODER_SETUP), setup)
        for _ in range(3):
            arm(channel, TriggerSource.INDEX, SPINDLE, TriggerAction.LATCH)
            shafts.turn(SPINDLE, [(12, 1)] * shafts.per_turn)
            core.run(13 * shafts.per_turn)
            turns += 1
            at_index = turns * shafts.per_turn + inverted  # inverted: where the line goes low
            if inverted:
                at_index -= shafts.per_turn
            (edge,) = [clock for clock, place in shafts.counts[SPINDLE] if place == at_index]
            core.run(200)
            words = channel.link.read(channel.base + r.CHANNEL_TRIGGER_POSITION_BASE, 1)
            steps = core.steps(0)
            fits = [n for n in range(-4, 12) if sum(step <= edge + n for step in steps) == words[0]]
            assert fits, f"latched {words[0]}"
            offsets.update([frozenset(fits)])
            assert positions(channel) == shafts.at
    assert frozenset.intersection(*offsets), "not always the same clock"
    channel.abort()


@core_test
def a_motion_that_waits_for_its_encoder_has_no_power(core: Core) -> None:
    """While the spindle turns there are steps and power; when it stops, neither. The watchdog stops it."""
    channel = core.channel()
    shafts = Shafts(core)
    core.watch(PinTiming())
    channel.link.write(channel.base + r.CHANNEL_FOLLOW, follow_word(SPINDLE, 5), 1 << 28)
    channel.lines(Line(10, (10, 5, 0), endless=True), outputs=[FULL])
    channel.ramps(Ramp(ONE // 4, 0), Ramp(ONE // 4, 60_000))
    channel.start()
    core.run(3000)
    assert core.is_running() and not core.steps(0) and not core.changes("power", 0)
    for _ in range(3):
        since = core.clock
        shafts.turn(SPINDLE, [(700, 1)] * 10)
        core.run(12_000)
        begun, ended = core.changes("power", 0, since)[0], core.changes("power", 0, since)[-1]
        steps = core.steps(0, since)
        assert begun[1] == 1 and begun[0] <= steps[0] + LAST_STEP
        assert ended[1] == 0 and 0 < ended[0] - steps[-1] <= LAST_STEP
        assert len(steps) == 10 * 32 // 4
    core.link.write(r.ADDRESS_WATCHDOG, r.WatchdogWord(stop_after=1, disable_after=0).pack())
    core.run_until(lambda: core.dut.irq.value == 1, 3 * UNIT)
    check_stopped(core, channel, Cause.WATCHDOG)
    check_power(core)
    core.link.write(r.ADDRESS_WATCHDOG, 0)


def wander(random: Random) -> Iterator[tuple[int, int]]:
    """A spindle that turns, stands and turns back."""
    while True:
        way = random.choice((1, 1, 1, -1))
        for _ in range(random.randrange(200)):
            yield random.randrange(6, 60), way
        yield random.randrange(1, 3000), way


def some_output(random: Random) -> LineOutputWord:
    """An output word."""
    raster = random.random() < 0.3
    power = 0 if raster else random.choice((0, 0xFFFF, random.randrange(1 << 16)))
    proportional = random.random() < 0.4
    return LineOutputWord(raster=raster, proportional=proportional, levels=random.getrandbits(8), power=power)


def write_settings(channel: CoreChannel, random: Random) -> None:
    """Some settings of encoders and outputs; what is refused is not in force."""
    axis = random.randrange(channel.core.axes)
    encoder = encoder_address(channel, axis, r.ENCODER_SETUP)
    source = random.choice((SPINDLE, SPINDLE, random.randrange(8)))
    follow = follow_word(source, random.randrange(8), random.random() < 0.3)
    lowest = random.getrandbits(random.randrange(1, 24))
    writes: list[tuple[int, list[int]]] = [
        (encoder, [random.getrandbits(5) & ~1, RATIO_ONE, random.choice((4, 30, 0xFFFF))]),
        (channel.base + r.CHANNEL_FOLLOW, [random.choice((0, follow))]),
        (channel.base + r.CHANNEL_FOLLOW_LIMIT, [1 << random.randrange(20, 32)]),
        (channel.base + random.choice(SETTINGS), [lowest]),
        (channel.base + r.CHANNEL_OUTPUT_LAG, [random.choice((0, 1, 300))]),
        (channel.base + r.CHANNEL_COMPARE_PULSE, [random.randrange(100) | axis << 16, random.randrange(40)]),
    ]
    for address, words in writes:
        if random.random() < 0.4:
            with suppress(RefusedError):
                channel.link.write(address, *words)


@core_test
def random_events_match_the_model(core: Core) -> None:
    """Of all kinds, at the pins and over the link. Positions are the edges; no power without a motion."""
    random = rng("machine")
    events = RandomInputs(random, core.parameters)
    channel = core.channel()
    checker = core.watch(PinTiming())
    shafts = Shafts(core)
    for axis in (0, 1):
        shafts.follow_steps(axis, 1, 6, slip=random.choice((0, 50)))
    shafts.turn(SPINDLE, wander(random))
    core.link.write(r.ADDRESS_RUN, 1)
    causes = set()
    for _ in range(50):
        write_settings(channel, random)
        with suppress(RefusedError):
            channel.link.push(channel.base + r.CHANNEL_RASTER, [random.getrandbits(32) for _ in range(5)])
        with suppress(RefusedError):
            steps = tuple(random.randint(-40, 40) for _ in range(core.axes))
            line = Line(40, steps, endless=random.random() < 0.7)
            channel.lines(line, outputs=[some_output(random)])
            speed = ONE // random.randint(12, 60)
            channel.ramps(Ramp(speed, random.randint(0, 3)), Ramp(speed, 500))
        for _ in range(3):
            if random.random() < 0.4:
                with suppress(RefusedError):
                    core.link.write(*events.write())
            for _ in range(random.randrange(3)):
                core.set(*events.pin())
                core.run(random.randint(1, random.choice([3, 40, 1500])))
        state = channel.state()
        causes.add(state.cause)
        if state.state == State.STOPPED:
            core.run(200)
            assert channel.positions() == checker.positions
        if random.random() < 0.8:
            command = r.CHANNEL_COMMAND_CLEAR_LSB
        else:
            command = random.choice((r.CHANNEL_COMMAND_STOP_LSB, r.CHANNEL_COMMAND_ABORT_LSB))
        with suppress(RefusedError):
            core.link.write(channel.base + r.CHANNEL_COMMAND, 1 << command)
        core.link.read(channel.base + r.CHANNEL_TRIGGER_POSITION_BASE, core.axes)
        core.link.read(channel.base + r.CHANNEL_FOLLOW_STATE, 1)
        core.link.read(encoder_address(channel, 0, r.ENCODER_ERROR), 3)
        core.link.read(channel.base + r.CHANNEL_OUTPUT_STATE, 1)
    core.dut._log.info(f"causes: {', '.join(sorted(cause.name for cause in causes))}")
    assert {Cause.LIMIT, Cause.ALARM, Cause.ESTOP} <= causes
    check_power(core)
