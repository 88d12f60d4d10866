# SPDX-License-Identifier: MIT
"""`passo heightmap`: the depth of cut on bowed and twisted plates, by closed form."""

import math
from pathlib import Path

import pytest
from passo.cli import main
from passo.expand.height_map import HeightMap, read_height_map
from passo.failure import BadInputError
from passo.gcode import NANOMETERS, Gcode, GcodeSettings
from passo.native import planner

from benchmarks import height_map as benchmark
from benchmarks.height_map import PLATES, cut, followed, places, plate


@pytest.mark.parametrize("name", PLATES)
def test_depth_of_cut(tmp_path: Path, name: str) -> None:
    """Lines and arcs in all modes are as deep in the plate as programmed."""
    made = cut(tmp_path, name)
    assert made.worst < PLATES[name][1]
    assert made.points > 2000 and made.lines < 200


def test_a_coarse_map_is_seen(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """The command prints the figures; probed every 20 mm the bowed plate is cut too deep."""
    assert benchmark.main() == 0
    assert capsys.readouterr().out.count("depth of cut within") == len(PLATES)
    monkeypatch.setattr(benchmark, "cut", lambda folder, name: cut(folder, name, 20))
    assert benchmark.main() == 1


def test_way_in_the_plane(tmp_path: Path) -> None:
    """Pieces of an arc and of a line stay on it, to a micrometer."""
    lines = followed(tmp_path, "G0 X20 Y30 Z0\nG2 X20 Y30 I15 J20 F100\n", plate(PLATES["twisted"][0]))
    assert len(lines) > 10
    for at_feed, x, y, _ in places(lines):
        assert not at_feed or abs(abs(complex(x - 35, y - 50)) - 25) < 0.001
    lines = followed(tmp_path, "G0 X20 Y30 Z0\nG91 G1 X60 Y30 F100\n", plate(PLATES["twisted"][0]))
    assert len(lines) > 10
    for at_feed, x, y, _ in places(lines):
        assert not at_feed or abs((x - 20) / 2 - (y - 30)) < 0.001


def test_arc_of_another_plane(tmp_path: Path) -> None:
    """It becomes lines, as deep."""
    surface, bound = PLATES["bowed by 0.5 mm"]
    lines = followed(tmp_path, "G0 X20 Y30 Z0\nG18 G3 X60 Z0 I20 K-50 F100\n", plate(surface))
    center, radius = complex(40, -50), math.hypot(20, 50)
    for at_feed, x, y, z in places(lines):
        assert not at_feed or abs(abs(complex(x, z - surface(x, y)) - center) - radius) < bound


def test_lines_stay_readable(tmp_path: Path) -> None:
    """Other words and comments stay; only what bends is cut."""
    text = "G90 (start)\nG0 Z5\nG0 X5 Y5\nM3 S10 G1 Z0 F90 (down)\nX45 N7\nG91 Z1\nG28 Z1\nG90 G0 X0\nM2\n"
    flat = plate(lambda x, y: 1.0)
    assert followed(tmp_path, text, flat) == [
        "G90 (start)", "G0 Z5", "G0 X5 Y5 Z6", "M3 S10 F90 (down) G1 Z1", "N7 G1 X10", "G1 X20", "G1 X30",
        "G1 X40", "G1 X45", "G91 G1 Z1", "G28 Z1", "G90 G0 X0", "M2",
    ]  # fmt: skip


def test_timed_motion_keeps_its_time(tmp_path: Path) -> None:
    """G93: the pieces take as long as the line."""
    lines = followed(tmp_path, "G0 X0 Y0 Z0\nG93 G1 X50 Y40 F2\n", plate(PLATES["twisted"][0]))
    rates = [float(line.split("F")[1]) for line in lines[1:]]
    assert len(rates) > 5 and sum(1 / rate for rate in rates) == pytest.approx(0.5, rel=1e-3)


LEAVES = "this motion leaves the height map: X 0 to 100, Y 0 to 80 (Passo)"
REFUSED = {
    "G0 X0 Y0 Z0\nG1 X101 F100": f"2: {LEAVES}",
    "G0 X98 Y40 Z0\nG3 X98 Y40 I1 F100": "",
    "G0 X98 Y40 Z0\nG3 X98 Y40 I1.5 F100": f"2: {LEAVES}",
    "G0 X0 Y0\nG1 X9 F100": "2: Z is not known: move it before, for the height map (Passo)",
    "G0 Z0 Y0\nG1 X9 F100": "2: where this motion begins is not known: move X, Y, Z before (Passo)",
    "G0 X0 Y0 Z0\nG92 X5": "2: the origin of the height map cannot be moved behind its first motion (Passo)",
    "G0 X0 Y0 Z0\nG55 X1": "2: the origin of the height map cannot be moved behind its first motion (Passo)",
    "G0 X0 Y0 Z3\nG81 Z0 R1 F9": "2: cycles do not follow a height map: write out their motions (Passo)",
    "G55 G0 X0 Y0 Z0\nG43.1 Z1\nG0 Z3": "",
}


@pytest.mark.parametrize("text", REFUSED)
def test_refusal(tmp_path: Path, text: str) -> None:
    """What cannot follow the map is an error with its line."""
    flat = plate(lambda x, y: 0.0)
    if not REFUSED[text]:
        followed(tmp_path, text, flat)
        return
    with pytest.raises(BadInputError) as caught:
        followed(tmp_path, text, flat)
    assert str(caught.value) == f"{tmp_path / 'part.ngc'}:{REFUSED[text]}"


def test_bilinear() -> None:
    """Between four points, and outside."""
    one = HeightMap((0.0, 10.0), (0.0, 20.0), ((0.0, 1.0), (2.0, 5.0)))
    assert one.height(5 + 10j) == 2 and one.height(10 + 20j) == 5 and one.height(0j) == 0
    assert one.height(-3 + 10j) == 1 and one.height(30 + 40j) == 5


def test_file(tmp_path: Path) -> None:
    """Points in any order, or the log of a sender; a bad file is named."""
    path = tmp_path / "map.csv"
    text = "x,y,z\n0,0,1\n10,0,2 # a corner\n10;20;4\n\n0 20 3\n"
    wanted = HeightMap((0.0, 10.0), (0.0, 20.0), ((1.0, 2.0), (3.0, 4.0)))
    for written in (text, text.removeprefix("x,y,z\n"), text.replace("\n", "\r\n")):
        for encoding in ("utf-8", "utf-8-sig"):  # as of a spreadsheet
            path.write_text(written, encoding=encoding, newline="")
            assert read_height_map(path) == wanted
    points = ((5, 5, -9), (15, 5, -8), (15.001, 25, -6), (5, 25, -7))
    path.write_text(
        "ok\n"
        + "".join(f"[PRB:{x}.000,{y}.000,{z}.000:1]\nok\n" for x, y, z in points).replace(".001.000", ".001")
    )
    assert read_height_map(path, (5, 5, -10)).heights == wanted.heights
    for text, reason in {
        "": "there is no point: x,y,z",
        "0,0,0\n1,1,1\n": "2 points are no grid of 2 by 2: X1 Y0 is missing",
        "0,0,0\n1,0,0\n": "2 points are no grid of 2 by 1",
        "0,0,0\n0,0,1\n": "X0 Y0 is there twice",
        "0,0,0\n0,zero\n": "2: no point: 0,zero; x,y,z is wanted",
        "[PRB:1,2,3:0]\n": "1: the probe did not touch",
    }.items():
        path.write_text(text)
        with pytest.raises(BadInputError) as caught:
            read_height_map(path)
        assert str(caught.value).endswith(reason)


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """From probing a rectangle to lines that follow it."""
    probe, log, part, out = (tmp_path / name for name in ("probe.nc", "log", "part.ngc", "out.nc"))
    assert main(["heightmap", "--probe", "0,0,20,10", "--step", "10", "-o", str(probe)]) == 0
    assert capsys.readouterr().out == f"6 points: {probe}\n"
    gcode, logged = Gcode(GcodeSettings()), []
    for line in probe.read_text().splitlines():
        gcode.execute(line)
        logged += [tuple(a.target[0:3]) for a in gcode.actions() if a.kind == planner().PASSO_GCODE_PROBE]
    assert [(x // NANOMETERS, y // NANOMETERS) for x, y, _ in logged] == [
        (0, 0), (10, 0), (20, 0), (20, 10), (10, 10), (0, 10),
    ]  # fmt: skip
    log.write_text("".join(f"[PRB:{x / 1e6},{y / 1e6},-1.5:1]\n" for x, y, _ in logged))
    part.write_text("#1=15\nG0 X0 Y0 Z1\nG1 X#1 F100\n")
    asked = ["heightmap", str(part), "--map", str(log), "--origin", "0,0,-2", "-o", str(out)]
    assert main(asked) == 0 and capsys.readouterr().out == f"part.ngc: 3 plain lines: {out}\n"
    assert out.read_text() == "G0 X0 Y0 Z1.5\nF100 G1 X10\nG1 X15\n"
    for wrong in (["--origin", "1,2"], ["--map", str(tmp_path / "none")]):
        assert main([*asked, *wrong]) == 2
    assert main(["heightmap", str(part)]) == 2
    assert main(["heightmap", "--probe", "0,0,0,10"]) == 2
    capsys.readouterr()
    for words, told in {
        ("--probe", "0,0,9,9", "--map", str(log)): "--map is for a program, not for --probe",
        (str(part), "--map", str(log), "--step", "5"): "--step is for --probe",
        ("--probe", "0,0,100000,100000", "--step", "1"): "more than 1,000,000 points",
        ("--probe", "0,0,9,200000"): "--probe takes 4 numbers of up to 100,000 mm",
    }.items():
        assert main(["heightmap", *words]) == 2
        said = capsys.readouterr()
        assert told in said.err and said.err.count("\n") == 1 and not said.out
