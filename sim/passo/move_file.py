# SPDX-License-Identifier: MIT
"""Move files: parses TOML into checked moves. An error is reported in one line."""

import math
import re
import tomllib
from collections.abc import Callable
from dataclasses import fields
from fractions import Fraction
from pathlib import Path

from passo.move_forms import FORMS, TASKS, Form, Points
from passo.move_keys import check_rules, read_key
from passo.moves import (
    CHANNELS_MAX,
    MOVES,
    PIN_CLOCKS_MAX,
    TASK_TYPES,
    Channels,
    Move,
    MoveFile,
    MoveFileError,
    PinTiming,
)
from passo.setup_file import OUTPUT, read_setup
from passo.shape import ShapeError, read_table
from passo.table_values import (
    Table,
    check_known,
    read_clock_hz,
    read_flag,
    read_subtable,
    read_tables,
    read_time,
    toml_error,
    within,
)
from passo.values import BadValueError, Written, meant, shown

PIN_SECONDS = Fraction(1, 1_000_000)  # default of every pin time
G_CODE = re.compile(r"^\s*(%|\(.*\)|;.*|N?\d*\s*[GMT]\d+(\s.*)?)$", re.MULTILINE)

FILE_KEYS = ("clock_hz", "together", "pins", "move", "machine", "event", "track")
PIN_KEYS = tuple(field.name for field in fields(PinTiming))
CHANNEL_KEYS = tuple(map(str, range(CHANNELS_MAX)))


def read_moves(path: Path) -> MoveFile:
    """Read and check a move file of channel 0 only; raises MoveFileError."""
    return _alone(read_channels(path))


def parse_moves(text: str, path: Path) -> MoveFile:
    """The same of a text, which is or could be in a file."""
    return _alone(parse_channels(text, path))


def _alone(channels: Channels) -> MoveFile:
    path = channels.path
    if channels.several:
        raise MoveFileError(
            f"{path}: it moves channel {channels.files[-1].channel}; only channel 0 is supported here"
        )
    if channels.setup:
        raise MoveFileError(f"{path}: machine, events, trackers, home and probe are not supported here")
    return channels.files[0]


