# SPDX-License-Identifier: MIT
# Generated from spec/moves.toml by spec/generate_moves.py.
"""Move forms: their keys, how values are converted, and the limits of values."""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from passo.form_table import Form, Key, Place, Points, Rule, Shaper
from passo.registers import Shape

# Longest line: its substeps, and therefore the steps of each axis, have 30 bits.
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
SHAPED = "shaped"  # the profile given by an input shaper
USER_BANK = Shape.SIGMOID  # the bank of that table

FORMS = {
    "in_time": Form(
        "in_time",
        (
            Key("steps", "steps", "steps"),
            Key("profile", "shape", "profile"),
            Key("table", "table", None, file_only=True),
            Key("shaper", "shaper", None, file_only=True),
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

TASKS = {
    "home": Form(
        "home",
        (
            Key("steps", "steps", "steps"),
            Key("switch", "word", None, default="home", choices=("home", "limit_low", "limit_high")),
            Key("speed", "number", "speed", factor=UNIT_Q32),
            Key("slow_speed", "number", "slow_speed", factor=UNIT_Q32),
            Key("acceleration", "number", "acceleration", factor=UNIT_Q32),
            Key("back_off", "whole", "back_off", low=1, high=SUBSTEPS_MAX),
            Key("pull_off", "whole", "pull_off", default=0, low=0, high=SUBSTEPS_MAX),
            Key("edge_position", "whole", "edge_position", default=0, low=-SIGNED_MAX, high=SIGNED_MAX),
            Key("channel", "channel", None, default=0),
        ),
    ),
    "probe": Form(
        "probe",
        (
            Key("steps", "steps", "steps"),
            Key("speed", "number", "speed", factor=UNIT_Q32),
            Key("acceleration", "number", "acceleration", factor=UNIT_Q32),
            Key("away", "flag", None, default=False),
            Key("optional", "flag", None, default=False),
            Key("channel", "channel", None, default=0),
        ),
    ),
    "thread": Form(
        "thread",
        (
            Key("steps", "steps", "steps"),
            Key("turns", "number", "turns", factor=UNIT_Q32),
            Key("wait_index", "flag", None, default=True),
            Key("top_rpm", "number", "top_rpm", factor=UNIT_Q32, optional=True),
            Key("channel", "channel", None, default=0),
        ),
        (
            Rule("above_zero", "turns", "turns"),
            Rule("above_zero", "top_rpm", "top_rpm"),
        ),
    ),
}

EVENTS = {
    "input": Form(
        "input",
        (
            Key("time", "time", "time", factor="clock_hz", optional=True),
            Key("position", "place", None, optional=True),
            Key(
                "trigger",
                "word",
                None,
                choices=("limit_low", "limit_high", "home", "alarm", "probe"),
                optional=True,
            ),
            Key("falling", "flag", None, default=False),
            Key("at_axis", "axis", "at_axis", default=0),
            Key("input", "word", None, choices=("limit_low", "limit_high", "home", "alarm", "probe")),
            Key("axis", "axis", "axis", default=0),
            Key("active", "flag", None, default=True),
            Key("length", "time", "length", factor="clock_hz", optional=True),
        ),
    ),
    "estop": Form(
        "estop",
        (
            Key("time", "time", "time", factor="clock_hz", optional=True),
            Key("position", "place", None, optional=True),
            Key(
                "trigger",
                "word",
                None,
                choices=("limit_low", "limit_high", "home", "alarm", "probe"),
                optional=True,
            ),
            Key("falling", "flag", None, default=False),
            Key("at_axis", "axis", "at_axis", default=0),
            Key("length", "time", "length", factor="clock_hz", optional=True),
        ),
    ),
    "hold": Form(
        "hold",
        (
            Key("time", "time", "time", factor="clock_hz", optional=True),
            Key("position", "place", None, optional=True),
            Key(
                "trigger",
                "word",
                None,
                choices=("limit_low", "limit_high", "home", "alarm", "probe"),
                optional=True,
            ),
            Key("falling", "flag", None, default=False),
            Key("at_axis", "axis", "at_axis", default=0),
        ),
    ),
    "resume": Form(
        "resume",
        (
            Key("time", "time", "time", factor="clock_hz", optional=True),
            Key("position", "place", None, optional=True),
            Key(
                "trigger",
                "word",
                None,
                choices=("limit_low", "limit_high", "home", "alarm", "probe"),
                optional=True,
            ),
            Key("falling", "flag", None, default=False),
            Key("at_axis", "axis", "at_axis", default=0),
        ),
    ),
    "override": Form(
        "override",
        (
            Key("time", "time", "time", factor="clock_hz", optional=True),
            Key("position", "place", None, optional=True),
            Key(
                "trigger",
                "word",
                None,
                choices=("limit_low", "limit_high", "home", "alarm", "probe"),
                optional=True,
            ),
            Key("falling", "flag", None, default=False),
            Key("at_axis", "axis", "at_axis", default=0),
            Key("percent", "whole", "percent", low=1, high=100),
        ),
    ),
    "stop": Form(
        "stop",
        (
            Key("time", "time", "time", factor="clock_hz", optional=True),
            Key("position", "place", None, optional=True),
            Key(
                "trigger",
                "word",
                None,
                choices=("limit_low", "limit_high", "home", "alarm", "probe"),
                optional=True,
            ),
            Key("falling", "flag", None, default=False),
            Key("at_axis", "axis", "at_axis", default=0),
        ),
    ),
    "abort": Form(
        "abort",
        (
            Key("time", "time", "time", factor="clock_hz", optional=True),
            Key("position", "place", None, optional=True),
            Key(
                "trigger",
                "word",
                None,
                choices=("limit_low", "limit_high", "home", "alarm", "probe"),
                optional=True,
            ),
            Key("falling", "flag", None, default=False),
            Key("at_axis", "axis", "at_axis", default=0),
        ),
    ),
    "arm": Form(
        "arm",
        (
            Key("time", "time", "time", factor="clock_hz", optional=True),
            Key("position", "place", None, optional=True),
            Key(
                "trigger",
                "word",
                None,
                choices=("limit_low", "limit_high", "home", "alarm", "probe"),
                optional=True,
            ),
            Key("falling", "flag", None, default=False),
            Key("at_axis", "axis", "at_axis", default=0),
            Key("source", "word", None, choices=("limit_low", "limit_high", "home", "probe")),
            Key("axis", "axis", "axis", default=0),
            Key("away", "flag", None, default=False),
            Key("action", "word", None, default="latch", choices=("latch", "soft_stop", "hard_stop")),
        ),
    ),
    "slip": Form(
        "slip",
        (
            Key("time", "time", "time", factor="clock_hz", optional=True),
            Key("position", "place", None, optional=True),
            Key(
                "trigger",
                "word",
                None,
                choices=("limit_low", "limit_high", "home", "alarm", "probe"),
                optional=True,
            ),
            Key("falling", "flag", None, default=False),
            Key("at_axis", "axis", "at_axis", default=0),
            Key("axis", "axis", "axis", default=0),
            Key("counts", "whole", "counts", low=-SIGNED_MAX, high=SIGNED_MAX),
        ),
    ),
    "untrack": Form(
        "untrack",
        (
            Key("time", "time", "time", factor="clock_hz", optional=True),
            Key("position", "place", None, optional=True),
            Key(
                "trigger",
                "word",
                None,
                choices=("limit_low", "limit_high", "home", "alarm", "probe"),
                optional=True,
            ),
            Key("falling", "flag", None, default=False),
            Key("at_axis", "axis", "at_axis", default=0),
            Key("axis", "axis", "axis", default=0),
        ),
    ),
}

MACHINES = {
    "settings": Form(
        "settings",
        (
            Key("filter", "time", "filter", factor="clock_hz", default=0),
            Key("stop_time", "time", "stop_time", factor="clock_hz", optional=True),
            Key("start", "places", None, optional=True),
            Key("steps_per_mm", "scales", None, optional=True),
            Key("tracked", "whole", "tracked", default=0, low=0, high=7),
            Key("seed", "whole", "seed", default=1, low=0, high=WHOLE_MAX),
            Key("pwm", "number", "pwm", factor=UNIT_Q32, default=20000),
            Key("lag", "time", "lag", factor="clock_hz", default=0),
        ),
    ),
    "input": Form(
        "input",
        (
            Key("role", "word", None, choices=("limit_low", "limit_high", "home", "alarm", "probe")),
            Key("axis", "axis", "axis", default=0),
            Key("polarity", "word", None, default="high", choices=("high", "low")),
            Key("at", "place", None, optional=True),
            Key("side", "word", None, default="below", choices=("below", "above")),
            Key("hysteresis", "whole", "hysteresis", default=0, low=0, high=SIGNED_MAX),
            Key("bounce", "time", "bounce", factor="clock_hz", default=0),
            Key("noise", "number", "noise", factor=UNIT_Q32, default=0),
            Key("glitch", "time", "glitch", factor="clock_hz", default=0),
            Key("soft", "flag", None, default=False),
            Key("disables", "flag", None, default=False),
        ),
        (
            Rule("needs", "hysteresis", "at"),
            Rule("needs", "bounce", "at"),
            Rule("needs", "noise", "glitch"),
            Rule("needs", "glitch", "noise"),
            Rule("above_zero", "noise", "noise"),
        ),
    ),
    "encoder": Form(
        "encoder",
        (
            Key("axis", "axis", "axis", default=0),
            Key("counts_per_step", "number", "counts_per_step", factor=UNIT_Q32),
            Key("limit", "number", "limit", factor=UNIT_Q32, optional=True),
            Key("stop", "word", None, default="soft", choices=("none", "soft", "hard")),
            Key("filter", "whole", "filter", default=3, low=0, high=255),
        ),
        (
            Rule("above_zero", "counts_per_step", "counts_per_step"),
            Rule("above_zero", "limit", "limit"),
        ),
    ),
    "output": Form(
        "output",
        (
            Key("levels", "whole", "levels", default=0, low=0, high=255),
            Key("power", "number", "power", factor=UNIT_Q32, default=0),
            Key("speed", "number", "speed", factor=UNIT_Q32, optional=True),
            Key("raster", "values", None, optional=True),
            Key("pitch", "whole", "pitch", default=1, low=1, high=SUBSTEPS_MAX),
        ),
        (
            Rule("excludes", "power", "raster"),
            Rule("needs", "speed", "power"),
            Rule("above_zero", "speed", "speed"),
            Rule("needs", "pitch", "raster"),
        ),
    ),
    "compare": Form(
        "compare",
        (
            Key("axis", "axis", "axis", default=0),
            Key("position", "place", None),
            Key("interval", "whole", "interval", low=-SIGNED_MAX, high=SIGNED_MAX),
            Key("width", "time", "width", factor="clock_hz"),
        ),
    ),
    "spindle": Form(
        "spindle",
        (
            Key("counts_per_turn", "whole", "counts_per_turn", low=4, high=65535),
            Key("rpm", "number", "rpm", factor=UNIT_Q32),
            Key("wander", "whole", "wander", default=0, low=0, high=90),
        ),
        (Rule("above_zero", "rpm", "rpm"),),
    ),
    "track": Form(
        "track",
        (
            Key("time", "time", "time", factor="clock_hz", optional=True),
            Key("position", "place", None, optional=True),
            Key(
                "trigger",
                "word",
                None,
                choices=("limit_low", "limit_high", "home", "alarm", "probe"),
                optional=True,
            ),
            Key("falling", "flag", None, default=False),
            Key("at_axis", "axis", "at_axis", default=0),
            Key("axis", "axis", "axis", default=0),
            Key("target", "place", None, default=0),
            Key("speed", "number", "speed", factor=UNIT_Q32, optional=True),
            Key("acceleration", "number", "acceleration", factor=UNIT_Q32, optional=True),
            Key("backlash", "place", None, optional=True),
        ),
        (
            Rule("above_zero", "speed", "speed"),
            Rule("above_zero", "acceleration", "acceleration"),
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
    shaper: Shaper | None = None
    channel: int = 0

    form: ClassVar[Form] = FORMS["in_time"]


@dataclass(frozen=True)
class MoveBySpeed:
    """A move by speeds of the dominant axis."""

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
    """A move in a given time, never above a speed."""

    steps: tuple[int, ...]
    profile: str
    total_time: Fraction
    speed: Fraction
    channel: int = 0

    form: ClassVar[Form] = FORMS["below_speed"]


@dataclass(frozen=True)
class MoveAtSpeed:
    """A move with a given speed and ramp time."""

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
    """Straight line through space, in millimeters or, for rotary axes, degrees."""

    distance: tuple[Fraction, ...]
    feed: Fraction
    steps_per_mm: tuple[Fraction, ...]
    speed: tuple[Fraction, ...]
    acceleration: tuple[Fraction, ...]
    jerk: tuple[Fraction, ...]
    channel: int = 0

    form: ClassVar[Form] = FORMS["straight"]


@dataclass(frozen=True)
class MoveHome:
    """Homing cycle: each axis to its switch, off it, and slowly to it again; the edge sets the position."""

    steps: tuple[int, ...]
    switch: str
    speed: Fraction
    slow_speed: Fraction
    acceleration: Fraction
    back_off: int
    pull_off: int
    edge_position: int
    channel: int = 0

    form: ClassVar[Form] = TASKS["home"]


@dataclass(frozen=True)
class MoveProbe:
    """Probing move: toward a workpiece until the probe triggers, or away until it releases."""

    steps: tuple[int, ...]
    speed: Fraction
    acceleration: Fraction
    away: bool
    optional: bool
    channel: int = 0

    form: ClassVar[Form] = TASKS["probe"]


@dataclass(frozen=True)
class MoveThread:
    """One spindle-synchronized pass of a thread: a straight line clocked by the spindle."""

    steps: tuple[int, ...]
    turns: Fraction
    wait_index: bool
    top_rpm: Fraction | None
    channel: int = 0

    form: ClassVar[Form] = TASKS["thread"]


@dataclass(frozen=True)
class EventInput:
    """Forces an input active or inactive, overriding its switch."""

    time: Fraction | None
    position: Place | None
    trigger: str | None
    falling: bool
    at_axis: int
    input: str
    axis: int
    active: bool
    length: Fraction | None

    form: ClassVar[Form] = EVENTS["input"]


@dataclass(frozen=True)
class EventEstop:
    """The e-stop is pressed."""

    time: Fraction | None
    position: Place | None
    trigger: str | None
    falling: bool
    at_axis: int
    length: Fraction | None

    form: ClassVar[Form] = EVENTS["estop"]


@dataclass(frozen=True)
class EventHold:
    """Feed hold."""

    time: Fraction | None
    position: Place | None
    trigger: str | None
    falling: bool
    at_axis: int

    form: ClassVar[Form] = EVENTS["hold"]


@dataclass(frozen=True)
class EventResume:
    """End of a hold."""

    time: Fraction | None
    position: Place | None
    trigger: str | None
    falling: bool
    at_axis: int

    form: ClassVar[Form] = EVENTS["resume"]


@dataclass(frozen=True)
class EventOverride:
    """Feed override."""

    time: Fraction | None
    position: Place | None
    trigger: str | None
    falling: bool
    at_axis: int
    percent: int

    form: ClassVar[Form] = EVENTS["override"]


@dataclass(frozen=True)
class EventStop:
    """Soft stop."""

    time: Fraction | None
    position: Place | None
    trigger: str | None
    falling: bool
    at_axis: int

    form: ClassVar[Form] = EVENTS["stop"]


@dataclass(frozen=True)
class EventAbort:
    """Hard stop."""

    time: Fraction | None
    position: Place | None
    trigger: str | None
    falling: bool
    at_axis: int

    form: ClassVar[Form] = EVENTS["abort"]


@dataclass(frozen=True)
class EventArm:
    """Arms the core's trigger, which latches the positions of all axes on one clock."""

    time: Fraction | None
    position: Place | None
    trigger: str | None
    falling: bool
    at_axis: int
    source: str
    axis: int
    away: bool
    action: str

    form: ClassVar[Form] = EVENTS["arm"]


@dataclass(frozen=True)
class EventSlip:
    """An axis slips: its encoder moves by `counts` relative to the steps."""

    time: Fraction | None
    position: Place | None
    trigger: str | None
    falling: bool
    at_axis: int
    axis: int
    counts: int

    form: ClassVar[Form] = EVENTS["slip"]


@dataclass(frozen=True)
class EventUntrack:
    """The tracker of an axis slows down and rests until its next target."""

    time: Fraction | None
    position: Place | None
    trigger: str | None
    falling: bool
    at_axis: int
    axis: int

    form: ClassVar[Form] = EVENTS["untrack"]


@dataclass(frozen=True)
class MachineSettings:
    """Settings of the core, and the axes of the simulated machine."""

    filter: Fraction
    stop_time: Fraction | None
    start: tuple[int, ...] | None
    steps_per_mm: tuple[Fraction, ...] | None
    tracked: int
    seed: int
    pwm: Fraction
    lag: Fraction

    form: ClassVar[Form] = MACHINES["settings"]


@dataclass(frozen=True)
class MachineInput:
    """A connected input: a switch at a position, or driven by events."""

    role: str
    axis: int
    polarity: str
    at: Place | None
    side: str
    hysteresis: int
    bounce: Fraction
    noise: Fraction
    glitch: Fraction
    soft: bool
    disables: bool

    form: ClassVar[Form] = MACHINES["input"]


@dataclass(frozen=True)
class MachineEncoder:
    """An encoder of an axis, and the following-error limit."""

    axis: int
    counts_per_step: Fraction
    limit: Fraction | None
    stop: str
    filter: int

    form: ClassVar[Form] = MACHINES["encoder"]


@dataclass(frozen=True)
class MachineOutput:
    """The outputs during a move."""

    levels: int
    power: Fraction
    speed: Fraction | None
    raster: tuple[int, ...] | None
    pitch: int

    form: ClassVar[Form] = MACHINES["output"]


@dataclass(frozen=True)
class MachineCompare:
    """Position-compare output: a pulse with the step onto each point."""

    axis: int
    position: Place
    interval: int
    width: Fraction

    form: ClassVar[Form] = MACHINES["compare"]


@dataclass(frozen=True)
class MachineSpindle:
    """A spindle with an encoder, at the inputs of the first axis not used by the moves."""

    counts_per_turn: int
    rpm: Fraction
    wander: int

    form: ClassVar[Form] = MACHINES["spindle"]


@dataclass(frozen=True)
class MachineTrack:
    """A target of the tracker of an axis, in steps of its own."""

    time: Fraction | None
    position: Place | None
    trigger: str | None
    falling: bool
    at_axis: int
    axis: int
    target: Place
    speed: Fraction | None
    acceleration: Fraction | None
    backlash: Place | None

    form: ClassVar[Form] = MACHINES["track"]
