# SPDX-License-Identifier: MIT
"""Readers of the keys of a move file, by the kind of key; see table_values.py. Errors raise BadValueError."""

from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

from passo.form_table import Form, Place, Shaper
from passo.move_forms import (
    PROFILES,
    SHAPED,
    SIGNED_MAX,
    SUBSTEPS_MAX,
    USER,
    Key,
    Points,
)
from passo.moves import AXES_MAX, CHANNELS_MAX
from passo.shaper import DAMPING_MAX, SHAPERS
from passo.table_values import (
    Table,
    check_known,
    get_value,
    read_flag,
    read_integer,
    read_number,
    read_signed,
    read_time,
    read_word,
    within,
)
from passo.values import NUMBER, BadValueError, check_number, shown

BYTE_MAX = 255


def read_steps(table: Table, key: str) -> tuple[int, ...]:
    """Steps of each axis; the sign is the direction."""
    steps = get_value(table, key)
    if not isinstance(steps, list) or any(type(n) is not int for n in steps):
        raise BadValueError("steps must be a list of whole numbers, one per axis")
    if not 1 <= len(steps) <= AXES_MAX:
        raise BadValueError(f"steps has {len(steps)} axes; must be 1 to {AXES_MAX}")
    for axis, n in enumerate(steps):
        if abs(n) > SUBSTEPS_MAX:
            raise BadValueError(f"axis {axis} has too many steps; must be at most {SUBSTEPS_MAX}")
    return tuple(steps)


def _shapes(table: Table) -> tuple[str, ...]:
    """The profiles of a form that accepts a shape; an input shaper needs a given time, and a move file."""
    shapes = table.get("profile") == SHAPED and "total_time" in table
    return (*PROFILES, USER, SHAPED) if shapes else (*PROFILES, USER)


def read_table_file(table: Table, key: str) -> str | Points:
    """Name of the file with a user-defined shape; empty for other profiles."""
    if table.get("profile") != USER:
        if key in table:
            raise BadValueError(f'{key} needs profile = "{USER}"')
        return ()
    name = get_value(table, key)
    if not isinstance(name, str) or not name:
        raise BadValueError(f"{key} must be the name of a file, not {shown(name)}")
    return name


def read_shaper(table: Table, key: str) -> Shaper | None:
    """An input shaper; None for other profiles."""
    if table.get("profile") != SHAPED:
        if key in table:
            raise BadValueError(f'{key} needs profile = "{SHAPED}"')
        return None
    facts = get_value(table, key)
    if not isinstance(facts, dict):
        raise BadValueError(
            f'{key} must be a table such as {{ name = "zv", frequency = 40 }}, not {shown(facts)}'
        )
    return within(key, lambda: _shaper(facts))


def _shaper(facts: Table) -> Shaper:
    check_known(facts, ("name", "frequency", "damping"))
    name, frequency = read_word(facts, "name", SHAPERS), read_number(facts, "frequency")
    damping = read_number(facts, "damping") if "damping" in facts else Fraction(0)
    if not frequency:
        raise BadValueError("frequency must be greater than 0")
    if damping > DAMPING_MAX:
        raise BadValueError(f"damping must be 0 to {float(DAMPING_MAX)}")
    return Shaper(name, frequency, damping)


def read_axes(table: Table, key: str) -> int:
    """Number of axes; by default just enough for the key `axis`."""
    least = table.get("axis", 0) + 1
    return read_integer(table, key, least, AXES_MAX) if key in table else least


def read_per_axis(table: Table, key: str) -> tuple[Fraction, ...]:
    """One number for all axes, or a list."""
    axes = len(read_distance(table, "distance"))
    value = get_value(table, key)
    if not isinstance(value, list):
        return (read_number(table, key),) * axes
    if len(value) != axes:
        raise BadValueError(f"{key} has {len(value)} axes, but distance has {axes}")
    return tuple(read_number({key: item}, key) for item in value)


def read_distance(table: Table, key: str) -> tuple[Fraction, ...]:
    """Millimeters of each axis."""
    value = get_value(table, key)
    if not isinstance(value, list) or not 1 <= len(value) <= AXES_MAX:
        raise BadValueError(f"{key} must be a list of 1 to {AXES_MAX} numbers, one per axis")
    return tuple(read_signed({key: item}, key) for item in value)


