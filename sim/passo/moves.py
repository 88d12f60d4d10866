# SPDX-License-Identifier: MIT
"""Move files: TOML to checked data. Whatever is wrong with a file is told in one line."""

import math
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

PROFILES = ("linear", "cosine", "sigmoid", "jerk")
AXES_MAX = 8
STEPS_MAX = 2**31 - 1
CLOCK_HZ_MAX = 2**32 - 1
PIN_CLOCKS_MAX = 65535
PIN_SECONDS = Fraction(1, 1_000_000)  # the default of every pin timing
NUMBER_MAX = 2**32 - 1  # seconds, steps/s, steps/s^2
DECIMALS_MAX = 30

FILE_KEYS = ("clock_hz", "pins", "move")
PIN_KEYS = ("step_high", "step_low", "dir_setup", "dir_hold")
COMMON_KEYS = ("steps", "profile")
TIME_KEYS = ("total_time",)
SPEED_KEYS = ("start_speed", "speed", "stop_speed", "acceleration", "deceleration")
BOTH_KEYS = ("ramp_time",)


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


@dataclass(frozen=True)
class MoveInTime:
    """A move from rest to rest in a given time (seconds)."""

    steps: tuple[int, ...]
    profile: str
    total_time: Fraction
    ramp_time: Fraction


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


Move = MoveInTime | MoveBySpeed


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
        move = _within(f"move {number}", lambda table=table: _move(table))
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


def _move(table: dict[str, Any]) -> Move:
    _known(table, (*COMMON_KEYS, *TIME_KEYS, *BOTH_KEYS, *SPEED_KEYS))
    steps, profile = _steps(table), _profile(table)
    by_time = [key for key in TIME_KEYS if key in table]
    by_speed = [key for key in SPEED_KEYS if key in table]
    if by_time and by_speed:
        raise _BadError(f"{by_time[0]} and {by_speed[0]} exclude each other: a move goes by time or by speed")
    if by_time:
        return MoveInTime(steps, profile, _number(table, "total_time"), _number(table, "ramp_time"))
    if "speed" not in table:
        raise _BadError("total_time or speed is missing")
    if "ramp_time" in table and "acceleration" in table:
        raise _BadError("acceleration and ramp_time exclude each other")
    if "deceleration" in table and "acceleration" not in table:
        raise _BadError("deceleration needs acceleration")
    for key in ("acceleration", "deceleration"):
        if key in table and _number(table, key) == 0:
            raise _BadError(f"{key} must be greater than 0")
    return MoveBySpeed(
        steps, profile, **{key: _number(table, key, Fraction(0)) for key in (*SPEED_KEYS, *BOTH_KEYS)}
    )


def _steps(table: dict[str, Any]) -> tuple[int, ...]:
    steps = _get(table, "steps")
    if not isinstance(steps, list) or any(type(n) is not int for n in steps):
        raise _BadError("steps must be a list of whole numbers, one per axis")
    if not 1 <= len(steps) <= AXES_MAX:
        raise _BadError(f"steps has {len(steps)} axes, 1 to {AXES_MAX} are possible")
    for axis, n in enumerate(steps):
        if abs(n) > STEPS_MAX:
            raise _BadError(f"axis {axis} has too many steps, at most {STEPS_MAX} are possible")
    return tuple(steps)


def _profile(table: dict[str, Any]) -> str:
    profile = _get(table, "profile")
    if profile not in PROFILES:
        raise _BadError(f"profile must be one of {', '.join(PROFILES)}, not {_show(profile)}")
    return profile


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
    value = _get(table, key)
    if type(value) is not int and type(value) is not Decimal:
        raise _BadError(f"{key} must be a number, not {_show(value)}")
    if type(value) is Decimal and not value.is_finite():
        raise _BadError(f"{key} must be finite, not {value}")
    if value < 0:
        raise _BadError(f"{key} must not be negative")
    if value > NUMBER_MAX:
        raise _BadError(f"{key} must be at most {NUMBER_MAX}")
    if type(value) is Decimal and value.as_tuple().exponent < -DECIMALS_MAX:
        raise _BadError(f"{key} has more than {DECIMALS_MAX} decimals")
    return Fraction(value)


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
