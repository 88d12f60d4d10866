# SPDX-License-Identifier: MIT
"""Compares a core inside a design with the C model: all of its pins, on every clock."""

from typing import ClassVar, Self

import cocotb
import numpy as np
from cocotb.handle import HierarchyObject
from cocotb.triggers import ValueChange

from passo.build import Parameters
from passo.cocotb.clocks import Clocks, Signal, read
from passo.judge import COLUMNS, Judge
from passo.pins import INPUTS, OUTPUTS

_PINS = (*(pin.name for pin in INPUTS), "spi_miso", *(pin.name for pin in OUTPUTS))
_RST = _PINS.index("rst")


class CoreModel:
    """Records the pins of a `passo_spi_top` from the moment it is made, which is before the end of its reset.

    What comes from outside must not change on a rising edge of the clock. A difference is an AssertionError
    with its pin and its clock, counted from the end of the first reset. A reset does not touch everything,
    so that there is one model of a core for all tests of a simulation.
    """

    _all: ClassVar[dict[str, "CoreModel"]] = {}

    def __init__(self, clocks: Clocks, core: HierarchyObject, parameters: Parameters) -> None:
        self._clocks = clocks
        self._before = 0  # rising edges in the tests before
        self._judge = Judge(parameters)
        self._rows: list[list[int]] = []
        self._reset: int | None = None  # the clock before the first one without reset
        self._signals = [getattr(core, name) for name in _PINS]
        self._begin()

    @classmethod
    def of(cls, clocks: Clocks, core: HierarchyObject, parameters: Parameters) -> Self:
        """The model of this core."""
        if core._path not in cls._all:
            cls._all[core._path] = cls(clocks, core, parameters)
        return cls._all[core._path]

    @classmethod
    def go_on(cls, clocks: Clocks) -> None:
        """Go on with all models, as another test begins at the time at which the last one ended."""
        for model in cls._all.values():
            model._keep(model._now + 1)
            model._before = model._now + 1
            model._clocks = clocks
            model._begin()

    def _begin(self) -> None:
        self._levels = [_level(signal) for signal in self._signals]
        self._at = self._now + 1  # rising edge that sees these levels
        for place, signal in enumerate(self._signals):
            cocotb.start_soon(self._watch(place, signal))

    @property
    def _now(self) -> int:
        return self._before + self._clocks.now

    def compare(self) -> None:
        """Compare up to now; DifferenceError at the first difference."""
        if self._at <= self._now:
            self._keep(self._now + 1)
        if self._reset is not None:
            rows = np.array(self._rows, dtype=np.uint64).reshape(-1, len(COLUMNS))
            self._rows.clear()
            self._judge.follow(rows, self._now - self._reset)

    def summary(self) -> str:
        """What was compared so far."""
        return self._judge.summary()

    async def _watch(self, place: int, signal: Signal) -> None:
        change = ValueChange(signal)
        while True:
            await change
            self._keep(self._now + 1)
            self._levels[place] = _level(signal)

    def _keep(self, following: int) -> None:
        """The levels so far were seen by a rising edge, unless they are followed by others before it."""
        if following == self._at:
            return
        if self._reset is None and self._levels[_RST] == 0:
            self._reset = self._at - 1
        if self._reset is not None:
            if None in self._levels:
                name = _PINS[self._levels.index(None)]
                raise AssertionError(f"clock {self._at - self._reset}: X at the pin {name} of the core")
            levels = [level for level in self._levels if level is not None]
            self._rows.append([self._at - self._reset, *levels])
        self._at = following


def _level(signal: Signal) -> int | None:
    try:
        return read(signal)
    except ValueError:
        return None
