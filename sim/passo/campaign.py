# SPDX-License-Identifier: MIT
"""`passo campaign`: random moves on all CPU cores, or on a Dask cluster; docs/campaign.md."""

import time
import uuid
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

from passo.campaign_moves import Case, draw
from passo.campaign_play import Batch, Player, play, play_apart, play_batch
from passo.campaign_shrink import shrink
from passo.failure import Failure
from passo.pulse_judge import Fault

BATCH = {"model": 100, "rtl": 10}  # cases: about a second
IN_FLIGHT = 4  # batches per worker
SHRUNK = 10  # failures for which a file is written
POLL = 5  # seconds between two looks at the workers
LONELY = 60  # seconds that a campaign waits for new workers


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
    canceled: bool = False

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


def carry_out(campaign: Campaign, client: Any, tell: Callable[[Result], None] = lambda _: None) -> Result:
    """Play all cases on the workers of a client; `tell` is called after each batch."""
    from concurrent.futures import CancelledError

    from distributed import KilledWorker

    workers = max(1, len(client.scheduler_info(n_workers=-1)["workers"]))
    result, began = Result(campaign, workers), time.monotonic()
    waiting = campaign.batches(workers)
    name = uuid.uuid4().hex  # two campaigns on a cluster do not share results

    def submit(play_it: Callable[..., Batch | None], first: int, count: int) -> Any:
        key = f"{play_it.__name__}-{name}-{first}-{count}"
        wanted = (campaign.seed, first, count, campaign.engine, campaign.player)
        future = client.submit(play_it, *wanted, key=key)
        places[key] = first, count
        return future

    places: dict[str, tuple[int, int]] = {}
    running = {submit(play_batch, *one) for one in islice(waiting, IN_FLIGHT * workers)}
    try:
        while running:
            for future in _finished(running, client, lambda: tell(result)):
                running.discard(future)
                first, count = places.pop(future.key)
                try:
                    batch = future.result()
                except (CancelledError, OSError) as error:
                    raise Failure(f"lost the connection to the cluster: {error}") from None
                except KilledWorker:  # whichever case of whichever batch ended it
                    future.release()
                    running.add(submit(play_apart, first, count))
                    continue
                if batch:
                    result.add(batch)
                elif count > 1:
                    running |= {submit(play_apart, number, 1) for number in range(first, first + count)}
                else:
                    fault = Fault("crash", "the process that played it died")
                    result.add(Batch(first, 1, Counter(moves=1), faults={first: fault}))
                future.release()
                running |= {submit(play_batch, *following) for following in islice(waiting, 1)}
                result.seconds = time.monotonic() - began
                tell(result)
    except KeyboardInterrupt:
        client.cancel(list(running))
        result.canceled = True
        return result
    if result.moves != campaign.moves:
        raise Failure(f"only {result.moves} of {campaign.moves} moves were counted")
    return result


def _finished(running: set[Any], client: Any, idle: Callable[[], None]) -> set[Any]:
    """Wait for some futures; raises Failure if there are no workers for long."""
    from distributed import wait

    since = time.monotonic()
    while True:
        try:
            return wait(running, timeout=POLL, return_when="FIRST_COMPLETED").done
        except TimeoutError:
            idle()
        if client.status != "running":
            raise Failure("lost the connection to the cluster")
        if client.nthreads():
            since = time.monotonic()
        elif time.monotonic() - since > LONELY:
            raise Failure(f"the cluster has had no workers for {LONELY} s")


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
