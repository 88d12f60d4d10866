# SPDX-License-Identifier: MIT
# Generated from schema/moves.toml by tools/generate_moves.py.
"""Move forms: their keys, how values are converted, and the limits of values."""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from passo.form_table import Form, Key, Points, Rule
from passo.registers import Shape

# Longest line: its substeps, and so the steps of each axis, have 30 bits.
SUBSTEPS_MAX = 1073741823
# Largest unsigned number, in its unit.
NUMBER_MAX = 4294967295
# Largest signed number, in its unit.
SIGNED_MAX = 2147483647
# Largest whole number.
WHOLE_MAX = 4294967295
# Digits after the decimal point.
DECIMALS_MAX = 30
# Speeds and similar quantities are UQ32.32, signed ones Q31.32: an integer x stands for x / 2^32.
UNIT_Q32 = 4294967296
# A sigmoid's alpha is in units of 1 / 4096.
ALPHA_ONE = 4096
# Smallest alpha.
ALPHA_MIN = 3
# Largest alpha.
ALPHA_MAX = 5
# The alpha of the core's table after configuration.
ALPHA_RESET = 5

PROFILES = ("linear", "cosine", "sigmoid", "jerk")
USER = "user"  # the profile given by a table
USER_BANK = Shape.SIGMOID  # the bank of that table

FORMS = {
    "in_time": Form(
        "in_time",
        (
            Key("steps", "steps", "steps"),
            Key("profile", "shape", "profile"),
            Key("table", "table", None, file_only=True),
            Key("total_time", "time", "total_clocks", factor="clock_hz"),
            Key("ramp_time", "time", "ramp_clocks", factor="clock_hz"),
            Key("channel", "channel", None, default=0),
        ),
        told_by="total_time",
    ),
    "by_speed": Form(
        "by_speed",
        (
            Key("steps", "steps", "steps"),
            Key("profile", "shape", "profile"),
            Key("table", "table", None, file_only=True),
            Key("start_speed", "number", "start_speed", factor=UNIT_Q32, default=0),
            Key("speed", "number", "speed", factor=UNIT_Q32),
            Key("stop_speed", "number", "stop_speed", factor=UNIT_Q32, default=0),
            Key("acceleration", "number", "acceleration", factor=UNIT_Q32, default=0),
            Key("deceleration", "number", "deceleration", factor=UNIT_Q32, default=0),
            Key("ramp_time", "time", "ramp_clocks", factor="clock_hz", default=0),
            Key("channel", "channel", None, default=0),
        ),
        (
            Rule("excludes", "acceleration", "ramp_time"),
            Rule("needs", "deceleration", "acceleration"),
            Rule("above_zero", "acceleration", "acceleration"),
            Rule("above_zero", "deceleration", "deceleration"),
        ),
        told_by="speed",
    ),
    "below_speed": Form(
        "below_speed",
        (
            Key("steps", "steps", "steps"),
            Key("profile", "profile", "profile"),
            Key("total_time", "time", "total_clocks", factor="clock_hz"),
            Key("speed", "number", "speed", factor=UNIT_Q32),
            Key("channel", "channel", None, default=0),
        ),
    ),
    "at_speed": Form(
        "at_speed",
        (
            Key("steps", "steps", "steps"),
            Key("profile", "profile", "profile"),
            Key("speed", "number", "speed", factor=UNIT_Q32),
            Key("ramp_time", "time", "ramp_clocks", factor="clock_hz"),
            Key("channel", "channel", None, default=0),
        ),
    ),
    "axes": Form(
        "axes",
        (
            Key("steps", "steps", "steps"),
            Key("start_speed", "number", "start_speed", factor=UNIT_Q32, default=0),
            Key("speed", "number", "speed", factor=UNIT_Q32),
            Key("ramp_time", "time", "ramp_clocks", factor="clock_hz"),
            Key("channel", "channel", None, default=0),
        ),
    ),
    "turn": Form(
        "turn",
        (
            Key("axis", "axis", "axis", default=0),
            Key("axes", "axes", None),
            Key("steps_per_turn", "whole", "steps_per_turn", low=1, high=WHOLE_MAX),
            Key("angle", "signed", "angle", factor=UNIT_Q32),
            Key("rpm", "number", "rpm", factor=UNIT_Q32),
            Key("minimum_rpm", "number", "minimum_rpm", factor=UNIT_Q32, default=0),
            Key("acceleration", "number", "acceleration", factor=UNIT_Q32),
            Key("channel", "channel", None, default=0),
        ),
    ),
    "sigmoid": Form(
        "sigmoid",
        (
            Key("steps", "steps", "steps"),
            Key("start_speed", "number", "start_speed", factor=UNIT_Q32, default=0),
            Key("speed", "number", "speed", factor=UNIT_Q32),
            Key("stop_speed", "number", "stop_speed", factor=UNIT_Q32, default=0),
            Key("accelerate_time", "time", "accelerate_clocks", factor="clock_hz"),
            Key("decelerate_time", "time", "decelerate_clocks", factor="clock_hz", default="accelerate_time"),
            Key("alpha", "alpha", "alpha", factor=ALPHA_ONE, default=5),
            Key("channel", "channel", None, default=0),
        ),
    ),
    "jerk": Form(
        "jerk",
        (
            Key("steps", "steps", "steps"),
            Key("start_speed", "number", "start_speed", factor=UNIT_Q32, default=0),
            Key("speed", "number", "speed", factor=UNIT_Q32),
            Key("stop_speed", "number", "stop_speed", factor=UNIT_Q32, default=0),
            Key("acceleration", "number", "acceleration", factor=UNIT_Q32),
            Key("jerk", "number", "jerk", factor=UNIT_Q32),
            Key("channel", "channel", None, default=0),
        ),
    ),
    "straight": Form(
        "straight",
        (
            Key("distance", "distance", "distance", factor=UNIT_Q32),
            Key("feed", "number", "feed", factor=UNIT_Q32),
            Key("steps_per_mm", "per_axis", "steps_per_mm", factor=UNIT_Q32),
            Key("speed", "per_axis", "speed", factor=UNIT_Q32),
            Key("acceleration", "per_axis", "acceleration", factor=UNIT_Q32),
            Key("jerk", "per_axis", "jerk", factor=UNIT_Q32, default=0),
            Key("channel", "channel", None, default=0),
        ),
    ),
}


