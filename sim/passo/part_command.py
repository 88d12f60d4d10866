# SPDX-License-Identifier: MIT
"""`passo run PART.nc --machine MACHINE.toml`: from G-code to a folder of results."""

import sys
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from passo.axis_judge import Share, faults
from passo.console import progress
from passo.course import Course
from passo.expand.height_map import HeightMap, read_height_map
from passo.expand.tools import read_tools
from passo.failure import BadInputError
from passo.gcode import NANOMETERS
from passo.grbl_setup import attach_encoders
from passo.machine_file import MachineFile, read_machine
from passo.output import check_folder, empty_folder, write_json
from passo.part import Lines, Part, Played, core_of, plan_part, play_part, read_part
from passo.part_judge import beside, greatest, shares_of
from passo.path import LOOK_AHEAD
from passo.report import write_rows
from passo.run import open_engine
from passo.toolchain import paths
from passo.waves import FILES, Window, check_window, recorded, say_waves, wanted_window, write_view

SUMMARY, PICTURE, PULSES, PAGE = "summary.json", "path.png", "pulses.csv", "report.html"


@dataclass(frozen=True)
class Asked:
    """What `passo run` was asked for."""

    machine: Path | None
    tools: Path | None = None
    engine: str = "model"
    out: Path | None = None
    plot: bool = False
    report: bool = False
    waves: str | None = None
    look_ahead: int = LOOK_AHEAD
    only: Lines | None = None
    inputs: int | None = None  # of M66: bits of those that are high
    surface: Path | None = None  # a height map that probes touch


def run_part(files: Sequence[Path], asked: Asked) -> bool:
    """Play a part, write the results and say where they are; return whether the motion was exact.

    Ctrl-C ends it: KeyboardInterrupt, once the results up to then are written.
    """
    check_folder(asked.out or paths.results, "--out")
    machine = machine_of(files, asked.machine, asked.inputs)
    window = wanted_window(asked.waves, asked.engine)
    part = read_part(files, machine, read_tools(asked.tools), asked.only, surface_of(asked.surface))
    out = asked.out or paths.results / "run" / part.name
    with progress(part.path.name, part.chords) as report:
        played, judged, summary = play_to(out, part, machine, asked.engine, asked, report, window)
    found = summary["problems"]
    for problem in found:
        print(f"{part.path}: {problem}", file=sys.stderr)
    say_unread(part)
    if not played.motions:
        print(f"{part.path}: nothing moved", file=sys.stderr)
    elif not found:
        print(f"{part.path.name}: {len(part.lines)} lines, {part.chords} chords in {played.seconds:.6g} s")
        limits = ", ".join(_limit(machine, share) for share in greatest(judged).values())
        print(f"greatest share of a limit: {limits}")
        if played.threads:
            print(f"{played.threads} threads")
    print(f"results: {', '.join(str(out / name) for name in (PULSES, SUMMARY) if (out / name).exists())}")
    if window:
        say_waves(out)
    for name in [PICTURE] * asked.plot + [PAGE] * asked.report:
        print(f"open: {out / name}")
    if played.canceled:
        raise KeyboardInterrupt
    return not found


def machine_of(files: Sequence[Path], path: Path | None, inputs: int | None = None) -> MachineFile:
    """The machine that a part needs, with the levels that M66 reads; raises BadInputError."""
    if path is None:
        raise BadInputError(f"{files[0]}: G-code needs --machine MACHINE.toml (docs/gcode.md)")
    machine = read_machine(path, takes_up=True)
    return replace(machine, gcode=replace(machine.gcode, levels=inputs))


def surface_of(path: Path | None) -> HeightMap | None:
    """The height map of a file, if there is one; raises BadInputError."""
    return read_height_map(path) if path else None


def say_unread(part: Part) -> None:
    """Say that a program has more lines than it reads."""
    if part.unread:
        print(f"{part.path}: {part.unread} lines behind the end of the program are not read", file=sys.stderr)


