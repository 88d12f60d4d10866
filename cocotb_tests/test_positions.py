# SPDX-License-Identifier: MIT
"""passo_positions: every step is counted, and a snapshot is of one clock."""

from random import Random

import cocotb
import pytest
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, read

from cocotb_tests.helpers.bench import Bench, rng
from cocotb_tests.helpers.runner import run, skip_icarus

ROUND = 64  # clocks
STEPS = 36  # at most, of an axis in a round
COMPLETE = 3 * ROUND  # snapshot to copies
READ = 12  # address to position


@pytest.mark.parametrize("axes", [1, 5, 8])
def test_positions(simulator: str, axes: int) -> None:
    if axes < 8:
        skip_icarus(simulator)
    run(__name__, "passo_positions", {"AXES": axes, "LATCH": 1}, simulator)


class Positions(Bench):
    """The module under test, and what its positions should be."""

    INPUTS = ("step_made", "step_direction", "zero", "snapshot", "latch", "address")

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        super().__init__(dut, clocks)
        self.axes = len(dut.step_made)
        self.now = [0] * self.axes
        self.at_round_end = list(self.now)
        self._steps = [0] * self.axes  # in this round

    async def clock(self, steps: list[int], zero: bool = False, snapshot: bool = False) -> None:
        """One clock with these steps, each -1, 0 or 1, limited to what an axis can make in a round."""
        if read(self.dut.slot) == ROUND - 1:
            self.at_round_end = list(self.now)
            self._steps = [0] * self.axes
        steps = [s if n < STEPS else 0 for s, n in zip(steps, self._steps, strict=True)]
        self.dut.step_made.value = sum((s != 0) << axis for axis, s in enumerate(steps))
        self.dut.step_direction.value = sum((s < 0) << axis for axis, s in enumerate(steps))
        self.dut.zero.value = zero
        self.dut.snapshot.value = snapshot
        await self.clocks.fall
        for axis, step in enumerate(steps):
            self.now[axis] = 0 if zero else self.now[axis] + step
            self._steps[axis] += abs(step)
        self.dut.zero.value = 0
        self.dut.snapshot.value = 0
        self.dut.step_made.value = 0

    async def rounds(self, rounds: int, direction: int) -> None:
        """As many rounds, in each of which every axis makes all its steps, one on each clock."""
        self.dut.step_direction.value = (1 << self.axes) - 1 if direction < 0 else 0
        while read(self.dut.slot) != ROUND - 1:
            await self.clocks.fall
        for _ in range(rounds):
            self.dut.step_made.value = (1 << self.axes) - 1
            await self.clocks.wait(STEPS)
            self.dut.step_made.value = 0
            await self.clocks.wait(ROUND - STEPS)
        self.now = [now + direction * rounds * STEPS for now in self.now]

    async def snapshot(self, random: Random, rate: float, delay: int = 0) -> None:
        """A snapshot while the axes step on; compare what is read with the positions of one clock."""
        expected = None
        await self.clock([0] * self.axes, snapshot=True)
        for clock in range(COMPLETE):
            ends = read(self.dut.slot) == ROUND - 1
            await self.clock(random_steps(random, self.axes, rate))
            if ends and expected is None:
                delay -= 1
                if delay < 0:
                    expected = list(self.at_round_end)
                    assert clock < 2 * ROUND
        for axis in range(self.axes):
            self.dut.address.value = axis
            for _ in range(READ):
                await self.clock(random_steps(random, self.axes, rate))
            assert self.dut.position.value.to_signed() == expected[axis], f"axis {axis}"


def random_steps(random: Random, axes: int, rate: float) -> list[int]:
    """A step of some axes."""
    return [random.choice((-1, 1)) if random.random() < rate else 0 for _ in range(axes)]


@cocotb.test()
async def all_positions_of_a_snapshot_are_of_one_clock(dut: HierarchyObject) -> None:
    """Random steps up to the highest rate, snapshots at random times."""
    random = rng("positions")
    positions = await Positions.begin(dut)
    for rate in (0.0, 0.02, 0.3, 1.0):
        for _ in range(6):
            for _ in range(random.randrange(200)):
                await positions.clock(random_steps(random, positions.axes, rate))
            await positions.snapshot(random, rate)


@cocotb.test()
@cocotb.parametrize(direction=[1, -1])
async def positions_carry_through_all_their_bits(dut: HierarchyObject, direction: int) -> None:
    """The fastest motion, forward and back through 0, and far enough for a carry into the upper half."""
    random = rng("positions, carry")
    positions = await Positions.begin(dut)
    for there, clocks in ((1, 500), (-1, 1200), (1, 700)):
        for n in range(clocks):
            step = direction * there if n % 2 == 0 or n % 64 < 8 else 0
            await positions.clock([step] * positions.axes)
        await positions.snapshot(random, 0.0)
    await positions.rounds(1000, direction)
    await positions.snapshot(random, 0.0)
    assert max(abs(p) for p in positions.now) > 1 << 15


@cocotb.test()
async def zero_sets_all_positions(dut: HierarchyObject) -> None:
    """At any clock of a round, at rest and in the fastest motion, either way; a snapshot then comes later."""
    random = rng("positions, zero")
    positions = await Positions.begin(dut)
    for at in range(0, ROUND, 3):
        direction = random.choice((-1, 1))
        for _ in range(150 + at):
            await positions.clock([direction] * positions.axes)
        last = read(dut.slot) == ROUND - 1
        await positions.clock([0] * positions.axes, zero=True)
        for _ in range(random.choice((0, 0, 5))):
            await positions.clock([direction] * positions.axes)
        waits = read(dut.clear_waits)
        assert waits or last or read(dut.clears)
        await positions.clock([direction] * positions.axes)
        for _ in range(2 * ROUND):
            await positions.clock([direction] * positions.axes)
        await positions.snapshot(random, 0.0)


@cocotb.test()
async def a_snapshot_waits_for_a_zero(dut: HierarchyObject) -> None:
    """Right after ZERO, the snapshot is taken in the round after the one that clears."""
    random = rng("positions, zero and snapshot")
    positions = await Positions.begin(dut)
    for at in range(0, ROUND, 5):
        for _ in range(300 + at):
            await positions.clock(random_steps(random, positions.axes, 0.5))
        while read(dut.slot) >= ROUND - 2:
            await positions.clock([0] * positions.axes)
        await positions.clock([0] * positions.axes, zero=True)
        await positions.snapshot(random, 0.5, delay=1)


@cocotb.test()
async def a_latch_keeps_the_positions_of_its_clock(dut: HierarchyObject) -> None:
    """At any clock of a round and in the fastest motion, either way; a snapshot after it is right as well."""
    random = rng("positions, latch")
    positions = await Positions.begin(dut)
    for at in range(0, ROUND, 3):
        direction = random.choice((-1, 1))
        for n in range(300 + at):
            await positions.clock([direction * (n % 2)] * positions.axes)
        expected = list(positions.now)
        dut.latch.value = 1
        await positions.clock([direction] * positions.axes)
        dut.latch.value = 0
        for n in range(2 * ROUND + 20):
            await positions.clock([direction * (n % 2)] * positions.axes)
        for axis in range(positions.axes):
            dut.address.value = 8 + axis
            for n in range(READ + 1):
                await positions.clock([direction * (n % 2)] * positions.axes)
            assert dut.position.value.to_signed() == expected[axis], f"axis {axis}, clock {at}"
        await positions.snapshot(random, 0.5)
