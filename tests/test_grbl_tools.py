# SPDX-License-Identifier: MIT
"""Tool change, tool lengths by the probe, and outputs at rest, at the pins of the C model."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from passo.grbl_setup import SettingsFile, core_for, machine_at
from passo.machine_file import MachineFile, read_machine
from passo.run import open_engine

from tests.helpers.grbl_console import GrblConsole, watch
from tests.helpers.grbl_machine import MACHINE

ADMIT, SPINDLE, FLOOD = b"\xa3", 1, 4
CHANGE = "[MSG:Tool change: T5]"


@pytest.fixture(scope="module")
def machine(tmp_path_factory: pytest.TempPathFactory) -> MachineFile:
    path = tmp_path_factory.mktemp("tools") / "machine.toml"
    path.write_text(MACHINE)
    return read_machine(path)


@pytest.fixture
def session(machine: MachineFile) -> Iterator[GrblConsole]:
    """Unlocked, at its start; Z touches 50 mm below, whatever its travel."""
    with machine_at("model", machine) as engine:
        engine.levels = watch(engine, "outputs")
        made = GrblConsole(engine, machine)
        made.line("$X")
        yield made


def levels(session: GrblConsole) -> int:
    """Of the digital outputs."""
    return session.engine.levels()


def test_outputs_at_rest(session: GrblConsole) -> None:
    """They change immediately; with the last line of a motion if it is under way; a reset ends them."""
    session.line("M3 S500 M8")
    session.run(0.01)
    assert levels(session) == SPINDLE | FLOOD
    session.line("G1 X-5 F6000")
    session.line("M5")
    assert levels(session) & SPINDLE
    session.rest()
    session.run(0.01)
    assert levels(session) == FLOOD
    session.line("M3")
    session.run(0.01)
    session.send(b"\x18", 0.1)
    assert levels(session) == 0


def test_outputs_of_the_user(session: GrblConsole) -> None:
    """M62 with the line after it, M64 when the motion before has ended; a tool change leaves them."""
    p0, p1 = 16, 32
    session.send(b"M3 S500\nG1 X-5 F6000\nM62 P0\nG1 X-10\nM63 P0\nG1 X-15\nM64 P1\nG1 X-20\n", 0.02)
    seen = []
    for _ in range(200):  # ms
        now = levels(session) & ~SPINDLE, round(-session.fields("MPos")[0], 2)
        seen += [now] if not seen or seen[-1][0] != now[0] else []
        session.run(0.001)
    assert [level for level, _ in seen] == [0, p0, 0, p1]
    for (_, x), wanted in zip(seen[1:], (5, 10, 15), strict=True):
        assert wanted <= x < wanted + 0.5
    assert session.status()["state"] == "Idle" and session.fields("MPos")[0] == -20
    session.send(b"T5 M6\n", 0.1)
    assert levels(session) == p1
    session.send(b"~", 0.1)
    assert levels(session) == SPINDLE | p1
    assert session.line("M65 P1") == "ok"
    session.run(0.01)
    assert levels(session) == SPINDLE


def test_a_dwell_has_the_spindle(session: GrblConsole) -> None:
    """`M3`, `G4`, a line: it turns before the dwell."""
    session.send(b"M3 S500\nG4 P0.5\nG1 X-5 F6000\n", 0.1)
    assert levels(session) == SPINDLE and session.status()["MPos"].startswith("0.000")


def test_a_change(session: GrblConsole) -> None:
    """At rest, spindle and coolant off; lines wait; `~` ends it, and motion waits for the spindle."""
    assert session.line("$394=0.5") == "ok"
    session.send(b"M3 S500 M8\nG1 X-5 F6000\nT5 M6\nG1 X-10\n", 2)
    assert levels(session) == 0 and session.log.count(CHANGE) == 1
    assert session.status()["state"] == "Tool" and session.fields("MPos")[0] == -5
    assert session.answers[-3:] == ["ok"] * 3 and session.grbl.player.gcode.c.loaded == 0
    session.send(b"~", 0.2)
    assert levels(session) == SPINDLE | FLOOD and session.fields("MPos")[0] == -5
    session.run(0.4)
    assert session.fields("MPos")[0] < -5
    session.finish()
    assert session.fields("MPos")[0] == -10 and session.grbl.player.gcode.c.loaded == 5
    assert session.line("M6") == "ok" and session.status()["state"] == "Idle"


def test_the_spindle_comes_up_to_speed(session: GrblConsole) -> None:
    """After each M3, and after a reversal; not after another speed or coolant."""
    session.line("$394=0.5")
    for line, seconds in (("M3 S500", 0.5), ("S600", 0), ("M8", 0), ("M4", 0.5), ("M5", 0), ("M3", 0.5)):
        began = session.engine.clock
        assert session.line(line) == "ok"
        took = (session.engine.clock - began) / session.grbl.machine.clock_hz
        assert seconds <= took < seconds + 0.02, line
    session.send(b"M5\nG1 X-2 F600\nM3 X-3\n", 0.1)
    assert levels(session) == FLOOD and session.fields("MPos")[0] > -2
    session.run(0.3)
    assert levels(session) == SPINDLE | FLOOD and session.fields("MPos")[0] == -2
    session.run(0.5)
    assert session.fields("MPos")[0] < -2


def test_hold_and_door(session: GrblConsole) -> None:
    """`!` does nothing in a change; a door is closed by one `~`, the change ended by the next."""
    session.send(b"T5 M6\nG1 X-1 F6000\n", 0.1)
    session.send(b"!", 0.1)
    assert session.status()["state"] == "Tool"
    session.send(b"\x84", 0.1)
    assert session.status()["state"] == "Door:0"
    session.send(b"~", 0.1)
    assert session.status()["state"] == "Tool" and session.fields("MPos")[0] == 0
    session.send(b"~", 1)
    assert session.fields("MPos")[0] == -1


def test_reset_and_a_second_connection(session: GrblConsole) -> None:
    """The former tool stays, the lines that wait are dropped."""
    session.line("M61 Q3")
    session.send(b"T5 M6\nG1 X-1 F6000\n", 0.1)
    said = session.send(b"\x18", 0.5)
    assert "Grbl 1.1h" in said and session.status()["state"] in ("Idle", "Alarm")
    session.line("$X")
    assert session.grbl.player.gcode.c.loaded == 3 and session.fields("MPos")[0] == 0
    session.send(b"T5 M6\n", 0.1)
    session.send(ADMIT + b"G4 P9\n", 0.1)
    session.send(b"\x18", 0.5)
    session.line("$X")
    assert session.line("G1 X-1 F6000") == "ok"
    session.finish()
    assert session.fields("MPos")[0] == -1


def test_an_alarm_in_a_change(session: GrblConsole) -> None:
    """The lines that wait are refused; `$X` leads back to the change."""
    session.send(b"M61 Q3\nT5 M6\nG1 X-1 F6000\n", 0.1)
    session.send(ADMIT, 0.01)
    session.send(b"G38.2 Z1 F600\n", 3)
    assert "ALARM:5" in session.log and session.status()["state"] == "Alarm"
    session.send(b"$X\n", 0.1)
    assert session.status()["state"] == "Tool"
    z = session.fields("MPos")[2]
    session.send(b"~", 1)
    assert session.fields("MPos")[:3] == [-1, 0, z] and session.grbl.player.gcode.c.loaded == 5


def test_what_is_typed_meanwhile(session: GrblConsole) -> None:
    """Jogs, modes, probes and lines without number; the program continues behind M6 with its own lines."""
    session.line("M3 S500")
    session.send(b"T5 M6\nG1 X-1 F6000\nG1 X-2\n", 0.1)
    answers = len(session.answers)
    session.send(ADMIT, 0.01)
    for number in range(24):  # more than the buffer holds
        session.send(b"$J=G91 Y%d F6000\n" % (1 if number % 2 else -1), 0.1)
    session.send(b"M8\nG91 G1 Y-3 F6000\nG90\n", 1)
    assert session.status()["state"] == "Tool" and levels(session) == 0
    assert session.answers[answers:] == ["ok"] * 27
    assert session.fields("MPos") == [0, -3, 0]
    session.send(b"G1 X5", 0.01)  # without an end
    session.send(b"~", 0.01)
    session.send(b"G1 Y-4\n", 2)
    session.finish()
    assert session.fields("MPos") == [-2, -4, 0] and levels(session) == SPINDLE | FLOOD


def test_one_change_after_the_other(session: GrblConsole) -> None:
    """What was typed in the first one is not in the way of the program that waits in the second one."""
    session.send(b"T5 M6\nG1 X-1 F6000\nT6 M6\nG1 X-2\n", 0.1)
    for y in (-3, -6):
        session.send(ADMIT, 0.01)
        session.send(b"$J=G91 Y-3 F6000\n", 0.3)
        assert session.fields("MPos")[1] == y
        session.send(b"~", 0.3)
    assert session.fields("MPos") == [-2, -6, 0] and session.grbl.player.gcode.c.loaded == 6


def test_a_jog_is_cancelled_meanwhile(session: GrblConsole) -> None:
    session.send(b"T5 M6\nG1 X-1 F6000\n", 0.1)
    session.send(ADMIT, 0.01)
    session.send(b"$J=G91 Y-100 F1000\n", 0.2)
    assert session.status()["state"] == "Jog"
    session.send(b"\x85", 0.5)
    assert session.status()["state"] == "Tool" and -10 < session.fields("MPos")[1] < 0
    session.send(b"~", 1)
    assert session.fields("MPos")[0] == -1


def test_lengths_by_the_probe(session: GrblConsole) -> None:
    """The first tool is the reference; another one has the difference, whatever the probe's first speed."""
    assert session.line("$TLR") == "error:47"
    session.line("G0 Z-40")
    session.rest()
    assert session.line("$TPW").endswith("ok") and session.line("$TLR") == "ok"
    touched = session.fields("MPos")[2] - 4
    assert f"[TLR:{touched:.3f}]" in session.line("$#") and "[TLO:0.000]" in session.line("$#")
    session.grbl.c.reference -= 3_500_000  # as if the first tool had been so much shorter
    assert session.line("$TPW").endswith("ok")
    assert "[TLO:3.500]" in session.line("$#") and abs(session.fields("WCO")[2] - 3.5) < 1e-9
    session.line("G0 Z0")
    session.rest()
    assert session.fields("MPos")[2] == 3.5


