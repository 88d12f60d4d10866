# SPDX-License-Identifier: MIT
"""Motions in step with the spindle through the grbl protocol, at the pins of the C model."""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from passo.cli import main
from passo.engine import moves_of
from passo.grbl import talk
from passo.machine_file import MachineFile, read_machine
from passo.part import FOLLOWS_PER_SECOND, LOOPS_PER_SECOND, Played, core_of
from passo.run import open_engine
from passo.spindle_at import SpindleAt, turning_machine_at

from benchmarks.rigid_tapping import AXIS, STEPS_PER_MM, WITHIN, judge
from tests.helpers.grbl_console import GrblConsole
from tests.test_rigid_tapping import SMALL

FREE, SPIN, PASS = 0, 2, 3  # enum passo_player_step
SPINDLE, REVERSE = 1, 2  # levels
TAP, PLACE = "G33.1 Z0 K.5", 1.5


class Tapping(GrblConsole):
    """With a spindle at the core, and the steps of Z."""

    def __init__(self, engine: Any, machine: MachineFile):
        super().__init__(engine, machine)
        self.spindle = SpindleAt(engine, machine)
        self.events = [engine.drain()]
        self.grbl.poll = self._poll  # type: ignore[method-assign]
        self.limit(10)

    @property
    def step(self) -> int:
        """Of the thread."""
        return int(self.grbl.player.c.thread.step)

    def _poll(self) -> None:
        grbl, clock_hz = self.grbl, self.grbl.machine.clock_hz
        grbl._c.passo_grbl_poll(grbl.c)
        grbl._check()
        power = (
            grbl.player.c.thread.output
            if self.step != FREE
            else grbl._c.passo_gcode_output(grbl.player.gcode.c)
        )
        self.spindle.drive(power & 0xFFFF)
        self.engine.run(clock_hz // (FOLLOWS_PER_SECOND if self.step != FREE else LOOPS_PER_SECOND))
        self.events.append(self.engine.drain())

    def until(self, step: int) -> None:
        """Wait until the thread is there."""
        assert self.grbl.wait(lambda: self.step == step)

    def played(self) -> Played:
        """The steps of Z, from its place at the first one."""
        events = np.concatenate(self.events)
        moves = moves_of(events, 2)
        made = np.flatnonzero(moves)
        return cast(
            Played,
            SimpleNamespace(
                clocks=[[], [], events["clock"][made].astype(np.int64)],
                positions=[[], [], np.cumsum(moves[made])],
                counts=self.spindle.changes(), origin=0, machine=self.grbl.machine,
            ),
        )  # fmt: skip


@contextmanager
def tapping(folder: Path, head: str) -> Iterator[Tapping]:
    path = folder / "machine.toml"
    path.write_text(head + "".join(AXIS.format(name, STEPS_PER_MM if name == "Z" else 80) for name in "XYZ"))
    machine = read_machine(path)
    with open_engine("model", core_of(machine), machine.clock_hz) as engine:
        made = Tapping(engine, machine)
        made.line("$X")
        yield made


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Tapping]:
    with tapping(tmp_path, SMALL) as made:
        yield made


def test_a_tap(tmp_path: Path) -> None:
    """Within a count, whatever the override of the feed; its line is reported, and answered at its end."""
    with tapping(tmp_path, SMALL.replace("4_000_000", "16_000_000")) as session:
        session.send(b"\x92\x92")
        session.send(b"M3 S600\nG1 Z2 F600\nN7 G33.1 Z-4 K1.25\n")
        session.until(PASS)
        status = session.status()
        assert status["state"] == "Run" and status["Ln"] == "7" and status["FS"].endswith(",600")
        answers = session.grbl.answers
        session.rest()
        assert session.fields("MPos")[2] == 2 and session.grbl.answers == answers + 1
        (one,) = judge(session.played())
        session.run(0.05)
        outputs = np.concatenate(session.events)["outputs"] & (SPINDLE | REVERSE)
        # backward only from the target on, although nothing follows
        assert outputs.max() == SPINDLE | REVERSE and outputs[-1] == SPINDLE
    assert one.error <= WITHIN and one.end == one.late == 0


def test_a_hold_is_for_the_end_of_a_thread(session: Tapping) -> None:
    """Not in it, and before it while the spindle comes up to speed."""
    session.send(f"M3 S600\nG0 Z{PLACE}\n{TAP}\n".encode())
    session.until(SPIN)
    session.send(b"!", 0.5)
    assert session.step == SPIN and session.status()["state"] == "Hold:0"
    session.send(b"~")
    session.until(PASS)
    session.send(b"G0 Z4\n")
    session.send(b"!", 0.01)
    assert session.status()["state"] == "Hold:1"
    session.until(FREE)
    session.run(0.5)
    assert session.status()["state"] == "Hold:0" and session.fields("MPos")[2] == PLACE
    session.send(b"~")
    session.rest()
    assert session.fields("MPos")[2] == 4


def test_a_reset_in_a_thread(session: Tapping) -> None:
    """It stops, the position is kept, and the next thread begins as any."""
    for line in ("M3 S600", "G0 Z9", "G33 Z-9 K.5"):
        assert session.line(line) == "ok"
    session.until(PASS)
    session.run(0.5)
    session.send(b"\x18", 0.5)
    assert "ALARM:3" in session.log and session.status()["state"] == "Alarm"
    assert session.line("$X").endswith("ok")
    place = session.fields("MPos")[2]
    assert -9 < place < 9
    session.run(0.3)
    assert session.fields("MPos")[2] == place and session.step == FREE
    session.line("M3 S600")
    assert session.line(f"G33 Z{place - 2:.3f} K.5") == "ok"
    session.rest()
    assert session.fields("MPos")[2] == pytest.approx(place - 2, abs=0.002)


