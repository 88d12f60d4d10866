# SPDX-License-Identifier: MIT
"""Residual vibration after a move, from the clocks of its steps: linear, cosine and shaped ramps.

All moves have the same steps, total time and ramp time, so the same peak speed. The resonance is a mass on a
spring with damping; each step moves the end of the spring.
"""

import math
from fractions import Fraction
from typing import Any

import numpy as np
from passo.form_table import Shaper
from passo.moves import Move, MoveInTime
from passo.plan import plan_move
from passo.shaper import SHAPERS

from benchmarks.passo_side import CLOCK_HZ, PARAMETERS, step_clocks

FREQUENCY, DAMPINGS = 40, (Fraction(0), Fraction(1, 10))
# the resonance beside the one that the shaper is for
DETUNED = (Fraction(9, 10), Fraction(1), Fraction(11, 10))
STEPS, TOTAL, RAMP = 3200, Fraction(173, 1000), Fraction(58, 1000)


def moves(damping: Fraction) -> dict[str, Move]:
    """The same move with each kind of ramp."""
    made: dict[str, Move] = {
        profile: MoveInTime((STEPS,), profile, TOTAL, RAMP) for profile in ("linear", "cosine")
    }
    for name in SHAPERS:
        shaper = Shaper(name, Fraction(FREQUENCY), damping)
        made[name] = MoveInTime((STEPS,), "shaped", TOTAL, RAMP, shaper=shaper)
    return made


def residual(move: Move, frequency: float, damping: float) -> float:
    """Amplitude in steps that is left when the motion ends.

    A step excites `exp(-damping w t) / sqrt(1 - damping^2)` of vibration: the phasors of all steps add up.
    """
    plan = plan_move(move, CLOCK_HZ, PARAMETERS)
    (clocks,), _ = step_clocks(plan)
    root = math.sqrt(1 - damping**2)
    ago = (plan.clocks - np.asarray(clocks, float)) / CLOCK_HZ * 2 * math.pi * frequency
    return float(abs(np.exp((-damping + 1j * root) * ago).sum()) / root)


def measure_resonances() -> list[dict[str, Any]]:
    """A row for each kind of ramp and damping, with what is left at each frequency."""
    return [
        {
            "ramp": name,
            "damping": float(damping),
            "left": [residual(move, float(part * FREQUENCY), float(damping)) for part in DETUNED],
        }
        for damping in DAMPINGS
        for name, move in moves(damping).items()
    ]
