# SPDX-License-Identifier: MIT
"""Input shapers: ramps that leave a resonance of the machine at rest.

A shaper replaces a motion by the sum of copies of it, delayed by parts of the resonance's period and weighted
such that their responses cancel. Here the motion is a ramp of constant acceleration, and the sum a table for
the core. Deceleration uses the same time order, not the mirrored shape, since a damped response is not
symmetric in time.

    zv   two impulses, half a period apart: exact at its frequency (Singer and Seering, 1990)
    mzv  three, 3/8 of a period apart: less sensitive to the frequency
    ei   three, half a period apart: below 5 % of the vibration over a wide band (Singhose, 1994)
"""

import math
from collections.abc import Callable
from fractions import Fraction

import numpy as np

from passo.form_table import Points, Shaper
from passo.shape import PLACES, ShapeError, from_values

DAMPING_MAX = Fraction(1, 2)
TOLERATED = 0.05  # of the vibration, by ei

Impulses = list[tuple[float, float]]  # delays in periods of the damped resonance, and weights


def _zv(k: float) -> Impulses:
    return [(0, 1), (1 / 2, k)]


def _mzv(k: float) -> Impulses:
    half = k ** (3 / 4)
    return [
        (0, 1 - math.sqrt(1 / 2)),
        (3 / 8, (math.sqrt(2) - 1) * half),
        (3 / 4, (1 - math.sqrt(1 / 2)) * half**2),
    ]


def _ei(k: float) -> Impulses:
    outer, inner = (1 + TOLERATED) / 4, (1 - TOLERATED) / 2
    return [(0, outer), (1 / 2, inner * k), (1, outer * k * k)]


SHAPERS: dict[str, Callable[[float], Impulses]] = {"zv": _zv, "mzv": _mzv, "ei": _ei}


def impulses(shaper: Shaper) -> Impulses:
    """Delays in seconds and weights, which add up to 1; `k` is what half a period leaves of a vibration."""
    damping = float(shaper.damping)
    root = math.sqrt(1 - damping**2)
    made = SHAPERS[shaper.name](math.exp(-math.pi * damping / root))
    total, period = sum(weight for _, weight in made), 1 / (float(shaper.frequency) * root)
    return [(delay * period, weight / total) for delay, weight in made]


def shaped(shaper: Shaper, ramp_time: Fraction) -> Points:
    """The table of a shaped ramp that takes `ramp_time` seconds. Raises ShapeError if that is too short."""
    delayed = impulses(shaper)
    ramp = float(ramp_time)
    straight = ramp - delayed[-1][0]  # of each copy
    if straight <= 0:
        raise ShapeError(
            f"{shaper.name} at {float(shaper.frequency):g} Hz takes {delayed[-1][0] * 1e3:.3f} ms; "
            f"the ramp has {ramp * 1e3:.3f} ms"
        )

    time = np.array(PLACES) * ramp
    speed = np.zeros_like(time)
    for delay, weight in delayed:
        speed += weight * np.clip((time - delay) / straight, 0, 1)  # 0: the copy has not begun
    return from_values(speed.tolist())
