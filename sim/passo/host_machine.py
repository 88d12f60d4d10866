# SPDX-License-Identifier: MIT
"""A machine for Python programs: plan a motion, look at it, run it, on a simulation or on a real core.

    from passo import Machine

    with Machine.from_file("router.toml") as machine:
        motion = machine.move(X=120, Y=40)
        print(motion.seconds)
        print(motion.run().end)

Lengths are in mm, of rotary axes in degrees, times in s, speeds in mm/s. Axes are named by the letters of the
machine file. A motion is planned from where the machine is then, and all limits are checked, before anything
moves.
"""

from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from passo.course import Course
from passo.failure import BadInputError, Failure
from passo.host_core import Core, open_core
from passo.host_home import Homing
from passo.machine_file import MachineFile, read_machine
from passo.motion import Array, Motion, PlannedMotion
from passo.path import Path as PathPlanner
from passo.plan import PlanError
from passo.preview import LINE, RAMP, Planned
from passo.timed import MM_MAX, SECONDS_MAX, TimedPoints, spline

LOOK_AHEAD_MIN = 4
SPLINE_PERIOD = 0.002  # s
PERCENT = 100


class Machine:
    """The axes of a machine file, and the core that moves them. Close it, or use it in a `with` statement.

    Methods raise BadInputError if what is asked for cannot be, DriverError if a call of the driver fails.
    """

    def __init__(self, file: MachineFile, core: Core):
        """Normally `from_file` makes it."""
        self.file, self.core = file, core
        self.is_closed = False
        self.clock_hz = file.clock_hz
        self.letters = file.letters  # of the axes
        self.motors = file.motors  # names, in the order of the core
        core.configure(file)
        self._settings = file.settings.struct(core.parameters)

    @classmethod
    def from_file(cls, path: str | Path, on: str = "model", speed_hz: int = 0) -> Self:
        """The machine of a file (docs/gcode.md), on a core.

        `on` is a simulation in this process: "model"; "rtl", the Verilated core; "both", compared edge by
        edge; or a device: "/dev/spidev0.0", "unix:/tmp/passo" of `passo serve`, or "/dev/ttyUSB0", the grbl
        image of an STM32F103. `speed_hz`: of SCLK at a device; 0: 4 MHz. Raises BadInputError, and OpenError
        with one sentence that says what to do.
        """
        file = read_machine(Path(path))
        core = open_core(on, file, speed_hz)
        try:
            return cls(file, core)
        except BaseException:
            core.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Let the core go; at a device it keeps what it has. A motion that is awaited comes to rest first."""
        if not self.is_closed:
            self.halt()
            self.is_closed = True
            self.core.close()

    @property
    def position(self) -> dict[str, float]:
        """Where the axes are now, in mm."""
        return dict(zip(self.letters, self.axes_of(self.steps()[None])[0].tolist(), strict=True))

    def steps(self) -> Array:
        """Where the motors are now, in steps."""
        return self.core.positions()

    def axes_of(self, steps: Array) -> Array:
        """Positions of the axes, in mm, of those of the motors, in steps; the last dimension is which one."""
        found: Array = self.file.settings.motors.axes_of(steps / np.array(self.file.settings.scales))
        return found

    def move(self, speed: float | None = None, **axes: float) -> PlannedMotion:
        """Straight to a place: `move(X=40, Y=20)`; other axes stay.

        `speed`: along the line, in mm/s; None: as fast as the axes can.
        """
        target = list(self.position.values())
        for name, place in axes.items():
            if name.upper() not in self.letters:
                raise BadInputError(f"there is no axis {name}: axes are {', '.join(self.letters)}")
            target[self.letters.index(name.upper())] = place
        return self.path([target], speed)

    def path(self, points: Sequence[Sequence[float]] | Array, speed: float | None = None) -> PlannedMotion:
        """Along straight lines through points (point x axis, in mm), without a stop.

        Corners are rounded only in time: the speed there is what junction deviation and jump of the machine
        file allow. `speed`: along the lines, in mm/s; None: as fast as the axes can.
        """
        places = self._places(points)
        begin = self.steps()
        path = PathPlanner(self.file.settings, self.core.parameters, max(LOOK_AHEAD_MIN, len(places) + 1))
        path.restart(begin.tolist())
        for number, place in enumerate(places):
            try:
                path.add(place.tolist(), speed)
            except PlanError as error:
                raise BadInputError(f"point {number}: {error}") from None
        path.end()
        lines, ramps = [], []
        while (line := path.next_line()) is not None:
            lines.append(line)
        while (ramp := path.next_ramp()) is not None:
            ramps.append(ramp)
        planned = _planned(self, lines, ramps, path.substeps_per_mm)
        course = Course(planned, self.axes_of(begin[None])[0])

        def start() -> None:
            if lines:
                self.core.path((lines, ramps), places, speed)

        return PlannedMotion(self, start, begin, course.seconds, course.places, course)

    def follow(
        self,
        times: Sequence[float] | Array,
        positions: Sequence[Sequence[float]] | Array,
        smooth: bool = False,
    ) -> PlannedMotion:
        """Through positions (point x axis, in mm) at times, in s from the start, each to two clocks.

        Between two points all axes have constant speeds; the change of speed at a point must be within what
        acceleration, jump and junction deviation of the axes allow (c_model/planner/passo_timed.h). `smooth`
        puts points on the cubic spline between those given, 2 ms apart, at rest at both ends. A first point
        at time 0 must be where the machine is. BadInputError names the first point that cannot be made.
        """
        places, begin = self._places(positions), self.steps()
        at = np.asarray(times, float)
        if at.shape != (len(places),):
            raise BadInputError(f"there are {at.size} times for {len(places)} positions")
        here = self.axes_of(begin[None])[0]
        if not np.all(np.isfinite(at) & (at >= 0) & (at < SECONDS_MAX)):
            raise BadInputError(f"times must be numbers from 0 on, below {SECONDS_MAX:g} s")
        first = int(at[0] == 0)
        if first and np.any(np.abs(places[0] - here) * self._scales > 0.5):
            raise BadInputError(f"point 0: at time 0 the machine is at {here.tolist()}, in mm")
        knots, ways = np.concatenate([[0.0], at[first:]]), np.vstack([here, places[first:]])
        if len(late := np.flatnonzero(np.diff(knots) <= 0)):
            raise BadInputError(f"point {late[0] + first}: its time must be above that of the point before")
        if len(knots) == 1:
            raise BadInputError("there is no point after time 0")
        if smooth:
            made, fine, leads = spline(knots, ways, SPLINE_PERIOD)
        else:
            made, fine, leads = knots[1:], ways[1:], np.arange(1, len(knots))
        numbers = (leads - 1 + first).tolist()
        points = TimedPoints(self.file, self._settings, begin.tolist(), made, fine, numbers)
        whole, course = np.concatenate([[0.0], made]), np.vstack([here, fine])

        def positions_at(asked: Array) -> Array:
            return np.stack([np.interp(asked, whole, column) for column in course.T], axis=1)

        return PlannedMotion(self, lambda: self.core.follow(points), begin, float(whole[-1]), positions_at)

    def home(self, axes: str = "") -> Motion:
        """Home these axes, or all that have a home, Z first: at low ends 0, at high ends the travel."""
        homing = Homing(self.file, axes.upper())
        return Motion(self, lambda: self.core.home(homing, axes), self.steps())

    def hold(self) -> None:
        """Feed hold."""
        self.core.call("hold")

    def resume(self) -> None:
        """Go on after `hold`."""
        self.core.call("resume")

    def override(self, percent: int) -> None:
        """Of all speeds, 1 to 100."""
        self.core.call("override", percent)

    def stop(self) -> None:
        """Soft stop; what runs raises DriverError or ends, then `clear`."""
        self.core.call("stop")

    def clear(self) -> None:
        """After a stop of any cause: accept motions again."""
        self.core.call("clear")

    def require(self, begin: Array) -> None:
        """Raises Failure unless the machine is open, at rest, and the motors are there."""
        if self.is_closed:
            raise Failure("the machine is closed")
        if self.core.is_moving:
            raise Failure("another motion is not over yet")
        if (now := self.steps()).tolist() != begin.tolist():
            raise Failure(f"planned from {begin.tolist()}, but the motors are at {now.tolist()}: plan again")

    def halt(self) -> None:
        """Bring all to rest, whatever runs, and clear it; nothing if it has stopped for another cause."""
        if not self.is_closed:
            self.core.halt()

    @property
    def _scales(self) -> Array:
        return np.array([float(axis.steps_per_mm) for axis in self.file.settings.axes])

    def _places(self, points: Sequence[Sequence[float]] | Array) -> Array:
        places = np.asarray(points, float)
        if places.ndim != 2 or places.shape[1] != len(self.letters) or not len(places):
            axes = ", ".join(self.letters)
            raise BadInputError(f"points must be rows of {len(self.letters)} numbers: {axes}")
        if not np.all(np.abs(places) < MM_MAX):
            raise BadInputError(f"positions must be numbers, less than {MM_MAX:,.0f} mm from 0")
        return places


def _planned(machine: Machine, lines: list[Any], ramps: list[Any], substeps_per_mm: int) -> Planned:
    """What Course needs."""
    ways, profile = np.zeros(len(lines), LINE), np.zeros(len(ramps), RAMP)
    for way, line in zip(ways, lines, strict=True):
        signs = [-1 if line.directions >> motor & 1 else 1 for motor in range(8)]
        way["steps"] = [sign * line.steps[motor] for motor, sign in enumerate(signs)]
        way["substeps"] = line.substeps
    for row, ramp in zip(profile, ramps, strict=True):
        row["velocity"], row["ticks"] = ramp.velocity_end, ramp.ticks
        row["shape"], row["last"] = ramp.shape, ramp.last
    core = machine.core.parameters
    return Planned(machine.file, core, ways, profile, [], substeps_per_mm, len(lines), True, False)
