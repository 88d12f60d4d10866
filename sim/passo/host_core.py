# SPDX-License-Identifier: MIT
"""The core that a program drives: simulated in this process, at a device of Linux, or behind an STM32F103."""

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from passo.build import Parameters
from passo.driver import Driver, DriverError, Source
from passo.failure import Failure
from passo.grbl_setup import machine_at
from passo.host_home import Homing, configure_inputs
from passo.host_loop import HostLoop, Steps
from passo.host_serial import SerialCore, is_serial
from passo.link import error_name
from passo.machine_file import MachineFile
from passo.native import ffi, planner, unopened
from passo.part import LOOPS_PER_SECOND, configure
from passo.serial_port import SerialPort
from passo.timed import TimedPoints

SIMULATED = ("model", "rtl", "both")
STOP_POLLS = 100_000  # until a soft stop has ended, at most

Array = np.ndarray[Any, np.dtype[Any]]
Planned = tuple[Sequence[Any], Sequence[Any]]  # struct passo_line, struct passo_ramp


class Core(Protocol):
    """What a Machine needs of its core."""

    parameters: Parameters

    def configure(self, file: MachineFile) -> None:
        """Set it up for a machine. Raises BadInputError, DriverError."""

    def positions(self) -> Array:
        """Of the motors, in steps."""

    @property
    def is_moving(self) -> bool:
        """Whether what was begun has not ended yet."""

    def path(self, planned: Planned, places: Array, speed: float | None) -> None:
        """Begin a path through places (point x axis, mm), planned here."""

    def follow(self, points: TimedPoints) -> None:
        """Begin timed points."""

    def home(self, homing: Homing, axes: str) -> None:
        """Begin to home the axes; empty: all."""

    def call(self, name: str, *arguments: int) -> None:
        """hold, resume, override, stop, clear."""

    def halt(self) -> None:
        """Bring all to rest, whatever runs, and clear it; nothing if it has stopped for another cause."""

    def begin(self) -> None:
        """A motion begins."""

    def turn(self) -> float:
        """Go on; return the seconds until the next turn is due, 0 in simulated time."""

    def steps(self, motors: int) -> Steps | None:
        """The steps since `begin`; None: nobody sees the pins."""

    @property
    def matched_edges(self) -> int | None:
        """Edges on which RTL and model agree so far; None: nothing is compared."""

    def close(self) -> None:
        """Let it go."""


class DriverCore:
    """What the driver does."""

    driver: Driver
    _motors: int

    def configure(self, file: MachineFile) -> None:
        """Pins, switches and drives."""
        self._motors = len(file.motors)
        configure(self.driver, file, enable_inverted=file.enable_inverted)
        if file.has_inputs:
            configure_inputs(self.driver, file)

    def positions(self) -> Array:
        """Of the motors, in steps."""
        return np.array(self.driver.positions()[: self._motors])

    @property
    def is_moving(self) -> bool:
        """As of the last turn."""
        return self.driver.is_moving

    def path(self, planned: Planned, places: Array, speed: float | None) -> None:
        """Stream it."""
        self.driver.stream(Source(*planned))

    def follow(self, points: TimedPoints) -> None:
        """Begin timed points."""
        points.start(self.driver)

    def home(self, homing: Homing, axes: str) -> None:
        """Begin to home."""
        homing.start(self.driver)

    def call(self, name: str, *arguments: int) -> None:
        """Of the driver."""
        self.driver.call(name, *arguments)

    def turn(self) -> float:
        """Poll the driver."""
        raise NotImplementedError

    def halt(self) -> None:
        """Bring all to rest, whatever runs, and clear it; nothing if it has stopped for another cause."""
        driver = self.driver
        if driver.fault != "OK" or not driver.is_moving:
            return
        driver.attempt("stop")
        for _ in range(STOP_POLLS):
            try:
                self.turn()
            except DriverError:
                break
            if not driver.is_moving:
                break
        driver.attempt("clear")


