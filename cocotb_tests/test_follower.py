# SPDX-License-Identifier: MIT
"""passo_follower: advances are the counts, as many and as early as the limit allows."""

from itertools import pairwise

import cocotb
from cocotb.handle import HierarchyObject

from cocotb_tests.helpers.bench import patience, rng
from cocotb_tests.helpers.encoder_model import Pair
from cocotb_tests.helpers.runner import run

LATENCY = 3  # count to advance
HALF = 1 << 31  # UQ0.32
ONE = 1 << 32
LOST = 1 << 22  # advances owed
OUTPUTS = {
    "owed": lambda model, _wires: model.owed & 0xFFFFFF,
    "behind": lambda model, _wires: model.behind,
    "lost": lambda model, _wires: model.lost,
}


def test_follower(simulator: str) -> None:
    run(__name__, "passo_follower", simulator=simulator)


class Gear:
    """Module and model, the counts in and the advances out."""

    def __init__(self, pair: Pair) -> None:
        self.pair = pair
        self.count = self.furthest = 0  # as owed has it, a clock late
        self.coming = 0
        self.advances: list[int] = []  # clocks
        self.now = 0
        self.outputs = pair.compare()

    @classmethod
    async def begin(cls, dut: HierarchyObject, **settings: int) -> "Gear":
        """Reset, then follow."""
        pair = await Pair.begin(dut, "follower", OUTPUTS)
        pair.c.passo_follower_reset(pair.model)
        gear = cls(pair)
        pair.set(**{"limit": HALF, "enable": 1, "following": 1, **settings})
        return gear

    async def clock(self, count: int = 0, **inputs: int) -> bool:
        """One clock with a count of -1, 0 or 1; return whether it is an advance."""
        self.pair.set(count_made=abs(count), count_down=int(count < 0), **inputs)
        # combinational, as the inputs of the clock to come make it
        advance = bool(self.pair.c.passo_follower_advance(self.pair.model, self.pair.wires))
        self.outputs = await self.pair.clock()
        if advance:
            self.advances.append(self.now)
        self.count, self.coming = self.count + self.coming, count
        self.furthest = max(self.furthest, self.count)
        self.now += 1
        return advance

    @property
    def owed(self) -> int:
        """As the module has it."""
        return self.outputs["owed"] - (self.outputs["owed"] >> 23 << 24)


@cocotb.test()
async def each_count_is_an_advance_two_clocks_later(dut: HierarchyObject) -> None:
    """With time enough between them."""
    random = rng("follower, counts")
    gear = await Gear.begin(dut)
    counts: list[int] = []
    for _ in range(500):
        counts.append(gear.now)
        await gear.clock(1)
        for _ in range(random.randint(1, 6)):
            await gear.clock()
    for _ in range(5):
        await gear.clock()
    assert gear.advances == [clock + LATENCY for clock in counts]
    assert gear.outputs == {"owed": 0, "behind": 0, "lost": 0}


@cocotb.test()
@cocotb.parametrize(limit=[1, 1 << 24, 123456789, HALF - 1, HALF])
async def what_is_owed_is_made_at_the_limit(dut: HierarchyObject, limit: int) -> None:
    """In no span of time more than one advance above limit * clocks, and as many as that: the sum decides."""
    gear = await Gear.begin(dut, limit=limit)
    for _ in range(1000):
        await gear.clock(1)
    for _ in range(patience(6000, 2000)):
        await gear.clock()
    first = gear.advances[0]
    assert first == LATENCY
    for n, clock in enumerate(gear.advances):
        assert n == (clock - first) * limit // ONE
        if n + 1 < len(gear.advances):
            assert (gear.advances[n + 1] - first) * limit // ONE == n + 1
    assert all(b - a >= 2 for a, b in pairwise(gear.advances))
    assert gear.owed + len(gear.advances) == 1000
    assert gear.outputs["behind"] == (gear.owed >= 2)


@cocotb.test()
async def counts_back_are_paid_back_first(dut: HierarchyObject) -> None:
    """The path waits until the spindle is again where it has been."""
    gear = await Gear.begin(dut)
    for _ in range(10):
        await gear.clock(1)
        await gear.clock()
    for _ in range(5):
        await gear.clock()
    assert len(gear.advances) == 10
    for _ in range(300):
        await gear.clock(-1)
    await gear.clock()
    assert gear.owed == -300
    for _ in range(300):
        await gear.clock(1)
    for _ in range(5):
        await gear.clock()
    assert len(gear.advances) == 10 and gear.owed == 0
    await gear.clock(1)
    for _ in range(LATENCY):
        await gear.clock()
    assert len(gear.advances) == 11


