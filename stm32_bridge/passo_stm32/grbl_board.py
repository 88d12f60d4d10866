# SPDX-License-Identifier: MIT
"""The board with the grbl image, and a sender at its serial line."""

import re
from collections.abc import Iterable
from pathlib import Path

from passo.toolchain import paths

from passo_stm32.board import make_firmware
from passo_stm32.machine import Machine
from passo_stm32.processor import FLASH
from passo_stm32.wires import CorePins

FOLDER = paths.build / "firmware_grbl"
# images, as their makefile calls them
SMALL_IMAGE, LARGE_IMAGE, BOTH_IMAGE = ("GRBL=1",), ("CHIP=cb", "GRBL=1"), ("CHIP=cb",)
GREETING = "Grbl 1.1h ['$' for help]\r\n"
START = 0.5  # seconds until the greeting
RECEIVED = 128  # bytes that senders count with
ANSWER = re.compile(r"^(ok|error:\d+)\r\n", re.M)


def grbl_elf(folder: Path = FOLDER, *machine: str, image: tuple[str, ...] = SMALL_IMAGE) -> Path:
    """Build an image if it is out of date; `machine` are the definitions of grbl_machine.h, AXES=3 ... ."""
    elf = folder / "passo.elf"
    flags = " ".join(f"-D{definition}" for definition in machine)
    make_firmware(*image, f"OUT={folder}", f"MACHINE={flags}", str(elf))
    return elf


class Answers:
    """The number of lines that a board answered since this was made."""

    def __init__(self, board: Machine):
        self._board, self._seen, self._count = board, len(board.output), 0

    @property
    def count(self) -> int:
        """Answers so far; looks at new output only, because it is asked at every step of a long stream."""
        if self._seen != len(self._board.output):
            for answer in ANSWER.finditer(self._board.output, self._seen):
                self._seen = answer.end()
                self._count += 1
        return self._count


class GrblBoard(Machine):
    """The machine from power-on to the greeting. `settings`: of another board, to begin with."""

    def __init__(self, core: CorePins | None, elf: Path, settings: bytes = b"", **options: object):
        super().__init__(elf, core, **options)
        self.write_memory(self._settings_at, settings)
        self.expect(GREETING, START)

    @property
    def settings(self) -> bytes:
        """The pages of the flash with the settings."""
        return self.read_memory(self._settings_at, FLASH + self.flash_size - self._settings_at)

    @property
    def _settings_at(self) -> int:
        return self.elf.symbols["settings_pages"]

    def line(self, text: str, seconds: float = 1.0) -> str:
        """Type a line; return all that is said until its answer."""
        since, answers = len(self.output), Answers(self)
        self.type(text + "\n")
        self.run_until(lambda: answers.count, seconds)
        return self.output[since:].replace("\r\n", "\n").strip()

    def report(self) -> dict[str, str]:
        """A status report: state and fields."""
        since = len(self.output)
        self.type("?")
        self.expect(">\r\n", 0.1, since)
        state, *fields = re.findall(r"<(.*)>", self.output[since:])[-1].split("|")
        return {"state": state, **dict(field.split(":", 1) for field in fields)}

    def stream(self, lines: Iterable[str], seconds: float) -> None:
        """Type lines by counting characters: never more unanswered than the board can hold."""
        answers, lengths, answered = Answers(self), [], 0
        end = self.seconds + seconds
        for line in lines:
            data = line + "\n"
            while sum(lengths[answered:]) + len(data) > RECEIVED:
                done = answered
                self.run_until(lambda done=done: answers.count > done, end - self.seconds)
                answered = answers.count
            lengths.append(len(data))
            self.type(data)
        self.run_until(lambda: answers.count == len(lengths), end - self.seconds)

    def rest(self, seconds: float) -> None:
        """Run until nothing moves."""
        end = self.seconds + seconds
        while self.report()["state"] != "Idle":
            if self.seconds > end:
                raise TimeoutError(f"still {self.report()} after {seconds} s")
            self.run(0.02)

    def restart(self) -> None:
        """Turn the board off and on; the core stays as it is."""
        since = len(self.output)
        self.request_reset("power")
        self.expect(GREETING, START, since)
