# SPDX-License-Identifier: MIT
"""`passo campaign`: many random moves on all processors, by Dask, each judged from outside."""

import json
import os
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from passo.campaign_case import Table, Verdict, cases_for, draw, play, written
from passo.campaign_shrink import shrink
from passo.console import console, stages, table
from passo.failure import BadInputError, Failure
from passo.toolchain import paths

BATCH = 40  # cases of a task
TASKS_PER_WORKER = 3  # that wait for a worker, so that it never does
CONNECT_SECONDS = 5
WORKER_DEATHS_MAX = 10  # that a task outlives
TELL_SECONDS = 10
SHRUNK_MAX = 5  # failures that are shrunk and written


@dataclass(frozen=True)
class Wanted:
    """A campaign. ``jobs`` 0: all processors; ``scheduler``: the address of a running cluster."""

    moves: int
    seed: int
    engine: str = "model"
    jobs: int = 0
    scheduler: str | None = None
    out: Path = Path()


@dataclass
class Batch:
    """What came of some consecutive cases."""

    first: int
    cases: int
    kinds: Counter = field(default_factory=Counter)
    moves: int = 0
    steps: int = 0
    seconds: float = 0  # of the worker
    failures: dict[int, Verdict] = field(default_factory=dict)


def play_batch(seed: int, first: int, cases: int, engine: str) -> Batch:
    """A task: plays cases."""
    batch, began = Batch(first, cases), time.monotonic()
    for number in range(first, first + cases):
        verdict = play(draw(seed, number), engine)
        batch.kinds[verdict.kind] += 1
        batch.moves += verdict.moves
        batch.steps += verdict.steps
        if not verdict.good:
            batch.failures[number] = verdict
    batch.seconds = time.monotonic() - began
    return batch


@contextmanager
def cluster(wanted: Wanted) -> Iterator[Any]:
    """A client of the cluster that was named, or of one on this machine."""
    try:
        import dask
        from distributed import Client, LocalCluster
    except ImportError:
        raise BadInputError("passo campaign needs Dask: pip install 'passo[campaign]'") from None
    dask.config.set({"distributed.scheduler.allowed-failures": WORKER_DEATHS_MAX})
    if wanted.scheduler:
        try:
            client = Client(wanted.scheduler, timeout=CONNECT_SECONDS, set_as_default=False)
        except (OSError, ValueError) as error:
            reason = str(error).splitlines()[0] if str(error) else type(error).__name__
            raise BadInputError(f"--scheduler {wanted.scheduler}: there is no cluster: {reason}") from None
        with client:
            yield client
        return
    jobs = wanted.jobs or len(os.sched_getaffinity(0))
    with (
        LocalCluster(
            n_workers=jobs, threads_per_worker=1, dashboard_address=None, silence_logs="CRITICAL"
        ) as own,
        Client(own, set_as_default=False) as client,
    ):
        yield client


def batches(wanted: Wanted, client: Any) -> Iterator[Batch]:
    """Play all cases, as the workers finish them."""
    from distributed import as_completed

    tasks = (
        (wanted.seed, first, min(BATCH, cases - first), wanted.engine)
        for cases in [cases_for(wanted.moves)]
        for first in range(0, cases, BATCH)
    )

    def submit() -> list[Any]:
        arguments = next(tasks, None)
        return [client.submit(play_batch, *arguments, pure=False)] if arguments else []

    workers = max(1, len(client.scheduler_info(n_workers=-1)["workers"]))
    first = [future for _ in range(TASKS_PER_WORKER * workers) for future in submit()]
    waiting = as_completed(first, loop=client.loop)
    for future in waiting:
        try:
            yield future.result()
        except Exception as error:
            raise Failure(f"a worker failed: {type(error).__name__}: {error}") from None
        for more in submit():
            waiting.add(more)


def run_campaign(wanted: Wanted) -> bool:
    """Run a campaign, write build/campaign.json and failing move files; return whether all was well."""
    if wanted.engine == "rtl":
        play(draw(wanted.seed, 0), "rtl")  # builds what the workers need
    total, tell, began, told = Batch(0, 0), stages(), time.monotonic(), time.monotonic()
    with cluster(wanted) as client:
        workers = len(client.scheduler_info(n_workers=-1)["workers"])
        for batch in batches(wanted, client):
            _add(total, batch)
            for number, verdict in batch.failures.items():
                tell(f"case {number}: {verdict.kind}: {verdict.says}")
            if time.monotonic() - told > TELL_SECONDS:
                told = time.monotonic()
                tell(_progress(total, wanted.moves, told - began))
    seconds = time.monotonic() - began
    for number in sorted(total.failures)[:SHRUNK_MAX]:
        _write_failure(wanted, number, total.failures[number], tell)
    _conclude(wanted, total, workers, seconds)
    return not total.failures


def _add(total: Batch, batch: Batch) -> None:
    for name in ("cases", "moves", "steps", "seconds"):
        setattr(total, name, getattr(total, name) + getattr(batch, name))
    total.kinds.update(batch.kinds)
    total.failures.update(batch.failures)


def _progress(total: Batch, moves: int, seconds: float) -> str:
    rate = total.moves / seconds
    return f"{total.moves:,} of {moves:,} moves, {rate:,.0f} per second, {len(total.failures)} failures"


def _write_failure(wanted: Wanted, number: int, verdict: Verdict, tell: Callable[[str], None]) -> None:
    """The smallest case that fails in the same way, as a move file."""

    def fails(case: Table) -> bool:
        return play(case, wanted.engine).kind == verdict.kind

    tell(f"case {number}: looking for the smallest move file that fails in this way ...")
    case = shrink(draw(wanted.seed, number), fails)
    path = wanted.out / f"campaign-{wanted.seed}-{number}.toml"
    path.write_text(f"# {verdict.kind}: {play(case, wanted.engine).says}\n{written(case)}", encoding="utf-8")
    engine = "model" if wanted.engine == "model" else "both"
    tell(f"case {number}: passo run {path} --engine {engine}")


def _conclude(wanted: Wanted, total: Batch, workers: int, seconds: float) -> None:
    """Print the table, write the figures."""
    figures = {
        "engine": wanted.engine,
        "seed": wanted.seed,
        "workers": workers,
        "cases": total.cases,
        "moves": total.moves,
        "steps": total.steps,
        "refused": total.kinds["refused"],
        "failures": len(total.failures),
        "seconds": round(seconds, 1),
        "moves_per_second": round(total.moves / seconds, 1),
        "moves_per_second_and_worker": round(total.moves / max(total.seconds, 1e-9), 1),
    }
    made = table(f"Campaign on {'the C model' if wanted.engine == 'model' else 'RTL and C model'}", "", "")
    for name, value in figures.items():
        made.add_row(name.replace("_", " "), f"{value:,}" if isinstance(value, int | float) else value)
    console.print(made)
    kinds = {kind: count for kind, count in sorted(total.kinds.items())}
    paths.results.mkdir(parents=True, exist_ok=True)
    text = json.dumps(figures | {"kinds": kinds}, indent=1)
    (paths.results / "campaign.json").write_text(text + "\n", encoding="utf-8")
