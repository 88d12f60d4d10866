# SPDX-License-Identifier: MIT
"""Move files: TOML to checked data. Whatever is wrong with a file is told in one line."""

import math
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

from passo.shape import ShapeError, read_table

PROFILES = ("linear", "cosine", "sigmoid", "jerk")
USER = "user"  # the profile that is a table
AXES_MAX = 8
STEPS_MAX = 2**30 - 1  # of an axis, the longest line
CLOCK_HZ_MAX = 2**32 - 1
PIN_CLOCKS_MAX = 65535
PIN_SECONDS = Fraction(1, 1_000_000)  # the default of every pin timing
NUMBER_MAX = 2**32 - 1  # seconds, steps/s, steps/s^2
SIGNED_MAX = 2**31 - 1  # degrees, millimetres
DECIMALS_MAX = 30

Q32 = 1 << 32  # the planner's numbers have 32 binary places

FILE_KEYS = ("clock_hz", "pins", "move")
PIN_KEYS = ("step_high", "step_low", "dir_setup", "dir_hold")


class MoveFileError(ValueError):
    """A move file cannot be executed; the text is one line that says why."""


class _BadError(ValueError):
    """A reason without its place."""


@dataclass(frozen=True)
class PinTiming:
    """Pin timing of an axis in clocks, 1 .. 65535 each."""

    step_high: int = 1
    step_low: int = 1
    dir_setup: int = 1
    dir_hold: int = 1


Table = tuple[int, ...]  # the points of a user's shape; empty with any other profile


@dataclass(frozen=True)
class MoveInTime:
    """A move from rest to rest in a given time (seconds)."""

    steps: tuple[int, ...]
    profile: str
    total_time: Fraction
    ramp_time: Fraction
    table: Table = ()


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
    table: Table = ()


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


def read_moves(path: Path) -> MoveFile:
    """Read and check a move file; raise MoveFileError."""
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"), parse_float=Decimal)
    except OSError as error:
        raise MoveFileError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise MoveFileError(f"{path}: this is not a text file in UTF-8") from None
    except RecursionError:
        raise MoveFileError(f"{path}: nested too deeply") from None
    except ArithmeticError:
        raise MoveFileError(f"{path}: a number is out of all range") from None
    except ValueError as error:
        raise MoveFileError(f"{path}: {str(error).splitlines()[0]}") from None
    try:
        return _file(path, data)
    except _BadError as error:
        raise MoveFileError(f"{path}: {error}") from None


