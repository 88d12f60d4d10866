# SPDX-License-Identifier: MIT
"""`passo campaign`: repeatable random moves, a judge that sees faults, small files of failures, clusters."""

import json
import os
import signal
import subprocess
import sys
import tomllib
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import pytest
from passo import campaign, campaign_cluster, campaign_play, cli, run_command
from passo.campaign import Campaign, carry_out
from passo.campaign_cluster import local_cluster
from passo.campaign_command import Where, run_campaign
from passo.campaign_forms import FORMS
from passo.campaign_moves import Case, draw, to_toml
from passo.campaign_play import Batch, Outcome, play, play_batch, play_file
from passo.campaign_shrink import shrink
from passo.failure import BadInputError, Failure
from passo.run import Run, execute_channels

MOVES, SEED = 60, 5
PROGRAM = str(Path(sys.executable).parent / "passo")


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with local_cluster(2) as made:
        yield made


@pytest.fixture(scope="module")
def alone() -> Batch:
    """The same cases in this process."""
    return play_batch(SEED, 0, MOVES, "model", play)


# ------------------------------------------------------------------------------------------------ cases ----


def test_a_case_is_a_function_of_seed_and_number() -> None:
    assert draw(1, 77) == draw(1, 77)
    assert draw(1, 77).data != draw(1, 78).data != draw(2, 78).data


def test_cases_have_all_forms_and_profiles() -> None:
    moves = [move for number in range(300) for move in draw(SEED, number).data["move"]]
    told = {move.get("method", "in_time" if "total_time" in move else "by_speed") for move in moves}
    assert told == set(FORMS)
    profiles = {move["profile"] for move in moves if "profile" in move}
    assert profiles == {"linear", "cosine", "sigmoid", "jerk", "user", "shaped"}
    assert {move.get("channel", 0) for move in moves} == {0, 1}


def test_the_file_says_what_was_drawn() -> None:
    for number in range(100):
        case = draw(SEED, number)
        assert tomllib.loads(to_toml(case.data)) == case.data


# ------------------------------------------------------------------------------------------------ judge ----

BACK_AND_FORTH = Case(
    0,
    0,
    {
        "clock_hz": 16_000_000,
        "pins": {
            "step_high": "9clocks",
            "step_low": "7clocks",
            "dir_setup": "30clocks",
            "dir_hold": "20clocks",
        },
        "move": [
            {"steps": [n], "profile": "cosine", "total_time": 0.003, "ramp_time": 0.001} for n in (90, -90)
        ],
    },
)


def shift(run: Run, edge: int, number: int, clocks: int) -> None:
    """Move a rising (1) or falling (-1) edge of axis 0."""
    level = np.concatenate([[0], run.pins["step"] & 1]).astype(int)
    row = np.flatnonzero(np.diff(level) == edge)[number]
    run.pins["clock"][row] = int(run.pins["clock"][row]) + clocks


def turn(run: Run, clocks: int) -> None:
    """Change DIR that number of clocks after the last step forward, or before the first one back."""
    (row,) = np.flatnonzero(np.diff(run.pins["dir"] & 1)) + 1
    begun = run.steps(0)[0] + run.start
    run.pins["clock"][row] = begun[89] + clocks if clocks > 0 else begun[90] + clocks


def turn_and_back(run: Run, number: int) -> None:
    """Invert DIR for 40 clocks, 40 clocks after a step."""
    begun = run.steps(0)[0][number] + run.start + 40
    row = int(np.searchsorted(run.pins["clock"], begun))
    glitch = np.repeat(run.pins[row - 1 : row], 2)
    glitch["clock"] = begun, begun + 40
    glitch["dir"][0] ^= 1
    run.pins = np.insert(run.pins, row, glitch)


def drop(run: Run, number: int) -> None:
    """Remove a pulse of axis 0."""
    rise = run.steps(0)[0][number] + run.start
    run.pins["step"][(run.pins["clock"] >= rise) & (run.pins["clock"] < rise + 9)] &= 0xFE


def later(run: Run, clocks: int) -> None:
    """All steps of axis 0 from the 50th to the 60th."""
    for number in range(50, 60):
        shift(run, 1, number, clocks)
        shift(run, -1, number, clocks)


