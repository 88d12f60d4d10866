# SPDX-License-Identifier: MIT
"""A serial port of this computer, to the firmware of an STM32F103."""

import errno
import fcntl
import os
import re
import select
import termios
import time
import tty
from pathlib import Path
from typing import ClassVar, Protocol, Self

from passo.failure import BadInputError, Failure

RESET, REPORT = b"\x18", b"?"
GREETING, STATUS = "Grbl ", r"<.*?>"
READ = 4096


class Line(Protocol):
    """A serial line to the firmware."""

    real_time: bool  # time passes by itself, not in `read`

    def write(self, data: bytes) -> None:
        """Send bytes."""

    def read(self, seconds: float) -> str:
        """Let this time pass; return what was received."""

    def close(self) -> None:
        """Let it go."""


class Conversation:
    """With the grbl image. Raises Failure if it does not answer, or refuses."""

    ANSWER: ClassVar[float] = 2.0  # seconds until a line is answered
    LOOK: ClassVar[float] = 0.05  # seconds between two looks

    def __init__(self, port: Line):
        self.port = port

    def _ask(self, data: bytes, answer: str, lacking: str) -> tuple[str, re.Match[str]]:
        """Send bytes; return what is said until it has the answer, and that."""
        self.port.write(data)
        said = ""
        for _ in range(round(self.ANSWER / self.LOOK)):
            said += self.port.read(self.LOOK)
            if found := re.search(answer, said, re.M):
                return said, found
        raise Failure(f"{lacking}: is it the grbl image, at 115200 baud?")

    def line(self, text: str) -> str:
        """Send a line; return what is said before its answer."""
        said, found = self._ask(text.encode() + b"\n", r"^(ok|error:\d+)\r?$", f"no answer to {text}")
        if found[1] != "ok":
            raise Failure(f"{text} was refused: {found[1]} (docs/gcode.md)")
        return said[: found.start()]

    def restart(self) -> None:
        """Reset the protocol, and wait for its greeting: bytes before it are dropped."""
        self._ask(RESET, GREETING, "no greeting")

    def report(self) -> dict[str, str]:
        """A status report, by its fields: the last one that is heard."""
        said, _ = self._ask(REPORT, STATUS, "no status report")
        return self.fields(re.findall(STATUS, said)[-1])

    @staticmethod
    def fields(report: str) -> dict[str, str]:
        """Of a status report, with its `state`."""
        state, *fields = report.strip("<>").split("|")
        return {"state": state, **dict(field.split(":", 1) for field in fields)}


class SerialPort:
    """115200 baud, locked against a second program. Raises BadInputError."""

    real_time = True

    def __init__(self, path: Path):
        self._file = -1
        try:
            self._file = os.open(path, os.O_RDWR | os.O_NOCTTY)
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            tty.setraw(self._file)
            settings = termios.tcgetattr(self._file)
            settings[4] = settings[5] = termios.B115200
            termios.tcsetattr(self._file, termios.TCSANOW, settings)
        except BlockingIOError:
            self.close()
            raise BadInputError(f"{path}: another program holds it: end that program first") from None
        except (OSError, termios.error) as error:
            self.close()
            reason = "this is no serial port" if error.args[0] == errno.ENOTTY else error.args[1]
            raise BadInputError(f"{path}: {reason}") from None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Let it go."""
        if self._file >= 0:
            os.close(self._file)
        self._file = -1

    def write(self, data: bytes) -> None:
        """Send bytes."""
        os.write(self._file, data)

    def read(self, seconds: float) -> str:
        """Let this time pass, 0: none; return what was received."""
        received, end = b"", time.monotonic() + seconds
        while select.select([self._file], [], [], max(0.0, end - time.monotonic()))[0]:
            received += os.read(self._file, READ)
        return received.decode("latin-1")

    def press(self, pressed: object, active: bool) -> None:
        """A person does it."""
