# SPDX-License-Identifier: MIT
"""The machine of a move file at the pins of an engine: sim/engine/passo_rig.h."""

from typing import Any

import numpy as np

from passo.engine import NUMBERS, Engine
from passo.move_forms import EventEstop, EventInput, EventSlip
from passo.native import ffi, planner
from passo.pair_engine import PairEngine
from passo.setup import Event, Setup

RATIO_ONE = 1 << 16
COUNT_GAP = 2  # clocks from count to count beyond what the filter needs
CHANGE = np.dtype([("clock", "u8"), ("input", "u8"), ("levels", "u8")])
CHANGES_PER_DRAIN = 4096


def most(name: str) -> int:
    """How many wires, wheels or events a rig can have."""
    return dict(ffi().typeof("struct passo_rig_config").fields)[name].type.length


def gap_of(encoder_filter: int) -> int:
    """Clocks from a count to the next, so that the filter lets both pass."""
    return encoder_filter + COUNT_GAP


def interval_of(clock_hz: int, rpm: Any, counts_per_turn: int) -> int:
    """Clocks from count to count of a spindle, in units of 1 / RATIO_ONE."""
    return round(clock_hz * 60 * RATIO_ONE / (rpm * counts_per_turn))


def config_of(setup: Setup, axes: int, pins: int, clock_hz: int) -> Any:
    """The `struct passo_rig_config`; the last wire is e-stop."""
    c = ffi().new("struct passo_rig_config *")
    c.seed, c.axes = setup.settings.seed, pins
    for axis in range(axes):
        c.start[axis] = setup.start(axis)
    for number, one in enumerate(setup.inputs):
        c.wire[number] = {
            "input": NUMBERS[one.role],
            "bit": 0 if one.role == "probe" else one.axis,
            "inverted": one.polarity == "low",
            "is_switch": one.at is not None,
            "above": one.side == "above",
            "axis": one.axis,
            "at": int(one.at.value) if one.at else 0,
            "hysteresis": one.hysteresis,
            "bounce": round(one.bounce * clock_hz),
            "every": round(clock_hz / one.noise) if one.noise else 0,
            "glitch": max(1, round(one.glitch * clock_hz)),
        }
    estop = len(setup.inputs)
    c.wire[estop] = {"input": NUMBERS["estop_n"], "inverted": True}
    c.wires = estop + 1
    for number, encoder in enumerate(setup.encoders):
        ratio = round(encoder.counts_per_step * RATIO_ONE)
        c.wheel[number] = {"axis": encoder.axis, "ratio": ratio, "gap": gap_of(encoder.filter)}
    if spindle := setup.spindle:
        c.wheel[len(setup.encoders)] = {
            "axis": setup.spindle_axis,
            "interval": interval_of(clock_hz, spindle.rpm, spindle.counts_per_turn),
            "wander": spindle.wander * RATIO_ONE // 100,
            "per_turn": spindle.counts_per_turn,
        }
    c.wheels = len(setup.encoders) + bool(setup.spindle)
    for number, event in enumerate(setup.events):
        c.event[number] = _when(event, setup, clock_hz) | _what(event, setup, estop, clock_hz)
    c.events = len(setup.events)
    return c


def _when(event: Event, setup: Setup, clock_hz: int) -> dict[str, Any]:
    c = planner()
    if event.time is not None:
        return {"when": c.PASSO_RIG_TIME, "clocks": round(event.time * clock_hz)}
    if event.position is not None:
        return {"when": c.PASSO_RIG_POSITION, "axis": event.at_axis, "position": int(event.position.value)}
    edge = c.PASSO_RIG_FALLING if event.falling else c.PASSO_RIG_RISING
    return {"when": edge, "source": setup.find(event.trigger, event.at_axis)}


def _what(event: Event, setup: Setup, estop: int, clock_hz: int) -> dict[str, Any]:
    c = planner()
    if isinstance(event, EventSlip):
        wheel = [encoder.axis for encoder in setup.encoders].index(event.axis)
        return {"what": c.PASSO_RIG_SLIP, "target": wheel, "counts": event.counts}
    if isinstance(event, EventInput | EventEstop):
        is_estop = isinstance(event, EventEstop)
        return {
            "what": c.PASSO_RIG_ACTIVE if is_estop or event.active else c.PASSO_RIG_INACTIVE,
            "target": estop if is_estop else setup.find(event.input, event.axis),
            "length": max(1, round(event.length * clock_hz)) if event.length is not None else 0,
        }
    return {"what": c.PASSO_RIG_CALL}


class Rig:
    """The machine at an engine, or equal ones at both of a pair."""

    def __init__(self, engine: Engine | PairEngine, setup: Setup, axes: int):
        parameters = engine.parameters
        config = config_of(setup, axes, parameters.channels * parameters.axes, engine.clock_hz)
        self.setup = setup
        self._rigs = engine.attach(config)  # of a pair the first one speaks for both
        self._changes = ffi().new("struct passo_rig_change[]", CHANGES_PER_DRAIN)

    def moment(self, event: int) -> int | None:
        """Clock of an event, from 0, if it has come."""
        clock = self._c.passo_rig_moment(self._rig, event).clock
        return None if clock == (1 << 64) - 1 else clock

    def moment_positions(self, event: int, axes: int) -> list[int]:
        """Positions of the machine then."""
        return list(self._c.passo_rig_moment(self._rig, event).positions[0:axes])

    def position(self, axis: int) -> int:
        """Where an axis of the machine is."""
        return self._c.passo_rig_position(self._rig, axis)

    def changes(self) -> np.ndarray:
        """The changes of inputs (CHANGE) since the last call."""
        chunks = [np.empty(0, CHANGE)]
        for c, rig in self._rigs:
            mine = [np.empty(0, CHANGE)]
            while count := c.passo_rig_drain(rig, self._changes, CHANGES_PER_DRAIN):
                mine.append(np.frombuffer(ffi().buffer(self._changes), CHANGE, count).copy())
            chunks = mine if (c, rig) == self._rigs[0] else chunks
        return np.concatenate(chunks)

    @property
    def _c(self) -> Any:
        return self._rigs[0][0]

    @property
    def _rig(self) -> Any:
        return self._rigs[0][1]