@cocotb.test()
@cocotb.parametrize(scale=range(8))
async def a_count_is_a_power_of_two(dut: HierarchyObject, scale: int) -> None:
    """2^scale advances for each, spread at the limit; behind is two counts."""
    gear = await Gear.begin(dut, scale=scale, limit=HALF // 2)
    for turn in range(20):
        for n in range(4 << scale):
            advance = await gear.clock(int(n == 0))
            assert advance == (n % 4 == LATENCY or (turn > 0 and scale == 0 and n == LATENCY)), (turn, n)
    assert gear.outputs["behind"] == 0
    for n in range(3):
        await gear.clock(1, limit=1)
        await gear.clock()
        await gear.clock()
        assert gear.outputs["behind"] == (gear.owed >= 2 << scale), n
    assert gear.outputs["behind"]


@cocotb.test()
async def nothing_is_made_while_held_and_all_of_it_after(dut: HierarchyObject) -> None:
    """A hold stretches the time, not the phase: the lag is made up at the limit."""
    gear = await Gear.begin(dut, limit=HALF // 3)
    for n in range(600):
        held = 100 <= n < 300
        advance = await gear.clock(int(n % 10 == 0), enable=int(not held), stall=int(n == 402))
        assert not (advance and (held or n == 402))
        assert gear.outputs["behind"] == (gear.owed >= 2) or n % 10 <= 1 or gear.owed <= 2
    for _ in range(50):
        await gear.clock()
    assert gear.count == 60 == len(gear.advances) and gear.owed == 0


@cocotb.test()
async def too_much_owed_is_lost_and_says_so(dut: HierarchyObject) -> None:
    """At 2^22 either way nothing is counted any more; it never wraps, and a new motion begins from 0."""
    gear = await Gear.begin(dut, scale=7, limit=1)
    for sign in (1, -1):
        await gear.clock(following=0)
        await gear.clock(following=1)
        while not gear.outputs["lost"]:
            before = gear.owed
            assert abs(before) <= LOST + 128
            await gear.clock(sign)
        assert before >= LOST if sign > 0 else before < -LOST
        await gear.clock(sign)
        await gear.clock(sign)
        stays = gear.owed
        assert abs(stays) < LOST + 4 * 128
        for _ in range(100):
            await gear.clock(sign)
        assert gear.owed == stays
    await gear.clock(following=0)
    assert gear.outputs == {"owed": 0, "behind": 0, "lost": 0}


@cocotb.test()
async def a_wandering_spindle_keeps_its_phase(dut: HierarchyObject) -> None:
    """1,000 turns, the speed changing by +-30 %: every advance at its count, however the turn before was."""
    random = rng("follower, spindle")
    gear = await Gear.begin(dut, limit=HALF // 2)
    per_turn = 64
    times: list[int] = []  # of the counts
    angle, speed = 0.0, 1 / 6  # counts
    for _ in range(patience(1000, 60) * per_turn):
        angle = 0.0
        while angle < 1:
            speed = min(1.3 / 6, max(0.7 / 6, speed + random.uniform(-1, 1) * 0.004))
            angle += speed
            if angle < 1:
                await gear.clock()
        times.append(gear.now)
        await gear.clock(1)
    for _ in range(5):
        await gear.clock()
    assert gear.advances == [clock + LATENCY for clock in times]


@cocotb.test()
async def random_inputs_match_the_model(dut: HierarchyObject) -> None:
    """Anything at any clock; nothing is made or lost, and nothing is ahead of the furthest count."""
    random = rng("follower")
    gear = await Gear.begin(dut)
    for _ in range(patience(60, 15)):
        scale = random.choice((0, 0, 1, 3, 7))
        await gear.clock(following=0)
        limit = random.choice((1, HALF, random.randrange(1, HALF)))
        gear.count = gear.furthest = gear.coming = 0
        gear.advances = []
        bias = random.choice((0.2, 0.5, 0.8))
        often = random.choice((1.0, 0.3, 0.02))
        for _ in range(200):
            count = (1 if random.random() < bias else -1) if random.random() < often else 0
            await gear.clock(
                count,
                following=1,
                scale=scale,
                limit=limit,
                enable=int(random.random() < 0.9),
                stall=int(random.random() < 0.1),
            )
            assert (gear.count << scale) == gear.owed + len(gear.advances)
            assert len(gear.advances) <= gear.furthest << scale
        assert all(b - a >= 2 for a, b in pairwise(gear.advances))
