# SPDX-License-Identifier: MIT
"""Places in source files, and the errors that name them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from passo.failure import BadInputError, Portable

MOST = 20  # bad lines that are reported
NIST, LINUXCNC, FANUC, BOTH = "NIST", "LinuxCNC", "Fanuc", "NIST, LinuxCNC"
ITSELF = "Passo"  # what no norm has


@dataclass(frozen=True)
class Place:
    """A line of a file, counted from 1."""

    path: Path
    line: int

    def __str__(self) -> str:
        return f"{self.path}:{self.line}"


class LineError(Portable, ValueError):
    """What is wrong with a line, by which norm; whoever knows its place makes an ExpandError of it."""

    def __init__(self, reason: str, norm: str = LINUXCNC):
        self.reason, self.norm = reason, norm
        super().__init__(f"{reason} ({norm})")


class StateError(LineError):
    """One that may follow from a line before that was left out."""


class UnsureError(LineError):
    """One that follows from a line before that was left out."""

    def __init__(self) -> None:
        super().__init__("this depends on a line that is refused")


class ExpandError(BadInputError):
    """A line of a file that cannot be expanded: file, line and reason."""

    def __init__(self, place: Place, reason: object):
        self.place, self.reason, self.why = place, str(reason), reason
        self.lines: Sequence[Any] = ()  # plain lines of the others, as far as they can be executed
        super().__init__(f"{place}: {reason}")

    @property
    def each(self) -> Sequence["ExpandError"]:
        """All errors of a program, this one first."""
        return (self,)


class ContourError(ExpandError):
    """Where a tool with a radius cannot go."""


class ProgramError(ExpandError):
    """Several; place and reason are those of the first."""

    def __init__(self, errors: Sequence[ExpandError], lines: Sequence[Any] = ()):
        super().__init__(errors[0].place, errors[0].reason)
        self.lines, self._each = lines, errors

    @property
    def each(self) -> Sequence[ExpandError]:
        """All errors of a program."""
        return self._each

    def __str__(self) -> str:
        return "\n".join(listed([*map(str, self._each)]))


def listed(told: list[str]) -> list[str]:
    """The first of these sentences, and how many more there are."""
    more = len(told) - MOST
    return [*told[:MOST], *([f"and {more} more lines"] * (more > 0))]
