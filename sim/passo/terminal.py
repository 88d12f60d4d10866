# SPDX-License-Identifier: MIT
"""The console of the STM32 bridge with a simulated core: `passo console`.

Simulated time advances only on request: a line takes as long as its frames on the link, a move until there
is room for it, `run SECONDS` advances time, and `wait` advances it until all motions have ended. The same
input always gives the same output.
"""

import re
from collections.abc import Callable, Iterable
from decimal import Decimal
from typing import Any, Self

import numpy as np

from passo.console import passing
from passo.engine import EVENT, Engine
from passo.machine import Machine
from passo.native import console, ffi
from passo.pair_engine import PairEngine
from passo.pins import INPUTS
from passo.shafts import Shafts

GAP, GAP_PER_WORD = 64, 4  # clocks after a frame
PATIENCE = 20  # rounds that a motion may be held or wait for sync
ROUND = 1000  # microseconds between two polls
MICROSECONDS = 1_000_000
RUN_MAX = 3600  # seconds
DECIMAL = re.compile(r"\d{1,6}(\.\d{0,9})?")

PINS = [pin.name for pin in INPUTS if pin.name == "sync" or pin.parameter]
LEVELS = re.compile(r"\d{1,6}")
COUNTS = re.compile(r"-?\d{1,9}")

STANDS = "the motion does not go on: it is held, or waits for the sync input"

HELP = """  run: let seconds of simulated time pass (only in the simulation)
  wait: let time pass until nothing is queued or moves (only in the simulation)
  pin: set the levels of an input of the core, a bit per axis (only in the simulation)
  slip: turn the encoder of an axis by counts against its axis (only in the simulation)
  quit, exit: end the simulation
"""


