# SPDX-License-Identifier: MIT
"""Python binding of the path planner (c_model/planner/passo_path.h)."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from passo.build import Parameters
from passo.driver import Driver, DriverError
from passo.moves import q32
from passo.native import ffi, planner, unopened
from passo.part_options import LOOK_AHEAD as LOOK_AHEAD
from passo.plan import PlanError

NOT_MOVING = 0xFFFFFFFF  # ticks held by a core that does not move yet
OVERRIDE_ONE = 1 << 16


@dataclass(frozen=True)
class PathAxis:
    """Limits of an axis in millimeters and seconds; see struct passo_path_axis."""

    steps_per_mm: Fraction | float = 80
    speed: Fraction | float = 200
    acceleration: Fraction | float = 1000
    jump: Fraction | float = 0
    jerk: Fraction | float = 0  # for profile jerk


@dataclass(frozen=True)
class Motors:
    """Which axes each motor moves; see passo_motors.h. `mixed`: limits of each motor that moves two."""

    rows: tuple[tuple[int, ...], ...] = ()  # motor x axis: -1, 0, 1; none: a motor for each axis
    mixed: PathAxis = PathAxis(0, 0, 0)  # 0: the larger one of the two axes

    def map(self, axes: int) -> np.ndarray:
        """Motor x axis."""
        return np.array(self.rows or np.eye(axes, dtype=int))

    def mixed_of(self, axes: int) -> np.ndarray:
        """Of each motor, whether it moves two axes."""
        return np.abs(self.map(axes)).sum(axis=1) > 1

    def bits(self, sign: int) -> list[int]:
        """Of each motor the axes, a bit each, that it moves with this sign."""
        return [sum((part == sign) << axis for axis, part in enumerate(row)) for row in self.rows]

    def axes_of(self, motors: np.ndarray) -> np.ndarray:
        """Places of the axes, from a column per motor."""
        if not self.rows:
            return motors
        rows = np.array(self.rows)
        return motors @ rows / np.abs(rows).sum(axis=0)


@dataclass(frozen=True)
class PathSettings:
    """The machine that a path is planned for; see struct passo_path_settings."""

    axes: tuple[PathAxis, ...] = (PathAxis(), PathAxis(), PathAxis())
    clock_hz: int = 64_000_000
    acceleration: Fraction | float = 0  # along the path; 0: only those of the axes
    junction_deviation: Fraction | float = 0.01
    tolerance: Fraction | float | None = None  # of merged lines; None: a twentieth of that; 0: none are
    profile: str = "linear"
    reserve_clocks: int = 0
    polls: int = 0  # of the feed in a second, at least; 0: 500
    unrounded: bool = False  # no constant speed around lone corners
    motors: Motors = Motors()

    @property
    def scales(self) -> list[float]:
        """Steps per mm of each motor."""
        own = [float(axis.steps_per_mm) for axis in self.axes]
        return [own[int(np.flatnonzero(row)[0])] for row in self.motors.map(len(own))]

    def limits(self) -> list[tuple[np.ndarray, PathAxis]]:
        """Directions of length 1 that have limits, and these: axes, then motors that move two of them."""
        count = len(self.axes)
        found = list(zip(np.eye(count), self.axes, strict=True))
        for row in self.motors.map(count)[self.motors.mixed_of(count)]:
            size = float(np.linalg.norm(row))
            moved = [axis for axis, part in zip(self.axes, row, strict=True) if part]
            own = {
                name: float(
                    getattr(self.motors.mixed, name) or max(float(getattr(axis, name)) for axis in moved)
                )
                / size
                for name in ("speed", "acceleration", "jerk", "jump")
            }
            found.append((row / size, PathAxis(float(moved[0].steps_per_mm) * size, **own)))
        return found

    def struct(self, parameters: Parameters) -> Any:
        """The `struct passo_path_settings`."""
        names = ("steps_per_mm", "speed", "acceleration", "jerk", "jump")
        return ffi().new(
            "struct passo_path_settings *",
            {
                "machine": (self.clock_hz, parameters.tick_log2, len(self.axes)),
                "axis": [{name: q32(getattr(axis, name)) for name in names} for axis in self.axes],
                "acceleration": q32(self.acceleration),
                "junction_deviation": q32(self.junction_deviation),
                "tolerance": {None: 0, 0: (1 << 64) - 1}.get(self.tolerance, q32(self.tolerance or 0)),
                "profile": getattr(planner(), f"PASSO_PROFILE_{self.profile.upper()}"),
                "reserve_clocks": self.reserve_clocks,
                "polls": self.polls,
                "unrounded": self.unrounded,
                "motors": (len(self.motors.rows), self.motors.bits(1), self.motors.bits(-1)),
                "mixed": {name: q32(getattr(self.motors.mixed, name)) for name in names},
            },
        )


class Path:
    """A `struct passo_path_planner` that looks ahead a number of lines. Methods raise PlanError."""

    def __init__(self, settings: PathSettings, parameters: Parameters, look_ahead: int = LOOK_AHEAD):
        self.settings, self.parameters = settings, parameters
        self._c = planner()
        self.c = unopened("passo_path_planner")
        self._items = ffi().new("struct passo_path_item[]", look_ahead)
        wanted = settings.struct(parameters)
        self._check(self._c.passo_path_open(self.c, wanted, self._items, look_ahead))

    @property
    def room(self) -> int:
        """Lines that can be added at present."""
        return self._c.passo_path_room(self.c)

    @property
    def is_empty(self) -> bool:
        """Whether all lines have been handed out and passed by ramps."""
        return self._c.passo_path_is_empty(self.c)

    @property
    def substeps_per_mm(self) -> int:
        """Scale of the path."""
        return self.c.substeps_per_mm

    def add(self, target: Sequence[float], feed: float | None, output: int = 0) -> None:
        """Add a line to a target in mm at a feed in mm/s; None: as fast as the axes allow."""
        wanted = (1 << 64) - 1 if feed is None else q32(feed)
        move = ffi().new("struct passo_path_move *", ([q32(mm) for mm in target], wanted, output))
        self._check(self._c.passo_path_add(self.c, move))

    def dwell(self, seconds: float = 0) -> None:
        """Rest after the last line; 0: an exact stop."""
        self._c.passo_path_dwell(self.c, round(seconds * self.settings.clock_hz))

    def override(self, factor: float) -> None:
        """Scale the feeds of all lines that the ramps have not passed yet, from 1 on."""
        self._c.passo_path_override(self.c, round(factor * OVERRIDE_ONE))

    def end(self) -> None:
        """End the motion with the last line."""
        self._c.passo_path_end(self.c)

    def restart(self, positions: Sequence[int]) -> None:
        """Drop all lines and begin again at these positions, in steps."""
        self._c.passo_path_restart(self.c, ffi().new("int32_t[8]", list(positions)))

    def next_line(self) -> Any:
        """The next `struct passo_line`, or None."""
        line = ffi().new("struct passo_line *")
        return line[0] if self._c.passo_path_next_line(self.c, line) else None

    def next_ramp(self, held: int = NOT_MOVING) -> Any:
        """The next `struct passo_ramp`, or None."""
        ramp = ffi().new("struct passo_ramp *")
        return ramp[0] if self._c.passo_path_next_ramp(self.c, held, ramp) else None

    def next_motion(self) -> bool:
        """Go on after the last line and ramp of a motion."""
        return self._c.passo_path_next_motion(self.c)

    def _check(self, error: int) -> None:
        if error != self._c.PASSO_PLAN_OK:
            name, text = self._c.passo_plan_error_name(error), self._c.passo_plan_error_text(error)
            raise PlanError(ffi().string(name).decode(), ffi().string(text).decode())


class PathFeed:
    """A `struct passo_path_feed`: a path that is fed to a channel while its lines become known."""

    def __init__(self, driver: Driver, path: Path):
        self.driver, self.path = driver, path
        self._c = planner()
        self.c = unopened("passo_path_feed")
        self.open()

    def open(self) -> None:
        """Begin, or begin again after a stop."""
        self._c.passo_path_feed_open(self.c, self.driver.c, self.path.c)

    def poll(self) -> None:
        """At most one frame, two at the start of a motion; raises each error once."""
        error = self._c.passo_path_feed_poll(self.c)
        self.driver.hardware.check()
        if error != self._c.PASSO_OK:
            raise DriverError("path_feed_poll", error)

    @property
    def rests(self) -> bool:
        """Whether polls would only read the state until that has changed, unless lines are added."""
        return self._c.passo_feed_rests(self.c)

    def recover(self, positions: Sequence[int]) -> bool:
        """After a stop: go on with the rest of the path; False: its line is forgotten."""
        return self._c.passo_path_feed_recover(self.c, ffi().new("int32_t[8]", list(positions)))

    @property
    def is_moving(self) -> bool:
        """Whether there are lines that have not been executed yet."""
        return self._c.passo_path_feed_is_moving(self.c)
