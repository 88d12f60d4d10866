# SPDX-License-Identifier: MIT
"""Forms without a published counterpart: random moves, measured against their plan and requested time."""

import random
from collections.abc import Callable
from fractions import Fraction

import numpy as np
from passo.move_forms import PROFILES, USER, Points
from passo.moves import (
    Move,
    MoveAtSpeed,
    MoveBelowSpeed,
    MoveInTime,
    MoveJerk,
    MoveStraight,
)
from passo.plan import plan_move
from passo.shape import sample

from benchmarks.passo_side import CLOCK_HZ, PARAMETERS, TICK_SECONDS, planned_curve, step_clocks

USERS_SHAPE = "quintic"
MICRO = 1_000_000


def quintic() -> Points:
    """The points of the user-defined shape."""
    return sample(lambda u: 6 * u**5 - 15 * u**4 + 10 * u**3)


def _speed(rng: random.Random) -> Fraction:
    return Fraction(rng.randint(1000, 60_000))


def _seconds(rng: random.Random, low: float, high: float) -> Fraction:
    return Fraction(rng.randint(round(low * MICRO), round(high * MICRO)), MICRO)


def _times(rng: random.Random) -> tuple[tuple[int], Fraction, Fraction]:
    """Steps, total and ramp time."""
    total = _seconds(rng, 0.05, 0.5)
    ramp = total / 2 * rng.randint(0, 10) / 10
    return (max(1, int(_speed(rng) * (total - ramp))),), total, ramp


def _in_time(rng: random.Random) -> MoveInTime:
    steps, total, ramp = _times(rng)
    return MoveInTime(steps, rng.choice(PROFILES), total, ramp)


def _user_in_time(rng: random.Random) -> MoveInTime:
    steps, total, ramp = _times(rng)
    return MoveInTime(steps, USER, total, ramp, quintic())


def _below_speed(rng: random.Random) -> MoveBelowSpeed:
    speed, total = _speed(rng), _seconds(rng, 0.05, 0.5)
    steps = (max(1, int(speed * total * _seconds(rng, 0.3, 0.95))),)
    return MoveBelowSpeed(steps, rng.choice(PROFILES), total, speed)


def _at_speed(rng: random.Random) -> MoveAtSpeed:
    speed = _speed(rng)
    steps = (max(1, int(speed * _seconds(rng, 0.05, 0.5))),)
    return MoveAtSpeed(steps, rng.choice(PROFILES), speed, steps[0] / speed * _seconds(rng, 0.05, 0.99))


def _jerk(rng: random.Random) -> MoveJerk:
    start, stop = (Fraction(rng.randint(0, 500)) for _ in range(2))
    speed, ramp = _speed(rng), _seconds(rng, 0.02, 0.2)
    jerk = speed / _seconds(rng, 0.02, 0.2) ** 2
    return MoveJerk((rng.randint(100, 10_000),), start, speed, stop, speed / ramp, jerk)


def _straight(rng: random.Random) -> MoveStraight:
    def each(low: int, high: int) -> tuple[Fraction, ...]:
        return tuple(Fraction(rng.randint(low, high)) for _ in range(3))

    return MoveStraight(
        distance=tuple(d / 1000 for d in each(-20_000, 20_000)),
        feed=Fraction(rng.randint(10, 300)),
        steps_per_mm=each(40, 400),
        speed=each(20, 200),
        acceleration=each(200, 3000),
        jerk=rng.choice((each(0, 0), each(5_000, 100_000))),
    )


FORMS: dict[str, Callable[[random.Random], Move]] = {
    "In time, all profiles": _in_time,
    "In time below a speed": _below_speed,
    "At a speed with ramp time": _at_speed,
    "Jerk-limited in seven phases": _jerk,
    "Straight line within limits per axis": _straight,
    "A user's own shape, in time": _user_in_time,
}


def wanted_seconds(move: Move) -> float:
    """The requested total time; NaN if there is no simple formula."""
    match move:
        case MoveInTime() | MoveBelowSpeed():
            return float(move.total_time)
        case MoveAtSpeed():
            return float(max(move.steps) / move.speed + move.ramp_time)
    return float("nan")


def measure_form(move: Move) -> dict[str, float]:
    """Plan a move, compute its steps and compare."""
    plan = plan_move(move, CLOCK_HZ, PARAMETERS)
    clocks, missing = step_clocks(plan)
    longest = max(range(len(move.steps)), key=lambda axis: abs(move.steps[axis]))
    curve = planned_curve(plan, USERS_SHAPE if move.profile == USER else "")
    pairs = zip(clocks, move.steps, strict=True)
    return {
        "steps": sum(abs(len(made) - abs(wanted)) for made, wanted in pairs),
        "missing": missing,
        "planned": float(np.abs(curve.distances(clocks[longest] / CLOCK_HZ)).max(initial=0)),
        "ticks": abs(plan.clocks / CLOCK_HZ - wanted_seconds(move)) / TICK_SECONDS,
    }


def measure_forms(name: str, count: int, seed: int) -> list[dict[str, float]]:
    """Measure random moves of a form."""
    rng = random.Random(f"{seed} {name}")
    return [measure_form(FORMS[name](rng)) for _ in range(count)]
