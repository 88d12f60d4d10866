# SPDX-License-Identifier: MIT
"""The spindle of a machine file at the pins of an engine, or of a pair: sim/engine/rig_spindle.c."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from passo.engine import Engine
from passo.grbl_setup import add_encoders, core_for, machine_at, rig_config, spindle_wheel
from passo.machine_file import MachineFile
from passo.native import ffi
from passo.pair_engine import PairEngine
from passo.rig import CHANGE, CHANGES_PER_DRAIN
from passo.run import open_engine


class SpindleAt:
    """A spindle that outputs 0 and 1 turn on and reverse, with the encoders of the motors."""

    def __init__(self, engine: Engine | PairEngine, machine: MachineFile, seed: int = 1, config: Any = None):
        """`config`: a `struct passo_rig_config` with the rest of the machine, whose encoders it has."""
        if config is None:
            config = ffi().new("struct passo_rig_config *")
            config.axes = engine.parameters.axes
            add_encoders(config, machine)
        config.seed = seed
        self._wheel = config.wheels
        config.wheels += 1
        config.wheel[self._wheel] = spindle_wheel(machine)
        self._rigs = engine.attach(config)
        self._changes = ffi().new("struct passo_rig_change[]", CHANGES_PER_DRAIN)
        self._found = [np.empty(0, CHANGE)]

    def drive(self, power: int, keep: bool = True) -> None:
        """Ask for a share of the greatest speed, in 1/65535, and keep what the encoder did, or forget it."""
        changes = self._changes
        for number, (c, rig) in enumerate(self._rigs):
            c.passo_rig_drive(rig, self._wheel, power + (power > 0))
            while count := c.passo_rig_drain(rig, changes, CHANGES_PER_DRAIN):
                if keep and number == 0:
                    self._found.append(np.frombuffer(ffi().buffer(changes), CHANGE, count).copy())

    @property
    def is_at_speed(self) -> bool:
        """Whether it turns as it was asked to."""
        c, rig = self._rigs[0]
        return c.passo_rig_at_speed(rig, self._wheel)

    def changes(self) -> np.ndarray:
        """The changes (CHANGE) of the pins of the encoder."""
        self.drive(0)
        return np.concatenate(self._found)


@contextmanager
def turning_machine_at(name: str, machine: MachineFile) -> Iterator[tuple[Any, SpindleAt | None]]:
    """An engine with the machine at its pins, and its spindle, if that has an encoder."""
    if not machine.turns:
        with machine_at(name, machine) as engine:
            yield engine, None
        return
    with open_engine(name, core_for(machine), machine.clock_hz) as engine:
        yield engine, SpindleAt(engine, machine, config=rig_config(engine, machine))
