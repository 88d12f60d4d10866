# SPDX-License-Identifier: MIT
"""Test interface of the planner: machines, moves and plans; velocities are UQ0.48, speeds UQ32.32."""

import tomllib
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

from passo import compiler
from passo.native import ffi, load
from passo.registers import Shape
from passo.toolchain import paths

SCHEMA = tomllib.loads((paths.spec / "moves.toml").read_text())
ONE = 1 << 48  # velocities and progress
HALF = 1 << 47
UNIT = 1 << 32  # speeds and accelerations
AXES = 8
LINEAR, COSINE, SIGMOID, EASE = Shape.LINEAR, Shape.COSINE, Shape.SIGMOID, Shape.EASE
JERK = 3  # the profile; the others are called like their shapes
SHAPE_OF_PROFILE = tuple(Shape[shape.upper()] for shape in SCHEMA["profiles"].values())
PROFILES = range(len(SHAPE_OF_PROFILE))
MOVE_CLOCKS = 1 << 44
SUBSTEPS_MAX = (1 << 30) - 1  # of a line, and so the steps of an axis


@dataclass(frozen=True)
class Machine:
    clock_hz: int = 100_000_000
    tick_log2: int = 7

    @property
    def tick(self) -> int:
        return 1 << self.tick_log2


@dataclass(frozen=True)
class InTime:
    steps: tuple[int, ...]
    profile: int
    total_clocks: int
    ramp_clocks: int


@dataclass(frozen=True)
class BySpeed:
    """Speeds and accelerations in UQ32.32."""

    steps: tuple[int, ...]
    profile: int
    speed: int
    start_speed: int = 0
    stop_speed: int = 0
    acceleration: int = 0
    deceleration: int = 0
    ramp_clocks: int = 0


@dataclass(frozen=True)
class Ramp:
    ticks: int
    shape: int
    mirror: bool
    velocity_start: int
    velocity_end: int
    progress_step: int


@dataclass(frozen=True)
class Plan:
    machine: Machine
    c: Any = field(repr=False)

    @property
    def substeps(self) -> int:
        return self.c.line.substeps

    @property
    def steps(self) -> list[int]:
        return list(self.c.line.steps)

    @property
    def ticks(self) -> int:
        return self.c.accelerate_ticks + self.c.cruise_ticks + self.c.decelerate_ticks

    @property
    def ramps(self) -> list[Ramp]:
        """The ramps with the velocities they start from."""
        result, velocity = [], 0
        for ramp in self.c.ramps[0 : self.c.ramp_count]:
            end = ramp.velocity_end
            result.append(Ramp(ramp.ticks, ramp.shape, ramp.mirror, velocity, end, ramp.progress_step))
            velocity = end
        return result


class PlanError(Exception):
    """The planner returned an error; the text is its name."""


def q32(value: float) -> int:
    return round(value * UNIT)


GOOD_IN_TIME = InTime((5, -3), JERK, 100_000, 20_000)
GOOD_BY_SPEED = BySpeed((500, -3), JERK, q32(1000), q32(100), q32(50), q32(1e5), q32(2e5))


def checked_library() -> Path:
    """Build the planner such that undefined behavior is fatal."""
    files = compiler.sources(paths.planner, paths.protocol)
    return compiler.library("checked_planner", (paths.planner, paths.protocol), files, *compiler.DEFINED)


@cache
def planner() -> Any:
    """Its functions."""
    return load(checked_library())


def make(c: Any, machine: Machine, axes: int, function: str, kind: str, fields: dict, *more: Any) -> Plan:
    """Call passo_plan_FUNCTION with a struct KIND, and further arguments; raise PlanError."""
    ours = ffi().new("struct passo_machine *", (machine.clock_hz, machine.tick_log2, axes))
    plan = ffi().new("struct passo_plan *")
    size = ffi().sizeof("struct passo_plan")
    ffi().memmove(plan, b"\xa5" * size, size)
    error = getattr(c, f"passo_plan_{function}")(ours, ffi().new(f"struct {kind} *", fields), *more, plan)
    if error:
        assert bytes(ffi().buffer(plan)) == b"\xa5" * size, "a refused plan was touched"
        raise PlanError(ffi().string(c.passo_plan_error_name(error)).decode())
    return Plan(machine, plan)


def make_move(c: Any, machine: Machine, function: str, fields: dict) -> Plan:
    """Methods whose struct is called as they are, with steps."""
    return make(c, machine, len(fields["steps"]), function, f"passo_move_{function}", fields)


def make_plan(c: Any, machine: Machine, move: InTime | BySpeed) -> Plan:
    """The first two forms."""
    form = "in_time" if isinstance(move, InTime) else "by_speed"
    return make_move(c, machine, form, {**vars(move), "steps": list(move.steps)})


def speed_of(plan: Plan, velocity: int) -> Fraction:
    """Steps/s of the longest axis."""
    return Fraction(velocity * plan.machine.clock_hz, ONE * plan.c.oversampling)


def refused(c: Any, function: Any, *arguments: Any) -> str:
    """Name of the error, or nothing."""
    try:
        function(c, *arguments)
    except PlanError as error:
        return str(error)
    return ""
