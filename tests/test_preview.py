# SPDX-License-Identifier: MIT
"""`passo preview`: its time is that of the run, its figures those of the program."""

import io
import json
import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from passo import cli, preview_command
from passo.course import Course
from passo.machine_file import MachineFile, read_machine
from passo.part import Lines, Part, plan_part, play_part, read_part
from passo.part_judge import path_of
from passo.preview import Planned
from passo.run import open_engine, parameters_for
from passo.toolchain import paths

GCODE = paths.examples / "gcode"
MACHINE = GCODE / "machine.toml"
SHARE = 1e-3  # of the time of a run, by which a preview may be off

WAVE = "G1 F9000\n" + "".join(f"X{k * 0.2:.2f} Y{4 * math.sin(k / 9):.3f}\n" for k in range(300))
STOPS = "G1 F3000 X5\nG4 P0.2\nM3 S100\nX9 Y2\nM0\nG2 I3 F6000\nG1 G61.1 X0\nY0\nM2\n"
SAW = "G0 " + "".join(f"X{k % 2 * 3} Y{k}\n" for k in range(30))
PROGRAMS = {"wave": WAVE, "stops": STOPS, "saw": SAW}
FILES = (
    ("part.nc", "machine.toml"),
    ("engraving.nc", "corexy.toml"),
)


def shaped(machine: MachineFile, profile: str) -> MachineFile:
    """With another profile."""
    axes = tuple(replace(axis, jerk=20 * float(axis.acceleration)) for axis in machine.settings.axes)
    return replace(machine, settings=replace(machine.settings, profile=profile, axes=axes))


def program(folder: Path, text: str, only: Lines | None = None) -> tuple[Part, MachineFile]:
    """A program for the machine of the example."""
    path, machine = folder / "part.nc", read_machine(MACHINE)
    path.write_text(text)
    return read_part(path, machine, only=only), machine


def course_of(part: Part, machine: MachineFile, look_ahead: int = 48) -> Course:
    """As it is planned."""
    planned = plan_part(part, machine, look_ahead)
    assert planned.ended and not planned.refused and not planned.dry
    return Course(planned, part.begin.place)


def check_against_run(part: Part, machine: MachineFile, look_ahead: int) -> None:
    """Time, motions and steps of a played part."""
    course = course_of(part, machine, look_ahead)
    with open_engine("model", parameters_for(len(machine.motors)), machine.clock_hz) as core:
        played = play_part(part, machine, core, look_ahead=look_ahead)
    assert played.problems() == []
    assert course.seconds == pytest.approx(played.seconds, rel=SHARE)
    assert course.motions == len(played.motions)
    steps = np.abs(course.planned.lines["steps"]).sum(axis=0)
    assert steps[: len(machine.motors)].tolist() == [len(clocks) for clocks in played.clocks]


@pytest.mark.parametrize("profile", ["linear", "cosine", "sigmoid", "jerk"])
@pytest.mark.parametrize("look_ahead", [8, 48, 300])
def test_the_time_is_that_of_the_run(tmp_path: Path, profile: str, look_ahead: int) -> None:
    """Short lines, stops of all kinds, reversals; an example in Cartesian axes and one of CoreXY."""
    for text in PROGRAMS.values():
        part, machine = program(tmp_path, text)
        check_against_run(part, shaped(machine, profile), look_ahead)
    for name, machine_name in FILES:
        machine = shaped(read_machine(GCODE / machine_name), profile)
        check_against_run(read_part(GCODE / name, machine), machine, look_ahead)


def test_the_figures_of_a_program(tmp_path: Path) -> None:
    """A rapid, two tools, two levels: what their geometry says."""
    text = "G0 X10\nM6 T1\nG1 Z-1 F300\nX60 F3000\nM6 T2\nZ-2 F600\nX-40 F6000\nM2\n"
    course = course_of(*program(tmp_path, text))
    assert course.extent() == {"X": (-40, 60), "Y": (0, 0), "Z": (-2, 0)}
    speeds = course.speeds()
    assert speeds["path"] == pytest.approx(100, rel=1e-3) and speeds["Z"] == pytest.approx(10, rel=1e-3)
    first, one, two = course.tools()
    assert (first["tool"], one["tool"], two["tool"]) == (0, 1, 2)
    assert first["rapid_mm"] == pytest.approx(10) and first["feed_mm"] == 0
    assert (one["feed_mm"], two["feed_mm"]) == (pytest.approx(51, rel=1e-3), pytest.approx(101, rel=1e-3))
    times = sum(tool["feed_seconds"] + tool["rapid_seconds"] for tool in course.tools())
    assert times == pytest.approx(course.seconds)
    assert [(level["z"], round(level["feed_mm"], 6)) for level in course.levels()] == [(-1, 50), (-2, 100)]
    # 100 mm at 100 mm/s and 1000 mm/s^2: 0.9 s of which are at the feed
    bound = course.bound()
    assert sum(bound.values()) == pytest.approx(course.seconds)
    assert bound["feed"] == pytest.approx(0.9 + 0.95 + (1 - 0.05**2 * 100) / 5 + 0.0, rel=0.05)
    assert bound["acceleration of X"] > 0.4 and "speed of X" not in bound


