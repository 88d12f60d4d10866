# SPDX-License-Identifier: MIT
"""The workers of a campaign: local processes, or a running Dask cluster."""

import asyncio
import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from passo.build import Parameters, model_library, planner_library, rtl_library
from passo.campaign_moves import AXES_OF_TWO
from passo.console import leave_interrupts
from passo.failure import BadInputError
from passo.run import AXES_OF_CORES, parameters_for

PATIENCE = 6  # seconds until a cluster must answer
# Workers of this machine may sleep, with all of it. Nobody looks at the profiles that each takes of itself.
LOCAL = {
    "distributed.scheduler.allowed-failures": 0,  # what was on a process that died is played apart
    "distributed.scheduler.worker-ttl": None,
    "distributed.worker.profile.enabled": False,
}


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
        dask.config.set(LOCAL),
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
        client.run(leave_interrupts)
        yield client


@contextmanager
def running_cluster(address: str) -> Iterator[Any]:
    """A client of a running cluster; raises BadInputError."""
    from distributed import Client

    with quiet():
        _check_address(address)
        with Client(address, timeout=PATIENCE) as client:
            try:
                client.wait_for_workers(1, timeout=PATIENCE)
            except TimeoutError:
                lacks = "the cluster has no workers: start 'dask worker'"
                raise BadInputError(f"--scheduler {address}: {lacks}") from None
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
        raise BadInputError(f"--scheduler {address}: no scheduler answers: start 'dask scheduler'") from None
    except (OSError, ValueError) as error:
        reason = str(error.__cause__ or error).partition("\n")[0]
        raise BadInputError(f"--scheduler {address}: {reason}") from None
    if kind != "Scheduler":
        raise BadInputError(f"--scheduler {address}: not a scheduler but a {kind.lower()}")


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
            raise BadInputError(f"worker {worker} runs passo {answer}, this is passo {__version__}")


def jobs_of(wanted: int | None) -> int:
    """Workers on this machine; by default one for each processor core."""
    return len(os.sched_getaffinity(0)) if wanted is None else wanted
