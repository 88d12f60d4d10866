# SPDX-License-Identifier: MIT
"""Method C: several axes, the others follow the main one."""

import math
from dataclasses import dataclass

import numpy as np

from benchmarks.sources.pulses import Pulses, pulses_from_periods


@dataclass(frozen=True)
class MultiAxis:
    """A coordinated move; speeds of the main axis in pulses per ms, `1 <= v0`, `vmax <= 100`."""

    steps: tuple[int, ...]  # the main axis, that with the most, comes first
    v0: int
    vmax: int
    t_acc: int  # ms, at most 250: the length of the table

    TIMER_HZ = 72_000_000
    PRESCALER = 1

    @property
    def acceleration(self) -> np.float32:
        """Pulses per ms, per ms."""
        return np.float32(self.vmax - self.v0) / np.float32(self.t_acc)

    @property
    def cruises(self) -> bool:
        """Whether it has the length for vmax."""
        return float((2 * self.v0 + self.acceleration * (self.t_acc - 1)) * self.t_acc) < self.steps[0]


def pulses_each_ms(move: MultiAxis, ms: int) -> np.ndarray:
    """Pulses in each ms of a ramp, `v0 + acc i` truncated."""
    return (np.float32(move.v0) + move.acceleration * np.arange(ms, dtype=np.float32)).astype(np.int64)


def period(move: MultiAxis, pulses: np.ndarray) -> np.ndarray:
    """Of a pulse, in timer clocks: two interrupts with `reload = 36000 / pulses / (psc + 1) - 1`."""
    return 2 * (36000 // pulses // move.PRESCALER)


def follower(v_main: int, v_sub: int) -> np.ndarray:
    """The pulses of the main axis, from 0, on which a follower makes one, for v_main of them.

    From `sy = ceil(v_main / 2)`, with `st = v_main - v_sub`, on each pulse of the main axis:
    `sy >= st`: a pulse and `sy -= st`, else `sy += v_sub`. So after m of them `sy` is
    `ceil(v_main / 2) + m v_sub - v_main * pulses`, and pulse k (from 1) comes with the first m for which
    `ceil(v_main / 2) + m v_sub >= k v_main`.
    """
    if v_sub == 0:
        return np.empty(0, np.int64)
    return -((-(-v_main // 2) - np.arange(1, v_sub + 1, dtype=np.int64) * v_main) // v_sub) - 1


def simulate(move: MultiAxis) -> Pulses:
    """Trapezoid if `(2 v0 + acc (t_acc - 1)) t_acc < L`; else the ramps take t_up ms,
    `t_up = (sqrt(4 v0^2 + 4 acc L) - 2 v0) / (2 acc)` truncated.

    What the ramps leave of L is made at vmax or, in a triangle, at the speed then reached, v0 + acc t_up.
    Followers go by their steps, so that their number is right for any ratio.
    """
    length, acc = move.steps[0], float(move.acceleration)
    ms, peak = move.t_acc, move.vmax
    if not move.cruises:
        ms = int((math.sqrt(4 * move.v0**2 + 4 * acc * length) - 2 * move.v0) / (2 * acc))
        peak = int(move.v0 + acc * ms)
    pulses = pulses_each_ms(move, ms)
    counts = np.concatenate([pulses, [length - 2 * pulses.sum()], pulses[::-1]])
    speeds = np.concatenate([pulses, [peak], pulses[::-1]])
    periods = np.repeat(period(move, speeds), counts)
    clock_hz = move.TIMER_HZ / move.PRESCALER
    times, seconds = pulses_from_periods(periods, clock_hz)
    followers = tuple(times[follower(length, sub)] for sub in move.steps[1:])
    start, run, stop = (clock_hz / period for period in (periods[0], periods.min(), periods[-1]))
    return Pulses(times, seconds, start, run, stop, followers)
