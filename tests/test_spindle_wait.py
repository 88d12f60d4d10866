# SPDX-License-Identifier: MIT
"""Motions that wait for the spindle: a time, or until an input says that it is at its speed."""

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import pytest
from passo import make_command
from passo.cli import main
from passo.engine import model_engine
from passo.failure import BadInputError
from passo.grbl_setup import core_for
from passo.linuxcnc_files import HAL, linuxcnc_files
from passo.machine_file import MachineFile, read_machine
from passo.part import Played, core_of, plan_part, play_part, read_part
from passo.run import open_engine
from passo.spindle_at import turning_machine_at

from benchmarks.rigid_tapping import AXIS
from tests.helpers.grbl_console import GrblConsole

HEAD = "clock_hz = 4_000_000\nspindle_maximum = 1000\n"
TURNS = "[spindle]\ncounts = 200\nstart_up = 0.5\n"
PROGRAM = "G1 X1 F600\nM3 S1000\nX2\nX3 M4\nX4\nM5\nX5\n"  # M4 reverses: it takes twice as long
STARTS = 0.3  # s to full speed of a spindle of which the file says nothing


def machine_of(folder: Path, head: str, axes: str = "XYZ") -> MachineFile:
    """A machine without switches that is simulated fast."""
    path = folder / "machine.toml"
    path.write_text(head + "".join(AXIS.format(letter, 80) for letter in axes))
    return read_machine(path)


def played(folder: Path, machine: MachineFile, text: str = PROGRAM) -> Played:
    """What the command plays."""
    path = folder / "part.nc"
    path.write_text(text)
    with model_engine(core_of(machine), machine.clock_hz) as engine:
        return play_part(read_part(path, machine), machine, engine)


@pytest.mark.parametrize(
    ("head", "first", "second"),
    [
        (HEAD + "spindle_wait = 0.7\n", 0.7, 0.7),
        (HEAD + "spindle_wait = 9\nspindle_at_speed = 2\n", STARTS, 2 * STARTS),
        (HEAD + "spindle_wait = 9\nspindle_at_speed = 1\n" + TURNS, 0.5, 1),
        (HEAD, 0, 0),
    ],
)
def test_a_run_waits(tmp_path: Path, head: str, first: float, second: float) -> None:
    """After M3 and after a reversal, also in the line that reverses; not after M5. A preview rests too."""
    machine = machine_of(tmp_path, head)
    made = played(tmp_path, machine)
    assert not made.problems() and made.end == [5 * 80, 0, 0]
    waited = [(begin - end) / machine.clock_hz for (_, end), (begin, _) in pairwise(made.motions)]
    assert len(waited) == 2 * (first > 0)
    for own, wanted in zip(waited, (first, second), strict=False):
        assert wanted <= own < wanted + 0.02
    planned = plan_part(made.part, machine)
    assert sum(planned.ramps["last"]) == len(made.motions)
    assert sum(planned.ramps["ticks"]) * 128 / machine.clock_hz == pytest.approx(made.seconds, rel=1e-3)


