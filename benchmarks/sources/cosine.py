# SPDX-License-Identifier: MIT
"""Method D: cosine ramps in slices of a millisecond."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from benchmarks.sources.pulses import MILLISECONDS, Pulses


@dataclass(frozen=True)
class Cosine:
    """A move of n pulses in a given time (ms), speeding up and slowing down in ramp_ms each."""

    steps: int
    total_ms: int
    ramp_ms: int

    TIMER_HZ = 48_000_000

    @property
    def f_max(self) -> float:
        """n / (t_i - t_s)."""
        return self.steps * MILLISECONDS / (self.total_ms - self.ramp_ms)


@cache
def _shape(total_ms: int, ramp_ms: int) -> np.ndarray:
    """f(t) / f_max at the start of each slice."""
    t = np.arange(total_ms, dtype=float)
    nearest = np.minimum(np.minimum(t, total_ms - t), ramp_ms)  # to an end of the move
    return (1 - np.cos(np.pi * nearest / max(ramp_ms, 1))) / 2 if ramp_ms else np.ones(total_ms)


def slices_at(move: Cosine, f_max: float) -> np.ndarray:
    """Pulses in each slice of TS = 1 ms: `floor(f(i TS) TS)`, with
    `f(t) = f_max / 2 (1 - cos(pi t / t_s))`, then f_max, then the mirror image.
    """
    return (_shape(move.total_ms, move.ramp_ms) * (f_max / MILLISECONDS)).astype(np.int64)


def repaired(move: Cosine) -> np.ndarray:
    """The slices after both repairs; their sum is n, but their number need not be t_i any more.

    The sum of the slices falls short of n. Coarse: raise f_max (by 1 Hz) until the sum brackets n, and take
    the nearer bracket. Fine: make up for the rest with slices of the cruise or, where there is none, with a
    pulse more or less in each of the last slices (which gives the published times). Pulses that do not fill
    a slice of the cruise have one to themselves.
    """
    low, high = math.floor(move.f_max), 2 * math.ceil(move.f_max) + 2 * MILLISECONDS
    while high - low > 1:  # the sum grows with f_max
        middle = (low + high) // 2
        low, high = (low, middle) if slices_at(move, middle).sum() >= move.steps else (middle, high)
    below, above = slices_at(move, low), slices_at(move, high)
    slices = below if move.steps - below.sum() < above.sum() - move.steps else above
    rest = int(move.steps - slices.sum())
    cruise_begin, cruise_end = move.ramp_ms, move.total_ms - move.ramp_ms
    if cruise_end > cruise_begin:
        full, part = divmod(rest, int(slices[cruise_begin]))  # rest < 0: slices less, and one in part
        cruise = slices[cruise_begin:cruise_end]
        cruise = cruise[-full:] if full < 0 else np.concatenate([cruise, np.full(full, cruise[0])])
        cruise = np.concatenate([cruise, np.full(min(part, 1), part)])
        return np.concatenate([slices[:cruise_begin], cruise, slices[cruise_end:]])
    while rest:
        changed = np.flatnonzero(slices > 0 if rest < 0 else slices >= 0)[-abs(rest) :]
        slices[changed] += 1 if rest > 0 else -1
        rest = int(move.steps - slices.sum())
    return slices


def simulate(move: Cosine) -> Pulses:
    """The pulses of a slice are even, at `48000 / pulses` timer clocks; the rest of the slice is empty."""
    slices = repaired(move)
    begins = np.repeat(np.arange(len(slices)), slices) * (move.TIMER_HZ // MILLISECONDS)
    periods = np.repeat(move.TIMER_HZ // MILLISECONDS // np.maximum(slices, 1), slices)
    number = np.arange(len(periods)) - np.repeat(np.cumsum(slices) - slices, slices)  # within its slice
    times = (begins + (number + 0.5) * periods) / move.TIMER_HZ
    run = move.TIMER_HZ / (move.TIMER_HZ // MILLISECONDS // int(slices.max()))
    return Pulses(times, len(slices) / MILLISECONDS, 0.0, run, 0.0)
