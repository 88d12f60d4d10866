# SPDX-License-Identifier: MIT
"""Parses path-synchronized outputs and the spindle of a move file."""

from fractions import Fraction
from typing import Any

from passo.form_table import Form
from passo.move_forms import (
    MACHINES,
    WHOLE_MAX,
    MachineCompare,
    MachineOutput,
    MachineSettings,
    MachineSpindle,
    MoveThread,
)
from passo.move_keys import check_rules, read_key
from passo.moves import AXES_MAX, Task
from passo.registers import CHANNEL_COMPARE_PULSE_WIDTH_BITS, CHANNEL_OUTPUT_LAG_LAG_BITS
from passo.setup import Setup
from passo.table_values import Table, check_known, within
from passo.values import BadValueError

LAG_MAX = (1 << CHANNEL_OUTPUT_LAG_LAG_BITS) - 1
WIDTH_MAX = (1 << CHANNEL_COMPARE_PULSE_WIDTH_BITS) - 1
PWM_BITS = 24  # longest period in clocks, as a power of two
COUNT_CLOCKS_MIN = 8  # from count to count of the spindle: its filter and some more


def read_form(form: Form, table: Table, clock_hz: int, others: tuple[str, ...] = ()) -> dict[str, Any]:
    """The values of a form's keys; raises BadValueError."""
    names = tuple(key.name for key in form.keys)
    check_known(table, (*others, *names))
    values = {key.name: read_key(table, key, clock_hz) for key in form.keys}
    check_rules(form, table)
    return values


def settings_of(table: Table, clock_hz: int, others: tuple[str, ...]) -> MachineSettings:
    """The settings among [machine]; `others` are its other keys."""
    settings = MachineSettings(**read_form(MACHINES["settings"], table, clock_hz, others))
    if "pwm" in table:
        check_pwm(settings, clock_hz)
    _check_clocks("lag", settings.lag * clock_hz, 0, LAG_MAX)
    return settings


def check_pwm(settings: MachineSettings, clock_hz: int) -> None:
    """Raises BadValueError if the core cannot make the frequency."""
    lowest, highest = max(1, clock_hz >> PWM_BITS), clock_hz // 2
    if not lowest <= settings.pwm <= highest:
        raise BadValueError(f"pwm must be {lowest} to {highest} Hz at this clock")


def _check_clocks(key: str, clocks: Fraction, least: int, most: int) -> None:
    if not least <= round(clocks) <= most:
        raise BadValueError(f"{key} is {round(clocks)} clocks; must be {least} to {most}")


def read_output(table: Table, move: Any, clock_hz: int) -> MachineOutput | None:
    """The key `output` of a move."""
    if "output" not in table:
        return None
    if isinstance(move, Task):
        raise BadValueError(f"output: {move.form.name} cannot have its own power or levels")
    return within("output", lambda: _output(table["output"], clock_hz))


def _output(table: object, clock_hz: int) -> MachineOutput:
    if not isinstance(table, dict):
        raise BadValueError("it must be a table, such as { power = 50 }")
    output = MachineOutput(**read_form(MACHINES["output"], table, clock_hz))
    if output.power > 100:
        raise BadValueError("power must be at most 100")
    return output


def _own_table(machine: Table, key: str) -> Table | None:
    table = machine.get(key)
    if table is not None and not isinstance(table, dict):
        raise BadValueError(f"it must be a table: [machine.{key}]")
    return table


def read_compare(machine: Table, axes: int, clock_hz: int) -> MachineCompare | None:
    """[machine.compare]"""
    if (table := _own_table(machine, "compare")) is None:
        return None
    compare = MachineCompare(**read_form(MACHINES["compare"], table, clock_hz))
    if compare.axis >= axes:
        raise BadValueError(f"axis must be 0 to {axes - 1}")
    if not compare.interval:
        raise BadValueError("interval must not be 0")
    _check_clocks("width", compare.width * clock_hz, 1, WIDTH_MAX)
    return compare


def read_spindle(machine: Table, axes: int, clock_hz: int) -> MachineSpindle | None:
    """[machine.spindle]"""
    if (table := _own_table(machine, "spindle")) is None:
        return None
    spindle = MachineSpindle(**read_form(MACHINES["spindle"], table, clock_hz))
    if axes == AXES_MAX:
        raise BadValueError(
            f"its encoder needs an axis of its own: moves must have at most {AXES_MAX - 1} axes"
        )
    clocks = clock_hz / (fastest(spindle) / 60 * spindle.counts_per_turn)
    if clocks < COUNT_CLOCKS_MIN:
        raise BadValueError(
            f"rpm: one count every {float(clocks):.3g} clocks; must be at least {COUNT_CLOCKS_MIN}"
        )
    return spindle


def fastest(spindle: MachineSpindle) -> Fraction:
    """Most rpm of a spindle."""
    return spindle.rpm * (100 + spindle.wander) / 100


def counts_of(move: MoveThread, spindle: MachineSpindle) -> int:
    """Counts of a pass."""
    return round(move.turns * spindle.counts_per_turn)


def check_thread(move: MoveThread, setup: Setup) -> None:
    """Raises BadValueError if there is no such pass."""
    if setup.spindle is None:
        raise BadValueError("a thread needs a spindle: [machine.spindle]")
    if not 1 <= counts_of(move, setup.spindle) <= WHOLE_MAX:
        counts = counts_of(move, setup.spindle)
        raise BadValueError(f"turns are {counts} counts; must be 1 to {WHOLE_MAX}")
    if move.top_rpm is not None and move.top_rpm < fastest(setup.spindle):
        raise BadValueError(f"top_rpm is less than the {float(fastest(setup.spindle)):g} of the spindle")
