# SPDX-License-Identifier: MIT
"""Trackers on the console (stm32_bridge/console/passo_track_commands.c), at the C model."""

from collections.abc import Iterator

import pytest
from passo.cli import main

from tests.test_console import Bench

LIMITS = "speed=5000 acceleration=200_000"


@pytest.fixture
def bench() -> Iterator[Bench]:
    """Axes 0 and 1 have lines, axis 2 has none."""
    made = Bench(axes=3, trackers=1, tracked=1)
    made.ask("enable")
    yield made
    made.close()


def counted(bench: Bench, axis: int) -> int:
    """Steps at the pins."""
    events = bench.terminal.pulses()
    place, level = 0, 0
    for step, down in zip(events["step"].tolist(), events["dir"].tolist(), strict=True):
        if step >> axis & 1 > level:
            place += -1 if down >> axis & 1 else 1
        level = step >> axis & 1
    return place


def test_a_core_without_trackers_says_so() -> None:
    """Each line."""
    bench = Bench()
    for line in (f"tracker 0 {LIMITS}", "tracker 0", "untrack 0"):
        assert bench.ask(line).startswith("error: NO_TRACKERS: "), line
    bench.close()


def test_a_motor_without_lines(bench: Bench) -> None:
    """Moves cannot move it; it lands on its target beside one."""
    line = "move steps=100,0,5 profile=linear speed=1000 acceleration=10_000"
    assert bench.ask(line).startswith("error: ARGUMENT")
    assert bench.ask(f"tracker 2 {LIMITS}") == "ok"
    assert bench.ask("track -250 axis=2") == "ok"
    assert bench.ask("move steps=400,100 profile=linear speed=2000 acceleration=50_000") == "ok"
    assert bench.tell("tracker 2")["moves"] == "1"
    bench.ask("wait")
    bench.ask("run 0.1")
    now = bench.tell("tracker 2")
    assert (now["position"], now["moves"], now["at_target"]) == ("-250", "0", "1")
    assert (now["speed"], now["acceleration"], now["backlash"]) == ("5000.000", "200000.000", "0")
    assert counted(bench, 2) == -250
    assert bench.tell("position")["position"] == "400,100,0"


def test_backlash(bench: Bench) -> None:
    """The path turns, and the axis goes further; the position is that of the path."""
    assert bench.ask(f"tracker 0 backlash=7 {LIMITS}") == "ok"
    assert bench.ask("track 0") == "ok"
    for steps, at, back in ((100, 100, 0), (-40, 60, 7), (10, 70, 0)):
        assert bench.ask(f"move steps={steps} profile=linear speed=2000 acceleration=50_000") == "ok"
        bench.ask("wait")
        bench.ask("run 0.1")
        assert bench.tell("position")["position"] == f"{at},0,0"
        assert counted(bench, 0) == at - back


def test_it_rests_when_told(bench: Bench) -> None:
    """Limits change only at rest, and stay when others are given."""
    assert bench.ask(f"tracker 2 {LIMITS}") == "ok"
    assert bench.ask("track 100_000 axis=2") == "ok"
    bench.ask("run 0.1")
    assert bench.ask("tracker 2 speed=400").startswith("error: MOVING: ")
    assert bench.ask("untrack 2") == "ok"
    bench.ask("run 0.1")
    now = bench.tell("tracker 2")
    assert (now["moves"], now["enabled"], now["speed"]) == ("0", "0", "5000.000")
    assert bench.ask("tracker 2 speed=400") == "ok"
    assert bench.tell("tracker 2")["acceleration"] == "200000.000"


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("tracker", "axis is missing"),
        ("tracker 3", "axis must be 0 to 2"),
        ("tracker 0 speed=5000", "TRACKER_LIMITS: "),
        ("tracker 0 speed=100 acceleration=1e9", "TRACKER_LIMITS: "),
        (f"tracker 0 backlash=65536 {LIMITS}", "backlash must be 0 to 65535"),
        ("track", "target is missing"),
        ("track 4 axis=1", "axis 1 has no speed: see tracker"),
        ("track 2147483648 axis=0", "target must be"),
        ("untrack", "axis is missing"),
    ],
)
def test_bad_input(bench: Bench, line: str, says: str) -> None:
    """Names the key and the range."""
    assert bench.ask(line).startswith(f"error: {says}")


def test_a_drive_that_is_off(bench: Bench) -> None:
    """A note, or an error if drives must be enabled."""
    assert bench.ask(f"tracker 2 {LIMITS}") == "ok"
    assert bench.ask("disable 2") == "ok"
    bench.ask("config need_enable=1")
    assert bench.ask("track 5 axis=2").startswith("error: ")


def test_options(capsys: pytest.CaptureFixture[str]) -> None:
    """Of the command."""
    assert main(["console", "--tracked", "1"]) == 2
    assert "--tracked needs --trackers" in capsys.readouterr().err
    assert main(["console", "--trackers", "--tracked", "4"]) == 2
    assert "--tracked must be 0 to 3: lines move an axis at least" in capsys.readouterr().err
