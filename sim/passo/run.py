# SPDX-License-Identifier: MIT
"""Execute a planned motion on an engine like a host: over SPI, keeping the queues filled."""

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from passo.build import Parameters
from passo.driver import Driver
from passo.engine import Engine, model_engine, rtl_engine
from passo.failure import Failure
from passo.host import ChannelState
from passo.move_forms import USER_BANK
from passo.moves import Channels, MoveFile
from passo.moving_channel import PINS, MovingChannel
from passo.native import ffi, planner
from passo.pair_engine import PairEngine
from passo.plan import Plan, table_of
from passo.registers import Cause, State

Steps = tuple[np.ndarray, np.ndarray]  # of an axis: clocks since the start of the motion, and directions
CHUNK = 1_000_000  # clocks between two reports of progress
AXES_OF_CORES = (4, 8)


class RunError(Failure):
    """The motion did not end."""


@dataclass
class Run:
    """Result of a motion."""

    file: MoveFile
    plans: list[Plan]
    pins: np.ndarray  # moving_channel.PINS, one row for each clock on which they change
    state: ChannelState
    positions: list[int]
    matched_edges: int | None  # edges that agree; None: only one engine
    clocks: int  # simulated in total
    seconds: float  # of real time
    canceled: bool = False
    since: int | None = None  # clock from which the channels of the file count; None: the start
    start: int = field(init=False)  # clock at which the motion started
    total_clocks: int = field(init=False)  # length of the motion

    def __post_init__(self) -> None:
        running = np.concatenate([[False], self.pins["running"]])
        rises = self.pins["clock"][running[1:] & ~running[:-1]]
        falls = self.pins["clock"][running[:-1] & ~running[1:]]
        self.start = int(rises[0]) if len(rises) else 0
        self.total_clocks = int(falls.sum()) - int(rises.sum()) if len(rises) == len(falls) else 0

    @property
    def moved_clocks(self) -> int:
        """Up to the end of the motion, or to the last edge of one that has not ended; 0: nothing moved."""
        if self.total_clocks or not self.pins["running"].any():
            return self.total_clocks
        return int(self.pins["clock"][-1]) - self.start

    @property
    def planned_clocks(self) -> int:
        """Length of the motion in the plan."""
        return sum(plan.clocks for plan in self.plans)

    @property
    def late(self) -> int:
        """Clocks from the start of the first channel to that of this one."""
        return 0 if self.since is None else self.start - self.since

    def steps(self, axis: int) -> Steps:
        """Clocks since the start of the motion and directions (1, -1) of all steps of an axis."""
        return self._steps_of([axis])[0]

    def all_steps(self) -> list[Steps]:
        """The same of all axes."""
        return self._steps_of(range(self.file.axes))

    def _steps_of(self, axes: Iterable[int]) -> list[Steps]:
        assert PINS.itemsize == planner().PASSO_PULSES_ROW
        rows, count, found = np.ascontiguousarray(self.pins), len(self.pins), []
        most = (count + 1) // 2
        own = np.empty(most, np.int64), np.empty(most, np.int8)
        clocks, directions = ffi().from_buffer("int64_t[]", own[0]), ffi().from_buffer("int8_t[]", own[1])
        data = ffi().from_buffer("uint8_t[]", rows)
        for axis in axes:
            made = planner().passo_pulses_steps(data, count, self.start, axis, clocks, directions)
            found.append((own[0][:made].copy(), own[1][:made].copy()))
        return found

    def commanded(self, axis: int) -> tuple[int, int]:
        """Commanded steps of an axis over all moves: their sum, and the sum of their magnitudes."""
        steps = [move.steps[axis] for move in self.file.moves]
        return sum(steps), sum(map(abs, steps))

    def problems(self, steps: list[Steps] | None = None) -> list[str]:
        """Deviations from the plan, one sentence each; empty if the motion was exact.

        `steps` are those of all_steps(), if they are known.
        """
        if self.canceled:
            return [f"canceled after {self.moved_clocks} clocks"]
        found = []
        if self.state.cause != Cause.NONE:
            found.append(f"the core stopped: {self.state.cause.name}: {self.state.cause.description}")
        if self.state.drained:
            found.append(f"{self.state.drained} substeps were missing at the end of the profile")
        for axis, (clocks, directions) in enumerate(self.all_steps() if steps is None else steps):
            expected, pulses = self.commanded(axis)
            if len(clocks) != pulses or int(directions.sum(dtype=np.int64)) != expected:
                found.append(f"axis {axis} made {len(clocks)} steps of {pulses}")
            if self.positions[axis] != (expected + 2**31) % 2**32 - 2**31:
                found.append(f"axis {axis} is at {self.positions[axis]}, not at {expected}")
        if not found and self.total_clocks != self.planned_clocks:
            found.append(f"the motion took {self.total_clocks} clocks instead of {self.planned_clocks}")
        return found


