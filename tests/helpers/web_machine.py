# SPDX-License-Identifier: MIT
"""A machine for G-code as the page of `make web` has to read it (sim/passo/page/machine_file.js)."""

from typing import Any

import numpy as np
from passo.grbl_setup import spindle_wheel
from passo.machine_file import PROFILES, MachineFile
from passo.path import PathAxis
from passo.run import AXES_OF_CORES
from passo.web_rules import LIMITS, MOTORS_MOST


def web_machine(machine: MachineFile) -> dict[str, Any]:
    """Its members: names and scales of motors, which axes they move, and `numbers` for C."""
    count = len(machine.settings.axes)
    rows = np.array(machine.settings.motors.map(count)).tolist()
    return {
        "numbers": numbers(machine),
        "clock_hz": machine.clock_hz,
        "letters": machine.letters,
        "profile": machine.settings.profile,
        "inputs": machine.gcode.inputs,
        "power": int(machine.gcode.power),
        "turn_counts": machine.gcode.turn_counts,
        "spindle": [f"{machine.spindle_wait:g}", machine.spindle_at_speed],
        "rows": rows,
        "motors": [
            {"name": name, "per_step": 1 / scale}
            for name, scale in zip(machine.motors, machine.settings.scales, strict=True)
        ],
    }


def numbers(machine: MachineFile) -> list[float]:
    """The members of `struct web_machine` (sim/engine/passo_web_program.c)."""
    settings, pins, gcode = machine.settings, machine.pins, machine.gcode
    core_axes = next(axes for axes in AXES_OF_CORES if axes >= machine.core_axes)
    wheel = spindle_wheel(machine) if machine.turns else {}
    rest = [0] * (MOTORS_MOST - len(settings.motors.rows))
    members = (
        *(settings.clock_hz, len(settings.axes), settings.junction_deviation),
        *(gcode.arc_tolerance, PROFILES.index(settings.profile), core_axes),
        *(pins.step_high, pins.step_low, pins.dir_setup, pins.dir_hold),
        *(gcode.spindle_maximum, gcode.left_out, gcode.inputs, gcode.power),
        *(wheel.get(key, 0) for key in ("per_turn", "interval", "wander", "start_up")),
        *(round(machine.spindle_wait * 1e6), machine.spindle_at_speed),
        len(settings.motors.rows),
        *(*settings.motors.bits(1), *rest, *settings.motors.bits(-1), *rest),
        *_limits(settings.motors.mixed),
        *(number for axis in settings.axes for number in _limits(axis)),
    )
    return [float(number) for number in members]


def _limits(axis: PathAxis) -> tuple[Any, ...]:
    return tuple(getattr(axis, name) for name in LIMITS)
