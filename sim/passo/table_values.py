# SPDX-License-Identifier: MIT
"""Readers of values in a TOML file: each takes a table and a key and returns the checked value.

Numbers are read exactly as written, as fractions. Times are seconds, or a text with a unit as on the console.
Errors raise BadValueError.
"""

import re
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

from passo.move_forms import NUMBER_MAX, SIGNED_MAX, WHOLE_MAX
from passo.values import BadValueError, check_number, meant, parse_time, shown

Table = dict[str, Any]
LINE = re.compile(r"\(at line (\d+), ")
UNQUOTED = re.compile(r"\s*([\w-]+)\s*=\s*((?:[.\d_]+\s*)?[^\W\d][\w.µ-]*)\s*(?:#.*)?$")
CLOCK_HZ_MIN = 1000  # below that it is in another unit


def toml_error(text: str, error: Exception) -> str:
    """What is wrong with a text that is not TOML, in a line; a word without quotes is named."""
    told = str(error).splitlines()[0]
    if place := LINE.search(told):
        line = text.splitlines()[int(place[1]) - 1]
        if bare := UNQUOTED.match(line):
            return f'{told}: {bare[1]} = "{bare[2]}" needs quotes'
    return told


def check_known(table: Table, keys: tuple[str, ...]) -> None:
    """Raises BadValueError if a table has a key other than `keys`."""
    for key in table:
        if key not in keys:
            hint = meant(key, keys) or f"; must be one of {', '.join(keys)}"
            raise BadValueError(f"unknown key {shown(key)}{hint}")


def within(place: str, check: Callable[[], Any]) -> Any:
    """Return the result of `check`; adds the place to its BadValueError."""
    try:
        return check()
    except BadValueError as error:
        raise BadValueError(f"{place}: {error}") from None


def get_value(table: Table, key: str) -> Any:
    """The value of a key; raises BadValueError if it is missing."""
    if key not in table:
        raise BadValueError(f"{key} is missing")
    return table[key]


def read_integer(table: Table, key: str, low: int, high: int) -> int:
    """An integer, low .. high."""
    value = get_value(table, key)
    if type(value) is not int:
        whole = isinstance(value, Decimal) and value.is_finite() and low <= value <= high and value % 1 == 0
        hint = f"; write {int(value):_}" if whole else ""
        raise BadValueError(f"{key} must be a whole number, not {shown(value)}{hint}")
    if not low <= value <= high:
        raise BadValueError(f"{key} must be {low} to {high}")
    return value


def read_number(table: Table, key: str) -> Fraction:
    """A number that is not negative."""
    value = _number(table, key)
    if value < 0:
        raise BadValueError(f"{key} must not be negative")
    return check_number(key, value, NUMBER_MAX)


def read_signed(table: Table, key: str) -> Fraction:
    """A number with a sign."""
    return check_number(key, _number(table, key), SIGNED_MAX)


def read_time(table: Table, key: str, clock_hz: int) -> Fraction:
    """Seconds, or a text with a unit."""
    value = get_value(table, key)
    if isinstance(value, str):
        return parse_time(key, value, clock_hz)
    _number(table, key, ' or a text such as "400ms"')
    return read_number(table, key)


def _number(table: Table, key: str, others: str = "") -> int | Decimal:
    value = get_value(table, key)
    if type(value) is not int and not isinstance(value, Decimal):
        raise BadValueError(f"{key} must be a number{others}, not {shown(value)}")
    if isinstance(value, Decimal) and not value.is_finite():
        raise BadValueError(f"{key} must be finite, not {value}")
    return value


def read_positive(table: Table, key: str) -> int:
    """An integer above 0."""
    return read_integer(table, key, 1, WHOLE_MAX)


def read_word(table: Table, key: str, choices: tuple[str, ...]) -> str:
    """One of some words."""
    word = get_value(table, key)
    if word not in choices:
        raise BadValueError(
            f"{key} must be one of {', '.join(choices)}, not {shown(word)}{meant(word, choices)}"
        )
    return word


def read_flag(table: Table, key: str) -> bool:
    """true or false."""
    flag = get_value(table, key)
    if not isinstance(flag, bool):
        raise BadValueError(f"{key} must be true or false, not {shown(flag)}")
    return flag


def read_clock_hz(table: Table) -> int:
    """The key clock_hz."""
    clock_hz = read_positive(table, "clock_hz")
    if clock_hz < CLOCK_HZ_MIN:
        raise BadValueError(f"clock_hz = {clock_hz} is in Hz: write {clock_hz}_000_000 for {clock_hz} MHz")
    return clock_hz


def read_subtable(table: Table, key: str) -> Table:
    """The table [key]; empty if it is missing."""
    inner = table.get(key, {})
    if not isinstance(inner, dict):
        raise BadValueError(f"{key} must be a table: [{key}]")
    return inner


def read_tables(table: Table, key: str) -> list[Table]:
    """The tables [[key]]; none if it is missing."""
    tables = table.get(key, [])
    if not isinstance(tables, list) or not all(isinstance(inner, dict) for inner in tables):
        raise BadValueError(f"{key} must be an array of tables: [[{key}]]")
    return tables
