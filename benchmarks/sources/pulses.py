# SPDX-License-Identifier: MIT
"""A move by a published method: the times of its pulses."""

from dataclasses import dataclass

import numpy as np

MILLISECONDS = 1000  # in a second


@dataclass(frozen=True)
class Pulses:
    """Pulses of a move. Frequencies (Hz) are those of the timer at the start, in cruise and at the end."""

    times: np.ndarray  # of each pulse, in seconds since the start
    seconds: float
    start: float
    run: float
    stop: float
    followers: tuple[np.ndarray, ...] = ()  # times of the pulses of each other axis


def pulses_from_periods(periods: np.ndarray, clock_hz: float) -> tuple[np.ndarray, float]:
    """Time of each pulse, in the middle of its period, and the time of all (s)."""
    ends = np.cumsum(periods, dtype=np.int64)
    return (ends - periods / 2) / clock_hz, float(ends[-1] / clock_hz) if len(ends) else 0.0
