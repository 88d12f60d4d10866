# SPDX-License-Identifier: MIT
"""passo_lines: which substep makes a step of which axis."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random

import cocotb
import pytest
from cocotb.handle import HierarchyObject
from cocotb.triggers import gather
from passo.cocotb.clocks import Clocks, Recorder, read

from cocotb_tests.helpers.bench import SUBSTEPS_MAX, Bench, PushBus, rng
from cocotb_tests.helpers.runner import run

AXES = 3
DEPTH_LOG2 = 5
LATENCY = 2  # substep to step_request


@pytest.mark.parametrize("register", [0, 1])
def test_lines(simulator: str, register: int) -> None:
    parameters = {"AXES": AXES, "DEPTH_LOG2": DEPTH_LOG2, "STEPS_REGISTER": register}
    run(
        __name__,
        "passo_lines",
        parameters,
        simulator,
        internals=["passo_line.substep_number", "passo_dda.e_minus_m"],
    )


@dataclass(frozen=True)
class Line:
    """A line command; `negative` has one bit per axis."""

    substeps: int
    steps: tuple[int, ...]
    negative: int = 0
    last: bool = False
    endless: bool = False

    def words(self) -> list[int]:
        """What is pushed."""
        return [self.last | self.endless << 1 | self.negative << 8, self.substeps, *self.steps]

    def step_numbers(self, axis: int, until: int) -> set[int]:
        """Substeps, from 1 to `until`, that make a step of an axis: the k-th is ceil((k M - M // 2) / N)."""
        m, n = self.substeps, self.steps[axis]
        if n == 0:
            return set()
        found: set[int] = set()
        for k in range(1, n + 1):
            number = -((m // 2 - k * m) // n)
            if number > until:
                break
            found.add(number)
        return found


Step = tuple[int, int, int]  # clock, axis, direction bit


class Lines(Bench):
    """The module under test, what it made and what it should have made."""

    INPUTS = (*PushBus.INPUTS, "start", "stopped", "release_line", "end_endless", "substep")

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        super().__init__(dut, clocks)
        self.bus = PushBus(dut, clocks)
        self.requests = Recorder(clocks, dut.step_request)
        self.underruns = Recorder(clocks, dut.underrun)
        self.directions = Recorder(clocks, dut.directions)
        self.expected: list[Step] = []

    async def start(self) -> None:
        """Take the first line, and give it the time that a motion gives it."""
        await self.clocks.wait(4)
        assert read(self.dut.valid) == 1
        await self.strobe("start")
        await self.clocks.wait(10)

    async def make(self, lines: Sequence[Line], gaps: Iterator[int], until: int | None = None) -> None:
        """Make all substeps of some lines, or `until` of each, with these distances between them."""
        for line in lines:
            count = line.substeps if until is None else until
            making = [line.step_numbers(axis, count) for axis in range(AXES)]
            for number in range(1, count + 1):
                for axis in range(AXES):
                    if number in making[axis]:
                        self.expected.append((self.clocks.now + LATENCY, axis, line.negative >> axis & 1))
                await self.strobe("substep")
                await self.clocks.wait(next(gaps) - 1)

    async def jump(self, line: Line, number: int) -> None:
        """Set the state after a number of substeps of a line, to skip them."""
        dut = self.dut
        dut.u_line.substep_number.value = number
        for axis, n in enumerate(line.steps):
            e = (line.substeps // 2 + number * n) % line.substeps
            e_minus_m = dut.g_axis[axis].u_dda.e_minus_m
            e_minus_m.value = (e - line.substeps) % (1 << len(e_minus_m))
        await self.clocks.wait(3)

    async def make_end(self, line: Line, number: int) -> None:
        """Make the remaining substeps of a line after a number of them."""
        m = line.substeps
        for at in range(number, m):
            for axis, n in enumerate(line.steps):
                if (m // 2 + at * n) // m < (m // 2 + (at + 1) * n) // m:
                    self.expected.append((self.clocks.now + LATENCY, axis, line.negative >> axis & 1))
            await self.strobe("substep")
            await self.clocks.wait(1)

    async def make_slowly(self, lines: Sequence[Line]) -> None:
        """Make all substeps of some lines, in the time that it takes to push as many."""
        for line in lines:
            await self.make([line], every(2 + 60 // line.substeps))

    async def feed(self, lines: Sequence[Line]) -> None:
        """Push lines when there is room."""
        for line in lines:
            while read(self.dut.room) == 0:
                await self.clocks.wait(1)
            await self.bus.push(line.words())

    async def compare(self) -> int:
        """Check all steps so far with their directions; return their number."""
        await self.clocks.wait(4)
        made: list[Step] = []
        ends = [*[clock for clock, _ in self.requests.changes], self.clocks.now + 1][1:]
        for (clock, bits), end in zip(self.requests.changes, ends, strict=True):
            assert not bits or end == clock + 1
            made += [(clock, axis, self.direction(clock, axis)) for axis in range(AXES) if bits >> axis & 1]
        assert made == self.expected
        return len(made)

    def direction(self, clock: int, axis: int) -> int:
        """Direction bit of an axis at a clock."""
        bits = next((bits for since, bits in reversed(self.directions.changes) if since <= clock), 0)
        return bits >> axis & 1

    def check_end(self, ended: bool, underruns: int) -> None:
        """Check how it ended."""
        assert read(self.dut.ended) == ended
        assert len(self.underruns.clocks_where(bool, self.clocks.now)) == underruns


def every(gap: int) -> Iterator[int]:
    """The same number, endlessly."""
    while True:
        yield gap


def gaps(random: Random) -> Iterator[int]:
    """Random distances, mostly the shortest."""
    while True:
        yield 2 if random.random() < 0.7 else random.randrange(2, 20)


@cocotb.test()
@cocotb.parametrize(
    size=[
        (1, (0, 1, 1)),
        (2, (0, 1, 2)),
        (3, (1, 2, 3)),
        (7, (3, 5, 6)),
        (64, (63, 1, 32)),
        (100, (100, 37, 99)),
        (101, (50, 51, 0)),
        (1000, (999, 500, 7)),
    ],
)
async def steps_are_spread_evenly_over_the_substeps(
    dut: HierarchyObject, size: tuple[int, tuple[int, ...]]
) -> None:
    """Exactly N steps in M substeps, the k-th at substep ceil((k M - M // 2) / N), at full rate."""
    lines = await Lines.begin(dut)
    m, n = size
    line = Line(m, n, negative=5, last=True)
    await lines.bus.push(line.words())
    await lines.start()
    await lines.make([line], every(2))
    assert await lines.compare() == sum(n)
    lines.check_end(ended=True, underruns=0)


@cocotb.test()
@cocotb.parametrize(
    n=[
        (SUBSTEPS_MAX, SUBSTEPS_MAX - 1, SUBSTEPS_MAX // 2),
        (SUBSTEPS_MAX // 3, 1 << 29, SUBSTEPS_MAX // 7),
        (1, 0, (1 << 29) + 1),
    ],
    m=[SUBSTEPS_MAX, SUBSTEPS_MAX - 1, (1 << 29) + 1],
)
async def the_longest_lines_do_not_overflow(dut: HierarchyObject, m: int, n: tuple[int, ...]) -> None:
    """M up to 2^30 - 1: the first substeps make the right steps, and the line does not end."""
    lines = await Lines.begin(dut)
    line = Line(m, tuple(min(m, steps) for steps in n), last=True)
    await lines.bus.push(line.words())
    await lines.start()
    await lines.make([line], every(2), until=300)
    await lines.compare()
    lines.check_end(ended=False, underruns=0)


@cocotb.test()
async def the_longest_lines_end_with_their_last_substep(dut: HierarchyObject) -> None:
    """The last substeps of lines of every length, as the count goes through 2^k and up to 2^30 - 1."""
    random = rng("line, end")
    lines = await Lines.begin(dut)
    for m in (*((1 << bit) + random.randrange(2, 9) for bit in range(8, 30)), SUBSTEPS_MAX):
        before = 6 if m == SUBSTEPS_MAX else m - (1 << m.bit_length() - 1) + 2
        long = Line(m, (m, m - 1, random.randrange(m)), random.randrange(8))
        short = Line(3, (3, 1, 2), random.randrange(8), last=True)
        await lines.bus.push(long.words() + short.words())
        await lines.start()
        await lines.jump(long, m - before)
        await lines.make_end(long, m - before)
        await lines.make([short], every(2))
        await lines.clocks.wait(1)
        lines.check_end(ended=True, underruns=0)
        await lines.strobe("release_line")
        await lines.clocks.wait(2)
        assert read(dut.room) == 1 << DEPTH_LOG2
    assert await lines.compare() > 200


@cocotb.test()
async def lines_of_one_substep_follow_each_other_without_a_lost_clock(dut: HierarchyObject) -> None:
    """As many lines as the queue holds, M = 1 each, directions and axes alternating, at full rate."""
    lines = await Lines.begin(dut)
    count = 1 << DEPTH_LOG2
    sequence = [Line(1, (k & 1, k >> 1 & 1, k >> 2 & 1), k * 5 & 7, k == count - 1) for k in range(count)]
    for line in sequence:
        await lines.bus.push(line.words())
    await lines.start()
    await lines.make(sequence, every(2))
    assert await lines.compare() == sum(sum(line.steps) for line in sequence)
    lines.check_end(ended=True, underruns=0)


@cocotb.test()
async def after_the_last_line_substeps_are_ignored(dut: HierarchyObject) -> None:
    """The LAST line ends with its last substep although another one waits, for the next motion."""
    lines = await Lines.begin(dut)
    first, second = Line(5, (5, 2, 0), 1, last=True), Line(4, (1, 4, 4), 2, last=True)
    await lines.bus.push(first.words() + second.words())
    for line in (first, second):
        await lines.start()
        assert read(dut.ended) == 0
        await lines.make([line], every(3))
        await lines.clocks.wait(1)
        lines.check_end(ended=True, underruns=0)
        for _ in range(10):
            await lines.strobe("substep")
            await lines.clocks.wait(1)
        await lines.compare()
        await lines.strobe("release_line")
    await lines.clocks.wait(2)
    assert read(dut.room) == 1 << DEPTH_LOG2


@cocotb.test()
async def a_missing_line_is_an_underrun(dut: HierarchyObject) -> None:
    """A line that is not LAST ends and none follows: underrun for one clock, no more steps until a stop."""
    lines = await Lines.begin(dut)
    line = Line(6, (6, 3, 1))
    for rounds in range(1, 4):
        await lines.bus.push(line.words())
        await lines.start()
        await lines.make([line], every(2))
        await lines.clocks.wait(2)
        lines.check_end(ended=False, underruns=rounds)
        await lines.bus.push(line.words())
        for _ in range(8):
            await lines.strobe("substep")
            await lines.clocks.wait(2)
        await lines.compare()
        lines.check_end(ended=False, underruns=rounds)
        await lines.strobe("stopped")
        await lines.clocks.wait(3)
        assert (read(dut.room), read(dut.valid)) == (1 << DEPTH_LOG2, 0)


@cocotb.test()
async def a_line_is_in_time_three_clocks_before_its_predecessor_ends(dut: HierarchyObject) -> None:
    """Its last word is written 3 clocks before the last substep of the line before: not a clock is lost."""
    for early, underruns in ((3, 0), (4, 0), (0, 1)):
        lines = await Lines.begin(dut)
        first, second = Line(20, (20, 0, 7), 1), Line(3, (3, 1, 2), 6, last=True)
        await lines.bus.push(first.words())
        await lines.bus.accept(second.words())
        await lines.start()
        begun = lines.clocks.now
        end = begun + 2 * (first.substeps - 1)

        async def late_push(
            end: int = end, early: int = early, lines: Lines = lines, line: Line = second
        ) -> None:
            words = line.words()
            # 4 clocks per word, of which the second has the strobe
            first_word = end - early - 4 * (len(words) - 1) - 1
            await lines.clocks.until(first_word - PushBus.COMMIT_CLOCKS)
            await lines.bus.commit(words)

        push = cocotb.start_soon(late_push())
        await lines.make([first] if underruns else [first, second], every(2))
        await push
        await lines.compare()
        lines.check_end(ended=not underruns, underruns=underruns)
        lines.clocks.stop()


@cocotb.test()
async def an_endless_line_repeats_until_it_is_released(dut: HierarchyObject) -> None:
    """The same line again and again, even if others wait; they are for the motion after release_line.

    Long lines and lines of one substep, at full rate.
    """
    lines = await Lines.begin(dut)
    after = Line(4, (4, 1, 0), 4, last=True)
    for endless in (Line(7, (3, 7, 1), 2, endless=True), Line(1, (1, 0, 1), 1, endless=True)):
        await lines.bus.push(endless.words() + after.words())
        await lines.start()
        assert read(dut.endless) == 1
        await lines.make([endless] * 6, every(2))
        await lines.make([endless], gaps(rng("line, endless")), until=4 if endless.substeps > 4 else None)
        assert await lines.compare() > 0
        lines.check_end(ended=False, underruns=0)
        await lines.strobe("release_line")
        await lines.clocks.wait(3)
        assert read(dut.room) == (1 << DEPTH_LOG2) - 1
        await lines.start()
        assert read(dut.endless) == 0
        await lines.make([after], every(2))
        await lines.compare()
        lines.check_end(ended=True, underruns=0)
        await lines.strobe("release_line")


@cocotb.test()
async def stop_forgets_the_line_and_the_next_motion_is_clean(dut: HierarchyObject) -> None:
    """Stopped anywhere inside a line; the line that is taken next begins from its own start value."""
    random = rng("line, stop")
    lines = await Lines.begin(dut)
    for _ in range(20):
        first = random_line(random)
        second = random_line(random, last=True)
        await lines.bus.push(first.words())
        await lines.start()
        await lines.make([first], gaps(random), until=random.randrange(first.substeps))
        await lines.clocks.wait(LATENCY)
        await lines.strobe("stopped")
        await lines.clocks.wait(2)
        await lines.bus.push(second.words())
        await lines.start()
        await lines.make([second], gaps(random))
    await lines.compare()


def random_line(random: Random, last: bool = False) -> Line:
    """Short lines, many of them of one or two substeps."""
    m = random.choice((1, 1, 2, 3, random.randrange(1, 12), random.randrange(1, 90)))
    n = tuple(random.choice((0, m, random.randrange(m + 1))) for _ in range(AXES))
    return Line(m, n, random.randrange(1 << AXES), last)


@cocotb.test()
async def random_paths_match_the_formula(dut: HierarchyObject) -> None:
    """Random lines, pushed while others are made: every step on the clock and in the direction due."""
    random = rng("line")
    lines = await Lines.begin(dut)
    for _ in range(15):
        count = random.randrange(2, 60)
        sequence = [random_line(random, last=k == count - 1) for k in range(count)]
        ahead, later = sequence[: 1 << DEPTH_LOG2], sequence[1 << DEPTH_LOG2 :]
        for line in ahead:
            await lines.bus.push(line.words())
        await lines.start()
        if later:
            await gather(lines.feed(later), lines.make_slowly(sequence))
        else:
            await lines.make(sequence, gaps(random))
        lines.check_end(ended=True, underruns=0)
        await lines.strobe("release_line")
        await lines.clocks.wait(2)
        assert read(dut.room) == 1 << DEPTH_LOG2
    dut._log.info(f"{await lines.compare()} steps compared")
