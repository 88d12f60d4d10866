# SPDX-License-Identifier: MIT
"""The console of the STM32 bridge with a simulated core: `passo console`.

Simulated time advances only on request: a line takes as long as its frames on the link, `run SECONDS` lets
time pass, and `wait` lets it pass until all motions have ended. The same input always gives the same output.
"""

import re
from collections.abc import Callable, Iterable
from decimal import Decimal
from typing import Any, Self

import numpy as np

from passo.engine import EVENT, Engine, PairEngine
from passo.native import console, ffi

GAP, GAP_PER_WORD = 64, 4  # clocks after a frame
PATIENCE = 5  # rounds that a motion may be held or wait for sync
ROUND = 1000  # microseconds between two polls
MICROSECONDS = 1_000_000
RUN_MAX = 3600  # seconds
DECIMAL = re.compile(r"\d{1,6}(\.\d{0,9})?")

HELP = """  run: let seconds of simulated time pass (only in the simulation)
  wait: let time pass until nothing is queued or moves (only in the simulation)
"""


class Terminal:
    """A console and its core.

    `write` receives all output, in pieces; `keep`: store the pin events for pulses().
    """

    def __init__(self, engine: Engine | PairEngine, write: Callable[[str], object], keep: bool = False):
        self.engine, self._write, self._keep = engine, write, keep
        self._events: list[np.ndarray] = []
        self._error: Exception | None = None
        types = (
            "bool(void *, uint32_t *, uint32_t *, size_t)",
            "uint32_t(void *, uint32_t)",
            "void(void *, char *)",
        )
        functions = self._transfer, self._advance, self._say
        # cffi requires that they live as long as the console.
        self._callbacks = [
            ffi().callback(kind, function, onerror=self._failed)
            for kind, function in zip(types, functions, strict=True)
        ]
        caller = ffi().new("struct passo_terminal_caller *")
        caller.transfer, caller.advance, caller.write = (ffi().cast("void *", c) for c in self._callbacks)
        self._console = console().passo_terminal_create(caller, engine.clock_hz)
        self._check()

    def close(self) -> None:
        """Free the console; the engine is the caller's."""
        console().passo_terminal_destroy(self._console)
        self._console = ffi().NULL

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def type(self, data: bytes) -> None:
        """Send bytes to the console; complete lines are executed."""
        console().passo_terminal_type(self._console, data, len(data))
        self._check()

    def line(self, text: str) -> None:
        """Execute a line: a command of the simulation (run, wait) or of the console."""
        words = text.partition("#")[0].split()
        if words[:1] == ["wait"]:
            self._answer(self.wait() if len(words) == 1 else "wait takes no keys")
        elif words[:1] == ["run"]:
            self._answer(self._run(words[1:]))
        else:
            if words == ["help"]:
                self._write(HELP)
            self.type(text.encode("utf-8", "surrogateescape") + b"\n")

    def wait(self) -> str | None:
        """Let time pass until all motions have ended; return None, or why they do not end."""
        waits = 0
        while status := self._poll():
            waits = waits + 1 if status == console().PASSO_TERMINAL_WAITS else 0
            if waits == PATIENCE:
                return "the motion does not go on: it is held, or waits for the sync input"
            self._advance(None, ROUND)
        return None

    def run(self, microseconds: int) -> None:
        """Let time pass, including the time that frames take meanwhile."""
        end = self.engine.clock + microseconds * self.engine.clock_hz // MICROSECONDS
        while self.engine.clock < end:
            self._poll()
            left = (end - self.engine.clock) * MICROSECONDS // self.engine.clock_hz
            self._advance(None, max(1, min(left, ROUND)))
        self._poll()

    def pulses(self) -> np.ndarray:
        """All pin events (EVENT) since the start, if they are kept."""
        self._collect()
        return np.concatenate([np.empty(0, EVENT), *self._events])

    def _run(self, words: list[str]) -> str | None:
        if len(words) != 1 or not DECIMAL.fullmatch(words[0]) or Decimal(words[0]) > RUN_MAX:
            return f"run needs seconds, at most {RUN_MAX}"
        self.run(int(Decimal(words[0]) * MICROSECONDS))
        return None

    def _poll(self) -> int:
        """One round of the console's main loop; return the enum passo_terminal_status."""
        status = console().passo_terminal_poll(self._console)
        self._check()
        return status

    def _answer(self, problem: str | None) -> None:
        self._write(f"error: {problem}\n" if problem else "ok\n")

    def _transfer(self, _: Any, mosi: Any, miso: Any, count: int) -> bool:
        received = self.engine.transfer(ffi().unpack(mosi, count), GAP + GAP_PER_WORD * count)
        ffi().memmove(miso, ffi().new("uint32_t[]", received), 4 * count)
        self._collect()
        return True

    def _advance(self, _: Any, microseconds: int) -> int:
        clocks = -(-microseconds * self.engine.clock_hz // MICROSECONDS)
        while clocks:
            clocks -= self.engine.run(clocks)
            self._collect()
        return self.engine.clock * MICROSECONDS // self.engine.clock_hz % 2**32

    def _say(self, _: Any, text: Any) -> None:
        self._write(ffi().string(text).decode("ascii", "replace"))

    def _collect(self) -> None:
        """Drain the events of the engine."""
        events = self.engine.drain()
        if self._keep and len(events):
            self._events.append(events)

    def _failed(self, _: Any, error: Exception, __: Any) -> None:
        self._error = self._error or error

    def _check(self) -> None:
        """Raise an exception that a callback has caught."""
        if self._error:
            error, self._error = self._error, None
            raise error


def talk(lines: Iterable[str], terminal: Terminal, echo: Callable[[str], object] | None = None) -> None:
    """Execute lines; `echo` receives each before its answer."""
    for line in lines:
        text = line.rstrip("\r\n")
        if echo:
            echo(f"> {text}\n")
        terminal.line(text)
