# SPDX-License-Identifier: MIT
"""`passo campaign`: random moves on all cores, or on a cluster, by Dask; docs/campaign.md."""

import asyncio
import logging
import os
import time
import uuid
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

from passo.build import Parameters, model_library, planner_library, rtl_library
from passo.campaign_moves import AXES_OF_TWO, Case, draw
from passo.campaign_play import Batch, Player, play, play_batch
from passo.campaign_shrink import shrink
from passo.failure import BadInputError, Failure
from passo.pulse_judge import Fault
from passo.run import AXES_OF_CORES, parameters_for

BATCH = {"model": 40, "rtl": 10}  # cases: about a second
IN_FLIGHT = 4  # batches per worker
SHRUNK = 10  # failures for which a file is written
DEATHS = 2  # of processes that a case may cause before it is one that crashes
PATIENCE = 6  # seconds until a cluster must answer


@dataclass(frozen=True)
class Campaign:
    """The cases `first` .. `first` + `moves` - 1 of a seed."""

    moves: int
    seed: int
    engine: str = "model"
    first: int = 0
    player: Player = play

    def batches(self, workers: int) -> Iterator[tuple[int, int]]:
        """First case and number of cases of each batch; small ones if there are few cases for each worker."""
        size = max(1, min(BATCH[self.engine], self.moves // (4 * workers)))
        end = self.first + self.moves
        return ((first, min(size, end - first)) for first in range(self.first, end, size))


@dataclass
class Result:
    """What was played so far."""

    campaign: Campaign
    workers: int
    counts: Counter[str] = field(default_factory=Counter)
    refused: Counter[str] = field(default_factory=Counter)
    faults: dict[int, Fault] = field(default_factory=dict)
    played: set[int] = field(default_factory=set)  # first case of each batch
    seconds: float = 0
    cpu_seconds: float = 0  # of all workers

    def add(self, batch: Batch) -> None:
        """Count a batch; once, however often it was played."""
        if batch.first in self.played:
            return
        self.played.add(batch.first)
        self.counts += batch.counts
        self.refused += batch.refused
        self.faults |= batch.faults
        self.cpu_seconds += batch.cpu_seconds

    @property
    def moves(self) -> int:
        """Cases played."""
        return self.counts["moves"]


def prepare(engine: str) -> str:
    """Build what the engine needs; return the version of the package."""
    from passo import __version__

    model_library()
    planner_library()
    if engine == "rtl":
        for parameters in (*map(parameters_for, AXES_OF_CORES), Parameters(channels=2, axes=AXES_OF_TWO)):
            rtl_library(parameters)
    return __version__


@contextmanager
def local_cluster(jobs: int) -> Iterator[Any]:
    """A client of workers on this machine, one process each."""
    import dask
    from distributed import Client, LocalCluster

    with (
        quiet(),
        dask.config.set({"distributed.scheduler.allowed-failures": DEATHS}),
        LocalCluster(
            n_workers=jobs,
            threads_per_worker=1,
            processes=True,
            memory_limit=0,
            dashboard_address=":0",
            silence_logs=logging.CRITICAL,
        ) as cluster,
        Client(cluster) as client,
    ):
        client.wait_for_workers(jobs)
        yield client


@contextmanager
def running_cluster(address: str) -> Iterator[Any]:
    """A client of a cluster that is there; raises BadInputError."""
    from distributed import Client

    with quiet():
        _check_address(address)
        with Client(address, timeout=PATIENCE, set_as_default=False) as client:
            try:
                client.wait_for_workers(1, timeout=PATIENCE)
            except TimeoutError:
                raise BadInputError(f"--scheduler {address}: the cluster has no workers") from None
            yield client


def _check_address(address: str) -> None:
    """Raises BadInputError if no scheduler answers there; the client would try for long."""
    from distributed.core import rpc

    async def ask() -> str:
        async with rpc(address) as there:
            return (await there.identity())["type"]

    async def wait() -> str:
        return await asyncio.wait_for(ask(), PATIENCE)

    try:
        kind = asyncio.run(wait())
    except TimeoutError:
        raise BadInputError(f"--scheduler {address}: no scheduler answers") from None
    except (OSError, ValueError) as error:
        reason = str(error.__cause__ or error).partition("\n")[0]
        raise BadInputError(f"--scheduler {address}: {reason}") from None
    if kind != "Scheduler":
        raise BadInputError(f"--scheduler {address}: this is a {kind.lower()}, not a scheduler")


@contextmanager
def quiet() -> Iterator[None]:
    """Without what Dask logs of workers that come and go."""
    logger = logging.getLogger("distributed")
    before = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(before)


def check_workers(client: Any, engine: str) -> None:
    """Have all workers build what they need; raises BadInputError if one has another version of passo."""
    from passo import __version__

    for worker, answer in client.run(prepare, engine, on_error="return").items():
        if isinstance(answer, Exception):
            raise BadInputError(f"worker {worker}: {type(answer).__name__}: {answer}")
        if answer != __version__:
            raise BadInputError(f"worker {worker} has passo {answer}, here is {__version__}")


def carry_out(campaign: Campaign, client: Any, tell: Callable[[Result], None] = lambda _: None) -> Result:
    """Play all cases on the workers of a client; `tell` is called after each batch."""
    from concurrent.futures import CancelledError

    from distributed import KilledWorker, as_completed

    workers = max(1, len(client.scheduler_info(n_workers=-1)["workers"]))
    result, began = Result(campaign, workers), time.monotonic()
    waiting = campaign.batches(workers)
    name = uuid.uuid4().hex  # two campaigns on a cluster do not share results

    def submit(first: int, count: int) -> Any:
        key = f"passo-{name}-{first}-{count}"
        wanted = (campaign.seed, first, count, campaign.engine, campaign.player)
        future = client.submit(play_batch, *wanted, key=key)
        places[key] = first, count
        return future

    places: dict[str, tuple[int, int]] = {}
    left = IN_FLIGHT * workers
    done = as_completed([submit(*one) for one in islice(waiting, left)], loop=client.loop)
    for future in done:
        first, count = places.pop(future.key)
        try:
            result.add(future.result())
        except (CancelledError, OSError) as error:
            raise Failure(f"the cluster is gone: {error}") from None
        except KilledWorker:
            # A case that ends its process is a failure; the others of its batch are not.
            if count == 1:
                text = "the process that played it died, again and again"
                result.add(Batch(first, 1, Counter(moves=1), faults={first: Fault("crash", text)}))
            else:
                done.update([submit(number, 1) for number in range(first, first + count)])
        future.release()
        if (following := next(waiting, None)) is not None:
            done.add(submit(*following))
        result.seconds = time.monotonic() - began
        tell(result)
    if result.moves != campaign.moves:
        raise Failure(f"{result.moves} moves of {campaign.moves} are counted")
    return result


def shrink_case(campaign: Campaign, number: int, fault: Fault) -> tuple[Case, Fault]:
    """The smallest case that fails like this one."""
    case = draw(campaign.seed, number)
    if fault.kind == "crash":
        return case, fault
    return shrink(case, fault, lambda other: campaign.player(other, campaign.engine).fault)


def shrink_all(result: Result, client: Any) -> list[tuple[Case, Fault]]:
    """The first failures, shrunk."""
    from distributed import KilledWorker

    wanted = sorted(result.faults.items())[:SHRUNK]
    futures = [client.submit(shrink_case, result.campaign, *one, pure=False) for one in wanted]
    made = []
    for future, (number, fault) in zip(futures, wanted, strict=True):
        try:
            made.append(future.result())
        except KilledWorker:
            made.append((draw(result.campaign.seed, number), fault))
    return made


def jobs_of(wanted: int | None) -> int:
    """Workers on this machine; by default one for each processor core."""
    return len(os.sched_getaffinity(0)) if wanted is None else wanted


def summary_of(result: Result, shrunk: list[tuple[Case, Fault]]) -> dict[str, Any]:
    """The contents of campaign.json."""
    campaign, seconds = result.campaign, max(result.seconds, 1e-9)
    return {
        "seed": campaign.seed,
        "first": campaign.first,
        "engine": campaign.engine,
        "workers": result.workers,
        "moves": result.moves,
        "refused": dict(sorted(result.refused.items())),
        **{name: result.counts[name] for name in ("steps", "clocks", "edges")},
        "seconds": round(result.seconds, 3),
        "cpu_seconds": round(result.cpu_seconds, 3),
        "moves_per_second": round(result.moves / seconds, 3),
        "moves_per_second_per_worker": round(result.moves / seconds / result.workers, 3),
        "moves_per_cpu_second": round(result.moves / max(result.cpu_seconds, 1e-9), 3),
        "failures": [
            {"number": number, "kind": fault.kind, "text": fault.text}
            for number, fault in sorted(result.faults.items())
        ],
        "files": [f"{case.name}.toml" for case, _ in shrunk],
    }
