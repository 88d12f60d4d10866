# SPDX-License-Identifier: MIT
"""passo_encoder: counts are the transitions of the shaft; glitches and jumps are none."""

from typing import Any

import cocotb
from cocotb.handle import HierarchyObject

from cocotb_tests.helpers.bench import patience, rng
from cocotb_tests.helpers.encoder_model import Pair
from cocotb_tests.helpers.runner import run

LATENCY = 4  # pin to count, without the filter
GRAY = ((0, 0), (1, 0), (1, 1), (0, 1))  # A and B while the shaft turns up
OUTPUTS = {
    name: (lambda model, _wires, name=name: getattr(model, name))
    for name in ("count_made", "count_down", "index_event", "illegal")
}


def test_encoder(simulator: str) -> None:
    run(__name__, "passo_encoder", simulator=simulator)


class Shaft:
    """Module and model, and what the counts sum up to."""

    def __init__(self, pair: Pair) -> None:
        self.pair = pair
        self.count = 0
        self.made = 0
        self.indexes: list[int] = []  # the count at each
        self.illegal = 0

    @classmethod
    async def begin(cls, dut: HierarchyObject, **settings: int) -> "Shaft":
        """Reset with all pins low."""
        pair = await Pair.begin(dut, "encoder", OUTPUTS)
        pair.c.passo_encoder_reset(pair.model)
        pair.compare()
        pair.set(**settings)
        return cls(pair)

    async def clock(self, **pins: int) -> None:
        """One clock with these pins."""
        self.take(await self.pair.clock(**pins))

    async def wait(self, clocks: int) -> None:
        """Clocks in which no pin changes."""
        for _ in range(clocks):
            await self.clock()

    async def turn_to(self, position: int, clocks: int = 1) -> None:
        """Set A and B as at this position of the shaft."""
        a, b = GRAY[position % 4]
        await self.clock(a=a, b=b)
        await self.wait(clocks - 1)

    async def reset(self, clocks: int) -> None:
        """A reset."""
        self.pair.dut.rst.value = 1
        for _ in range(clocks):
            self.pair.before[0] = self.pair.model[0]
            self.pair.c.passo_encoder_clock(self.pair.model, self.pair.wires)
            self.pair.c.passo_encoder_restart(self.pair.model, self.pair.before)
            await self.pair.clocks.fall
            self.take(self.pair.compare())
        self.pair.dut.rst.value = 0

    def take(self, outputs: dict[str, Any]) -> None:
        """Sum up."""
        if outputs["count_made"]:
            self.count += -1 if outputs["count_down"] else 1
            self.made += 1
        if outputs["index_event"]:
            self.indexes.append(self.count)
        self.illegal = outputs["illegal"]


@cocotb.test()
@cocotb.parametrize(length=[0, 1, 7, 255])
async def the_count_is_the_position_of_the_shaft(dut: HierarchyObject, length: int) -> None:
    """4 + filter clocks after the pins, however the shaft turns, as fast as the filter allows."""
    random = rng(f"encoder, shaft, {length}")
    shaft = await Shaft.begin(dut, filter=length)
    delay = [0] * (LATENCY + length - 1)  # positions on their way
    position = 0
    direction = 1
    for _ in range(patience(400, 150) if length < 255 else 20):
        if random.random() < 0.2:
            direction = -direction
        position += direction
        # each line keeps its level for at least filter + 1 clocks
        for n in range(length + 1 + random.choice((0, 0, 0, 1, 5))):
            if n == 0:
                await shaft.turn_to(position)
            else:
                await shaft.clock()
            delay.append(position)
            assert shaft.count == delay.pop(0)
    assert shaft.illegal == 0


@cocotb.test()
@cocotb.parametrize(length=[1, 5, 30])
async def glitches_up_to_the_filter_never_count(dut: HierarchyObject, length: int) -> None:
    """Pulses of up to `filter` clocks on any line, alone or all together, while the shaft turns slowly."""
    random = rng(f"encoder, glitches, {length}")
    shaft = await Shaft.begin(dut, filter=length)
    level = {"a": 0, "b": 0, "index": 0}
    position = 0
    for _ in range(patience(300, 80)):
        if random.random() < 0.5:
            position += random.choice((-1, 1))
            level["a"], level["b"] = GRAY[position % 4]
            await shaft.clock(**level)
            await shaft.wait(length + 2)
        lines = random.sample(sorted(level), random.randint(1, 3))
        await shaft.clock(**{line: 1 - level[line] for line in lines})
        await shaft.wait(random.randrange(length))
        await shaft.clock(**level)
        await shaft.wait(length + LATENCY)
        assert shaft.count == position
    assert shaft.illegal == 0 and not shaft.indexes


