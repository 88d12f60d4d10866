# SPDX-License-Identifier: MIT
"""The demonstration: all examples on both engines, with pictures, tables and an overview."""

import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from typing import Any

from passo.build import model_library, planner_library, preview_library, rtl_library
from passo.console import console, progress, table
from passo.demo_gantry import gantry_core, run_gantry
from passo.machine_file import read_machine
from passo.move_file import read_channels
from passo.output import make_folder, write_json
from passo.part import read_part
from passo.part_command import play_to
from passo.plan import plan_channels
from passo.plot import plot_file, plot_overview
from passo.plot_scene import plot_scene
from passo.report import summarize_channels, write_pulses
from passo.report_page import write_page, write_scene_page
from passo.run import Run, execute_channels, open_engine, parameters_for, parameters_of
from passo.scene import Scene
from passo.scene_plan import scene_parameters
from passo.scene_report import summarize_scene, write_scene_pulses
from passo.toolchain import paths, short

FOLDER = paths.results / "demo"
EXAMPLES = (
    *("three_axes", "cosine", "sigmoid", "triangle", "there_and_back"),
    *("exact_time", "turn", "sigmoid_alpha", "seven_phases", "straight", "user_shape", "four_motors"),
)
# examples with a machine or events
MACHINES = ("homing", "probing", "hold_and_estop", "closed_loop", "laser", "feeder", "threading")
PROGRAMS = {"engraving": "corexy"}  # G-code and its machine
GANTRY = "gantry"  # a machine that is homed
ALL = (*EXAMPLES, *MACHINES, *PROGRAMS, GANTRY)
LONG = (GANTRY, "laser", "engraving", "four_motors")  # to simulate; these come first


def run_example(name: str) -> tuple[list[Run], dict[str, Any]]:
    """Run an example on both engines and write its files; return its runs and its summary."""
    file = read_channels(paths.examples / f"{name}.toml")
    parameters = parameters_of(file)
    with open_engine("both", parameters, file.clock_hz) as engine:
        runs = execute_channels(file, plan_channels(file, parameters), engine)
    summary = summarize_channels(file, runs, "both")
    out = FOLDER / name
    make_folder(out)
    write_pulses(runs, out / "pulses.csv")
    write_json(summary, out / "summary.json")
    plot_file(runs, out)
    write_page(file, runs, "both", out / "report.html")
    return runs, summary


def run_machine(name: str) -> dict[str, Any]:
    """The same for an example with a machine; return its summary."""
    file = read_channels(paths.examples / f"{name}.toml")
    with open_engine("both", scene_parameters(file), file.clock_hz) as engine:
        run = Scene(file, engine).run()
    summary = summarize_scene(run, "both")
    out = FOLDER / name
    make_folder(out)
    write_scene_pulses(run, out / "pulses.csv")
    write_json(summary, out / "summary.json")
    plot_scene(run, out / "motion.png")
    write_scene_page(file, run, "both", out / "report.html")
    return summary


def run_program(name: str) -> dict[str, Any]:
    """The same for G-code."""
    folder, began = paths.examples / "gcode", time.monotonic()
    machine = read_machine(folder / f"{PROGRAMS[name]}.toml")
    part = read_part(folder / f"{name}.nc", machine)
    played, _, summary = play_to(FOLDER / name, part, machine, "both")
    return {
        **summary,
        "axes": [{"pulses": count} for count in summary["pulses"]],
        "total_seconds": played.seconds,
        "clocks_per_second": played.motions[-1][1] / (time.monotonic() - began),
        "stops": [],
    }


def _run(name: str) -> tuple[list[Run], dict[str, Any]]:
    """Any of them; return the runs of an example without a machine, and the summary."""
    if name in PROGRAMS:
        return [], run_program(name)
    if name == GANTRY:
        return [], run_gantry(paths.examples / "gcode" / f"{name}.toml", FOLDER / name)
    return ([], run_machine(name)) if name in MACHINES else run_example(name)


def _error(summary: dict[str, Any]) -> str:
    """The largest distance from the ideal curve, of the steps or of what an encoder measured."""
    own = [axis["largest_error_steps"] for axis in summary["axes"] if "largest_error_steps" in axis]
    own += [encoder["largest_error_steps"] for encoder in summary.get("encoders", [])]
    own = [error for error in own if error is not None]
    return f"{max(own):.4f} steps" if own else ", ".join(stop["cause"] for stop in summary["stops"][-1:])


def _build_all(pool: ProcessPoolExecutor) -> None:
    """Build what the examples need, side by side and the longest first."""
    files = [read_channels(paths.examples / f"{name}.toml") for name in (*EXAMPLES, *MACHINES)]
    used = {scene_parameters(file) if file.setup else parameters_of(file) for file in files}
    used |= {gantry_core(read_machine(paths.examples / "gcode" / f"{GANTRY}.toml"))}
    used |= {
        parameters_for(len(read_machine(paths.examples / "gcode" / f"{name}.toml").motors))
        for name in PROGRAMS.values()
    }
    cores = sorted(used, key=lambda core: (core.channels, core.encoders), reverse=True)
    waiting = [pool.submit(rtl_library, core) for core in cores]
    waiting += [pool.submit(make) for make in (planner_library, model_library, preview_library)]
    for built in waiting:
        built.result()


def demo() -> bool:
    """Run the demonstration, an example per processor; return whether RTL and model agreed everywhere."""
    results = {}
    with ProcessPoolExecutor() as pool:
        _build_all(pool)
        long = sorted(ALL, key=lambda name: LONG.index(name) if name in LONG else len(LONG))
        waiting = {pool.submit(_run, name): name for name in long}
        with progress("examples", len(waiting)) as report:
            for count, done in enumerate(as_completed(waiting), 1):
                results[waiting[done]] = done.result()
                report(count)
    summaries = {name: results[name][1] for name in ALL}
    for name, summary in summaries.items():
        for problem in summary["problems"]:
            print(f"{name}: {problem}", file=sys.stderr)
    write_json({"ok": all(s["ok"] for s in summaries.values()), "runs": summaries}, FOLDER / "summary.json")
    plot_overview({name: runs[0] for name, (runs, _) in results.items() if runs}, FOLDER / "demo.png")

    shown = table(
        "RTL and C model, compared edge for edge",
        *("move", "steps", "time", "edges compared", "largest error", "clocks/s"),
    )
    for name, summary in summaries.items():
        shown.add_row(
            name,
            f"{sum(axis['pulses'] for axis in summary['axes']):,}",
            f"{summary['total_seconds']:.4f} s",
            f"{summary['matched_edges']:,}",
            _error(summary),
            f"{summary['clocks_per_second'] / 1e6:.1f} M",
        )
    console.print(shown)
    folder = short(FOLDER)
    print(
        f"{folder}/NAME/ has for each move a zoomable report.html, motion.png, and its steps in pulses.csv;"
    )
    print(f"for G-code path.png: {', '.join(PROGRAMS)}; {GANTRY}: motion.png")
    print(f"open: {folder}/demo.png")
    return all(summary["ok"] for summary in summaries.values())