def parameters_for(axes: int, channels: int = 1) -> Parameters:
    """Parameters of the core used for a number of axes and channels."""
    if channels > 1:
        return Parameters(channels=channels, axes=axes)
    return Parameters(axes=next(n for n in AXES_OF_CORES if n >= axes))


def parameters_of(channels: Channels) -> Parameters:
    """Parameters of the core used for a move file."""
    return parameters_for(max(file.axes for file in channels.files), channels.files[-1].channel + 1)


def open_engine(name: str, parameters: Parameters, clock_hz: int, waves: bool = False) -> Engine | PairEngine:
    """Create the engine named on the command line: both, rtl or model."""
    if name == "model":
        return model_engine(parameters, clock_hz)
    rtl = rtl_engine(parameters, clock_hz, waves)
    return rtl if name == "rtl" else PairEngine(rtl, model_engine(parameters, clock_hz))


def execute(
    file: MoveFile,
    plans: list[Plan],
    engine: Engine | PairEngine,
    progress: Callable[[int], None] = lambda clocks: None,
) -> Run:
    """Execute the motion of one channel; `progress` is called with the clocks done so far.

    Raises DriverError, RunError.
    """
    (run,) = execute_channels(Channels(file.path, False, (file,)), [plans], engine, progress)
    run.since = None
    return run


def execute_channels(
    channels: Channels,
    plans: list[list[Plan]],
    engine: Engine | PairEngine,
    progress: Callable[[int], None] = lambda clocks: None,
) -> list[Run]:
    """Execute the motions of all channels, as `execute` does; a run for each of them."""
    used: list[MovingChannel] = []
    for file, own in zip(channels.files, plans, strict=True):
        driver = Driver(
            engine, file.clock_hz, engine.parameters, file.channel, beside=used[0].driver if used else None
        )
        used.append(MovingChannel(file, own, driver))

    def collect() -> bool:
        """Store the pin events; return whether the core reports a stop."""
        events = engine.drain()
        for channel in used:
            channel.collect(events)
        return bool(len(events) and events["irq"][-1])

    def advance(clocks: int) -> None:
        while clocks:
            clocks -= engine.run(min(clocks, CHUNK))
            progress(engine.clock - start)
            if collect():
                return

    tick = 1 << engine.parameters.tick_log2

    def go_on() -> None:
        """Run until a channel that moves has something to do."""
        times = []
        for channel in used:
            left = start + channel.planned - engine.clock
            if channel.moves and left < -channels.clock_hz:
                raise RunError(f"timeout: the motion did not end: {channel.driver.state.name}")
            if channel.moves and channel.driver.is_streaming:
                left = min(left, start + channel.hungry() - engine.clock)
            if channel.moves:
                times.append(max(left, channel.driver.idle_clocks, 16 * tick))
        advance(min(times))

    for channel in used:
        channel.configure()
    if table := table_of([plan for own in plans for plan in own]):
        used[0].driver.call("load_table", USER_BANK, table)
    if channels.together:
        for channel in used:
            channel.driver.call("wait_for_sync", True)
    for channel in used:
        channel.driver.stream(channel.source)
    start, began = engine.clock, time.monotonic()
    for channel in used:
        channel.poll()
    if channels.together:
        while any(channel.driver.snapshot().state != State.ARMED for channel in used):
            if engine.clock - start > channels.clock_hz:
                raise RunError("timeout: the motions were not prepared")
            advance(tick)
        start = engine.clock
        engine.sync(True)
    canceled = False
    try:
        while any(channel.moves for channel in used):
            go_on()
            for channel in used:
                channel.poll()
    except KeyboardInterrupt:
        canceled = True
    # The last pulse and a change of DIR may still be in progress.
    pins = [file.pins for file in channels.files]
    advance(8 * max(sum((pin.step_high, pin.step_low, pin.dir_setup, pin.dir_hold)) for pin in pins))
    ends = [(channel.driver.positions(), channel.driver.snapshot()) for channel in used]
    collect()
    runs = [
        Run(
            file=channel.file,
            plans=channel.plans,
            pins=channel.pins,
            state=ChannelState(
                state=State(snapshot.state),
                cause=Cause(snapshot.cause),
                quiet=snapshot.quiet,
                stopping=snapshot.stopping,
                overrun=snapshot.overrun,
                drained=snapshot.drained,
            ),
            positions=positions[: channel.file.axes],
            matched_edges=engine.matched_edges if isinstance(engine, PairEngine) else None,
            clocks=engine.clock - start,
            seconds=time.monotonic() - began,
            canceled=canceled,
        )
        for channel, (positions, snapshot) in zip(used, ends, strict=True)
    ]
    for run in runs:
        run.since = min(other.start for other in runs)
    return runs