@pytest.mark.parametrize("look_ahead", [4, 8, 48, 300])
def test_the_figures_of_a_tool_are_its_own(tmp_path: Path, look_ahead: int) -> None:
    """Cycles, of which one poll adds several lines and sends them: as of each tool alone."""
    own = "M6 T{0}\nG81 X{0} Y2 Z-3 R2 F60\nX5\nX{1}\nG80\nG0 Z{0}\n"
    text, count = "".join(own.format(tool, 3 * tool) for tool in (1, 2, 3)), own.count("\n")
    course = course_of(*program(tmp_path, text + "M2\n"), look_ahead)
    tools = course.tools()
    assert [tool.pop("tool") for tool in tools] == [1, 2, 3]
    for number, found in enumerate(tools):
        assert found["feed_mm"] == pytest.approx(3 * 5) and found["feed_seconds"] == pytest.approx(15, 0.01)
        alone = Lines(number * count + 1, (number + 1) * count)
        (single,) = course_of(*program(tmp_path, text, alone), look_ahead).tools()
        assert found == pytest.approx({name: single[name] for name in found}, rel=SHARE)
    sources = course.planned.lines["source"].tolist()
    assert sources == sorted(sources)


def test_places_and_speeds_in_time(tmp_path: Path) -> None:
    """A line of 40 mm at 100 mm/s and 1000 mm/s^2, from rest to rest: 5 mm up, 30 mm, 5 mm down."""
    course = course_of(*program(tmp_path, "G1 F6000 X40\n"))
    assert course.seconds == pytest.approx(0.5, rel=1e-3)
    times = np.array([0.05, 0.1, 0.25, 0.4, 0.45])
    assert course.places(times)[:, 0] == pytest.approx([1.25, 5, 20, 35, 38.75], abs=0.02)
    assert course.speed(times) == pytest.approx([50, 100, 100, 100, 50], rel=0.01)


def test_a_speed_that_binds(tmp_path: Path) -> None:
    """Of a rapid: that of the slowest axis on its way."""
    bound = course_of(*program(tmp_path, "G0 X10 Z-60\n")).bound()
    assert next(iter(bound)) == "speed of Z"


def run(*words: object) -> int:
    """The command, on the machine of the example."""
    return cli.main(["preview", *map(str, words), "--machine", str(MACHINE)])


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Figures, picture, page; nothing is left of another run."""
    (tmp_path / "preview.json").write_text("old")
    assert run(GCODE / "part.nc", "--out", tmp_path) == 0
    said = capsys.readouterr().out
    assert "24 lines, 530 chords in 12.0901 s\nextent in mm: X 0 to 80, Y 0 to 60, Z -1 to 2" in said
    facts = json.loads((tmp_path / "preview.json").read_text())
    assert facts["ok"] and facts["path_seconds"] == pytest.approx(12.090084)
    assert (tmp_path / "preview.png").stat().st_size > 20_000
    page = (tmp_path / "preview.html").read_text()
    assert "Bound by" in page and "Levels of Z" in page and "data:image/png" in page
    assert cli.main(["preview", str(GCODE / "part.nc")]) == 2
    assert "needs --machine" in capsys.readouterr().err


def test_all_refused_lines_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With their places, up to 20; lines that only the planner refuses as well."""
    path = tmp_path / "bad.nc"
    path.write_text("G1 X1\nG5 X2\nG0 X1\nG38.2 Z-1 F10\nX1 X2\n" + 30 * "G5\n")
    assert run(path) == 2
    told = capsys.readouterr().err.splitlines()
    assert [line.split(": ")[0].split(":")[-1] for line in told[:4]] == ["1", "2", "4", "5"]
    assert len(told) == 21 and told[-1] == "and 14 more lines"
    path.write_text("G0 X1\nG0 X99999999\nX2\n")
    assert run(path, "--out", tmp_path) == 1
    assert f"{path}:2: " in capsys.readouterr().err