def _file(path: Path, data: dict[str, Any]) -> MoveFile:
    _known(data, FILE_KEYS)
    clock_hz = _integer(data, "clock_hz", 1, CLOCK_HZ_MAX)
    pins = data.get("pins", {})
    if not isinstance(pins, dict):
        raise _BadError("pins must be a table: [pins]")
    timing = _within("pins", lambda: _pins(pins, clock_hz))
    tables = data.get("move", [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise _BadError("move must be an array of tables: [[move]]")
    if not tables:
        raise _BadError("there are no moves: [[move]] is missing")
    moves: list[Move] = []
    for number, table in enumerate(tables, 1):
        move = _within(f"move {number}", lambda table=table: _move(table, path.parent))
        if moves and len(move.steps) != len(moves[0].steps):
            raise _BadError(
                f"move {number}: steps has {len(move.steps)} axes, but move 1 has {len(moves[0].steps)}"
            )
        moves.append(move)
    return MoveFile(path, clock_hz, timing, tuple(moves))


def _pins(table: dict[str, Any], clock_hz: int) -> PinTiming:
    _known(table, PIN_KEYS)
    clocks = {}
    for key in PIN_KEYS:
        clocks[key] = max(1, math.ceil(_number(table, key, PIN_SECONDS) * clock_hz))
        if clocks[key] > PIN_CLOCKS_MAX:
            raise _BadError(f"{key} is {clocks[key]} clocks, at most {PIN_CLOCKS_MAX} are possible")
    return PinTiming(**clocks)


def _move(table: dict[str, Any], folder: Path) -> Move:
    form = FORMS[_form(table)]
    values = {key: read(table, key) for key, read in form.keys.items()}
    form.check(table)
    if values.get("table"):
        try:
            values["table"] = read_table(folder / values["table"])
        except ShapeError as error:
            raise _BadError(f"table: {error}") from None
    return form.make(**values)


def _form(table: dict[str, Any]) -> str:
    """The form by its name or, for the first two, by what is given."""
    if "method" in table:
        method = table["method"]
        if not isinstance(method, str) or method not in FORMS:
            raise _BadError(f"method must be one of {', '.join(FORMS)}, not {_show(method)}")
        _known(table, ("method", *FORMS[method].keys))
        return method
    in_time, by_speed = FORMS["in_time"].keys, FORMS["by_speed"].keys
    _known(table, tuple(dict.fromkeys(("method", *in_time, *by_speed))))
    of_time = [key for key in table if key in in_time and key not in by_speed]
    of_speed = [key for key in table if key in by_speed and key not in in_time]
    if of_time and of_speed:
        raise _BadError(f"{of_time[0]} and {of_speed[0]} exclude each other: a move goes by time or by speed")
    if not of_time and "speed" not in table:
        raise _BadError("total_time or speed is missing")
    return "in_time" if of_time else "by_speed"


def _steps(table: dict[str, Any], key: str) -> tuple[int, ...]:
    steps = _get(table, key)
    if not isinstance(steps, list) or any(type(n) is not int for n in steps):
        raise _BadError("steps must be a list of whole numbers, one per axis")
    if not 1 <= len(steps) <= AXES_MAX:
        raise _BadError(f"steps has {len(steps)} axes, 1 to {AXES_MAX} are possible")
    for axis, n in enumerate(steps):
        if abs(n) > STEPS_MAX:
            raise _BadError(f"axis {axis} has too many steps, at most {STEPS_MAX} are possible")
    return tuple(steps)


def _profile(table: dict[str, Any], key: str, profiles: tuple[str, ...] = PROFILES) -> str:
    profile = _get(table, key)
    if profile not in profiles:
        raise _BadError(f"profile must be one of {', '.join(profiles)}, not {_show(profile)}")
    return profile


def _profile_or_user(table: dict[str, Any], key: str) -> str:
    return _profile(table, key, (*PROFILES, USER))


def _table_file(table: dict[str, Any], key: str) -> str | Table:
    """Name of the file with a user's shape."""
    if table.get("profile") != USER:
        if key in table:
            raise _BadError(f'{key} needs profile = "{USER}"')
        return ()
    name = _get(table, key)
    if not isinstance(name, str) or not name:
        raise _BadError(f"{key} must be the name of a file, not {_show(name)}")
    return name


def _axis(table: dict[str, Any], key: str) -> int:
    return _integer(table, key, 0, AXES_MAX - 1) if key in table else 0


def _axes(table: dict[str, Any], key: str) -> int:
    axis = _axis(table, "axis")
    return _integer(table, key, axis + 1, AXES_MAX) if key in table else axis + 1


def _positive(table: dict[str, Any], key: str) -> int:
    return _integer(table, key, 1, CLOCK_HZ_MAX)


def _per_axis(table: dict[str, Any], key: str) -> tuple[Fraction, ...]:
    """One number for all axes, or a list."""
    axes = len(_distance(table, "distance"))
    value = _get(table, key)
    if not isinstance(value, list):
        return (_number(table, key),) * axes
    if len(value) != axes:
        raise _BadError(f"{key} has {len(value)} axes, but distance has {axes}")
    return tuple(_number({key: item}, key) for item in value)


def _distance(table: dict[str, Any], key: str) -> tuple[Fraction, ...]:
    value = _get(table, key)
    if not isinstance(value, list) or not 1 <= len(value) <= AXES_MAX:
        raise _BadError(f"{key} must be a list of 1 to {AXES_MAX} numbers, one per axis")
    return tuple(_signed({key: item}, key) for item in value)


def _check_by_speed(table: dict[str, Any]) -> None:
    if "ramp_time" in table and "acceleration" in table:
        raise _BadError("acceleration and ramp_time exclude each other")
    if "deceleration" in table and "acceleration" not in table:
        raise _BadError("deceleration needs acceleration")
    for key in ("acceleration", "deceleration"):
        if key in table and _number(table, key) == 0:
            raise _BadError(f"{key} must be greater than 0")


def _get(table: dict[str, Any], key: str) -> Any:
    if key not in table:
        raise _BadError(f"{key} is missing")
    return table[key]


def _integer(table: dict[str, Any], key: str, low: int, high: int) -> int:
    value = _get(table, key)
    if type(value) is not int:
        raise _BadError(f"{key} must be a whole number, not {_show(value)}")
    if not low <= value <= high:
        raise _BadError(f"{key} must be {low} to {high}")
    return value


def _number(table: dict[str, Any], key: str, default: Fraction | None = None) -> Fraction:
    """A number that is not negative, exactly as it is written."""
    if default is not None and key not in table:
        return default
    value = _finite(table, key)
    if value < 0:
        raise _BadError(f"{key} must not be negative")
    return _fraction(key, value, NUMBER_MAX)


def _signed(table: dict[str, Any], key: str) -> Fraction:
    """A number, exactly as it is written."""
    return _fraction(key, _finite(table, key), SIGNED_MAX)


def _finite(table: dict[str, Any], key: str) -> int | Decimal:
    value = _get(table, key)
    if type(value) is not int and type(value) is not Decimal:
        raise _BadError(f"{key} must be a number, not {_show(value)}")
    if type(value) is Decimal and not value.is_finite():
        raise _BadError(f"{key} must be finite, not {value}")
    return value


def _fraction(key: str, value: int | Decimal, largest: int) -> Fraction:
    if value > largest:
        raise _BadError(f"{key} must be at most {largest}")
    if value < -largest:
        raise _BadError(f"{key} must be at least -{largest}")
    if type(value) is Decimal and value.as_tuple().exponent < -DECIMALS_MAX:
        raise _BadError(f"{key} has more than {DECIMALS_MAX} decimals")
    return Fraction(value)


def _number_or(default: int | str) -> "Reader":
    """A number with a default, which may be another key's number."""

    def read(table: dict[str, Any], key: str) -> Fraction:
        if key in table or not isinstance(default, str):
            return _number(table, key, Fraction(0 if isinstance(default, str) else default))
        return _number(table, default)

    return read


def _per_axis_or_0(table: dict[str, Any], key: str) -> tuple[Fraction, ...]:
    return _per_axis({key: 0, **table}, key)


def _known(table: dict[str, Any], keys: tuple[str, ...]) -> None:
    for key in table:
        if key not in keys:
            raise _BadError(f"unknown key {_show(key)}; known are {', '.join(keys)}")


def _show(value: Any) -> str:
    """A value as an error message can show it: short and on one line."""
    try:
        text = str(value).lower() if isinstance(value, bool) else repr(value)
    except ValueError:  # Python refuses to print very long numbers
        return "a very long number"
    return text if len(text) <= 40 else text[:37] + "..."


def _within(place: str, check: Callable[[], Any]) -> Any:
    try:
        return check()
    except _BadError as error:
        raise _BadError(f"{place}: {error}") from None


# ----------------------------------------------------------------------------------------------- forms ----

Reader = Callable[[dict[str, Any], str], Any]
OR_0 = _number_or(0)


@dataclass(frozen=True)
class Form:
    """A form of a move: what it becomes, and who reads each of its keys."""

    make: type
    keys: dict[str, Reader]
    check: Callable[[dict[str, Any]], None] = lambda table: None


SHAPED = {"steps": _steps, "profile": _profile}
SHAPED_OR_USER = {"steps": _steps, "profile": _profile_or_user, "table": _table_file}
SPEEDS = {"start_speed": OR_0, "speed": _number, "stop_speed": OR_0}

# By the name of the method. The first two are also found by their keys.
FORMS = {
    "in_time": Form(MoveInTime, {**SHAPED_OR_USER, "total_time": _number, "ramp_time": _number}),
    "by_speed": Form(
        MoveBySpeed,
        {**SHAPED_OR_USER, **SPEEDS, "acceleration": OR_0, "deceleration": OR_0, "ramp_time": OR_0},
        _check_by_speed,
    ),
    "below_speed": Form(MoveBelowSpeed, {**SHAPED, "total_time": _number, "speed": _number}),
    "at_speed": Form(MoveAtSpeed, {**SHAPED, "speed": _number, "ramp_time": _number}),
    "axes": Form(MoveAxes, {"steps": _steps, "start_speed": OR_0, "speed": _number, "ramp_time": _number}),
    "turn": Form(
        MoveTurn,
        {
            **{"axes": _axes, "axis": _axis, "steps_per_turn": _positive},
            **{"angle": _signed, "rpm": _number, "minimum_rpm": OR_0, "acceleration": _number},
        },
    ),
    "sigmoid": Form(
        MoveSigmoid,
        {
            **{"steps": _steps, **SPEEDS, "accelerate_time": _number},
            **{"decelerate_time": _number_or("accelerate_time"), "alpha": _number_or(5)},
        },
    ),
    "jerk": Form(MoveJerk, {"steps": _steps, **SPEEDS, "acceleration": _number, "jerk": _number}),
    "straight": Form(
        MoveStraight,
        {
            **{"distance": _distance, "feed": _number, "steps_per_mm": _per_axis},
            **{"speed": _per_axis, "acceleration": _per_axis, "jerk": _per_axis_or_0},
        },
    ),
}
