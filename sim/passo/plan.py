# SPDX-License-Identifier: MIT
"""Python binding of the planner (c_model/planner/passo_plan.h)."""

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from passo import move_forms
from passo.build import Parameters
from passo.failure import Portable
from passo.move_forms import ALPHA_MAX, ALPHA_MIN, ALPHA_ONE, SHAPED, USER, USER_BANK, WHOLE_MAX, Key, Points
from passo.moves import Channels, Move, MoveFile, MoveFileError
from passo.native import ffi, planner
from passo.shape import POINTS, ShapeError
from passo.shaper import shaped

Q48 = 1 << 48
ALPHA_RESET = move_forms.ALPHA_RESET * ALPHA_ONE  # alpha of the sigmoid table after reset


class PlanError(Portable):
    """The planner rejected a move; `name` is the name of an enum passo_plan_error."""

    def __init__(self, name: str, text: str):
        self.name, self.text = name, text
        super().__init__(f"{name}: {text}")


@dataclass(frozen=True)
class Plan:
    """A planned move; `c` is its `struct passo_plan`. Velocities are UQ0.48 substeps per clock."""

    move: Move
    c: Any
    tick_log2: int
    table: Points = ()  # required contents of the sigmoid bank; empty: those after reset, or any

    def __reduce__(self) -> tuple[Any, ...]:
        """Can be passed between processes, although a C struct cannot."""
        return _restored, (self.move, bytes(ffi().buffer(self.c)), self.tick_log2, self.table)

    @property
    def line(self) -> Any:
        """Its `struct passo_line`."""
        return self.c.line

    @property
    def ramps(self) -> list[Any]:
        """All its `struct passo_ramp`."""
        return [self.c.ramps[i] for i in range(self.c.ramp_count)]

    @property
    def clocks(self) -> int:
        """Length of the profile in clocks."""
        return sum(ramp.ticks for ramp in self.ramps) << self.tick_log2


def _restored(move: Move, data: bytes, tick_log2: int, table: Points) -> Plan:
    plan = ffi().new("struct passo_plan *")
    ffi().memmove(plan, data, len(data))
    return Plan(move, plan, tick_log2, table)


def plan_move(move: Move, clock_hz: int, parameters: Parameters) -> Plan:
    """Plan one move; raises PlanError."""
    c = planner()
    machine = ffi().new("struct passo_machine *", (clock_hz, parameters.tick_log2, len(move.steps)))
    plan = ffi().new("struct passo_plan *")
    method, table = move.form.name, _table(move)
    wanted = struct_of(move, clock_hz)
    if table:
        points = ffi().new("uint16_t[]", table)
        shape = ffi().new("struct passo_user_shape *", (int(USER_BANK), points, move.profile == SHAPED))
        error = getattr(c, f"passo_plan_user_{method}")(machine, wanted, shape, plan)
    else:
        error = getattr(c, f"passo_plan_{method}")(machine, wanted, plan)
    if error != c.PASSO_PLAN_OK:
        name, text = c.passo_plan_error_name(error), c.passo_plan_error_text(error)
        raise PlanError(ffi().string(name).decode(), ffi().string(text).decode())
    if plan.sigmoid_alpha not in (0, ALPHA_RESET):
        table = sigmoid_table(plan.sigmoid_alpha)
    return Plan(move, plan, parameters.tick_log2, table)


def _table(move: Move) -> Points:
    """The table that a move needs; empty: none."""
    if move.profile != SHAPED:
        return getattr(move, "table", ())
    try:
        return shaped(move.shaper, move.ramp_time)
    except ShapeError as error:
        raise PlanError("RAMP_TOO_SHORT", str(error)) from None


def sigmoid_table(alpha: int) -> Points:
    """The 256 points (UQ0.16) of a sigmoid table; `alpha` is in units of 1/4096. Raises ValueError."""
    table = ffi().new("uint16_t[]", POINTS)
    if planner().passo_sigmoid_table(alpha, table):
        raise ValueError(f"alpha {alpha / ALPHA_ONE} is not {ALPHA_MIN} to {ALPHA_MAX}")
    return tuple(table)


