# SPDX-License-Identifier: MIT
"""passo_profile with passo_tables: the velocity of every tick."""

from collections.abc import Callable, Iterator, Sequence
from itertools import islice, pairwise
from random import Random

import cocotb
import pytest
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, Recorder, read

from cocotb_tests.helpers.bench import Bench, PushBus, rng
from cocotb_tests.helpers.ramps import V_MAX, Ramp, velocities
from cocotb_tests.helpers.runner import run, skip_icarus
from cocotb_tests.helpers.shapes import Shape

TICK_LOG2 = 7
TICK = 1 << TICK_LOG2
DEPTH_LOG2 = 4
DEPTH = 1 << DEPTH_LOG2

Enable = Callable[[], bool]


@pytest.mark.parametrize("channels", [1, 8])
def test_profile(simulator: str, channels: int) -> None:
    if channels < 8:
        skip_icarus(simulator)
    parameters = {"CHANNELS": channels, "DEPTH_LOG2": DEPTH_LOG2, "TICK_LOG2": TICK_LOG2}
    run(__name__, "passo_profile_top", parameters, simulator)


def always() -> bool:
    """Every clock is enabled."""
    return True


class Ramps(Bench):
    """The modules under test; `seen` has the velocity of every enabled clock of the profile."""

    INPUTS = (
        *PushBus.INPUTS, "now_coming", "prepare", "begin_profile", "stopped", "drain", "drain_velocity",
        "enable",
    )  # fmt: skip

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        super().__init__(dut, clocks)
        self.bus = PushBus(dut, clocks)
        self.dry = Recorder(clocks, dut.dry)
        self.ended = Recorder(clocks, dut.ended_q)
        self.seen: list[int] = []
        self.enabled_clocks: list[int] = []
        self.stalls = 0

    async def push(self, *ramps: Ramp) -> None:
        """Push ramps, one frame each, as the link does."""
        for ramp in ramps:
            await self.bus.push(ramp.words())

    async def start(self) -> None:
        """Prepare a motion and begin its profile."""
        await self.strobe("prepare")
        for _ in range(250):
            if read(self.dut.ready):
                break
            await self.clocks.wait(1)
        assert read(self.dut.ready) == 1
        await self.clocks.wait(1)
        self.seen, self.enabled_clocks = [], []
        await self.strobe("begin_profile")

    async def advance(self, clocks: int, enable: Enable = always) -> None:
        """Run for a number of enabled clocks."""
        dut = self.dut
        while clocks:
            enabled = enable()
            dut.enable.value = enabled
            if enabled and read(dut.stall):
                self.stalls += 1
            elif enabled:
                self.seen.append(read(dut.velocity))
                self.enabled_clocks.append(self.clocks.now)
                clocks -= 1
            await self.clocks.fall
        dut.enable.value = 0

    def compare(self, expected: Sequence[int]) -> None:
        """Check the velocity of every enabled clock: constant in each tick, and that of the recurrence."""
        assert len(self.seen) == len(expected) * TICK
        for tick, velocity in enumerate(expected):
            clocks = self.seen[tick * TICK : (tick + 1) * TICK]
            assert set(clocks) == {velocity}, f"tick {tick}: expected {velocity}, actual {set(clocks)}"

    async def compare_end(self) -> None:
        """Check that the profile has ended with its last enabled clock."""
        await self.clocks.wait(2)
        last = self.enabled_clocks[-1] if self.enabled_clocks else None
        ends = [
            clock
            for clock in self.ended.clocks_where(bool, self.clocks.now)
            if not last or clock > last - TICK
        ]
        assert ends == [last + 1]
        assert read(self.dut.velocity) == 0

    async def whole(self, ramps: Sequence[Ramp], enable: Enable = always) -> None:
        """Run a whole profile and check it."""
        expected = list(velocities(ramps))
        feeder = cocotb.start_soon(self.feed(ramps))
        # the first ramps, as many as the queue takes, are there before
        await self.clocks.wait(50 * min(len(ramps), DEPTH) + 50)
        await self.start()
        await self.advance(len(expected) * TICK, enable)
        assert feeder.done()
        self.compare(expected)
        await self.compare_end()

    async def write_at(self, enabled: int, ramps: Sequence[Ramp]) -> None:
        """Write ramps, which are checked before, after a number of enabled clocks of the profile."""
        words = [word for ramp in ramps for word in ramp.words()]
        await self.bus.accept(words)
        begun = self.enabled_clocks
        assert len(begun) < enabled - PushBus.COMMIT_CLOCKS
        while len(begun) < enabled - PushBus.COMMIT_CLOCKS:
            await self.clocks.wait(1)
        await self.bus.commit(words)

    async def feed(self, ramps: Sequence[Ramp]) -> None:
        """Push ramps whenever there is room."""
        for ramp in ramps:
            while read(self.dut.room) == 0:
                await self.clocks.wait(1)
            await self.push(ramp)


