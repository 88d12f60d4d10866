# SPDX-License-Identifier: MIT
"""Places in source files, and the error that names them."""

from dataclasses import dataclass
from pathlib import Path

from passo.failure import BadInputError


@dataclass(frozen=True)
class Place:
    """A line of a file, counted from 1."""

    path: Path
    line: int

    def __str__(self) -> str:
        return f"{self.path}:{self.line}"


class LineError(ValueError):
    """What is wrong with a line; whoever knows its place makes an ExpandError of it."""


class ExpandError(BadInputError):
    """A line of a file that cannot be expanded: file, line and reason."""

    def __init__(self, place: Place, reason: object):
        self.place, self.reason = place, str(reason)
        super().__init__(f"{place}: {reason}")