@cocotb.test()
async def one_clock_more_than_the_filter_always_counts(dut: HierarchyObject) -> None:
    """A pulse of filter + 1 clocks is a count up and one down, and an index."""
    shaft = await Shaft.begin(dut)
    for length in (0, 1, 2, 9, 254, 255):
        made, indexes = shaft.made, len(shaft.indexes)
        await shaft.clock(filter=length, a=1, index=1)
        await shaft.wait(length)
        await shaft.clock(a=0, index=0)
        await shaft.wait(length + LATENCY)
        assert (shaft.made, len(shaft.indexes)) == (made + 2, indexes + 1)
    assert shaft.count == 0 and shaft.illegal == 0


@cocotb.test()
async def a_line_that_flickers_on_every_clock(dut: HierarchyObject) -> None:
    """With a filter nothing is counted, the other line as always; without one each edge is a count."""
    shaft = await Shaft.begin(dut, filter=1)
    for n in range(200):
        await shaft.clock(a=n & 1, index=n & 1, b=n // 50 & 1)
    await shaft.clock(a=0, index=0)
    await shaft.wait(10)
    assert shaft.made == 3 and not shaft.indexes
    start, shaft.made = shaft.count, 0
    await shaft.clock(filter=0)
    for n in range(200):
        await shaft.clock(a=n & 1, index=n & 1)
        assert abs(shaft.count - start) <= 1
    await shaft.wait(10)
    assert shaft.made == 199 and shaft.illegal == 0 and len(shaft.indexes) == 100


@cocotb.test()
async def both_lines_together_are_no_count(dut: HierarchyObject) -> None:
    """They are counted apart, up to 255, until cleared."""
    shaft = await Shaft.begin(dut, filter=2)
    for n in range(1, 300):
        await shaft.clock(a=n & 1, b=n & 1)
        await shaft.wait(8)
        assert shaft.illegal == min(n, 255)
    await shaft.clock(clear=1)
    assert shaft.illegal == 0 and shaft.count == shaft.made == 0


@cocotb.test()
async def a_gated_index_is_always_at_the_same_count(dut: HierarchyObject) -> None:
    """Its edges up to 2 clocks before or after those of A and B, and the shaft turning up or down."""
    random = rng("encoder, index")
    shaft = await Shaft.begin(dut, index_gated=1)
    for _ in range(patience(200, 60)):
        for position in range(8):
            # high at the positions 1 .. 2: the gate is position 2
            skew = random.randint(-2, 2)
            index = int(position in (1, 2))
            if skew < 0:
                await shaft.clock(index=index)
                await shaft.wait(-skew - 1)
            await shaft.turn_to(position)
            if skew > 0:
                await shaft.wait(skew - 1)
            await shaft.clock(index=index)
            await shaft.wait(3)
        await shaft.wait(5)
    at = {count % 8 for count in shaft.indexes}
    assert at == {2} and len(shaft.indexes) == patience(200, 60)


@cocotb.test()
async def an_encoder_that_is_not_connected_does_nothing(dut: HierarchyObject) -> None:
    """Pins that stay at any level, through a reset: no count, no index."""
    shaft = await Shaft.begin(dut)
    for levels in range(8):
        for inverted in (0, 1):
            pins = {"a": levels & 1, "b": levels >> 1 & 1, "index": levels >> 2}
            await shaft.clock(**pins, index_inverted=inverted)
            await shaft.reset(3)
            before = (shaft.made, len(shaft.indexes))
            await shaft.wait(20)
            assert (shaft.made, len(shaft.indexes)) == before and shaft.illegal == 0


@cocotb.test()
async def random_pins_and_settings_match_the_model(dut: HierarchyObject) -> None:
    """Anything at any clock, resets too."""
    random = rng("encoder")
    shaft = await Shaft.begin(dut)
    for _ in range(patience(6000, 1500)):
        changes: dict[str, int] = {}
        for pin in ("a", "b", "index"):
            if random.random() < 0.3:
                changes[pin] = random.randrange(2)
        if random.random() < 0.01:
            changes["filter"] = random.choice((0, 1, 2, random.randrange(20)))
        for setting in ("inverted", "index_inverted", "index_gated"):
            if random.random() < 0.01:
                changes[setting] = random.randrange(2)
        changes["clear"] = int(random.random() < 0.01)
        await shaft.clock(**changes)
        if random.random() < 0.005:
            await shaft.reset(random.randint(1, 3))
    assert shaft.made > 100 and shaft.illegal > 0 and shaft.indexes
