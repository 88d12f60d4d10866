# SPDX-License-Identifier: MIT
"""The whole core behind its SPI pins, operated by the host's own code and compared with the C model.

    @core_test
    def motion_ends(core: Core) -> None:
        channel = core.channel()
        channel.lines(Line(100, (100, -50), last=True))
        channel.ramps(Ramp(ONE // 16, 13), Ramp(0, 13, last=True))
        channel.start()
        core.wait_end()

Such a test is plain code in its own thread, because passo.link and passo.host are not coroutines.
Simulated time passes in `run`, `transfer` and what is built on them. Each of these ends with a comparison of
all pins on all clocks up to now; the first difference is an error.
"""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self, TextIO

import numpy as np
from cocotb.handle import HierarchyObject
from passo import registers as r
from passo.cocotb.clocks import PERIOD, Clocks, read
from passo.cocotb.host import Host, plain_test, wait
from passo.cocotb.pulses import PinTiming
from passo.cocotb.thread import Thread
from passo.host import Channel, read_parameters
from passo.judge import COLUMNS, Judge
from passo.link import Link
from passo.plan import Plan
from passo.registers import Shape

from tests.helpers import closed_form
from tests.helpers.closed_form import HALF as V_MAX
from tests.helpers.closed_form import ONE

__all__ = ["ONE", "V_MAX", "Core", "CoreChannel", "Line", "PinTiming", "Ramp", "Shape", "core_test"]


class Line(closed_form.Line):
    """A line command."""

    def words(self) -> list[int]:
        """What is pushed."""
        directions = sum((n < 0) << axis for axis, n in enumerate(self.steps))
        return [self.last | self.endless << 1 | directions << 8, self.substeps, *map(abs, self.steps)]


class Ramp(closed_form.Ramp):
    """A ramp command."""

    def words(self) -> list[int]:
        """What is pushed."""
        control = self.last | self.now << 1 | self.mirror << 2 | self.shape << 4
        pairs = (self.velocity_end >> 32 << 16 | control, self.velocity_end & 0xFFFFFFFF)
        return [*pairs, self.ticks, self.progress_step >> 32, self.progress_step & 0xFFFFFFFF]


def planned(plan: Plan, axes: int) -> tuple[Line, list[Ramp]]:
    """A plan as commands."""
    signs = [-1 if plan.line.directions >> axis & 1 else 1 for axis in range(axes)]
    steps = tuple(sign * plan.line.steps[axis] for axis, sign in enumerate(signs))
    ramps = [Ramp(c.velocity_end, c.ticks, Shape(c.shape), c.mirror, c.last, c.now) for c in plan.ramps]
    return Line(plan.line.substeps, steps, plan.line.last), ramps


@dataclass
class Record:
    """What is recorded of the pins, and how far it was compared: of all tests of one simulation, because a
    reset does not touch everything."""

    log: TextIO
    unread: str = ""
    judge: Judge | None = None


@functools.cache
def _record() -> Record:
    return Record(Path("pins.log").open())


