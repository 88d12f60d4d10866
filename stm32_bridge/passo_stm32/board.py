# SPDX-License-Identifier: MIT
"""The board: the emulated microcontroller with the firmware, a core at its pins, and a terminal."""

import fcntl
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from passo.compiler import failed, sources
from passo.engine import Engine
from passo.moves import AXES_MAX
from passo.output import make_folder
from passo.toolchain import environment, paths

from passo_stm32.machine import Machine
from passo_stm32.wires import CorePins

ELF = paths.build / "firmware" / "passo.elf"
ANSWERS = ("ok", "error:")
FAST_BAUD = 1_000_000
START = 0.3  # seconds until the greeting of the console, even without a crystal
LATENCY = 0.001  # seconds


def make_firmware(*arguments: str) -> str:
    """Run the makefile of the firmware; return its output. Raises BuildError."""
    make_folder(paths.build)
    quiet = {k: v for k, v in environment().items() if k not in ("MAKEFLAGS", "MAKELEVEL")}
    with open(paths.build / "firmware.lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        command = ["make", "-C", str(paths.firmware), *arguments]
        done = subprocess.run(command, env=quiet, capture_output=True, text=True)
    if done.returncode:
        raise failed("make", done.stderr or done.stdout)
    return done.stdout


def firmware_elf() -> Path:
    """Build the firmware if it is out of date; return the path of its ELF file."""
    make_firmware(f"OUT={ELF.parent}", str(ELF))
    return ELF


def program_elf(name: str, source: Path, *options: str) -> Path:
    """Build a program with driver and planner instead of the console; return the path of its ELF file."""
    folder = paths.build / name
    make_folder(folder)
    own = [path for path in sources(paths.firmware) if path.name != "main.c"]
    files = [source, *own, *sources(paths.driver, paths.planner, paths.protocol)]
    elf = folder / "passo.elf"
    make_firmware(f"OUT={folder}", *options, f"SOURCES={' '.join(map(str, files))}", str(elf))
    return elf


@dataclass(frozen=True)
class Motion:
    """The pulses of one motion: from the rising edge of `running` to shortly after its falling edge."""

    start: int  # clock
    clocks: int  # duration of `running`
    step: np.ndarray  # one row per change: clock since the start, levels of all STEP pins
    dir: np.ndarray  # levels of the DIR pins for each row

    def same_as(self, other: "Motion") -> str:
        """The first difference, in words; empty if there is none."""
        if self.clocks != other.clocks:
            return f"{self.clocks} clocks long instead of {other.clocks}"
        common = min(len(self.step), len(other.step))
        wrong = np.flatnonzero((self.step[:common] != other.step[:common]).any(axis=1))
        at = int(wrong[0]) if len(wrong) else common
        if at < max(len(self.step), len(other.step)):
            return f"edge {at} of {len(self.step)} and {len(other.step)} differs"
        if ((self.dir ^ other.dir) & self.rising()).any():
            return "DIR differs at a step"
        return ""

    def rising(self) -> np.ndarray:
        """For each row, a bit for each STEP pin with a rising edge."""
        levels = self.step[:, 1]
        return levels & ~np.concatenate([[0], levels[:-1]]).astype(np.int64)

    def pulses(self) -> int:
        """Number of steps of all axes."""
        return int(np.bitwise_count(self.rising()).sum())

    def steps(self, axis: int) -> tuple[np.ndarray, np.ndarray]:
        """Clocks and directions (1, -1) of the steps of an axis."""
        level = self.step[:, 1] >> axis & 1
        rows = np.flatnonzero(level & ~np.concatenate([[0], level[:-1]]) & 1)
        return self.step[rows, 0], 1 - 2 * (self.dir[rows] >> axis & 1)


def motions(events: np.ndarray, channel: int = 0, axes: int = AXES_MAX) -> list[Motion]:
    """All motions of a channel in the events (passo.engine.EVENT) of a core; the last must have ended.

    `axes` is the number of axes of each channel.
    """
    running = events["running"] >> channel & 1
    first, mask = np.uint64(channel * axes), np.uint64((1 << axes) - 1)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], running]).astype(np.int8)))
    starts, ends = edges[::2], edges[1::2]
    found = []
    for begin, end, stop in zip(starts, ends, [*starts[1:], len(events)], strict=False):
        part = events[begin:stop]
        levels = (part["step"].astype(np.uint64) >> first & mask).astype(np.int64)
        changed = np.flatnonzero(np.diff(np.concatenate([[0], levels])))
        start = int(events["clock"][begin])
        clocks = part["clock"][changed].astype(np.int64) - start
        found.append(
            Motion(
                start=start,
                clocks=int(events["clock"][end]) - start,
                step=np.stack([clocks, levels[changed]], axis=1),
                dir=(part["dir"][changed].astype(np.uint64) >> first & mask).astype(np.int64),
            )
        )
    return found


class Board(Machine):
    """The machine with the firmware, and a user at its console."""

    def __init__(
        self, core: CorePins | None, *, fast: bool = True, elf: Path | None = None, **options: object
    ):
        super().__init__(elf or firmware_elf(), core, **options)
        self.expect("help lists the commands\n", START)
        self.run(LATENCY)
        if isinstance(core, Engine) and not core.parameters.clock_hz:
            self.must(f"config clock_hz={core.clock_hz}")
        if fast:
            self.set_baud(FAST_BAUD)

    def ask(self, line: str, seconds: float = 1.0) -> str:
        """Type a line; return its answer, the line that starts with ok or error:."""
        since = len(self.output)
        self.type(line + "\r")
        self.run_until(lambda: self._answer(since), seconds)
        return self._answer(since)

    def _answer(self, since: int) -> str:
        if not self.output.endswith("\n"):
            return ""
        lines = self.output[since:].splitlines()
        return next((line for line in lines if line.startswith(ANSWERS)), "")

    def must(self, line: str, seconds: float = 1.0) -> str:
        """Type a line that must succeed; return its answer."""
        answer = self.ask(line, seconds)
        if not answer.startswith("ok"):
            raise AssertionError(f"{line!r} is answered with {answer!r}")
        return answer

    def set_baud(self, baud: int) -> None:
        """Change the baud rate of both ends, and check it with an empty line."""
        since = len(self.output)
        self.type(f"config baud={baud}\r")
        self.expect("ok", 1.0, since)
        self.run(0.002)
        self.baud = baud
        self.must("")

    def positions(self) -> list[int]:
        """The positions that the console reports."""
        answer = self.must("position")
        return [int(number) for number in answer.partition("position=")[2].split(",")]

    def wait_motion(self, seconds: float) -> None:
        """Run until a motion not yet returned by `events` has started and ended, with its last pulse."""
        end = self.seconds + seconds + LATENCY
        while not self._motion_ended():
            if self.seconds > end:
                raise TimeoutError(f"no motion within {seconds} s")
            self.run(LATENCY)
        self.run(LATENCY)

    def _motion_ended(self) -> bool:
        self._drain()
        events = self._events
        return bool(events) and not events[-1]["running"][-1] and any(e["running"].any() for e in events)
