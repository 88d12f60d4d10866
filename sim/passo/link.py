# SPDX-License-Identifier: MIT
"""Python binding of the link library (stm32_bridge/driver/passo_host.h), the host's end of the SPI link."""

from collections.abc import Sequence
from typing import Any, Protocol

from passo.engine import Engine
from passo.failure import Failure
from passo.native import ffi, planner, unopened
from passo.registers import Verdict

GAP = 64  # clocks after a frame, as PASSO_ENGINE_GAP
TRIES = 4
MICROSECONDS = 1_000_000


class LinkError(Failure):
    """A frame failed after all tries; `error` is an enum passo_error, `name` its name."""

    def __init__(self, what: str, error: int = 0):
        self.error = error
        self.name = error_name(error)
        super().__init__(what)


class RefusedError(LinkError):
    """The core refused a frame; `verdict` is the reason."""

    def __init__(self, verdict: Verdict, what: str):
        self.verdict = verdict
        error = planner().PASSO_ERROR_REFUSED + verdict
        super().__init__(f"{what} was refused: {verdict.name}: {verdict.description}", error)


class Transferring(Protocol):
    """The part of an engine that the link uses."""

    def transfer(self, mosi: Sequence[int], gap: int) -> list[int]:
        """One chip select: send the words and return those received, then wait for `gap` clocks."""


def error_name(error: int) -> str:
    """Name of an enum passo_error."""
    return ffi().string(planner().passo_error_name(error)).decode()


def error_text(error: int) -> str:
    """Description of an enum passo_error."""
    return ffi().string(planner().passo_error_text(error)).decode()


class Hardware:
    """A `struct passo_hardware` on an engine. `check` raises exceptions that occurred in its callbacks."""

    def __init__(self, engine: Any, tries: int = 0, clock_hz: int = 0):
        """With `clock_hz` it also has a microsecond clock, and waiting runs the engine."""
        self.engine, self.clock_hz = engine, clock_hz
        self._raised: BaseException | None = None
        self.c = ffi().new("struct passo_hardware *", {"tries": tries})
        if type(self) is Hardware and type(engine) is Engine and clock_hz in (0, engine.clock_hz):
            engine.connect(self.c, timed=clock_hz > 0)
            return
        # The callbacks live as long as this object.
        self._callbacks = [
            ffi().callback("bool(void *, const uint32_t *, uint32_t *, size_t)", self._transfer)
        ]
        self.c.transfer = self._callbacks[0]
        if clock_hz:
            self._callbacks += [
                ffi().callback("uint32_t(void *)", self._microseconds),
                ffi().callback("void(void *, uint32_t)", self._wait),
            ]
            self.c.microseconds, self.c.wait = self._callbacks[1:]

    def check(self) -> None:
        """Raise an exception of the engine that a callback has caught."""
        if self._raised is not None:
            raised, self._raised = self._raised, None
            raise raised

    def _transfer(self, _: Any, send: Any, receive: Any, words: int) -> bool:
        try:
            received = self.engine.transfer(ffi().unpack(send, words), GAP)
        except BaseException as error:
            self._raised = error
            return False
        receive[0:words] = received
        return True

    def _microseconds(self, _: Any) -> int:
        return self.engine.clock * MICROSECONDS // self.clock_hz & 0xFFFFFFFF

    def _wait(self, _: Any, microseconds: int) -> None:
        try:
            self.engine.run(microseconds * self.clock_hz // MICROSECONDS + 1)
        except BaseException as error:
            self._raised = error


class Link:
    """Register access with exactly-once frames. Methods raise LinkError, or RefusedError with the verdict."""

    def __init__(self, engine: Transferring, tries: int = TRIES):
        self.engine = engine
        self.tries = tries
        self._hardware = Hardware(engine, tries)
        self._c = planner()
        self.host = unopened("passo_host")
        self._check(self._c.passo_host_open(self.host, self._hardware.c), "read of 0x000")

    @property
    def retries(self) -> int:
        """Number of frames resent so far."""
        return self.host.counters.retries

    @property
    def status(self) -> int:
        """The last valid status word."""
        return self.host.status

    def write(self, address: int, *words: int) -> None:
        """Write 1 to 60 consecutive registers."""
        error = self._c.passo_host_write(self.host, address, words, len(words))
        self._check(error, f"write to 0x{address:03X}")

    def push(self, address: int, words: Sequence[int]) -> None:
        """Write 1 to 60 words to one register."""
        error = self._c.passo_host_push(self.host, address, list(words), len(words))
        self._check(error, f"push to 0x{address:03X}")

    def read(self, address: int, length: int) -> list[int]:
        """Read 1 to 60 consecutive registers."""
        words = ffi().new("uint32_t[]", length)
        self._check(self._c.passo_host_read(self.host, address, words, length), f"read of 0x{address:03X}")
        return list(words)

    def _check(self, error: int, what: str) -> None:
        self._hardware.check()
        if error == self._c.PASSO_OK:
            return
        if error >= self._c.PASSO_ERROR_REFUSED:
            raise RefusedError(Verdict(error - self._c.PASSO_ERROR_REFUSED), what)
        wire = self._c.PASSO_ERROR_TRANSFER < error <= self._c.PASSO_ERROR_BAD_CRC
        failed = f"failed {self.tries} times" if wire else "failed"
        raise LinkError(f"{what} {failed}: {error_text(error)}", error)
