# SPDX-License-Identifier: MIT
"""The job of a worker: plays a case of a campaign and checks it at the pins."""

import gc
import os
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path

from passo.campaign_moves import Case, draw, to_toml
from passo.campaign_refusals import acceptance_fault, outruns_the_link, refusal_fault
from passo.engine import DifferenceError
from passo.move_file import parse_channels
from passo.move_forms import Points
from passo.moves import Channels, MoveFileError
from passo.plan import PlanError, plan_channels
from passo.pulse_judge import Fault, faults
from passo.run import Run, Steps, execute_channels, open_engine, parameters_of
from passo.shape import parse_table, read_table, table_text

ENGINES = {"model": "model", "rtl": "both"}  # of a campaign; as `passo run` calls them
CLOCKS_MAX = 1 << 25  # longer than any move that is drawn


@dataclass
class Outcome:
    """What became of a case."""

    refused: str = ""  # the reason
    counts: Counter[str] = field(default_factory=Counter)
    fault: Fault | None = None


# Plays the motion of a case on an engine; tests have wrong ones.
Player = Callable[[Case, str], Outcome]


@cache
def _keep_modules() -> None:
    """Once: the collector of garbage need not look again and again through what is loaded by now."""
    gc.freeze()


def play(case: Case, engine: str) -> Outcome:
    """Read the texts of the case as those of files, plan and play it; an exception is a fault, too."""
    _keep_modules()
    table = table_text(case.table) if case.table else ""

    def read(path: Path) -> Points:
        return parse_table(table, path)

    try:
        # the texts stay in memory: files take longer than to read them
        return play_text(to_toml(case.data), Path(f"{case.name}.toml"), engine, read)
    except DifferenceError as error:
        return Outcome(fault=Fault("difference", str(error)))
    except Exception as error:
        return Outcome(fault=Fault(type(error).__name__, str(error).partition("\n")[0]))


def play_file(path: Path, engine: str) -> Outcome:
    """The same for a file, but exceptions of the engine are raised."""
    return play_text(path.read_text(encoding="utf-8"), path, engine)


def play_text(text: str, path: Path, engine: str, read: Callable[[Path], Points] = read_table) -> Outcome:
    """The same for the text of a file; `read` reads the tables that it names."""
    channels = None
    try:
        channels = parse_channels(text, path, read)
        parameters = parameters_of(channels)
        plans = plan_channels(channels, parameters)
    except MoveFileError as error:
        reason = error.__context__ if isinstance(error.__context__, PlanError) else f"FILE: {error}"
        return Outcome(str(reason), fault=refusal_fault(error, channels))
    if fault := acceptance_fault(channels):
        return Outcome(fault=fault)
    clocks = max(sum(plan.clocks for plan in own) for own in plans)
    if clocks > CLOCKS_MAX:
        return Outcome(fault=Fault("length", f"the motion would take {clocks} clocks"))
    with open_engine(ENGINES[engine], parameters, channels.clock_hz) as core:
        runs = execute_channels(channels, plans, core)
    steps = [run.all_steps() for run in runs]
    found = [fault for run, own in zip(runs, steps, strict=True) for fault in faults(run, own)]
    if found and _lacked_ramps(found[0], runs) and outruns_the_link(plans, parameters):
        return Outcome(f"LINK_TOO_SLOW: {found[0].text}")
    if channels.together and len({run.start for run in runs}) > 1:
        found.append(Fault("together", f"the channels started at clocks {[run.start for run in runs]}"))
    return Outcome(counts=_counts(channels, runs, steps), fault=found[0] if found else None)


def _lacked_ramps(fault: Fault, runs: list[Run]) -> bool:
    """Whether ramps may have come late: at speed the core stops then, at rest it waits for them."""
    waited = any(run.total_clocks > run.planned_clocks for run in runs)
    return "RAMP_UNDERRUN" in fault.text or (fault.kind == "clocks" and waited)


def _counts(channels: Channels, runs: list[Run], steps: list[list[Steps]]) -> Counter[str]:
    return Counter(
        steps=sum(len(clocks) for own in steps for clocks, _ in own),
        clocks=max(run.late + run.total_clocks for run in runs),
        edges=runs[0].matched_edges or 0,
        parts=sum(len(file.moves) for file in channels.files),
    )


@dataclass
class Batch:
    """Results of consecutive cases."""

    first: int
    count: int
    counts: Counter[str] = field(default_factory=Counter)
    refused: Counter[str] = field(default_factory=Counter)
    faults: dict[int, Fault] = field(default_factory=dict)  # by number of the case
    cpu_seconds: float = 0  # of the process that played them


APART = """\
import sys, cloudpickle
result, sys.stdout = sys.stdout.buffer, sys.stderr
result.write(cloudpickle.dumps(cloudpickle.load(sys.stdin.buffer)()))
"""


def play_apart(seed: int, first: int, count: int, engine: str, player: Player) -> Batch | None:
    """The same as play_batch() in a process of its own; None if that died."""
    import cloudpickle

    job = cloudpickle.dumps(partial(play_batch, seed, first, count, engine, player))
    path = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", APART], input=job, stdout=subprocess.PIPE, env=path)
    return None if done.returncode else cloudpickle.loads(done.stdout)


def play_batch(seed: int, first: int, count: int, engine: str, player: Player) -> Batch:
    """Draw and play the cases first .. first + count - 1."""
    batch, began = Batch(first, count), time.process_time()
    for number in range(first, first + count):
        outcome = player(draw(seed, number), engine)
        batch.counts += outcome.counts
        batch.counts["moves"] += 1
        if outcome.fault:
            batch.faults[number] = outcome.fault
        elif outcome.refused:
            batch.refused[outcome.refused.partition(":")[0]] += 1
    batch.cpu_seconds = time.process_time() - began
    return batch
