# SPDX-License-Identifier: MIT
"""Real-time requests of the grbl console, in batches and in every state; the lines around them."""

import pytest

from tests.helpers.grbl_console import GrblConsole
from tests.helpers.grbl_machine import session, x_of

__all__ = ["session"]
LONG = b"G1 X-50 F3000\n"


# -------------------------------------------------------------------------------- holds and their batches


@pytest.mark.parametrize(("batch", "state"), [(b"!~", "Hold:0"), (b"~!", "Hold:0"), (b"\x84~", "Door:0")])
def test_a_hold_in_the_batch_blocks_the_resume(session: GrblConsole, batch: bytes, state: str) -> None:
    """In motion, and while held: `~!` is no resume either."""
    session.send(LONG, 0.2)
    for _ in range(2):
        session.send(batch, 0.3)
        there = session.status()
        session.run(0.2)
        assert session.status()["MPos"] == there["MPos"] and there["state"] == state
    session.send(b"~")
    session.rest()
    assert x_of(session) == -50


@pytest.mark.parametrize("code", [b"!", b"\x84"])
def test_a_hold_at_rest_holds_the_lines(session: GrblConsole, code: bytes) -> None:
    """They wait, and go on in their order."""
    session.send(code)
    assert session.status()["state"] == ("Hold:0" if code == b"!" else "Door:0")
    assert session.send(b"G0 X-1\n$$\n$G\n", 0.3) == "" and x_of(session) == 0
    assert session.send(b"~", 0.1).startswith("ok\nerror:8\n[GC:")
    session.rest()
    assert x_of(session) == -1


def test_the_door_in_a_jog(session: GrblConsole) -> None:
    """It is in motion until it rests; the jog is over then."""
    session.send(b"$J=G91 X-50 F6000\n", 0.2)
    session.send(b"\x84")
    assert session.status()["state"] == "Door:2"
    session.run(0.3)
    assert session.status()["state"] == "Door:0"
    there = x_of(session)
    assert session.send(b"~", 0.3) == "" and x_of(session) == there < 0
    assert session.status()["state"] == "Idle"


# ------------------------------------------------------------------------------------- jogs and their end


@pytest.mark.parametrize("pressed", [0.05, 0.5])
@pytest.mark.parametrize("code", [b"\x85", b"\x18"])
def test_an_estop_on_the_way_to_rest_is_an_alarm(session: GrblConsole, code: bytes, pressed: float) -> None:
    """Steps may be lost: whatever the way to rest was for, and however short it is pressed."""
    session.send(b"$J=G91 X-50 F12000\n", 0.35)
    session.take()
    session.send(code, 0.01)
    session.engine.set("estop_n", 0)
    session.run(pressed)
    session.engine.set("estop_n", 1)
    session.run(0.5)
    assert session.log.count("ALARM:3") == 1 and session.status()["state"] == "Alarm"
    assert session.line("G0 X0") == "error:9"


@pytest.mark.parametrize("code", [b"\x85", b"!"])
def test_a_jog_just_after_the_end_of_another_waits_and_runs(session: GrblConsole, code: bytes) -> None:
    """So does any other line."""
    session.send(b"$J=G91 X-50 F6000\n", 0.2)
    answered = len(session.answers)
    session.send(code + b"$J=G90 X-60 F6000\n", 0.02)
    assert len(session.answers) == answered and session.status()["state"] == "Jog"
    session.finish()
    assert session.answers[answered:] == ["ok"] and x_of(session) == -60
    session.send(b"$J=G91 X50 F6000\n", 0.2)
    session.send(code + b"G0 X-70\n", 0.02)
    session.finish()
    assert session.answers[answered:] == ["ok"] * 3 and x_of(session) == -70