def test_a_part_of_a_program(tmp_path: Path) -> None:
    """From a line to another one: modes of the lines before, and the same steps in between."""
    text = "G21 G91 F3000\nG1 X1.006 Y2\nX5\nY5\nG90 X0\nM2\nX9\n"
    part, machine = program(tmp_path, text, Lines(3, 4))
    assert part.lines == [b"X5\n", b"Y5\n"]
    assert part.begin.steps == [80, 160, 0] and part.ends[:2] == pytest.approx([5.006, 5])
    assert path_of(part, machine)[-1][0][:2] == pytest.approx([5.006, 5])
    check_against_run(part, machine, 48)
    course = course_of(part, machine)
    assert course.extent()["X"] == (1, pytest.approx(6, abs=0.02))
    whole, _ = program(tmp_path, text)
    steps = course_of(whole, machine).planned.lines["steps"]
    assert course.planned.lines["steps"].tolist() == steps[1:3].tolist()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--from", "9"], "there is no line 9"),
        (["--from", "3"], "line 3 is behind the end of the program"),
        (["--from", "2", "--to", "1"], "lines count from 1"),
        (["--from", "0"], "lines count from 1"),
    ],
)
def test_parts_that_there_are_not(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: Sequence[str], told: str
) -> None:
    path = tmp_path / "part.nc"
    path.write_text("G0 X1\nM2\nX3\n")
    assert run(path, *words) == 2
    assert told in capsys.readouterr().err


def test_several_files_and_standard_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One after the other, each up to its end; places name their file."""
    first, second = tmp_path / "first.nc", tmp_path / "second.tap"
    first.write_text("G91 G0 X5\nM2\nnonsense")
    second.write_text("G0 X9\nY5")
    part = read_part([first, second], read_machine(MACHINE))
    assert part.lines == [b"G91 G0 X5\n", b"M2\n", b"G0 X9\n", b"Y5\n"]
    assert part.end[:2] == (9_000_000, 5_000_000) and part.unread == 1  # M2 has ended G91
    assert [str(place) for place in part.places[1:3]] == [f"{first}:2", f"{second}:1"]
    assert run(first, second, "--from", 2) == 2
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"G0 X5\nG5 X1")))
    assert run("-") == 2
    assert "stdin:2: error:20" in capsys.readouterr().err


def test_a_preview_that_is_canceled(tmp_path: Path) -> None:
    """What is planned by then is kept."""
    part, machine = program(tmp_path, "G1 F6000\n" + "".join(f"X{k % 9} Y{k}\n" for k in range(5000)))

    def cancel(_: int) -> None:
        raise KeyboardInterrupt

    planned = plan_part(part, machine, progress=cancel)
    assert planned.canceled and not planned.ended and 1900 < planned.taken < 2100
    assert 1000 < len(planned.lines) < planned.taken and Course(planned, part.begin.place).seconds > 10


def test_nothing_moves(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It is planned to its end, and the command says so."""
    path = tmp_path / "part.nc"
    for text in ("G21\nG90\nM2\n", "G4 P1\n", "G1 X0 F100\nX0\n"):
        path.write_text(text)
        assert run(path, "--out", tmp_path) == 0
        assert capsys.readouterr().err == f"{path}: nothing moved\n"
        assert json.loads((tmp_path / "preview.json").read_text())["problems"] == []


@pytest.mark.parametrize(
    ("text", "line", "machine"),
    [
        ("G0 X1\nG4 P4000\nX2\n", 3, MACHINE),
        ("M66 P0 L3 Q5000\nG0 X1\n", 1, paths.examples / "machines" / "router.toml"),
    ],
)
def test_what_takes_more_than_an_hour(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, line: int, machine: Path
) -> None:
    """It is a problem, whether or not all lines are taken, and not an interruption."""
    path = tmp_path / "part.nc"
    path.write_text(text)
    assert cli.main(["preview", str(path), "--machine", str(machine), "--out", str(tmp_path)]) == 1
    (problem,) = json.loads((tmp_path / "preview.json").read_text())["problems"]
    told = "timeout: no step for an hour of simulated time; the last line taken is "
    assert problem == f"{told}{path}:{line}"
    assert capsys.readouterr().err == f"{path}: {problem}\n"


@pytest.mark.parametrize("command", ["preview", "run"])
def test_a_line_that_moves_for_hours(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    """It is no timeout, however slow its steps are; without a step in an hour that is the reason."""
    path = tmp_path / "part.nc"
    path.write_text("G1 X0.05 F0.0005\n")
    assert cli.main([command, str(path), "--machine", str(MACHINE), "--out", str(tmp_path)]) == 0
    assert "in 6117.7" in capsys.readouterr().out
    path.write_text("G1 X0.05 F0.0001\n")
    assert cli.main([command, str(path), "--machine", str(MACHINE), "--out", str(tmp_path)]) != 0
    told = f"{path}: timeout: no step for an hour of simulated time; the last line taken is {path}:1\n"
    assert told in capsys.readouterr().err


def test_ctrl_c_at_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The results so far, and exit status 130."""

    def cancel(part: Part, machine: MachineFile, look_ahead: int, _: object) -> Planned:
        return replace(plan_part(part, machine, look_ahead), canceled=True, ended=False)

    monkeypatch.setattr(preview_command, "plan_part", cancel)
    path = tmp_path / "part.nc"
    path.write_text("G0 X1\nX2\n")
    assert run(path, "--out", tmp_path) == 130
    assert capsys.readouterr().err == f"{path}: canceled at {path}:2\n"
    assert (tmp_path / "preview.html").exists()
