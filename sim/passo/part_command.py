# SPDX-License-Identifier: MIT
"""`passo run PART.nc --machine MACHINE.toml`: from G-code to a folder of results."""

import sys
from pathlib import Path
from typing import Any

from passo.console import progress
from passo.failure import BadInputError
from passo.gcode import NANOMETRES
from passo.machine_file import MachineFile, read_machine
from passo.part import Part, Played, play_part, read_part
from passo.report import write_json
from passo.run import open_engine, parameters_for
from passo.toolchain import paths

SUMMARY, PICTURE = "summary.json", "path.png"


def run_part(path: Path, machine_path: Path | None, engine: str, out: Path | None, plot: bool) -> bool:
    """Play a part, write the results and say where they are; return whether the motion was exact."""
    if machine_path is None:
        raise BadInputError(f"{path}: G-code needs --machine MACHINE.toml (docs/gcode.md)")
    machine = read_machine(machine_path)
    part = read_part(path, machine)
    out = out or paths.results / "run" / path.stem
    try:
        out.mkdir(parents=True, exist_ok=True)
        for result in (SUMMARY, PICTURE):
            (out / result).unlink(missing_ok=True)
    except OSError as error:
        raise BadInputError(f"{out}: {error.strerror}") from None
    parameters = parameters_for(len(machine.settings.axes))
    with (
        open_engine(engine, parameters, machine.clock_hz) as core,
        progress(path.name, part.chords) as report,
    ):
        played = play_part(part, machine, core, report)
    found = played.problems()
    write_json(_summary(part, machine, played, engine), out / SUMMARY)
    if plot:
        from passo.part_plot import plot_part

        plot_part(played, out / PICTURE)
    for problem in found:
        print(f"{path}: {problem}", file=sys.stderr)
    if part.unread:
        print(f"{path}: {part.unread} lines behind the end of the program are not read", file=sys.stderr)
    if not played.motions:
        print(f"{path}: nothing moved", file=sys.stderr)
    elif not found:
        print(f"{path.name}: {len(part.lines)} lines, {part.chords} chords in {played.seconds:.6g} s")
    print(f"results: {', '.join(str(out / name) for name in (SUMMARY, PICTURE) if (out / name).exists())}")
    return not found


def _summary(part: Part, machine: MachineFile, played: Played, engine: str) -> dict[str, Any]:
    axes = machine.settings.axes
    return {
        "name": part.path.stem,
        "engine": engine,
        "ok": not played.problems(),
        "problems": played.problems(),
        "clock_hz": machine.clock_hz,
        "path_seconds": played.seconds,
        "lines": len(part.lines),
        "unread_lines": part.unread,
        "chords": part.chords,
        "motions": len(played.motions),
        "matched_edges": played.matched_edges,
        "end": {
            "millimetres": [nanometres / NANOMETRES for nanometres in part.end[: len(axes)]],
            "steps": played.end,
        },
        "pulses": [len(clocks) for clocks in played.clocks],
    }
