# SPDX-License-Identifier: MIT
"""Run a move file with a machine: moves, home and probe one after the other, while events come."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from passo import registers as r
from passo.build import Parameters
from passo.driver import Driver, DriverError, Source
from passo.engine import EVENT, Engine, PairEngine
from passo.link import error_text
from passo.move_forms import USER_BANK, EventArm, EventOverride, MoveHome, MoveProbe
from passo.moves import Channels, MoveFile, MoveFileError, Task, q32
from passo.native import ffi
from passo.plan import plan_moves, table_of
from passo.registers import Cause, State, TriggerAction, TriggerSource
from passo.rig import RATIO_ONE, Rig
from passo.run import CHUNK, SLEWS_PER_SECOND, RunError
from passo.scene_run import SAMPLE, Happened, Latch, SceneRun, Section, Stop, sampled_at
from passo.setup import Event

POLLS_PER_SECOND = 1000
POLL_CLOCKS_MIN = 2000  # some times the length of a frame
AXES_OF_CORES = (2, 4, 8)
SETTLE_CLOCKS = 256
COMMANDS = ("hold", "resume", "override", "stop", "abort", "arm")  # events that the host carries out
GIVE_UP_SECONDS = 2  # without a step, a change of an input or an event


def scene_parameters(channels: Channels) -> Parameters:
    """Parameters of the core used for a file with a machine."""
    axes = next(n for n in AXES_OF_CORES if n >= channels.files[0].axes)
    return Parameters(axes=axes, inputs=1, encoders=1)


def plan_sections(file: MoveFile, parameters: Parameters) -> list[Section]:
    """The moves of a file as sections; raises MoveFileError."""
    sections: list[Section] = []
    for index, move in enumerate(file.moves):
        if isinstance(move, Task) or not sections or sections[-1].kind != "moves":
            sections.append(Section([], [], []))
        sections[-1].numbers.append(file.number(index))
        sections[-1].moves.append(move)
    for section in sections:
        if section.kind == "moves":
            own = MoveFile(
                file.path,
                file.clock_hz,
                file.pins,
                tuple(section.moves),
                file.channel,
                tuple(section.numbers),
            )
            section.plans = plan_moves(own, parameters)
    return sections


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
        self.sections = plan_sections(self.file, engine.parameters)
        self.driver = Driver(engine, self.clock_hz, engine.parameters)
        self.rig = Rig(engine, self.setup, self.axes)
        self.progress = progress or (lambda _: None)
        self.pins: list[np.ndarray] = []
        self.inputs: list[np.ndarray] = []
        self.samples: list[tuple[Any, ...]] = []
        self.stops: list[Stop] = []
        self.latches: list[Latch] = []
        self.troubles: list[str] = []
        self.answers: dict[int, int] = {}
        self.armed: int | None = None  # event
        self.source: Source | None = None
        self.is_stopped = False
        self.active_at = 0  # clock of the last change of anything

    def run(self) -> SceneRun:
        """Run all of it; raises DriverError, RunError, DifferenceError."""
        self._configure()
        began, start = time.monotonic(), self.engine.clock
        for number, section in enumerate(self.sections):
            self._section(section)
            if section.outcome != "OK":
                self.sections = self.sections[: number + 1]
                break
        pins = self.file.pins
        rest = 8 * (pins.step_high + pins.step_low + pins.dir_setup + pins.dir_hold)
        self._advance(max(rest, self.clock_hz // 500))
        positions, core = self.driver.positions(), self._raw_positions()
        self._sample()
        return SceneRun(
            file=self.file,
            setup=self.setup,
            sections=self.sections,
            pins=np.concatenate([np.empty(0, EVENT), *self.pins]),
            inputs=np.concatenate(self.inputs),
            samples=np.array(self.samples, SAMPLE),
            events=[self._happened(number) for number in range(len(self.setup.events))],
            stops=self.stops,
            latches=self.latches,
            positions=positions[: self.axes],
            core_positions=core,
            machine=[self.rig.position(axis) for axis in range(self.axes)],
            greatest=[self._greatest(encoder.axis) for encoder in self.setup.encoders],
            troubles=self.troubles,
            matched_edges=self.engine.matched_edges if isinstance(self.engine, PairEngine) else None,
            clocks=self.engine.clock - start,
            seconds=time.monotonic() - began,
        )

    # ------------------------------------------------------------------------------------- settings ----

    def _configure(self) -> None:
        driver, settings = self.driver, self.setup.settings
        driver.call("configure_watchdog", 0, 0)
        driver.call("configure_filter", round(settings.filter * self.clock_hz))
        for axis in range(self.axes):
            driver.call("configure_inputs", axis, self._input_config(axis))
        # An alarm may have been read with the wrong polarity until now.
        self._advance(3 * round(settings.filter * self.clock_hz) + SETTLE_CLOCKS)
        if driver.snapshot().state == State.STOPPED:
            driver.attempt("clear")
        for axis in range(self.axes):
            driver.configure_axis(axis, self.file.pins)
        probe = self.setup.find("probe", 0)
        if probe is not None:
            driver.call("configure_probe", self.setup.inputs[probe].polarity == "low")
        stop = settings.stop_time
        slew = self.clock_hz // SLEWS_PER_SECOND if stop is None else round(stop * self.clock_hz)
        peaks = [plan.c.velocity_peak for section in self.sections for plan in section.plans]
        driver.call("configure_motion", slew, slew, max(1, min(peaks) >> 20) if peaks else 0)
        if table := table_of([plan for section in self.sections for plan in section.plans]):
            driver.call("load_table", USER_BANK, table)
        for encoder in self.setup.encoders:
            ratio = round(encoder.counts_per_step * RATIO_ONE)
            limit = round(encoder.limit * encoder.counts_per_step) if encoder.limit else r.ENCODER_LIMIT_RESET
            stops = bool(encoder.limit)
            word = (stops and encoder.stop == "soft") << r.ENCODER_SETUP_STOP_SOFT_LSB
            word |= (stops and encoder.stop == "hard") << r.ENCODER_SETUP_STOP_HARD_LSB
            self._write(r.CHANNEL_ENCODER_FILTER, encoder.filter)
            base = r.CHANNEL_ENCODER_BASE + encoder.axis * r.CHANNEL_ENCODER_STRIDE
            self._write(base + r.ENCODER_SETUP, word, ratio, limit)

    def _input_config(self, axis: int) -> Any:
        """The `struct passo_input_config` of an axis."""
        config: dict[str, bool] = {}
        for one in self.setup.inputs:
            if one.axis != axis or one.role == "probe":
                continue
            if one.role != "alarm":
                config[one.role] = True
            config[f"{one.role}_inverted"] = one.polarity == "low"
            if one.role == "alarm":
                config |= {"alarm_soft": one.soft, "alarm_disables": one.disables}
            elif one.soft:
                config["limit_soft"] = True
        return ffi().new("struct passo_input_config *", config)

    # --------------------------------------------------------------------------------------- moves ----

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
                self._sample()
            self._advance(min(self.poll_clocks, self._patience()))
            self._look()
            if self.engine.clock - self.active_at > GIVE_UP_SECONDS * self.clock_hz:
                state = self.driver.snapshot()
                raise RunError(
                    f"{self.file.path}: move {section.numbers[0]} does not end: {State(state.state).name}"
                )
        if section.outcome == "OK" and self.is_stopped:
            section.outcome = "STOPPED"
        section.end = self.engine.clock

    def _poll(self) -> None:
        """Poll the driver, which clears a stop that home or probe expects."""
        self._look()
        self.driver.poll()
        self._serve()

    def _begin(self, section: Section) -> None:
        self.source = None
        move = section.moves[0]
        if section.plans:
            ramps = [ramp for plan in section.plans for ramp in plan.ramps]
            self.source = Source([plan.line for plan in section.plans], ramps)
            self.driver.stream(self.source)
        elif isinstance(move, MoveHome):
            axis = next(axis for axis, steps in enumerate(move.steps) if steps)
            self.home = ffi().new(
                "struct passo_home *",
                {
                    "axis": axis,
                    "source": TriggerSource[move.switch.upper()],
                    "distance": move.steps[axis],
                    "back_off": move.back_off,
                    "pull_off": move.pull_off,
                    "speed": q32(move.speed),
                    "slow_speed": q32(move.slow_speed),
                    "acceleration": q32(move.acceleration),
                    "position": move.edge_position,
                },
            )
            self.driver.call("home", self.home, 1)
        elif isinstance(move, MoveProbe):
            fields = {
                "steps": move.steps,
                "speed": q32(move.speed),
                "acceleration": q32(move.acceleration),
                "away": move.away,
                "optional": move.optional,
            }
            self.driver.call("probe", ffi().new("struct passo_probe *", fields))

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
        if len(pins) or len(inputs):
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
                self.troubles.append(f"event {number + 1}: {error.args[0]}")
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
        elif name in COMMANDS:
            self.driver.call(name)

    # ------------------------------------------------------------------------------------- readings ----

    def _look(self) -> None:
        """See whether the core has stopped, and what a trigger has latched."""
        if self.armed is not None:
            report = self._trigger()
            if report.fired:
                self.latches.append(Latch(self.armed + 1, list(report.positions)[: self.axes]))
                self.armed = None
        if not self.engine.irq:
            self.is_stopped = False
            return
        if self.is_stopped:
            return
        self.is_stopped = True
        state, report = self.driver.snapshot(), self._trigger()
        readings = ffi().new("struct passo_readings *")
        self.driver.call("read_inputs", readings)
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

    def _trigger(self) -> Any:
        report = ffi().new("struct passo_trigger_report *")
        self.driver.call("read_trigger", report)
        return report

    def _sample(self) -> None:
        clock = sampled_at(self.engine.clock)
        length = r.CHANNEL_ENCODER_POSITION_BASE + self.axes - r.CHANNEL_POSITION_BASE
        words = self._read(r.CHANNEL_POSITION_BASE, length)
        signed = np.zeros((2, 8), np.int32)
        at = r.CHANNEL_ENCODER_POSITION_BASE - r.CHANNEL_POSITION_BASE
        signed[0, : self.axes] = np.array(words[: self.axes], np.uint32).view(np.int32)
        signed[1, : self.axes] = np.array(words[at : at + self.axes], np.uint32).view(np.int32)
        self.samples.append((clock, signed[0], signed[1]))

    def _raw_positions(self) -> list[int]:
        words = self._read(r.CHANNEL_POSITION_BASE, self.axes)
        return [word - (word >> 31 << 32) for word in words]

    def _greatest(self, axis: int) -> float:
        """Greatest following error of an axis in steps."""
        encoder = next(one for one in self.setup.encoders if one.axis == axis)
        base = r.CHANNEL_ENCODER_BASE + axis * r.CHANNEL_ENCODER_STRIDE
        (word,) = self._read(base + r.ENCODER_GREATEST, 1)
        counts = word & ((1 << r.ENCODER_GREATEST_GREATEST_BITS) - 1)
        return counts / float(encoder.counts_per_step)

    def _happened(self, number: int) -> Happened:
        clock = self.rig.moment(number)
        positions = self.rig.moment_positions(number, self.axes) if clock is not None else []
        command = self.setup.events[number].form.name in (
            *["hold", "resume", "override", "stop", "abort", "arm"],
        )
        answered = self.answers.get(number) if command else None
        return Happened(number + 1, self.setup.events[number], clock, positions, answered)

    def _read(self, address: int, length: int) -> list[int]:
        words = ffi().new("uint32_t[]", length)
        self._check(self.driver.lib.passo_host_read(self.driver.host, address + self._base, words, length))
        return list(words)

    def _write(self, address: int, *words: int) -> None:
        self._check(
            self.driver.lib.passo_host_write(self.driver.host, address + self._base, words, len(words))
        )

    @property
    def _base(self) -> int:
        return r.ADDRESS_CHANNEL_BASE

    def _check(self, error: int) -> None:
        self.driver.hardware.check()
        if error:
            raise RunError(error_text(error))
