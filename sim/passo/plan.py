# SPDX-License-Identifier: MIT
"""The planner (c_model/passo_plan.h) for Python."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from passo.build import Parameters
from passo.moves import Move, MoveFile, MoveFileError, MoveInTime
from passo.native import ffi, planner

Q32 = 1 << 32
Q48 = 1 << 48


class PlanError(Exception):
    """The planner refused a move; `name` is one of enum passo_plan_error."""

    def __init__(self, name: str, text: str):
        self.name, self.text = name, text
        super().__init__(f"{name}: {text}")


@dataclass(frozen=True)
class Plan:
    """A planned move; `c` is its `struct passo_plan`. Velocities are UQ0.48 substeps per clock."""

    move: Move
    c: Any
    tick_log2: int

    @property
    def line(self) -> Any:
        """Its `struct passo_line`."""
        return self.c.line

    @property
    def ramps(self) -> list[Any]:
        """Each `struct passo_ramp` of it."""
        return [self.c.ramps[i] for i in range(self.c.ramp_count)]

    @property
    def clocks(self) -> int:
        """Length of the profile."""
        return sum(ramp.ticks for ramp in self.ramps) << self.tick_log2


def plan_move(move: Move, clock_hz: int, parameters: Parameters) -> Plan:
    """Plan one move; raise PlanError."""
    c = planner()
    machine = ffi().new("struct passo_machine *", (clock_hz, parameters.tick_log2, len(move.steps)))
    plan = ffi().new("struct passo_plan *")
    profile = getattr(c, f"PASSO_PROFILE_{move.profile.upper()}")
    if isinstance(move, MoveInTime):
        fields = {
            "total_clocks": _clocks(move.total_time, clock_hz),
            "ramp_clocks": _clocks(move.ramp_time, clock_hz),
        }
        wanted = ffi().new("struct passo_move_in_time *", {"profile": profile, **fields})
        make = c.passo_plan_in_time
    else:
        speeds = ("start_speed", "speed", "stop_speed", "acceleration", "deceleration")
        fields = {name: round(getattr(move, name) * Q32) for name in speeds}
        fields["ramp_clocks"] = _clocks(move.ramp_time, clock_hz)
        wanted = ffi().new("struct passo_move_by_speed *", {"profile": profile, **fields})
        make = c.passo_plan_by_speed
    for axis, steps in enumerate(move.steps):
        wanted.steps[axis] = steps
    error = make(machine, wanted, plan)
    if error != c.PASSO_PLAN_OK:
        name, text = c.passo_plan_error_name(error), c.passo_plan_error_text(error)
        raise PlanError(ffi().string(name).decode(), ffi().string(text).decode())
    return Plan(move, plan, parameters.tick_log2)


def plan_file(file: MoveFile, parameters: Parameters) -> list[Plan]:
    """Plan all moves and chain them into one motion; raise MoveFileError."""
    plans = []
    for number, move in enumerate(file.moves, 1):
        try:
            plan = plan_move(move, file.clock_hz, parameters)
            _check_pins(plan, file)
        except PlanError as error:
            raise MoveFileError(f"{file.path}: move {number}: {error}") from None
        plans.append(plan)
    for plan in plans[:-1]:
        plan.line.last = False
        plan.ramps[-1].last = False
    return plans


def _check_pins(plan: Plan, file: MoveFile) -> None:
    """Raise PlanError if an axis makes steps faster than its pins can."""
    shortest = file.pins.step_high + file.pins.step_low
    for axis, steps in enumerate(map(abs, plan.move.steps)):
        steps_per_clock = Fraction(plan.c.velocity_peak * steps, Q48 * plan.line.substeps)
        if steps_per_clock * shortest > 1:
            speed, limit = steps_per_clock * file.clock_hz, file.clock_hz / shortest
            raise PlanError(
                "PINS_TOO_SLOW",
                f"axis {axis} reaches {float(speed):.0f} steps/s, its pin timing allows {limit:.0f}",
            )


def _clocks(seconds: Fraction, clock_hz: int) -> int:
    return round(seconds * clock_hz)
