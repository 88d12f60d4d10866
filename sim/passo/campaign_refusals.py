# SPDX-License-Identifier: MIT
"""Checks rejections of a move: each must have a reason visible in the move itself (docs/planning.md)."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

from passo.build import Parameters
from passo.move_forms import ALPHA_MAX, ALPHA_MIN, SHAPED
from passo.moves import Channels, Move, MoveFileError
from passo.plan import Plan, PlanError
from passo.pulse_judge import Fault
from passo.shape import ONE

TICK = 128
ROUND_TRIP = 1 << 14  # clocks: some frames
ALMOST = Fraction(9, 10)  # rounding to ticks may take a move over a limit
# What the reader of move files says of values, and of the tables of several moves.
RULES = (
    "must be greater than 0",
    "must be at most ",
    "has too many steps",
    "needs profile = ",
    "and tables cannot be loaded during a motion",
)


def _of(move: Move, *names: str) -> Fraction:
    """The first of these values that the move has, or 0."""
    values = (getattr(move, name, None) for name in names)
    return next((Fraction(value) for value in values if isinstance(value, int | Fraction)), Fraction(0))


def _longest(move: Move) -> int:
    return max(map(abs, move.steps))


def _limits(move: Move, name: str) -> list[Fraction]:
    """The limits of the axes that move."""
    pairs = zip(getattr(move, name, ()), getattr(move, "distance", ()), strict=False)
    return [limit for limit, distance in pairs if distance]


def _above(name: str) -> Callable[[Move, int], bool]:
    return lambda move, _: _of(move, name) > _of(move, "rpm" if name == "minimum_rpm" else "speed")


def _fastest(move: Move, clock_hz: int) -> Fraction:
    """A bound for the steps per second of the longest axis."""
    tick = Fraction(TICK, clock_hz)
    if hasattr(move, "total_time"):
        ramp = getattr(move, "ramp_time", move.total_time / 2)
        if table := getattr(move, "table", ()):
            ramp *= 2 * (1 - Fraction(sum(table), len(table) * ONE))
        return _longest(move) / max(move.total_time - ramp - 2 * tick, tick / 2)
    if hasattr(move, "rpm"):
        return move.rpm * move.steps_per_turn / 60
    if hasattr(move, "feed"):
        speeds = zip(move.speed, move.steps_per_mm, strict=True)
        return max(speed * scale for speed, scale in speeds)
    return _of(move, "speed")


def _ramp_too_long(move: Move, clock_hz: int) -> bool:
    tick = Fraction(TICK, clock_hz)
    if hasattr(move, "total_time"):
        return 2 * move.ramp_time > move.total_time - 2 * tick
    return move.ramp_time > Fraction(_longest(move)) / move.speed - 2 * tick


# By name of the refusal: whether the move has this fault. A move with one of the exact ones must be refused.
EXACT: dict[str, Callable[[Move, int], bool]] = {
    "NO_STEPS": lambda move, _: not any(move.steps),
    "NO_SPEED": lambda move, _: 0 in (getattr(move, "speed", None), getattr(move, "rpm", None)),
    "START_ABOVE_SPEED": _above("start_speed"),
    "STOP_ABOVE_SPEED": _above("stop_speed"),
    "MINIMUM_ABOVE_SPEED": _above("minimum_rpm"),
    "BAD_ALPHA": lambda move, _: hasattr(move, "alpha") and not ALPHA_MIN <= move.alpha <= ALPHA_MAX,
    "NO_FEED": lambda move, _: hasattr(move, "feed") and not move.feed,
    "NO_SCALE": lambda move, _: not all(_limits(move, "steps_per_mm")),
    "NO_AXIS_SPEED": lambda move, _: hasattr(move, "feed") and not all(_limits(move, "speed")),
    "NO_AXIS_ACCELERATION": lambda move, _: hasattr(move, "feed") and not all(_limits(move, "acceleration")),
}
OTHERS: dict[str, Callable[[Move, int], bool]] = {
    "NO_JERK": lambda move, _: "jerk" in vars(move),
    "NO_ACCELERATION": lambda move, _: not _of(move, "acceleration") and not _of(move, "ramp_time"),
    "NO_TIME": lambda move, clock_hz: _of(move, "total_time") * clock_hz < TICK,
    "RAMP_TOO_LONG": _ramp_too_long,
    "RAMP_TOO_SHORT": lambda move, _: move.profile == SHAPED,
    "SPEED_TOO_LOW": lambda move, clock_hz: (
        _longest(move) / move.speed > move.total_time - Fraction(2 * TICK, clock_hz)
    ),
    "TOO_FAST": lambda move, clock_hz: _fastest(move, clock_hz) > ALMOST * clock_hz / 2,
}


def refusal_fault(error: MoveFileError, channels: Channels | None) -> Fault | None:
    """What is wrong with a refusal; `channels`: the file, unless its reader refused it."""
    reason = error.__context__
    if not isinstance(reason, PlanError):
        told = any(rule in str(error) for rule in RULES)
        return None if told else Fault("refusal", f"refused without a documented reason: {error}")
    right = any(_is_right(reason.name, move, file) for file in channels.files for move in file.moves)
    return None if right else Fault("refusal", f"refused without a reason: {reason}")


def _is_right(name: str, move: Move, file: Any) -> bool:
    if name == "PINS_TOO_SLOW":
        between = file.pins.step_high + file.pins.step_low
        return _fastest(move, file.clock_hz) * between > ALMOST * file.clock_hz
    reason = (EXACT | OTHERS).get(name)
    try:
        return reason is not None and reason(move, file.clock_hz)
    except (AttributeError, ZeroDivisionError):
        return False  # a form without this value


def outruns_the_link(plans: list[list[Plan]], parameters: Parameters) -> bool:
    """Whether somewhere three quarters of a queue of ramps are over before the driver sends the last one."""
    places = 1 << parameters.ramp_queue_log2
    rest = places - (places + 3) // 4
    return any(
        sum(ticks[first : first + rest]) << parameters.tick_log2 < ROUND_TRIP
        for own in plans
        for ticks in [[ramp.ticks for plan in own for ramp in plan.ramps]]
        for first in range(1, len(ticks) - rest)
    )


def acceptance_fault(channels: Channels) -> Fault | None:
    """What the planner should have refused."""
    for file in channels.files:
        for index, move in enumerate(file.moves):
            for name, holds in EXACT.items():
                if holds(move, file.clock_hz):
                    return Fault("accepted", f"move {file.number(index)} is planned in spite of {name}")
    return None
