# SPDX-License-Identifier: MIT
"""The grbl console on the C model: answers, reports, real-time bytes, both stream protocols."""

import os
import re
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from passo.failure import BadInputError
from passo.grbl import Grbl, pseudo_terminal, serve
from passo.machine_file import read_machine
from passo.run import open_engine, parameters_for
from passo.toolchain import paths

from tests.helpers.grbl_console import GrblConsole

MACHINE = read_machine(paths.examples / "gcode" / "machine.toml")
RX = 128  # bytes that senders count with


class Session(GrblConsole):
    """A console with three axes."""

    def __init__(self) -> None:
        super().__init__(open_engine("model", parameters_for(3), MACHINE.clock_hz), MACHINE)
        assert self.take_all() == "\r\nGrbl 1.1h ['$' for help]\r\n"

    def report(self) -> dict[str, str]:
        """A status report: state and fields."""
        (text,) = re.findall(r"<(.*)>", self.line("?"))
        state, *fields = text.split("|")
        return {"state": state, **dict(field.split(":", 1) for field in fields)}


@pytest.fixture
def session() -> Iterator[Session]:
    made = Session()
    yield made
    made.engine.close()


def test_lines_and_their_answers(session: Session) -> None:
    """One answer each, with the number of the error."""
    for text, said in (
        ("G21 G90", "ok"), ("", "ok"), ("G1 X1", "error:22"), ("x0 (rapid)", "ok"), ("G0 X1 X2", "error:25"),
        ("$Z", "error:3"), ("$H", "error:5"), ("G0 X" + "1" * 200, "error:11"), ("$J=X1", "error:22"),
        ("$JX1", "error:16"), ("\x07", "ok"), ("\x7f", "error:1"), ("$10=256", "error:3"),
    ):  # fmt: skip
        assert session.line(text) == said


def test_reports(session: Session) -> None:
    """Fields that senders read; offsets in the first report and after a change."""
    first = session.report()
    assert first["state"] == "Idle" and first["MPos"] == "0.000,0.000,0.000"
    assert first["WCO"] == "0.000,0.000,0.000" and first["FS"] == "0,0" and first["Bf"] == "48,128"
    assert session.report()["Ov"] == "100,100,100"
    assert session.line("N7 G10 L2 P1 X-1.5 Y2") == "ok"
    assert session.report()["WCO"] == "-1.500,2.000,0.000"
    session.line("G1 X30 F6000 M3 S500")
    session.grbl.wait(lambda: False, 0.2)
    moving = session.report()
    assert moving["state"] == "Run" and moving["FS"] == "6000,500" and moving["Ln"] == "7"
    assert 0 < float(moving["MPos"].split(",")[0]) < 28.5
    session.rest()
    assert session.report()["MPos"] == "28.500,0.000,0.000"
    assert session.line("$G").splitlines() == ["[GC:G1 G54 G17 G21 G90 G94 M3 M9 T0 F6000 S500]", "ok"]
    parameters = session.line("$#").splitlines()
    assert parameters[0] == "[G54:-1.500,2.000,0.000]" and parameters[-2:] == [
        "[PRB:0.000,0.000,0.000:0]",
        "ok",
    ]
    settings = session.line("$$").splitlines()
    assert {"$100=80.000", "$110=12000.000", "$122=100.000", "$12=0.002"} < set(settings)


@pytest.mark.sample(1)
def test_hold_and_resume(session: Session) -> None:
    """The path stops on the path, and continues to its exact end."""
    session.line("G1 X30 F6000")
    session.grbl.wait(lambda: False, 0.15)
    session.line("!")
    session.grbl.wait(lambda: False, 0.3)
    held = session.report()
    assert held["state"] == "Hold:0"
    session.grbl.wait(lambda: False, 1)
    assert session.report()["MPos"] == held["MPos"]
    session.line("~")
    session.rest()
    assert session.report()["MPos"] == "30.000,0.000,0.000"


@pytest.mark.parametrize("held", [False, True])
def test_a_reset_in_mid_path(session: Session, held: bool) -> None:
    """Alarm 3, the position is kept, nothing moves before it is unlocked, and the next target is exact."""
    session.line("G1 X30 F6000")
    session.grbl.wait(lambda: False, 0.15)
    if held:
        session.line("!")
        session.grbl.wait(lambda: False, 0.3)
    said = session.line("\x18")
    session.rest()
    said += session.take_all()
    assert "Grbl 1.1h" in said and "unlock" in said
    stopped = session.report()
    assert stopped["state"] == "Alarm" and 0 < float(stopped["MPos"].split(",")[0]) < 30
    assert session.line("G0 X1") == "error:9"
    assert session.line("$X").endswith("ok")
    assert session.line("G0 X-5 Y1") == "ok"
    session.rest()
    assert session.report()["MPos"] == "-5.000,1.000,0.000"