@cocotb.test()
@cocotb.parametrize(shape=list(Shape), mirror=[False, True])
async def a_ramp_follows_its_shape(dut: HierarchyObject, shape: Shape, mirror: bool) -> None:
    """Up, along, and down again, from velocity 0, in ramps of different lengths."""
    bench = await Ramps.begin(dut)
    for ticks in (1, 2, 3, 10):
        ramps = [
            Ramp(V_MAX - 12345, ticks, shape, mirror),
            Ramp(V_MAX - 12345, 1, shape, mirror),
            Ramp(V_MAX, ticks, shape, mirror),
            Ramp(1, ticks + 1, shape, mirror, last=True),
        ]
        await bench.whole(ramps)
    assert bench.stalls == 0


@cocotb.test()
async def the_next_ramp_begins_without_a_gap_from_exactly_v_end(dut: HierarchyObject) -> None:
    """Each ramp begins from v_end of the one before, whatever its own last tick was."""
    bench = await Ramps.begin(dut)
    ramps = [
        Ramp(V_MAX // 3, 1),
        Ramp(V_MAX, 2),
        Ramp(V_MAX // 7, 3),
        Ramp(V_MAX // 7, 2),
        Ramp(9, 1, last=True),
    ]
    expected = list(velocities(ramps))
    # v_end itself is not among the velocities of ramps that change it
    assert V_MAX // 3 not in expected and expected[1] == V_MAX // 3 + ((V_MAX - V_MAX // 3) * (1 << 22) >> 24)
    await bench.whole(ramps)


@cocotb.test()
async def a_ramp_of_no_ticks_sets_the_velocity_immediately(dut: HierarchyObject) -> None:
    """T = 0 before, between and after other ramps, and several of them in a row."""
    bench = await Ramps.begin(dut)
    for ramps in (
        [Ramp(V_MAX, 0), Ramp(V_MAX, 3, last=True)],
        [Ramp(V_MAX, 2), Ramp(1000, 0), Ramp(V_MAX, 2), Ramp(0, 0, last=True)],
        [
            Ramp(V_MAX, 0),
            Ramp(5, 0),
            Ramp(V_MAX // 2, 0),
            Ramp(77, 0),
            Ramp(V_MAX, 2, Shape.COSINE, last=True),
        ],
    ):
        await bench.whole(ramps)


@cocotb.test()
async def a_profile_without_ticks_ends_as_it_begins(dut: HierarchyObject) -> None:
    """Only ramps of no ticks: ended comes with begin_profile, and the next motion is as usual."""
    bench = await Ramps.begin(dut)
    await bench.push(Ramp(V_MAX, 0), Ramp(0, 0, last=True))
    await bench.start()
    begun = bench.clocks.now
    await bench.clocks.wait(3)
    assert bench.ended.clocks_where(bool, bench.clocks.now) == [begun]
    assert read(dut.velocity) == 0
    await bench.whole([Ramp(V_MAX, 2, last=True)])


@cocotb.test()
async def the_longest_ramp_keeps_its_precision(dut: HierarchyObject) -> None:
    """T = 2^32 - 1 and others too long to run to their end: the first ticks are right, then it is stopped."""
    bench = await Ramps.begin(dut)
    for ticks in ((1 << 32) - 1, (1 << 24) + 1, 1 << 24, 99_999):
        for v_end in (V_MAX, 3):
            ramp = Ramp(v_end, ticks, Shape.EASE if ticks % 3 else Shape.LINEAR)
            await bench.push(Ramp(V_MAX // 2, 0), ramp)
            await bench.start()
            await bench.advance(6 * TICK)
            bench.compare(list(islice(ramp.velocities(V_MAX // 2), 6)))
            await bench.strobe("stopped")
    assert not bench.ended.clocks_where(bool, bench.clocks.now)


@cocotb.test()
async def progress_steps_by_exactly_du(dut: HierarchyObject) -> None:
    """To the last of its 49 bits, mirrored and not: s lies just above where it rounds up, or below."""
    bench = await Ramps.begin(dut)
    for mirror in (False, True):
        for edge in (-2, -1, 0, 1):
            du = (
                ((1 << 24) + edge) * pow(3, -1, 1 << 25) % (1 << 25)
            )  # 3 du, in the second tick, is at the edge
            ramps = [Ramp(V_MAX, 3, Shape.LINEAR, mirror, progress_step=du), Ramp(0, 1, last=True)]
            await bench.whole(ramps)


@cocotb.test()
async def the_last_ticks_of_a_long_ramp_stay_below_one(dut: HierarchyObject) -> None:
    """A progress step that carries u to just below 1 in the last tick: u never wraps."""
    bench = await Ramps.begin(dut)
    for ticks in (3, 5, 6, 7, 11, 13):
        ramps = [Ramp(V_MAX, ticks, Shape.LINEAR), Ramp(0, ticks, Shape.SIGMOID, last=True)]
        expected = list(velocities(ramps))
        assert all(a <= b for a, b in pairwise(expected[:ticks]))
        await bench.whole(ramps)


@cocotb.test()
async def ramps_that_run_out_at_speed_raise_dry_a_tick_ahead(dut: HierarchyObject) -> None:
    """dry comes in the last tick of the ramp; the velocity stays; the next ramp is taken when it comes."""
    bench = await Ramps.begin(dut)
    first, late = Ramp(V_MAX // 3, 4), Ramp(100, 3, Shape.COSINE, last=True)
    await bench.push(first)
    await bench.start()
    await bench.advance(3 * TICK)
    assert not bench.dry.clocks_where(bool, bench.clocks.now)
    await bench.advance(TICK)
    assert bench.dry.clocks_where(bool, bench.clocks.now)
    await bench.advance(2 * TICK + 10)
    await bench.push(late)
    await bench.advance(TICK - 10 + 4 * TICK - 1)
    await bench.clocks.wait(3)
    assert not bench.ended.clocks_where(bool, bench.clocks.now)
    await bench.advance(1)
    # the late ramp is found when the tick after the one it came in begins, and makes the tick after that
    held = [V_MAX // 3] * 4
    bench.compare([*first.velocities(0), *held, *late.velocities(V_MAX // 3)])
    await bench.compare_end()


@cocotb.test()
async def ramps_that_run_out_at_velocity_zero_just_wait(dut: HierarchyObject) -> None:
    """No dry at velocity 0; the next ramp continues from there."""
    bench = await Ramps.begin(dut)
    first, late = [Ramp(V_MAX, 2), Ramp(0, 2)], Ramp(V_MAX, 2, last=True)
    await bench.push(*first)
    await bench.start()
    await bench.advance(6 * TICK + 5)
    assert read(dut.velocity) == 0
    await bench.push(late)
    await bench.advance(TICK - 5 + 3 * TICK)
    assert not bench.dry.clocks_where(bool, bench.clocks.now)
    bench.compare([*velocities(first), 0, 0, 0, 0, *late.velocities(0)])
    await bench.compare_end()


@cocotb.test()
@cocotb.parametrize(clock=[2, 20, 60, 100])
async def now_drops_the_ramps_before_it_and_starts_from_the_present_velocity(
    dut: HierarchyObject, clock: int
) -> None:
    """Pushed in tick 5: tick 6 is already made, the new ramp takes over after it, from its velocity."""
    bench = await Ramps.begin(dut)
    old = [Ramp(V_MAX, 20, Shape.COSINE), Ramp(V_MAX // 2, 9), Ramp(0, 9, last=True)]
    new = [Ramp(V_MAX // 5, 3, Shape.SIGMOID, now=True), Ramp(0, 2, last=True)]
    for now in (new, [Ramp(77, 0, now=True), Ramp(0, 2, last=True)]):
        await bench.push(*old)
        await bench.start()
        before = list(islice(velocities(old), 7))
        expected = [*before, *velocities(now, before[-1])]

        cocotb.start_soon(bench.write_at(5 * TICK + clock, now))
        await bench.advance(len(expected) * TICK)
        bench.compare(expected)
        await bench.compare_end()
        assert (read(dut.room), read(dut.valid)) == (DEPTH, 0)


@cocotb.test()
async def the_latest_now_wins(dut: HierarchyObject) -> None:
    """Of several ramps with NOW only the last one is left; one before the first tick is like any other."""
    bench = await Ramps.begin(dut)
    ramps = [
        Ramp(V_MAX, 5),
        Ramp(1, 5, now=True),
        Ramp(V_MAX, 9),
        Ramp(V_MAX // 2, 4, now=True),
        Ramp(0, 1, last=True),
    ]
    await bench.push(*ramps)
    await bench.start()
    await bench.advance(5 * TICK)
    bench.compare(list(velocities(ramps[3:])))
    await bench.compare_end()


@cocotb.test()
async def a_second_now_ramp_starts_from_the_present_velocity_as_well(dut: HierarchyObject) -> None:
    """Two ramps with NOW in a row: wherever the tick ends between them, the velocity is not lost."""
    bench = await Ramps.begin(dut)
    old = [Ramp(V_MAX, 20), Ramp(0, 9, last=True)]
    now = [Ramp(V_MAX // 5, 3, Shape.SIGMOID, now=True), Ramp(0, 2, Shape.COSINE, now=True, last=True)]
    before = list(islice(velocities(old), 7))
    expected = [*before, *velocities(now[1:], before[-1])]
    for clock in range(80, 112, 4):
        await bench.push(*old)
        await bench.start()

        cocotb.start_soon(bench.write_at(5 * TICK + clock, now))
        await bench.advance(len(expected) * TICK)
        bench.compare(expected)
        await bench.compare_end()


@cocotb.test()
@cocotb.parametrize(early=[1, 5, 60, 100])
async def a_now_ramp_that_is_coming_keeps_the_profile_from_ending(dut: HierarchyObject, early: int) -> None:
    """Announced before the last tick, written after its end: the tick is only extended."""
    bench = await Ramps.begin(dut)
    old = [Ramp(V_MAX, 2), Ramp(V_MAX // 2, 2, last=True)]
    now = [Ramp(V_MAX // 5, 3, Shape.SIGMOID, now=True), Ramp(0, 2, last=True)]
    before = list(velocities(old))
    expected = [*before, *velocities(now, before[-1])]
    await bench.push(*old)
    await bench.start()

    async def push_late() -> None:
        while len(bench.enabled_clocks) < 3 * TICK - early:
            await bench.clocks.wait(1)
        dut.now_coming.value = 1
        while not read(dut.stall):
            await bench.clocks.wait(1)
        await bench.push(*now)
        dut.now_coming.value = 0

    cocotb.start_soon(push_late())
    await bench.advance(len(expected) * TICK)
    assert bench.stalls > 0
    bench.compare(expected)
    await bench.compare_end()


@cocotb.test()
async def the_last_ramp_ends_the_profile_and_later_ones_wait(dut: HierarchyObject) -> None:
    """Ramps after LAST belong to the next motion, which starts from 0."""
    bench = await Ramps.begin(dut)
    first = [Ramp(V_MAX, 1), Ramp(V_MAX, 1, last=True)]
    second = [Ramp(V_MAX // 2, 2), Ramp(0, 0, last=True)]
    await bench.push(*first, *second)
    for ramps in (first, second):
        await bench.start()
        await bench.advance(TICK * len(list(velocities(ramps))))
        bench.compare(list(velocities(ramps)))
        await bench.compare_end()
        await bench.clocks.wait(300)


@cocotb.test()
async def ramps_that_set_the_velocity_fit_into_a_tick_with_another(dut: HierarchyObject) -> None:
    """Ramps of one tick each with T = 0 before them, at full rate: the next velocity is ready in time.

    Three ramps of T = 0 before each on a core of one channel, two on a core of eight, whatever the phase
    of the tick against the turns of the channels at the tables.
    """
    bench = await Ramps.begin(dut)
    random = rng("ramp, stall")
    channels = len(dut.table_requests)
    for phase in range(2 * channels):
        ramps: list[Ramp] = []
        for _ in range(4):
            ramps += [Ramp(random.randrange(V_MAX), 0) for _ in range(3 if channels == 1 else 2)]
            ramps.append(Ramp(random.randrange(V_MAX), 1, random.choice(list(Shape)[1:]), phase % 4 < 2))
        ramps[-1] = Ramp(0, 1, Shape.EASE, last=True)
        while bench.clocks.now % (2 * channels) != phase:
            await bench.clocks.wait(1)
        await bench.whole(ramps)
    assert bench.stalls == 0


@cocotb.test()
async def what_does_not_fit_into_a_tick_comes_later_but_is_not_lost(dut: HierarchyObject) -> None:
    """Ten consecutive ramps without ticks only stall the profile at the end of the tick."""
    bench = await Ramps.begin(dut)
    ramps = [Ramp(V_MAX, 2), *[Ramp(V_MAX - n, 0) for n in range(10)], Ramp(5, 3, Shape.COSINE, last=True)]
    await bench.whole(ramps)
    assert bench.stalls > 0


@cocotb.test()
async def drain_sets_its_own_velocity(dut: HierarchyObject) -> None:
    """While drain is high the velocity is drain_velocity, UQ0.32, from the second clock on; no stall."""
    bench = await Ramps.begin(dut)
    await bench.whole([Ramp(V_MAX, 2, last=True)])
    dut.drain.value = 1
    dut.drain_velocity.value = 0x12345678
    await bench.clocks.wait(2)
    bench.seen = []
    await bench.advance(3 * TICK)
    assert set(bench.seen) == {0x12345678 << 16} and bench.stalls == 0
    dut.drain.value = 0
    await bench.whole([Ramp(V_MAX, 2, last=True)])


@cocotb.test()
async def stop_forgets_everything(dut: HierarchyObject) -> None:
    """Stopped on any clock of a tick: velocity 0, queue empty, and the next motion begins from 0."""
    random = rng("ramp, stop")
    bench = await Ramps.begin(dut)
    for _ in range(40):
        ramps = [
            Ramp(V_MAX, 2, random.choice(list(Shape))),
            Ramp(5, 0, now=random.random() < 0.3),
            Ramp(V_MAX, 9),
        ]
        await bench.push(*ramps)
        await bench.start()
        await bench.advance(random.randrange(1, 4 * TICK))
        await bench.strobe("stopped")
        await bench.clocks.wait(2)
        assert (read(dut.velocity), read(dut.ready), read(dut.room)) == (0, 0, DEPTH)
        await bench.clocks.wait(random.randrange(150))
        assert (read(dut.velocity), read(dut.ready), read(dut.stall)) == (0, 0, 0)
        # with NOW the first ramp begins from 0 as well
        now = random.random() < 0.5
        await bench.whole([Ramp(V_MAX // 3, 1, Shape.COSINE, now=now), Ramp(0, 1, last=True)])


def random_ramps(random: Random) -> list[Ramp]:
    """Short ramps, some of no ticks, of all shapes."""
    count = random.randrange(1, 9)
    ramps = []
    for n in range(count):
        ticks = random.choice((0, 1, 1, 2, 3, random.randrange(1, 12)))
        v_end = random.choice(
            (0, V_MAX, random.randrange(V_MAX + 1), random.randrange(1 << random.randrange(1, 47)))
        )
        du = random.choice((None, None, random.randrange(1 << 48)))
        ramps.append(
            Ramp(v_end, ticks, random.choice(list(Shape)), random.random() < 0.5, n == count - 1, False, du)
        )
    return ramps if sum(ramp.ticks for ramp in ramps) else random_ramps(random)


def gappy(random: Random) -> Iterator[bool]:
    """An enable that is high for a random share of the clocks, the share changing."""
    while True:
        share = random.choice((1.0, 0.9, 0.4))
        for _ in range(random.randrange(1, 300)):
            yield random.random() < share


@cocotb.test()
async def random_profiles_match_the_recurrence_under_any_enable(dut: HierarchyObject) -> None:
    """Random profiles: the velocity of every tick, at full rate and with gaps in the enable."""
    random = rng("ramp")
    bench = await Ramps.begin(dut)
    ticks = 0
    for n in range(25):
        enable = gappy(random)
        await bench.whole(random_ramps(random), always if n % 2 else lambda enable=enable: next(enable))
        ticks += len(bench.seen) // TICK
    dut._log.info(f"{ticks} ticks compared, {bench.stalls} clocks stalled")
