# SPDX-License-Identifier: MIT
"""passo_timescale: pattern of the clock enable, and slewing of the rate."""

from dataclasses import dataclass, field

import cocotb
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, read

from cocotb_tests.helpers.bench import begin, rng
from cocotb_tests.helpers.runner import run

ONE = 1 << 16
LATENCY = 7  # slew tick to rate
INPUTS = ("slew_tick", "moving", "stopping", "rate_target", "rate_slew", "stop_slew")


def test_timescale(simulator: str) -> None:
    run(__name__, "passo_timescale", simulator=simulator)


@dataclass
class Reference:
    """Rate and enable after each clock; the goal is of the last slew tick, the slew of 2 clocks later."""

    rate: int = ONE
    goal: int = ONE
    slew: int = 1
    rate_sum: int = 0
    enable: int = 0
    since: int = LATENCY  # clocks since the slew tick
    rested: bool = False  # outside a motion for a clock

    def clock(
        self, *, slew_tick: int, moving: int, stopping: int, rate_target: int, rate_slew: int, stop_slew: int
    ) -> None:
        """One rising edge with these inputs."""
        self.enable, self.rate_sum = divmod(self.rate_sum + self.rate, ONE)
        self.since += 1
        if self.since == 2:
            self.slew = max(1, stop_slew if stopping else rate_slew)
        if self.since == LATENCY - 1:
            if abs(self.goal - self.rate) <= self.slew:
                self.rate = self.goal
            else:
                self.rate += self.slew if self.goal > self.rate else -self.slew
        if slew_tick and moving:
            self.since = 0
            self.goal = 0 if stopping else rate_target
        if not moving:
            if self.rested:
                self.rate = self.goal
            self.goal = rate_target
            self.since, self.rate_sum, self.enable = LATENCY, 0, 0
        self.rested = not moving


@dataclass
class Bench:
    """The module under test beside its reference, with a slew tick every `period` clocks."""

    dut: HierarchyObject
    clocks: Clocks
    period: int = 8
    inputs: dict[str, int] = field(default_factory=lambda: dict.fromkeys(INPUTS, 0))
    reference: Reference = field(default_factory=Reference)
    rates: list[int] = field(default_factory=list)
    enables: list[int] = field(default_factory=list)
    since_tick: int = 0

    @classmethod
    async def begin(cls, dut: HierarchyObject, **inputs: int) -> "Bench":
        """Reset with these inputs, so long not moving that the rate has its target."""
        bench = cls(dut, await begin(dut, *INPUTS))
        bench.set(**inputs)
        await bench.run(2)
        return bench

    def set(self, **inputs: int) -> None:
        """Change inputs."""
        self.inputs.update(inputs)
        for name, value in inputs.items():
            getattr(self.dut, name).value = value

    async def run(self, clocks: int) -> None:
        """Run and compare every clock."""
        for _ in range(clocks):
            self.since_tick = 1 if self.since_tick >= self.period else self.since_tick + 1
            self.set(slew_tick=self.since_tick == 1)
            self.reference.clock(**self.inputs)
            await self.clocks.fall
            seen = (read(self.dut.rate), read(self.dut.enable))
            assert seen == (self.reference.rate, self.reference.enable), f"clock {self.clocks.now}"
            self.rates.append(seen[0])
            self.enables.append(seen[1])


@cocotb.test()
async def rate_one_enables_every_clock(dut: HierarchyObject) -> None:
    """From the first clock on; and no clock before or after the motion."""
    bench = await Bench.begin(dut, rate_target=ONE, rate_slew=100)
    await bench.run(20)
    assert sum(bench.enables) == 0
    bench.set(moving=1)
    await bench.run(500)
    assert bench.enables[-500:] == [1] * 500
    bench.set(moving=0)
    await bench.run(20)
    assert sum(bench.enables[-20:]) == 0


