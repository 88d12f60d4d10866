# SPDX-License-Identifier: MIT
"""Campaigns of random moves: every case once, repeatable, failures shrunk."""

import json
import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from distributed import Client, LocalCluster
from passo import campaign, campaign_case
from passo.campaign import Wanted, batches, cluster, run_campaign
from passo.campaign_case import Verdict, cases_for, draw, moves_of, off_curve, pins_wrong, play, written
from passo.cli import main
from passo.engine import model_engine
from passo.move_file import parse_moves, read_moves
from passo.plan import plan_file
from passo.run import Run, execute, parameters_for
from passo.toolchain import paths

from tests.helpers.random_plans import SEED

FEW = 60


def test_cases_have_the_moves_that_are_wanted() -> None:
    for moves in (1, 2, 3, 9, 10, 11, 99, 1_000_000):
        cases = cases_for(moves)
        assert sum(map(moves_of, range(cases))) >= moves > sum(map(moves_of, range(cases - 1)))


def test_a_case_depends_on_its_number_only() -> None:
    again = [draw(SEED, number) for number in range(FEW)]
    assert [draw(SEED, number) for number in reversed(range(FEW))] == again[::-1]
    assert len({written(case) for case in again}) == FEW
    assert {move["method"] for case in again for move in case["move"]} == {
        *("in_time", "by_speed", "below_speed", "at_speed", "axes", "sigmoid", "jerk")
    }


def test_a_campaign(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["campaign", "--moves", "150", "--seed", str(SEED), "--jobs", "2", "--out", str(tmp_path)]
    assert main(arguments) == 0
    said = capsys.readouterr().out
    figures = json.loads((paths.results / "campaign.json").read_text())
    assert figures["moves"] == 150 and figures["cases"] == cases_for(150) and figures["failures"] == 0
    assert figures["kinds"]["exact"] + figures["refused"] == figures["cases"]
    assert figures["kinds"]["exact"] > figures["refused"]
    assert f"{figures['steps']:,}" in said
    assert list(tmp_path.iterdir()) == []


def test_the_rtl_agrees() -> None:
    for number in range(6):
        verdict = play(draw(SEED, number), "rtl")
        assert verdict.good, verdict.says


def run_of(number: int) -> Run:
    case = draw(SEED, number)
    file = parse_moves(written(case), Path("case"))
    parameters = parameters_for(file.axes)
    with model_engine(parameters, file.clock_hz) as engine:
        return execute(file, plan_file(file, parameters), engine)


def exact_run() -> Run:
    """A run with a turn, long enough to plant a fault in."""
    for number in range(1000):
        if play(draw(SEED, number), "model").kind == "exact":
            run = run_of(number)
            if len(run.steps(0)[0]) > 20 and len(set(run.steps(0)[1])) == 2:
                return run
    raise AssertionError("there is none")


def test_the_judges_see_what_is_wrong() -> None:
    run = exact_run()
    assert pins_wrong(run) == off_curve(run) == run.problems() == []
    pins = run.pins
    # all pulses of axis 0 two steps late
    period = round(np.diff(run.steps(0)[0]).mean())
    run.pins = pins.copy()
    run.pins["clock"] += np.uint64(4 * period)
    assert off_curve(run)
    # each pin timing wants a clock more than the shortest that was made
    run.pins = pins
    own = run.file.pins
    for name in campaign_case.PIN_KEYS:
        least = getattr(own, name)
        object.__setattr__(own, name, 1 << 40)
        assert any(name in problem for problem in pins_wrong(run)), name
        object.__setattr__(own, name, least)


@contextmanager
def here(_: Wanted) -> Iterator[Any]:
    """A cluster in this process, which the test can break."""
    with (
        LocalCluster(processes=False, n_workers=1, threads_per_worker=1, dashboard_address=None) as own,
        Client(own, set_as_default=False) as client,
    ):
        yield client


def test_a_failure_is_shrunk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Cosine ramps of 12 steps and more are said to be wrong."""

    def wrong(case: campaign_case.Table, _: str) -> Verdict:
        for move in case["move"]:
            if move.get("profile") == "cosine" and max(map(abs, move["steps"])) >= 12:
                return Verdict("off its curve", "planted")
        return Verdict("exact", "", len(case["move"]))

    monkeypatch.setattr(campaign, "play", wrong)
    monkeypatch.setattr(campaign, "cluster", here)
    assert not run_campaign(Wanted(30, SEED, out=tmp_path))
    made = sorted(tmp_path.iterdir())
    assert made
    said = capsys.readouterr().out
    for path in made:
        file = read_moves(path)
        assert len(file.moves) == 1 and file.axes == 1 and file.moves[0].profile == "cosine"
        assert 12 <= file.moves[0].steps[0] < 24
        assert f"passo run {path} --engine model" in said.replace("\n", "")
        assert path.read_text().startswith("# off its curve: planted\n")


def test_a_worker_that_dies_loses_nothing() -> None:
    with LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs="CRITICAL"
    ) as own:
        wanted = Wanted(600, SEED, scheduler=own.scheduler_address)
        with cluster(wanted) as client:
            done = []
            for batch in batches(wanted, client):
                if not done:
                    os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)
                done.append(batch)
    numbers = sorted(number for batch in done for number in range(batch.first, batch.first + batch.cases))
    assert numbers == list(range(cases_for(600)))
    assert sum(batch.moves for batch in done) == 600


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--moves", "0"], "--moves 0: at least 1"),
        (["--jobs", "-1"], "--jobs -1: "),
        (["--jobs", "1", "--scheduler", "tcp://127.0.0.1:1"], "--jobs and --scheduler exclude each other"),
        (["--scheduler", "tcp://127.0.0.1:1"], "--scheduler tcp://127.0.0.1:1: there is no cluster"),
        (["--scheduler", "nonsense://x"], "--scheduler nonsense://x: there is no cluster"),
        (["--out", "/no/such/folder"], "--out /no/such/folder: there is no such folder"),
    ],
)
def test_bad_input(
    arguments: list[str], said: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(campaign, "CONNECT_SECONDS", 1)
    assert main(["campaign", *arguments]) == 2
    error = capsys.readouterr().err
    assert error.startswith(said) and error.count("\n") == 1
