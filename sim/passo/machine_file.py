# SPDX-License-Identifier: MIT
"""Machine files: axes and limits of a machine, as TOML. An error is reported in one line."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

from passo.failure import BadInputError
from passo.gcode import AXIS_LETTERS, GcodeSettings
from passo.move_file import CLOCK_HZ_MIN, read_pins
from passo.move_keys import Table, check_known, read_number, read_positive, read_profile, within
from passo.moves import PinTiming
from passo.path import PathAxis, PathSettings
from passo.values import BadValueError, Written, shown

FILE_KEYS = ("clock_hz", "junction_deviation", "arc_tolerance", "profile", "spindle_maximum", "pins", "axis")
AXIS_KEYS = ("name", "steps_per_mm", "speed", "acceleration", "jerk", "jump")
PROFILES = ("linear", "cosine", "sigmoid", "jerk")
JUNCTION_DEVIATION, ARC_TOLERANCE = 0.01, 0.002  # mm


@dataclass(frozen=True)
class MachineFile:
    """A machine for G-code."""

    path: Path
    settings: PathSettings
    gcode: GcodeSettings
    pins: PinTiming

    @property
    def clock_hz(self) -> int:
        """Clock of the core."""
        return self.settings.clock_hz


def read_machine(path: Path) -> MachineFile:
    """Read and check a machine file; raises BadInputError."""
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8-sig"), parse_float=Written)
    except OSError as error:
        raise BadInputError(f"{path}: {error.strerror}") from None
    except (ValueError, RecursionError, ArithmeticError) as error:
        raise BadInputError(f"{path}: {str(error).splitlines()[0]}") from None
    try:
        return _machine(path, data)
    except BadValueError as error:
        raise BadInputError(f"{path}: {error}") from None


def _machine(path: Path, data: Table) -> MachineFile:
    check_known(data, FILE_KEYS)
    clock_hz = read_positive(data, "clock_hz")
    if clock_hz < CLOCK_HZ_MIN:
        raise BadValueError(f"clock_hz = {clock_hz} is in Hz: write {clock_hz}_000_000 for {clock_hz} MHz")
    pins = data.get("pins", {})
    if not isinstance(pins, dict):
        raise BadValueError("pins must be a table: [pins]")
    tables = data.get("axis", [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise BadValueError("axis must be an array of tables: [[axis]]")
    if not 1 <= len(tables) <= len(AXIS_LETTERS):
        raise BadValueError(f"there are {len(tables)} axes, 1 to {len(AXIS_LETTERS)} are possible: [[axis]]")
    profile = read_profile(data, "profile", PROFILES) if "profile" in data else "linear"
    if profile == "jerk":
        raise BadValueError("profile: paths have linear, cosine or sigmoid ramps, not jerk")
    axes = tuple(
        within(f"axis {number}", lambda number=number, table=table: _axis(table, AXIS_LETTERS[number - 1]))
        for number, table in enumerate(tables, 1)
    )
    tolerance = _number(data, "arc_tolerance", ARC_TOLERANCE)
    if not tolerance:
        raise BadValueError("arc_tolerance must be greater than 0")
    spindle = read_positive(data, "spindle_maximum") if "spindle_maximum" in data else 0
    return MachineFile(
        path,
        PathSettings(
            axes,
            clock_hz,
            junction_deviation=_number(data, "junction_deviation", JUNCTION_DEVIATION),
            profile=profile,
        ),
        GcodeSettings(len(axes), tolerance, spindle),
        within("pins", lambda: read_pins(pins, clock_hz)),
    )


def _number(table: Table, key: str, default: float) -> float:
    return float(read_number(table, key)) if key in table else default


def _axis(table: Table, letter: str) -> PathAxis:
    check_known(table, AXIS_KEYS)
    name = table.get("name", letter)
    if name != letter:
        raise BadValueError(f'name must be "{letter}", not {shown(name)}: axes are X, Y, Z, A, B, C in order')
    if "jerk" in table and read_number(table, "jerk"):
        raise BadValueError("jerk must be 0: ramps of paths are limited by their profile")
    limits = {}
    for key in ("steps_per_mm", "speed", "acceleration"):
        limits[key] = read_number(table, key)
        if not limits[key]:
            raise BadValueError(f"{key} must be greater than 0")
    return PathAxis(**limits, jump=read_number(table, "jump") if "jump" in table else 0)
