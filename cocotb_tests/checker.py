# SPDX-License-Identifier: MIT
"""Watches STEP and DIR pins and stops the test at the first violation of a pin timing.

    checker = PulseChecker(clocks, dut.step, dut.dir, [PinTiming(high=2, low=3)] * AXES)
    ...
    dut._log.info(checker.finish())
    assert checker.positions == [...]

It is driven by changes of the pins, so that watching costs nothing while they rest.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import cocotb
from cocotb.triggers import ValueChange

from cocotb_tests.bench import Clocks, Signal, read


@dataclass(frozen=True)
class PinTiming:
    """What is set for the pins of an axis; times in clocks, 0 counts as 1."""

    high: int = 1
    low: int = 1
    setup: int = 1
    hold: int = 1
    both_edges: bool = False
    step_inverted: bool = False
    direction_inverted: bool = False

    def level(self, active: bool) -> int:
        """How long STEP stays active or inactive at least."""
        return max(1, self.high if active else self.low)

    @property
    def busy(self) -> int:
        """Shortest time from an active edge to the next, both_edges apart."""
        return self.level(True) + self.level(False)


class PulseError(AssertionError):
    """A pin broke its timing."""

    def __init__(self, clock: int, axis: int, signal: str, expected: str, actual: str) -> None:
        super().__init__(f"clock {clock}, axis {axis}, {signal}: expected {expected}, actual {actual}")
        self.clock, self.axis, self.signal = clock, axis, signal


@dataclass
class _Pins:
    """One axis as seen at its pins; -1 = negative direction."""

    timing: PinTiming
    active: bool = False
    direction: int = 1
    stepped: int | None = None  # clock of the last step
    moved: int | None = None  # of the last change of STEP
    turned: int | None = None  # of the last change of DIR
    turns: int = 0
    steps: list[tuple[int, int]] = field(default_factory=list)


class PulseChecker:
    """Checks the pins of any number of axes, from the moment it is made to `finish`.

    A violation raises PulseError inside the simulation, which fails the running test at once. Rules, per axis:

    - `high`: STEP is active for exactly so long; with both_edges each active level lasts at least so long
    - `low`: STEP is inactive for at least so long
    - `setup`: DIR has been stable for so long at each step
    - `hold`: DIR stays stable until so long after the low time that follows a step (with both_edges: after the
      time of the level that begins with the step)
    - pins change on rising clock edges only and are never X

    When it is made the pins must stand still; what happened before counts as long ago.
    """

    def __init__(self, clocks: Clocks, step: Signal, direction: Signal, timings: Sequence[PinTiming]) -> None:
        self._clocks = clocks
        self._step, self._dir = step, direction
        self._begin = clocks.now
        self._axes = [_Pins(timing) for timing in timings]
        self._finished = False
        step_bits, dir_bits = read(step), read(direction)
        for axis, pins in enumerate(self._axes):
            pins.active = self._is_active(axis, step_bits)
            pins.direction = self._direction(axis, dir_bits)
            if pins.active and not pins.timing.both_edges:
                raise PulseError(clocks.now, axis, "STEP", "inactive when watching begins", "active")
        self._step_bits, self._dir_bits = step_bits, dir_bits
        cocotb.start_soon(self._watch_step())
        cocotb.start_soon(self._watch_dir())

    # What was seen

    @property
    def positions(self) -> list[int]:
        """Steps up minus steps down, per axis, since the checker was made."""
        return [sum(direction for _, direction in pins.steps) for pins in self._axes]

    def steps(self, axis: int = 0) -> list[tuple[int, int]]:
        """All steps of an axis: (clock, direction), direction 1 or -1."""
        return self._axes[axis].steps

    def direction(self, axis: int = 0) -> int:
        """Direction DIR shows now."""
        return self._axes[axis].direction

    def turns(self, axis: int = 0) -> int:
        """How often DIR changed."""
        return self._axes[axis].turns

    def set_timing(self, axis: int, timing: PinTiming) -> None:
        """Go on with another timing; the axis has to stand, and its pins keep their levels."""
        pins = self._axes[axis]
        pins.timing = timing
        pins.active = self._is_active(axis, self._step_bits)
        pins.direction = self._direction(axis, self._dir_bits)
        pins.stepped = pins.moved = pins.turned = None

    def finish(self) -> str:
        """Stop watching and tell how much was checked; PulseError if a pulse has not ended in time."""
        self._finished = True
        now = self._clocks.now
        for axis, pins in enumerate(self._axes):
            if pins.active and not pins.timing.both_edges and now - pins.moved >= pins.timing.level(True):
                expected = f"active for {pins.timing.level(True)}"
                raise PulseError(now, axis, "STEP", expected, f"still active after {now - pins.moved}")
        steps = ", ".join(
            f"axis {axis}: {sum(d > 0 for _, d in pins.steps)} up {sum(d < 0 for _, d in pins.steps)} down "
            f"{pins.turns} turns"
            for axis, pins in enumerate(self._axes)
        )
        return f"pins checked for {now - self._begin} clocks: {steps}"

    # Watching

    def _is_active(self, axis: int, bits: int) -> bool:
        return bool(bits >> axis & 1) != self._axes[axis].timing.step_inverted

    def _direction(self, axis: int, bits: int) -> int:
        negative = bool(bits >> axis & 1) != self._axes[axis].timing.direction_inverted
        return -1 if negative else 1

    def _look(self, signal: Signal, name: str) -> tuple[int, int]:
        """Return clock and value of a signal that has changed."""
        try:
            clock = self._clocks.edge()
        except ValueError as error:
            raise PulseError(self._clocks.now, -1, name, "change on a rising clock edge", str(error)) from None
        try:
            return clock, read(signal)
        except ValueError:
            raise PulseError(clock, -1, name, "0 or 1", str(signal.value)) from None

    async def _watch_step(self) -> None:
        change = ValueChange(self._step)
        while True:
            await change
            if self._finished:
                return
            clock, bits = self._look(self._step, "STEP")
            changed, self._step_bits = bits ^ self._step_bits, bits
            for axis, pins in enumerate(self._axes):
                if changed >> axis & 1:
                    self._step_changed(clock, axis, pins)

    async def _watch_dir(self) -> None:
        change = ValueChange(self._dir)
        while True:
            await change
            if self._finished:
                return
            clock, bits = self._look(self._dir, "DIR")
            changed, self._dir_bits = bits ^ self._dir_bits, bits
            for axis, pins in enumerate(self._axes):
                if changed >> axis & 1:
                    self._dir_changed(clock, axis, pins)

    def _step_changed(self, clock: int, axis: int, pins: _Pins) -> None:
        timing = pins.timing
        lasted = None if pins.moved is None else clock - pins.moved
        least = timing.level(pins.active)
        name = "step_high" if pins.active else "step_low"
        if pins.active and not timing.both_edges:
            if lasted != least:
                raise PulseError(clock, axis, f"STEP {name}", f"exactly {least}", str(lasted))
        elif lasted is not None and lasted < least:
            raise PulseError(clock, axis, f"STEP {name}", f"at least {least}", str(lasted))
        pins.active = not pins.active
        pins.moved = clock
        if pins.active or timing.both_edges:
            setup = max(1, timing.setup)
            if pins.turned is not None and clock - pins.turned < setup:
                raise PulseError(clock, axis, "DIR dir_setup", f"at least {setup}", str(clock - pins.turned))
            pins.stepped = clock
            pins.steps.append((clock, pins.direction))

    def _dir_changed(self, clock: int, axis: int, pins: _Pins) -> None:
        timing = pins.timing
        if pins.stepped is not None:
            busy = timing.level(pins.active) if timing.both_edges else timing.busy
            least = busy + max(1, timing.hold)
            if clock - pins.stepped < least:
                expected = f"at least {least} after the step ({busy} + hold {max(1, timing.hold)})"
                raise PulseError(clock, axis, "DIR dir_hold", expected, str(clock - pins.stepped))
        pins.direction = -pins.direction
        pins.turned = clock
        pins.turns += 1
