# SPDX-License-Identifier: MIT
"""passo_path: the clock of every carry of phase += velocity."""

from collections.abc import Iterable
from itertools import pairwise

import cocotb
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, Recorder, read

from cocotb_tests.helpers.bench import Bench, rng
from cocotb_tests.helpers.runner import run

LATENCY = 2  # advance to substep
ONE = 1 << 48
HALF = ONE // 2


def test_path(simulator: str) -> None:
    run(__name__, "passo_path", simulator=simulator)


class Path(Bench):
    """The module under test with the sum it has to follow."""

    # the reset leaves the phase as restart does
    INPUTS = (
        "restart", "advance", "stop", "begin_profile", "tick", "rest", "velocity_next", "drain",
        "drain_velocity",
    )  # fmt: skip

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        super().__init__(dut, clocks)
        self.substeps = Recorder(clocks, dut.substep)
        self.expected: list[int] = []
        self.phase = ONE // 4
        self.velocity = self.coming_high = 0

    async def restart(self) -> None:
        """Begin a motion."""
        await self.clocks.wait(3)
        await self.strobe("restart")
        self.phase, self.velocity = ONE // 4, 0

    def take(self, velocity: int) -> None:
        """Take a velocity with the clock to come; its upper half is there only one clock later."""
        dut = self.dut
        high, self.coming_high = self.coming_high, velocity >> 24
        dut.velocity_next.value = high << 24 | velocity & 0xFFFFFF
        dut.begin_profile.value = 1

    async def advance(self, velocities: Iterable[int | None]) -> None:
        """One clock for each velocity, taken with the one before; None is a clock without advance."""
        given = list(velocities)
        for velocity, following in zip([None, *given], [*given, None], strict=True):
            self.dut.advance.value = velocity is not None
            if velocity is not None:
                carry, self.phase = divmod(self.phase + velocity, ONE)
                if carry:
                    self.expected.append(self.clocks.now + LATENCY)
            self.take(self.velocity if following is None else following)
            self.velocity = self.velocity if following is None else following
            await self.clocks.fall
        self.dut.advance.value = 0
        self.take(self.velocity)
        await self.clocks.fall
        self.dut.begin_profile.value = 0

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
    first = path.clocks.now + 1  # the clock before takes the velocity
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


@cocotb.test()
async def a_tick_begins_with_the_next_velocity(dut: HierarchyObject) -> None:
    """From the clock after tick; 0 if rest. The host sees it too."""
    path = await Path.begin(dut)
    await path.restart()
    random = rng("path, tick")
    dut.advance.value = 1
    for _ in range(100):
        velocity, rest = random.randrange(HALF + 1), random.random() < 0.3
        dut.velocity_next.value, dut.rest.value = velocity, rest
        for clock in range(random.randrange(2, 40)):
            dut.tick.value = clock == 0
            carry, path.phase = divmod(path.phase + path.velocity, ONE)
            if carry:
                path.expected.append(path.clocks.now + LATENCY)
            path.velocity = 0 if rest else velocity
            await path.clocks.fall
        assert read(dut.velocity) == path.velocity >> 16
    dut.advance.value = 0
    assert await path.compare() > 100


@cocotb.test()
async def drain_has_its_own_velocity_and_stop_none(dut: HierarchyObject) -> None:
    """drain_velocity while drain is high, 0 after it and after a stop, each 3 clocks later at the latest."""
    path = await Path.begin(dut)
    random = rng("path, drain")
    for _ in range(30):
        await path.restart()
        await path.advance([random.randrange(1, HALF + 1)] * random.randrange(1, 9))
        dut.rest.value = 1
        drain_velocity = random.randrange(HALF >> 16)
        dut.drain_velocity.value = drain_velocity
        for name, expected in (("drain", drain_velocity), ("stop", 0)):
            getattr(dut, name).value = 1
            await path.clocks.wait(3)
            assert read(dut.velocity) == expected
            getattr(dut, name).value = 0
            await path.clocks.wait(3)
            assert read(dut.velocity) == 0
        dut.rest.value = 0
    await path.compare()
