# SPDX-License-Identifier: MIT
"""Machine description of the grbl console, and the file with its settings."""

import math
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from passo.build import Parameters
from passo.engine import NUMBERS
from passo.failure import BadInputError
from passo.machine_file import ENCODER_FILTER, MachineFile, Spindle, check_pins
from passo.moves import PinTiming
from passo.native import ffi, planner
from passo.output import check_access, write_bytes
from passo.rig import RATIO_ONE, gap_of, interval_of
from passo.run import open_engine, parameters_for
from passo.values import BadValueError

MILLION = 1_000_000
SECONDS_PER_MINUTE = 60
REPORT_ALL = 3  # $10: MPos and Bf
INFINITE = math.inf
FILTER_CLOCKS = 65535  # of the filter of the switches, at most
ALWAYS_ON = 255  # $1
TICKS_PER_COUNT = 8  # of a simulated spindle (rig_spindle.c)
SPINDLE_TICKS = 1000  # of one without an encoder, in a second
PAGE = 2048  # bytes, as of the STM32F103CB
PAGES = 2
WORD = 4
TOUCH = {"TOUCH_DISTANCE": 30, "TOUCH_FEED": 25, "TOUCH_SEEK": 200, "TOUCH_PULL_OFF": 200}  # $342 to $345


def setting_counts(machine: MachineFile) -> Any:
    """The `struct passo_grbl_counts` of a machine."""
    offsets = len(machine.motors) if machine.squared else 0
    return ffi().new("struct passo_grbl_counts *", {"axes": len(machine.ends), "offsets": offsets})[0]


def _millionths(
    machine: MachineFile, key: str, index: int, given: float, factor: int, most: float = INFINITE
) -> int:
    """A setting of a key of the file; refuses what `$n=` would refuse."""
    counts, whole, positive = setting_counts(machine), ffi().new("bool *"), ffi().new("bool *")
    number = planner().passo_grbl_setting_number(index, counts, whole)
    most = min(most, planner().passo_grbl_setting_most(number, counts, positive) / factor)
    value = round(given * factor * MILLION)
    if given > most or (positive[0] and value == 0):
        least = "more than 0 and at most" if positive[0] else "0 to"
        raise BadInputError(
            f"{machine.path}: {key} must be {least} {most:g}, as ${number}, not {float(given):g}"
        )
    return value


def _seconds(clocks: int, clock_hz: int) -> float:
    """In millionths of a microsecond, rounded down: the console rounds up to clocks again."""
    return clocks * MILLION**2 // clock_hz / MILLION**2


