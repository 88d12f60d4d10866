# SPDX-License-Identifier: MIT
"""`passo check`: the first power-on of a machine, at a serial port or simulated.

Each switch is pressed once by hand and must be the only one that answers; each output blinks; each motor
makes steps to and fro, one at a time. Nothing else moves; the power of spindle or laser stays 0.
"""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple, Protocol

from passo_fpga.boards import board
from passo_fpga.generate import generate

from passo.failure import Failure
from passo.gcode import place_of
from passo.grbl import Grbl
from passo.grbl_setup import core_for
from passo.machine_file import MachineFile, read_machine
from passo.make_command import core_of, wired
from passo.run import open_engine
from passo.serial_port import RESET, Conversation, Line, SerialPort

GREETING = 3.0  # seconds after a reset
PRESSED = 60.0  # seconds that a person has for a switch
FEED = 60  # mm/min of a step
RESOLUTION = 0.0011  # mm, of two positions in status reports
REVERSE = "M4 S0"  # a laser has proportional power instead
BLINKS = (
    ("spindle on", "M3 S0", "M5"),
    ("spindle reverse", REVERSE, "M5"),
    ("flood", "M8", "M9"),
    ("mist", "M7", "M9"),
)
BLINK_COUNT, BLINK = 3, 0.3  # seconds


class Input(NamedTuple):
    """A wired input: its pin of the core, bits of it, its name, and its letter in a status report."""

    pin: str
    bits: int
    name: str
    letter: str


class Port(Line, Protocol):
    """A serial line to the firmware, and a hand at the switches."""

    def press(self, pressed: Input, active: bool) -> None:
        """Press or release an input, if that is not up to a person."""


class SimulatedPort:
    """The firmware's protocol on a simulated core, and a hand at its switches."""

    real_time = False

    def __init__(self, engine: Any, machine: MachineFile):
        self.engine, self._machine, self._levels, self._said = engine, machine, {}, []
        for port in all_inputs(machine):
            self.press(port, False)
        self._grbl = Grbl(engine, machine, self._said.append)

    def write(self, data: bytes) -> None:
        """Send bytes."""
        self._grbl.type(data)

    def read(self, seconds: float) -> str:
        """Let this time pass; return what was received."""
        self._grbl.wait(lambda: False, seconds)
        said = "".join(self._said)
        self._said.clear()
        return said

    def close(self) -> None:
        """The engine is the caller's."""

    def press(self, pressed: Input, active: bool) -> None:
        """Change the level of its pin."""
        low_is_active = pressed.pin == "estop_n" or (
            pressed.pin != "probe" and self._machine.switches.inverted
        )
        level = active != low_is_active
        bits = self._levels.get(pressed.pin, 0) & ~pressed.bits | level * pressed.bits
        self._levels[pressed.pin] = bits
        self.engine.set(pressed.pin, bits)


def build_of(machine: MachineFile) -> int:
    """Identifier of the bitstream that `passo make` makes of a file; 0: it has no board."""
    if not machine.board:
        return 0
    chosen = board(machine.board)
    with TemporaryDirectory() as folder:
        design, _ = generate(chosen, Path(folder), *core_of(machine), more=wired(machine, chosen))
    return int(design.parameters["BUILD"])


def all_inputs(machine: MachineFile) -> list[Input]:
    """The inputs that are wired."""
    if not machine.has_inputs:
        return []
    names = {
        "home": "home switch",
        "limit_low": "limit at the low end",
        "limit_high": "limit at the high end",
    }
    found = [
        Input(
            switch,
            machine.bits(switch, axis),
            f"{machine.letters[axis]}: {names[switch]}",
            machine.letters[axis],
        )
        for axis, end in enumerate(machine.ends)
        for switch in dict.fromkeys(end.switches)
    ]
    probe = [Input("probe", 1, "probe", "P")] if machine.switches.probe else []
    return [*found, *probe, Input("estop_n", 1, "e-stop", "R")]


