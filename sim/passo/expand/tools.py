# SPDX-License-Identifier: MIT
"""Tool tables in LinuxCNC's format: `T1 P1 Z25.4 D6 ;end mill`, in millimeters."""

from dataclasses import dataclass
from pathlib import Path

from passo.expand.block import Block, split
from passo.expand.place import ExpandError, LineError, Place
from passo.failure import BadInputError


@dataclass(frozen=True)
class Tool:
    """A tool; lengths in mm."""

    number: int
    diameter: float = 0.0
    length: float = 0.0


def read_tools(path: Path | None) -> dict[int, Tool]:
    """The tools by number; raises BadInputError."""
    if path is None:
        return {}
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise BadInputError(f"{path}: {error.strerror}") from None
    tools: dict[int, Tool] = {}
    for number, line in enumerate(lines, 1):
        place = Place(path, number)
        try:
            words = {letter: value(_NONE) for letter, value in Block(split(line)[0]).words}
        except LineError as error:
            raise ExpandError(place, error) from None
        if "T" in words:
            if words["T"] < 0 or words["T"] % 1:
                raise ExpandError(place, LineError(f"T{words['T']:g}: a tool needs a whole number"))
            tool = Tool(round(words["T"]), words.get("D", 0.0), words.get("Z", 0.0))
            tools[tool.number] = tool
        elif words:
            raise ExpandError(place, LineError("a tool needs its number: T"))
    return tools


def lengths(tools: dict[int, Tool]) -> dict[int, float]:
    """Those of the tools, in mm."""
    return {number: tool.length for number, tool in tools.items()}


class _NoParameters:
    def number(self, index: int) -> float:
        raise LineError("a tool table has no parameters")

    def name(self, name: str) -> float:
        raise LineError("a tool table has no parameters")

    def exists(self, name: str) -> bool:
        return False


_NONE = _NoParameters()
