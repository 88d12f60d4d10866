# SPDX-License-Identifier: MIT
"""`passo run PART.nc --machine MACHINE.toml`: from G-code to a folder of results."""

import sys
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from passo.axis_judge import Share, faults
from passo.console import progress
from passo.expand.tools import read_tools
from passo.failure import BadInputError
from passo.gcode import NANOMETERS
from passo.machine_file import MachineFile, read_machine
from passo.output import empty_folder, write_json
from passo.part import Part, Played, play_part, read_part
from passo.part_judge import greatest, shares_of
from passo.run import open_engine, parameters_for
from passo.toolchain import paths

SUMMARY, PICTURE = "summary.json", "path.png"


def run_part(
    path: Path,
    machine_path: Path | None,
    tools: Path | None,
    engine: str,
    out: Path | None,
    plot: bool,
) -> bool:
    """Play a part, write the results and say where they are; return whether the motion was exact."""
    if machine_path is None:
        raise BadInputError(f"{path}: G-code needs --machine MACHINE.toml (docs/gcode.md)")
    machine = read_machine(machine_path)
    part = read_part(path, machine, read_tools(tools))
    out = out or paths.results / "run" / path.stem
    with progress(path.name, part.chords) as report:
        played, judged, summary = play_to(out, part, machine, engine, plot, report)
    found = summary["problems"]
    for problem in found:
        print(f"{path}: {problem}", file=sys.stderr)
    if part.unread:
        print(f"{path}: {part.unread} lines behind the end of the program are not read", file=sys.stderr)
    if not played.motions:
        print(f"{path}: nothing moved", file=sys.stderr)
    elif not found:
        print(f"{path.name}: {len(part.lines)} lines, {part.chords} chords in {played.seconds:.6g} s")
        limits = ", ".join(_limit(machine, share) for share in greatest(judged).values())
        print(f"greatest share of a limit: {limits}")
    print(f"results: {', '.join(str(out / name) for name in (SUMMARY, PICTURE) if (out / name).exists())}")
    return not found


def play_to(
    out: Path,
    part: Part,
    machine: MachineFile,
    engine: str,
    plot: bool = True,
    report: Callable[[int], None] = lambda chords: None,
) -> tuple[Played, list[Share], dict[str, Any]]:
    """Play a part and write the results to a folder; what left the pins, its limits, and its summary."""
    empty_folder(out, (SUMMARY, PICTURE))
    with open_engine(engine, parameters_for(len(machine.motors)), machine.clock_hz) as core:
        played = play_part(part, machine, core, report)
    judged = shares_of(played)
    summary = _summary(part, machine, played, engine, judged, played.problems() + faults(judged))
    write_json(summary, out / SUMMARY)
    if plot:
        from passo.part_plot import plot_part

        plot_part(played, out / PICTURE)
    return played, judged, summary


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
    }