def test_a_locked_machine_touches_nothing(session: GrblConsole) -> None:
    """As no other line moves it, and no hold would stop it."""
    session.line("G0 Z-40")
    session.rest()
    session.send(b"G0 X-50\n", 0.1)
    session.send(b"\x18", 0.5)
    assert session.status()["state"] == "Alarm"
    before = session.fields("MPos")
    assert session.line("$TPW") == "error:9"
    session.run(0.3)
    assert session.fields("MPos") == before


def test_a_probe_that_fails(session: GrblConsole) -> None:
    """No contact within the distance: an error, no alarm, the length stays."""
    session.line("$342=5")
    session.line("G43.1 Z2")
    said = session.line("$TPW")
    assert said.endswith("[MSG:Probe failed, try again]\nerror:47")
    assert session.status()["state"] == "Idle" and "[TLO:2.000]" in session.line("$#")
    assert session.fields("MPos")[2] == -5


@pytest.mark.parametrize("reset", [True, False])
def test_a_probe_that_an_estop_ends_is_over(session: GrblConsole, reset: bool) -> None:
    """It owes no answer once the machine is unlocked, or reset and unlocked."""
    session.send(b"$TPW\n", 0.2)
    session.engine.set("estop_n", 0)
    session.run(0.3)
    session.engine.set("estop_n", 1)
    assert session.status()["state"] == "Alarm" and "ALARM:3" in session.log
    if reset:
        session.send(b"\x18", 0.5)
    answered = len(session.answers)
    assert session.line("$X").endswith("ok")
    session.run(0.5)
    assert session.line("G0 X-1") == "ok"
    session.rest()
    assert session.answers[answered:] == ["ok"] * 2 and session.fields("MPos")[0] == -1