class Terminal:
    """A console and its core.

    `write` receives all output, in pieces; `keep`: store the pin events for pulses(). `shafts`: the encoders
    at the engine. Setting `interrupted` ends what lets time pass.
    """

    def __init__(
        self,
        engine: Engine | PairEngine | Machine,
        write: Callable[[str], object],
        keep: bool = False,
        shafts: Shafts | None = None,
    ):
        self.engine, self._write, self._keep, self._shafts = engine, write, keep, shafts
        self._events: list[np.ndarray] = []
        self._error: Exception | None = None
        self.interrupted = False
        self._stands = False  # a move waits for queue space, but the motion does not go on
        types = (
            "bool(void *, uint32_t *, uint32_t *, size_t)",
            "uint32_t(void *, uint32_t)",
            "bool(void *)",
            "void(void *, char *)",
        )
        functions = self._transfer, self._advance, self._irq, self._say
        # cffi requires that they live as long as the console.
        self._callbacks = [
            ffi().callback(kind, function, onerror=self._failed)
            for kind, function in zip(types, functions, strict=True)
        ]
        caller = ffi().new("struct passo_terminal_caller *")
        caller.transfer, caller.advance, caller.irq, caller.write = (
            ffi().cast("void *", callback) for callback in self._callbacks
        )
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
        """Execute a line: a command of the simulation (run, wait, pin, slip) or of the console."""
        words = words_of(text)
        self.interrupted = False
        if words[:1] == ["wait"]:
            self._answer(self.wait() if len(words) == 1 else "wait takes no keys")
        elif words[:1] == ["run"]:
            self._answer(self._run(words[1:]))
        elif words[:1] == ["pin"]:
            self._answer(self._pin(words[1:]))
        elif words[:1] == ["slip"]:
            self._answer(self._slip(words[1:]))
        else:
            if words in (["help"], ["?"]):
                self._write(HELP)
            self.type(text.encode("utf-8", "surrogateescape") + b"\n")
            self._wait_for_room()

    def finish(self) -> None:
        """No more lines come: answer a move that still waits for room."""
        if self._owes():
            self._answer(STANDS)

    def quit(self) -> None:
        """Answer the last line."""
        self.finish()
        self._answer(None)

    def wait(self) -> str | None:
        """Let time pass until all motions have ended; return None, or why they do not end."""
        return self._pass("wait", lambda status: status == console().PASSO_TERMINAL_IDLE)

    def run(self, microseconds: int) -> str | None:
        """Let time pass, including the time that frames take meanwhile; return None, or what ended it."""
        end = self.engine.clock + microseconds * self.engine.clock_hz // MICROSECONDS
        problem = None
        with passing("run", microseconds / MICROSECONDS) as report:
            while self.engine.clock < end and not problem:
                self._poll()
                left = (end - self.engine.clock) * MICROSECONDS // self.engine.clock_hz
                self._advance(None, max(1, min(left, ROUND)))
                report((microseconds - left) / MICROSECONDS)
                problem = self._interruption()
        self._poll()
        return problem

    def pulses(self) -> np.ndarray:
        """All pin events (EVENT) since the start, if they are kept."""
        self._collect()
        return np.concatenate([np.empty(0, EVENT), *self._events])

    def _wait_for_room(self) -> None:
        """Let time pass until the move that waits for room is answered, or the motion does not go on."""
        if not self._owes():
            self._stands = False
            return
        problem = self._pass("wait for room", lambda _: not self._owes())
        if problem and not self._stands:
            self._write(f"note: the move waits: {problem}\n")
        self._stands = problem is not None

    def _owes(self) -> bool:
        return bool(console().passo_terminal_owes(self._console))

    def _pass(self, name: str, is_over: Callable[[int], bool]) -> str | None:
        """Let time pass until the status satisfies a condition; return None, or why it does not."""
        began, waits = self.engine.clock, 0
        with passing(name) as report:
            while not is_over(status := self._poll()):
                waits = waits + 1 if status == console().PASSO_TERMINAL_WAITS else 0
                if waits == PATIENCE:
                    return STANDS
                if problem := self._interruption():
                    return problem
                self._advance(None, ROUND)
                report((self.engine.clock - began) / self.engine.clock_hz)
        return None

    def _interruption(self) -> str | None:
        return "interrupted" if self.interrupted else None

    def _run(self, words: list[str]) -> str | None:
        if len(words) != 1 or not DECIMAL.fullmatch(words[0]) or Decimal(words[0]) > RUN_MAX:
            return f"run needs seconds, at most {RUN_MAX}"
        return self.run(int(Decimal(words[0]) * MICROSECONDS))

    def _pin(self, words: list[str]) -> str | None:
        if len(words) != 2 or words[0] not in PINS or not LEVELS.fullmatch(words[1]):
            return f"pin needs a name and levels, such as pin estop_n 0; names are {', '.join(PINS)}"
        self.engine.set(words[0], int(words[1]))
        return None

    def _slip(self, words: list[str]) -> str | None:
        if len(words) != 2 or not LEVELS.fullmatch(words[0]) or not COUNTS.fullmatch(words[1]):
            return "slip needs an axis and counts, such as slip 0 -40"
        if self._shafts is None or not self._shafts.slip(int(words[0]), int(words[1])):
            return f"axis {words[0]} has no --encoder"
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

    def _irq(self, _: Any) -> bool:
        return bool(self.engine.irq)

    def _say(self, _: Any, text: Any) -> None:
        self._write(ffi().string(text).decode("ascii", "replace"))

    def _collect(self) -> None:
        """Drain the events of the engine."""
        if self._shafts:
            self._shafts.forget()
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


def words_of(line: str) -> list[str]:
    """The words of a line without its comment."""
    return line.partition("#")[0].split()


def talk(lines: Iterable[str], terminal: Terminal, echo: Callable[[str], object] | None = None) -> None:
    """Execute lines to their end, or to `quit` or `exit`; `echo` receives each before its answer."""
    for line in lines:
        text = line.rstrip("\r\n")
        if echo:
            echo(f"> {text}\n")
        if words_of(text) in (["quit"], ["exit"]):
            terminal.quit()
            return
        terminal.line(text)
    terminal.finish()
