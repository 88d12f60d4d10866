# SPDX-License-Identifier: MIT
"""passo_axis: pin timings, queue, directions, counters."""

from collections.abc import Sequence
from dataclasses import replace
from random import Random

import cocotb
import pytest
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, Recorder, read
from passo.cocotb.pulses import PinTiming, PulseChecker

from cocotb_tests.helpers.bench import begin, patience, rng
from cocotb_tests.helpers.runner import run

LATENCY = 3  # step_request to STEP, direction to DIR
QUEUE = 4
LOST_MAX = 15

INPUTS = (
    "step_request",
    "pins_written",
    "direction",
    "drop",
    "closed_low",
    "closed_high",
    "clear",
    "timing_written",
    "both_edges",
    "step_inverted",
    "direction_inverted",
    "enable",
    "enable_inverted",
)

Request = tuple[int, int]  # clock, direction: 1 or -1


@pytest.mark.sample(1)
def test_axis(simulator: str) -> None:
    run(__name__, "passo_axis_top", simulator=simulator)


def expected_steps(
    timing: PinTiming, requests: Sequence[Request], direction: int
) -> tuple[list[Request], list[int]]:
    """Reference: steps as early as the pin timing allows, and the clocks of requests to a full queue.

    DIR has `direction` initially, and the direction of the line is always that of the last request. Clocks
    are those at the pins: a request and a change of the line's direction reach them after LATENCY, and a step
    leaves the queue one clock before it is seen.
    """
    steps: list[Request] = []
    lost: list[int] = []
    waiting: list[Request] = []
    coming = list(requests)
    line = [(clock + LATENCY, wanted) for clock, wanted in requests]
    line_direction = direction
    active = False
    step_free = turn_free = set_up = 0
    clock = requests[0][0]
    while coming or waiting:
        clock += 1
        while line and line[0][0] <= clock:
            line_direction = line.pop(0)[1]
        ready = bool(waiting) and waiting[0][0] + LATENCY <= clock
        wanted = waiting[0][1] if ready else line_direction
        if wanted != direction:
            if clock >= turn_free:
                direction, set_up = wanted, clock + max(1, timing.setup)
        elif ready and clock >= step_free and clock >= set_up:
            waiting.pop(0)
            steps.append((clock, direction))
            active = not active
            step_free = clock + (timing.level(active) if timing.both_edges else timing.busy)
            turn_free = step_free + max(1, timing.hold)
        while coming and coming[0][0] == clock - 1:
            request = coming.pop(0)
            if len(waiting) == QUEUE:
                lost.append(request[0])
            else:
                waiting.append(request)
    return steps, lost


def set_time(dut: HierarchyObject, name: str, clocks: int) -> None:
    """Set one of the four times; 0 counts as 1."""
    getattr(dut, name).value = max(1, clocks)


def apply(dut: HierarchyObject, timing: PinTiming) -> None:
    """Set all settings."""
    set_time(dut, "step_high", timing.high)
    set_time(dut, "step_low", timing.low)
    set_time(dut, "dir_setup", timing.setup)
    set_time(dut, "dir_hold", timing.hold)
    dut.both_edges.value = timing.both_edges
    dut.step_inverted.value = timing.step_inverted
    dut.direction_inverted.value = timing.direction_inverted


async def write(dut: HierarchyObject, clocks: Clocks, timing: PinTiming) -> None:
    """Write pins and timings as the registers do: they change one clock after the strobe."""
    dut.pins_written.value = 1
    dut.both_edges_next.value = timing.both_edges
    await clocks.wait(1)
    dut.pins_written.value = 0
    apply(dut, timing)
    await clocks.wait(1)
    while not read(dut.quiet):
        await clocks.wait(1)


async def prepare(dut: HierarchyObject, timing: PinTiming) -> Clocks:
    """Reset with these settings; the pins are idle."""
    apply(dut, PinTiming())
    clocks = await begin(dut, *INPUTS)
    while not read(dut.quiet):
        await clocks.wait(1)
    await write(dut, clocks, timing)
    return clocks