class Core(Host):
    """The core as an engine for passo.link; `parameters` are what the core says of itself."""

    def __init__(self, dut: HierarchyObject, thread: Thread, clocks: Clocks) -> None:
        super().__init__(dut, thread, clocks)
        self.clock_hz = 1_280_000  # of plans: 10000 ticks per second
        self.started = 0  # clock
        self._rows: list[np.ndarray] = []
        self._running: list[tuple[int, int]] = [(0, 0)]  # clocks and levels of all channels
        self._record: Record
        self._first = 0  # clock

    @classmethod
    async def begin(cls, dut: HierarchyObject, thread: Thread) -> Self:
        """Reset; return on the falling edge at its end."""
        core = await super().begin(dut, thread)
        core._record, core._first = _record(), core.clock
        return core

    def identify(self) -> None:
        """Read the parameters of the core and start the comparison."""
        self.link = Link(self)
        self.parameters = read_parameters(self.link)
        self.axes, self.tick = self.parameters.axes, 1 << self.parameters.tick_log2
        if self._record.judge is None:
            self._record.judge = Judge(self.parameters)
        else:
            self._forget_settings()
        self.compare()

    def _forget_settings(self) -> None:
        """Restore the initial pin settings, which a reset does not change."""
        for number in range(self.parameters.channels):
            channel = self.channel(number)
            channel.times(PinTiming())
            channel.pins(PinTiming(), enable=False)
            if self.parameters.inputs:
                channel.link.write(channel.base + r.CHANNEL_PROBE, 0)
                for axis in range(self.axes):
                    channel.link.write(channel.axis_base(axis) + r.AXIS_INPUTS, 0)
        if self.parameters.inputs:
            self.link.write(r.ADDRESS_INPUT_FILTER, 0)

    def channel(self, number: int = 0) -> "CoreChannel":
        """One channel."""
        return CoreChannel(self, number)

    # time

    @property
    def clock(self) -> int:
        """Clocks since the first reset."""
        return read(self.dut.clock)

    def run_quarters(self, count: int) -> None:
        """Let quarters of a clock pass: after a falling edge the first has none."""
        self._thread.wait(wait(count * PERIOD // 4))

    def sync(self, level: bool) -> None:
        """Set the sync input."""
        self.started = self.clock
        self.set("sync", int(level))

    def reset(self, clocks: int) -> None:
        """Reset the core for a number of clocks."""

        async def pulse() -> None:
            self.dut.rst.value = 1
            await wait(clocks * PERIOD)
            self.dut.rst.value = 0

        self._thread.wait(pulse())
        self.compare()

    def is_running(self, channel: int = 0) -> bool:
        """Level of the pin `running`."""
        return bool(read(self.dut.running) >> channel & 1)

    def wait_end(self, channel: int = 0, limit: int = 100_000) -> None:
        """Wait until the last motion and its last pulse have ended."""
        self.run_until(lambda: self.motions(channel, self.started), limit)
        self.run(16)

    # comparison

    def compare(self) -> None:
        """Compare all pins up to now with the model; the error is the first difference."""
        record = self._record
        if record.judge is None:
            return
        *lines, record.unread = (record.unread + record.log.read()).split("\n")
        text = " ".join(lines)
        if "x" in text.lower():
            line = next(line for line in lines if "x" in line.lower())
            raise AssertionError(f"X at a pin: {dict(zip(COLUMNS, line.split(), strict=True))}")
        rows = np.fromstring(text, dtype=np.uint64, sep=" ").reshape(-1, len(COLUMNS))
        record.judge.follow(rows, self.clock)
        rows = rows[rows[:, 0] > self._first]
        self._rows.append(rows)
        for clock, level in rows[:, [0, COLUMNS.index("running")]].tolist():
            if level != self._running[-1][1]:
                self._running.append((clock - 1, level))

    def end(self) -> None:
        """Compare the rest and log a summary."""
        self.run(200)
        super().end()
        self.dut._log.info(f"{self.clock} clocks compared, {self._record.judge.summary()}")

    # what was recorded; the clock of a change is the one after whose rising edge the pin shows it

    def changes(self, signal: str, bit: int, since: int = 0) -> list[tuple[int, int]]:
        """Clocks and levels of all changes of an output pin after a clock."""
        rows = np.concatenate(self._rows)
        levels = (rows[:, COLUMNS.index(signal)] >> np.uint64(bit) & np.uint64(1)).astype(np.int8)
        clocks = rows[:, 0].astype(np.int64) - 1
        at = np.flatnonzero(np.diff(levels)) + 1
        return [(int(clocks[i]), int(levels[i])) for i in at if clocks[i] > since]

    def motions(self, channel: int = 0, since: int = 0) -> list[tuple[int, int]]:
        """Rise and fall of `running` of each completed motion that started after a clock."""
        found, begin = [], None
        for clock, levels in self._running:
            level = levels >> channel & 1
            if level and begin is None:
                begin = clock
            elif not level and begin is not None:
                if begin > since:
                    found.append((begin, clock))
                begin = None
        return found

    def motions_begun(self, since: int = 0) -> list[int]:
        """Clocks after a clock on which `running` of any channel rose, and still is or was high."""
        return [clock for clock, level in self._running if level and clock > since]

    def began(self) -> int:
        """Clock on which `running` rose last."""
        return max(clock for clock, level in self._running if level)

    def steps(self, axis: int = 0, since: int = 0) -> list[int]:
        """Clocks of the rising edges of STEP of bit `axis`."""
        return [clock for clock, level in self.changes("step", axis, since) if level]


class CoreChannel(Channel):
    """A channel of the core that accepts the Line and Ramp of the tests."""

    def __init__(self, core: Core, number: int):
        super().__init__(core.link, core.parameters, number)
        self.core = core

    def lines(self, *lines: Line, outputs: Sequence[r.LineOutputWord] = ()) -> None:
        """Push lines, with OUTPUTS each with its output."""
        self.push_line_words([line.words() for line in lines], outputs)

    def ramps(self, *ramps: Ramp) -> None:
        """Push ramps."""
        self._push(r.CHANNEL_RAMP, [ramp.words() for ramp in ramps])

    def pins(self, *timings: PinTiming, enable: bool = True) -> None:
        """At rest, set the pins of all axes (one timing for each or one for all) and enable the drives."""
        for axis, timing in enumerate(self._of_all_axes(timings)):
            flags = timing.step_inverted << 1 | timing.direction_inverted << 2 | timing.both_edges << 4
            address = self.axis_base(axis)
            self.link.write(address, flags, timing.high << 16 | timing.low, timing.setup << 16 | timing.hold)
            self.link.write(address + r.AXIS_ENABLE, int(enable))
        self.core.run(8)
        self.core.run_until(lambda: self.state().quiet, 300_000)

    def times(self, *timings: PinTiming) -> None:
        """Set the four times of the pins, at any time."""
        for axis, timing in enumerate(self._of_all_axes(timings)):
            words = timing.high << 16 | timing.low, timing.setup << 16 | timing.hold
            self.link.write(self.axis_base(axis) + r.AXIS_STEP_TIMING, *words)
        self.core.run(8)

    def _of_all_axes(self, timings: Sequence[PinTiming]) -> Sequence[PinTiming]:
        return timings if len(timings) > 1 else [*timings] * self.core.axes

    def start(self) -> None:
        """Let the channel start its motion."""
        self.core.started = self.core.clock
        super().start()

    def rest(self) -> None:
        """Disable the start of motions."""
        self.link.write(r.ADDRESS_RUN, 0)


def core_test(body: Callable[[Core], None]) -> Any:
    """Make a cocotb test from plain code."""

    def whole(core: Core) -> None:
        core.identify()
        body(core)
        core.end()

    return plain_test(Core.begin, body, whole)
