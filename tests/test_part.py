# SPDX-License-Identifier: MIT
"""`passo run PART.nc`: G-code on the C model, its pulses against the path reference and the G-code itself."""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from passo import cli, part_command
from passo.driver import Driver, DriverError
from passo.failure import BadInputError
from passo.gcode import NANOMETERS, GcodeSettings
from passo.host_loop import HostLoop
from passo.machine_file import MachineFile, read_machine
from passo.moves import PinTiming, q32
from passo.native import planner
from passo.part import Played, play_part, read_part
from passo.path import PathAxis, PathSettings
from passo.program import Program
from passo.run import open_engine, parameters_for
from passo.toolchain import paths

from benchmarks.path_reference import seconds

MACHINE = paths.examples / "gcode" / "machine.toml"
PART = paths.examples / "gcode" / "part.nc"


def play(folder: Path, text: str, engine: str = "model", look_ahead: int = 48) -> Played:
    """A part on the machine of the example."""
    path, machine = folder / "part.nc", read_machine(MACHINE)
    path.write_text(text)
    part = read_part(path, machine)
    with open_engine(engine, parameters_for(3), machine.clock_hz) as core:
        return play_part(part, machine, core, look_ahead=look_ahead)


def places(played: Played, clocks: np.ndarray) -> np.ndarray:
    """Positions of all axes in mm at these clocks."""
    columns = []
    for at, counts, axis in zip(played.clocks, played.positions, played.machine.settings.axes, strict=True):
        index = np.searchsorted(at, clocks, side="right")
        columns.append(np.concatenate([[0], counts])[index] / float(axis.steps_per_mm))
    return np.stack(columns, axis=1)