class Axis:
    """The module under test with its pins watched."""

    def __init__(self, dut: HierarchyObject, clocks: Clocks, timing: PinTiming) -> None:
        self.dut, self.clocks, self.timing = dut, clocks, timing
        self.overruns = Recorder(clocks, dut.overrun)
        self.made = Recorder(clocks, dut.step_made)
        self.directions = Recorder(clocks, dut.step_direction)
        self.checker = PulseChecker(clocks, dut.step_pin, dut.dir_pin, [timing])

    @classmethod
    async def begin(cls, dut: HierarchyObject, timing: PinTiming) -> "Axis":
        """Reset with these settings in force."""
        return cls(dut, await prepare(dut, timing), timing)

    async def set_timing(self, timing: PinTiming) -> None:
        """Change the settings while the axis is idle."""
        self.timing = timing
        await write(self.dut, self.clocks, timing)
        self.checker.set_timing(0, timing)

    async def request(self, requests: Sequence[Request]) -> None:
        """Make step requests; the direction of the line is that of the last one."""
        negative: int | None = None
        for clock, direction in requests:
            if self.clocks.now < clock:
                self.dut.step_request.value = 0
                await self.clocks.until(clock)
            if negative != (direction < 0):
                negative = direction < 0
                self.dut.direction.value = negative
            self.dut.step_request.value = 1
            await self.clocks.fall
        self.dut.step_request.value = 0

    async def request_and_compare(self, requests: Sequence[Request]) -> None:
        """Make step requests and compare all edges of the pins with the reference."""
        before = len(self.checker.steps())
        steps, lost = expected_steps(self.timing, requests, self.checker.direction())
        await self.request(requests)
        settle = sum(
            max(1, t) for t in (self.timing.high, self.timing.low, self.timing.hold, self.timing.setup)
        )
        await self.clocks.until(max(steps[-1][0], requests[-1][0]) + settle + 5)
        made = self.checker.steps()[before:]
        assert made == steps, first_difference(made, steps)
        overruns = self.overruns.clocks_where(bool, self.clocks.now)
        assert [clock for clock in overruns if clock > requests[0][0]] == [clock + 1 for clock in lost]
        assert self.counted()[before:] == steps

    def counted(self) -> list[Request]:
        """The steps that the axis counts, by the clock on which they leave the pin."""
        counted: list[Request] = []
        for clock in self.made.clocks_where(bool, self.clocks.now):
            negative = next((n for since, n in reversed(self.directions.changes) if since <= clock), 0)
            counted.append((clock + 1, -1 if negative else 1))
        return counted


def first_difference(actual: Sequence[Request], expected: Sequence[Request]) -> str:
    """The first difference between two lists of steps."""
    for n, (a, e) in enumerate(zip(actual, expected, strict=False)):
        if a != e:
            return f"step {n}: expected {e}, actual {a}"
    return f"expected {len(expected)} steps, actual {len(actual)}"


@cocotb.test()
async def a_step_leaves_the_pin_after_three_clocks(dut: HierarchyObject) -> None:
    """STEP rises 3 clocks after the request, and the step is counted on the same clock."""
    axis = await Axis.begin(dut, PinTiming(high=4, low=2, setup=3, hold=5))
    for direction in (1, -1, -1, 1):
        await axis.clocks.wait(30)
        dut.direction.value = direction < 0
        await axis.clocks.wait(30)
        now = axis.clocks.now
        await axis.request_and_compare([(now, direction)])
        assert axis.checker.steps()[-1] == (now + LATENCY, direction)
    dut._log.info(axis.checker.finish())


@cocotb.test()
async def one_and_one_gives_a_step_every_two_clocks(dut: HierarchyObject) -> None:
    """2000 steps at the highest rate: all made, each with the same latency."""
    axis = await Axis.begin(dut, PinTiming())
    first = axis.clocks.now
    await axis.request_and_compare([(first + 2 * n, 1) for n in range(2000)])
    assert axis.checker.steps() == [(first + 2 * n + LATENCY, 1) for n in range(2000)]
    assert axis.checker.turns() == 0
    dut._log.info(axis.checker.finish())


@cocotb.test()
@cocotb.parametrize(
    timing=[
        PinTiming(0, 0, 0, 0),
        PinTiming(7, 1, 1, 1),
        PinTiming(1, 7, 1, 1),
        PinTiming(1, 1, 7, 1),
        PinTiming(1, 1, 1, 7),
        PinTiming(2, 2, 2, 2),
        PinTiming(3, 4, 5, 6),
        PinTiming(300, 257, 512, 1024),
        PinTiming(3, 5, 4, 2, both_edges=True),
        PinTiming(1, 1, 1, 1, both_edges=True),
        PinTiming(9, 2, 1, 30, both_edges=True),
    ]
)
async def bursts_and_reversals_take_exactly_the_set_times(dut: HierarchyObject, timing: PinTiming) -> None:
    """Queued steps follow as early as the four times allow, in the same and in the other direction."""
    axis = await Axis.begin(dut, timing)
    for directions in ([1, 1, 1, 1], [1, 1, -1, -1], [1, -1, 1, -1], [-1, 1, 1, -1], [-1, -1, -1, -1]):
        now = axis.clocks.now
        await axis.request_and_compare([(now + n, d) for n, d in enumerate(directions)])
    dut._log.info(axis.checker.finish())