def test_a_spindle_that_is_too_slow(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The line, the input, the time, and what to do."""
    machine = machine_of(tmp_path, HEAD + "spindle_wait = 0.4\nspindle_at_speed = 1\n")
    with pytest.raises(BadInputError) as error:
        played(tmp_path, machine)
    said = f"{tmp_path / 'part.nc'}:4: spindle_at_speed: input P1 has not said within 0.4 s that "
    assert str(error.value).startswith(said) and "(LinuxCNC, grblHAL)" in str(error.value)
    command = [
        "run",
        str(tmp_path / "part.nc"),
        "--machine",
        str(machine.path),
        "--out",
        str(tmp_path / "out"),
    ]
    assert main(command) == 2 and "part.nc:4: spindle_at_speed" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("spindle_wait = 61", "spindle_wait must be at most 60 s"),
        (
            "spindle_at_speed = 1",
            "spindle_at_speed: it needs spindle_wait, the seconds after which it is an error",
        ),
        ("spindle_wait = 1\nspindle_at_speed = 4", "spindle_at_speed must be 1 to 3"),
        ("spindle_wait = 1\nspindle_at_speed = 0", "spindle_at_speed must be 1 to 3"),
    ],
)
def test_wrong_files(tmp_path: Path, lines: str, said: str) -> None:
    with pytest.raises(BadInputError, match=said):
        machine_of(tmp_path, f"{HEAD}{lines}\n")


def test_an_input_that_is_taken(tmp_path: Path) -> None:
    """By a home switch; a spindle without speeds is not waited for."""
    text = HEAD + "spindle_wait = 1\nspindle_at_speed = 3\n" + AXIS.format("X", 80) + AXIS.format("Y", 80)
    path = tmp_path / "machine.toml"
    path.write_text(text + AXIS.format("Z", 80) + 'home = "low"\nswitches = ["home"]\n')
    with pytest.raises(BadInputError, match="spindle_at_speed: input P3 is the home switch of axis 3"):
        read_machine(path)
    path.write_text("clock_hz = 4_000_000\nspindle_wait = 1\n" + AXIS.format("X", 80))
    with pytest.raises(BadInputError, match="spindle_wait: it needs spindle_maximum"):
        read_machine(path)


@contextmanager
def console(folder: Path, head: str) -> Iterator[GrblConsole]:
    """At pins that nothing drives, unlocked."""
    machine = machine_of(folder, head)
    with open_engine("model", core_for(machine), machine.clock_hz) as engine:
        made = GrblConsole(engine, machine)
        made.limit(20)
        yield made


WAITS = HEAD + "spindle_wait = 2\nspindle_at_speed = 2\n"
P2 = 0b10  # of the home inputs: that of Y


def test_the_console_waits_for_the_input(tmp_path: Path) -> None:
    """At most $394 seconds, also behind a tool change; a hold stops the time."""
    with console(tmp_path, WAITS) as session:
        assert "$394=2.000" in session.line("$$")
        session.send(b"M3 S500\nG1 X1 F6000\n", 1)
        assert session.fields("MPos")[0] == 0 and session.status()["state"] == "Run"
        session.engine.set("home", P2)
        session.finish()
        assert session.fields("MPos")[0] == 1
        session.engine.set("home", 0)
        session.send(b"T5 M6\nG1 X2\n", 0.5)
        session.send(b"~", 1)
        session.send(b"!", 5)
        assert session.fields("MPos")[0] == 1
        session.send(b"~", 1)
        assert session.fields("MPos")[0] == 1 and "ALARM" not in session.log
        session.engine.set("home", P2)
        session.finish()
        assert session.fields("MPos")[0] == 2


def test_the_input_of_the_former_speed_does_not_count(tmp_path: Path) -> None:
    """It is still high for a moment when the spindle is to reverse."""
    with console(tmp_path, WAITS) as session:
        session.engine.set("home", P2)
        session.line("M3 S500")
        session.send(b"M4\nG1 X1 F6000\n", 0.02)
        session.engine.set("home", 0)
        session.run(0.5)
        assert session.fields("MPos")[0] == 0


def test_the_alarm(tmp_path: Path) -> None:
    """14, as in grblHAL; what waits is refused, the spindle is off, and `$X` continues without it."""
    with console(tmp_path, WAITS) as session:
        session.send(b"M3 S500\nG1 X1 F6000\n", 3)
        assert session.log.count("ALARM:14\r\n") == 1 and session.answers == ["error:9"] * 2
        assert session.status()["state"] == "Alarm" and session.engine.drain()["outputs"][-1:].sum() == 0
        session.line("$X")
        assert "M5" in session.line("$G")
        assert session.line("G1 X1 F6000") == "ok"
        session.finish()
        assert session.fields("MPos")[0] == 1


@pytest.mark.parametrize(
    ("more", "seconds"), [("", STARTS), (TURNS, 0.5), ("[switches]\ninverted = true\n", STARTS)]
)
def test_the_spindle_that_the_console_simulates(tmp_path: Path, more: str, seconds: float) -> None:
    """Its input rises when it is at its speed, in time; half the speed takes half of it."""
    machine = machine_of(tmp_path, WAITS + more)
    with turning_machine_at("model", machine) as (engine, spindle):
        session = GrblConsole(engine, machine, None, None, spindle)
        session.take()
        for line, wanted in (
            ("M3 S1000", seconds),
            ("M4 S500", 1.5 * seconds),
            ("M5", 0),
            ("M3", 0.5 * seconds),
        ):
            began = engine.clock
            assert session.line(line) == "ok"
            took = (engine.clock - began) / machine.clock_hz
            assert wanted <= took + 0.01 and took < wanted + 0.03, line
            session.run(1)


def test_what_is_made_of_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The firmware, the wire, LinuxCNC; the small chip has no room."""
    text = WAITS.replace("clock_hz = 4_000_000", 'board = "hx8k"')
    machine = machine_of(tmp_path, text)
    assert make_command.definitions(machine)["AT_SPEED"] == 2
    assert main(["make", str(machine.path), "--no-build", "--out", str(tmp_path / "out")]) == 2
    assert "spindle_wait: the firmware for STM32F103C8 waits for no spindle" in capsys.readouterr().err
    machine = machine_of(tmp_path, 'chip = "STM32F103CB"\n' + text)
    assert main(["make", str(machine.path), "--no-build", "--out", str(tmp_path / "out")]) == 0
    wiring = (tmp_path / "out" / "wiring.txt").read_text().splitlines()
    assert next(line for line in wiring if line.startswith("home[1]")).endswith("spindle: at its speed")
    assert "$394=2" in make_command.settings_lines(machine)
    hal = "\n".join(linuxcnc_files(machine)[HAL])
    assert "net spindle-ready passo.0.gpio.006.in => spindle.0.at-speed" in hal
    assert "near" not in hal and "setp spindle.0.at-speed" not in hal
