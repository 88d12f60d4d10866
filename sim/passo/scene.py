# SPDX-License-Identifier: MIT
"""Run a move file with a machine: moves, homing and probing in sequence, with events."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from passo.driver import DriverError, Source
from passo.engine import EVENT, NUMBERS, Engine
from passo.move_forms import EventArm, EventOverride, EventUntrack, MachineTrack
from passo.moves import Channels, MoveFileError
from passo.native import ffi
from passo.pair_engine import PairEngine
from passo.registers import Cause, State, TriggerAction, TriggerSource
from passo.rig import Rig
from passo.run import CHUNK, RunError
from passo.scene_driver import SceneDriver, track_of
from passo.scene_plan import Raster, plan_sections
from passo.scene_run import SAMPLE, TRACKED, Happened, Latch, SceneRun, Section, Stop, Tracker
from passo.setup import Event

POLLS_PER_SECOND = 1000
POLL_CLOCKS_MIN = 2000  # some times the length of a frame
SETTLE_CLOCKS = 256
COMMANDS = (
    "hold",
    "resume",
    "override",
    "stop",
    "abort",
    "arm",
    "track",
    "untrack",
)  # events that the host carries out
SPINDLE = [NUMBERS[f"encoder_{line}"] for line in ("a", "b", "index")]  # turns continuously
GIVE_UP_SECONDS = 2  # without a step, a change of an input or an event


class Scene:
    """The host: a driver that is polled every millisecond, and carries out the events that are commands."""

    def __init__(
        self, channels: Channels, engine: Engine | PairEngine, progress: Callable[[int], None] | None = None
    ):
        self.file, self.engine = channels.files[0], engine
        assert channels.setup is not None
        self.setup = channels.setup
        self.clock_hz, self.axes = channels.clock_hz, self.file.axes
        self.poll_clocks = max(self.clock_hz // POLLS_PER_SECOND, POLL_CLOCKS_MIN)
        self.sections = plan_sections(self.file, self.setup, engine.parameters)
        self.driver = SceneDriver(engine, self.clock_hz, engine.parameters)
        self.rig = Rig(engine, self.setup, self.axes)
        self.progress = progress or (lambda _: None)
        self.pins: list[np.ndarray] = []
        self.inputs: list[np.ndarray] = []
        self.samples: list[tuple[Any, ...]] = []
        self.tracked: list[tuple[int, list[int]]] = []
        self.targets = dict.fromkeys(self.setup.with_trackers, 0)
        self.following: dict[int, MachineTrack] = {}  # targets in force, by axis
        self.stops: list[Stop] = []
        self.latches: list[Latch] = []
        self.troubles: list[str] = []
        self.answers: dict[int, int] = {}
        self.armed: int | None = None  # event
        self.held = ""  # the name of an event
        self.source: Source | None = None
        self.raster: Raster | None = None
        self.is_stopped = False
        self.active_at = 0  # clock of the last change of anything

    def run(self) -> SceneRun:
        """Run all of it; raises DriverError, RunError, DifferenceError."""
        self._configure()
        began, start = time.monotonic(), self.engine.clock
        made: list[Section] = []
        for section in self.sections:
            made.append(section)
            self._section(section)
            if section.outcome != "OK":
                break
        self._advance(max(8 * sum(vars(self.file.pins).values()), self.clock_hz // 500))
        trackers = self._settle()
        positions = self.driver.positions()
        self.samples.append(self.driver.sample(self.axes))
        return SceneRun(
            file=self.file,
            setup=self.setup,
            sections=made,
            pins=np.concatenate([np.empty(0, EVENT), *self.pins]),
            inputs=np.concatenate(self.inputs),
            samples=np.array(self.samples, SAMPLE),
            events=[self._happened(number) for number in range(len(self.setup.events))],
            stops=self.stops,
            latches=self.latches,
            positions=positions[: self.axes],
            core_positions=self.samples[-1][1][: self.axes].tolist(),
            machine=[self.rig.position(axis) for axis in range(self.axes)],
            greatest=[
                self.driver.greatest(one.axis, float(one.counts_per_step)) for one in self.setup.encoders
            ],
            troubles=self.troubles,
            trackers=trackers,
            tracked=np.array(self.tracked, TRACKED),
            matched_edges=self.engine.matched_edges if isinstance(self.engine, PairEngine) else None,
            clocks=self.engine.clock - start,
            seconds=time.monotonic() - began,
            unmade=[number for section in self.sections[len(made) :] for number in section.numbers],
        )

    # --------------------------------------------------------------------------------------- moves ----

    def _configure(self) -> None:
        driver = self.driver
        driver.configure_inputs(self.setup, self.axes)
        self._advance(3 * round(self.setup.settings.filter * self.clock_hz) + SETTLE_CLOCKS)
        if driver.snapshot().state == State.STOPPED:
            driver.attempt("clear")
        driver.configure(self.setup, self.file, self.sections)
        for track in self.setup.trackers:
            driver.call("configure_tracker", track_of(track))
        for track in self.setup.tracks:
            self._track(track)

    def _section(self, section: Section) -> None:
        section.begin = self.engine.clock
        section.start = [self.rig.position(axis) for axis in range(self.axes)]
        self.active_at = self.engine.clock
        try:
            self._begin(section)
        except DriverError as error:
            number = section.numbers[0]
            if not section.plans and error.name not in ("ESTOP", "ALARM", "STOPPED", "SWITCH_LEVEL"):
                raise MoveFileError(f"{self.file.path}: move {number}: {error.args[0]}") from None
            section.outcome, section.end = error.name, self.engine.clock
            self._look()
            return
        while self.driver.is_moving:
            try:
                self._poll()
                while self.driver.idle_microseconds == 0 and self.driver.is_moving:
                    self._poll()
            except DriverError as error:
                if self.driver.fault == "OK":
                    raise
                section.outcome = error.name
            if self.setup.encoders:
                self.samples.append(self.driver.sample(self.axes))
            self._look_at_trackers()
            self._advance(min(self.poll_clocks, self._patience()))
            self._look()
            if self.engine.clock - self.active_at > GIVE_UP_SECONDS * self.clock_hz:
                number, why = section.numbers[0], self._why_it_does_not_end()
                raise RunError(f"{self.file.path}: move {number} does not end: {why}")
        if section.outcome == "OK" and self.is_stopped:
            section.outcome = "STOPPED"
        if section.outcome == "OK" and section.kind in ("home", "probe"):
            for track in list(self.following.values()):  # at its edges it has stopped the trackers, too
                self._track(track)
        section.end = self.engine.clock

    def _why_it_does_not_end(self) -> str:
        if self.held:
            return f"held by {self.held}, and no resume follows"
        return State(self.driver.snapshot().state).name

    def _poll(self) -> None:
        """Poll the driver, which clears a stop that home or probe expects."""
        self._look()
        self.driver.poll()
        if self.raster:
            self.raster.feed()
        self._serve()

    def _begin(self, section: Section) -> None:
        self.source, self.raster = None, None
        move = section.moves[0]
        if section.plans:
            self.raster = Raster(section, self.driver)
            self.raster.feed()
            ramps = [ramp for plan in section.plans for ramp in plan.ramps]
            self.source = Source([plan.line for plan in section.plans], ramps)
            self.driver.stream(self.source)
        else:
            self.driver.begin(move, self.setup)

    def _patience(self) -> int:
        """Clocks until the queues should be refilled: half of their contents."""
        if self.source is None or not self.driver.is_streaming:
            return self.clock_hz
        parameters = self.engine.parameters
        waiting = (1 << parameters.ramp_queue_log2) - self.driver.c.snapshot.ramp_room
        ticks = sum(self.source.ticks[-waiting:]) if waiting else 0
        return max(1, ticks // 2) << parameters.tick_log2

    # ---------------------------------------------------------------------------------------- time ----

    def _advance(self, clocks: int) -> None:
        """Let time pass; events that are commands are carried out on their clock."""
        end = self.engine.clock + clocks
        while (left := end - self.engine.clock) > 0:
            self.engine.run(min(left, CHUNK))
            self._serve()
            self._collect()
            self.progress(self.engine.clock)

    def _collect(self) -> None:
        pins, inputs = self.engine.drain(), self.rig.changes()
        self.pins.append(pins)
        self.inputs.append(inputs)
        if len(pins) or not np.isin(inputs["input"], SPINDLE).all():
            self.active_at = self.engine.clock

    def _serve(self) -> None:
        """Carry out the commands among the events that have come."""
        for number, event in enumerate(self.setup.events):
            if number in self.answers or self.rig.moment(number) is None:
                continue
            self.answers[number] = self.engine.clock
            self.active_at = self.engine.clock
            try:
                self._command(number, event)
            except DriverError as error:
                self.troubles.append(f"{self.setup.names[number]}: {error.args[0]}")
            self.answers[number] = self.engine.clock

    def _command(self, number: int, event: Event) -> None:
        name = event.form.name
        if isinstance(event, EventOverride):
            self.driver.call("override", event.percent)
        elif isinstance(event, EventArm):
            fields = {
                "source": TriggerSource[event.source.upper()],
                "action": TriggerAction[event.action.upper()],
                "axis": event.axis,
                "falling": event.away,
            }
            self.driver.call("arm_trigger", ffi().new("struct passo_trigger_config *", fields))
            self.armed = number
        elif isinstance(event, MachineTrack):
            self._track(event)
        elif isinstance(event, EventUntrack):
            self.following.pop(event.axis, None)
            self.driver.call("untrack", event.axis)
        elif name in COMMANDS:
            self.driver.call(name)
            if name in ("hold", "resume"):
                self.held = self.setup.names[number] if name == "hold" else ""

    # ------------------------------------------------------------------------------------- readings ----

    def _look(self) -> None:
        """See whether the core has stopped, and what a trigger has latched."""
        if self.armed is not None:
            report = self.driver.trigger()
            if report.fired:
                self.latches.append(Latch(self.armed + 1, list(report.positions)[: self.axes]))
                self.armed = None
        if not self.engine.irq:
            self.is_stopped = False
            return
        if self.is_stopped:
            return
        self.is_stopped = True
        state, report, readings = self.driver.snapshot(), self.driver.trigger(), self.driver.readings()
        cause = Cause(state.cause)
        named = cause in (Cause.LIMIT, Cause.ALARM)
        self.stops.append(
            Stop(
                clock=self.engine.clock,
                cause=cause,
                positions=[self.rig.position(axis) for axis in range(self.axes)],
                axes=[axis for axis in range(self.axes) if named and readings.axes >> axis & 1],
                latch=list(report.positions)[: self.axes] if report.fired else None,
            )
        )

    def _track(self, track: MachineTrack) -> None:
        self.targets[track.axis] = int(track.target.value)
        self.following[track.axis] = track
        self.driver.call("track_to", track_of(track), self.targets[track.axis])

    def _look_at_trackers(self) -> None:
        if self.setup.trackers:
            self.tracked.append((self.engine.clock, self.driver.tracker_positions()))

    def _settle(self) -> list[Tracker]:
        """Wait until the trackers rest."""
        self.active_at = self.engine.clock
        while True:
            self._look_at_trackers()
            readings = [self.driver.tracker(axis) for axis in self.setup.with_trackers]
            if not any(reading.moves or (reading.enabled and not reading.at_target) for reading in readings):
                break
            if self.engine.clock - self.active_at > GIVE_UP_SECONDS * self.clock_hz:
                break
            self._advance(self.poll_clocks)
        return [
            Tracker(axis, reading.position, self.targets[axis], reading.at_target, reading.enabled)
            for axis, reading in zip(self.setup.with_trackers, readings, strict=True)
        ]

    def _happened(self, number: int) -> Happened:
        clock = self.rig.moment(number)
        positions = self.rig.moment_positions(number, self.axes) if clock is not None else []
        command = self.setup.events[number].form.name in COMMANDS
        answered = self.answers.get(number) if command else None
        name = self.setup.names[number]
        return Happened(name, self.setup.events[number], clock, positions, answered)