def read_channels(path: Path) -> Channels:
    """Read and check a move file; raises MoveFileError."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise MoveFileError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise MoveFileError(f"{path}: not a UTF-8 text file") from None
    return parse_channels(text, path)


def parse_channels(text: str, path: Path, read: Callable[[Path], Points] = read_table) -> Channels:
    """The same of a text, which is or could be in a file; `read` reads the tables that it names."""
    try:
        data = tomllib.loads(text, parse_float=Written)
    except RecursionError:
        raise MoveFileError(f"{path}: nested too deeply") from None
    except ArithmeticError:
        raise MoveFileError(f"{path}: a number is out of range") from None
    except ValueError as error:
        if G_CODE.match(text):
            raise MoveFileError(
                f"{path}: this is G-code; move files are TOML (docs/gcode.md, docs/planning.md)"
            ) from None
        raise MoveFileError(f"{path}: {toml_error(text, error)}") from None
    try:
        return _file(path, data, read)
    except BadValueError as error:
        raise MoveFileError(f"{path}: {error}") from None


def _file(path: Path, data: Table, read: Callable[[Path], Points]) -> Channels:
    check_known(data, FILE_KEYS)
    clock_hz = read_clock_hz(data)
    together = "together" in data and read_flag(data, "together")
    pins = read_subtable(data, "pins")
    timing = within("pins", lambda: read_pins(pins, clock_hz, CHANNEL_KEYS))
    tables = read_tables(data, "move")
    if not tables:
        raise BadValueError("no moves: [[move]] is missing")
    queues: dict[int, dict[int, Move]] = {}  # by channel, by number
    for number, table in enumerate(tables, 1):
        move = within(f"move {number}", lambda table=table: _move(table, path.parent, clock_hz, read))
        queue = queues.setdefault(move.channel, {})
        first = next(iter(queue), number)
        queue[number] = move
        if len(move.steps) != len(queue[first].steps):
            raise BadValueError(
                f"move {number}: steps has {len(move.steps)} axes, "
                f"but move {first} has {len(queue[first].steps)}"
            )
    if together and len(queues) == 1:
        raise BadValueError(f"together needs several channels: all moves use channel {min(queues)}")
    own = {}
    for key, table in ((key, pins[key]) for key in CHANNEL_KEYS if key in pins):
        if int(key) not in queues:
            raise BadValueError(f"pins.{key}: no move uses channel {key}")
        own[int(key)] = within(f"pins.{key}", lambda table=table: _own_pins(pins, table, clock_hz))
    moves = {number: move for queue in queues.values() for number, move in queue.items()}
    return Channels(
        path,
        together,
        tuple(
            MoveFile(path, clock_hz, own.get(channel, timing), tuple(queue.values()), channel, tuple(queue))
            for channel, queue in sorted(queues.items())
        ),
        read_setup(data, [moves[number] for number in sorted(moves)], clock_hz),
    )


def _own_pins(common: Table, table: object, clock_hz: int) -> PinTiming:
    """The pin timing of one channel: what it does not say is as for all."""
    if not isinstance(table, dict):
        raise BadValueError("it must be a table, such as [pins.1]")
    check_known(table, PIN_KEYS)
    return read_pins({key: common[key] for key in PIN_KEYS if key in common} | table, clock_hz)


def read_pins(table: Table, clock_hz: int, others: tuple[str, ...] = ()) -> PinTiming:
    """The table [pins]; raises BadValueError."""
    check_known(table, (*PIN_KEYS, *others))
    clocks = {}
    for key in PIN_KEYS:
        seconds = read_time(table, key, clock_hz) if key in table else PIN_SECONDS
        if not seconds:
            raise BadValueError(f"{key} is 0 clocks; must be 1 to {PIN_CLOCKS_MAX}")
        clocks[key] = math.ceil(seconds * clock_hz)
        if clocks[key] > PIN_CLOCKS_MAX:
            hint = '; a number is in seconds, a text may have a unit: "2us"' if seconds >= 1 else ""
            raise BadValueError(f"{key} is {clocks[key]} clocks; must be at most {PIN_CLOCKS_MAX}{hint}")
    return PinTiming(**clocks)


def _move(table: Table, folder: Path, clock_hz: int, read: Callable[[Path], Points]) -> Move:
    table = {key: value for key, value in table.items() if key != OUTPUT}
    form = _form(table)
    values = {key.name: read_key(table, key, clock_hz) for key in form.keys}
    check_rules(form, table)
    if values.get("table"):
        try:
            values["table"] = read(folder / values["table"])
        except ShapeError as error:
            raise BadValueError(f"table: {error}") from None
    return (MOVES | TASK_TYPES)[form.name](**values)


def _names(form: Form) -> list[str]:
    return [key.name for key in form.keys]


def _form(table: Table) -> Form:
    """The form named by `method` or, without it, the one identified by the keys."""
    if "method" in table:
        method, methods = table["method"], FORMS | TASKS
        if not isinstance(method, str) or method not in methods:
            hint = meant(method, tuple(methods))
            raise BadValueError(f"method must be one of {', '.join(methods)}, not {shown(method)}{hint}")
        check_known(table, ("method", *_names(methods[method])))
        return methods[method]
    by_time, by_speed = FORMS["in_time"], FORMS["by_speed"]
    time_keys, speed_keys = _names(by_time), _names(by_speed)
    check_known(table, tuple(dict.fromkeys(("method", *time_keys, *speed_keys))))
    of_time = [key for key in table if key not in speed_keys]
    of_speed = [key for key in table if key not in time_keys]
    if of_time and of_speed:
        raise BadValueError(f"{of_time[0]} and {of_speed[0]} are mutually exclusive: set time or speed")
    if not of_time and by_speed.told_by not in table:
        raise BadValueError(f"{by_time.told_by} or {by_speed.told_by} is missing")
    return by_time if of_time else by_speed
