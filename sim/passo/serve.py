# SPDX-License-Identifier: MIT
"""A simulated core at a Unix socket: `passo serve`. The other end is linux/passo_linux_socket.c.

A host sends plain SPI frames and lets time pass. In simulated time nothing else moves the clock; in real
time the core follows the clock of this computer.
"""

import contextlib
import os
import selectors
import socket
import struct
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from passo.engine import EVENT
from passo.failure import BadInputError
from passo.link import GAP, MICROSECONDS

GREETING = 0x50415353  # "PASS"
SIMULATED_TIME, REAL_TIME, BUSY = range(3)
WORD = 4
FRAME_MAX = 64  # words
MILLISECOND = 0.001
BEHIND = 0.1  # seconds that the simulation may be late before it warns
READ = 1 << 16


class Server:
    """Serves one host at a time; the core lives on between them.

    The axes go on when a host is gone: in real time by themselves, in simulated time while the next host lets
    time pass.
    """

    def __init__(self, engine: Any, path: Path, real_time: bool = False, keep: bool = False):
        """`keep`: the events of the pins, for `events`. Raises BadInputError."""
        self.engine, self.path, self.real_time, self._keep = engine, path, real_time, keep
        self.hosts = 0  # so far
        self._host: socket.socket | None = None
        self._received = b""
        self._events = [np.empty(0, EVENT)]
        self._began, self._origin, self._told = time.monotonic(), engine.clock, False
        self._listener = _listen(path)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Let the host go and remove the socket; the engine is the caller's."""
        self._drop()
        self._selector.close()
        self._listener.close()
        self.path.unlink(missing_ok=True)

    @property
    def is_idle(self) -> bool:
        """There was a host, and it is gone."""
        return self.hosts > 0 and self._host is None

    @property
    def events(self) -> np.ndarray:
        """All events of the pins (EVENT) so far, if they are kept."""
        self._collect()
        self._events = [np.concatenate(self._events)]
        return self._events[0]

    def serve(
        self, until: Callable[[], bool] = lambda: False, warn: Callable[[str], None] = lambda text: None
    ) -> None:
        """Answer until a condition holds, which is checked after each message, or each millisecond."""
        while not until():
            ready = [key.fileobj for key, _ in self._selector.select(MILLISECOND)]
            if self._host in ready:  # first: it may be gone, and the next one is not to be refused
                self._read()
            if self._listener in ready:
                self._accept()
            self._catch_up(warn)

    def _accept(self) -> None:
        host, _ = self._listener.accept()
        told = BUSY if self._host else REAL_TIME if self.real_time else SIMULATED_TIME
        with contextlib.suppress(OSError):
            host.sendall(struct.pack(">2I", GREETING, told))
        if self._host:
            host.close()
            return
        self._host, self._received = host, b""
        self.hosts += 1
        self._selector.register(host, selectors.EVENT_READ)

    def _drop(self) -> None:
        if self._host:
            self._selector.unregister(self._host)
            self._host.close()
            self._host = None

    def _read(self) -> None:
        assert self._host
        try:
            data = self._host.recv(READ)
        except OSError:
            data = b""
        if not data:
            self._drop()
            return
        self._received += data
        try:
            for words in self._messages():
                self._host.sendall(self._answer(words))
        except (OSError, ValueError):  # it is gone, or no driver
            self._drop()

    def _messages(self) -> Iterator[tuple[int, ...]]:
        """The complete messages: a frame, or no words and a time."""
        while len(self._received) >= WORD:
            (count,) = struct.unpack_from(">I", self._received)
            if count > FRAME_MAX:
                raise ValueError
            size = WORD * (1 + max(count, 1))
            if len(self._received) < size:
                return
            words = struct.unpack_from(f">{size // WORD}I", self._received)
            self._received = self._received[size:]
            yield words

    def _answer(self, words: tuple[int, ...]) -> bytes:
        received: list[int] = []
        if self.real_time:
            self._catch_up()
        if words[0]:
            received = self.engine.transfer(words[1:], GAP)
        elif not self.real_time:
            self._run(words[1] * self.engine.clock_hz // MICROSECONDS)
        self._collect()
        now = self.engine.clock * MICROSECONDS // self.engine.clock_hz & 0xFFFFFFFF
        return struct.pack(f">{2 + len(received)}I", now, self.engine.irq, *received)

    def _catch_up(self, warn: Callable[[str], None] = lambda text: None) -> None:
        """In real time: run to the present."""
        if not self.real_time:
            return
        clock_hz = self.engine.clock_hz
        due = self._origin + round((time.monotonic() - self._began) * clock_hz)
        most = round(BEHIND * clock_hz)
        if due - self.engine.clock > most:
            # slower than real time: the difference is lost, or it could only grow
            if not self._told:
                self._told = True
                warn("the simulation is slower than real time: leave --real-time out, or use --engine model")
            self._origin -= due - self.engine.clock - most
            due = self.engine.clock + most
        self._run(due - self.engine.clock)

    def _run(self, clocks: int) -> None:
        while clocks > 0:
            clocks -= self.engine.run(clocks)
            self._collect()

    def _collect(self) -> None:
        events = self.engine.drain()
        if self._keep and len(events):
            self._events.append(events)


def _listen(path: Path) -> socket.socket:
    """A socket at a path; one that a dead server has left is replaced."""
    listener = socket.socket(socket.AF_UNIX)
    try:
        if path.is_socket():
            with socket.socket(socket.AF_UNIX) as probe, contextlib.suppress(ConnectionError):
                probe.connect(str(path))
                raise BadInputError(f"{path}: another program serves there: end it, or choose another path")
            path.unlink()
        elif os.path.lexists(path):
            raise BadInputError(f"{path}: this is no socket: choose another path")
        listener.bind(str(path))
    except OSError as error:
        listener.close()
        raise BadInputError(f"{path}: {error.strerror or error}") from None
    except BadInputError:
        listener.close()
        raise
    listener.listen()
    return listener
