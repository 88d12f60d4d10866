# SPDX-License-Identifier: MIT
"""Encoders and spindles at the pins of an engine, for `passo console`: those of sim/engine/passo_rig.h."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from passo.engine import Engine
from passo.native import ffi
from passo.pair_engine import PairEngine
from passo.registers import CHANNEL_ENCODER_FILTER_FILTER_RESET as FILTER
from passo.rig import CHANGES_PER_DRAIN, RATIO_ONE, gap_of, interval_of, most
from passo.setup_outputs import COUNT_CLOCKS_MIN

NUMBER = r"(\d{1,9}(?:\.\d{1,9})?)"
ENCODER = re.compile(rf"(\d{{1,2}}):{NUMBER}")
SPINDLE = re.compile(rf"(\d{{1,2}}):{NUMBER}:(\d{{1,5}})")
COUNTS_PER_TURN = range(4, 65536)
SHAFTS_MAX = most("wheel")


@dataclass(frozen=True)
class Shaft:
    """The encoder of an axis, which follows its steps, or of a spindle, which turns by itself."""

    axis: int  # channel * axes + axis
    counts_per_step: Fraction = Fraction(0)
    rpm: Fraction = Fraction(0)  # of a spindle
    counts_per_turn: int = 0


def read_encoder(text: str) -> Shaft:
    """An encoder as users write it: 0:4 has 4 counts per step of axis 0."""
    match = ENCODER.fullmatch(text)
    if not match or not round(Fraction(match[2]) * RATIO_ONE):
        raise ValueError(f"{text}: an encoder is AXIS:COUNTS_PER_STEP, above 0")
    return Shaft(int(match[1]), Fraction(match[2]))


def read_spindle(text: str, clock_hz: int) -> Shaft:
    """A spindle as users write it: 2:600:4000 turns at 600 rpm, with 4000 counts per turn."""
    match = SPINDLE.fullmatch(text)
    if not match or not Fraction(match[2]) or int(match[3]) not in COUNTS_PER_TURN:
        raise ValueError(
            f"{text}: a spindle is AXIS:RPM:COUNTS_PER_TURN, with "
            f"{COUNTS_PER_TURN.start} to {COUNTS_PER_TURN.stop - 1} counts"
        )
    shaft = Shaft(int(match[1]), rpm=Fraction(match[2]), counts_per_turn=int(match[3]))
    clocks = clock_hz * 60 / (shaft.rpm * shaft.counts_per_turn)
    if clocks < COUNT_CLOCKS_MIN:
        raise ValueError(
            f"{text}: one count every {float(clocks):.3g} clocks; must be at least {COUNT_CLOCKS_MIN}"
        )
    return shaft


class Shafts:
    """Encoders and spindles at an engine, or equal ones at both of a pair."""

    def __init__(self, engine: Engine | PairEngine, shafts: Sequence[Shaft]):
        config = ffi().new("struct passo_rig_config *")
        config.seed, config.axes = 1, engine.parameters.channels * engine.parameters.axes
        for number, shaft in enumerate(shafts):
            wheel = {"axis": shaft.axis, "gap": gap_of(FILTER), "per_turn": shaft.counts_per_turn}
            if shaft.rpm:
                wheel["interval"] = interval_of(engine.clock_hz, shaft.rpm, shaft.counts_per_turn)
            else:
                wheel["ratio"] = round(shaft.counts_per_step * RATIO_ONE)
            config.wheel[number] = wheel
        config.wheels = len(shafts)
        self._rigs = engine.attach(config)
        self._followers = {shaft.axis: i for i, shaft in enumerate(shafts) if not shaft.rpm}
        self._changes = ffi().new("struct passo_rig_change[]", CHANGES_PER_DRAIN)

    def slip(self, axis: int, counts: int) -> bool:
        """Turn an encoder against its axis; whether the axis has one."""
        if axis not in self._followers:
            return False
        for c, rig in self._rigs:
            c.passo_rig_slip(rig, self._followers[axis], counts)
        return True

    def forget(self) -> None:
        """Drop the record of what the spindles did, or it grows."""
        for c, rig in self._rigs:
            while c.passo_rig_drain(rig, self._changes, CHANGES_PER_DRAIN):
                pass
