# SPDX-License-Identifier: MIT
"""The core behind an STM32F103 with the grbl image, at a serial port: the firmware plans, from G-code."""

import re
from collections import deque
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from passo.failure import BadInputError, Failure
from passo.gcode import place_of
from passo.grbl_setup import core_for
from passo.host_home import Homing
from passo.machine_file import MachineFile
from passo.serial_port import REPORT, Conversation, Line
from passo.timed import TimedPoints

ROOM = 120  # bytes that the firmware may have to read
PERIOD = 0.01  # s of a turn
REST = 10.0  # s in which a stop ends
HOLD, RESUME = b"!", b"~"
FULL, TEN, ONE = b"\x90", b"\x92", b"\x94"  # of the feed: 100 %, -10, -1
OVERRIDE_MIN = 10
SCALE_AT = 100  # first setting of the steps per mm
SAME = 1e-6  # of two scales, relative
SPIDEV = "spidev"


def is_serial(on: str) -> bool:
    """Whether a device is a serial port: by its name, or because it is no other one."""
    path = Path(on)
    named = path.name.startswith("tty") or "serial" in path.parts
    return named or (path.is_char_device() and not path.resolve().name.startswith(SPIDEV))


class Stopped(Failure):
    """By `stop`."""


class SerialCore(Conversation):
    """What a Machine needs of its core. Raises Failure for what the firmware refuses."""

    matched_edges: int | None = None

    def __init__(self, port: Line, file: MachineFile):
        super().__init__(port)
        self.parameters = core_for(file)
        self._file = file
        # the firmware has 0 at the high end
        self._ends = np.array([end.travel if end.home else 0.0 for end in file.ends])
        self._lines: deque[bytes] = deque()
        self._owed: deque[bytes] = deque()  # lines that have no answer yet
        self._said = ""
        self._place: list[float] = []  # of the last report
        self._asked = self._moves = self._stops = False

    def configure(self, file: MachineFile) -> None:
        """Nothing is set: the firmware must have the clock and the scales of the machine file."""
        self.port.write(b"\n")
        self.port.read(self.LOOK)
        state = self.report()["state"]
        if state.partition(":")[0] not in ("Idle", "Alarm"):
            raise Failure(f"the machine is in {state}: end what it does, or reset it")
        found = re.search(r"\[CORE:[^:\]]*:(\d+):", self.line("$I"))
        if not found:
            raise Failure("the firmware has no core: check the SPI wires and the bitstream")
        if int(found[1]) != file.clock_hz:
            raise BadInputError(f"the core runs at {found[1]} Hz, {file.path} has {file.clock_hz}")
        settings = dict(re.findall(r"\$(\d+)=([\d.]+)", self.line("$$")))
        for number, axis in enumerate(file.settings.axes, SCALE_AT):
            value, wanted = float(settings.get(str(number), 0)), float(axis.steps_per_mm)
            if abs(value - wanted) > SAME * wanted:
                raise BadInputError(
                    f"the firmware has ${number}={value:g}, {file.path} {wanted:g}: "
                    "send it the settings.txt of `passo make`"
                )

    def positions(self) -> np.ndarray[Any, np.dtype[Any]]:
        """Of the motors, in steps, to 0.001 mm; while something moves as of the last turn."""
        if not self._moves or not self._place:
            self._see(self.report())
        motors = self._file.settings.motors.map(len(self._ends)) @ (np.array(self._place) + self._ends)
        return np.rint(motors * np.array(self._file.settings.scales)).astype(int)

    @property
    def is_moving(self) -> bool:
        """As of the last turn."""
        return self._moves

    def path(self, planned: object, places: np.ndarray[Any, np.dtype[Any]], speed: float | None) -> None:
        """Send it; the firmware plans it with its own look-ahead."""
        fastest = sum(float(axis.speed) for axis in self._file.settings.axes)
        feed = 60 * (fastest if speed is None else speed)
        lines = ["G21 G90 G94"]
        for place in places - self._ends:
            words = (f"{letter}{value:.6f}" for letter, value in zip(self._file.letters, place, strict=True))
            lines.append(f"G53 G1 {' '.join(words)} F{feed:.3f}")
        self._start(lines)

    def follow(self, points: TimedPoints) -> None:
        """Raises BadInputError."""
        raise BadInputError("the firmware has no timed points: wire the core to this computer's SPI")

    def home(self, homing: Homing, axes: str) -> None:
        """All axes; raises BadInputError for some of them."""
        homed = {letter for letter, end in zip(self._file.letters, self._file.ends, strict=True) if end.home}
        if axes and set(axes.upper()) != homed:
            raise BadInputError(f"the firmware homes {', '.join(sorted(homed))} together: home()")
        self._start(["$H"])

    def call(self, name: str, *arguments: int) -> None:
        """hold, resume, override, stop, clear."""
        if name == "override":
            (percent,) = arguments
            if not OVERRIDE_MIN <= percent <= 100:
                raise BadInputError(f"override is {percent}: the firmware takes {OVERRIDE_MIN} to 100")
            tens, ones = divmod(100 - percent, 10)
            self.port.write(FULL + tens * TEN + ones * ONE)
        elif name == "clear":
            self.line("$X")
        else:
            self._stops = self._stops or name == "stop"
            self.port.write(RESUME if name == "resume" else HOLD)

    def halt(self) -> None:
        """Bring all to rest, whatever runs, and clear it; nothing if it has stopped for another cause."""
        if not self._moves:
            return
        self.call("stop")
        try:
            for _ in range(round(REST / PERIOD)):
                self.port.read(self.turn())
        except Stopped:
            self.call("clear")
        except Failure:
            pass
        self._moves = self._stops = False

    def begin(self) -> None:
        """A motion begins."""
        self._stops = False

    def turn(self) -> float:
        """Read, and send what there is room for."""
        self._said += self.port.read(0.0 if self.port.real_time else PERIOD)
        *said, self._said = self._said.split("\n")
        for line in said:
            self._hear(line.strip())
        while self._lines and sum(map(len, self._owed)) + len(self._lines[0]) <= ROOM:
            self.port.write(self._lines[0])
            self._owed.append(self._lines.popleft())
        if not self._asked and self._moves:
            self.port.write(REPORT)
            self._asked = True
        return PERIOD if self.port.real_time else 0.0

    def steps(self, motors: int) -> None:
        """Nobody sees the pins."""

    def close(self) -> None:
        """Let the port go."""
        self.port.close()

    def _start(self, lines: Sequence[str]) -> None:
        self._lines.extend(f"{line}\n".encode() for line in lines)
        self._moves, self._asked = True, False

    def _hear(self, line: str) -> None:
        if line.startswith("<"):
            self._see(self.fields(line))
        elif line == "ok" and self._owed:
            self._owed.popleft()
            self._asked = False  # what was asked before it does not count
        elif line.startswith(("error:", "ALARM:")):
            text = self._owed.popleft().decode().strip() if self._owed else "the motion"
            self._lines.clear()
            self._owed.clear()  # their answers are not heard
            self._moves = self._is_moving(self.report()["state"])
            raise Failure(f"{text}: {line} (docs/gcode.md)")

    @staticmethod
    def _is_moving(state: str) -> bool:
        return state.partition(":")[0] in ("Run", "Hold", "Home", "Jog")

    def _see(self, report: dict[str, str]) -> None:
        self._asked = False
        if "MPos" not in report:
            raise Failure("status reports have no MPos: set $10=1")
        self._place = place_of(report["MPos"], self._file.letters)
        state = report["state"]
        if self._stops and state.startswith("Hold:0"):
            self._lines.clear()
            self._owed.clear()
            self._moves = self._stops = False
            self.restart()
            raise Stopped("stopped")
        if state == "Idle" and not self._lines and not self._owed:
            self._moves = False