def test_the_example(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Command, summary, picture."""
    arguments = ["run", str(PART), "--machine", str(MACHINE), "--out", str(tmp_path), "--plot"]
    assert cli.main(arguments) == 0
    assert "24 lines, 530 chords in 12.09" in capsys.readouterr().out
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["ok"] and summary["end"]["steps"] == [0, 0, 0]
    assert (summary["lines"], summary["chords"], summary["motions"]) == (24, 530, 1)
    assert (tmp_path / "path.png").stat().st_size > 20_000
    limits = summary["limits"]
    assert 0.9 < limits["acceleration"]["share"] < 1.03 and 0.4 < limits["speed"]["share"] <= 1.0


def test_a_part_beyond_the_limits_of_an_axis_fails(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Judged with half the acceleration that it was planned with."""
    path = tmp_path / "part.nc"
    path.write_text("G21 G90\nG3 X0 Y0 I0 J5 F6000\n")
    weak = replace(read_machine(MACHINE).settings, axes=(PathAxis(80, 200, 500),) * 3)
    judge = part_command.shares_of
    change = lambda played: judge(replace(played, machine=replace(played.machine, settings=weak)))  # noqa: E731
    monkeypatch.setattr(part_command, "shares_of", change)
    arguments = ["run", str(path), "--machine", str(MACHINE), "--out", str(tmp_path)]
    assert cli.main(arguments) == 1
    assert "of its acceleration, at" in capsys.readouterr().err
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert not summary["ok"] and 1.7 < summary["limits"]["acceleration"]["share"] < 2.1


def test_a_circle_takes_as_long_as_the_reference(tmp_path: Path) -> None:
    """And its steps are within a step and the tolerance of the circle."""
    played = play(tmp_path, "G21 G90\nG1 F6000\nG2 X0 I20\n")
    assert played.problems() == []
    lines = played.part.chords
    angles = [-2 * math.pi * i / lines for i in range(1, lines + 1)]
    chords = [((20 - 20 * math.cos(a), -20 * math.sin(a), 0.0), 100.0) for a in angles]
    assert 0.999 < played.seconds / seconds(chords, played.machine.settings) < 1.01
    steps = places(played, np.unique(np.concatenate(played.clocks[:2])))
    radius = np.hypot(steps[:, 0] - 20, steps[:, 1])
    assert np.abs(radius - 20).max() < 0.002 + 1.5 / 80
    area = np.sum(steps[:-1, 0] * steps[1:, 1] - steps[1:, 0] * steps[:-1, 1]) / 2
    assert abs(area + math.pi * 400) < 1  # clockwise


def test_dwells_pauses_and_stops_of_the_program(tmp_path: Path) -> None:
    """A dwell lasts; M0 ends a motion; nothing after M30 is read."""
    still = play(tmp_path, "G1 X5 F1000\nX10")
    with_dwell = play(tmp_path, "G1 X5 F1000\nG4 P0.25\nX10")
    stop = play(tmp_path, "G1 X5 F1000\nM0\nX10\nM30\nnonsense")
    assert 0.25 < with_dwell.seconds - still.seconds < 0.3
    assert (len(still.motions), len(with_dwell.motions), len(stop.motions)) == (1, 1, 2)
    assert still.end == with_dwell.end == stop.end == [800, 0, 0]


def test_the_look_ahead_changes_times_only(tmp_path: Path) -> None:
    """The same steps with 4 lines as with 1000."""
    text = "G1 F3000\n" + "".join(f"X{i * 0.3:.2f} Y{math.sin(i):.3f}\n" for i in range(60))
    short, long = (play(tmp_path, text, look_ahead=n) for n in (4, 1000))
    assert short.problems() == long.problems() == []
    for a, b in zip(short.positions, long.positions, strict=True):
        assert a.tolist() == b.tolist()
    assert long.seconds <= short.seconds


SQUARE = ["(a square)", "G21 G90", "G1 X5 F6000", "Y5", "X0 Y0"]


@pytest.mark.parametrize("around", [("", ""), ("\ufeff", ""), ("", "\x1a"), ("\x00\x07", "\x1a\x1a\n")])
@pytest.mark.parametrize("end", ["\n", "\r", "\r\n", "\n\r"])
def test_files_of_any_editor_are_the_same_part(tmp_path: Path, end: str, around: tuple[str, str]) -> None:
    """Ends of lines, byte order mark, the end of a file of CP/M, padding."""
    path, machine = tmp_path / "part.nc", read_machine(MACHINE)
    path.write_bytes((around[0] + end.join(SQUARE) + end + around[1]).encode())
    part = read_part(path, machine)
    assert (part.chords, part.end[:2], part.unread) == (3, (0, 0), 0)
    path.write_bytes((around[0] + end.join([*SQUARE, "X1 X2"]) + around[1]).encode())
    number = 11 if end == "\n\r" else 6
    with pytest.raises(BadInputError, match=f":{number}: error:25"):
        read_part(path, machine)


def test_a_part_that_is_lost_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A file without words, without a motion, with lines behind its end."""
    path = tmp_path / "part.nc"
    run = ["run", str(path), "--machine", str(MACHINE), "--out", str(tmp_path / "out")]
    for text in ("", "\n\r\n", "(only G0 X1)\r;G1 X1\r", "%\n\x1a", "\ufeff"):
        path.write_text(text, encoding="utf-8", newline="")
        assert cli.main(run) == 2
        assert "the file has no G-code" in capsys.readouterr().err
    for text in ("G21 G90\nM3 S100", "G0 X0\nG4 P0.1", "(G1 X5"):
        path.write_text(text + "\nF100\n")
        assert cli.main(run) == 0
        told = capsys.readouterr()
        assert "nothing moved" in told.err and "chords" not in told.out
    path.write_text("G0 X1\nM30\n%\nG0 X5\n(end)\nM0\n")
    assert cli.main(run) == 0
    assert "2 lines behind the end of the program are not read" in capsys.readouterr().err
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["unread_lines"] == 2


def test_words_for_the_path_reach_the_planner(tmp_path: Path) -> None:
    """Fine chords are merged within the tolerance of G64, or the machine's own; after G61 none is."""
    angles = np.linspace(0, math.pi, 700)
    arc = "".join(f"X{5 * math.cos(a) - 5:.6f} Y{5 * math.sin(a):.6f}\n" for a in angles)
    off, seconds_of = {}, {}
    for words in ("G61", "", "G64 P0.1", "G64 P0.1\nG64", "G64 P0.5\nG61"):
        played = play(tmp_path, f"{words}\nG1 F9000\n{arc}")
        assert played.problems() == []
        steps = places(played, np.unique(np.concatenate(played.clocks[:2])))
        off[words] = np.abs(np.hypot(steps[:, 0] + 5, steps[:, 1]) - 5).max()
        seconds_of[words] = played.seconds
    step = 1.5 / 80
    assert off["G61"] == off["G64 P0.5\nG61"] < step and seconds_of["G61"] == seconds_of["G64 P0.5\nG61"]
    assert off[""] == off["G64 P0.1\nG64"] < 0.0005 + step and seconds_of[""] == seconds_of["G64 P0.1\nG64"]
    assert seconds_of[""] != seconds_of["G61"]
    assert 0.03 < off["G64 P0.1"] < 0.1 + step


def test_rtl_and_model_agree(tmp_path: Path) -> None:
    """A short part on both, edge for edge."""
    played = play(tmp_path, "G91 G0 X0.5 Y0.2\nG2 X0.2 I0.1 F2000\n", "both")
    assert played.problems() == [] and played.matched_edges
    assert played.matched_edges > 100


def test_the_end_is_exact_in_any_units(tmp_path: Path) -> None:
    """Positions are rounded once, from the sum of all increments."""
    played = play(tmp_path, "G20 G91 G1 F100\n" + "X0.0007 Y-0.00013\n" * 300)
    assert played.problems() == []
    assert played.part.end[0] == 300 * 17_780
    assert played.end[:2] == [round(300 * 17_780 * 80 / NANOMETERS), round(-300 * 3_302 * 80 / NANOMETERS)]


# ---------------------------------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("text", "told"),
    [("G1 X10", ":1: error:22:"), ("G0 X1\nG0 X1 Y1 X2", ":2: error:25:"), ("\x00\xff", ":1: error:1:"),
     ("G38.2 Z-1 F10", "no probe"), ("G0 X" + "0" * 200, ":1: error:11:"),
     ("F100\n\nG2 X1 R.1", ":3: error:34:")],
)  # fmt: skip
def test_a_bad_line_is_named_and_nothing_moves(
    tmp_path: Path, text: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "bad.nc"
    path.write_bytes(text.encode("latin-1"))
    assert cli.main(["run", str(path), "--machine", str(MACHINE), "--out", str(tmp_path / "out")]) == 2
    assert told in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


GOOD_AXIS = '[[axis]]\nname = "X"\nsteps_per_mm = 80\nspeed = 200\nacceleration = 1000\n'


SPINDLE = "clock_hz = 64_000_000\nspindle_maximum = 1000\n[spindle]\n"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "clock_hz is missing"),
        ("clock_hz = 64", "write 64_000_000"),
        ("clock_hz = 64_000_000", "0 axes"),
        ("clock_hz = 64_000_000\nclock = 1\n" + GOOD_AXIS, "unknown key 'clock'"),
        ("clock_hz = 64_000_000\n" + GOOD_AXIS.replace("X", "Y"), 'axis 1: name must be "X"'),
        ("clock_hz = 64_000_000\n" + GOOD_AXIS.replace("speed = 200\n", ""), "axis 1: speed is missing"),
        ("clock_hz = 64_000_000\n" + GOOD_AXIS.replace("1000", "0"), "acceleration must be greater than 0"),
        ("clock_hz = 64_000_000\narc_tolerance = 0\n" + GOOD_AXIS, "arc_tolerance must be greater than 0"),
        ('clock_hz = 64_000_000\nprofile = "smooth"\n' + GOOD_AXIS, "profile must be one of"),
        ('clock_hz = 64_000_000\nprofile = "jerk"\n' + GOOD_AXIS, 'axis 1: profile = "jerk" needs its jerk'),
        ("clock_hz = 64_000_000\n[pins]\nstep_high = 1\n" + GOOD_AXIS, "pins: step_high is"),
        ("clock_hz = 64_000_000\n" + GOOD_AXIS + "jerk = -5", "axis 1: jerk"),
        ("clock_hz = ", "Invalid value"),
        ("clock_hz = 64_000_000\n[spindle]\ncounts = 400\n" + GOOD_AXIS, "spindle: it needs spindle_maximum"),
        (SPINDLE + GOOD_AXIS, "spindle: counts is missing"),
        (SPINDLE + "counts = 400\nwander = 95\n" + GOOD_AXIS, "wander at most"),
        (SPINDLE + "counts = 400\nstart_up = 0\n" + GOOD_AXIS, "start_up must be greater than 0"),
        (SPINDLE + "count = 400\n" + GOOD_AXIS, "spindle: unknown key 'count'; did you mean counts?"),
    ],
)
def test_a_bad_machine_file_is_refused(
    tmp_path: Path, text: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(text)
    assert cli.main(["run", str(PART), "--machine", str(path)]) == 2
    assert told in capsys.readouterr().err


FAST_AXES = "".join(
    f'[[axis]]\nname = "{name}"\nsteps_per_mm = 1600\nspeed = SPEED\nacceleration = 20000\n' for name in "XY"
)


@pytest.mark.parametrize(
    ("pins", "told"),
    [("", "312.5: step_high and step_low are 128 clocks"), ('[pins]\nstep_low = "1.5us"\n', "250: "),
     ('[pins]\nstep_high = "10ns"\nstep_low = "90ns"\n', "5714.28: "),
     ('[pins]\nstep_high = "1us"\ndir_setup = "9us"\n', "312.5: ")],
)  # fmt: skip
def test_a_speed_that_the_pins_do_not_allow_is_refused(
    tmp_path: Path, pins: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """With the highest one, at which no step is lost: on long lines, at corners, in small pieces."""
    machine, part = tmp_path / "machine.toml", tmp_path / "part.nc"
    part.write_text(
        "G0 X12 Y6\nX0\nG1 X-1 F1000000\nX1\nX0 Y0\n"
        + "".join(f"X{i * 0.07:.3f} Y{i * 0.07 + i % 7 * 0.001:.4f}\n" for i in range(120))
    )
    text = f"clock_hz = 64_000_000\n{pins}{FAST_AXES}"
    run = ["run", str(part), "--machine", str(machine), "--out", str(tmp_path / "out")]
    machine.write_text(text.replace("SPEED", "6000"))
    assert cli.main(run) == 2
    refused = capsys.readouterr().err
    assert f"axis 1: speed is 6000; the pins allow at most {told}" in refused and refused.count("\n") == 1
    assert not (tmp_path / "out").exists()
    machine.write_text(text.replace("SPEED", told.split(":")[0]))
    assert cli.main(run) == 0


def test_a_reversal_that_the_pins_do_not_allow_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Steps wait while DIR turns, and the core has room for four: with what is allowed a saw loses none."""
    machine, part = tmp_path / "machine.toml", tmp_path / "part.nc"
    part.write_text("G1 F100000\n" + "".join(f"X{i % 2 * 3} Y{i * 3}\n" for i in range(8)))
    axes = FAST_AXES.replace("SPEED", "300")
    text = f'clock_hz = 64_000_000\n[pins]\ndir_setup = "US"\ndir_hold = "US"\n{axes}'
    run = ["run", str(part), "--machine", str(machine), "--out", str(tmp_path / "out")]
    machine.write_text(text.replace("US", "100us"))
    assert cli.main(run) == 2
    told = "axis 1: it may reverse at 40 mm/s (jump, junction_deviation), the pins allow at most 4.16811: "
    assert told in capsys.readouterr().err
    for deviation, jump, allowed in (("0.0053", "0", True), ("0.0054", "0", False), ("0", "29", True),
                                     ("0", "30", False)):  # fmt: skip
        limits = text.replace("US", "20us").replace("acceleration", f"jump = {jump}\nacceleration")
        machine.write_text(f"junction_deviation = {deviation}\n{limits}")
        ended = cli.main(run)
        assert ended == (0 if allowed else 2)
        assert "OVERRUN" not in capsys.readouterr().err


def test_a_program_in_c_is_refused_as_well() -> None:
    """Its largest speed is that of the pins."""
    axis = PathAxis(Fraction(7, 3), 200, 20000)
    with open_engine("model", parameters_for(1), 64_000_000) as core:
        driver = Driver(core, 64_000_000, core.parameters)
        assert planner().passo_highest_speed(driver.c, 0, q32(axis.steps_per_mm)) == 0  # not configured
        driver.configure_axis(0, PinTiming(100, 28, 1, 1))
        highest = planner().passo_highest_speed(driver.c, 0, q32(axis.steps_per_mm))
        exact = Fraction(64_000_000, 128) / Fraction(q32(axis.steps_per_mm), 1 << 32)
        assert exact <= Fraction(highest, 1 << 32) < exact + Fraction(2, 1 << 32)
        assert planner().passo_highest_speed(driver.c, 0, 1) == (1 << 64) - 1
        for speed, refused in ((Fraction(highest, 1 << 32), False), (Fraction(highest + 1, 1 << 32), True)):
            settings = PathSettings((replace(axis, speed=speed),), 64_000_000)
            try:
                Program(driver, settings, GcodeSettings(axes=1))
                assert not refused
            except DriverError as error:
                assert refused and "PINS_TOO_SLOW" in str(error)


def test_what_does_not_fit_together_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["run", str(PART)]) == 2
    assert cli.main(["run", str(PART), "--machine", str(MACHINE), "--waves", "--engine", "model"]) == 2
    for option in (["--machine", str(MACHINE)], ["--from", "2"], ["--look-ahead", "9"]):
        assert cli.main(["run", str(paths.examples / "turn.toml"), *option]) == 2
    assert cli.main(["run", *2 * [str(paths.examples / "turn.toml")]]) == 2
    assert cli.main(["run", "missing.nc", "--machine", str(MACHINE)]) == 2
    assert capsys.readouterr().err.count("\n") == 7


def test_all_that_a_move_file_gets(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Pulses, waves, report, figures of the cut; of a part of a program."""
    path, out = tmp_path / "part.tap", tmp_path / "out"
    path.write_text("G0 X1\nG1 X2 Y1 F6000\nX3\nG0 X0\nM2\n")
    words = ["run", path, "--machine", MACHINE, "--out", out, "--from", 2, "--to", 3, "--look-ahead", 8]
    assert cli.main([*map(str, words), "--report", "--waves", "1ms..2ms"]) == 0
    assert "waves, " in capsys.readouterr().out
    rows = np.loadtxt(out / "pulses.csv", int, delimiter=",", skiprows=1)
    assert (out / "pulses.csv").read_text().startswith("clock,axis,direction\n")
    assert [int(rows[rows[:, 1] == axis, 2].sum()) for axis in range(3)] == [160, 80, 0]
    assert (np.diff(rows[:, 0]) >= 0).all()
    summary = json.loads((out / "summary.json").read_text())
    assert summary["ok"] and summary["matched_edges"] > 400
    assert summary["tools"][0]["feed_mm"] == pytest.approx(1 + math.sqrt(2), rel=1e-3)
    assert summary["levels"][0]["feed_seconds"] == pytest.approx(summary["path_seconds"])
    assert 20 < summary["highest"]["X"]["speed"] <= 100 and summary["highest"]["Z"]["speed"] == 0
    assert 500 < summary["highest"]["X"]["acceleration"] < 1050
    facts = (out / "report.html").read_text()
    assert '"start":80' in facts and '"edges":[160,160,' in facts
    assert (out / "waves.fst").stat().st_size > 1000
    assert cli.main([*map(str, words), "--waves", "900ms..901ms"]) == 2
    assert "the motion takes only 0." in capsys.readouterr().err


def test_a_run_that_is_canceled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The results up to then are written."""
    path, out = tmp_path / "part.nc", tmp_path / "out"
    path.write_text("G1 F6000\n" + "".join(f"X{k % 9} Y{k}\n" for k in range(200)))
    turn = HostLoop.turn

    def cancel(loop: HostLoop, *arguments: Callable[[], Any]) -> None:
        turn(loop, *arguments)
        if loop.engine.clock > 64_000_000:
            raise KeyboardInterrupt

    monkeypatch.setattr(HostLoop, "turn", cancel)
    assert cli.main(["run", str(path), "--machine", str(MACHINE), "--out", str(out), "--plot"]) == 130
    summary = json.loads((out / "summary.json").read_text())
    (problem,) = summary["problems"]
    assert problem.startswith(f"canceled at {path}:") and not summary["ok"]
    assert 1000 < sum(summary["pulses"]) < 20_000 and (out / "path.png").exists()
    assert len((out / "pulses.csv").read_text().splitlines()) == sum(summary["pulses"]) + 1


def test_a_line_that_only_the_planner_refuses_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "part.nc"
    path.write_text("G0 X1\nX99999999\n")
    assert cli.main(["run", str(path), "--machine", str(MACHINE), "--out", str(tmp_path)]) == 2
    assert f"{path}:2: " in capsys.readouterr().err


def test_a_machine_file(tmp_path: Path) -> None:
    """All keys."""
    path = tmp_path / "machine.toml"
    path.write_text(
        'clock_hz = 72_000_000\nprofile = "cosine"\nspindle_maximum = 24000\n'
        "junction_deviation = 0.02\narc_tolerance = 0.005\n"
        f'[pins]\nstep_high = "2us"\n{GOOD_AXIS}jump = 2\njerk = 0\n'
    )
    machine: MachineFile = read_machine(path)
    assert machine.settings.axes == (PathAxis(80, 200, 1000, 2),)
    assert (machine.clock_hz, machine.settings.profile) == (72_000_000, "cosine")
    assert (machine.gcode.axes, machine.gcode.spindle_maximum) == (1, 24000)
    assert (machine.pins.step_high, machine.pins.step_low) == (144, 72)
