# SPDX-License-Identifier: MIT
"""Converts move files to console commands (docs/console.md)."""

import tomllib
from pathlib import Path
from typing import Any

from passo.move_file import PIN_KEYS
from passo.move_forms import FORMS
from passo.shape import read_table

POINTS_PER_LINE = 16
FILE_ONLY = {key.name for form in FORMS.values() for key in form.keys if key.file_only}


def read_toml(path: Path) -> dict[str, Any]:
    """Parse a move file; decimal fractions stay text."""
    return tomllib.loads(path.read_text(encoding="utf-8-sig"), parse_float=str)


def pin_lines(data: dict[str, Any], axes: int, channel: int = 0) -> list[str]:
    """Lines that set the pin timing of a channel of a file, if it has any."""
    pins = data.get("pins", {})
    pins = pins | pins.get(str(channel), {})
    words = [f"channel={channel}"] if channel else []
    words += [f"{key}={pins[key]}" for key in PIN_KEYS if key in pins]
    return [" ".join([f"config axis={axis}", *words]) for axis in range(axes)] if pins else []


def move_lines(data: dict[str, Any], folder: Path) -> list[list[str]]:
    """The lines of each move: those that load its table, unless it is loaded, and the move itself."""
    found, loaded = [], None
    for move in data["move"]:
        lines = []
        table = move.get("table")
        if table is not None and table != loaded:
            lines += table_lines(read_table(folder / table))
            loaded = table
        found.append([*lines, move_line(move)])
    return found


def move_line(move: dict[str, Any]) -> str:
    """The line of one move."""
    words = [f"{key}={_value(value)}" for key, value in move.items() if key not in FILE_ONLY]
    return " ".join(["move", *words])


def table_lines(points: tuple[int, ...]) -> list[str]:
    """The lines that load a shape."""
    return [
        f"table {row} {','.join(map(str, points[row * POINTS_PER_LINE : (row + 1) * POINTS_PER_LINE]))}"
        for row in range(len(points) // POINTS_PER_LINE)
    ]


def _value(value: Any) -> str:
    return ",".join(map(str, value)) if isinstance(value, list) else str(value)
