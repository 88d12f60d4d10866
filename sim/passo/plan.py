# SPDX-License-Identifier: MIT
"""The planner (planner/passo_plan.h) for Python."""

from dataclasses import dataclass, fields
from fractions import Fraction
from typing import Any

from passo import moves as m
from passo.build import Parameters
from passo.moves import Move, MoveFile, MoveFileError, q32
from passo.native import ffi, planner
from passo.shape import POINTS

Q48 = 1 << 48
ALPHA_ONE = 4096
ALPHA_RESET = 5 * ALPHA_ONE  # what the sigmoid's table is made for after reset

# Which passo_plan_METHOD() plans a move; its struct is passo_move_METHOD.
METHODS = {
    m.MoveInTime: "in_time",
    m.MoveBySpeed: "by_speed",
    m.MoveBelowSpeed: "below_speed",
    m.MoveAtSpeed: "at_speed",
    m.MoveAxes: "axes",
    m.MoveTurn: "turn",
    m.MoveSigmoid: "sigmoid",
    m.MoveJerk: "jerk",
    m.MoveStraight: "straight",
}


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
    table: m.Points = ()  # what the sigmoid's bank must hold; empty: what is there after reset, or anything

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
    method, table = METHODS[type(move)], getattr(move, "table", ())
    wanted = ffi().new(f"struct passo_move_{method} *", _struct_of(move, clock_hz))
    if table:
        points = ffi().new("uint16_t[]", table)
        shape = ffi().new("struct passo_user_shape *", (c.PASSO_SHAPE_SIGMOID, points))
        error = getattr(c, f"passo_plan_user_{method}")(machine, wanted, shape, plan)
    else:
        error = getattr(c, f"passo_plan_{method}")(machine, wanted, plan)
    if error != c.PASSO_PLAN_OK:
        name, text = c.passo_plan_error_name(error), c.passo_plan_error_text(error)
        raise PlanError(ffi().string(name).decode(), ffi().string(text).decode())
    if plan.sigmoid_alpha not in (0, ALPHA_RESET):
        table = sigmoid_table(plan.sigmoid_alpha)
    return Plan(move, plan, parameters.tick_log2, table)


def sigmoid_table(alpha: int) -> m.Points:
    """The points of the sigmoid for an alpha in 1/4096."""
    table = ffi().new("uint16_t[]", POINTS)
    if planner().passo_sigmoid_table(alpha, table):
        raise ValueError(f"alpha {alpha / ALPHA_ONE} is not 3 to 5")
    return tuple(table)


def _struct_of(move: Move, clock_hz: int) -> dict[str, Any]:
    """A move's fields as its C struct has them: times in clocks, all else in units of 2^-32."""
    if isinstance(move, m.MoveStraight):
        limits = zip(move.steps_per_mm, move.speed, move.acceleration, move.jerk, strict=True)
        return {
            "distance": [q32(d) for d in move.distance],
            "limits": [tuple(map(q32, own)) for own in limits],
            "feed": q32(move.feed),
        }
    values: dict[str, Any] = {}
    known = {name for name, _ in ffi().typeof(f"struct passo_move_{METHODS[type(move)]}").fields}
    for field in fields(move):
        name, value = field.name, getattr(move, field.name)
        if name == "alpha":
            values[name] = min(round(value * ALPHA_ONE), 2**32 - 1)
        elif name == "profile":
            value = "linear" if value == m.USER else value  # not looked at then
            values[name] = getattr(planner(), f"PASSO_PROFILE_{value.upper()}")
        elif name.endswith("_time"):
            values[f"{name.removesuffix('_time')}_clocks"] = round(value * clock_hz)
        else:
            values[name] = q32(value) if isinstance(value, Fraction) else value
    return {name: value for name, value in values.items() if name in known}


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
    _check_tables(plans, file)
    for plan in plans[:-1]:
        plan.line.last = False
        plan.ramps[-1].last = False
    return plans


def table_of(plans: list[Plan]) -> m.Points:
    """What the sigmoid's bank must hold before this motion; empty: what is there after reset."""
    return next((plan.table for plan in plans if plan.table), ())


def _check_tables(plans: list[Plan], file: MoveFile) -> None:
    """Raise MoveFileError if two moves need different tables in the one bank there is for them."""
    users = [(n, plan) for n, plan in enumerate(plans, 1) if plan.table or plan.c.sigmoid_alpha]
    for number, plan in users[1:]:
        if plan.table != users[0][1].table:
            raise MoveFileError(
                f"{file.path}: move {number}: it needs another table than move {users[0][0]}, "
                "and tables cannot be loaded during a motion"
            )


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
