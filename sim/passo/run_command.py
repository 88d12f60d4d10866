# SPDX-License-Identifier: MIT
"""`passo run`: from a move file to a folder of results."""

import sys
from pathlib import Path

from passo.console import progress
from passo.engine import DifferenceError
from passo.failure import BadInputError
from passo.move_file import read_moves
from passo.moves import MoveFile
from passo.plan import Plan, plan_file
from passo.report import summarize, write_json, write_pulses
from passo.run import Run, execute, open_engine, parameters_for
from passo.toolchain import paths
from passo.waves import FILES, Window, read_window, record, write_view

PULSES, SUMMARY, PICTURE = "pulses.csv", "summary.json", "motion.png"


def run_file(moves: Path, engine: str, out: Path | None, waves: str | None, plot: bool) -> bool:
    """Run the moves, write the results and say where they are; return whether the motion was exact."""
    window = _read_window(waves, engine)
    file = read_moves(moves)
    parameters = parameters_for(file.axes)
    plans = plan_file(file, parameters)
    if window:
        _check_window(window, file, plans)
    out = out or paths.build / "run" / file.name
    with open_engine(engine, parameters, file.clock_hz, window is not None) as core:
        _clear(out)
        if window:
            record(core, window, out)
        try:
            with progress(file.name, sum(plan.clocks for plan in plans)) as report:
                run = execute(file, plans, core, report)
        except DifferenceError as error:
            write_json({"name": file.name, "ok": False, "difference": vars(error)}, out / SUMMARY)
            raise
        if window:
            core.close_waves()
            write_view(out, parameters, file.axes, file.clock_hz, run.start)
    write_pulses(run, out / PULSES)
    write_json(summarize(run, engine), out / SUMMARY)
    if plot:
        from passo.plot import plot_motion

        plot_motion(run, out / PICTURE)
    return _conclude(run, out, window, plot)


def _read_window(waves: str | None, engine: str) -> Window | None:
    if waves is None:
        return None
    if engine == "model":
        raise BadInputError("--waves needs the RTL: --engine both or rtl")
    try:
        return read_window(waves)
    except ValueError as error:
        raise BadInputError(f"--waves: {error}") from None


def _check_window(window: Window, file: MoveFile, plans: list[Plan]) -> None:
    clocks = sum(plan.clocks for plan in plans)
    if window.clocks(file.clock_hz)[0] >= clocks:
        raise BadInputError(f"--waves: the motion takes only {clocks / file.clock_hz:.6g} s")


def _clear(out: Path) -> None:
    """Make the folder and delete the results of an earlier run."""
    try:
        out.mkdir(parents=True, exist_ok=True)
        for result in (PULSES, SUMMARY, PICTURE, *FILES):
            (out / result).unlink(missing_ok=True)
    except OSError as error:
        raise BadInputError(f"{out}: {error.strerror}") from None


def _conclude(run: Run, out: Path, window: Window | None, plot: bool) -> bool:
    """Print the result and which files to open."""
    problems = run.problems()
    for problem in problems:
        print(f"{run.file.path}: {problem}", file=sys.stderr)
    if not problems:
        steps = sum(run.commanded(axis)[1] for axis in range(run.file.axes))
        edges = "" if run.matched_edges is None else f", {run.matched_edges} edges agree"
        seconds = run.total_clocks / run.file.clock_hz
        print(f"{run.file.name}: {steps} steps in {run.total_clocks} clocks ({seconds:.6g} s){edges}")
    print(f"results: {out / PULSES}, {out / SUMMARY}")
    if window:
        fst, view = (out / name for name in FILES[:2])
        print(f"waves, {fst.stat().st_size / 1e6:.1f} MB; open: gtkwave {view}   or: surfer {fst}")
    if plot:
        print(f"open: {out / PICTURE}")
    return not problems