def default_settings(machine: MachineFile) -> Any:
    """The `struct passo_grbl_settings` of a machine file."""
    c = planner()
    made = ffi().new("struct passo_grbl_settings *")
    ends, switches, pins = machine.ends, machine.switches, machine.pins
    pulse, turn = max(pins.step_high, pins.step_low), max(pins.dir_setup, pins.dir_hold)
    try:
        check_pins(machine.settings, PinTiming(pulse, pulse, turn, turn))
    except BadValueError as error:
        raise BadInputError(f"{machine.path}: as $0 and $29: {error}") from None
    values = {
        "IDLE_DELAY": ALWAYS_ON,
        "REPORT": REPORT_ALL,
        "LIMITS_INVERTED": switches.inverted,
        "SOFT_LIMITS": switches.soft_limits,
        "HARD_LIMITS": switches.stop and any(set(end.switches) - {"home"} for end in ends),
        "HOMING": any(end.home for end in ends),
        "HOMES_LOW": sum(1 << axis for axis, end in enumerate(ends) if end.home == "low"),
        "LASER": machine.laser,
        "ENABLES_INVERTED": machine.enable_inverted,
        **TOUCH,
    }
    for name, value in values.items():
        made.value[getattr(c, f"PASSO_GRBL_{name}")] = round(value * MILLION)
    filter_most = FILTER_CLOCKS / machine.clock_hz
    for name, key, given, factor, most in (
        ("PULSE", "pins: step_high", _seconds(pulse, machine.clock_hz), MILLION, INFINITE),
        ("TURN", "pins: dir_setup", _seconds(turn, machine.clock_hz), MILLION, INFINITE),
        ("DEVIATION", "junction_deviation", machine.settings.junction_deviation, 1, INFINITE),
        ("ARC_TOLERANCE", "arc_tolerance", machine.gcode.arc_tolerance, 1, INFINITE),
        ("HOME_FEED", "home: speed", switches.speed, SECONDS_PER_MINUTE, INFINITE),
        ("HOME_SEEK", "home: seek", switches.seek, SECONDS_PER_MINUTE, INFINITE),
        ("DEBOUNCE", "switches: debounce", switches.debounce, 1000, filter_most),
        ("PULL_OFF", "home: pull_off", switches.pull_off, 1, INFINITE),
        ("SPINDLE", "spindle_maximum", machine.gcode.spindle_maximum, 1, INFINITE),
        ("SPIN_UP", "spindle_wait", machine.spindle_wait, 1, INFINITE),
    ):
        index = getattr(c, f"PASSO_GRBL_{name}")
        made.value[index] = _millionths(machine, key, index, given, factor, most)
    for axis, limits in enumerate(machine.settings.axes):
        for name, key, given, factor in (
            ("STEPS", "steps_per_mm", limits.steps_per_mm, 1),
            ("SPEED", "speed", limits.speed, SECONDS_PER_MINUTE),
            ("ACCELERATION", "acceleration", limits.acceleration, 1),
            ("TRAVEL", "travel", ends[axis].travel, 1),
            ("BACKLASH", "backlash", ends[axis].backlash, 1),
            ("TAKE_UP", "take_up", ends[axis].take_up, 1),
            ("JERK", "jerk", limits.jerk if machine.settings.profile == "jerk" else 0, 1),
        ):
            setting = getattr(c, f"PASSO_GRBL_{name}")
            index = c.PASSO_GRBL_SETTINGS + setting * len(ends) + axis
            made.axis[setting][axis] = _millionths(machine, f"axis {axis + 1}: {key}", index, given, factor)
    made.axis[c.PASSO_GRBL_OFFSET][0 : len(machine.offsets)] = machine.offsets
    return made


def defaults_of(machine: MachineFile) -> Any:
    """The function of a `struct passo_grbl_setup` that sets them; it must live as long as that."""
    made = default_settings(machine)

    def set_defaults(settings: Any) -> None:
        settings[0] = made[0]

    return ffi().callback("void(struct passo_grbl_settings *)", set_defaults)


def encoders_of(machine: MachineFile) -> list[int]:
    """Those of a `struct passo_grbl_setup`; none: there is none."""
    if not machine.encoders:
        return []
    pairs = (machine.encoders.get(motor, (0, 0)) for motor in range(len(machine.motors)))
    return [number for counts, limit in pairs for number in (round(counts * (1 << 32)), limit)]


def setup_of(machine: MachineFile, parameters: Parameters, defaults: Any, pages: Any, encoders: Any) -> Any:
    """The `struct passo_grbl_setup`; `pages` is that of a file, or NULL, `encoders` an array, or NULL."""
    made = ffi().new("struct passo_grbl_setup *")
    made.path = machine.settings.struct(parameters)[0]
    made.defaults = defaults
    made.limits_low, made.limits_high = machine.mask("limit_low"), machine.mask("limit_high")
    made.homes = machine.mask("home")
    for axis, end in enumerate(machine.ends):
        made.homed |= (end.home is not None) << axis
    made.squared = sum(1 << axis for axis in machine.squared)
    made.racking = round(machine.switches.racking * 1000)
    made.encoders = encoders
    if parameters.encoders and parameters.axes > len(machine.motors):
        made.turn_counts = machine.gcode.turn_counts
    made.probe, made.pages = machine.switches.probe, pages
    made.at_speed = machine.spindle_at_speed
    return made