class SimulatedCore(DriverCore):
    """An engine with the machine at its pins; time passes only in `turn`."""

    def __init__(self, name: str, file: MachineFile):
        self._stack = ExitStack()
        self._engine = self._stack.enter_context(machine_at(name, file))
        self._period = file.clock_hz // LOOPS_PER_SECOND
        self.parameters: Parameters = self._engine.parameters
        self.driver: Driver = Driver(self._engine, file.clock_hz, self.parameters)
        self.begin()

    def begin(self) -> None:
        """A motion begins."""
        self._loop = HostLoop(self._engine, self._period)

    def turn(self) -> float:
        """Poll the driver, and let time pass."""
        self._loop.turn(self.driver.poll)
        return 0.0

    def steps(self, motors: int) -> Steps:
        """The steps since `begin`."""
        return self._loop.steps(motors)

    @property
    def matched_edges(self) -> int | None:
        """Edges on which RTL and model agree so far."""
        return getattr(self._engine, "matched_edges", None)

    def close(self) -> None:
        """Free the engine."""
        self._stack.close()


class LinuxDriver(Driver):
    """A driver that passo_open_linux() opens, without Python between it and the wires."""

    def __init__(self, device: str, axes: int, clock_hz: int, speed_hz: int = 0):
        """Raises Failure with one sentence that says what to do."""
        self.lib = planner()
        self._name = ffi().new("char[]", device.encode())
        self._linux = ffi().new("struct passo_linux *")
        self.c, self.host = unopened("passo"), unopened("passo_host")
        self.hardware, self.clock_hz = _NoHardware(), clock_hz
        self._device = ffi().new(
            "struct passo_linux_options *", {"device": self._name, "axes": axes, "speed_hz": speed_hz}
        )
        self.options = ffi().new("struct passo_options *", {"clock_hz": clock_hz})
        self.open()

    def open(self) -> None:
        """Open the device and the channel."""
        arguments = (self.c, self.host, self._linux, self._device, self.options)
        if error := self.lib.passo_open_linux(*arguments):
            raise OpenError(error, ffi().string(self._linux.problem).decode())

    def close(self) -> None:
        """Close the device."""
        self.lib.passo_close_linux(self._linux)


class OpenError(Failure):
    """The device cannot be opened; `name` is the name of the error, such as "STUCK_LOW"."""

    def __init__(self, error: int, problem: str):
        self.name = error_name(error)
        super().__init__(problem)


class _NoHardware:
    """In place of passo.link.Hardware: no callback of Python could have failed."""

    def check(self) -> None:
        """Nothing."""


class LinuxCore(DriverCore):
    """A core at a device of Linux: "/dev/spidev0.0", or "unix:/tmp/passo" of `passo serve`."""

    def __init__(self, device: str, file: MachineFile, speed_hz: int = 0):
        self.driver = LinuxDriver(device, len(file.motors), file.clock_hz, speed_hz)
        machine = self.driver.c.machine
        self.parameters = Parameters(axes=self.driver.c.axes, tick_log2=machine.tick_log2)
        self.matched_edges: int | None = None

    def begin(self) -> None:
        """A motion begins."""

    def turn(self) -> float:
        """Poll the driver; while nothing is due, wait as its `wait` function does."""
        self.driver.poll()
        if self.driver._linux.served and not self.driver._linux.real_time:
            self.driver.host.hardware.wait(self.driver._linux, max(self.driver.idle_microseconds, 1))
            return 0.0
        return self.driver.idle_microseconds / 1e6

    def steps(self, motors: int) -> None:
        """Nobody sees the pins."""

    def close(self) -> None:
        """Close the device."""
        self.driver.close()


def open_core(on: str, file: MachineFile, speed_hz: int) -> Core:
    """A simulated core of this name, or the one at this device. Raises Failure, DriverError."""
    if on in SIMULATED:
        return SimulatedCore(on, file)
    return SerialCore(SerialPort(Path(on)), file) if is_serial(on) else LinuxCore(on, file, speed_hz)
