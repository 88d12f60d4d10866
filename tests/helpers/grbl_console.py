# SPDX-License-Identifier: MIT
"""The grbl console on the C model, and what it has said."""

from typing import Any

from passo.grbl import Grbl


class GrblConsole:
    """A console of an engine; arguments as those of Grbl, without where it writes."""

    def __init__(self, engine: Any, machine: Any, *settings: Any):
        self.engine = engine
        self.said = ""
        self.grbl = Grbl(engine, machine, self.write, *settings)

    def write(self, text: str) -> None:
        self.said += text

    def take_all(self) -> str:
        """What it has said since the last call."""
        said, self.said = self.said, ""
        return said

    def take(self) -> str:
        """The same as lines, without the end of the last one."""
        return self.take_all().replace("\r\n", "\n").strip()

    def line(self, text: str) -> str:
        """What it says to a line."""
        self.grbl.line(text.encode("latin-1"))
        return self.take()

    def rest(self) -> None:
        """Wait until it is idle."""
        assert self.grbl.wait(lambda: self.grbl.is_idle)
