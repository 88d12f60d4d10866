# SPDX-License-Identifier: MIT
"""The core that a program drives: simulated in this process, or at a device of Linux."""

from contextlib import ExitStack
from typing import Protocol

from passo.build import Parameters
from passo.driver import Driver
from passo.failure import Failure
from passo.grbl_setup import machine_at
from passo.host_loop import HostLoop, Steps
from passo.link import error_name
from passo.machine_file import MachineFile
from passo.native import ffi, planner
from passo.part import LOOPS_PER_SECOND

SIMULATED = ("model", "rtl", "both")


class Core(Protocol):
    """What a Machine needs of its core."""

    parameters: Parameters

    @property
    def driver(self) -> Driver:
        """Of its channel, open."""

    def begin(self) -> None:
        """A motion begins."""

    def turn(self) -> float:
        """Poll the driver; return the seconds until the next poll is due, 0 in simulated time."""

    def steps(self, motors: int) -> Steps | None:
        """The steps since `begin`; None: nobody sees the pins."""

    @property
    def matched_edges(self) -> int | None:
        """Edges on which RTL and model agree so far; None: nothing is compared."""

    def close(self) -> None:
        """Let it go."""


class SimulatedCore:
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
        self.c, self.host = ffi().new("struct passo *"), ffi().new("struct passo_host *")
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


class LinuxCore:
    """A core at a device of Linux: "/dev/spidev0.0", or "unix:/tmp/passo" of `passo serve`."""

    def __init__(self, device: str, file: MachineFile, speed_hz: int = 0):
        self.driver = LinuxDriver(device, len(file.motors), file.clock_hz, speed_hz)
        machine = self.driver.c.machine
        self.parameters = Parameters(axes=machine.axes, tick_log2=machine.tick_log2)
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
    return SimulatedCore(on, file) if on in SIMULATED else LinuxCore(on, file, speed_hz)