def test_jogs_end_immediately_without_an_alarm(session: Session) -> None:
    session.line("G91 G20")
    assert session.line("$J=G21 G91 X50 F6000") == "ok"
    session.grbl.wait(lambda: False, 0.2)
    assert session.report()["state"] == "Jog"
    assert session.line("G0 X1") == "error:9"
    session.grbl.type(b"\x85")
    session.rest()
    report = session.report()
    assert report["state"] == "Idle" and 0 < float(report["MPos"].split(",")[0]) < 50
    assert "G20" in session.line("$G") and "G91" in session.line("$G")


def test_feed_overrides(session: Session) -> None:
    """Down by the time scale, up by replanning."""
    for codes, percent, feed in ((b"\x92\x92\x94", 79, 2370), (b"\x90\x91\x91\x93", 121, 3630)):
        for code in codes:
            session.grbl.type(bytes([code]))
            session.grbl.poll()
        session.line("G91 G1 X20 F3000")
        session.grbl.wait(lambda: False, 0.25)
        assert abs(int(session.report()["FS"].split(",")[0]) - feed) <= 5
        session.rest()
        assert session.grbl.c.feed == percent


def test_checking_moves_nothing(session: Session) -> None:
    assert "[MSG:Enabled]" in session.line("$C")
    assert session.line("G0 X10") == "ok" and session.line("G2 X1") == "error:22"
    assert "[MSG:Disabled]" in session.line("$C")
    session.rest()
    assert session.report()["MPos"] == "0.000,0.000,0.000"


def test_pauses_and_the_end_of_the_program(session: Session) -> None:
    session.line("G0 X1")
    session.grbl.line(b"M0")
    session.grbl.type(b"G0 X2\n")
    session.grbl.wait(lambda: False, 0.5)
    assert session.report()["MPos"] == "1.000,0.000,0.000"
    session.line("~")
    session.rest()
    said = session.line("M30")
    session.rest()
    assert said == "[MSG:Pgm End]\nok" and session.take_all() == ""
    assert session.report()["MPos"] == "2.000,0.000,0.000"


def test_counting_characters(session: Session) -> None:
    """As many lines under way as 128 bytes hold: the same answers and the same end."""
    lines = [f"G1 X{i % 7} Y{i % 5}.5 F6000\n".encode() for i in range(120)]
    waiting: list[int] = []
    seen = session.grbl.answers
    for line in lines:
        while sum(waiting) + len(line) > RX:
            session.grbl.poll()
            for _ in range(session.grbl.answers - seen):
                waiting.pop(0)
            seen = session.grbl.answers
        session.grbl.type(line)
        waiting.append(len(line))
    session.grbl.wait(lambda: session.grbl.answers == len(lines))
    session.rest()
    assert session.take_all() == "ok\r\n" * len(lines)
    assert session.report()["MPos"] == "0.000,4.500,0.000"


def test_a_full_buffer_is_an_error_and_no_half_line(session: Session) -> None:
    """A line that has lost bytes is not executed."""
    session.grbl.type(b"G0 X1 (" + b"x" * 400 + b")\nG0 X5\n")
    session.grbl.wait(lambda: False, 0.1)
    session.grbl.type(b"\nG0 X2\n")
    session.grbl.wait(lambda: False, 1)
    assert "error:11" in session.take_all()
    assert session.report()["MPos"] == "2.000,0.000,0.000"


def test_the_pseudo_terminal(tmp_path: Path, session: Session) -> None:
    """A sender opens it by its name."""
    link = tmp_path / "grbl"
    with pseudo_terminal(link) as ours:
        grbl = Grbl(session.engine, MACHINE, lambda text: os.write(ours, text.encode()))
        over = threading.Event()
        thread = threading.Thread(target=serve, args=(grbl, ours, over.is_set))
        thread.start()
        try:
            with link.open("r+b", buffering=0) as port:
                port.write(b"$I\nG0 X1\n?")
                said = b""
                while b"ok\r\nok" not in said:
                    said += port.read(100)
        finally:
            over.set()
            thread.join()
    assert b"[VER:1.1h" in said and b"Grbl 1.1h" in said
    assert not link.exists()


def test_the_name_of_a_pseudo_terminal(tmp_path: Path) -> None:
    """A link of an earlier one is replaced, and stays when that one ends; nothing else is touched."""
    link, kept = tmp_path / "grbl", tmp_path / "kept"
    with pseudo_terminal(link):
        first = os.readlink(link)
        with pseudo_terminal(link):
            second = os.readlink(link)
            link.unlink()
            link.symlink_to(first)
        assert os.readlink(link) == first != second
    assert not link.exists()
    kept.write_text("kept")
    link.symlink_to(kept)
    for path in (link, kept, tmp_path):
        with pytest.raises(BadInputError, match="this is no link to a terminal"), pseudo_terminal(path):
            pass
    assert link.is_symlink() and kept.read_text() == "kept"
