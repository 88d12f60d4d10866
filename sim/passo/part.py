# SPDX-License-Identifier: MIT
"""A part of G-code on a machine: its lines are checked, then played on an engine."""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from passo.build import Parameters
from passo.driver import Driver, DriverError, new_track
from passo.engine import Engine
from passo.expand.expander import Options, expand_file, needs_expanding
from passo.expand.height_map import HeightMap
from passo.expand.output import PlainLine
from passo.expand.place import Place, ProgramError, listed
from passo.expand.refusals import SLOW
from passo.expand.tools import Tool, lengths
from passo.failure import BadInputError
from passo.gcode import NANOMETERS, GcodeError, check_text, has_words, lines
from passo.host_loop import HostLoop
from passo.machine_file import MachineFile
from passo.native import ffi
from passo.pair_engine import PairEngine
from passo.path import LOOK_AHEAD
from passo.preview import Checked, Planned, check_lines, new_gcode, plan_lines, position_of
from passo.program import Program
from passo.rig import CHANGE
from passo.run import parameters_for
from passo.spindle_at import SpindleAt

LOOPS_PER_SECOND = 1000  # polls of the driver
FOLLOWS_PER_SECOND = 10_000  # the same in step with the spindle
SLEWS_PER_SECOND = 20  # of hold and stop, from full speed
STANDARD_INPUT, STDIN = Path("-"), Path("stdin")
PATIENCE = 3600  # simulated seconds without a line or step that are too many
TIMEOUT = "timeout: no step for an hour of simulated time; the last line taken is"


@dataclass(frozen=True)
class Begin:
    """Where a part begins: at 0, or behind lines that were executed without moving."""

    gcode: Any  # `struct passo_gcode`
    steps: list[int]  # of the motors
    place: np.ndarray  # of the axes, mm: where these steps are


@dataclass(frozen=True)
class Part:
    """The checked lines of a program."""

    path: Path  # of its first file
    lines: list[bytes]
    places: list[Place]  # of each line
    chords: int  # with those of the arcs
    end: tuple[int, ...]  # nm
    unread: int  # lines that say something behind the end of the program
    tools: dict[int, float]  # lengths in mm
    begin: Begin

    @property
    def name(self) -> str:
        """For folders and summaries."""
        return self.path.stem

    @property
    def ends(self) -> np.ndarray:
        """Where the last line ends, in mm from where the part begins."""
        return np.array(self.end) / NANOMETERS - self.begin.place


@dataclass(frozen=True)
class Pass:
    """In step with the spindle."""

    begin: int  # clock; so is the end
    end: int
    lines: int  # of the program


class _Passes:
    """Those of a program, looked at after each poll."""

    def __init__(self, program: Program, engine: Engine | PairEngine):
        self.found: list[Pass] = []
        self._program, self._engine, self._begin = program, engine, 0

    def look(self) -> None:
        """One has begun or ended, or not."""
        program, clock = self._program, self._engine.clock
        if program.threads > len(self.found):
            self.found.append(Pass(self._begin, clock, program.pass_lines))
        if not program.follows:
            self._begin = clock


