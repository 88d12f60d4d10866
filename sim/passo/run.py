# SPDX-License-Identifier: MIT
"""Execute a planned motion on an engine as a host does: over SPI, keeping the queues filled."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from passo.build import Parameters
from passo.driver import Driver, DriverError, Source
from passo.engine import Engine, PairEngine, model_engine, rtl_engine
from passo.failure import Failure
from passo.host import ChannelState
from passo.move_forms import USER_BANK
from passo.moves import MoveFile
from passo.plan import Plan, table_of
from passo.registers import Cause, State

CHUNK = 1_000_000  # clocks between two reports of progress
SLEWS_PER_SECOND = 20  # of hold and stop, from full speed
AXES_OF_CORES = (4, 8)

# The pins of a single channel that change during a motion.
PINS = np.dtype([("clock", "u8"), ("step", "u1"), ("dir", "u1"), ("running", "?")])


class RunError(Failure):
    """The motion did not end."""


@dataclass
class Run:
    """Result of a motion."""

    file: MoveFile
    plans: list[Plan]
    pins: np.ndarray  # PINS, one row for each clock on which they change
    state: ChannelState
    positions: list[int]
    matched_edges: int | None  # edges that agree; None: only one engine
    clocks: int  # simulated in total
    seconds: float  # of real time
    start: int = field(init=False)  # clock at which the motion started
    total_clocks: int = field(init=False)  # length of the motion

    def __post_init__(self) -> None:
        running = np.concatenate([[False], self.pins["running"]])
        rises = self.pins["clock"][running[1:] & ~running[:-1]]
        falls = self.pins["clock"][running[:-1] & ~running[1:]]
        self.start = int(rises[0]) if len(rises) else 0
        self.total_clocks = int(falls.sum()) - int(rises.sum()) if len(rises) == len(falls) else 0

    def steps(self, axis: int) -> tuple[np.ndarray, np.ndarray]:
        """Clocks since the start of the motion and directions (1, -1) of all steps of an axis."""
        level = self.pins["step"] >> axis & 1
        rising = np.flatnonzero(level & ~np.concatenate([[0], level[:-1]]) & 1)
        negative = self.pins["dir"][rising] >> axis & 1
        return self.pins["clock"][rising].astype(np.int64) - self.start, 1 - 2 * negative.astype(np.int8)

    def commanded(self, axis: int) -> tuple[int, int]:
        """Commanded steps of an axis over all moves: their sum, and the sum of their magnitudes."""
        steps = [move.steps[axis] for move in self.file.moves]
        return sum(steps), sum(map(abs, steps))

    def problems(self) -> list[str]:
        """Deviations from the plan, one sentence each; empty if the motion was exact."""
        found = []
        if self.state.cause != Cause.NONE:
            found.append(f"the core stopped: {self.state.cause.name}: {self.state.cause.description}")
        if self.state.drained:
            found.append(f"{self.state.drained} substeps were missing at the end of the profile")
        for axis in range(self.file.axes):
            expected, pulses = self.commanded(axis)
            clocks, directions = self.steps(axis)
            if len(clocks) != pulses or int(directions.sum(dtype=np.int64)) != expected:
                found.append(f"axis {axis} made {len(clocks)} steps of {pulses}")
            if self.positions[axis] != (expected + 2**31) % 2**32 - 2**31:
                found.append(f"axis {axis} is at {self.positions[axis]}, not at {expected}")
        expected_clocks = sum(plan.clocks for plan in self.plans)
        if not found and self.total_clocks != expected_clocks:
            found.append(f"the motion took {self.total_clocks} clocks instead of {expected_clocks}")
        return found


def parameters_for(axes: int) -> Parameters:
    """Parameters of the core used for a number of axes."""
    return Parameters(axes=next(n for n in AXES_OF_CORES if n >= axes))


def open_engine(name: str, parameters: Parameters, clock_hz: int, waves: bool = False) -> Engine | PairEngine:
    """Create the engine named on the command line: both, rtl or model."""
    if name == "model":
        return model_engine(parameters, clock_hz)
    rtl = rtl_engine(parameters, clock_hz, waves)
    return rtl if name == "rtl" else PairEngine(rtl, model_engine(parameters, clock_hz))


def patience(driver: Driver, source: Source) -> int:
    """Clocks until the queues should be refilled: half of their contents."""
    parameters = driver.engine.parameters
    waiting = (1 << parameters.ramp_queue_log2) - driver.c.snapshot.ramp_room
    ticks = sum(source.ticks[-waiting:]) if waiting else 0
    return max(1, ticks // 2) << parameters.tick_log2


def execute(
    file: MoveFile,
    plans: list[Plan],
    engine: Engine | PairEngine,
    progress: Callable[[int], None] = lambda clocks: None,
) -> Run:
    """Execute the motion; `progress` is called with the clocks done so far. Raises DriverError, RunError."""
    driver = Driver(engine, file.clock_hz, engine.parameters)
    pins: list[np.ndarray] = []

    def collect() -> bool:
        """Store the pin events; return whether the core reports a stop."""
        events = engine.drain()
        compact = np.empty(len(events), PINS)
        for name in PINS.names:
            compact[name] = events[name]
        pins.append(compact)
        return bool(len(events) and events["irq"][-1])

    def advance(clocks: int) -> None:
        while clocks:
            clocks -= engine.run(min(clocks, CHUNK))
            progress(engine.clock - start)
            if collect():
                return

    def poll() -> bool:
        """Poll the driver while it has something to do; return whether there was no fault."""
        try:
            driver.poll()
            while driver.idle_microseconds == 0 and driver.is_moving:
                driver.poll()
        except DriverError:
            if not driver.c.fault:
                raise
            return False  # the state shows the cause
        return True

    for axis in range(file.axes):
        driver.configure_axis(axis, file.pins)
    if table := table_of(plans):
        driver.call("load_table", USER_BANK, table)
    slowest = min(plan.c.velocity_peak for plan in plans)
    slew = driver.clock_hz // SLEWS_PER_SECOND
    driver.call("configure_motion", slew, slew, max(1, slowest >> 16 >> 4))

    tick = 1 << engine.parameters.tick_log2
    planned = sum(plan.clocks for plan in plans)
    source = Source([plan.line for plan in plans], [ramp for plan in plans for ramp in plan.ramps])
    driver.stream(source)
    start, began = engine.clock, time.monotonic()
    while poll() and driver.is_moving:
        left = start + planned - engine.clock
        if left < -file.clock_hz:
            raise RunError(f"the motion did not end in time: {driver.state.name}")
        left = max(left, 16 * tick)
        advance(min(left, patience(driver, source)) if driver.is_streaming else left)
    # The last pulse and a change of DIR may still be in progress.
    advance(8 * sum((file.pins.step_high, file.pins.step_low, file.pins.dir_setup, file.pins.dir_hold)))
    positions = driver.positions()[: file.axes]
    snapshot = driver.snapshot()
    state = ChannelState(
        state=State(snapshot.state),
        cause=Cause(snapshot.cause),
        quiet=snapshot.quiet,
        stopping=snapshot.stopping,
        overrun=snapshot.overrun,
        drained=snapshot.drained,
    )
    collect()
    return Run(
        file=file,
        plans=plans,
        pins=np.concatenate(pins),
        state=state,
        positions=positions,
        matched_edges=engine.matched_edges if isinstance(engine, PairEngine) else None,
        clocks=engine.clock - start,
        seconds=time.monotonic() - began,
    )