WRONG: dict[str, tuple[str, Callable[[Run], None]]] = {
    "count": ("count", lambda run: drop(run, 50)),
    "position": ("position", lambda run: run.positions.__setitem__(0, 99)),
    "clocks": ("clocks", lambda run: setattr(run, "total_clocks", run.total_clocks + 1)),
    "high": ("high", lambda run: shift(run, -1, 50, 1)),
    "high, short": ("high", lambda run: shift(run, -1, 50, -1)),
    "setup": ("setup", lambda run: turn(run, -29)),
    "hold": ("hold", lambda run: turn(run, 9 + 7 + 19)),
    "turns": ("turns", lambda run: turn_and_back(run, 89)),
    "turns at the end": ("turns", lambda run: turn_and_back(run, 179)),
    "direction": ("direction", lambda run: run.pins.__setitem__("dir", run.pins["dir"] ^ 1)),
    "late": ("curve", lambda run: later(run, 200)),
    "early": ("curve", lambda run: later(run, -200)),
}


def tampered(fault: Callable[[Run], None], *arguments: Any) -> list[Run]:
    """What the engine did, falsified."""
    runs = execute_channels(*arguments)
    fault(runs[0])
    return runs


def test_a_good_motion_is_accepted() -> None:
    outcome = play(BACK_AND_FORTH, "model")
    assert outcome.fault is None and outcome.counts["steps"] == 180


@pytest.mark.parametrize("name", WRONG)
def test_the_judge_sees(name: str) -> None:
    kind, fault = WRONG[name]
    with mock.patch.object(campaign_play, "execute_channels", partial(tampered, fault)):
        found = play(BACK_AND_FORTH, "model").fault
    assert found and found.kind == kind, found