@cocotb.test()
async def the_longest_times_are_kept(dut: HierarchyObject) -> None:
    """Each of the four times can be 65535."""
    axis = await Axis.begin(dut, PinTiming(65535, 1, 1, 1))
    for name in ("high", "low", "setup", "hold")[: patience(4, 1)]:
        await axis.set_timing(replace(PinTiming(), **{name: 65535}))
        direction = -1 if len(axis.checker.steps()) % 4 == 0 else 1
        now = axis.clocks.now
        # the second step waits for all four times
        await axis.request_and_compare([(now, -direction), (now + 1, direction)])
    dut._log.info(axis.checker.finish())


@cocotb.test()
async def the_fifth_waiting_step_is_an_overrun(dut: HierarchyObject) -> None:
    """Four steps are queued with their directions; each further one raises overrun once and is dropped."""
    axis = await Axis.begin(dut, PinTiming(high=50, low=20, setup=5, hold=9))
    now = axis.clocks.now
    directions = [1, -1, -1, 1, 1, -1, 1, -1]  # the first is under way when the fifth is to wait
    await axis.request_and_compare([(now, 1)] + [(now + 3 + n, d) for n, d in enumerate(directions)])
    assert [d for _, d in axis.checker.steps()] == [1, 1, -1, -1, 1]
    assert len(axis.overruns.clocks_where(bool, axis.clocks.now)) == 4
    assert read(dut.lost) == 4
    dut._log.info(axis.checker.finish())


@cocotb.test()
async def dir_follows_the_line_while_nothing_waits(dut: HierarchyObject) -> None:
    """DIR follows a new line immediately, so its first step is not late; a queued step goes first."""
    timing = PinTiming(high=6, low=4, setup=20, hold=10)
    axis = await Axis.begin(dut, timing)
    turned = Recorder(axis.clocks, dut.dir_pin)
    now = axis.clocks.now
    dut.direction.value = 1
    await axis.clocks.until(now + 20)
    assert turned.changes == [(now + LATENCY, 1)]
    await axis.request([(axis.clocks.now, -1)])
    assert len(axis.checker.steps()) == 0
    await axis.clocks.wait(3)
    assert axis.checker.steps() == [(now + 20 + LATENCY, -1)]

    # a step of the old line waits when the direction of the line changes
    await axis.clocks.wait(40)
    now = axis.clocks.now
    await axis.request([(now, -1), (now + 1, -1)])
    dut.direction.value = 0
    await axis.clocks.wait(60)
    first = now + LATENCY
    assert axis.checker.steps()[1:] == [(first, -1), (first + timing.busy, -1)]
    assert turned.changes[1:] == [(first + 2 * timing.busy + timing.hold, 0)]
    dut._log.info(axis.checker.finish())


@cocotb.test()
async def drop_forgets_what_waits_and_finishes_the_pulse(dut: HierarchyObject) -> None:
    """After drop no further step is made, and a pulse in progress keeps its length."""
    axis = await Axis.begin(dut, PinTiming(high=30, low=10, setup=5, hold=5))
    for at in range(6):
        now = axis.clocks.now
        before = len(axis.checker.steps())
        await axis.request([(now + n, 1) for n in range(4)])
        await axis.clocks.until(now + 10 + at * 9)
        dut.drop.value = 1
        await axis.clocks.wait(1)
        dut.drop.value = 0
        await axis.clocks.wait(200)
        made = len(axis.checker.steps()) - before
        assert made == (1 if 10 + at * 9 < 30 + 10 + 1 else 2), (
            f"drop {10 + at * 9} clocks after the first request"
        )
    assert axis.counted() == axis.checker.steps()
    dut._log.info(axis.checker.finish())