@dataclass(frozen=True)
class MoveInTime:
    """A move in a given total time, from rest to rest."""

    steps: tuple[int, ...]
    profile: str
    total_time: Fraction
    ramp_time: Fraction
    table: Points = ()
    channel: int = 0

    form: ClassVar[Form] = FORMS["in_time"]


@dataclass(frozen=True)
class MoveBySpeed:
    """A move by speeds of the longest axis."""

    steps: tuple[int, ...]
    profile: str
    start_speed: Fraction
    speed: Fraction
    stop_speed: Fraction
    acceleration: Fraction
    deceleration: Fraction
    ramp_time: Fraction
    table: Points = ()
    channel: int = 0

    form: ClassVar[Form] = FORMS["by_speed"]


@dataclass(frozen=True)
class MoveBelowSpeed:
    """In a given time, never above a speed."""

    steps: tuple[int, ...]
    profile: str
    total_time: Fraction
    speed: Fraction
    channel: int = 0

    form: ClassVar[Form] = FORMS["below_speed"]


@dataclass(frozen=True)
class MoveAtSpeed:
    """With a given speed and ramp time."""

    steps: tuple[int, ...]
    profile: str
    speed: Fraction
    ramp_time: Fraction
    channel: int = 0

    form: ClassVar[Form] = FORMS["at_speed"]


@dataclass(frozen=True)
class MoveAxes:
    """Trapezoid on several axes, from and to the start speed."""

    steps: tuple[int, ...]
    start_speed: Fraction
    speed: Fraction
    ramp_time: Fraction
    channel: int = 0

    form: ClassVar[Form] = FORMS["axes"]
    profile: ClassVar[str] = "linear"


@dataclass(frozen=True)
class MoveTurn:
    """Trapezoid on one axis by angle and rpm."""

    axis: int
    axes: int
    steps_per_turn: int
    angle: Fraction
    rpm: Fraction
    minimum_rpm: Fraction
    acceleration: Fraction
    channel: int = 0

    form: ClassVar[Form] = FORMS["turn"]
    profile: ClassVar[str] = "linear"


@dataclass(frozen=True)
class MoveSigmoid:
    """Sigmoid S-curve by three frequencies and two ramp times."""

    steps: tuple[int, ...]
    start_speed: Fraction
    speed: Fraction
    stop_speed: Fraction
    accelerate_time: Fraction
    decelerate_time: Fraction
    alpha: Fraction
    channel: int = 0

    form: ClassVar[Form] = FORMS["sigmoid"]
    profile: ClassVar[str] = "sigmoid"


@dataclass(frozen=True)
class MoveJerk:
    """Jerk-limited in up to seven phases."""

    steps: tuple[int, ...]
    start_speed: Fraction
    speed: Fraction
    stop_speed: Fraction
    acceleration: Fraction
    jerk: Fraction
    channel: int = 0

    form: ClassVar[Form] = FORMS["jerk"]
    profile: ClassVar[str] = "jerk"


@dataclass(frozen=True)
class MoveStraight:
    """Straight line through space, in millimetres or, for rotary axes, degrees."""

    distance: tuple[Fraction, ...]
    feed: Fraction
    steps_per_mm: tuple[Fraction, ...]
    speed: tuple[Fraction, ...]
    acceleration: tuple[Fraction, ...]
    jerk: tuple[Fraction, ...]
    channel: int = 0

    form: ClassVar[Form] = FORMS["straight"]
