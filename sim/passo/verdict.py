# SPDX-License-Identifier: MIT
"""The verdict on a run for summary, page and terminal: only what was checked."""

from dataclasses import dataclass
from typing import Any

from passo.run import Run
from passo.scene_run import SceneRun

COMPLETE, STOPPED, FAILED = "complete", "stopped", "failed"


@dataclass(frozen=True)
class Verdict:
    """`outcome` is one of the words above; `stopped` names the cause of the stop that ended the run."""

    outcome: str
    text: str
    stopped: str | None = None

    def summary(self) -> dict[str, Any]:
        """The keys of summary.json."""
        return {"outcome": self.outcome, "verdict": self.text, "stopped": self.stopped}


def verdict_of(runs: list[Run], engine: str, problems: list[str]) -> Verdict:
    """Of moves alone, which have to be complete; `problems` are the faults of their pulses."""
    causes = [run.state.cause.name for run in runs if run.state.cause]
    stopped = causes[0] if causes else None
    if problems:
        return Verdict(FAILED, "; ".join(problems), stopped)
    steps = sum(run.commanded(axis)[1] for run in runs for axis in range(run.file.axes))
    text = f"all {steps:,} steps made at the pins, in the planned time, each on its curve"
    return Verdict(COMPLETE, f"{text}; {_engines(engine, runs[0].matched_edges)}", stopped)


def scene_verdict(run: SceneRun, engine: str) -> Verdict:
    """Of a move file with a machine, whose motions may end at a stop."""
    stops = [stop for stop in run.stops if not run.sought(stop)]
    stopped = stops[-1].cause.name if stops else None
    said = []
    moved = [section for section in run.sections if section.plans or section.kind == "thread"]
    asked, made = sum(run.asked(section) for section in moved), sum(run.made(section) for section in moved)
    if stopped:
        said.append(f"stopped by {stopped} in {_moves(run.sections[-1].numbers)}")
    if moved and run.plain_axes:
        said.append(f"{made:,} of {asked:,} steps made")
    said += [f"tracker of axis {one.axis} at {one.position}" for one in run.trackers]
    if tasks := [
        section.kind for section in run.sections if section not in moved and section.outcome == "OK"
    ]:
        said.append(f"done: {', '.join(dict.fromkeys(tasks))}")
    if run.unmade:
        said.append(f"{_moves(run.unmade)} not started")
    if problems := run.problems():
        return Verdict(FAILED, "; ".join([*problems, *said]), stopped)
    said += ["the core counts what its pins made", _engines(engine, run.matched_edges)]
    complete = not stopped and not run.unmade and made == asked
    return Verdict(COMPLETE if complete else STOPPED, "; ".join(said), stopped)


def _moves(numbers: list[int]) -> str:
    return f"move{'s' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))}"


def _engines(engine: str, matched: int | None) -> str:
    if matched is not None:
        return f"RTL and C model agree in {matched:,} edges"
    return {"rtl": "RTL alone, not compared", "model": "C model alone, not compared"}.get(engine, engine)
