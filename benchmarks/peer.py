# SPDX-License-Identifier: MIT
"""Jerk-limited moves, and straight lines within limits per axis, against the time-optimal plans of ruckig.

ruckig plans in floating point and in continuous time; a plan of Passo consists of whole ticks, rounded up.
"""

import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import ruckig
from passo.moves import Move, MoveJerk, MoveStraight
from passo.plan import plan_move

from benchmarks.forms import FORMS
from benchmarks.passo_side import CLOCK_HZ, PARAMETERS, TICK_SECONDS

MOVES = 20_000  # of each kind
LONG_SECONDS = 0.05  # relative errors of moves shorter than this say only that a tick is long
KINDS = ("Jerk-limited in seven phases", "Straight line within limits per axis")


def limits(move: Move) -> tuple[float, ...]:
    """Distance, start, top and stop speed, acceleration and jerk (0: none) of the leading axis, in steps."""
    match move:
        case MoveJerk():
            facts = (abs(move.steps[0]), move.start_speed, move.speed, move.stop_speed)
            return tuple(map(float, (*facts, move.acceleration, move.jerk)))
        case MoveStraight():
            return _of_line(move)
    raise TypeError(type(move).__name__)


def _of_line(move: MoveStraight) -> tuple[float, ...]:
    steps = [abs(count) for count in move.steps]
    longest = max(steps)

    def lowest(of_axes: tuple[Fraction, ...]) -> Fraction:
        """The limit of the leading axis, of which every axis keeps its own."""
        scaled = zip(of_axes, move.steps_per_mm, steps, strict=True)
        return min(limit * scale * longest / count for limit, scale, count in scaled if count)

    length = float(sum(distance**2 for distance in move.distance)) ** 0.5
    speed = min(float(lowest(move.speed)), float(move.feed) * longest / length)
    return float(longest), 0.0, speed, 0.0, float(lowest(move.acceleration)), float(lowest(move.jerk))


def seconds(distance: float, start: float, speed: float, stop: float, rise: float, jerk: float) -> float:
    """The shortest time, by ruckig; in units in which speed and acceleration are 1."""
    unit = speed / rise
    wanted = ruckig.InputParameter(1)
    wanted.current_velocity, wanted.target_velocity = [start / speed], [stop / speed]
    wanted.target_position = [distance / (speed * unit)]
    wanted.max_velocity = wanted.max_acceleration = [1.0]
    wanted.max_jerk = [jerk * unit / rise if jerk else float("inf")]
    found = ruckig.Trajectory(1)
    result = ruckig.Ruckig(1).calculate(wanted, found)
    if result != ruckig.Result.Working:
        raise RuntimeError(f"ruckig: {result}")
    return found.duration * unit


def compare_with_peer(name: str, count: int, seed: int) -> dict[str, Any]:
    """Differences of the total time: in ticks, and relative to the time of ruckig."""
    rng = random.Random(f"{seed} {name} against a peer")
    make: Callable[[random.Random], Move] = FORMS[name]
    moves = [make(rng) for _ in range(count)]
    ours = np.array([plan_move(move, CLOCK_HZ, PARAMETERS).clocks / CLOCK_HZ for move in moves])
    theirs = np.array([seconds(*limits(move)) for move in moves])
    over = (ours / theirs - 1)[theirs >= LONG_SECONDS]
    return {
        "moves": count,
        "fewest_ticks": float(((ours - theirs) / TICK_SECONDS).min()),
        "most_ticks": float(((ours - theirs) / TICK_SECONDS).max()),
        "long_moves": len(over),
        "median": float(np.median(over)),
        "999 of 1000": float(np.quantile(over, 0.999)),
        "worst": float(over.max()),
    }
