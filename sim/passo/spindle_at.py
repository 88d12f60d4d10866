# SPDX-License-Identifier: MIT
"""The spindle of a machine file at the pins of an engine, or of a pair: sim/engine/rig_spindle.c."""

import numpy as np

from passo.engine import Engine
from passo.grbl_setup import add_encoders, spindle_wheel
from passo.machine_file import MachineFile
from passo.native import ffi
from passo.pair_engine import PairEngine
from passo.rig import CHANGE, CHANGES_PER_DRAIN


class SpindleAt:
    """A spindle that outputs 0 and 1 turn on and reverse, with the encoders of the motors."""

    def __init__(self, engine: Engine | PairEngine, machine: MachineFile, seed: int = 1):
        config = ffi().new("struct passo_rig_config *")
        config.seed, config.axes = seed, engine.parameters.axes
        add_encoders(config, machine)
        self._wheel = config.wheels
        config.wheels += 1
        config.wheel[self._wheel] = spindle_wheel(machine)
        self._rigs = engine.attach(config)
        self._changes = ffi().new("struct passo_rig_change[]", CHANGES_PER_DRAIN)
        self._found = [np.empty(0, CHANGE)]

    def drive(self, power: int) -> None:
        """Ask for a share of the greatest speed, in 1/65535, and keep what the encoder did."""
        changes = self._changes
        for number, (c, rig) in enumerate(self._rigs):
            c.passo_rig_drive(rig, self._wheel, power + (power > 0))
            while count := c.passo_rig_drain(rig, changes, CHANGES_PER_DRAIN):
                if number == 0:
                    self._found.append(np.frombuffer(ffi().buffer(changes), CHANGE, count).copy())

    def changes(self) -> np.ndarray:
        """The changes (CHANGE) of the pins of the encoder."""
        self.drive(0)
        return np.concatenate(self._found)
