# SPDX-License-Identifier: MIT
"""The command `passo campaign`: checks of the options, progress, and results."""

import argparse
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from passo.campaign import Campaign, Result, carry_out, shrink_all, summary_of
from passo.campaign_cluster import check_workers, jobs_of, local_cluster, prepare, running_cluster
from passo.campaign_moves import Case
from passo.campaign_play import ENGINES
from passo.console import Estimate, console, stages, table
from passo.failure import BadInputError
from passo.output import check_file, check_folder, make_folder, write_json
from passo.pulse_judge import Fault
from passo.toolchain import paths

SHOWN = 10  # failures reported immediately
NAME = "campaign.json"
NUMBER_MAX = 1_000_000_000_000  # of moves
JOBS_MAX = 1000


@dataclass(frozen=True)
class Where:
    """Where a campaign is carried out, and where its results go."""

    jobs: int | None = None
    scheduler: str | None = None
    out: Path = Path()
    json: Path | None = None


def campaign_of(options: argparse.Namespace) -> tuple[Campaign, Where]:
    """What the options say."""
    campaign = Campaign(options.moves, options.seed, options.engine, options.first)
    return campaign, Where(options.jobs, options.scheduler, options.out, options.json)


def run_campaign(campaign: Campaign, where: Where) -> bool:
    """Carry it out, show and write the results; return whether there was no failure.

    Raises BadInputError; KeyboardInterrupt after Ctrl-C, with the results up to then.
    """
    _check(campaign, where)
    summary = where.json or paths.results / NAME
    check_folder(where.out, "--out")
    check_file(summary, "--json", makes=True)
    if local := where.scheduler is None:
        prepare(campaign.engine)  # once, and not in all processes at the same time
    cluster = local_cluster(jobs_of(where.jobs)) if local else running_cluster(where.scheduler)
    with cluster as client:
        check_workers(client, campaign.engine)
        result = carry_out(campaign, client, _Progress(campaign))
        if result.faults and not result.canceled:
            print(f"shrinking {min(len(result.faults), SHOWN)} of {len(result.faults)} failures", flush=True)
        shrunk = [] if result.canceled else shrink_all(result, client)
    make_folder(summary.parent)
    write_json(summary_of(result, shrunk), summary)
    _show(result)
    print(f"results: {summary}")
    if shrunk:
        _show_failures(campaign, shrunk, where.out)
    if result.canceled:
        raise KeyboardInterrupt
    return not result.faults


def _check(campaign: Campaign, where: Where) -> None:
    for option, value, least, most in (
        ("--moves", campaign.moves, 1, NUMBER_MAX),
        ("--first", campaign.first, 0, NUMBER_MAX),
        ("--jobs", 1 if where.jobs is None else where.jobs, 1, JOBS_MAX),
    ):
        if value < least:
            raise BadInputError(f"{option} must be at least {least}, not {value}")
        if value > most:
            raise BadInputError(f"{option} must be at most {most}")
    if campaign.engine not in ENGINES:
        raise BadInputError(f"--engine must be one of {', '.join(ENGINES)}, not {campaign.engine}")
    if where.jobs is not None and where.scheduler is not None:
        raise BadInputError("--jobs and --scheduler are mutually exclusive: a cluster has its own workers")
    if not find_spec("distributed"):
        raise BadInputError("a campaign needs the Python package distributed: pip install 'passo[campaign]'")


class _Progress:
    """Reports new failures immediately, and progress from time to time."""

    def __init__(self, campaign: Campaign):
        self.campaign, self.tell, self.told = campaign, stages(), set[int]()
        self.estimate = Estimate(campaign.moves)

    def __call__(self, result: Result) -> None:
        for number in sorted(result.faults.keys() - self.told):
            self.told.add(number)
            if len(self.told) <= SHOWN:
                fault = result.faults[number]
                self.tell(f"FAIL move {number}: {fault.kind}: {fault.text}")
        done = result.moves == self.campaign.moves
        if self.estimate.is_due() or done:
            rate = result.moves / max(result.seconds, 1e-9)
            left = "" if done else self.estimate.left(result.moves)
            counted = f"{result.moves:,} of {self.campaign.moves:,} moves, {len(result.faults)} failed"
            self.tell(f"{counted}, {rate:.1f} moves/s{left and ', '}{left}")


def _show(result: Result) -> None:
    """The table at the end."""
    campaign, rate = result.campaign, result.moves / max(result.seconds, 1e-9)
    made = table("campaign", "", "")
    rows = {
        "seed": str(campaign.seed),
        "engine": campaign.engine,
        "moves": f"{result.moves:,}",
        "refused": f"{result.refused.total():,}",
        "steps": f"{result.counts['steps']:,}",
        "failures": f"{len(result.faults):,}",
        "seconds": f"{result.seconds:,.1f}",
        "moves/s": f"{rate:,.1f}",
        "moves/s per core": f"{rate / result.workers:,.1f}",
        "moves per CPU second": f"{result.moves / max(result.cpu_seconds, 1e-9):,.1f}",
    }
    if campaign.engine == "rtl":
        rows["edges that agree"] = f"{result.counts['edges']:,}"
    for row in rows.items():
        made.add_row(*row)
    console.print(made)


def _show_failures(campaign: Campaign, shrunk: list[tuple[Case, Fault]], out: Path) -> None:
    """Write their files and say how to repeat them."""
    make_folder(out)
    for case, fault in shrunk:
        path = case.write(out)
        print(f"move {case.number}: {fault.kind}: {fault.text}")
        print(f"  again: passo run {path} --engine {ENGINES[campaign.engine]}")