@cocotb.test()
async def polarities_invert_only_the_pins(dut: HierarchyObject) -> None:
    """Inverted pins have the same edges with inverted levels; EN follows its two bits."""
    for step_inverted in (False, True):
        for direction_inverted in (False, True):
            timing = PinTiming(3, 2, 4, 5, step_inverted=step_inverted, direction_inverted=direction_inverted)
            axis = await Axis.begin(dut, timing)
            assert (read(dut.step_pin), read(dut.dir_pin)) == (step_inverted, direction_inverted)
            now = axis.clocks.now
            await axis.request_and_compare([(now, 1), (now + 1, -1), (now + 2, -1), (now + 40, 1)])
            axis.checker.finish()
            axis.clocks.stop()
    apply(dut, PinTiming())
    clocks = await begin(dut, *INPUTS)
    for enable, inverted in ((1, 0), (1, 1), (0, 1), (0, 0)):
        dut.enable.value = enable
        dut.enable_inverted.value = inverted
        await clocks.wait(2)
        assert read(dut.enable_pin) == enable ^ inverted


@cocotb.test()
async def lost_steps_are_counted_up_to_15(dut: HierarchyObject) -> None:
    """The count stays at 15, and `clear` sets it to 0."""
    axis = await Axis.begin(dut, PinTiming(high=100))
    first = axis.clocks.now
    for count in range(20):
        await axis.request([(first + n + 2 * count, 1) for n in range(7 if count == 0 else 1)])
        await axis.clocks.wait(1)
        if count:
            assert read(dut.lost) == min(LOST_MAX, read_lost(axis))
    assert read(dut.lost) == LOST_MAX
    dut.clear.value = 1
    await axis.clocks.wait(1)
    dut.clear.value = 0
    await axis.clocks.wait(1)
    assert read(dut.lost) == 0


def read_lost(axis: Axis) -> int:
    """Overruns so far that have been counted."""
    return len(axis.overruns.clocks_where(bool, axis.clocks.now - 1))


@cocotb.test()
@cocotb.parametrize(high=[0, 1, 2, 8, 70])
async def a_time_that_is_written_begins_anew(dut: HierarchyObject, high: int) -> None:
    """step_high written at any clock of a pulse: STEP stays active for the new time from then on."""
    clocks = await prepare(dut, PinTiming())
    for at in range(LATENCY - 1, LATENCY + 17):
        set_time(dut, "step_high", 20)
        pins = Recorder(clocks, dut.step_pin)
        now = clocks.now
        dut.step_request.value = 1
        await clocks.fall
        dut.step_request.value = 0
        await clocks.until(now + at)
        dut.timing_written.value = 1
        await clocks.fall
        dut.timing_written.value = 0
        set_time(dut, "step_high", high)
        await clocks.wait(150)
        # the time begins with the third clock after the write; the pin follows a clock later
        assert pins.changes == [(now + LATENCY, 1), (now + at + 4 + max(1, high), 0)]
        pins.stop()


@cocotb.test()
@cocotb.parametrize(
    before=[PinTiming(), PinTiming(3, 2, 1, 1, both_edges=True)],
    after=[
        PinTiming(2, 1, 9, 1, direction_inverted=True),
        PinTiming(2, 7, 1, 1, step_inverted=True),
        PinTiming(1, 5, 3, 2, both_edges=True, step_inverted=True, direction_inverted=True),
    ],
)
async def a_change_of_polarity_is_a_change_of_dir(
    dut: HierarchyObject, before: PinTiming, after: PinTiming
) -> None:
    """After the write, low time, DIR hold and DIR setup elapse before the next step."""
    for steps in (1, 2):
        for at in range(2, 30):
            axis = await Axis.begin(dut, before)
            await axis.request([(axis.clocks.now + 5 * n, 1) for n in range(steps)])
            await axis.clocks.wait(40)
            assert read(dut.quiet)
            step_pin = read(dut.step_pin)
            axis.checker.finish()
            dut.pins_written.value = 1
            dut.both_edges_next.value = after.both_edges
            written = axis.clocks.now
            made, pin = Recorder(axis.clocks, dut.step_made), Recorder(axis.clocks, dut.step_pin)
            await axis.clocks.fall
            dut.pins_written.value = 0
            apply(dut, after)
            await axis.request([(written + at, 1)])
            await axis.clocks.wait(60)
            (step, _), _ = made.changes
            # STEP takes its new level immediately, if it differs
            assert len([clock for clock, _ in pin.changes if clock < step]) <= 1
            # both pins have followed three clocks after the strobe at the latest
            busy = max(1, after.low if not (after.both_edges and steps % 2) else after.high)
            assert step + 1 - (written + 2) >= max(busy, max(1, after.setup)), (step, written)
            assert step + 1 - (written + 3) <= busy + max(1, after.hold) + max(1, after.setup) + at + 4
            # with single edges STEP is inactive again, whatever it was
            level = read(dut.step_pin) ^ after.step_inverted
            assert level == (0 if not after.both_edges else (steps * before.both_edges + 1) % 2), step_pin
            made.stop()
            pin.stop()


