# SPDX-License-Identifier: MIT
"""The grbl console on the C model, and what it has said."""

import re
from collections.abc import Callable
from typing import Any

from passo.gcode import place_of
from passo.grbl import Grbl

ROOM = 255  # bytes


def watch(engine: Any, pin: str) -> Callable[[], int]:
    """The levels of a pin at the last change of any, once somebody has drained the events; 0 before."""
    drain, levels = engine.drain, [0]

    def watched() -> Any:
        events = drain()
        levels.extend(int(word) for word in events[pin][-1:])
        return events

    engine.drain = watched
    return lambda: levels[-1]


class GrblConsole:
    """A console of an engine; arguments as those of Grbl, without where it writes."""

    def __init__(self, engine: Any, machine: Any, *settings: Any):
        self.engine = engine
        self.said = self.log = ""
        self.grbl = Grbl(engine, machine, self.write, *settings)

    def write(self, text: str) -> None:
        self.said += text
        self.log += text

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

    def limit(self, patience: float) -> None:
        """Simulated seconds that it waits at most."""
        wait = self.grbl.wait
        self.grbl.wait = lambda until, seconds=patience: wait(until, min(seconds, patience))

    def send(self, data: bytes, seconds: float = 0) -> str:
        """What it answers to bytes of one batch, immediately and within a time."""
        self.take_all()
        self.grbl.type(data)
        self.grbl.poll()
        self.run(seconds)
        return self.take()

    def run(self, seconds: float) -> None:
        """Let time pass."""
        self.grbl.wait(lambda: False, seconds)

    def status(self) -> dict[str, str]:
        """A status report: state and fields."""
        (text,) = re.findall(r"<(.*)>", self.send(b"?"))
        state, *fields = text.split("|")
        return {"state": state, **dict(field.split(":", 1) for field in fields)}

    def fields(self, name: str) -> list[float]:
        """The numbers of a field of a status report; of positions one for each axis."""
        field = self.status()[name]
        if name in ("MPos", "WPos", "WCO"):
            return place_of(field, self.grbl.machine.letters)
        return [float(number) for number in field.split(",")]

    @property
    def answers(self) -> list[str]:
        """All since the beginning."""
        return re.findall(r"^(?:ok|error:\d+)(?=\r$)", self.log, re.M)

    def finish(self) -> None:
        """Wait until all lines are answered, and it is idle."""
        assert self.grbl.wait(lambda: self.grbl.room == ROOM and not self.grbl.c.owes and self.grbl.is_idle)

    def rest(self) -> None:
        """Wait until it is idle."""
        assert self.grbl.wait(lambda: self.grbl.is_idle)