@dataclass(frozen=True)
class Played:
    """What left the pins."""

    part: Part
    machine: MachineFile
    clocks: list[np.ndarray]  # of the steps of each motor, from the start of the first motion
    positions: list[np.ndarray]  # in steps, after each of them
    motions: list[tuple[int, int]]  # begin and end of each motion, in clocks
    end: list[int]  # positions at the end, in steps
    drained: int
    cause: str
    matched_edges: int | None
    events: np.ndarray  # of the pins, EVENT
    origin: int  # clock of the start of the first motion
    following: dict[str, float]  # greatest following errors of motors with an encoder, in mm
    canceled: str = ""  # where, if it was
    passes: Sequence[Pass] = ()
    counts: np.ndarray = field(default_factory=lambda: np.empty(0, CHANGE))  # of the encoder of the spindle
    taken_up: dict[int, int] = field(default_factory=dict)  # steps of the trackers at the end, by motor

    @property
    def threads(self) -> int:
        """Passes in step with the spindle."""
        return len(self.passes)

    @cached_property
    def seconds(self) -> float:
        """Duration of all motions."""
        return sum(end - begin for begin, end in self.motions) / self.machine.clock_hz

    def problems(self) -> list[str]:
        """What was not exact, one sentence each."""
        found = []
        if self.cause != "NONE":
            found.append(f"the core stopped: {self.cause}")
        if self.canceled:
            return [*found, f"canceled at {self.canceled}"]
        if self.drained:
            found.append(f"{self.drained} substeps were missing at the end of a ramp")
        settings = self.machine.settings
        axes = len(settings.axes)
        ends = settings.motors.map(axes) @ self.part.ends[:axes] * settings.scales
        for motor, exact in enumerate(ends.tolist()):
            made = int(self.positions[motor][-1]) if len(self.positions[motor]) else 0
            taken_up = self.taken_up.get(motor, 0)
            if abs(made - taken_up - exact) > 0.5 + 1e-6 or self.end[motor] + taken_up != made:
                name = self.machine.motors[motor]
                found.append(
                    f"motor {name} made {made} steps and counted {self.end[motor]}, wanted are {exact:g}"
                )
            if taken_up not in (0, -self.machine.backlash(motor)):
                name = self.machine.motors[motor]
                found.append(f"motor {name}: its tracker ends at {taken_up}, neither 0 nor the backlash")
        return found


@dataclass(frozen=True)
class Lines:
    """Which lines of a file are played, counted from 1; the modes of those before are in force."""

    first: int = 1
    last: int | None = None


def read_part(
    path: Path | Sequence[Path],
    machine: MachineFile,
    tools: dict[int, Tool] | None = None,
    only: Lines | None = None,
    surface: HeightMap | None = None,
) -> Part:
    """Check all lines of a file, or of several in turn, expanded where they need that.

    Each file ends at its M2 or M30. Probes touch `surface`, in machine coordinates. Raises BadInputError with
    all bad lines.
    """
    files = [path] if isinstance(path, Path) else list(path)
    if only and len(files) > 1:
        raise BadInputError("--from and --to count the lines of one file")
    table = lengths(tools or {})
    gcode = new_gcode(machine.gcode, table)
    begin = _begin(gcode, machine)
    refused: list[str] = []
    whole, places, chords, unread = [], [], 0, 0
    for file in files:
        try:
            text, where = _read(file, machine, tools or {}, surface, gcode)
        except ProgramError as error:  # the lines of the others are checked as well
            if only:
                raise
            refused += map(str, error.each)
            text, where = _plain(error.lines)
        if only:
            before, text, where = _split(file, text, where, only)
            checked = check_lines(before, gcode)
            refused += _told(checked, before, where, machine)
            begin = _begin(gcode, machine)
            before, where = [], where[len(before) :]
            if checked.ended:
                raise BadInputError(f"{file}: line {only.first} is behind the end of the program")
        checked = check_lines(text, gcode)
        refused += _told(checked, text, where, machine)
        chords += checked.chords
        unread += checked.unread
        whole += text[: checked.lines]
        places += where[: checked.lines]
    if refused:
        raise BadInputError("\n".join(listed(refused)))
    first = STDIN if files[0] == STANDARD_INPUT else files[0]
    return Part(first, whole, places, chords, position_of(gcode), unread, table, begin)


def _read(
    path: Path, machine: MachineFile, tools: dict[int, Tool], surface: HeightMap | None, begin: Any
) -> tuple[list[bytes], list[Place]]:
    """The lines of a file and their places; `begin`: the `struct passo_gcode` before them."""
    try:
        data = sys.stdin.buffer.read() if path == STANDARD_INPUT else path.read_bytes()
    except OSError as error:
        raise BadInputError(f"{path}: {error.strerror}") from None
    name = STDIN if path == STANDARD_INPUT else path
    check_text(name, data)
    text = lines(data)
    if surface or needs_expanding(data):
        options = Options(machine.gcode, tools, at_zero=True, surface=surface, begin=begin)
        text, places = _plain(expand_file(name, options, _say, data))
    else:
        places = [Place(name, number) for number in range(1, len(text) + 1)]
    if not any(map(has_words, text)):
        raise BadInputError(f"{name}: the file has no G-code")
    if not text[-1].endswith(b"\n"):
        text[-1] += b"\n"  # another file may follow
    return text, places


