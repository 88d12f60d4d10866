# SPDX-License-Identifier: MIT
"""What the grbl console answers when, and what it reports of what moves."""

import re

import pytest
from passo import __version__, registers

from tests.helpers.grbl_console import GrblConsole, watch
from tests.helpers.grbl_machine import session

__all__ = ["session"]


def seconds_until_answered(session: GrblConsole, line: str) -> float:
    began = session.engine.clock
    assert session.line(line).endswith("ok")
    return (session.engine.clock - began) / session.grbl.machine.clock_hz


# --------------------------------------------------------------------------------------- what waits for rest


def test_a_dwell_is_answered_when_it_is_over(session: GrblConsole) -> None:
    """After the motion before it; it is no part of the next one."""
    session.line("G1 X-20 F6000")
    assert seconds_until_answered(session, "G4 P0.5") > 0.7
    assert session.fields("MPos")[0] == -20 and session.status()["state"] == "Idle"
    assert seconds_until_answered(session, "G4 P0") < 0.01
    session.run(0.3)
    began = session.engine.clock
    session.line("G1 X-20.1 F6000")
    session.rest()
    assert session.engine.clock - began < 0.2 * session.grbl.machine.clock_hz


def test_a_dwell_is_no_rest(session: GrblConsole) -> None:
    """It runs, it is held by a hold, and what follows waits."""
    session.send(b"G4 P0.3\nM0\n", 0.1)
    assert session.status()["state"] == "Run"
    session.send(b"!")
    session.run(1)
    assert session.send(b"~", 0.15) == "" and session.status()["state"] == "Run"
    session.run(0.1)
    assert session.status()["state"] == "Hold:0" and session.answers[-2:] == ["ok", "ok"]
    session.send(b"~")
    session.finish()
    assert session.status()["state"] == "Idle"


def test_a_reset_ends_a_dwell(session: GrblConsole) -> None:
    session.send(b"G4 P100\n", 0.1)
    assert session.send(b"\x18", 0.1).startswith("Grbl")
    assert seconds_until_answered(session, "G4 P0.1") < 0.2


def test_the_end_of_the_program(session: GrblConsole) -> None:
    """At rest; the message comes before the answer."""
    session.line("G1 X-10 F3000")
    assert seconds_until_answered(session, "M30") > 0.15
    assert session.log.endswith("[MSG:Pgm End]\r\nok\r\n") and session.fields("MPos")[0] == -10


# ------------------------------------------------------------------------------------------------- probes


def test_a_probe_is_told_before_it_is_answered(session: GrblConsole) -> None:
    """Found; away from it; not found without and with an error, and twice in a row."""
    assert re.fullmatch(r"\[PRB:0.000,0.000,-50.0\d\d:1\]\nok", session.line("G38.2 Z-60 F3000"))
    assert session.line("G38.2 Z-60 F3000").splitlines() == ["ALARM:4", "ok"]
    session.run(0.1)
    assert session.line("$X").endswith("ok")
    assert re.fullmatch(r"\[PRB:0.000,0.000,-(50|49).\d\d\d:1\]\nok", session.line("G38.4 Z0 F3000"))
    session.line("G0 Z-20")
    assert session.line("G38.3 Z-30 F3000") == "[PRB:0.000,0.000,-30.000:0]\nok"
    said = session.line("G38.2 Z-35 F3000").splitlines()
    assert said[0] == "ALARM:5" and said[1].endswith(":0]") and said[2:] == ["ok"]
    session.run(0.1)
    assert session.status()["state"] == "Alarm"


@pytest.mark.parametrize("line", ["G38.2 X-300 F6000", "G38.3 Y0.001 F600", "G38.4 Z-300 F6000"])
def test_a_probe_within_soft_limits(session: GrblConsole, line: str) -> None:
    """Alarm 2 before anything moves if its target is outside; it may go to the end of the travel."""
    session.line("$20=1")
    assert session.line(line) == "ALARM:2\nerror:9"
    session.run(0.3)
    assert session.fields("MPos") == [0, 0, 0]
    session.line("$X")
    assert session.line("G38.2 Z-200 F6000").endswith(":1]\nok")


def test_speed_of_probe_and_home(session: GrblConsole) -> None:
    """Along the way, in mm/min."""
    session.send(b"G38.2 Z-60 X-30 F600\n", 0.4)
    assert session.fields("FS")[0] == pytest.approx(600, abs=2)
    session.send(b"!", 0.2)
    assert session.fields("FS")[0] == 0
    session.send(b"\x18", 0.2)
    session.send(b"$H\n", 0.4)
    assert session.fields("FS")[0] == pytest.approx(2400, abs=2)


# ------------------------------------------------------------------------------------------------ reports