def struct_of(move: Move, clock_hz: int) -> Any:
    """The C struct of a move, in the units of the planner."""
    values: dict[str, Any] = {}
    for key in move.form.keys:
        value = getattr(move, key.name)
        if key.kind == "per_axis":
            limits = values.setdefault("limits", [{} for _ in value])
            for own, number in zip(limits, value, strict=True):
                own[key.member] = _number(key, number, clock_hz)
        elif key.kind in ("profile", "shape"):
            name = "linear" if value in (USER, SHAPED) else value  # ignored by the planner
            values[key.member] = getattr(planner(), f"PASSO_PROFILE_{name.upper()}")
        elif key.member and key.factor and isinstance(value, tuple):
            values[key.member] = [_number(key, number, clock_hz) for number in value]
        elif key.member:
            values[key.member] = _number(key, value, clock_hz) if key.factor else value
    return ffi().new(f"struct passo_move_{move.form.name} *", values)


def _number(key: Key, value: Fraction, clock_hz: int) -> int:
    """A value in the units of the struct, rounded to nearest; alpha saturates at 32 bits."""
    factor, whole = clock_hz if key.factor == "clock_hz" else key.factor, value.denominator
    number, rest = divmod(value.numerator * factor, whole)  # as round() of a fraction, in half the time
    number += 2 * rest > whole or (2 * rest == whole and number & 1)
    return min(number, WHOLE_MAX) if key.kind == "alpha" else number


def plan_file(file: MoveFile, parameters: Parameters) -> list[Plan]:
    """Plan all moves and chain them into one motion; raises MoveFileError."""
    plans = plan_moves(file, parameters)
    check_tables([(file.number(i), plan) for i, plan in enumerate(plans)], file.path)
    return plans


def plan_channels(channels: Channels, parameters: Parameters) -> list[list[Plan]]:
    """Plan the motion of each channel; raises MoveFileError."""
    plans = [plan_moves(file, parameters) for file in channels.files]
    numbered = [
        (file.number(i), plan)
        for file, own in zip(channels.files, plans, strict=True)
        for i, plan in enumerate(own)
    ]
    check_tables(sorted(numbered, key=lambda pair: pair[0]), channels.path)
    return plans


def plan_moves(file: MoveFile, parameters: Parameters) -> list[Plan]:
    plans = []
    for index, move in enumerate(file.moves):
        try:
            plan = plan_move(move, file.clock_hz, parameters)
            _check_pins(plan, file)
        except PlanError as error:
            raise MoveFileError(f"{file.path}: move {file.number(index)}: {error}") from None
        plans.append(plan)
    for plan in plans[:-1]:
        plan.line.last = False
        plan.ramps[-1].last = False
    return plans


def table_of(plans: list[Plan]) -> Points:
    """Required contents of the sigmoid bank for this motion; empty: those after reset."""
    return next((plan.table for plan in plans if plan.table), ())


def check_tables(plans: list[tuple[int, Plan]], path: Path) -> None:
    """Raises MoveFileError if two moves, given with their numbers, need different tables in the same bank."""
    users = [(n, plan) for n, plan in plans if plan.table or plan.c.sigmoid_alpha]
    for number, plan in users[1:]:
        if plan.table != users[0][1].table:
            raise MoveFileError(
                f"{path}: move {number}: it needs a different table than move {users[0][0]}, "
                "and tables cannot be loaded during a motion"
            )


def _check_pins(plan: Plan, file: MoveFile) -> None:
    """Raises PlanError if an axis would exceed its pin timing."""
    shortest = file.pins.step_high + file.pins.step_low
    for axis, steps in enumerate(map(abs, plan.move.steps)):
        steps_per_clock = Fraction(plan.c.velocity_peak * steps, Q48 * plan.line.substeps)
        if steps_per_clock * shortest > 1:
            speed, limit = steps_per_clock * file.clock_hz, file.clock_hz / shortest
            raise PlanError(
                "PINS_TOO_SLOW",
                f"axis {axis} reaches {float(speed):.0f} steps/s; its pin timing allows {limit:.0f}",
            )