def _plain(expanded: Sequence[PlainLine]) -> tuple[list[bytes], list[Place]]:
    return [f"{line.text}\n".encode() for line in expanded], [line.place for line in expanded]


def _split(
    path: Path, text: list[bytes], places: list[Place], only: Lines
) -> tuple[list[bytes], list[bytes], list[Place]]:
    """The lines before those that are played, these, and the places of both."""
    own = [place.line if place.path == places[0].path else 0 for place in places]
    first = next((k for k, line in enumerate(own) if line >= only.first), None)
    if first is None:
        raise BadInputError(f"{path}: there is no line {only.first}")
    last = max((k for k, line in enumerate(own) if only.last is None or line <= only.last), default=-1)
    if last < first:
        raise BadInputError(f"{path}: no line is from {only.first} to {only.last}")
    return text[:first], text[first : last + 1], places[: last + 1]


def _begin(gcode: Any, machine: MachineFile) -> Begin:
    """Where the interpreter is, in whole steps."""
    settings = machine.settings
    rows, scales = settings.motors.map(len(settings.axes)), np.array(settings.scales)
    at = np.array(position_of(gcode)) / NANOMETERS
    steps = np.rint(rows @ at * scales)
    kept = ffi().new("struct passo_gcode *", gcode[0])
    return Begin(kept, steps.astype(int).tolist(), settings.motors.axes_of((steps / scales)[None])[0])


def _told(checked: Checked, text: list[bytes], places: list[Place], machine: MachineFile) -> list[str]:
    """A sentence for each refused line."""
    return [
        f"{places[found.line]}: {found.why(text[found.line], machine.gcode)}" for found in checked.refused
    ]


def _say(text: str) -> None:
    print(text, file=sys.stderr)


def core_of(machine: MachineFile) -> Parameters:
    """The core that plays parts; the encoder of a spindle is at the inputs behind the motors."""
    core = parameters_for(machine.core_axes)
    outputs = machine.turns or machine.spindle_wait > 0
    return replace(
        core,
        encoders=int("encoders" in machine.parts),
        outputs=int(outputs),
        trackers=int("trackers" in machine.parts),
    )


def plan_part(
    part: Part,
    machine: MachineFile,
    look_ahead: int = LOOK_AHEAD,
    progress: Callable[[int], None] = lambda lines: None,
) -> Planned:
    """Plan all lines, as play_part() does; `progress` is called with the lines taken."""
    core = core_of(machine)
    begin, polls = part.begin, LOOPS_PER_SECOND
    return plan_lines(part.lines, machine, begin.gcode, begin.steps, core, look_ahead, polls, progress)


def configure(driver: Driver, machine: MachineFile, **fields: Any) -> None:
    """Pins, stops, encoders and backlash; `fields` are further members of struct passo_axis_config."""
    for motor in range(len(machine.motors)):
        driver.configure_axis(motor, machine.pins, **fields)
    slew = machine.clock_hz // SLEWS_PER_SECOND
    driver.call("configure_motion", slew, slew, 1 << 16)
    for motor, ratio in machine.encoder_ratios.items():
        _, limit = machine.encoders[motor]
        config = {"ratio": ratio, "limit": limit, "stop": driver.lib.PASSO_FOLLOWING_SOFT}
        driver.call("configure_encoder", motor, ffi().new("struct passo_encoder_config *", config))
    for motor, limits in machine.trackers.items():
        track = new_track(motor, *limits)
        driver.call("configure_tracker", track)
        driver.call("track_to", track, 0)


