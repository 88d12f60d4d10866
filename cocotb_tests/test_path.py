# SPDX-License-Identifier: MIT
"""passo_path: the clock of every carry of phase += velocity."""

from collections.abc import Iterable
from itertools import pairwise

import cocotb
from cocotb.handle import HierarchyObject

from cocotb_tests.bench import Clocks, Recorder, begin, rng
from cocotb_tests.runner import run

LATENCY = 2  # advance to substep
ONE = 1 << 48
HALF = ONE // 2


def test_path(simulator: str) -> None:
    run(__name__, "passo_path", simulator=simulator)


class Path:
    """The module under test with the sum it has to follow."""

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        self.dut, self.clocks = dut, clocks
        self.substeps = Recorder(clocks, dut.substep)
        self.expected: list[int] = []
        self.phase = ONE // 4

    @classmethod
    async def begin(cls, dut: HierarchyObject) -> "Path":
        """Reset; the reset leaves the phase as restart does."""
        return cls(dut, await begin(dut, "restart", "advance", "velocity"))

    async def restart(self) -> None:
        """Begin a motion."""
        await self.clocks.wait(3)
        self.dut.restart.value = 1
        await self.clocks.wait(1)
        self.dut.restart.value = 0
        self.phase = ONE // 4

    async def advance(self, velocities: Iterable[int | None]) -> None:
        """One clock for each velocity; None is a clock without advance, with any velocity."""
        for velocity in velocities:
            self.dut.advance.value = velocity is not None
            if velocity is not None:
                self.dut.velocity.value = velocity
                carry, self.phase = divmod(self.phase + velocity, ONE)
                if carry:
                    self.expected.append(self.clocks.now + LATENCY)
            await self.clocks.fall
        self.dut.advance.value = 0

    async def compare(self) -> int:
        """Check all substeps so far; return their number."""
        await self.clocks.wait(4)
        made = self.substeps.clocks_where(bool, self.clocks.now)
        assert made == self.expected
        assert all(b - a >= 2 for a, b in pairwise(made))
        return len(made)


@cocotb.test()
async def half_a_substep_per_clock_is_one_every_second_clock(dut: HierarchyObject) -> None:
    """The highest velocity: the quarter substep puts the first carry on the second clock."""
    path = await Path.begin(dut)
    await path.restart()
    first = path.clocks.now
    await path.advance([HALF] * 3000)
    assert await path.compare() == 1500
    assert path.expected == [first + 1 + 2 * n + LATENCY for n in range(1500)]


@cocotb.test()
@cocotb.parametrize(
    velocity=[
        0,
        1,
        HALF - 1,
        HALF // 3,
        (1 << 24) - 1,
        1 << 24,
        (1 << 47) - (1 << 24),
        (1 << 46) + (1 << 23) + 1,
    ]
)
async def a_constant_velocity_carries_when_the_integer_sum_does(dut: HierarchyObject, velocity: int) -> None:
    """Both halves of the sum and the carry between them."""
    path = await Path.begin(dut)
    await path.restart()
    await path.advance([velocity] * 3000)
    assert await path.compare() == (ONE // 4 + velocity * 3000) // ONE


@cocotb.test()
async def the_last_bit_of_the_sum_decides(dut: HierarchyObject) -> None:
    """Velocities that sum up to exactly a whole number, and to 2^-48 less: the carry is there, or late."""
    random = rng("path, last bit")
    path = await Path.begin(dut)
    for missing in (0, 1):
        for _ in range(150):
            await path.restart()
            velocities = [random.randrange(HALF) for _ in range(random.randrange(1, 12))]
            last = (-missing - path.phase - sum(velocities)) % ONE
            halves = [last // 2, last - last // 2]
            await path.advance([*velocities, *halves, 1])
            assert path.phase == 1 - missing
    await path.compare()


@cocotb.test()
async def restart_begins_at_a_quarter(dut: HierarchyObject) -> None:
    """After restart the same velocities give the same substeps, whatever was before."""
    path = await Path.begin(dut)
    random = rng("path, restart")
    velocities = [random.randrange(HALF + 1) for _ in range(100)]
    seen: set[tuple[int, ...]] = set()
    for _ in range(5):
        await path.advance(random.randrange(HALF + 1) for _ in range(random.randrange(50)))
        await path.restart()
        now, before = path.clocks.now, len(path.expected)
        await path.advance(velocities)
        await path.compare()
        seen.add(tuple(clock - now for clock in path.expected[before:]))
    assert len(seen) == 1


@cocotb.test()
async def random_velocities_and_gaps_match_the_integer_sum(dut: HierarchyObject) -> None:
    """Velocities that change on any clock, and an enable with gaps of any kind."""
    random = rng("path")
    path = await Path.begin(dut)
    for _ in range(30):
        await path.restart()
        share = random.choice((1.0, 0.9, 0.5, 0.1))
        top = random.choice((HALF, HALF, 1 << 44, 1 << 25))
        velocity = top
        sequence: list[int | None] = []
        for _ in range(300):
            if random.random() < 0.3:
                velocity = top - random.randrange(min(top, 1 << random.randrange(1, 48)))
            sequence.append(velocity if random.random() < share else None)
        await path.advance(sequence)
    dut._log.info(f"{await path.compare()} substeps compared")
