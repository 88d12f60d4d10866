# SPDX-License-Identifier: MIT
"""Ramps in integers, from the recurrence of docs/architecture.md."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache

from cocotb_tests.helpers.shapes import PROGRESS_ONE, Shape, evaluate, loaded_table

V_MAX = 1 << 47  # 1/2 substep per clock
ONE = 1 << 48


@dataclass(frozen=True)
class Ramp:
    """A ramp command; `progress_step` None: the value of the planner."""

    v_end: int
    ticks: int
    shape: Shape = Shape.LINEAR
    mirror: bool = False
    last: bool = False
    now: bool = False
    progress_step: int | None = None

    @property
    def du(self) -> int:
        """Progress per tick."""
        if self.progress_step is not None:
            return self.progress_step
        if self.ticks == 0:
            return 0
        if self.ticks > 1 << 24:
            return ONE // self.ticks
        return min(ONE - 1, (ONE + self.ticks // 2) // self.ticks)

    def words(self) -> list[int]:
        """Payload words."""
        control = self.last | self.now << 1 | self.mirror << 2 | self.shape << 4
        return [
            self.v_end >> 32 << 16 | control,
            self.v_end & 0xFFFFFFFF,
            self.ticks,
            self.du >> 32,
            self.du & 0xFFFFFFFF,
        ]

    def velocities(self, v_start: int) -> Iterator[int]:
        """Velocity of each tick."""
        u = self.du  # half a step, of UQ0.49
        for _ in range(self.ticks):
            at, a, b = (
                (PROGRESS_ONE - 1 - u, self.v_end, v_start) if self.mirror else (u, v_start, self.v_end)
            )
            yield a + ((b - a) * evaluate(at, _table(self.shape)) >> 24)
            u = (u + 2 * self.du) % PROGRESS_ONE


@cache
def _table(shape: Shape) -> list[int] | None:
    return None if shape == Shape.LINEAR else loaded_table(shape)


def velocities(ramps: Iterable[Ramp], v_start: int = 0) -> Iterator[int]:
    """Velocity of each tick under ramps that follow each other."""
    for ramp in ramps:
        yield from ramp.velocities(v_start)
        v_start = ramp.v_end