def play_to(
    out: Path,
    part: Part,
    machine: MachineFile,
    engine: str,
    asked: Asked | None = None,
    report: Callable[[int], None] = lambda chords: None,
    window: Window | None = None,
) -> tuple[Played, list[Share], dict[str, Any]]:
    """Play a part and write the results to a folder; what left the pins, its limits, and its summary."""
    asked = asked or Asked(None, plot=True)
    course = Course(plan_part(part, machine, asked.look_ahead), part.begin.place)
    if window:
        check_window(window, machine.clock_hz, round(course.seconds * machine.clock_hz))
    parameters = core_of(machine)
    with open_engine(engine, parameters, machine.clock_hz, window is not None) as core:
        empty_folder(out, (SUMMARY, PICTURE, PULSES, PAGE, *FILES))
        with recorded(core, window, out) if window else nullcontext():
            attach_encoders(core, machine)
            played = play_part(part, machine, core, report, asked.look_ahead)
    if window:
        write_view(out, parameters, machine.clock_hz, {0: len(machine.motors)}, played.origin)
    alone = _alone(part, machine, asked.look_ahead) if machine.trackers and not played.canceled else played
    judged = [] if played.canceled else shares_of(alone)  # it does not come to rest
    found = played.problems() + faults(judged)
    if alone is not played:
        found += beside(played, alone)
    summary = _summary(part, machine, played, engine, judged, found)
    summary |= {"tools": course.tools(), "levels": course.levels()}
    write_pulses(played, out / PULSES)
    write_json(summary, out / SUMMARY)
    if asked.plot:
        from passo.part_plot import plot_part

        plot_part(played, out / PICTURE)
    if asked.report:
        from passo.part_page import write_part_page

        write_part_page(played, summary, out / PAGE)
    return played, judged, summary


def _alone(part: Part, machine: MachineFile, look_ahead: int) -> Played:
    """The same path of a machine without backlash, whose pulses are those of the path."""
    plain = replace(machine, ends=tuple(replace(end, backlash=0, take_up=0) for end in machine.ends))
    with open_engine("model", core_of(plain), machine.clock_hz) as core:
        attach_encoders(core, plain)
        return play_part(part, plain, core, look_ahead=look_ahead)


def write_pulses(played: Played, path: Path) -> None:
    """Write a row per step, as of a move file."""
    rows = [
        np.stack([clocks, np.full(len(clocks), motor), np.diff(counts, prepend=0)])
        for motor, (clocks, counts) in enumerate(zip(played.clocks, played.positions, strict=True))
    ]
    write_rows(("clock", "axis", "direction"), np.concatenate(rows, axis=1), path)


def _limit(machine: MachineFile, share: Share) -> str:
    return f"{share.name} {share.share:.3f}" + (f" ({machine.limited[share.axis]})" if share.share else "")


def _summary(
    part: Part, machine: MachineFile, played: Played, engine: str, judged: list[Share], found: list[str]
) -> dict[str, Any]:
    axes = machine.settings.axes
    return {
        "name": part.path.stem,
        "engine": engine,
        "ok": not found,
        "problems": found,
        "clock_hz": machine.clock_hz,
        "path_seconds": played.seconds,
        "lines": len(part.lines),
        "unread_lines": part.unread,
        "chords": part.chords,
        "motions": len(played.motions),
        "matched_edges": played.matched_edges,
        "end": {
            "millimetres": [nanometres / NANOMETERS for nanometres in part.end[: len(axes)]],
            "steps": played.end,
        },
        "motors": machine.motors,
        "pulses": [len(clocks) for clocks in played.clocks],
        "limits": {name: asdict(share) for name, share in greatest(judged).items()},
        "highest": _highest(machine, judged),
        "following": played.following,
        "taken_up": {machine.motors[motor]: steps for motor, steps in played.taken_up.items()},
    }


def _highest(machine: MachineFile, judged: list[Share]) -> dict[str, dict[str, float]]:
    """What axes and motors with limits reached at the pins: speed in mm/s, acceleration in mm/s^2, jerk."""
    found: dict[str, dict[str, float]] = {name: {} for name in machine.limited}
    limits = [own for _, own in machine.settings.limits()]
    for share in judged:
        limit = float(getattr(limits[share.axis], share.name))
        found[machine.limited[share.axis]][share.name] = share.share * limit
    return found