def test_a_probe_within_the_travel(session: GrblConsole) -> None:
    """With soft limits the distance ends there: no contact is an error, no alarm."""
    for line in ("$20=1", "$342=100", "$132=20"):
        assert session.line(line) == "ok"
    assert session.line("$TPW").endswith("failed, try again]\nerror:47")
    assert session.status()["state"] == "Idle" and session.fields("MPos")[2] == -20
    session.line("$132=60")
    assert session.line("$TPW").endswith("ok") and -50 < session.fields("MPos")[2] < -45


def test_lengths_are_kept(machine: MachineFile, tmp_path: Path) -> None:
    """In the file of settings; a tool table of the command line is entered into it."""
    kept, given = "[T:5,0.000,0.000,30.000,0.000]", "[T:1,0.000,0.000,2.500,0.000]"
    for tools, expected in (({}, []), ({}, [kept]), ({1: 2.5}, [given, kept])):
        with machine_at("model", machine) as engine:
            session = GrblConsole(engine, machine, SettingsFile(tmp_path / "settings"), tools)
            session.line("$X")
            listed = [line for line in session.line("$#").splitlines() if line.startswith("[T:")]
            assert listed == expected
            assert session.line("G10 L1 P5 Z30") == "ok"
            session.rest()


def test_check_mode(session: GrblConsole) -> None:
    """A change takes no time, and leaves no trace."""
    session.line("$C")
    for line in ("G10 L1 P5 Z3", "T5 M6", "G43", "M3 S100", "G0 X-1"):
        assert session.line(line) == "ok"
    session.line("$C")
    session.run(0.3)
    assert levels(session) == 0 and "[T:" not in session.line("$#")