def core_for(machine: MachineFile) -> Parameters:
    """The core that a machine needs."""
    core = parameters_for(machine.core_axes)
    return replace(core, clock_hz=machine.clock_hz, **dict.fromkeys(machine.parts, 1))


def attach(
    engine: Any,
    machine: MachineFile,
    skews: dict[int, int] | None = None,
    per_turn: int = 0,
    spindle: bool = False,
) -> Any:
    """A simulated machine at the core; returns the rigs, with their libraries.

    `spindle`: its encoder, if it has one, is behind the motors; it turns at full speed while output 0 is on.
    """
    config = rig_config(engine, machine, skews, per_turn)
    if not spindle:
        return engine.attach(config)
    config.wheel[config.wheels] = spindle_wheel(machine)
    config.wheels += 1
    rigs = engine.attach(config)
    for c, rig in rigs:
        c.passo_rig_drive(rig, config.wheels - 1, RATIO_ONE)
    return rigs


def rig_config(
    engine: Any, machine: MachineFile, skews: dict[int, int] | None = None, per_turn: int = 0
) -> Any:
    """The `struct passo_rig_config` of a machine: each axis in the middle of its travel, switches at its end.

    `skews`: steps by which motors begin elsewhere; `per_turn`: counts from index to index of their encoders.
    For the probe there is a plate that Z (or the last axis) touches a quarter of its travel below the middle.
    """
    config = ffi().new("struct passo_rig_config *")
    config.axes = engine.parameters.channels * engine.parameters.axes
    rows, wires = machine.settings.motors.map(len(machine.ends)), []
    travels = [
        round(float(limits.steps_per_mm) * end.travel)
        for limits, end in zip(machine.settings.axes, machine.ends, strict=True)
    ]
    add_encoders(config, machine, per_turn)
    for motor, start in enumerate(rows @ np.array(travels) // 2):
        config.start[motor] = start + (skews or {}).get(motor, 0)
    for axis, (travel, end) in enumerate(zip(travels, machine.ends, strict=True)):
        for switch in end.switches:
            above = switch == "limit_high" or (switch == "home" and end.home == "high")
            wires += [
                (NUMBERS[switch], motor, axis, above, travel if above else 0)
                for motor in range(len(rows))
                if machine.bits(switch, axis) >> motor & 1
            ]
    if machine.switches.probe:
        axis = machine.letters.index("Z") if "Z" in machine.letters else len(travels) - 1
        wires.append((NUMBERS["probe"], 0, axis, False, travels[axis] // 4))
    for wire, (pin, bit, axis, above, at) in zip(config.wire, wires, strict=False):
        wire.input, wire.bit, wire.above = pin, bit, above
        wire.axis, wire.at = (bit if pin != NUMBERS["probe"] else axis), at
        if len(mixed := np.flatnonzero(rows[:, axis] * machine.settings.motors.mixed_of(len(travels)))):
            wire.axis, wire.other = (int(motor) for motor in mixed)
            wire.share, wire.at = rows[wire.other][axis], 2 * at
        wire.is_switch, wire.inverted = True, machine.switches.inverted and pin != NUMBERS["probe"]
    config.wires = len(wires)
    return config


def spindle_wheel(machine: MachineFile) -> dict[str, int]:
    """The `struct passo_rig_wheel` of its spindle, with its encoder, if it has one, behind the motors."""
    ready = {"ready": machine.spindle_at_speed, "inverted": int(machine.switches.inverted)}
    if not machine.spindle:
        interval = TICKS_PER_COUNT * machine.clock_hz * RATIO_ONE // SPINDLE_TICKS
        return {"interval": interval, "start_up": round(Spindle.start_up * machine.clock_hz), **ready}
    return {
        **ready,
        "axis": len(machine.motors),
        "interval": interval_of(machine.clock_hz, machine.gcode.spindle_maximum, machine.spindle.counts),
        "wander": round(machine.spindle.wander * RATIO_ONE / 100),
        "per_turn": machine.spindle.counts,
        "start_up": round(machine.spindle.start_up * machine.clock_hz),
    }


def add_encoders(config: Any, machine: MachineFile, per_turn: int = 0) -> None:
    """Make those of the motors the wheels of a `struct passo_rig_config`."""
    for number, (motor, ratio) in enumerate(machine.encoder_ratios.items()):
        wheel = {"axis": motor, "ratio": ratio, "gap": gap_of(ENCODER_FILTER), "per_turn": per_turn}
        config.wheel[number] = wheel
    config.wheels = len(machine.encoders)


def attach_encoders(engine: Any, machine: MachineFile) -> None:
    """The encoders of a machine, and nothing else of it."""
    if machine.encoders:
        config = ffi().new("struct passo_rig_config *")
        config.axes = engine.parameters.channels * engine.parameters.axes
        add_encoders(config, machine)
        engine.attach(config)


@contextmanager
def served(
    name: str, machine: MachineFile, per_turn: int = 0, tell: Callable[[Any], None] = lambda rigs: None
) -> Iterator[Any]:
    """An engine with the machine at its pins, with the encoder of its spindle; `per_turn`: see attach().

    `tell` is given its rigs.
    """
    core = core_for(machine)
    if machine.spindle:
        more = parameters_for(len(machine.motors) + 1)
        core = replace(core, axes=more.axes, encoders=1, outputs=1)
    with open_engine(name, core, machine.clock_hz) as engine:
        if machine.has_inputs or core.encoders:
            tell(attach(engine, machine, per_turn=per_turn, spindle=machine.turns))
        yield engine


@contextmanager
def machine_at(name: str, machine: MachineFile) -> Iterator[Any]:
    """An engine with the machine at its pins."""
    with open_engine(name, core_for(machine), machine.clock_hz) as engine:
        if machine.has_inputs or machine.encoders:
            attach(engine, machine)
        yield engine


class SettingsFile:
    """Two pages in a file, as they would be in flash."""

    def __init__(self, path: Path):
        self.path = path
        try:
            if not path.exists():
                write_bytes(path, b"\xff" * PAGE * PAGES)
            if not path.is_file() or path.stat().st_size != PAGE * PAGES:
                raise BadInputError(f"{path}: not a settings file: it must have {PAGE * PAGES} bytes")
            check_access(path, os.R_OK | os.W_OK)
        except OSError as error:
            raise BadInputError(f"{path}: {error.strerror}") from None
        kinds = (
            "bool(void *, unsigned, size_t, uint32_t *, size_t)",
            "bool(void *, unsigned)",
            "bool(void *, unsigned, size_t, uint32_t *, size_t)",
        )
        functions = self._read, self._erase, self._write
        self._callbacks = [
            ffi().callback(kind, function, error=False)
            for kind, function in zip(kinds, functions, strict=True)
        ]
        self.c = ffi().new("struct passo_storage_pages *")
        self.c.read, self.c.erase, self.c.write = (ffi().cast("void *", call) for call in self._callbacks)

    def _read(self, _: Any, page: int, at: int, words: Any, count: int) -> bool:
        if WORD * (at + count) > PAGE:
            return False
        with suppress(OSError), self.path.open("rb") as file:
            file.seek(page * PAGE + WORD * at)
            ffi().memmove(words, file.read(WORD * count), WORD * count)
            return True
        return False

    def _erase(self, _: Any, page: int) -> bool:
        return self._put(page, 0, b"\xff" * PAGE)

    def _write(self, _: Any, page: int, at: int, words: Any, count: int) -> bool:
        return self._put(page, at, bytes(ffi().buffer(words, WORD * count)))

    def _put(self, page: int, at: int, data: bytes) -> bool:
        if WORD * at + len(data) > PAGE:
            return False
        with suppress(OSError), self.path.open("r+b") as file:
            file.seek(page * PAGE + WORD * at)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
            return True
        return False
