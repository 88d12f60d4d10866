# SPDX-License-Identifier: MIT
"""The ideal motion: a speed curve in real numbers, and the distance of pulses from it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np


def _logistic(x: np.ndarray | float) -> Any:
    return 1 / (1 + np.exp(-x))


def shape_value(shape: str, alpha: float, u: np.ndarray) -> np.ndarray:
    """A curve that rises from 0 to 1 over 0 .. 1.

    linear    u
    cosine    (1 - cos(pi u)) / 2
    sigmoid   (g(alpha (2u - 1)) - g(-alpha)) / (g(alpha) - g(-alpha)), g(x) = 1 / (1 + exp(-x))
    ease      u^2, half of a jerk-limited ramp; the other half is its mirror image
    quintic   6 u^5 - 15 u^4 + 10 u^3, an example of a user-defined shape
    """
    if shape == "linear":
        return u
    if shape == "cosine":
        return (1 - np.cos(np.pi * u)) / 2
    if shape == "ease":
        return u * u
    if shape == "quintic":
        return 6 * u**5 - 15 * u**4 + 10 * u**3
    low, high = _logistic(-alpha), _logistic(alpha)
    return (_logistic(alpha * (2 * u - 1)) - low) / (high - low)


def shape_area(shape: str, alpha: float, u: np.ndarray) -> np.ndarray:
    """Its integral from 0 to u."""
    if shape == "linear":
        return u * u / 2
    if shape == "cosine":
        return u / 2 - np.sin(np.pi * u) / (2 * np.pi)
    if shape == "ease":
        return u**3 / 3
    if shape == "quintic":
        return u**6 - 3 * u**5 + 2.5 * u**4
    low = _logistic(-alpha)
    area = (np.logaddexp(0, alpha * (2 * u - 1)) - np.logaddexp(0, -alpha)) / (2 * alpha)
    return (area - low * u) / (1 - 2 * low)


@dataclass(frozen=True)
class Phase:
    """A change of speed (Hz) from `start` to `end` in `seconds`."""

    seconds: float
    start: float
    end: float
    shape: str = "linear"
    alpha: float = 5.0
    mirror: bool = False

    @property
    def steps(self) -> float:
        """Length in steps."""
        return float(self.position(np.array([self.seconds]))[0])

    def position(self, seconds: np.ndarray) -> np.ndarray:
        """Steps made since the start of the phase."""
        if self.start == self.end:
            return self.start * seconds
        u = seconds / self.seconds
        if self.mirror:
            whole, rest = shape_area(self.shape, self.alpha, np.array([np.ones_like(u), 1 - u]))
            area = u - (whole - rest)
        else:
            area = shape_area(self.shape, self.alpha, u)
        return self.start * seconds + (self.end - self.start) * self.seconds * area


class Ideal:
    """A sequence of phases, some of which may be empty."""

    def __init__(self, *phases: Phase):
        self.phases = [phase for phase in phases if phase.seconds > 0]
        self.start, self.stop = self.phases[0].start, self.phases[-1].end
        self.run = max(phase.end for phase in self.phases)
        self.begins = np.cumsum([0.0, *(phase.seconds for phase in self.phases)])
        self.seconds = float(self.begins[-1])
        self.bases = np.cumsum([0.0, *(phase.steps for phase in self.phases)])
        self.steps = float(self.bases[-1])

    def position(self, times: np.ndarray) -> np.ndarray:
        """Steps made at these times (s, ascending), constant after the end."""
        bounds = np.searchsorted(times, self.begins)
        position = np.full(len(times), self.steps)
        for i, phase in enumerate(self.phases):
            inside = slice(bounds[i], bounds[i + 1])
            position[inside] = self.bases[i] + phase.position(times[inside] - self.begins[i])
        return position

    def distances(self, times: np.ndarray, share: float = 1.0) -> np.ndarray:
        """Lead of the ideal curve over each pulse in steps; `share` is the ratio of a follower.

        Pulse q (from 0) covers the distance q to q + 1, so it belongs at q + 1/2.
        """
        return self.position(times) * share - (np.arange(len(times)) + 0.5)


def by_speed(
    steps: float, start: float, run: float, stop: float, up: float, down: float, shape: Sequence = ("linear",)
) -> Ideal:
    """A move over `steps` whose full ramps take `up` and `down` seconds, with cruise in between.

    A linear move too short for `run` becomes a triangle with the same slopes; others must be long enough.
    """
    up_way, down_way = up * (start + run) / 2, down * (run + stop) / 2
    if up_way + down_way > steps:
        if shape[0] != "linear":
            raise ValueError("too short for its ramps")
        rise, fall = up / (run - start), down / (run - stop)  # seconds per Hz
        peak = math.sqrt((2 * steps + start**2 * rise + stop**2 * fall) / (rise + fall))
        up, run, down = rise * (peak - start), peak, fall * (peak - stop)
        up_way, down_way = up * (start + run) / 2, down * (run + stop) / 2
    cruise = max(0.0, (steps - up_way - down_way) / run)
    return Ideal(Phase(up, start, run, *shape), Phase(cruise, run, run), Phase(down, run, stop, *shape))


def in_time(steps: float, seconds: float, ramp: float, shape: str) -> Ideal:
    """A move from rest to rest over `steps` in `seconds`, with ramps of `ramp` seconds each."""
    run = steps / (seconds - ramp)
    return Ideal(Phase(ramp, 0, run, shape), Phase(seconds - 2 * ramp, run, run), Phase(ramp, run, 0, shape))
