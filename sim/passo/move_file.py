# SPDX-License-Identifier: MIT
"""Move files: TOML to checked moves. Whatever is wrong with a file is told in one line."""

import math
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

from passo import moves as m
from passo.move_keys import (
    BadValueError,
    Reader,
    Table,
    check_known,
    read_axes,
    read_axis,
    read_distance,
    read_number,
    read_number_or,
    read_per_axis,
    read_per_axis_or_0,
    read_positive,
    read_profile,
    read_profile_or_user,
    read_signed,
    read_steps,
    read_table_file,
    shown,
    within,
)
from passo.moves import Move, MoveFile, MoveFileError, PinTiming
from passo.shape import ShapeError, read_table

PIN_CLOCKS_MAX = 65535
PIN_SECONDS = Fraction(1, 1_000_000)  # the default of every pin timing

FILE_KEYS = ("clock_hz", "pins", "move")
PIN_KEYS = ("step_high", "step_low", "dir_setup", "dir_hold")


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
    except BadValueError as error:
        raise MoveFileError(f"{path}: {error}") from None


def _file(path: Path, data: Table) -> MoveFile:
    check_known(data, FILE_KEYS)
    clock_hz = read_positive(data, "clock_hz")
    pins = data.get("pins", {})
    if not isinstance(pins, dict):
        raise BadValueError("pins must be a table: [pins]")
    timing = within("pins", lambda: _pins(pins, clock_hz))
    tables = data.get("move", [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise BadValueError("move must be an array of tables: [[move]]")
    if not tables:
        raise BadValueError("there are no moves: [[move]] is missing")
    moves: list[Move] = []
    for number, table in enumerate(tables, 1):
        move = within(f"move {number}", lambda table=table: _move(table, path.parent))
        if moves and len(move.steps) != len(moves[0].steps):
            raise BadValueError(
                f"move {number}: steps has {len(move.steps)} axes, but move 1 has {len(moves[0].steps)}"
            )
        moves.append(move)
    return MoveFile(path, clock_hz, timing, tuple(moves))


def _pins(table: Table, clock_hz: int) -> PinTiming:
    check_known(table, PIN_KEYS)
    clocks = {}
    for key in PIN_KEYS:
        clocks[key] = max(1, math.ceil(read_number(table, key, PIN_SECONDS) * clock_hz))
        if clocks[key] > PIN_CLOCKS_MAX:
            raise BadValueError(f"{key} is {clocks[key]} clocks, at most {PIN_CLOCKS_MAX} are possible")
    return PinTiming(**clocks)


def _move(table: Table, folder: Path) -> Move:
    form = FORMS[_form(table)]
    values = {key: read(table, key) for key, read in form.keys.items()}
    form.check(table)
    if values.get("table"):
        try:
            values["table"] = read_table(folder / values["table"])
        except ShapeError as error:
            raise BadValueError(f"table: {error}") from None
    return form.make(**values)


def _form(table: Table) -> str:
    """The form by its name or, for the first two, by what is given."""
    if "method" in table:
        method = table["method"]
        if not isinstance(method, str) or method not in FORMS:
            raise BadValueError(f"method must be one of {', '.join(FORMS)}, not {shown(method)}")
        check_known(table, ("method", *FORMS[method].keys))
        return method
    in_time, by_speed = FORMS["in_time"].keys, FORMS["by_speed"].keys
    check_known(table, tuple(dict.fromkeys(("method", *in_time, *by_speed))))
    of_time = [key for key in table if key in in_time and key not in by_speed]
    of_speed = [key for key in table if key in by_speed and key not in in_time]
    if of_time and of_speed:
        raise BadValueError(
            f"{of_time[0]} and {of_speed[0]} exclude each other: a move goes by time or by speed"
        )
    if not of_time and "speed" not in table:
        raise BadValueError("total_time or speed is missing")
    return "in_time" if of_time else "by_speed"


# ----------------------------------------------------------------------------------------------- forms ----


def _check_by_speed(table: Table) -> None:
    if "ramp_time" in table and "acceleration" in table:
        raise BadValueError("acceleration and ramp_time exclude each other")
    if "deceleration" in table and "acceleration" not in table:
        raise BadValueError("deceleration needs acceleration")
    for key in ("acceleration", "deceleration"):
        if key in table and read_number(table, key) == 0:
            raise BadValueError(f"{key} must be greater than 0")


@dataclass(frozen=True)
class Form:
    """A form of a move: what it becomes, and who reads each of its keys."""

    make: type
    keys: dict[str, Reader]
    check: Callable[[Table], None] = lambda table: None


OR_0 = read_number_or(0)
SHAPED = {"steps": read_steps, "profile": read_profile}
SHAPED_OR_USER = {"steps": read_steps, "profile": read_profile_or_user, "table": read_table_file}
SPEEDS = {"start_speed": OR_0, "speed": read_number, "stop_speed": OR_0}

# By the name of the method. The first two are also found by their keys.
FORMS = {
    "in_time": Form(m.MoveInTime, {**SHAPED_OR_USER, "total_time": read_number, "ramp_time": read_number}),
    "by_speed": Form(
        m.MoveBySpeed,
        {**SHAPED_OR_USER, **SPEEDS, "acceleration": OR_0, "deceleration": OR_0, "ramp_time": OR_0},
        _check_by_speed,
    ),
    "below_speed": Form(m.MoveBelowSpeed, {**SHAPED, "total_time": read_number, "speed": read_number}),
    "at_speed": Form(m.MoveAtSpeed, {**SHAPED, "speed": read_number, "ramp_time": read_number}),
    "axes": Form(
        m.MoveAxes, {"steps": read_steps, "start_speed": OR_0, "speed": read_number, "ramp_time": read_number}
    ),
    "turn": Form(
        m.MoveTurn,
        {
            **{"axes": read_axes, "axis": read_axis, "steps_per_turn": read_positive},
            **{"angle": read_signed, "rpm": read_number, "minimum_rpm": OR_0, "acceleration": read_number},
        },
    ),
    "sigmoid": Form(
        m.MoveSigmoid,
        {
            **{"steps": read_steps, **SPEEDS, "accelerate_time": read_number},
            **{"decelerate_time": read_number_or("accelerate_time"), "alpha": read_number_or(5)},
        },
    ),
    "jerk": Form(
        m.MoveJerk, {"steps": read_steps, **SPEEDS, "acceleration": read_number, "jerk": read_number}
    ),
    "straight": Form(
        m.MoveStraight,
        {
            **{"distance": read_distance, "feed": read_number, "steps_per_mm": read_per_axis},
            **{"speed": read_per_axis, "acceleration": read_per_axis, "jerk": read_per_axis_or_0},
        },
    ),
}