def test_the_line_that_moves(session: GrblConsole) -> None:
    """`Ln` is that of the motion, not of what has been read; none at rest."""
    session.send(b"N10 G1 X-20 F6000\nN20 X-40\nN9999999 X-60\n", 0.05)
    seen = []
    while (report := session.status())["state"] == "Run":
        seen.append((report.get("Ln"), -float(report["MPos"].split(",")[0])))
        session.run(0.02)
    assert {line for line, _ in seen if line} == {"10", "20", "9999999"} and "Ln" not in report
    for line, x in seen:
        least, most = {"10": (0, 20), "20": (20, 40), "9999999": (40, 60), None: (0, 60)}[line]
        assert least - 0.3 <= x <= most + 0.3


def test_spindle_and_coolant_of_what_moves(session: GrblConsole) -> None:
    """`FS` and `A`: of the motion; at rest what has been commanded; off is 0."""
    session.send(b"M3 S500 G1 X-10 F6000\nM4 S800 M8 X-20\nM5 X-30\n", 0.05)
    seen = set()
    while (report := session.status())["state"] == "Run":
        seen.add(report["FS"].split(",")[1])
        session.run(0.02)
    assert seen == {"500", "800", "0"} and report["FS"] == "0,0"
    session.line("M3 M7 S400")
    reports = [session.status() for _ in range(3)]
    assert [report["A"] for report in reports if "Ov" in report] == ["SFM"]
    session.send(b"\x9a")
    assert session.status()["FS"] == "0,440"
    assert session.line("$31=700") == "ok" and session.line("M3 S1") == "ok"
    assert session.status()["FS"] == "0,700"


def test_feeds_in_inches(session: GrblConsole) -> None:
    """One decimal; millimeters are rounded."""
    session.line("G20 F0.5")
    assert "F13 " in session.line("$G")
    session.line("$13=1")
    assert "F0.5 " in session.line("$G")
    session.send(b"G1 X-1 F100\n", 0.3)
    assert session.fields("FS")[0] == pytest.approx(100, abs=0.1)


def test_pins_of_the_drives(session: GrblConsole) -> None:
    """Of all motors; the time of `$1` begins with the rest, not with the motion."""
    levels = watch(session.engine, "enable")
    assert session.line("$1=250") == "ok"
    session.line("G1 X-40 F6000")
    session.run(0.1)
    assert levels() == 7
    session.rest()
    session.run(0.2)
    assert levels() == 7
    session.run(0.2)
    assert levels() == 0


def test_drives_that_rest(session: GrblConsole) -> None:
    """`$1`: off after the time, on for the next motion."""
    assert session.line("$1=50") == "ok"
    session.run(0.02)
    assert session.grbl.c.driven
    session.run(0.1)
    assert not session.grbl.c.driven
    session.line("G0 X-1")
    assert session.grbl.c.driven
    session.rest()
    assert session.fields("MPos")[0] == -1
    session.run(0.1)
    assert not session.grbl.c.driven and session.line("$1=255") == "ok" and session.grbl.c.driven


def test_what_it_says_of_itself(session: GrblConsole) -> None:
    """`$I` and `$`, to the letter."""
    numbers = (getattr(registers, f"VERSION_{part}_RESET") for part in ("MAJOR", "MINOR", "PATCH"))
    core = ".".join(map(str, numbers))
    told = f"[VER:1.1h.passo:]\n[OPT:VNM,48,255]\n[FIRMWARE:Passo {__version__}]\n[CORE:{core}:4000000:0]\nok"
    assert session.line("$I") == told
    letters = "$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H $RST= ~ ! ? ctrl-x"
    assert session.line("$") == f"[HLP:{letters}]\nok"


def test_messages(session: GrblConsole) -> None:
    """`(MSG,...)`: when the motion before has ended, in order, before the answer of `M0`; 63 characters."""
    session.send(
        b"(MSG, first)\nG1 X-10 F6000\n(msg,between)\nX-20\nM0 (a) ( Msg, Turn it ) ; (MSG,no)\n", 0.05
    )
    assert session.log.count("[MSG:first]") == 1
    while "[MSG:between]" not in session.log:
        assert -session.fields("MPos")[0] < 10.5
        session.run(0.005)
    assert 9.9 < -session.fields("MPos")[0] < 11.1
    session.run(0.5)
    assert session.log.endswith("[MSG:Turn it ]\r\nok\r\n")
    assert session.status()["state"] == "Hold:0" and session.fields("MPos")[0] == -20
    session.send(b"~")
    assert session.line(f"(MSG,{'x' * 100}) ( MSGX, a) (MS) (print,b)") == f"[MSG:{'x' * 63}]\nok"
    assert session.line("G9 (MSG,no)") == "error:20"
    session.send(b"G1 X-30 F600\n(MSG,dropped)\n", 0.05)
    assert "dropped" not in session.send(b"\x18", 0.5)