@pytest.mark.parametrize("word", ["T5 M6", "M61 Q5"])
@pytest.mark.parametrize("ending", ["$C", "G0 X-1000"])
def test_check_mode_leaves_the_tool(session: GrblConsole, word: str, ending: str) -> None:
    """The program that was checked, or failed, changes its tools then; the tool before it is still there."""
    for line in ("$20=1", "M61 Q2", "$C", word):
        assert session.line(line).endswith("ok")
    session.line(ending)
    session.run(0.3)
    session.line("$X")
    session.take()
    assert " T2 " in session.line("$G") and session.line("T2 M6") == "ok"
    assert CHANGE in session.send(b"T5 M6\n", 0.1) and session.status()["state"] == "Tool"


def test_an_input(machine: MachineFile) -> None:
    """M66 waits at rest, at most its time, and says what it has found; `!` stops the time."""
    with open_engine("model", core_for(machine), machine.clock_hz) as engine:
        session = GrblConsole(engine, machine)
        session.line("$X")
        check_input(session)


def check_input(session: GrblConsole) -> None:
    """P2 is the home input of Y."""
    y = 2

    def says(text: str, wanted: str, seconds: float) -> None:
        began = session.engine.clock
        assert session.line(text) == f"[MSG:M66:{wanted}]\nok"
        took = (session.engine.clock - began) / session.grbl.machine.clock_hz
        assert seconds <= took < seconds + 0.02, text

    says("M66 P2", "0", 0)
    says("M66 P2 L4 Q1", "0", 0)
    for wanted in (1, 2, 3):
        says(f"M66 P2 L{wanted} Q0.3", "-1", 0.3)
    for wanted, level in ((1, 1), (4, 0), (3, 1), (2, 0)):
        session.send(b"G1 X%d F6000\nM66 P2 L%d Q9\nG1 X0\n" % (wanted, wanted), 0.5)
        assert session.fields("MPos")[0] == wanted and session.status()["state"] == "Run"
        session.engine.set("home", y * level)
        assert session.send(b"", 0.5) == f"[MSG:M66:{level}]\nok\nok"
        assert session.fields("MPos")[0] == 0
    session.engine.set("probe", 1)
    session.run(0.01)
    says("M66 P0 L3 Q1", "1", 0)
    assert session.line("M66 P4") == session.line("M66 E0") == "error:39"
    session.send(b"M66 P2 L3 Q0.5\n", 0.1)
    assert session.send(b"!", 2) == "" and session.status()["state"].startswith("Hold")
    assert session.send(b"~", 0.5) == "[MSG:M66:-1]\nok"
    session.send(b"M66 P2 L3 Q9\nG1 X-9\n", 0.1)
    session.send(b"\x18", 0.1)
    session.line("$X")
    says("M66 P2 L0", "0", 0)
    assert session.fields("MPos")[0] == 0
    # what changes between a wait that a reset ended and the next one is no edge of that
    for edge, level in ((1, 1), (2, 0)):
        session.send(b"M66 P2 L%d Q9\n" % edge, 0.1)
        session.send(b"\x18", 0.1)
        session.engine.set("home", y * level)
        session.line("$X")
        says(f"M66 P2 L{edge} Q0.3", "-1", 0.3)


@pytest.mark.parametrize("line", ["G1 X-10", "G0 X-10.00001", "G4 P0.01", "G1 X-10.006\nG1 X-10"])
def test_what_follows_without_motion_takes_no_level_along(session: GrblConsole, line: str) -> None:
    """The core never gets a line of no length: what it would have switched switches at rest."""
    session.send(f"M3 S500 M8\nG1 X-10 F6000\nM5\n{line}\n".encode(), 0.05)
    assert levels(session) == SPINDLE | FLOOD
    session.finish()
    session.run(0.05)
    assert session.fields("MPos")[0] == -10 and levels(session) == FLOOD


def test_the_power(session: GrblConsole) -> None:
    """M67 with the line after it, M68 when the motion before has ended, M5 ends it: shares of the time."""
    drain, kept = session.engine.drain, []

    def watched() -> np.ndarray:
        kept.append(drain())
        return kept[-1]

    session.engine.drain = watched
    session.grbl.type(b"M67 E0 Q25\nG1 X-10 F6000\nM68 E0 Q75\nG1 X-20\nM5\nG1 X-30\n")
    session.finish()
    watched()
    events = np.concatenate(kept)
    begins, ends = (np.flatnonzero(np.diff(events["running"].astype(int)) == edge) + 1 for edge in (1, -1))
    assert len(begins) == len(ends) == 2
    at, on = np.diff(events["clock"].astype(float)), events["power"][:-1] & 1
    shares = [on[a:b] @ at[a:b] / at[a:b].sum() for a, b in zip(begins, ends, strict=True)]
    assert abs(shares[0] - 0.25) < 0.01 and 0.3 < shares[1] < 0.45
    assert session.line("M67 E1 Q1").endswith("error:39")
