# SPDX-License-Identifier: MIT
"""Method B: an S by a table of the logistic function."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from benchmarks.sources.pulses import MILLISECONDS, Pulses, pulses_from_periods


@dataclass(frozen=True)
class Sigmoid:
    """A move by frequencies (Hz) and whole ramp times (ms); alpha says how sharply the S is bent."""

    steps: int
    start: int
    run: int
    stop: int
    up_ms: int
    down_ms: int
    alpha: float

    TIMER_HZ = 12_000_000


def formula(alpha: float, i: float, half: float) -> float:
    """1 / (1 + exp(-alpha (i - N) / N)), i = 0 .. 2N: which part of the change of frequency is made.

    It neither starts at 0 nor ends at 1: 0.7 % are missing at either end for alpha = 5, 4.7 % for alpha = 3.
    """
    return 1 / (1 + math.exp(-alpha * (i - half) / half))


@cache
def logistic_table() -> tuple[int, ...]:
    """1024 values of 65535 / (1 + exp(-x)), x evenly over -5 .. 5."""
    return tuple(int(65535 / (1 + math.exp(5 - 10 * i / 1023))) for i in range(1024))


def index(alpha: float, n: int, half: int) -> int:
    """Where in the table the ramp is after n ms, if half of it takes `half` ms.

    With alpha in 1/4096: `d = alpha n / half`, at most 32767; `x = 4 * 4096 - (alpha - d)`, at least 0;
    `index = x / 32`, at most 1023. A full table would be -5 .. 5, but x is made for -4 .. 4: at alpha = 5
    the ramp goes from index 0 to 895, which is 2.3 % short of its end.
    """
    fixed = round(alpha * 4096)
    d = min(fixed * n // half, 32767)
    return min(max(4 * 4096 - (fixed - d), 0) // 32, 1023)


@dataclass(frozen=True)
class _Runs:
    """Groups of pulses of equal length in timer clocks, in order; `last` is the last frequency."""

    periods: list[int]
    counts: list[int]
    last: int

    @property
    def pulses(self) -> int:
        return sum(self.counts)

    @property
    def clocks(self) -> int:
        return sum(period * count for period, count in zip(self.periods, self.counts, strict=True))


def _ramp(move: Sigmoid, begin: int, end: int, ms: int, clock: int) -> _Runs:
    """From one frequency to another, where a ms began `clock` ago. Pulses begun in the same ms are equal."""
    table, tick = logistic_table(), move.TIMER_HZ // MILLISECONDS
    periods, counts, f = [], [], begin
    while (n := clock // tick) < ms:
        part = abs(end - begin) * table[index(move.alpha, n, ms // 2)] // 65535
        f = max(begin + part if end >= begin else begin - part, 200)
        periods.append(move.TIMER_HZ // f)
        counts.append(-(-((n + 1) * tick - clock) // periods[-1]))
        clock += counts[-1] * periods[-1]
    return _Runs(periods, counts, f)


def simulate(move: Sigmoid) -> Pulses:
    """A timer of 1 ms counts n, and the interrupt of a pulse takes the frequency of the next from it:

        speed up    f = (run - start) table[index] / 65535 + start, at least 200, until n is the ramp time
        run         the frequency reached, until `total <= steps + stop_remain_steps`
        slow down   f = reached - (reached - stop) table[index] / 65535, until n is the ramp time
        stop        f = stop, until all steps are made

    stop_remain_steps is left to the user, who here has found out what slowing down takes. The clock of the
    pulse timer is open; here it is the fastest at which 200 Hz fit 16 bits, 72 MHz / 6.
    """
    up = _ramp(move, move.start, move.run, move.up_ms, 0)
    stop_remain_steps = _ramp(move, up.last, move.stop, move.down_ms, 0).pulses
    period, cruise = move.TIMER_HZ // up.last, max(move.steps - stop_remain_steps - up.pulses, 0)
    clock = (up.clocks + cruise * period) % (move.TIMER_HZ // MILLISECONDS)
    down = _ramp(move, up.last, move.stop, move.down_ms, clock)
    rest = max(move.steps - up.pulses - cruise - down.pulses, 0)

    periods = [*up.periods, period, *down.periods, move.TIMER_HZ // max(move.stop, 200)]
    every = np.repeat(periods, [*up.counts, cruise, *down.counts, rest])[: move.steps]
    times, seconds = pulses_from_periods(every, move.TIMER_HZ)
    return Pulses(times, seconds, *(move.TIMER_HZ / float(p) for p in (every[0], period, every[-1])))