@cocotb.test()
@cocotb.parametrize(rate=[0, 1, 3, ONE // 3, ONE // 2, ONE - 1, 40000])
async def a_rate_makes_exactly_its_share_of_clocks(dut: HierarchyObject, rate: int) -> None:
    """The k-th clock is enabled where floor(k * rate) counts on; each motion begins with an empty sum."""
    bench = await Bench.begin(dut, rate_target=rate, rate_slew=ONE)
    for _ in range(3):
        bench.set(moving=1)
        await bench.run(700)
        expected = [(k + 1) * rate // ONE - k * rate // ONE for k in range(700)]
        assert bench.enables[-700:] == expected
        bench.set(moving=0)
        await bench.run(3)


@cocotb.test()
async def the_rate_slews_onto_its_target_and_stays(dut: HierarchyObject) -> None:
    """Down to hold, up again, and onto targets that are not a multiple of the slew away: never beyond."""
    bench = await Bench.begin(dut, rate_target=ONE, rate_slew=5000, stop_slew=1)
    bench.set(moving=1)
    for target in (0, ONE, 12345, 12346, 12345, 12345 + 5000, 12345 + 5001, 0, 1, ONE):
        before = bench.rates[-1]
        bench.set(rate_target=target)
        first = len(bench.rates)
        await bench.run(bench.period * (3 + ONE // 5000))
        rates = bench.rates[first:]
        assert rates == sorted(rates, reverse=target < before)
        assert rates[-1] == target
        assert min(before, target) <= min(rates) and max(rates) <= max(before, target)


@cocotb.test()
async def a_slew_of_zero_counts_as_one_and_of_one_is_immediate(dut: HierarchyObject) -> None:
    """rate_slew 0 moves by 1 per slew tick; 65536 is there with the first step."""
    bench = await Bench.begin(dut, rate_target=1000, rate_slew=0)
    bench.set(moving=1, rate_target=1005)
    await bench.run(20 * bench.period)
    assert sorted(set(bench.rates[1:])) == [1000, 1001, 1002, 1003, 1004, 1005]
    bench.set(rate_target=ONE, rate_slew=ONE)
    await bench.run(3 * bench.period)
    bench.set(rate_target=0)
    await bench.run(3 * bench.period)
    assert set(bench.rates[-6 * bench.period :]) == {1005, ONE, 0}


@cocotb.test()
async def a_stop_goes_to_zero_by_its_own_slew(dut: HierarchyObject) -> None:
    """Stopping takes stop_slew and 0, whatever rate_target says; the next motion has its rate immediately."""
    bench = await Bench.begin(dut, rate_target=ONE, rate_slew=7, stop_slew=6000)
    bench.set(moving=1)
    await bench.run(50)
    bench.set(stopping=1, rate_target=30000)
    await bench.run(bench.period * (2 + 65536 // 6000 + 1))
    assert bench.rates[-1] == 0
    bench.set(moving=0, stopping=0)
    await bench.run(2)
    assert bench.rates[-1] == 30000


@cocotb.test()
async def random_changes_match_the_reference(dut: HierarchyObject) -> None:
    """Targets, slews, stops and motions that change on any clock."""
    random = rng("timescale")
    bench = await Bench.begin(dut, rate_target=ONE)
    for _ in range(300):
        choice = random.randrange(7)
        if choice == 0:
            bench.set(moving=int(random.random() < 0.8))
        elif choice == 1:
            bench.set(stopping=int(random.random() < 0.3))
        elif choice in (2, 3):
            bench.set(rate_target=random.choice((0, ONE, random.randrange(ONE + 1))))
        elif choice == 4:
            bench.set(rate_slew=random.choice((0, 1, ONE, random.randrange(1 << random.randrange(1, 17)))))
        elif choice == 5:
            bench.set(stop_slew=random.randrange(1 << random.randrange(1, 17)))
        else:
            bench.period = random.choice((8, 9, 128))
        await bench.run(random.randrange(1, 120))
