# SPDX-License-Identifier: MIT
"""Encoders at the pins of the core: shafts that turn by themselves or with the steps of their axis."""

from collections.abc import Iterable

from cocotb.triggers import Event, ValueChange
from passo import registers as r
from passo.cocotb.clocks import PERIOD, read
from passo.cocotb.host import wait

from cocotb_tests.helpers.core_bench import Core, CoreChannel

GRAY = ((0, 0), (1, 0), (1, 1), (0, 1))  # A and B while a shaft turns up
FOLLOW = 1 << r.CHANNEL_FOLLOW_FOLLOW_LSB
WAIT_INDEX = 1 << r.CHANNEL_FOLLOW_WAIT_INDEX_LSB


def follow_word(source: int, scale: int = 0, wait_index: bool = False) -> int:
    """The register FOLLOW."""
    word = FOLLOW | source << r.CHANNEL_FOLLOW_SOURCE_LSB | scale << r.CHANNEL_FOLLOW_SCALE_LSB
    return word | (WAIT_INDEX if wait_index else 0)


def encoder_address(channel: CoreChannel, axis: int, register: int) -> int:
    """Word address of a register of an encoder."""
    return channel.base + r.CHANNEL_ENCODER_BASE + axis * r.CHANNEL_ENCODER_STRIDE + register


class Shafts:
    """The encoders of all axes; the index is high at multiples of `per_turn` counts."""

    def __init__(self, core: Core, per_turn: int = 64) -> None:
        self.core, self.per_turn = core, per_turn
        axes = core.axes * core.parameters.channels
        self.at = [0] * axes
        self.counts: list[list[tuple[int, int]]] = [[] for _ in range(axes)]  # clock, place after it

    def _drive(self) -> None:
        dut = self.core.dut
        lines = [GRAY[at % 4] for at in self.at]
        dut.encoder_a.value = sum(a << n for n, (a, _) in enumerate(lines))
        dut.encoder_b.value = sum(b << n for n, (_, b) in enumerate(lines))
        dut.encoder_index.value = sum((at % self.per_turn == 0) << n for n, at in enumerate(self.at))

    def move(self, axis: int, counts: int) -> None:
        """Change the pins now, in the simulation; a jump by 2 is an illegal transition."""
        self.at[axis] += counts
        # the clock at whose rising edge the core sees it
        self.counts[axis].append((self.core.clock + 1, self.at[axis]))
        self._drive()

    def turn(self, axis: int, moves: Iterable[tuple[int, int]]) -> None:
        """From now on, beside everything else: wait for some clocks, then move by some counts, and so on."""

        async def run() -> None:
            for clocks, counts in moves:
                await wait(clocks * PERIOD)
                self.move(axis, counts)

        self.core.spawn(run)

    def follow_steps(self, axis: int, counts_per_step: int, clocks: int, slip: int = 0) -> None:
        """From now on a shaft turns with its axis, a count every `clocks`; each `slip`th step is lost."""

        dut = self.core.dut
        owed = 0
        stepped = Event()

        async def watch() -> None:
            nonlocal owed
            steps, level = 0, read(dut.step) >> axis & 1
            while True:
                await ValueChange(dut.step)
                was, level = level, read(dut.step) >> axis & 1
                steps += level and not was
                if level and not was and (not slip or steps % slip):
                    owed += -counts_per_step if read(dut.dir) >> axis & 1 else counts_per_step
                    stepped.set()

        async def run() -> None:
            nonlocal owed
            while True:
                stepped.clear()
                await stepped.wait()
                await self.core.clocks.fall
                while owed:
                    self.move(axis, 1 if owed > 0 else -1)
                    owed += -1 if owed > 0 else 1
                    await wait(clocks * PERIOD)

        self.core.spawn(watch)
        self.core.spawn(run)


def positions(channel: CoreChannel) -> list[int]:
    """Counts of all encoders of a channel, all sampled at the same time."""
    words = channel.link.read(channel.base + r.CHANNEL_ENCODER_POSITION_BASE, channel.core.axes)
    return [word - (word >> 31 << 32) for word in words]


def error(channel: CoreChannel, axis: int) -> float:
    """Following error in counts."""
    (word,) = channel.link.read(encoder_address(channel, axis, r.ENCODER_ERROR), 1)
    return (word - (word >> 31 << 32)) / 256