@pytest.mark.parametrize("code", [b"\x85", b"!"])
def test_every_jog_is_answered(session: GrblConsole, code: bytes) -> None:
    """Those received before the end are not made; a line of which a half has come keeps its head."""
    answered = len(session.answers)
    session.send(b"$J=G91 X-1 F6000\n" * 3 + b"$J=G91 ", 0.05)
    for _ in range(67):
        session.grbl.type(b"X-1 F6000\n$J=G91 ")
        session.grbl.wait(lambda: session.grbl.room > 30)
    session.run(0.05)
    there = x_of(session)
    session.send(code + b"X-1 F6000\n")
    session.finish()
    assert session.answers[answered:] == ["ok"] * 71
    assert there > -60 and there - 12 < x_of(session) < there


@pytest.mark.parametrize("lines", [1, 3])
def test_a_jog_that_is_canceled_before_it_begins(session: GrblConsole, lines: int) -> None:
    """Where both come together to a machine at rest: it is answered, and nothing moves."""
    answered = len(session.answers)
    session.grbl.type(b"$J=G91 X-5 F6000\n" * lines + b"\x85")
    session.finish()
    assert session.answers[answered:] == ["ok"] * lines and x_of(session) == 0
    assert session.status()["state"] == "Idle"


def test_lines_after_the_end_of_a_jog_are_taken(session: GrblConsole) -> None:
    """In a jog G-code is error 9, once it has been canceled it is not."""
    session.send(b"$J=G91 X-50 F6000\n", 0.1)
    assert session.line("G0 X1") == "error:9"
    session.send(b"\x85G0 ")
    session.grbl.type(b"X-9\n")
    session.finish()
    assert x_of(session) == -9


# ------------------------------------------------------------------------------------ lines that are lost


def test_the_line_that_lost_bytes_is_refused(session: GrblConsole) -> None:
    """And no other: neither those before it in the buffer, nor those after."""
    head, tail = b"G1 Y7\n", b"G1 X-10"
    session.send(b"G1 F6000\nM0\n", 0.1)
    answered = len(session.answers)
    room = session.grbl.room
    session.grbl.type(head + b"\n" * (room - len(head) - len(tail)) + tail)
    session.grbl.type(b"0~\n")
    session.finish()
    assert session.answers[answered:] == ["ok"] * (1 + room - len(head) - len(tail)) + ["error:11"]
    assert session.fields("MPos")[:2] == [0, 7]
    assert session.line("G0 X-2") == "ok"
    session.rest()
    assert x_of(session) == -2


def test_every_line_that_is_lost_is_answered(session: GrblConsole) -> None:
    """In its place, also if its end was lost; a line whose head was lost is refused as well."""
    session.send(b"M0\n", 0.1)
    answered = len(session.answers)
    room = session.grbl.room
    session.grbl.type(b"\n" * (room - 3) + b"G0 X-1\nG0 X-2\nG0 X-")
    session.send(b"~", 1)
    session.grbl.type(b"3\nG0 Y-1\n")
    session.finish()
    assert session.answers[answered:] == ["ok"] * (room - 3) + ["error:11"] * 3 + ["ok"]
    assert session.fields("MPos")[:2] == [0, -1]


def test_lost_lines_end_with_a_reset(session: GrblConsole) -> None:
    """They owe no answer behind the greeting, and refuse no line that comes then."""
    session.send(b"M0\n", 0.1)
    session.grbl.type(b"\n" * (session.grbl.room - 3) + b"G0 X-1\nG0 X-2\nG0 X-")
    session.send(b"\x18", 0.5)
    answered = len(session.answers)
    for line in (b"G0 Y-1\n", b"G0 Y-2\n"):
        session.grbl.type(line)
        session.finish()
    assert session.answers[answered:] == ["ok"] * 2 and session.fields("MPos")[:2] == [0, -2]


def test_a_byte_that_the_serial_line_lost_refuses_its_line(session: GrblConsole) -> None:
    """Also in a comment, whose end it may have been."""
    assert session.line("(a\0 G0 X1") == "error:11"
    assert session.line("G0 X-1") == "ok"


# --------------------------------------------------------------------------------------------- overrides


