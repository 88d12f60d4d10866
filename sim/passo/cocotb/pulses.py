# SPDX-License-Identifier: MIT
"""Steps as STEP and DIR pins show them, and the timing of these pins.

    checker = PulseChecker(clocks, dut.step, dut.dir, [PinTiming(high=2, low=3)] * AXES)
    ...
    dut._log.info(checker.finish())
    assert checker.positions == [...]

A StepMonitor records the steps, a PulseChecker also stops the test at the first violation of a timing. Both
are driven by changes of the pins, so that watching costs nothing while they rest.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import cocotb
from cocotb.triggers import ValueChange

from passo import moves
from passo.cocotb.clocks import Clocks, Signal, read
from passo.failure import Portable


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

    def pins(self) -> moves.PinTiming:
        """The four times as passo.driver and passo.host take them."""
        return moves.PinTiming(*(max(1, t) for t in (self.high, self.low, self.setup, self.hold)))


class PulseError(Portable, AssertionError):
    """A pin broke its timing; axis -1 is all pins of one kind."""

    def __init__(self, clock: int, axis: int, signal: str, expected: str, actual: object) -> None:
        super().__init__(f"clock {clock}, axis {axis}, {signal}: expected {expected}, actual {actual}")
        self.clock, self.axis, self.signal = clock, axis, signal


@dataclass
class AxisSteps:
    """The steps of one axis, from every change of its pins."""

    axis: int
    timing: PinTiming
    active: bool = False
    direction: int = 1  # -1 = negative
    turns: int = 0
    steps: list[tuple[int, int]] = field(default_factory=list)  # clock, direction

    def step_level(self, bit: int) -> bool:
        """Whether this level of the STEP pin is the active one."""
        return bool(bit) != self.timing.step_inverted

    def dir_level(self, bit: int) -> int:
        """Direction that this level of the DIR pin means."""
        return -1 if bool(bit) != self.timing.direction_inverted else 1

    def stand(self, timing: PinTiming, step_bit: int, dir_bit: int) -> None:
        """Begin, or continue with another timing, from stable pins."""
        self.timing = timing
        self.active = self.step_level(step_bit)
        self.direction = self.dir_level(dir_bit)

    def step_changed(self, clock: int) -> None:
        """STEP has the other level from this clock on."""
        self.active = not self.active
        if self.active or self.timing.both_edges:
            self.steps.append((clock, self.direction))

    def dir_changed(self, clock: int) -> None:
        """DIR has the other level from this clock on."""
        self.direction = -self.direction
        self.turns += 1

    def finish(self, clock: int) -> None:
        """Nothing has changed up to this clock."""


@dataclass
class AxisPins(AxisSteps):
    """The rules for one axis. It gets every change of its pins, and raises PulseError.

    - step_high: STEP is active for exactly so long; with both_edges each active level lasts at least so long
    - step_low: STEP is inactive for at least so long
    - dir_setup: DIR has been stable for so long at each step
    - dir_hold: DIR stays stable until so long after the low time that follows a step; with both_edges after
      the time of the level that begins with the step

    What was before `stand` counts as long ago.
    """

    # clocks of the last step, the last change of STEP and of DIR
    stepped: int | None = None
    moved: int | None = None
    turned: int | None = None

    def stand(self, timing: PinTiming, step_bit: int, dir_bit: int) -> None:
        super().stand(timing, step_bit, dir_bit)
        self.stepped = self.moved = self.turned = None

    def step_changed(self, clock: int) -> None:
        lasted = None if self.moved is None else clock - self.moved
        due = self.timing.level(self.active)
        if self.active and not self.timing.both_edges:
            if lasted != due:
                raise PulseError(clock, self.axis, "STEP step_high", f"exactly {due}", lasted)
        elif lasted is not None and lasted < due:
            name = "STEP step_high" if self.active else "STEP step_low"
            raise PulseError(clock, self.axis, name, f"at least {due}", lasted)
        self.moved = clock
        if not self.active or self.timing.both_edges:
            setup = max(1, self.timing.setup)
            if self.turned is not None and clock - self.turned < setup:
                raise PulseError(clock, self.axis, "DIR dir_setup", f"at least {setup}", clock - self.turned)
            self.stepped = clock
        super().step_changed(clock)

    def dir_changed(self, clock: int) -> None:
        if self.stepped is not None:
            busy = self.timing.level(self.active) if self.timing.both_edges else self.timing.busy
            hold = max(1, self.timing.hold)
            if clock - self.stepped < busy + hold:
                expected = f"at least {busy} + {hold} after the step"
                raise PulseError(clock, self.axis, "DIR dir_hold", expected, clock - self.stepped)
        self.turned = clock
        super().dir_changed(clock)

    def finish(self, clock: int) -> None:
        due = self.timing.level(True)
        if self.active and not self.timing.both_edges and (self.moved is None or clock - self.moved >= due):
            lasts = "longer" if self.moved is None else f"{clock - self.moved} and no end"
            raise PulseError(clock, self.axis, "STEP step_high", f"exactly {due}", lasts)


class StepMonitor:
    """Records the steps of any number of axes, from the moment it is made to `finish`.

    `step` and `direction` have one bit per axis, and `timings` is theirs; of these only polarities and mode
    count here. A pin that is X or changes off the rising clock edges raises PulseError inside the simulation,
    which fails the running test immediately.
    """

    AXIS: ClassVar[type[AxisSteps]] = AxisSteps

    def __init__(self, clocks: Clocks, step: Signal, direction: Signal, timings: Sequence[PinTiming]) -> None:
        self._clocks = clocks
        self._begin = clocks.now
        self._finished = False
        self._step_bits, self._dir_bits = read(step), read(direction)
        self._axes = [self.AXIS(axis, timing) for axis, timing in enumerate(timings)]
        for pins, timing in zip(self._axes, timings, strict=True):
            self.set_timing(pins.axis, timing)
        cocotb.start_soon(self._watch(step, "STEP", self._step_changed))
        cocotb.start_soon(self._watch(direction, "DIR", self._dir_changed))

    @property
    def positions(self) -> list[int]:
        """Steps up minus steps down, per axis, since this was made."""
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
        self._axes[axis].stand(timing, self._step_bits >> axis & 1, self._dir_bits >> axis & 1)

    def finish(self) -> str:
        """Stop watching and tell how much was seen; by a checker, PulseError if a pulse has not ended."""
        self._finished = True
        now = self._clocks.now
        told = []
        for pins in self._axes:
            pins.finish(now)
            up = sum(direction > 0 for _, direction in pins.steps)
            told.append(f"axis {pins.axis}: {up} up {len(pins.steps) - up} down {pins.turns} turns")
        return f"pins watched for {now - self._begin} clocks: {', '.join(told)}"

    async def _watch(self, signal: Signal, name: str, changed: Callable[[int, int], None]) -> None:
        change = ValueChange(signal)
        while True:
            await change
            if self._finished:
                return
            try:
                clock = self._clocks.edge()
            except ValueError as error:
                raise PulseError(self._clocks.now, -1, name, "change on a clock edge", error) from None
            try:
                bits = read(signal)
            except ValueError:
                raise PulseError(clock, -1, name, "0 or 1", signal.value) from None
            changed(clock, bits)

    def _step_changed(self, clock: int, bits: int) -> None:
        changed, self._step_bits = bits ^ self._step_bits, bits
        for pins in self._axes:
            if changed >> pins.axis & 1:
                pins.step_changed(clock)

    def _dir_changed(self, clock: int, bits: int) -> None:
        changed, self._dir_bits = bits ^ self._dir_bits, bits
        for pins in self._axes:
            if changed >> pins.axis & 1:
                pins.dir_changed(clock)


class PulseChecker(StepMonitor):
    """The same, and a violation of the rules of AxisPins raises PulseError as well.

    The pins have to stand when the checker is made.
    """

    AXIS = AxisPins

    def __init__(self, clocks: Clocks, step: Signal, direction: Signal, timings: Sequence[PinTiming]) -> None:
        super().__init__(clocks, step, direction, timings)
        for pins in self._axes:
            if pins.active and not pins.timing.both_edges:
                raise PulseError(clocks.now, pins.axis, "STEP", "inactive at the beginning", "active")
