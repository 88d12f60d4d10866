# SPDX-License-Identifier: MIT
"""A part of G-code on a machine: its lines are checked, then played on an engine."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from passo.driver import Driver
from passo.engine import Engine
from passo.expand.expander import Options, expand_file, needs_expanding
from passo.expand.place import Place
from passo.expand.refusals import explain_text
from passo.expand.tools import Tool, lengths
from passo.failure import BadInputError
from passo.gcode import NANOMETERS, Gcode, GcodeError, has_words, lines, set_tool_lengths
from passo.host_loop import HostLoop
from passo.machine_file import MachineFile
from passo.native import planner
from passo.pair_engine import PairEngine
from passo.path import LOOK_AHEAD
from passo.program import Program

LOOPS_PER_SECOND = 1000  # polls of the driver
SLEWS_PER_SECOND = 20  # of hold and stop, from full speed
PATIENCE = 3600  # simulated seconds without an end of the path that are too many


@dataclass(frozen=True)
class Part:
    """The checked lines of a file."""

    path: Path
    lines: list[bytes]
    chords: int  # with those of the arcs
    end: tuple[int, ...]  # nm
    unread: int  # lines that say something behind the end of the program
    tools: dict[int, float]  # lengths in mm


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

    @cached_property
    def seconds(self) -> float:
        """Duration of all motions."""
        return sum(end - begin for begin, end in self.motions) / self.machine.clock_hz

    def problems(self) -> list[str]:
        """What was not exact, one sentence each."""
        found = []
        if self.cause != "NONE":
            found.append(f"the core stopped: {self.cause}")
        if self.drained:
            found.append(f"{self.drained} substeps were missing at the end of a ramp")
        settings = self.machine.settings
        axes = len(settings.axes)
        ends = settings.motors.map(axes) @ np.array(self.part.end[:axes]) / NANOMETERS * settings.scales
        for motor, exact in enumerate(ends.tolist()):
            made = int(self.positions[motor][-1]) if len(self.positions[motor]) else 0
            if abs(made - exact) > 0.5 + 1e-6 or self.end[motor] != made:
                name = self.machine.motors[motor]
                found.append(
                    f"motor {name} made {made} steps and counted {self.end[motor]}, wanted are {exact:g}"
                )
        return found


def read_part(path: Path, machine: MachineFile, tools: dict[int, Tool] | None = None) -> Part:
    """Check all lines of a file, expanded if it needs that; raises BadInputError with the first bad line."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise BadInputError(f"{path}: {error.strerror}") from None
    text, places = lines(data), None
    if needs_expanding(data):
        expanded = expand_file(path, Options(machine.gcode, tools or {}, at_zero=True), _say)
        text, places = [f"{line.text}\n".encode() for line in expanded], [line.place for line in expanded]
    if not any(map(has_words, text)):
        raise BadInputError(f"{path}: the file has no G-code")
    gcode, chords, table = Gcode(machine.gcode), 0, lengths(tools or {})
    set_tool_lengths(gcode.c, table)
    for number, line in enumerate(text, 1):
        place = places[number - 1] if places else Place(path, number)
        try:
            gcode.execute(line)
        except GcodeError as error:
            why = explain_text(error, line.decode("utf-8", "replace"), machine.gcode.axes)
            raise BadInputError(f"{place}: {why}") from None
        for action in gcode.actions():
            if action.kind == planner().PASSO_GCODE_CHANGE:
                planner().passo_gcode_load(gcode.c, action.tool)
            if action.kind == planner().PASSO_GCODE_PROBE:
                raise BadInputError(f"{place}: no probe is fitted")
            if action.kind == planner().PASSO_GCODE_END:
                unread = sum(map(has_words, text[number:]))
                return Part(path, text[:number], chords, gcode.position, unread, table)
            chords += action.kind == planner().PASSO_GCODE_LINE
    return Part(path, text, chords, gcode.position, 0, table)


def _say(text: str) -> None:
    print(text, file=sys.stderr)


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
    for motor in range(motors):
        driver.configure_axis(motor, machine.pins)
    slew = machine.clock_hz // SLEWS_PER_SECOND
    driver.call("configure_motion", slew, slew, 1 << 16)
    program = Program(driver, machine.settings, machine.gcode, look_ahead)
    set_tool_lengths(program.c.gcode, part.tools)
    loop = HostLoop(engine, machine.clock_hz // LOOPS_PER_SECOND)
    waiting = iter(part.lines)
    last, quiet = -1, engine.clock
    while not program.is_done:
        while program.is_ready:
            if (line := next(waiting, None)) is not None:
                program.line(line)
            else:
                program.end()
            program.poll()
        loop.turn(program.poll, lambda: program.rests)
        if program.chords != last:
            last, quiet = program.chords, engine.clock
            progress(last)
        if engine.clock - quiet > PATIENCE * machine.clock_hz:
            raise BadInputError(f"{part.path}: timeout: no motion for an hour of simulated time")
    loop.run(8 * sum(vars(machine.pins).values()))
    snapshot, end = driver.snapshot(), driver.positions()[:motors]
    cause, matched = driver.cause.name, getattr(engine, "matched_edges", None)
    steps = loop.steps(motors)
    motions = list(zip(steps.begins, steps.ends, strict=True))
    drained = int(snapshot.drained)
    return Played(part, machine, steps.clocks, steps.positions, motions, end, drained, cause, matched)