def test_overrides_stay_in_their_range(session: GrblConsole) -> None:
    """They clamp; any number of them between two polls counts."""
    for first, least in ((0x90, 10), (0x99, 10)):
        code = {name: bytes([first + i]) for i, name in enumerate(("full", "up", "down", "+", "-"))}
        index = 0 if first == 0x90 else 2
        for batch, percent in (
            (code["up"] * 9 + code["+"] * 9, 199), (code["up"], 200), (code["+"], 200), (code["full"], 100),
            (code["down"] * 8 + code["-"] * 5, 15), (code["down"], least), (code["-"] * 300, least),
            (code["full"] + code["down"] + code["+"] * 4, 94),
        ):  # fmt: skip
            session.send(batch)
            c = session.grbl.c
            assert (c.feed, c.rapid, c.spindle)[index] == percent


def test_one_override_acts_without_the_others(session: GrblConsole) -> None:
    """Told in a report, and the speed is that of the line that moves."""
    for code, percent in ((b"\x92", [90, 100, 100]), (b"\x96", [90, 50, 100]), (b"\x9b", [90, 50, 90])):
        session.send(code)
        reports = (session.status() for _ in range(30))
        told = next(report["Ov"] for report in reports if "Ov" in report)
        assert [int(number) for number in told.split(",")] == percent
    for line, seconds, speed in (("G1 X-6 F2400", 0.1, 2160), ("G0 X-55", 0.45, 6000)):
        session.line(line)
        session.run(seconds)
        assert session.fields("FS")[0] == pytest.approx(speed, rel=0.01)
        session.rest()


def seconds_of(session: GrblConsole, line: str) -> float:
    """From a line to the rest behind it."""
    began = session.engine.clock
    session.line(line)
    session.rest()
    return (session.engine.clock - began) / 4e6


def test_a_feed_override_leaves_rapids_and_dwells_alone(session: GrblConsole) -> None:
    """Its own feeds take their time."""
    full = [seconds_of(session, line) for line in ("G0 X-20", "G4 P0.3", "G1 X0 F2400")]
    session.send(b"\x92" * 9)
    slow = [seconds_of(session, line) for line in ("G0 X-20", "G4 P0.3", "G1 X0 F2400")]
    assert slow[:2] == pytest.approx(full[:2], abs=0.01) and 5 < slow[2] < 5.5
    session.send(b"\x90\x97")
    quarter = [seconds_of(session, line) for line in ("G0 X-20", "G4 P0.3", "G1 X0 F2400")]
    assert quarter[0] > 1.3 * full[0] and quarter[1:] == pytest.approx(full[1:], abs=0.01)


@pytest.mark.parametrize("codes", [b"\x92" * 5, b"\x91" * 5], ids=["50 %", "150 %"])
def test_a_jog_has_the_feed_that_it_names(session: GrblConsole, codes: bytes) -> None:
    """An override is that of the lines behind it, also if it comes in the jog, and is reported."""
    jog, line = "$J=G90 X-20 F2400", "G1 X0 F2400"
    jogged, moved = seconds_of(session, jog), seconds_of(session, line)
    session.send(codes)
    assert seconds_of(session, jog) == pytest.approx(jogged, abs=0.01)
    other = seconds_of(session, line)
    assert abs(other - moved) > 0.1
    session.send(b"\x90" + jog.encode() + b"\n", 0.1)
    session.send(codes, 0.1)
    assert session.fields("FS")[0] == pytest.approx(2400, abs=5)
    told = next(report["Ov"] for report in (session.status() for _ in range(30)) if "Ov" in report)
    assert told == f"{session.grbl.c.feed},100,100" != "100,100,100"
    session.rest()
    assert seconds_of(session, line) == pytest.approx(other, abs=0.01)


def test_an_override_in_mid_motion_slows_down_the_rest_of_it(session: GrblConsole) -> None:
    """And ends at the same step."""
    session.send(b"G1 X-100 F6000\n", 0.3)
    session.send(b"\x92" * 5, 0.25)
    assert session.fields("FS")[0] == pytest.approx(3000, abs=5)
    session.send(b"\x90", 0.2)
    assert session.fields("FS")[0] == pytest.approx(6000, abs=5)
    session.rest()
    assert x_of(session) == -100


