# SPDX-License-Identifier: MIT
"""`passo run`: from a move file to a folder of results."""

import sys
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path

from passo.console import passing, progress
from passo.engine import DifferenceError
from passo.failure import BadInputError
from passo.move_file import read_channels
from passo.moves import Channels
from passo.output import check_folder, empty_folder, write_json
from passo.plan import Plan, plan_channels
from passo.report import problems, summarize_channels, total_clocks, write_pulses
from passo.run import Run, execute_channels, open_engine, parameters_of
from passo.scene import Scene
from passo.scene_plan import plan_sections, scene_parameters
from passo.scene_report import summarize_scene, write_scene_pulses
from passo.toolchain import paths
from passo.verdict import STOPPED, scene_verdict
from passo.waves import FILES, Window, check_window, recorded, say_waves, wanted_window, write_view

PULSES, SUMMARY, PICTURE, PAGE = "pulses.csv", "summary.json", "motion.png", "report.html"


@dataclass(frozen=True)
class Wanted:
    """What to write besides the pulses and the summary; `waves` is a window of time."""

    waves: str | None = None
    plot: bool = False
    report: bool = False


def run_file(moves: Path, engine: str, out: Path | None, wanted: Wanted) -> bool:
    """Run the moves, write the results and say where they are; return whether the motion was exact.

    Ctrl-C ends it: KeyboardInterrupt, once the results up to then are written.
    """
    check_folder(out or paths.results, "--out")
    window = wanted_window(wanted.waves, engine)
    file = read_channels(moves)
    if file.setup:
        if window:
            raise BadInputError("--waves is for files without a machine or events")
        return _run_scene(file, engine, out or paths.results / "run" / file.name, wanted)
    parameters = parameters_of(file)
    plans = plan_channels(file, parameters)
    if window:
        check_window(window, file.clock_hz, _longest(plans))
    out = out or paths.results / "run" / file.name
    with open_engine(engine, parameters, file.clock_hz, window is not None) as core:
        _clear(out)
        waves = recorded(core, window, out) if window else nullcontext()
        try:
            with waves, progress(file.name, _longest(plans)) as report:
                runs = execute_channels(file, plans, core, report)
        except DifferenceError as error:
            write_json({"name": file.name, "ok": False, "difference": vars(error)}, out / SUMMARY)
            raise
        if window:
            axes = {own.channel: own.axes for own in file.files}
            write_view(out, parameters, file.clock_hz, axes, runs[0].start - runs[0].late)
    write_pulses(runs, out / PULSES)
    write_json(summarize_channels(file, runs, engine), out / SUMMARY)
    if wanted.plot:
        from passo.plot import plot_file

        plot_file(runs, out)
    if wanted.report:
        from passo.report_page import write_page

        write_page(file, runs, engine, out / PAGE)
    exact = _conclude(file, runs, out, window, wanted)
    if runs[0].canceled:
        raise KeyboardInterrupt
    return exact


def _run_scene(file: Channels, engine: str, out: Path, wanted: Wanted) -> bool:
    """The same for a file with a machine or events."""
    parameters = scene_parameters(file)
    plan_sections(file.files[0], file.setup, parameters)  # says what is wrong before anything is built
    with open_engine(engine, parameters, file.clock_hz) as core:
        _clear(out)
        try:
            with passing(file.name) as report:
                run = Scene(file, core, lambda clock: report(clock / file.clock_hz)).run()
        except DifferenceError as error:
            write_json({"name": file.name, "ok": False, "difference": vars(error)}, out / SUMMARY)
            raise
    write_scene_pulses(run, out / PULSES)
    write_json(summarize_scene(run, engine), out / SUMMARY)
    if wanted.plot:
        from passo.plot_scene import plot_scene

        plot_scene(run, out / PICTURE)
    if wanted.report:
        from passo.report_page import write_scene_page

        write_scene_page(file, run, engine, out / PAGE)
    for problem in run.problems():
        print(f"{file.path}: {problem}", file=sys.stderr)
    edges = "" if run.matched_edges is None else f", {run.matched_edges} edges agree"
    steps = sum(len(run.steps(axis)[0]) for axis in range(run.file.axes))
    print(f"{file.name}: {steps} steps in {run.total_clocks} clocks{edges}")
    for stop in run.stops:
        if not run.sought(stop):
            at = ", ".join(map(str, stop.positions))
            print(f"stop {stop.cause.name} at {at}, clock {stop.clock - run.start}")
    verdict = scene_verdict(run, engine)
    if verdict.outcome == STOPPED:
        print(f"{file.name}: {verdict.text}")
    print(f"results: {out / PULSES}, {out / SUMMARY}")
    for name in [PICTURE] * wanted.plot + [PAGE] * wanted.report:
        print(f"open: {out / name}")
    return not run.problems()


def _longest(plans: list[list[Plan]]) -> int:
    """Clocks of the longest motion."""
    return max(sum(plan.clocks for plan in own) for own in plans)


def _clear(out: Path) -> None:
    """Make the folder and delete the results of an earlier run."""
    pictures = [path.name for path in out.glob("motion_channel_[0-7].png")]
    empty_folder(out, (PULSES, SUMMARY, PICTURE, PAGE, *pictures, *FILES))


def _conclude(file: Channels, runs: list[Run], out: Path, window: Window | None, wanted: Wanted) -> bool:
    """Print the result and which files to open."""
    found = problems(runs)
    for problem in found:
        print(f"{file.path}: {problem}", file=sys.stderr)
    if not found:
        steps = sum(run.commanded(axis)[1] for run in runs for axis in range(run.file.axes))
        where = f" on {len(runs)} channels" if len(runs) > 1 else ""
        edges = "" if runs[0].matched_edges is None else f", {runs[0].matched_edges} edges agree"
        clocks = total_clocks(runs)
        seconds = clocks / file.clock_hz
        print(f"{file.name}: {steps} steps{where} in {clocks} clocks ({seconds:.6g} s){edges}")
    print(f"results: {out / PULSES}, {out / SUMMARY}")
    if window:
        say_waves(out)
    for name in [PICTURE] * wanted.plot + [PAGE] * wanted.report:
        print(f"open: {out / name}")
    return not found