def test_passo_run_has_the_same_judge(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """So a file of a campaign fails there, too."""
    path, out = BACK_AND_FORTH.write(tmp_path), tmp_path / "out"
    command = ["run", str(path), "--engine", "model", "--out", str(out)]
    assert cli.main(command) == 0
    with mock.patch.object(run_command, "execute_channels", partial(tampered, WRONG["high"][1])):
        assert cli.main(command) == 1
    text = "axis 0, step 50: STEP is high for 10 clocks"
    assert text in capsys.readouterr().err
    assert json.loads((out / "summary.json").read_text())["problems"] == [text]


def test_the_judge_sees_a_short_low_time() -> None:
    move = {"steps": [400], "profile": "linear", "total_time": 0.0008, "ramp_time": 0.0001}
    case = replace(BACK_AND_FORTH, data={**BACK_AND_FORTH.data, "move": [move]})
    assert play(case, "model").fault is None

    def lower(run: Run) -> None:
        gaps = np.diff(run.steps(0)[0])
        n = int(np.argmin(gaps))
        shift(run, 1, n + 1, 9 + 6 - int(gaps[n]))
        shift(run, -1, n + 1, 9 + 6 - int(gaps[n]))

    with mock.patch.object(campaign_play, "execute_channels", partial(tampered, lower)):
        assert play(case, "model").fault.kind == "low"


@pytest.mark.parametrize(
    ("old", "new", "name"),
    [("NO_STEPS", "steps = [0, 0]", "NO_STEPS"), ("RAMP", 'ramp_time = "9000clocks"', "RAMP_TOO_LONG")],
)
def test_a_refusal_has_a_reason(tmp_path: Path, old: str, new: str, name: str) -> None:
    """And one without it is a fault, as is a move that should have been refused."""
    lines = {"NO_STEPS": "steps = [10, 3]", "RAMP": 'ramp_time = "10clocks"'}
    text = 'clock_hz = 16_000_000\n[[move]]\nprofile = "linear"\ntotal_time = "16000clocks"\n'
    path = tmp_path / "moves.toml"
    path.write_text(text + "\n".join(lines.values()).replace(lines[old], new))
    outcome = play_file(path, "model")
    assert outcome.refused.startswith(name) and outcome.fault is None
    path.write_text(text + "\n".join(lines.values()))
    assert play_file(path, "model") == Outcome(counts=Counter(steps=13, clocks=16000, parts=1))
    error = campaign_play.MoveFileError(f"{path}: move 1")
    error.__context__ = __import__("passo.plan").plan.PlanError(name, "of no reason")
    with mock.patch.object(campaign_play, "plan_channels", side_effect=error):
        assert play_file(path, "model").fault.kind == "refusal"


# --------------------------------------------------------------------------------------------- clusters ----


def test_a_campaign_is_repeatable(client: Any, alone: Batch) -> None:
    """On two workers as in one process, every case counted once, in lots of two sizes."""
    for first, moves in ((0, MOVES), (0, 7), (7, MOVES - 7)):
        result = carry_out(Campaign(moves, SEED, first=first), client)
        assert (result.moves, result.faults) == (moves, {})
        if moves == MOVES:
            assert (result.counts, result.refused) == (alone.counts, alone.refused)
    assert alone.counts["steps"] > 1000 and alone.refused.total() < MOVES / 5


def wrong_engine(case: Case, engine: str) -> Outcome:
    """It loses a pulse wherever axis 0 makes more than 25 steps forward."""

    def lose(run: Run) -> None:
        if (run.steps(0)[1] > 0).sum() > 25:
            clocks = run.steps(0)[0] + run.start
            run.pins["step"][run.pins["clock"] == clocks[9]] &= 0xFE

    with mock.patch.object(campaign_play, "execute_channels", partial(tampered, lose)):
        return play(case, engine)


def test_a_failure_is_found_and_shrunk(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """The file that is left fails again, alone, and is small; an engine that is right accepts it."""
    out = tmp_path / "out"
    where = Where(jobs=3, out=out, json=tmp_path / "campaign.json")
    assert not run_campaign(Campaign(12, SEED, player=wrong_engine), where)
    said = capsys.readouterr().out
    summary = json.loads(where.json.read_text())
    numbers = [failure["number"] for failure in summary["failures"]]
    expected = [n for n in range(12) if wrong_engine(draw(SEED, n), "model").fault]
    assert numbers == expected and 0 < len(numbers) < 10
    assert (summary["moves"], summary["workers"]) == (12, 3)
    for number in numbers:
        path = out / f"campaign-{SEED}-{number}.toml"
        assert f"passo run {path} --engine model" in said
        data = tomllib.loads(path.read_text())
        (move,) = data["move"]
        assert len(move.get("steps", move.get("distance", [0]))) == 1
        assert 25 < max(map(abs, move.get("steps", [26]))) <= 51
        assert play_file(path, "model").fault is None
        shown = wrong_engine(Case(SEED, number, data, read_points(out, data)), "model").fault
        assert shown and shown.kind in ("count", "position")


def read_points(folder: Path, data: dict[str, Any]) -> tuple[int, ...]:
    from passo.shape import read_table

    names = [move["table"] for move in data["move"] if "table" in move]
    return read_table(folder / names[0]) if names else ()


def short_moves(path: Path, count: int, steps: int, **values: float) -> Path:
    """A file with as many moves of a few steps at 1 MHz, a slow link."""
    lines = [f"{name} = {value}" for name, value in values.items()]
    move = ["[[move]]", 'method = "jerk"', f"steps = [{steps}]", *lines]
    path.write_text("\n".join(["clock_hz = 1_000_000", *(move * count)]))
    return path


# At speed the core stops; three moves that end at rest make it wait for the third.
STOPS = {"count": 4, "steps": 1, "speed": 240, "acceleration": 391070, "jerk": 4e9}
WAITS = {"count": 3, "steps": 1, "speed": 445, "acceleration": 207170, "jerk": 2.7185e9}
WAITS |= {"start_speed": 300, "stop_speed": 0}


@pytest.mark.parametrize(
    ("moves", "excuse"), [(STOPS, "the core stopped: RAMP_UNDERRUN"), (WAITS, "the motion took")]
)
def test_a_slow_link_excuses_late_ramps(tmp_path: Path, moves: dict[str, float], excuse: str) -> None:
    """The moves end before the link brings the next ones."""
    outcome = campaign_play.play_file(short_moves(tmp_path / "short.toml", **moves), "model")
    assert outcome.refused.startswith(f"LINK_TOO_SLOW: {excuse}")


@pytest.mark.parametrize(
    ("moves", "problem", "kind"),
    [
        (STOPS | {"speed": 0.24}, "the core stopped: RAMP_UNDERRUN: The ramps ran out at speed.", "stop"),
        (STOPS | {"speed": 0.24}, "the motion took 2 clocks instead of 1", "clocks"),
        # late ramps make a motion longer, never shorter
        (STOPS | {"speed": 445, "count": 3}, "the motion took 1 clocks instead of 2", "clocks"),
    ],
)
def test_a_slow_link_excuses_nothing_else(
    tmp_path: Path, moves: dict[str, float], problem: str, kind: str
) -> None:
    file = short_moves(tmp_path / "short.toml", **moves)
    outcome = campaign_play.play_file(file, "model")
    assert outcome == Outcome(counts=outcome.counts)
    with mock.patch.object(Run, "problems", lambda run, steps: [problem]):
        assert campaign_play.play_file(file, "model").fault.kind == kind


def test_shrinking_keeps_the_kind_of_fault() -> None:
    case = next(draw(SEED, n) for n in range(60) if len(draw(SEED, n).data["move"]) == 3)

    def judge(other: Case) -> campaign_play.Fault | None:
        moves = other.data["move"]
        return campaign_play.Fault("a" if len(moves) > 1 else "b", "")

    small, _ = shrink(case, campaign_play.Fault("a", ""), judge)
    assert len(small.data["move"]) == 2


def test_a_worker_that_dies_loses_nothing(client: Any, alone: Batch) -> None:
    """Killed in the middle, with batches at work and results that were not fetched yet."""
    killed: list[int] = []

    def kill(result: Any) -> None:
        if result.moves >= MOVES // 3 and not killed:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    result = carry_out(Campaign(MOVES, SEED), client, kill)
    assert killed and killed[0] not in client.run(os.getpid).values()
    assert (result.moves, result.faults) == (MOVES, {})
    assert (result.counts, result.refused) == (alone.counts, alone.refused)


def test_a_campaign_without_workers_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """It does not wait indefinitely for new ones."""
    from distributed import Client, LocalCluster

    monkeypatch.setattr(campaign, "POLL", 0.5)
    monkeypatch.setattr(campaign, "LONELY", 1)
    gone = pytest.raises(Failure, match="the cluster has had no workers for 1 s")
    with LocalCluster(n_workers=0, dashboard_address=":0") as empty, Client(empty) as lonely, gone:
        carry_out(Campaign(5, 1), lonely)


DEADLY = {3, 4, 6}


def deadly(case: Case, engine: str) -> Outcome:
    """Some cases end their process."""
    if case.number in DEADLY:
        os.kill(os.getpid(), signal.SIGKILL)
    return play(case, engine)


def test_a_case_that_ends_its_process_is_a_failure(client: Any) -> None:
    """Those that were on the same process are not."""
    result = carry_out(Campaign(16, SEED, player=deadly), client)
    assert result.moves == 16
    assert {number: fault.kind for number, fault in result.faults.items()} == dict.fromkeys(DEADLY, "crash")


def test_help_is_fast() -> None:
    """The command imports Dask and numpy only where it needs them."""
    code = "import sys, passo.cli; print({'dask', 'distributed', 'numpy', 'rich'} & sys.modules.keys())"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout == "set()\n"
    done = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, timeout=60)
    assert "campaign" in done.stdout


def test_a_running_cluster(client: Any, tmp_path: Path) -> None:
    """By its address, with the whole command."""
    client.wait_for_workers(2, timeout=60)  # one that another test killed may still be starting
    summary = tmp_path / "deep" / "campaign.json"
    address = client.scheduler.address
    command = [PROGRAM, "campaign", "--moves", "9", "--seed", "5", "--json", summary, "--scheduler", address]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=60, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "9 of 9 moves, 0 failed" in done.stdout
    made = json.loads(summary.read_text())
    assert (made["moves"], made["failures"], made["workers"]) == (9, [], 2)
    assert made["steps"] == play_batch(SEED, 0, 9, "model", play).counts["steps"]
    assert list(tmp_path.iterdir()) == [tmp_path / "deep"]


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["--moves", "0"], "--moves must be at least 1, not 0"),
        (["--moves", "5", "--first", "-1"], "--first must be at least 0, not -1"),
        (["--moves", "5", "--engine", "both"], "--engine must be one of model, rtl, not both"),
        (["--moves", "5", "--jobs", "0"], "--jobs must be at least 1, not 0"),
        (["--moves", "5", "--jobs", "1", "--scheduler", "tcp://127.0.0.1:9"], "are mutually exclusive"),
        (["--moves", "5", "--scheduler", "tcp://127.0.0.1:9"], "tcp://127.0.0.1:9: no scheduler answers"),
        (["--moves", "5", "--scheduler", "nothing"], "--scheduler nothing: "),
        (["--moves", "5", "--out", "/dev/null"], "--out /dev/null: "),
    ],
)
def test_bad_input(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture,
    arguments: list[str],
    reason: str,
) -> None:
    """One line, and nothing is written."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(campaign_cluster, "PATIENCE", 1)
    assert cli.main(["campaign", "--seed", "1", "--json", "x/campaign.json", *arguments]) == 2
    said = capsys.readouterr()
    assert reason in said.err and said.err.count("\n") == 1 and not said.out
    assert list(tmp_path.iterdir()) == []


def test_a_scheduler_without_workers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from distributed import LocalCluster

    monkeypatch.setattr(campaign_cluster, "PATIENCE", 1)
    with LocalCluster(n_workers=0, dashboard_address=":0") as empty, pytest.raises(BadInputError) as error:
        run_campaign(Campaign(5, 1), Where(scheduler=empty.scheduler_address, json=tmp_path / "x.json"))
    assert "the cluster has no workers" in str(error.value)
    assert list(tmp_path.iterdir()) == []