@cocotb.test()
@cocotb.parametrize(
    timing=[
        PinTiming(6, 3, 4, 5),
        PinTiming(6, 3, 4, 5, step_inverted=True, direction_inverted=True),
        PinTiming(6, 3, 4, 5, both_edges=True),
    ]
)
async def a_reset_makes_no_edge(dut: HierarchyObject, timing: PinTiming) -> None:
    """At any clock of steps and reversals: STEP and DIR do not change; a pulse is completed after it."""
    for length in (1, 2, 7):
        for at in range(40):
            clocks = await prepare(dut, timing)
            start = clocks.now
            for clock in range(at + 1):
                dut.step_request.value = clock < 3
                dut.direction.value = clock >= 2
                await clocks.until(start + clock + 1)
            steps, dirs = Recorder(clocks, dut.step_pin), Recorder(clocks, dut.dir_pin)
            levels = read(dut.step_pin), read(dut.dir_pin)
            dut.rst.value = 1
            dut.step_request.value = dut.direction.value = 0
            await clocks.wait(length)
            dut.rst.value = 0
            assert (read(dut.step_pin), read(dut.dir_pin)) == levels
            await clocks.wait(80)
            assert read(dut.quiet)
            # a pulse that has begun is finished, and lasts its time from the reset on
            active = levels[0] != timing.step_inverted and not timing.both_edges
            assert [level for _, level in steps.changes] == [timing.step_inverted] * active, (length, at)
            assert all(clock >= start + at + 1 + length + timing.high for clock, _ in steps.changes)
            # then DIR goes back to the direction of no line
            assert len(dirs.changes) == (levels[1] != timing.direction_inverted)
            steps.stop()
            dirs.stop()


def random_timing(random: Random) -> PinTiming:
    """Small times, which meet more often than large ones."""
    top = random.choice((1, 2, 3, 8, 40))
    times = [random.randint(0, top) for _ in range(4)]
    bits = [random.random() < 0.5 for _ in range(3)]
    return PinTiming(*times, *bits)


@cocotb.test()
async def random_steps_match_the_reference(dut: HierarchyObject) -> None:
    """Random timings, rates and reversals, overruns included: every edge on the clock the reference says."""
    random = rng("axis")
    steps = 0
    for _ in range(60):
        timing = random_timing(random)
        axis = await Axis.begin(dut, timing)
        clock = axis.clocks.now
        requests: list[Request] = []
        direction = 1
        pace = timing.busy * random.choice((0.4, 0.8, 1, 1.5, 4))
        for _ in range(60):
            if random.random() < 0.2:
                direction = -direction
            requests.append((clock, direction))
            clock += max(1, round(random.expovariate(1 / pace)))
        await axis.request_and_compare(requests)
        steps += len(axis.checker.steps())
        axis.checker.finish()
        axis.clocks.stop()
    dut._log.info(f"{steps} steps compared")


@cocotb.test()
async def no_change_of_line_direction_harms_the_pins(dut: HierarchyObject) -> None:
    """The line's direction may change at any time: timings hold, every step keeps its own direction."""
    random = rng("axis, line direction")
    for _ in range(20):
        timing = random_timing(random)
        axis = await Axis.begin(dut, timing)
        accepted: list[int] = []
        direction = 1
        for _ in range(600):
            await axis.clocks.fall
            request = random.random() < 0.5 / timing.busy
            if random.random() < 0.3:
                direction = random.choice((1, -1))
            dut.step_request.value = request
            dut.direction.value = direction < 0
            if request:
                accepted.append(direction)
        await axis.clocks.fall
        dut.step_request.value = 0
        await axis.clocks.wait(6 * (timing.busy + timing.setup + timing.hold + 4))
        lost = len(axis.overruns.clocks_where(bool, axis.clocks.now))
        made = [direction for _, direction in axis.checker.steps()]
        assert len(made) + lost == len(accepted)
        if not lost:
            assert made == accepted
        axis.checker.finish()
        axis.clocks.stop()