def read_place(table: Table, key: str) -> Place:
    """A position in steps, or a text in millimeters."""
    value = get_value(table, key)
    if not isinstance(value, str):
        return Place(Fraction(read_integer(table, key, -SIGNED_MAX, SIGNED_MAX)))
    number = value.removesuffix("mm")
    if number == value or not NUMBER.fullmatch(number):
        raise BadValueError(f'{key} must be steps or a text such as "12.5mm", not {shown(value)}')
    return Place(check_number(key, Decimal(number.replace("_", "")), SIGNED_MAX), in_mm=True)


def read_places(table: Table, key: str) -> tuple[int, ...]:
    """Whole numbers, one for each axis."""
    value = get_value(table, key)
    if not isinstance(value, list) or not 1 <= len(value) <= AXES_MAX:
        raise BadValueError(f"{key} must be a list of 1 to {AXES_MAX} whole numbers, one per axis")
    return tuple(read_integer({key: item}, key, -SIGNED_MAX, SIGNED_MAX) for item in value)


def read_values(table: Table, key: str) -> tuple[int, ...]:
    """Bytes, one at least."""
    value = get_value(table, key)
    if not isinstance(value, list) or not value:
        raise BadValueError(f"{key} must be a list of whole numbers, 0 to {BYTE_MAX}")
    return tuple(read_integer({key: item}, key, 0, BYTE_MAX) for item in value)


def read_scales(table: Table, key: str) -> tuple[Fraction, ...]:
    """One number for all axes, or a list."""
    value = get_value(table, key)
    items = value if isinstance(value, list) else [value] * AXES_MAX
    if not 1 <= len(items) <= AXES_MAX:
        raise BadValueError(f"{key} must be a number, or a list of 1 to {AXES_MAX} numbers, one per axis")
    scales = tuple(read_number({key: item}, key) for item in items)
    if not all(scales):
        raise BadValueError(f"{key} must be greater than 0")
    return scales


# By kind of key; times need the clock.
READERS: dict[str, Callable[[Table, Key, int], Any]] = {
    "steps": lambda table, key, _: read_steps(table, key.name),
    "profile": lambda table, key, _: read_word(table, key.name, PROFILES),
    "shape": lambda table, key, _: read_word(table, key.name, _shapes(table)),
    "shaper": lambda table, key, _: read_shaper(table, key.name),
    "table": lambda table, key, _: read_table_file(table, key.name),
    "time": lambda table, key, clock_hz: read_time(table, key.name, clock_hz),
    "number": lambda table, key, _: read_number(table, key.name),
    "signed": lambda table, key, _: read_signed(table, key.name),
    "alpha": lambda table, key, _: read_number(table, key.name),
    "whole": lambda table, key, _: read_integer(table, key.name, key.low, key.high),
    "axis": lambda table, key, _: read_integer(table, key.name, 0, AXES_MAX - 1),
    "axes": lambda table, key, _: read_axes(table, key.name),
    "channel": lambda table, key, _: read_integer(table, key.name, 0, CHANNELS_MAX - 1),
    "distance": lambda table, key, _: read_distance(table, key.name),
    "per_axis": lambda table, key, _: read_per_axis(table, key.name),
    "word": lambda table, key, _: read_word(table, key.name, key.choices),
    "flag": lambda table, key, _: read_flag(table, key.name),
    "place": lambda table, key, _: read_place(table, key.name),
    "places": lambda table, key, _: read_places(table, key.name),
    "values": lambda table, key, _: read_values(table, key.name),
    "scales": lambda table, key, _: read_scales(table, key.name),
}


def read_key(table: Table, key: Key, clock_hz: int) -> Any:
    """The value of a key of a form, or its default."""
    if key.optional and key.name not in table:
        return None
    if key.default is not None and key.name not in table:
        names_key = isinstance(key.default, str) and key.kind != "word"
        default = table[key.default] if names_key else key.default
        table = {**table, key.name: default}
    return READERS[key.kind](table, key, clock_hz)


def check_rules(form: Form, table: Table) -> None:
    """Check the rules between the keys of a form."""
    for rule in form.rules:
        if rule.key not in table:
            continue
        if rule.kind == "excludes" and rule.other in table:
            raise BadValueError(f"{rule.key} and {rule.other} are mutually exclusive")
        if rule.kind == "needs" and rule.other not in table:
            raise BadValueError(f"{rule.key} needs {rule.other}")
        if rule.kind == "above_zero" and table[rule.key] == 0:
            raise BadValueError(f"{rule.key} must be greater than 0")