@pytest.mark.parametrize("end", ["M2", "M30"])
def test_overrides_end_with_the_program(session: GrblConsole, end: str) -> None:
    """Not before its last motion has ended; a line that waits behind the end is no part of it."""
    session.send(b"\x92" * 5 + b"\x97\x9a" + f"G1 X-30 F6000\n{end}\nG1 X-60 F6000\n".encode(), 0.3)
    assert session.fields("FS")[0] == pytest.approx(3000, abs=5)
    assert session.grbl.wait(lambda: "Pgm End" in session.log, 1)
    session.run(0.15)
    assert session.fields("FS")[0] == pytest.approx(6000, abs=5)
    told = next(report["Ov"] for report in (session.status() for _ in range(30)) if "Ov" in report)
    assert told == "100,100,100"


# ------------------------------------------------------------------------------------------ resets, sleep


def test_sleep_ends_with_a_reset(session: GrblConsole) -> None:
    """Drives are off, lines wait, requests do nothing; afterwards it is locked."""
    assert session.line("$SLP") == "[MSG:Sleeping]\nok"
    assert session.send(b"G0 X-1\n~!\x84\x85", 0.2) == "" and session.status()["state"] == "Sleep"
    assert "unlock" in session.send(b"\x18", 0.1)
    assert session.status()["state"] == "Alarm" and session.line("$X").endswith("ok")
    assert session.line("G0 X-2") == "ok"
    session.rest()
    assert x_of(session) == -2


def test_overrides_behind_a_reset_are_kept(session: GrblConsole) -> None:
    """Those before it are not."""
    session.send(b"\x91\x91\x18\x92", 0.1)
    assert session.grbl.c.feed == 90


def test_an_alarm_leaves_no_line_without_an_answer(session: GrblConsole) -> None:
    """Lines that had been received have error 9, one each; `$X` among them unlocks."""
    session.line("$20=1")
    answered = len(session.answers)
    session.send(b"G1 X-1 F6000\nG0 X5\nG0 X-2\n$G\nG0 X-3\n$X\nG0 X-4\n")
    session.finish()
    assert session.answers[answered:] == ["ok", "error:9", "error:9", "ok", "error:9", "ok", "ok"]
    assert x_of(session) == -4


# ------------------------------------------------------------------------------------------- start lines


def test_start_lines_run_when_the_place_is_known(session: GrblConsole) -> None:
    """After a reset in Alarm `$X` runs none, as they may move; `$H` does, and a reset that was no alarm."""
    session.line("$N0=G91 G0 X-10")
    session.rest()
    session.send(b"G0 X-50\n", 0.1)
    assert session.send(b"\x18", 0.5).startswith("ALARM:3\n\nGrbl")
    before = session.fields("MPos")
    for _ in range(2):
        session.line("$X")
        session.run(0.3)
        assert session.fields("MPos") == before and ">" not in session.send(b"G4 P0\n", 0.1)
    assert session.line("$H") == "ok"
    at = session.fields("MPos")[0]
    session.run(0.3)
    assert session.log.count(">G91G0X-10:ok") == 1 and session.fields("MPos")[0] == at - 10
    session.send(b"\x18", 0.5)
    assert session.log.count(">G91G0X-10:ok") == 2 and session.fields("MPos")[0] == at - 20


def test_a_start_line_that_fails_is_the_last(session: GrblConsole) -> None:
    """`$X` does not go on with the others."""
    for line in ("$N0=G0 X-100", "G0 X0", "G4 P0", "$N1=G0 Y-10", "G0 Y0", "G4 P0", "$130=50", "$20=1"):
        assert session.line(line) == "ok"
    assert session.send(b"\x18", 0.5).endswith(">G0X-100:ok\nALARM:2")
    assert session.line("$X").endswith("ok")
    session.run(0.3)
    assert ">G0Y" not in session.log and session.fields("MPos") == [0, 0, 0]
