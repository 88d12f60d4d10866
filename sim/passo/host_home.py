# SPDX-License-Identifier: MIT
"""The switches of a machine file for the driver, and its homing."""

from fractions import Fraction
from typing import Any

from passo.driver import Driver
from passo.failure import BadInputError
from passo.machine_file import MachineFile
from passo.moves import q32
from passo.native import ffi, planner

ORDER = "ZXYABC"
SEEK = 1.5  # travels to the switch, at most
NANOMETERS = 1_000_000


def configure_inputs(driver: Driver, file: MachineFile) -> None:
    """Filter, switches and probe. A limit that is also a home is there in any case.

    Raises BadInputError if the core has no inputs, DriverError if a call fails.
    """
    if not driver.lib.passo_has_inputs(driver.c):
        raise BadInputError(
            f"{file.path}: its switches need inputs, the core has none: build it with INPUTS=1, "
            "or leave switches, homes and probe out"
        )
    inverted, stops = file.switches.inverted, file.switches.stop
    driver.call("configure_filter", round(file.switches.debounce * file.clock_hz))
    low, high, home = (file.mask(name) for name in ("limit_low", "limit_high", "home"))
    by_limit = sum(
        file.bits(end.homing_switch, axis)
        for axis, end in enumerate(file.ends)
        if end.homing_switch not in (None, "home")
    )
    for motor in range(len(file.motors)):
        bit = 1 << motor
        used = bit if stops or by_limit & bit else 0
        config = {
            "limit_low": bool(low & used),
            "limit_high": bool(high & used),
            "home": bool(home & bit),
            "limit_low_inverted": inverted and bool(low & bit),
            "limit_high_inverted": inverted and bool(high & bit),
            "home_inverted": inverted,
            "limit_soft": True,
        }
        driver.call("configure_inputs", motor, ffi().new("struct passo_input_config *", config))
    if file.switches.probe:
        driver.call("configure_probe", False)


class Homing:
    """The `struct passo_home` of some axes, or of all that have a home, in the order in which they home."""

    def __init__(self, file: MachineFile, wanted: str):
        """Raises BadInputError."""
        for letter in wanted:
            if letter not in file.letters:
                raise BadInputError(f"there is no axis {letter}: axes are {', '.join(file.letters)}")
            if file.ends[file.letters.index(letter)].home is None:
                raise BadInputError(f'axis {letter} has no home: home = "low" or "high" in {file.path}')
        chosen = [file.letters.index(letter) for letter in ORDER if letter in (wanted or file.letters)]
        axes = [axis for axis in chosen if file.ends[axis].home]
        if not axes:
            raise BadInputError(f'no axis has a home: home = "low" or "high" in {file.path}')
        self._homes, self._offsets = ffi().new("struct passo_home[]", len(axes)), ffi().new("int32_t[8]")
        for motor, offset in enumerate(file.offsets):
            self._offsets[motor] = round(offset / NANOMETERS * file.settings.scales[motor])
        for home, axis in zip(self._homes, axes, strict=True):
            _set(home, file, axis, self._offsets)

    def start(self, driver: Driver) -> None:
        """Start it; raises DriverError."""
        driver.call("home", self._homes, len(self._homes))


def _set(home: Any, file: MachineFile, axis: int, offsets: Any) -> None:
    c, own, end = planner(), file.settings.axes[axis], file.ends[axis]
    scale, switches, low = float(own.steps_per_mm), file.switches, end.home == "low"
    home.axis = axis
    for motor, row in enumerate(file.settings.motors.rows):
        home.forward |= (row[axis] > 0) << motor
        home.backward |= (row[axis] < 0) << motor
    if axis in file.squared:
        home.racking = round(switches.racking * scale)
    home.offset = offsets
    source = "HOME" if end.homing_switch == "home" else "LIMIT_LOW" if low else "LIMIT_HIGH"
    home.source = getattr(c, f"PASSO_TRIGGER_SOURCE_{source}")
    home.distance = round(SEEK * end.travel * scale) * (-1 if low else 1)
    home.pull_off = round(switches.pull_off * scale)
    home.back_off = max(1, home.pull_off)
    home.speed = q32(Fraction(min(switches.seek, float(own.speed)) * scale))
    home.slow_speed = q32(Fraction(min(switches.speed, float(own.speed)) * scale))
    limits = file.settings.limits()
    along = [float(limit.acceleration) / abs(way[axis]) for way, limit in limits if way[axis]]
    home.acceleration = q32(Fraction(min(along) * scale))
    home.position = 0 if low else round(end.travel * scale)
