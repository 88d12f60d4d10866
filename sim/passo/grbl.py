# SPDX-License-Identifier: MIT
"""The grbl console (stm32_bridge/grbl/passo_grbl.h) with a simulated core: `passo console --grbl`."""

import contextlib
import os
import time
import tty
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path as FilePath
from typing import Any

from passo.driver import Driver
from passo.expand.block import words_of
from passo.expand.lathe import DIAMETERS, Lathe, Said
from passo.expand.machine import Machine
from passo.expand.place import LineError
from passo.failure import BadInputError, Failure
from passo.gcode import Gcode, set_tool_lengths
from passo.grbl_setup import SettingsFile, defaults_of, encoders_of, setup_of
from passo.machine_file import MachineFile
from passo.native import ffi, planner, unopened
from passo.part import FOLLOWS_PER_SECOND, LOOPS_PER_SECOND, SLEWS_PER_SECOND
from passo.path import LOOK_AHEAD, Path, PathFeed
from passo.player import Player
from passo.spindle_at import SpindleAt

REAL_TIME = (b"?", b"!", b"~", b"\x18")  # lines of one of these bytes alone are sent without an end of line
PATIENCE = 600  # simulated seconds until the machine rests
READ = 4096
ENDS = (20, 300)  # M2 and M30


class Grbl:
    """A `struct passo_grbl` on a machine; `write` receives all answers, in pieces."""

    def __init__(
        self,
        engine: Any,
        machine: MachineFile,
        write: Callable[[str], object],
        settings: SettingsFile | None = None,
        tools: Mapping[int, float] | None = None,
        spindle: SpindleAt | None = None,
    ):
        """Settings and offsets are kept in a file, or not at all; `tools` are lengths in mm.

        `spindle`: at the pins, is turned as commanded.
        """
        self.engine, self.machine, self._write = engine, machine, write
        self.spindle = spindle
        driver = Driver(engine, machine.clock_hz, engine.parameters)
        slew = machine.clock_hz // SLEWS_PER_SECOND
        driver.call("configure_motion", slew, slew, 1 << 16)
        feed = PathFeed(driver, Path(machine.settings, engine.parameters, LOOK_AHEAD))
        self.player = Player(Gcode(machine.gcode), feed)
        self._c = planner()
        self._error: Exception | None = None  # of `write`, which C calls
        self._say = ffi().callback("void(void *, char *)", self._said, onerror=self._failed)
        self._sink = ffi().new("struct passo_grbl_sink *")
        self._sink.write = ffi().cast("void *", self._say)
        self.answers = 0  # ok and error so far
        self.c = unopened("passo_grbl")
        self._settings = settings
        self._defaults = defaults_of(machine)
        pages = settings.c if settings else ffi().NULL
        given = encoders_of(machine)
        self._encoders = ffi().new("uint64_t[]", given) if given else ffi().NULL
        self._setup = setup_of(machine, engine.parameters, self._defaults, pages, self._encoders)
        self._c.passo_grbl_open(self.c, self.player.c, self._sink, self._setup)
        set_tool_lengths(self.player.gcode.c, tools or {})
        self._check()

    @property
    def is_idle(self) -> bool:
        """Nothing moves or waits."""
        return self._c.passo_grbl_is_idle(self.c)

    @property
    def room(self) -> int:
        """Bytes that can be typed at present."""
        return (self.c.tail - self.c.head - 1) % 256

    def type(self, data: bytes) -> None:
        """Bytes from the host."""
        for byte in data:
            self._c.passo_grbl_receive(self.c, bytes([byte]))
        self._check()

    def poll(self) -> None:
        """One round of the main loop, and the time that it takes."""
        self._c.passo_grbl_poll(self.c)
        self._check()
        self.player.feed.driver.hardware.check()
        polls = LOOPS_PER_SECOND
        if self.spindle:
            self.spindle.drive(self.player.power, keep=False)
            polls = FOLLOWS_PER_SECOND if self.player.follows else polls
        self.engine.run(self.machine.clock_hz // polls)
        self.engine.drain()

    def wait(self, until: Callable[[], bool], seconds: float = PATIENCE) -> bool:
        """Poll until a condition holds; return whether it did within a simulated time."""
        end = self.engine.clock + round(seconds * self.machine.clock_hz)
        while not until() and self.engine.clock < end:
            self.poll()
        return until()

    def say(self, text: str) -> None:
        """Write a text of the PC's own."""
        self._write(text)

    def line(self, text: bytes) -> None:
        """A line, until it is answered; a real-time byte, until it has taken effect."""
        if text.strip() in REAL_TIME:
            self.type(text.strip())
            self.poll()
            return
        answers = self.answers
        self.type(text.rstrip(b"\r\n") + b"\n")
        if not self.wait(lambda: self.answers > answers):
            raise Failure(f"timeout: no answer to {text!r}: the machine is in hold")

    def _said(self, _: Any, text: Any) -> None:
        said = ffi().string(text).decode("ascii", "replace")
        self.answers += said == "ok\r\n" or said == "error:"
        self._write(said)

    def _failed(self, _: Any, error: Exception, __: Any) -> None:
        self._error = self._error or error

    def _check(self) -> None:
        """Raise an exception that the callback has caught."""
        if self._error:
            error, self._error = self._error, None
            raise error


class Cycles:
    """Threads and taps (G76, G84, G74) of typed lines, which the console itself does not have."""

    def __init__(self, grbl: Grbl):
        self._grbl = grbl
        self._machine = Machine(grbl.machine.gcode, {}, at_zero=True)
        self._lathe = Lathe(self._machine)

    def plain(self, line: str) -> Iterator[str]:
        """The lines that a line becomes, each to be executed before the next."""
        if line.strip().startswith("$") or line.strip().encode("utf-8", "surrogateescape") in REAL_TIME:
            self._lathe = Lathe(self._machine)
            yield line
            return
        words = words_of(line)
        if not self._lathe.becomes_others(words):
            if any(word.letter == "M" and word.code in ENDS for word in words):
                self._lathe = Lathe(self._machine)
            yield line
            return
        self._look()
        modes = ("G8", "G7") if self._machine.diameters else ()
        yield from modes[:1]
        try:
            for plain in self._lathe.plain(Said(line, words, ())):
                yield plain.text
                self._look()
        except LineError as error:
            self._grbl.say(f"[MSG:{error}]\r\n")
            yield line  # is refused
        yield from modes[1:]

    def _look(self) -> None:
        """The state of the interpreter is that of the console."""
        self._machine.gcode.c[0] = self._grbl.player.gcode.c[0]
        self._machine.diameters = self._machine.mode("DIAMETER") == DIAMETERS


def talk(lines: Iterable[str], grbl: Grbl) -> None:
    """Type lines, threads and taps as those that they become, and wait until all has been executed."""
    cycles = Cycles(grbl)
    for line in lines:
        for plain in cycles.plain(line):
            grbl.line(plain.encode("utf-8", "surrogateescape"))
    grbl.wait(lambda: grbl.is_idle)


def serve(grbl: Grbl, terminal: int, until: Callable[[], bool] = lambda: False) -> None:
    """Connect the console to a terminal, in real time."""
    began, start = time.monotonic(), grbl.engine.clock
    os.set_blocking(terminal, False)
    while not until():
        with contextlib.suppress(BlockingIOError, OSError):
            # Real-time bytes pass a full buffer, so reading continues; a sender counts the rest.
            grbl.type(os.read(terminal, READ))
        grbl.poll()
        ahead = (grbl.engine.clock - start) / grbl.machine.clock_hz - (time.monotonic() - began)
        if ahead > 0:
            time.sleep(ahead)


@contextlib.contextmanager
def pseudo_terminal(link: FilePath) -> Any:
    """Open a pseudo-terminal under a name; yields its other end."""
    ours, theirs = os.openpty()
    name = os.ttyname(theirs)
    tty.setraw(theirs)
    try:
        if link.is_symlink() and FilePath(os.readlink(link)).parent == FilePath(name).parent:
            link.unlink()
        elif os.path.lexists(link):
            raise BadInputError(f"{link}: this is no link to a terminal: choose another path")
        link.symlink_to(name)
    except OSError as error:
        raise BadInputError(f"{link}: {error.strerror}") from None
    try:
        yield ours
    finally:
        if link.is_symlink() and os.readlink(link) == name:  # not that of a later one
            link.unlink()
        os.close(theirs)
        os.close(ours)
