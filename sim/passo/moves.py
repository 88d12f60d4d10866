# SPDX-License-Identifier: MIT
"""Moves: what the planner is asked for, one class for each of its methods."""

from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

PROFILES = ("linear", "cosine", "sigmoid", "jerk")
USER = "user"  # the profile that is a table
AXES_MAX = 8

Q32 = 1 << 32  # the planner's numbers have 32 binary places


class MoveFileError(ValueError):
    """A move file cannot be executed; the text is one line that says why."""


@dataclass(frozen=True)
class PinTiming:
    """Pin timing of an axis in clocks, 1 .. 65535 each."""

    step_high: int = 1
    step_low: int = 1
    dir_setup: int = 1
    dir_hold: int = 1


Points = tuple[int, ...]  # the points of a user's shape; empty with any other profile


@dataclass(frozen=True)
class MoveInTime:
    """A move from rest to rest in a given time (seconds)."""

    steps: tuple[int, ...]
    profile: str
    total_time: Fraction
    ramp_time: Fraction
    table: Points = ()


@dataclass(frozen=True)
class MoveBySpeed:
    """A move by speeds (steps/s) of its longest axis; acceleration 0 means: by ramp time."""

    steps: tuple[int, ...]
    profile: str
    start_speed: Fraction
    speed: Fraction
    stop_speed: Fraction
    acceleration: Fraction
    deceleration: Fraction
    ramp_time: Fraction
    table: Points = ()


@dataclass(frozen=True)
class MoveBelowSpeed:
    """A move in a given time with the longest ramps that keep a highest speed."""

    steps: tuple[int, ...]
    profile: str
    total_time: Fraction
    speed: Fraction


@dataclass(frozen=True)
class MoveAtSpeed:
    """A move with a given speed and ramp time, from rest to rest."""

    steps: tuple[int, ...]
    profile: str
    speed: Fraction
    ramp_time: Fraction


@dataclass(frozen=True)
class MoveAxes:
    """A trapezoid of the axis with the most steps, from and to the start speed; the others follow."""

    steps: tuple[int, ...]
    start_speed: Fraction
    speed: Fraction
    ramp_time: Fraction
    profile: str = field(default="linear", init=False)


@dataclass(frozen=True)
class MoveTurn:
    """A turn of one axis by degrees and rpm; acceleration in steps/s^2."""

    axes: int
    axis: int
    steps_per_turn: int
    angle: Fraction
    rpm: Fraction
    minimum_rpm: Fraction
    acceleration: Fraction
    profile: str = field(default="linear", init=False)

    @property
    def steps(self) -> tuple[int, ...]:
        """To the nearest step, as the planner reckons."""
        count = (q32(abs(self.angle)) * self.steps_per_turn + 180 * Q32) // (360 * Q32)
        return tuple((count if self.angle > 0 else -count) * (i == self.axis) for i in range(self.axes))


@dataclass(frozen=True)
class MoveSigmoid:
    """A sigmoid S-curve by three frequencies and the times of two full ramps."""

    steps: tuple[int, ...]
    start_speed: Fraction
    speed: Fraction
    stop_speed: Fraction
    accelerate_time: Fraction
    decelerate_time: Fraction
    alpha: Fraction
    profile: str = field(default="sigmoid", init=False)


@dataclass(frozen=True)
class MoveJerk:
    """A jerk-limited move in up to seven phases; jerk in steps/s^3."""

    steps: tuple[int, ...]
    start_speed: Fraction
    speed: Fraction
    stop_speed: Fraction
    acceleration: Fraction
    jerk: Fraction
    profile: str = field(default="jerk", init=False)


@dataclass(frozen=True)
class MoveStraight:
    """A straight line in millimetres with limits of its own for each axis; a jerk of 0 is without limit."""

    distance: tuple[Fraction, ...]
    feed: Fraction
    steps_per_mm: tuple[Fraction, ...]
    speed: tuple[Fraction, ...]
    acceleration: tuple[Fraction, ...]
    jerk: tuple[Fraction, ...]

    @property
    def profile(self) -> str:
        """What its ramps are."""
        return "jerk" if any(self.jerk) else "linear"

    @property
    def steps(self) -> tuple[int, ...]:
        """To the nearest step, as the planner reckons."""
        counts = (
            (q32(abs(d)) * q32(scale) + (1 << 63)) >> 64
            for d, scale in zip(self.distance, self.steps_per_mm, strict=True)
        )
        return tuple(n if d > 0 else -n for n, d in zip(counts, self.distance, strict=True))


Move = (
    MoveInTime
    | MoveBySpeed
    | MoveBelowSpeed
    | MoveAtSpeed
    | MoveAxes
    | MoveTurn
    | MoveSigmoid
    | MoveJerk
    | MoveStraight
)


def q32(value: Fraction) -> int:
    """The planner's number that is nearest."""
    return round(value * Q32)


@dataclass(frozen=True)
class MoveFile:
    """A checked move file. All moves have the same number of axes."""

    path: Path
    clock_hz: int
    pins: PinTiming
    moves: tuple[Move, ...]

    @property
    def name(self) -> str:
        """What its results are called."""
        return self.path.stem

    @property
    def axes(self) -> int:
        """Axes of each move."""
        return len(self.moves[0].steps)