def test_a_thread_that_cannot_be_made(session: Tapping) -> None:
    """Outside the travel; too fast."""
    session.line("M3 S600")
    session.send(b"G33 Z-1 K9\n", 1)
    assert "ALARM:3" in session.log and session.fields("MPos")[2] == 0
    assert session.line("$X").endswith("ok")
    session.grbl.c.limits.limited = True
    session.line("M3 S600")
    session.send(b"G33 Z-300 K.5\n", 0.2)
    assert "ALARM:2" in session.log and session.fields("MPos")[2] == 0


def test_without_an_encoder(tmp_path: Path) -> None:
    """A core that has no inputs for it: error 20."""
    path = tmp_path / "machine.toml"
    path.write_text(SMALL + AXIS.format("X", 80))
    machine = read_machine(path)
    with open_engine("model", core_of(machine), machine.clock_hz) as engine:
        session = GrblConsole(engine, machine)
        session.line("$X")
        session.grbl.c.setup.turn_counts = 0
        assert session.line("$12=0.002") == "ok" and session.line("M3 S60") == "ok"
        assert session.line("G33 X5 K1") == "error:20"


@contextmanager
def turning(folder: Path, head: str = SMALL) -> Iterator[tuple[GrblConsole, list[np.ndarray]]]:
    """What `passo console --grbl` has for a file, and the events of its pins."""
    path = folder / "machine.toml"
    path.write_text(head + "".join(AXIS.format(name, STEPS_PER_MM if name == "Z" else 80) for name in "XZ"))
    machine = read_machine(path)
    with turning_machine_at("model", machine) as (engine, spindle):
        console, drain, events = GrblConsole(engine, machine, None, None, spindle), engine.drain, []
        engine.drain = lambda: events.append(drain())
        console.limit(20)
        yield console, events


def ways(events: list[np.ndarray], axis: int) -> list[int]:
    """Steps of an axis from turn to turn."""
    moves = moves_of(np.concatenate(events), axis)
    moves = moves[moves != 0]
    return [int(part.sum()) for part in np.split(moves, np.flatnonzero(np.diff(moves)) + 1)]


def test_the_console_turns_the_spindle(tmp_path: Path) -> None:
    """G33 and G95 are executed; threads and taps that are typed become such lines, from where the tool is."""
    with turning(tmp_path) as (console, events):
        talk(["$X", "M3 S600", "G0 Z2", "G95 F.5", "G1 X1", "G94", "G33 Z1 K.5"], console.grbl)
        assert console.answers == ["ok"] * 7 and console.fields("MPos") == [1, 1]
        events.clear()
        talk(["G17 G0 Z2 F300", "G84 Z0 R1.5"], console.grbl)
        assert set(console.answers) == {"ok"}
        up, down = ways(events, 1)[:2]  # up to 2, down to 0 and over
        assert up == STEPS_PER_MM and -3 * STEPS_PER_MM < down < -2 * STEPS_PER_MM
        assert console.fields("MPos") == [1, 2]
        events.clear()
        talk(["G18 G0 X4 Z2", "G76 P.5 Z1 I-1 J.2 K.4"], console.grbl)
        assert set(console.answers) == {"ok"} and console.fields("MPos") == [4, 1]
        deep = [way for way in ways(events, 1) if way < 0]
        assert deep == [-STEPS_PER_MM] * 2  # of both depths, 0.2 and 0.4


def test_what_the_console_refuses_of_a_tap(tmp_path: Path) -> None:
    """With its reason; a row of taps ends with another motion, and with the program."""
    with turning(tmp_path) as (console, _):
        talk(["$X", "G17 G0 Z2 F300 S600", "G84 Z0 R1.5"], console.grbl)
        assert console.answers == ["ok", "ok", "error:20"]
        assert "[MSG:G84 needs M3 (LinuxCNC)]\r\nerror:20" in console.log
        console.log = ""
        talk(["M3 S600", "G84 Z1 R1.5", "G80", "X1", "M2", "G1 X2 F600"], console.grbl)
        assert console.answers[-4:] == ["ok", "error:31", "ok", "ok"]
        assert console.fields("MPos") == [2, 2]


def test_diameters_of_a_thread_that_is_typed(tmp_path: Path) -> None:
    """After G7 its X, I, J and K are diameters; G7 stays."""
    with turning(tmp_path) as (console, _):
        talk(["$X", "G7 G18", "M3 S600", "G0 X8 Z2", "G76 P.5 Z1 I-2 J.8 K1"], console.grbl)
        assert set(console.answers) == {"ok"} and console.fields("MPos") == [4, 1]
        talk(["G0 X10"], console.grbl)
        assert console.fields("MPos") == [5, 1]


def test_a_machine_without_the_encoder_refuses(tmp_path: Path) -> None:
    with turning(tmp_path, "clock_hz = 4_000_000\nspindle_maximum = 1000\n") as (console, _):
        talk(["$X", "M3 S600", "G33 Z-1 K1"], console.grbl)
        assert console.answers == ["ok", "ok", "error:20"]


def test_the_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(SMALL + AXIS.format("X", 80) + AXIS.format("Z", STEPS_PER_MM))
    monkeypatch.setattr("sys.stdin", io.StringIO("M3 S600\nG0 Z2\nG33 Z1 K.5\nM30\n?\n"))
    assert main(["console", "--grbl", "--machine", str(path)]) == 0
    told = capsys.readouterr().out
    assert "error" not in told and "MPos:0.000,0.000,1.000" in told
