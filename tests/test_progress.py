# SPDX-License-Identifier: MIT
"""Progress without a terminal, and what Ctrl-C leaves."""

import json
import os
import re
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from passo import bench, cli, console
from passo.campaign import Campaign, carry_out
from passo.campaign_cluster import local_cluster
from passo.ending import INTERRUPTED
from passo.engine import Engine
from passo.toolchain import paths

from benchmarks import backlash, gcode_compare, hosts_all, rigid_tapping, squaring
from verify.mutants import engine_judge
from verify.mutants import run as mutants
from verify.mutants.fates import Fate


class Clock:
    """Seconds that a test sets."""

    def __init__(self) -> None:
        self.now = 100.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    made = Clock()
    monkeypatch.setattr(console, "time", made)
    return made


def test_a_line_every_ten_seconds(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    """On standard error; none of a work that is done, or that is short."""
    with console.progress("part.nc", 1000) as report:
        for second in range(1, 41):
            clock.now = 100 + second
            report(25 * second)
    said = capsys.readouterr()
    assert said.out == ""
    lines = ["25%, 0:30 left", "50%, 0:20 left", "75%, 0:10 left"]
    assert said.err.splitlines() == [f"part.nc: {line}" for line in lines]


def test_a_count_with_an_estimate(clock: Clock) -> None:
    """As `make verify` and `make report` print it; none at the end."""
    estimate = console.Estimate(1200)
    assert estimate.counted(0) == "0 of 1,200"
    clock.now += 30
    assert estimate.counted(400) == "400 of 1,200, 1:00 left"
    clock.now += 60
    assert estimate.counted(1200) == "1,200 of 1,200"


def test_the_run_of_the_mutants(
    clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of its parts, as it ends them."""

    def play(*_: Any) -> list[Any]:
        clock.now += 60
        return []

    for name in ("run_core", "run_c"):
        monkeypatch.setattr(mutants, name, play)
    monkeypatch.setattr(mutants, "CORES", mutants.CORES[:2])
    monkeypatch.setattr(mutants, "write", lambda *_: None)
    monkeypatch.setattr(sys, "argv", ["run"])
    with pytest.raises(SystemExit, match="False"):
        mutants.main()
    said = capsys.readouterr().out
    names = (*(core.name for core in mutants.CORES), "C")
    for name, counted in zip(names, ("1 of 3, 2:00 left", "2 of 3, 1:00 left", "3 of 3"), strict=True):
        assert f" {name}: done, {counted}\n" in said


def test_a_judge_of_mutants(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every ten, with an estimate."""

    def broken(*_: Any) -> str:
        clock.now += 2
        return "" if clock.now % 4 else "a fault"

    monkeypatch.setattr(engine_judge, "broken", broken)
    monkeypatch.setattr(engine_judge, "_says", lambda *_: "")
    told: list[str] = []
    fates: Any = SimpleNamespace(get=cache(lambda name: Fate(tried=[])), save=lambda: None)
    waiting: Any = [SimpleNamespace(name=str(number), number=number) for number in range(20)]
    check: Any = SimpleNamespace(name="check", judge="judge", case="case", tries=lambda _: True)
    core: Any = SimpleNamespace(name="core")
    engine_judge.judge(core, waiting, fates, Path(), 1, told.append, check)
    assert told == ["core: check: 10 of 20, 0:20 left; 5 live", "core: check: 20 of 20; 10 live"]


@pytest.mark.parametrize(("total", "left"), [(None, ""), (4.0, ", 2:50 left")])
def test_simulated_seconds(
    clock: Clock, capsys: pytest.CaptureFixture[str], total: float | None, left: str
) -> None:
    """With an estimate if their total is known."""
    with console.passing("run", total) as report:
        clock.now += 9
        report(0.1)
        clock.now += 1
        report(0.222222)
    assert capsys.readouterr().err == f"run: 0.222 s simulated{left}\n"


def test_an_estimate_before_anything_is_done(clock: Clock) -> None:
    estimate = console.Estimate(10)
    clock.now += 600
    assert estimate.left(0) == "" and estimate.left(5) == "10:00 left" and estimate.left(10) == "0:00 left"


def test_progress_between_items(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    for item in console.each("files", ("a", "b", "c", "d")):
        clock.now += 11 if item == "a" else 1
    assert capsys.readouterr().err == "files: 25%, 0:33 left\n"


def test_a_stage_that_lasts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Says so while it lasts, with what is left once it is known; nothing when the work has ended."""
    monkeypatch.setattr(console, "EVERY", 0.1)
    monkeypatch.setattr(console, "paths", SimpleNamespace(build=tmp_path))
    for left in ("", ", 0:0[0-9] left"):
        tell = console.stages()
        tell("synthesis")
        time.sleep(0.35 if left else 2.2)
        tell("bitstream")
        del tell
        said = capsys.readouterr()
        assert said.out == "[  0:00] synthesis\n[  0:0%s] bitstream\n" % ("0" if left else "2")
        lines = [line for line in said.err.splitlines() if line.startswith("synthesis: 0:0")]
        assert re.fullmatch(rf"synthesis: 0:0[0-9]{left}", lines[0]), lines
    time.sleep(0.3)
    tell = console.stages()
    tell("packing")
    time.sleep(0.15)
    tell.end()
    assert json.loads((tmp_path / console.LASTED).read_text())["packing"] > 0.1
    capsys.readouterr()
    time.sleep(0.3)
    assert capsys.readouterr().err == ""
    assert json.loads((tmp_path / console.LASTED).read_text())["synthesis"] > 0.3


def test_a_stage_without_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Or with nonsense in it: nothing is known, nothing fails."""
    monkeypatch.setattr(console, "EVERY", 0.0)
    monkeypatch.setattr(console, "paths", SimpleNamespace(build=tmp_path / "none"))
    console._remember("a", 1)
    assert console._durations() == {}
    monkeypatch.setattr(console, "paths", SimpleNamespace(build=tmp_path))
    (tmp_path / console.LASTED).write_text("[")
    assert console._durations() == {}


def test_the_speeds_of_the_engines_when_they_are_interrupted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Those that are measured are shown; the status is that of an interrupt."""
    monkeypatch.setattr(bench.Measurement, "clocks_per_second", interrupt_after(2, lambda _: 3e6))
    assert cli.main(["bench"]) == INTERRUPTED
    said = capsys.readouterr()
    assert said.out.count("3.0 M") == 2 and "canceled" in said.err


def test_a_comparison_that_is_interrupted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The programs until then are counted, and what differs is said."""
    monkeypatch.setattr(gcode_compare, "play_passo", interrupt_after(3, gcode_compare.play_passo))
    monkeypatch.setattr(gcode_compare, "_judge", lambda *_: "another place")
    monkeypatch.setattr(sys, "argv", ["gcode_compare", "--programs", "9", "--seed", "1"])
    assert gcode_compare.main()
    said = capsys.readouterr()
    assert said.out.count("another place") == 3 and "canceled" in said.err
    assert re.search(r"^3 programs: [0-9,]+ lines, .* 3 different$", said.out, re.M)


def test_gantries_that_are_interrupted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Figures of those that are squared; no page."""
    monkeypatch.setattr(squaring, "problems", interrupt_after(2, squaring.problems))
    monkeypatch.setattr(squaring, "write_text", None)
    with pytest.raises(SystemExit, match="canceled"):
        squaring.main(["6"])
    assert capsys.readouterr().out.startswith("2 gantries: at most ")


def commands() -> dict[str, Path]:
    """Modules that the Makefile or a person runs, and their sources."""
    makefile = (paths.root / "Makefile").read_text(encoding="utf-8")
    named = set(re.findall(r"python3? (?:-m )?([\w./]+?)(?:\.py)?(?![\w./])", makefile))
    benchmarks = (paths.root / "benchmarks").glob("*.py")
    named |= {f"benchmarks.{path.stem}" for path in benchmarks if is_program(path)}
    found = {}
    for name in (one.replace("/", ".") for one in named):
        tail = Path(*name.split(".")).with_suffix(".py")
        roots = (paths.root, paths.sim, paths.syn, paths.stm32_bridge)
        found[name] = next(root / tail for root in roots if (root / tail).exists())
    return found


def is_program(path: Path) -> bool:
    return '__name__ == "__main__"' in path.read_text(encoding="utf-8")


# A command whose parts say what is left, or one that takes no longer than two seconds.
PARTS = {
    "verify.run": ("verify.formal.run", "verify.equal.run", "verify.equal.wiring", "verify.soak.parts"),
    "verify.page": (), "verify.formal.page": (), "benchmarks.page": (), "benchmarks.path_page": (),
    "benchmarks.play_case": (), "benchmarks.plan_record": (),
    "tools.check_names": (), "tools.count_words": (), "tools.lint_prose": (), "tools.lint_rtl": (),
    **{f"spec.generate_{what}": () for what in ("registers", "pins", "moves", "shapes", "package", "gcode")},
}  # fmt: skip
TELLS = re.compile(r"from passo\.console import [^\n]*(?:Estimate|stages|progress|each|passing)")


def tells(source: Path) -> bool:
    """Whether a program uses what says how long it still takes, beyond importing it."""
    text = source.read_text(encoding="utf-8")
    called = re.search(r"(?<!def )\b(?:Estimate|stages|progress|each|passing)\(", text)
    return bool(TELLS.search(text) and called)


@pytest.mark.parametrize("name", sorted(commands()))
def test_every_command_says_what_is_left(name: str) -> None:
    """Or its parts do; those of passo are tested below."""
    source = commands()[name]
    if name not in PARTS:
        assert tells(source), f"{name} has no estimate of what is left: see passo.console"
        return
    assert not tells(source), f"{name} is no exception any more"
    for part in PARTS[name]:
        assert tells(paths.root / Path(*part.split(".")).with_suffix(".py")), part


def test_the_exceptions_are_commands() -> None:
    assert PARTS.keys() <= commands().keys()


# The modules behind the commands of passo that compute.
PASSO = {
    *("bench", "campaign_command", "demo", "make_command", "part_command", "preview_command", "run_command"),
    *("terminal",),
}


@pytest.mark.parametrize("name", sorted(PASSO))
def test_every_long_command_of_passo_says_what_is_left(name: str) -> None:
    assert tells(paths.sim / "passo" / f"{name}.py")


@pytest.mark.parametrize("name", ["bench", "grbl_bench", "demo"])
def test_the_measurements_of_the_firmware_say_what_is_left(name: str) -> None:
    assert tells(paths.stm32_bridge / "passo_stm32" / f"{name}.py")


def test_hosts_that_are_interrupted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Parts that are finished stand in their files; there is no page."""

    def part(_: Any) -> Any:
        yield hosts_all.Row("what", "figure", "", True)

    monkeypatch.setattr(hosts_all, "RESULTS", tmp_path)
    monkeypatch.setattr(hosts_all, "PARTS", {name: (name, part) for name in ("one", "two", "three")})
    monkeypatch.setattr(hosts_all, "run", interrupt_after(2, hosts_all.run))
    monkeypatch.setattr(
        hosts_all, "write_text", lambda path, text: path.parent == tmp_path and path.write_text(text)
    )
    monkeypatch.setattr(sys, "argv", ["hosts_all"])
    assert hosts_all.main() == 1
    said = capsys.readouterr()
    assert sorted(path.stem for path in tmp_path.iterdir()) == ["one", "two"]
    assert "hosts: three" in said.out and "canceled" in said.err and "written" not in said.out


def test_taps_that_are_interrupted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Those that are cut are judged."""

    @contextmanager
    def progress(_: str, total: int) -> Iterator[Callable[[int], None]]:
        def report(chords: int) -> None:
            if chords > total / 3:
                raise KeyboardInterrupt

        yield report

    monkeypatch.setattr(rigid_tapping, "progress", progress)
    monkeypatch.setattr(sys, "argv", ["rigid_tapping", "--passes", "2"])
    assert rigid_tapping.main() == 1
    passes = [line for line in capsys.readouterr().out.splitlines() if re.match(r" +\d+ +\d\.\d{4} ", line)]
    assert len(passes) == 1


def test_circles_that_are_interrupted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The one that is made is shown."""
    monkeypatch.setattr(
        backlash, "machine", interrupt_after(1, lambda *_: backlash.Result(np.ones(2), np.ones(2), 1))
    )
    monkeypatch.setattr(sys, "argv", ["backlash"])
    with pytest.raises(SystemExit, match="canceled"):
        backlash.main()
    assert "without trackers" in capsys.readouterr().out


def interrupt_after(calls: int, function: Callable[..., Any]) -> Callable[..., Any]:
    """A function that is interrupted, once."""
    left = [calls]

    def call(*arguments: Any, **named: Any) -> Any:
        left[0] -= 1
        if left[0] == -1:
            raise KeyboardInterrupt
        return function(*arguments, **named)

    return call


def test_a_run_of_moves_that_is_interrupted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The pulses up to then are written, and the status is that of an interrupt."""
    path, out = tmp_path / "moves.toml", tmp_path / "out"
    path.write_text(
        'clock_hz = 16_000_000\n[[move]]\nsteps = [90000]\nprofile = "linear"\n'
        "total_time = 3\nramp_time = 1\n[[move]]\nsteps = [900]\ntotal_time = 1\n"
        'ramp_time = 0.1\nprofile = "linear"\n'
    )
    monkeypatch.setattr(Engine, "run", interrupt_after(12, Engine.run))
    words = ["run", str(path), "--engine", "model", "--out", str(out), "--plot", "--report"]
    assert cli.main(words) == INTERRUPTED
    assert "canceled after" in capsys.readouterr().err
    summary = json.loads((out / "summary.json").read_text())
    assert not summary["ok"] and summary["problems"][0].startswith("canceled after")
    rows = np.loadtxt(out / "pulses.csv", int, delimiter=",", skiprows=1, ndmin=2)
    assert 0 < len(rows) < 90900
    assert (out / "motion.png").exists() and (out / "report.html").exists()


def test_a_campaign_that_is_interrupted() -> None:
    """Its result has the moves played by then; workers leave interrupts to the process that waits."""
    with local_cluster(1) as client:
        tell = interrupt_after(1, lambda _: None)
        result = carry_out(Campaign(100, 1), client, tell)
        assert result.canceled and 0 < result.moves < 100
        (handler,) = client.run(_interrupt).values()
        assert handler == signal.SIG_IGN


def _interrupt() -> int:
    """Of a worker, after an interrupt: who takes it."""
    os.kill(os.getpid(), signal.SIGINT)
    return int(signal.getsignal(signal.SIGINT))
