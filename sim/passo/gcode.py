# SPDX-License-Identifier: MIT
"""Python binding of the G-code interpreter (c_model/gcode/passo_gcode.h)."""

import codecs
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from passo.failure import BadInputError, Failure
from passo.native import ffi, planner, unopened

NANOMETERS = 1_000_000  # per millimeter
AXIS_LETTERS = "XYZABC"
LINEAR = "XYZ"


def place_of(field: str, letters: str) -> list[float]:
    """Of each axis, in a field of a status report, which tells X, Y and Z of any machine."""
    told = LINEAR + "".join(letter for letter in letters if letter not in LINEAR)
    values = dict(zip(told, map(float, field.split(",")), strict=True))
    return [values[letter] for letter in letters]


class GcodeError(Failure):
    """A line was refused; `number` is that of grbl."""

    def __init__(self, number: int):
        self.number = number
        text = ffi().string(planner().passo_gcode_error_text(number)).decode()
        super().__init__(f"error:{number}: {text}")


@dataclass(frozen=True)
class GcodeSettings:
    """See struct passo_gcode_settings."""

    axes: int = 3
    arc_tolerance: float = 0.002  # mm
    spindle_maximum: int = 0  # rpm
    turn_counts: int = 0  # of the encoder of the spindle; 0: none
    letters: str = ""  # of the axes; none: the first ones of AXIS_LETTERS
    inputs: int = 1 + len(AXIS_LETTERS)  # of M66
    power: bool = True  # there is the output of M67 and M68
    # That M66 reads in a simulation, P0 is bit 0. None: 0, and `passo expand` does not know them.
    levels: int | None = None

    @property
    def axis_letters(self) -> str:
        """A letter for each axis."""
        return self.letters or AXIS_LETTERS[: self.axes]

    @property
    def left_out(self) -> int:
        """A bit for each of AXIS_LETTERS before the last axis that the machine leaves out."""
        letters = self.axis_letters
        before = AXIS_LETTERS[: AXIS_LETTERS.index(letters[-1])]
        return sum(1 << at for at, letter in enumerate(before) if letter not in letters)

    def simulated_inputs(self) -> Any:
        """The `inputs` of a `struct passo_program_settings`; they must live as long as the program."""
        return ffi().new("uint16_t *", self.levels or 0)

    def struct(self) -> Any:
        """The `struct passo_gcode_settings`."""
        tolerance = max(1, round(self.arc_tolerance * NANOMETERS))
        return ffi().new(
            "struct passo_gcode_settings *",
            {
                "axes": self.axes,
                "arc_tolerance": tolerance,
                "spindle_maximum": self.spindle_maximum,
                "left_out": self.left_out,
                "inputs": self.inputs,
                "power": self.power,
                "turn_counts": self.turn_counts,
            },
        )


def set_tool_lengths(gcode: Any, lengths: Mapping[int, float]) -> None:
    """Enter lengths in mm, by the number of the tool, into the table of a `struct passo_gcode`."""
    table = gcode.offsets.tool_length
    for tool, length in lengths.items():
        if 1 <= tool <= len(table):
            table[tool - 1] = round(length * NANOMETERS)


def check_text(name: object, data: bytes) -> None:
    """Refuse what is no G-code, whatever its lines are. Raises BadInputError."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        raise BadInputError(f"{name}: the file is UTF-16: save it as UTF-8")


def lines(text: bytes) -> list[bytes]:
    """The lines of a text, with their ends."""
    start, at, found = ffi().from_buffer(text), 0, []
    while at < len(text):
        count = planner().passo_gcode_line_count(start + at, len(text) - at)
        found.append(text[at : at + count])
        at += count
    return found


def stripped(line: bytes) -> Any:
    """The `struct passo_gcode_line` of a line of text; raises GcodeError."""
    if planner().passo_gcode_line_count(line, len(line)) != len(line):
        raise ValueError(f"more than one line: {line!r}")
    made = ffi().new("struct passo_gcode_line *")
    planner().passo_gcode_line_read(made, line, len(line))
    if made.overflow:
        raise GcodeError(planner().PASSO_GCODE_LINE_OVERFLOW)
    return made


def has_words(line: bytes) -> bool:
    """Whether a line says anything."""
    made = ffi().new("struct passo_gcode_line *")
    planner().passo_gcode_line_read(made, line, len(line))
    return ffi().string(made.text).strip(b"%") != b""


class Gcode:
    """A `struct passo_gcode`."""

    def __init__(self, settings: GcodeSettings | None = None):
        self.settings = settings or GcodeSettings()
        self._c = planner()
        self.c = unopened("passo_gcode")
        self._c.passo_gcode_open(self.c, self.settings.struct())

    def execute(self, line: str | bytes) -> None:
        """Execute a line; raises GcodeError."""
        self._check("execute", line)

    def jog(self, line: str | bytes) -> None:
        """The words after `$J=`; raises GcodeError."""
        self._check("jog", line)

    def actions(self) -> Iterator[Any]:
        """What is left of the line: each `struct passo_gcode_action`."""
        action = ffi().new("struct passo_gcode_action *")
        while self._c.passo_gcode_next(self.c, action):
            yield action[0]
            action = ffi().new("struct passo_gcode_action *")

    @property
    def position(self) -> tuple[int, ...]:
        """Programmed end in machine coordinates, in nanometers."""
        return tuple(self.c.position[0 : self.settings.axes])

    def _check(self, function: str, line: str | bytes) -> None:
        text = stripped(line.encode("utf-8", "replace") if isinstance(line, str) else line)
        error = getattr(self._c, f"passo_gcode_{function}")(self.c, text.text)
        if error:
            raise GcodeError(error)