def play_part(
    part: Part,
    machine: MachineFile,
    engine: Engine | PairEngine,
    progress: Callable[[int], None] = lambda chords: None,
    look_ahead: int = LOOK_AHEAD,
) -> Played:
    """Play all lines; `progress` is called with the chords that the planner has taken."""
    driver = Driver(engine, machine.clock_hz, engine.parameters)
    motors = len(machine.motors)
    configure(driver, machine)
    program = Program(driver, machine.settings, machine.gcode, look_ahead)
    program.begin(part.begin.gcode, part.begin.steps)
    spindle = SpindleAt(engine, machine) if machine.turns else None
    program.c.machine.spindle = motors
    program.wait(machine.spindle_wait, machine.spindle_at_speed)
    passes = _Passes(program, engine)

    def poll() -> None:
        program.poll()
        passes.look()

    loop = HostLoop(engine, machine.clock_hz // LOOPS_PER_SECOND)
    waiting, taken, begun = iter(part.lines), 0, 0  # begun: of the thread that lines continue
    last, quiet = -1, engine.clock
    canceled = ""
    try:
        while not program.is_done:
            while program.is_ready:
                if (line := next(waiting, None)) is not None:
                    begun = begun if program.follows else taken
                    program.line(line)
                    taken += 1
                else:
                    program.end()
                poll()
            if spindle:
                spindle.drive(program.power)
                program.say_at_speed(spindle.is_at_speed)
                polls = FOLLOWS_PER_SECOND if program.follows else LOOPS_PER_SECOND
                loop.period = machine.clock_hz // polls
            loop.turn(poll, lambda: program.rests)
            if program.is_slow:
                raise BadInputError(f"{part.places[taken - 1]}: {slow(machine)}")
            if program.chords != last:
                last, quiet = program.chords, engine.clock
                progress(last)
            if engine.clock - quiet > PATIENCE * machine.clock_hz:
                if (step := loop.last_step()) <= quiet:
                    raise BadInputError(f"{part.path}: {TIMEOUT} {part.places[taken - 1]}")
                quiet = step
    except (GcodeError, DriverError) as error:
        raise BadInputError(f"{part.places[begun if program.follows else taken - 1]}: {error}") from None
    except KeyboardInterrupt:
        canceled = str(part.places[taken - 1])
    loop.run(8 * sum(vars(machine.pins).values()))
    taken_up = _taken_up(driver, machine, loop)
    snapshot, end = driver.snapshot(), driver.positions()[:motors]
    cause, matched = driver.cause.name, getattr(engine, "matched_edges", None)
    steps = loop.steps(motors)
    ends = [*steps.ends, engine.clock - steps.origin][: len(steps.begins)]  # a canceled one continues
    motions = list(zip(steps.begins, ends, strict=True))
    drained = int(snapshot.drained)
    return Played(
        *(part, machine, steps.clocks, steps.positions, motions, end, drained, cause, matched),
        *(steps.events, steps.origin, _following(driver, machine), canceled),
        passes.found if spindle else (),
        spindle.changes() if spindle else np.empty(0, CHANGE),
        taken_up,
    )


def slow(machine: MachineFile) -> str:
    """The spindle was not at its speed in time."""
    return SLOW.format(input=machine.spindle_at_speed, seconds=f"{machine.spindle_wait:g}")


def _taken_up(driver: Driver, machine: MachineFile, loop: HostLoop) -> dict[int, int]:
    """Steps of the trackers, once they rest."""
    found = {}
    for motor in machine.trackers:
        for _ in range(LOOPS_PER_SECOND):
            reading = driver.tracker(motor)
            if not reading.moves:
                break
            loop.run(machine.clock_hz // LOOPS_PER_SECOND)
        found[motor] = reading.position
    return found


def _following(driver: Driver, machine: MachineFile) -> dict[str, float]:
    found = {}
    for motor, (counts, _) in machine.encoders.items():
        reading = ffi().new("struct passo_encoder_reading *")
        driver.call("read_encoder", motor, reading)
        found[machine.motors[motor]] = reading.greatest / counts
    return found
