# SPDX-License-Identifier: MIT
"""Check mode of the grbl console."""

import pytest

from tests.helpers.grbl_console import GrblConsole, watch
from tests.helpers.grbl_machine import session, x_of

__all__ = ["session"]
LONG = b"G1 X-50 F3000\n"


@pytest.mark.parametrize(
    "line", ["$J=G91X10F6000", "$H", "$N0=G0X10", "$SLP", "$RST=$", "$#", "$100=90", "$I"]
)
def test_check_mode_takes_nothing_that_moves_or_changes(session: GrblConsole, line: str) -> None:
    """Error 8, and nothing moves."""
    session.line("$C")
    assert session.line(line) == "error:8"
    session.run(0.3)
    assert session.status()["state"] == "Check" and x_of(session) == 0
    assert session.line("$N0=G0X10") == "error:8"
    session.line("$C")
    session.rest()
    assert "$N0=\n" in session.line("$N")


def test_check_mode_checks_the_travel(session: GrblConsole) -> None:
    """Alarm 2 for the line that leaves it, also in the middle of an arc; and check mode is over."""
    session.line("$20=1")
    for line in ("G0 X1", "G2 X-1 I5 J0 F600", "G38.2 Z-300 F600"):
        session.line("$C")
        assert session.line("G0 X-1 Y-1") == "ok"
        said = session.line(line)
        assert said == "ALARM:2\nerror:9"
        session.run(0.1)
        assert session.status()["state"] == "Alarm" and x_of(session) == 0
        session.line("$X")


def test_an_alarm_of_check_mode_leaves_no_trace(session: GrblConsole) -> None:
    """Modes are those of a reset, as they were, so the spindle of the program does not turn."""
    before, outputs = session.line("$G"), watch(session.engine, "outputs")
    session.line("$20=1")
    session.line("$C")
    assert session.line("G20 G91 M3 S800 F100") == "ok"
    assert session.line("G0 X-1000").startswith("ALARM:2")
    session.run(0.2)
    session.line("$X")
    session.rest()
    session.take()
    assert session.line("$G") == before and outputs() == 0


def test_check_mode_leaves_no_trace(session: GrblConsole) -> None:
    """Offsets, modes and the position are those of before; dwells, pauses and probes take no time."""
    before = session.line("$G"), session.line("$#")
    session.line("$C")
    for line in ("G10 L2 P1 X5", "G28.1", "G20 G91 M3 S5", "G4 P100", "M0", "G38.2 Z-1 F9", "G92 X3", "M30"):
        assert session.line(line).endswith("ok")
    assert "Disabled" in session.line("$C")
    session.rest()
    session.take()
    assert (session.line("$G"), session.line("$#")) == before


def test_check_mode_is_for_a_machine_that_is_idle(session: GrblConsole) -> None:
    """Not in Alarm, not in motion."""
    session.send(LONG, 0.1)
    assert session.line("$C") == "error:8"
    session.send(b"\x18", 0.3)
    assert session.status()["state"] == "Alarm" and session.line("$C") == "error:8"