class _Check(Conversation):
    """Raises Failure with the first thing that is wrong."""

    def __init__(self, machine: MachineFile, port: Port, tell: Callable[[str], None]):
        super().__init__(port)
        self.machine, self.port, self.tell = machine, port, tell

    def active(self) -> set[str]:
        """Letters of the active inputs."""
        return set(self.report().get("Pn", ""))

    def reset(self) -> None:
        """Reset the protocol and unlock it."""
        self.port.write(RESET)
        self.port.read(GREETING)
        self.line("$X")

    def core(self) -> None:
        """The core must be that of the file."""
        found = re.search(r"\[CORE:([^:\]]*):(\d+):(\d+)\]", self.line("$I"))
        if not found:
            raise Failure("the firmware has no core: check the SPI wires and the bitstream")
        self.tell(f"core {found[1]}, {int(found[2]) / 1e6:g} MHz, build {found[3]}")
        if int(found[2]) != self.machine.clock_hz:
            raise Failure(f"the core runs at {found[2]} Hz, the machine file has {self.machine.clock_hz}")
        build, wanted = int(found[3]), build_of(self.machine) if int(found[3]) else 0
        if build != wanted:
            raise Failure(f"the bitstream is build {build}, that of the machine file {wanted}: load that one")

    def inputs(self) -> None:
        """Each input in turn."""
        wired = all_inputs(self.machine)
        if found := self.active():
            names = ", ".join(port.name for port in wired if port.letter in found)
            raise Failure(f"active at rest: {names or found}; check the contact and `inverted` in [switches]")
        for port in wired:
            self.tell(f"press {port.name}")
            self.port.press(port, True)
            self._until({port.letter}, port)
            self.tell("  release it")
            self.port.press(port, False)
            self._until(set(), port)

    def _until(self, wanted: set[str], port: Input) -> None:
        for _ in range(round(PRESSED / self.LOOK)):
            found = self.active()
            if found == wanted:
                return
            if others := found - {port.letter}:
                raise Failure(f"{port.name}: {', '.join(sorted(others))} answers instead; check the wires")
        raise Failure(f"{port.name} does not answer; check its wires")

    def outputs(self) -> None:
        """Each output blinks; they change when a motion begins: a step of the first motor, forth and back."""
        if "outputs" not in self.machine.parts:
            return
        step = 1 / float(self.machine.settings.axes[0].steps_per_mm)
        for name, on, off in BLINKS:
            if self.machine.laser and on == REVERSE:
                continue
            self.tell(f"blinking: {name}")
            for _ in range(BLINK_COUNT):
                for line, way in ((on, step), (off, -step)):
                    self.line(f"{line} G91 G1 {self.machine.letters[0]}{way:.6f} F{FEED}")
                    self.port.read(BLINK)
        self._rest()

    def motors(self) -> None:
        """One step of each motor, and back."""
        for axis, limits in enumerate(self.machine.settings.axes):
            letter, step = self.machine.letters[axis], 1 / float(limits.steps_per_mm)
            for sign, way in ((1, "forth"), (-1, "back")):
                self.tell(f"one step of {letter}, {way}")
                before = self._position(axis)
                self.line(f"$J=G91 {letter}{sign * step:.6f} F{FEED}")
                self._rest()
                made = self._position(axis) - before
                if abs(made - sign * step) > RESOLUTION:
                    raise Failure(f"{letter} moved by {made:.3f} mm, not by {sign * step:.4f}")

    def _rest(self) -> None:
        for _ in range(round(self.ANSWER / self.LOOK)):
            if self.report()["state"] == "Idle":
                return
        raise Failure("the motor does not come to rest")

    def _position(self, axis: int) -> float:
        return place_of(self.report()["MPos"], self.machine.letters)[axis]


def check(machine: MachineFile, port: Port, tell: Callable[[str], None] = print) -> None:
    """Check a machine; raises Failure with the first thing that is wrong."""
    conversation = _Check(machine, port, tell)
    conversation.reset()
    conversation.core()
    conversation.inputs()
    conversation.reset()
    conversation.outputs()
    conversation.motors()
    tell("all inputs, outputs and motors answer")


@contextmanager
def simulated(machine: MachineFile) -> Iterator[SimulatedPort]:
    """The machine on the C model."""
    with open_engine("model", core_for(machine), machine.clock_hz) as engine:
        yield SimulatedPort(engine, machine)


def check_machine(path: Path, port: Path | None) -> None:
    """Check the machine of a file at a serial port; without one, a simulated one."""
    machine = read_machine(path, takes_up=True)
    with SerialPort(port) if port else simulated(machine) as connected:
        check(machine, connected)
