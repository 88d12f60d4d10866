# SPDX-License-Identifier: MIT
"""A core of 8 axes with all parts: every setting, and every pin and register of every axis."""

from collections.abc import Sequence
from contextlib import suppress
from random import Random

from passo import registers as r
from passo.host import RATE_ONE
from passo.link import RefusedError
from passo.register_table import Register
from passo.registers import Cause, LineOutputWord, Operation, TriggerSource, Verdict

from cocotb_tests.core_inputs import arm, trigger_state
from cocotb_tests.core_outputs import levels_at
from cocotb_tests.core_trackers import Trackers
from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.core_bench import ONE, V_MAX, Core, CoreChannel, Line, PinTiming, Ramp, core_test
from cocotb_tests.helpers.core_frames import GAP, ack, request
from cocotb_tests.helpers.core_moves import check_stopped
from cocotb_tests.helpers.core_shaft import Shafts, encoder_address, error, follow_word, positions
from tests.test_register_table import GREATEST, NOT_0, every_register

FULL = LineOutputWord(raster=False, proportional=False, levels=0, power=0xFFFF)
RASTER = LineOutputWord(raster=True, proportional=False, levels=0, power=0)
RASTER_WORDS = 256  # in the queue
CHANGES = 256  # of the outputs that can wait for the lag
INPUT_PINS = ("limit_low", "limit_high", "home", "alarm")
OTHER_PINS = ("probe", "encoder_a", "encoder_b", "encoder_index")
SOURCES = (TriggerSource.LIMIT_LOW, TriggerSource.LIMIT_HIGH, TriggerSource.HOME, TriggerSource.INDEX)
# What starts something by itself; the times of the pins stay short, because a write of PINS waits for them.
COMMANDS = {"RUN", "CHANNEL_COMMAND", "CHANNEL_TRACKER_ENABLE"}
QUEUES = {"CHANNEL_LINE", "CHANNEL_RAMP", "CHANNEL_RASTER"}
TABLES = {"COSINE", "SIGMOID", "EASE"}
TIMES = {"AXIS_STEP_TIMING", "AXIS_DIR_TIMING"}
SHORT_TIMES = 0x003F003F
ZERO = 1 << r.CHANNEL_COMMAND_ZERO_LSB


def settings(core: Core) -> list[tuple[int, Register]]:
    """Address and register of all words that can be written and only set something."""
    others = COMMANDS | QUEUES | TABLES
    return [
        (address, register)
        for address, register in every_register(core.parameters)
        if "w" in register.access and register.name not in others
    ]


def legal(register: Register, word: int) -> int:
    """Of a random word, what the register takes."""
    if register.name == "CHANNEL_TRIGGER":
        return word & register.defined & ~7 | word % 5 + 1  # the source
    word &= register.defined
    greatest = GREATEST.get(register.name, word)
    if word > greatest:  # a power of 2
        word = greatest if word & 1 else word & greatest - 1
    return max(word, int(register.name in NOT_0))


def read_all(core: Core) -> None:
    """Read all registers that can be read, with what is between them; the model has the same words."""
    channel = core.channel()
    core.link.read(r.ADDRESS_IDENTIFICATION, 20)
    for first, count in ((r.CHANNEL_STATE, 4), (r.CHANNEL_INPUT_LEVELS, 8), (r.CHANNEL_OUTPUT_STATE, 32)):
        core.link.read(channel.base + first, count)
    core.link.read(channel.base + r.CHANNEL_FOLLOW_STATE, 13)
    for axis in range(core.axes):
        core.link.read(channel.axis_base(axis) + r.AXIS_LOST_STEPS, 1)
        core.link.read(encoder_address(channel, axis, r.ENCODER_ERROR), 3)


