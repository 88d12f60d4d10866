# SPDX-License-Identifier: MIT
"""Method A: a trapezoid by a recurrence in integers."""

import math
from dataclasses import dataclass

import numpy as np

from benchmarks.sources.pulses import Pulses


@dataclass(frozen=True)
class Trapezoid:
    """A move by angle and rpm: 200 full steps of 8 microsteps are 1600 pulses or 3200 updates a turn."""

    degrees: float
    rpm: int
    rpm_min: int

    ACCELERATION = 40_000  # updates/s^2
    UPDATES = 3200  # per turn
    TIMER_HZ = 1_000_000

    @property
    def v_target(self) -> int:
        """Updates per second at full speed."""
        return self.rpm * self.UPDATES // 60

    @property
    def v_min(self) -> int:
        """Updates per second at the start and at the end."""
        return self.rpm_min * self.UPDATES // 60

    @property
    def n_target(self) -> int:
        """Updates in all."""
        return int(abs(self.degrees) / 360 * self.UPDATES)

    @property
    def n_acc(self) -> int:
        """Updates for speeding up."""
        return (self.v_target**2 - self.v_min**2) // 2 // self.ACCELERATION

    @property
    def cruises(self) -> bool:
        """Whether the move has a middle part."""
        return self.n_acc < self.n_target // 2


def update_speeds(move: Trapezoid) -> list[int]:
    """v before the first update and after each but the last. On update n, from 1 to n_target:

        n < n_acc                               v = sqrt(v^2 + 2 a)
        n_target - n > n_acc, if it cruises     v = v_target
        else                                    v = sqrt(v^2 - 2 a)

    and v is kept within v_min .. v_target. It is an integer, so that each root is truncated: from 40000
    updates/s on it does not grow at all. In a move that does not cruise, n_acc still is what v_target would
    take, so that such a move slows down too late, or not at all. (A root of less than 0 is taken as 0.)
    """
    low, target, twice = move.v_min, move.v_target, 2 * move.ACCELERATION
    n_acc, n_target = move.n_acc, move.n_target
    v, speeds = low, [low]
    for _ in range(1, min(n_acc, n_target)):
        v = min(math.isqrt(v * v + twice), target)
        speeds.append(v)
    if move.cruises:
        cruise = n_target - n_acc - len(speeds)
        if cruise > 0:
            v = target
            speeds += [v] * cruise
    for _ in range(n_target - len(speeds)):
        v = max(math.isqrt(max(v * v - twice, 0)), low)
        speeds.append(v)
    return speeds


def simulate(move: Trapezoid) -> Pulses:
    """Timer at 1 MHz with `reload = 1000000 / v - 1`; every other update, from the first on, is a pulse."""
    periods = move.TIMER_HZ // np.array(update_speeds(move), dtype=np.int64)
    updates = np.cumsum(periods)
    start, run, stop = (move.TIMER_HZ / 2 / period for period in (periods[0], periods.min(), periods[-1]))
    return Pulses(updates[::2] / move.TIMER_HZ, updates[-1] / move.TIMER_HZ, start, run, stop)