def stir(core: Core, random: Random) -> None:
    """Random levels at the pins, and a random motion if the settings allow one."""
    channel = core.channel()
    with suppress(RefusedError):
        channel.clear()
        size = random.choice((40, 300))
        lines = [Line(size, tuple(random.randint(-size, size) for _ in range(core.axes))) for _ in range(2)]
        channel.lines(*lines, outputs=[LineOutputWord(False, True, 0xA5, 40_000)])
        channel.ramps(Ramp(ONE // random.choice((3, 20)), 2), Ramp(ONE // 25, 30))
        channel.start()
    for _ in range(20):
        core.set(random.choice(INPUT_PINS), random.getrandbits(core.axes))
        pin = random.choice(OTHER_PINS)
        core.set(pin, random.getrandbits(1 if pin == "probe" else core.axes))
        core.run(random.randrange(1, 200))
    channel.abort()
    channel.rest()


def run_endless(channel: CoreChannel, speed: int, steps: int, *outputs: LineOutputWord) -> None:
    """Run a line until a stop, of 1000 substeps with these steps of all axes."""
    core = channel.core
    since = core.clock
    channel.lines(Line(1000, (steps,) * core.axes, endless=True), outputs=outputs)
    channel.ramps(Ramp(speed, 0), Ramp(speed, 60_000))
    channel.start()
    core.run_until(lambda: core.motions_begun(since), 2000)


@core_test
def every_setting_takes_every_bit(core: Core) -> None:
    """Words and their inverses; after each of them pins change, and all registers are read."""
    random = rng("most axes, settings")
    channel = core.channel()
    for is_random in (False, True):
        words = {address: random.getrandbits(32) for address, _ in settings(core)}
        if not is_random:
            words = dict.fromkeys(words, 0x55555555)
        for inverse in (0, 0xFFFFFFFF):
            for address, register in settings(core):
                word = legal(register, words[address] ^ inverse)
                try:
                    core.link.write(address, word)
                except RefusedError:  # not quiet: the pins of an axis have changed
                    core.run_until(lambda: channel.state().quiet, 3000)
                    core.link.write(address, word)
                if register.name in TIMES:
                    core.link.write(address, word & SHORT_TIMES)
            stir(core, random)
            read_all(core)
    core.link.write(r.ADDRESS_WATCHDOG, 0)


@core_test
def every_input_has_its_bit_and_fires_the_trigger(core: Core) -> None:
    """Of its axis and kind alone: level and flag, and as the source of the trigger. An alarm is named."""
    channel = core.channel()
    channel.clear()
    core.link.write(channel.base + r.CHANNEL_INPUT_CLEAR, 0xFFFFFFFF)
    for kind, name in enumerate(INPUT_PINS):
        for axis in range(core.axes):
            bit = 1 << 8 * kind + axis
            if name != "alarm":
                arm(channel, SOURCES[kind], axis=axis)
                core.run(20)
            core.set(name, 1 << axis)
            core.run(20)
            assert core.link.read(channel.base + r.CHANNEL_INPUT_LEVELS, 2) == [bit, bit]
            if name == "alarm":
                assert channel.state().cause == Cause.ALARM and trigger_state(channel).axes == 1 << axis
            else:
                assert trigger_state(channel).fired
            core.set(name, 0)
            core.run(20)
            channel.clear()
            assert core.link.read(channel.base + r.CHANNEL_INPUT_LEVELS, 2) == [0, bit]
            core.link.write(channel.base + r.CHANNEL_INPUT_CLEAR, bit)
            assert core.link.read(channel.base + r.CHANNEL_INPUT_FLAGS, 1) == [0]
    for axis in range(core.axes):
        arm(channel, TriggerSource.INDEX, axis=axis)
        for index, fired in ((1 << core.axes) - 1 & ~(1 << axis), False), (1 << axis, True):
            core.set("encoder_index", index)
            core.run(20)
            assert trigger_state(channel).fired == fired
            core.set("encoder_index", 0)


@core_test
def the_longest_filter_ignores_what_is_no_longer(core: Core) -> None:
    """A level of 65535 clocks does not fire the trigger, one of 65536 does."""
    channel = core.channel()
    longest = 0xFFFF
    core.link.write(r.ADDRESS_INPUT_FILTER, longest)
    arm(channel, TriggerSource.HOME, axis=core.axes - 1)
    core.run(longest + 100)
    assert trigger_state(channel).armed
    for clocks, fired in ((longest, False), (longest + 1, True)):
        core.set("home", 1 << core.axes - 1)
        core.run(clocks)
        core.set("home", 0)
        core.run(100)
        assert trigger_state(channel).fired == fired
    core.link.write(r.ADDRESS_INPUT_FILTER, 0)


def turn_all(core: Core, shafts: Shafts, clocks: int, moves: Sequence[int]) -> None:
    """Turn all shafts by these counts, a move every few clocks."""
    for axis in range(core.axes):
        shafts.turn(axis, [(clocks, move) for move in moves])
    core.run(clocks * len(moves) + 20)


@core_test
def every_encoder_counts_for_its_axis(core: Core) -> None:
    """Up and down, inverted or not; simultaneous changes of A and B up to 255; a following error each way."""
    channel = core.channel()
    channel.link.write(channel.base + r.CHANNEL_STOP_SLEW, RATE_ONE)
    shafts = Shafts(core)
    addresses = [encoder_address(channel, axis, r.ENCODER_SETUP) for axis in range(core.axes)]
    for axis in range(1, core.axes, 2):
        channel.link.write(addresses[axis], r.EncoderSetupWord(inverted=True).pack())
    turn_all(core, shafts, 6, [1] * 100 + [-1] * 30)
    signs = [-1 if axis % 2 else 1 for axis in range(core.axes)]
    assert positions(channel) == [70 * sign for sign in signs]
    assert [error(channel, axis) for axis in range(core.axes)] == [-70 * sign for sign in signs]
    turn_all(core, shafts, 6, [2] * 260)
    for axis in range(core.axes):
        (word,) = channel.link.read(encoder_address(channel, axis, r.ENCODER_INDEX), 1)
        assert r.EncoderIndexWord.unpack(word).illegal == 255
    for axis, sign in enumerate(signs):
        for stop in ({"stop_soft": True}, {"stop_hard": True}):
            channel.link.write(channel.base + r.CHANNEL_COMMAND, ZERO)
            channel.clear()
            setup = r.EncoderSetupWord(inverted=sign < 0, **stop).pack()
            channel.link.write(addresses[axis], setup, 1 << 16, 9)
            run_endless(channel, ONE // 10, 0)
            shafts.turn(axis, [(6, sign)] * 9)
            core.run(70)
            assert channel.state().cause == Cause.NONE
            shafts.turn(axis, [(6, sign)])
            core.run(50)
            assert channel.state().cause == Cause.FOLLOWING_ERROR and error(channel, axis) == -10
            channel.link.write(addresses[axis], r.EncoderSetupWord(inverted=sign < 0).pack())
            channel.link.write(channel.base + r.CHANNEL_COMMAND, ZERO)
            channel.clear()


@core_test
def the_greatest_error_is_two_steps_and_a_count(core: Core) -> None:
    """At the greatest ratio, with a count on the clock of the second step; earlier it saturates.

    Of each axis the encoder counts down on another clock.
    """
    channel = core.channel()
    core.link.write(channel.base + r.CHANNEL_ENCODER_FILTER, 0)
    shafts = Shafts(core)

    def two_steps() -> int:
        """Make them; return the clocks from the edge of sync to the second one."""
        core.link.write(channel.base + r.CHANNEL_COMMAND, ZERO)
        channel.lines(Line(2, (2,) * core.axes, last=True))
        channel.ramps(Ramp(ONE // 300, 0), Ramp(ONE // 300, 6, last=True))
        core.link.write(r.ADDRESS_RUN, 1 << r.RUN_WAIT_SYNC_LSB | 1)
        core.run(300)
        core.sync(True)
        for axis, offset in enumerate(counts_at):
            shafts.turn(axis, [(offset, -1)])
        started = core.started
        core.wait_end()
        core.sync(False)
        return core.steps(0, started)[1] - started

    counts_at: list[int] = []
    second = two_steps()
    for axis in range(core.axes):
        channel.link.write(encoder_address(channel, axis, r.ENCODER_RATIO), 0xFFFFFFFF)
    counts_at = [second - 9 + axis for axis in range(core.axes)]
    two_steps()
    words = [
        channel.link.read(encoder_address(channel, axis, r.ENCODER_GREATEST), 1)[0]
        for axis in range(core.axes)
    ]
    greatest = [r.EncoderGreatestWord.unpack(word).greatest for word in words]
    early = greatest.count(0x10000)
    assert 0 < early < core.axes - 1
    assert greatest == [0x10000] * early + [0x20000] + [0x1FFFF] * (core.axes - 1 - early)


@core_test
def any_encoder_can_be_followed_at_any_scale(core: Core) -> None:
    """What is owed is the counts of that encoder times 2^scale, less the first clock."""
    channel = core.channel()
    shafts = Shafts(core)
    counts = 5
    for source in range(core.axes):
        scale = core.axes - 1 - source
        channel.link.write(channel.base + r.CHANNEL_FOLLOW, follow_word(source, scale), 1)
        run_endless(channel, ONE // 10, 1000)
        for axis in range(core.axes):
            shafts.turn(axis, [(6, 1 if axis == source else -1)] * counts)
        core.run(6 * counts + 50)
        (word,) = channel.link.read(channel.base + r.CHANNEL_FOLLOW_STATE, 1)
        state = r.ChannelFollowStateWord.unpack(word)
        assert (state.owed, state.behind, state.lost) == ((counts << scale) - 1, True, False)
        channel.abort()
        channel.rest()
        channel.clear()
    channel.link.write(channel.base + r.CHANNEL_FOLLOW, 0)


@core_test
def a_motion_with_encoders_stalls_and_drains(core: Core) -> None:
    """Ramps without ticks take longer than a tick; what the line lacks is drained. It follows or not."""
    channel = core.channel()
    core.watch(PinTiming())
    shafts = Shafts(core)
    source = core.axes - 1
    shafts.turn(source, ((20, 1) for _ in range(3000)))
    substeps, lacking = 200, 60
    velocity = ONE * (substeps - lacking) // (4 * core.tick)
    ramps = [Ramp(velocity + n, 0) for n in range(12)]
    for turn, follow in enumerate((follow_word(source, scale=7), 0), 1):
        channel.rest()
        channel.link.write(channel.base + r.CHANNEL_FOLLOW, follow, 1 << 31)
        channel.lines(Line(substeps, (substeps,) * core.axes, last=True))
        channel.ramps(Ramp(velocity, 0), Ramp(velocity, 2), *ramps, Ramp(velocity, 2), Ramp(0, 0, last=True))
        channel.start()
        core.wait_end(limit=200_000)
        state = channel.state()
        assert abs(state.drained - turn * lacking) <= turn and state.cause == Cause.NONE
        assert channel.positions() == [turn * substeps] * core.axes


@core_test
def a_limit_stops_its_axis(core: Core) -> None:
    """Each switch only in its direction, and it is named."""
    channel = core.channel()
    core.watch(PinTiming())
    for axis in range(core.axes):
        for name, way in (("limit_low", -1), ("limit_high", 1)):
            core.set(name, 1 << axis)
            core.run(20)
            run_endless(channel, ONE // 10, -way * 1000)
            core.run(100)
            assert channel.state().cause == Cause.NONE
            channel.abort()
            channel.rest()
            channel.clear()
            run_endless(channel, ONE // 10, way * 1000)
            core.run(100)
            assert channel.state().cause == Cause.LIMIT and trigger_state(channel).axes == 1 << axis
            assert channel.positions() == core.checker.positions
            core.set(name, 0)
            core.run(20)
            channel.rest()
            channel.clear()


@core_test
def a_line_can_have_any_steps_of_every_axis(core: Core) -> None:
    """Of 2^30 - 1 substeps: each axis steps in its share, of which each bit is 0 and 1."""
    channel = core.channel()
    core.watch(PinTiming())
    most, pattern = (1 << 30) - 1, 0x15555555
    for turn in range(4):
        before = channel.positions()
        steps = tuple(pattern << (axis + turn) % 2 for axis in range(core.axes))
        channel.lines(Line(most, steps, endless=True))
        channel.ramps(Ramp(V_MAX, 0), Ramp(V_MAX, 8), Ramp(0, 0, last=True))
        channel.start()
        core.wait_end()
        channel.rest()
        made = [after - b for after, b in zip(channel.positions(), before, strict=True)]
        substeps = 4 * core.tick
        expected = [(n * substeps + most // 2) // most for n in steps]
        assert made == expected


@core_test
def compare_takes_the_steps_of_any_axis(core: Core) -> None:
    """In both directions: a pulse at every third step of its axis, and of no other."""
    channel = core.channel()
    core.watch(PinTiming())
    for axis in range(core.axes):
        for way in (1, -1):
            channel.rest()
            words = (axis << 16 | 2, 3 * way % (1 << 32), 3 * way % (1 << 32))
            core.link.write(channel.base + r.CHANNEL_COMPARE_PULSE, *words)
            since = core.clock
            steps = tuple(way * 30 if n == axis else 25 * (n + axis & 1) for n in range(core.axes))
            channel.lines(Line(30, steps, last=True))
            channel.ramps(Ramp(ONE // 10, 0), Ramp(ONE // 10, 3), Ramp(0, 0, last=True))
            channel.start()
            core.wait_end()
            rises = [clock for clock, level in core.changes("compare", 0, since) if level]
            assert rises == core.steps(axis, since)[2::3] and len(rises) == 10


@core_test
def every_tracker_has_its_axis_and_its_bits(core: Core) -> None:
    """Each alone moves its axis there and back, then all together; TRACKER_STATE shows it."""
    channel = core.channel()
    core.watch(PinTiming())
    channel.pins(PinTiming())
    trackers = Trackers(channel)
    every = (1 << core.axes) - 1
    for axis in range(core.axes):
        trackers.limit(axis, ONE >> 17, ONE >> 18)
    for axes in (*(1 << axis for axis in range(core.axes)), every):
        for steps in (3, 0):
            goal = [steps * (axis + 1) * (axes >> axis & 1) for axis in range(core.axes)]
            trackers.go(*goal)
            trackers.enable(axes)
            core.run(2 * trackers.tick)
            state = trackers.state()
            assert (state.enabled, state.moves, state.at_target) == (axes, axes, every & ~axes)
            trackers.wait()
            assert trackers.state().at_target == every and trackers.state().moves == 0
            assert trackers.positions() == channel.positions() == goal
            trackers.enable(0)


@core_test
def a_new_acceleration_is_the_one_that_moves(core: Core) -> None:
    """Also if a motion that waited for its inputs begins right behind it, and with it a tracker."""
    channel = core.channel()
    core.watch(PinTiming())
    channel.pins(PinTiming())
    trackers = Trackers(channel)
    random, limits = rng("a new acceleration"), (40 << 20, 12 << 20)
    trackers.limit(0, 1 << 30, limits[0])
    trackers.enable(1)
    targets = (r.CHANNEL_TRACKER_TARGET_DOWN_BASE, r.CHANNEL_TRACKER_TARGET_BASE)
    filter_clocks, way, place = 1200, 0, 0
    margins: list[int] = []
    for number in range(16):
        up = number % 2
        way += 24 if up else -24
        place += 2
        channel.link.write(channel.base + targets[up], place)
        channel.rest()
        line = Line(240, (24 if up else -24, *[0] * (core.axes - 1)), last=True)
        channel.lines(line, outputs=[LineOutputWord(False, False, 0, 0)])
        channel.ramps(Ramp(ONE // 16, 0), Ramp(ONE // 16, 31), Ramp(0, 0, last=True))
        core.run(random.randrange(2 * trackers.tick))
        core.link.write(r.ADDRESS_INPUT_FILTER, filter_clocks)  # unknown for twice as long
        unknown = core.clock
        channel.start()
        # the motion begins when the write lets it, or up to 100 clocks later
        core.run(max(0, unknown + 2 * filter_clocks - 700 - 12 * number - core.clock))
        channel.link.write(channel.axis_base(0) + r.AXIS_TRACKER_ACCELERATION, limits[1 - up])
        written = core.clock
        core.wait_end()
        margins.append(core.began() - written)
        trackers.wait(20_000)  # it does not come back from far away
        assert trackers.positions()[0] == place, margins
        assert channel.positions()[0] == way + place
    assert max(margins) > min(margins) + 64


@core_test
def a_tracker_too_fast_for_its_pins_is_an_overrun(core: Core) -> None:
    """On any axis: some steps wait, then one is lost; the channel is STOPPED, and the axis is named."""
    channel = core.channel()
    trackers = Trackers(channel)
    timing = PinTiming(1500, 1500, 1, 1)
    core.watch(timing)
    channel.pins(timing)
    for axis in (0, core.axes - 1):
        trackers.limit(axis, ONE - 1 >> 16, ONE >> 17)
        goal = [100 if n == axis else 0 for n in range(core.axes)]
        trackers.go(*goal)
        trackers.enable(1 << axis)
        core.run_until(lambda: core.dut.irq.value == 1, 40_000)
        core.run(6 * 3000)
        check_stopped(core, channel, Cause.STEP_OVERRUN)
        assert channel.state().overrun == 1 << axis
        assert core.link.read(channel.axis_base(axis) + r.AXIS_LOST_STEPS, 1) == [1]
        channel.clear()
        channel.link.write(channel.base + r.CHANNEL_COMMAND, ZERO)
        core.watch(timing)
        core.run(2 * trackers.tick)
    channel.pins(PinTiming())


@core_test
def every_axis_can_overrun(core: Core) -> None:
    """All simultaneously, and each counts what it has lost."""
    channel = core.channel()
    timing = PinTiming(3, 2, 1, 1)
    channel.pins(timing)
    core.watch(timing)
    channel.lines(Line(3000, tuple(3000 * (-1) ** axis for axis in range(core.axes)), last=True))
    channel.ramps(Ramp(V_MAX, 0), Ramp(V_MAX, 100), Ramp(0, 0, last=True))
    channel.start()
    core.run_until(lambda: core.dut.irq.value == 1, 10_000)
    check_stopped(core, channel, Cause.STEP_OVERRUN)
    assert channel.state().overrun == (1 << core.axes) - 1
    for axis in range(core.axes):
        assert core.link.read(channel.axis_base(axis) + r.AXIS_LOST_STEPS, 1) == [2]
    channel.clear()
    assert channel.state().overrun == 0
    channel.pins(PinTiming())


def output_state(channel: CoreChannel) -> r.ChannelOutputStateWord:
    """Read OUTPUT_STATE."""
    (word,) = channel.link.read(channel.base + r.CHANNEL_OUTPUT_STATE, 1)
    return r.ChannelOutputStateWord.unpack(word)


def push_raster(channel: CoreChannel, words: Sequence[int]) -> None:
    """Push raster words, as many to a frame as fit."""
    for n in range(0, len(words), 60):
        channel.link.push(channel.base + r.CHANNEL_RASTER, words[n : n + 60])


@core_test
def a_raster_queue_is_filled_while_it_runs(core: Core) -> None:
    """More words than it has places, all used in order; a stop empties it. Too long a frame is refused."""
    random = rng("most axes, raster")
    channel = core.channel()
    core.watch(PinTiming())
    more = 120
    words = [random.choice((0, 0xFF, 0xFF00, 0xFFFFFFFF)) for _ in range(RASTER_WORDS + more)]
    since = core.clock
    longest = request(Operation.PUSH, 0x77, 255, channel.base + r.CHANNEL_RASTER, [0] * 255)
    assert ack(core.transfer(longest, GAP)) == (0x77, Verdict.BAD_LENGTH)
    push_raster(channel, words[:RASTER_WORDS])
    assert output_state(channel).raster_room == 0
    run_endless(channel, ONE // 40, 1000, RASTER)
    core.run(more * 4 * 40)
    push_raster(channel, words[RASTER_WORDS:])
    core.run_until(lambda: len(core.steps(0, since)) > 4 * len(words), 100_000, 512)
    assert output_state(channel).raster_empty
    values = [word >> shift & 0xFF for word in words for shift in (0, 8, 16, 24)]
    steps = core.steps(0, since)[: len(values)]
    assert levels_at(core, "power", 0, since, steps) == [value // 255 for value in values]
    channel.abort()
    assert output_state(channel).raster_room == RASTER_WORDS
    channel.clear()


@core_test
def a_change_too_many_is_an_overflow(core: Core) -> None:
    """With the longest lag, the values of a raster fill the queue of changes: no power until CLEAR.

    A line with power has it after the lag.
    """
    channel = core.channel()
    core.watch(PinTiming())
    longest = 0xFFFF
    core.link.write(channel.base + r.CHANNEL_OUTPUT_LAG, longest)
    push_raster(channel, [0xFFFFFFFF] * (CHANGES // 4 + 1))
    for output in (FULL, RASTER):
        since = core.clock
        run_endless(channel, ONE // 20, 1000, output)
        core.run(longest + 1000)
        overflows = output is RASTER
        assert output_state(channel).overflow == overflows
        changes = core.changes("power", 0, since)
        assert changes == ([] if overflows else [(core.steps(0, since)[0] + longest, 1)])
        channel.abort()
        channel.rest()
        channel.clear()
        assert not output_state(channel).overflow
        push_raster(channel, [0xFFFFFFFF] * (CHANGES // 4 + 1))
