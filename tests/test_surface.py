# SPDX-License-Identifier: MIT
"""Probes of a simulated surface in `passo run`: where they end, by closed form, and #5061 to #5070."""

import re
from pathlib import Path

import numpy as np
import pytest
from passo.cli import main
from passo.expand.expander import Options, expand_file
from passo.expand.height_map import HeightMap
from passo.expand.place import ExpandError
from passo.gcode import GcodeSettings
from passo.machine_file import read_machine
from passo.part import play_part, read_part
from passo.run import open_engine, parameters_for
from passo.toolchain import paths

MACHINE = paths.examples / "gcode" / "machine.toml"
# z = -5 + x / 10 + x y / 200: bilinear on any grid
GRID = (0.0, 10.0, 25.0, 40.0)


def height(x: float, y: float) -> float:
    return -5 + x / 10 + x * y / 200


SURFACE = HeightMap(GRID, GRID, tuple(tuple(height(x, y) for x in GRID) for y in GRID))
OPTIONS = Options(GcodeSettings(axes=3), at_zero=True, surface=SURFACE)


def expanded(folder: Path, text: str) -> list[str]:
    path = folder / "part.ngc"
    path.write_text(text)
    return [line.text for line in expand_file(path, OPTIONS)]


def end_of(line: str) -> tuple[float, ...]:
    """The machine coordinates of a line."""
    assert "G53 G1" in line and "G38" not in line
    return tuple(float(number) for number in re.findall(r"[XYZ](-?[0-9.]+)", line))


@pytest.mark.parametrize(("x", "y"), [(0, 0), (10, 25), (13, 17), (40, 40), (33.5, 0.25)])
def test_down(tmp_path: Path, x: float, y: float) -> None:
    """To the surface, whatever units and distance mode; #5061 to #5070 have the place."""
    said = "G1 X[#5061] Y[#5062] Z[#5063*2] F9\nG0 Z[#5070]\n"
    lines = expanded(tmp_path, f"G0 X{x} Y{y} Z9\nG38.2 Z-20 F100\n{said}")
    assert end_of(lines[1]) == pytest.approx((x, y, height(x, y)), abs=2e-6)
    words = [float(number) for number in re.findall(r"[XYZ](-?[0-9.]+)", lines[2])]
    assert words == pytest.approx([x, y, 2 * height(x, y)], abs=4e-6) and lines[3] == "G0 Z1"
    lines = expanded(
        tmp_path, f"G20 G91 G0 X{x / 25.4:.6f} Y{y / 25.4:.6f}\nG0 Z1\nG38.3 Z-9 F9\nG0 Z#5063\n"
    )
    inches = end_of(lines[2])
    assert 25.4 * inches[2] == pytest.approx(height(x, y), abs=2e-5)  # 6 decimals of an inch
    assert float(lines[3].split("Z")[1]) == pytest.approx(inches[2], abs=2e-6)


def test_along_a_slope(tmp_path: Path) -> None:
    """A probe aside, and one away; with offsets and the length of a tool."""
    (line,) = expanded(tmp_path, "G0 Z-3 Y20\nG38.2 X40 F100\n")[1:]
    assert end_of(line) == pytest.approx((10, 20, -3), abs=1e-5)
    lines = expanded(tmp_path, "G0 Z-3 X30 Y20\nG38.4 X0 F100\n")
    assert end_of(lines[1]) == pytest.approx((10, 20, -3), abs=1e-5)
    lines = expanded(tmp_path, "G92 X-10 Z3\nG43.1 Z2\nG38.2 Z-30 F100\nG0 Z[#5063]\n")
    assert end_of(lines[2]) == pytest.approx((0, 0, -3), abs=2e-6)
    assert lines[3] == "G0 Z-2"


def test_the_probe_in_force(tmp_path: Path) -> None:
    """Axis words alone are another probe; other commands are not."""
    lines = expanded(tmp_path, "G0 Z2\nG38.3 Z-9 F100\nG92 Z0\nG53 G0 Z3\nG38.3 X10 Z-9\n")
    assert end_of(lines[1]) == pytest.approx((0, 0, -5)) and lines[2:4] == ["G92 Z0", "G53 G0 Z3"]
    lines = expanded(tmp_path, "G0 Z2\nG38.3 Z-1 F100\nZ-9\n")
    assert end_of(lines[1])[2] == -1 and end_of(lines[2])[2] == pytest.approx(-5)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("G38.2 Z-1 F10", "1: the probe touches nothing"), ("G38.4 Z9 F10", "1: the probe does not touch"),
        ("G0 Z-9\nG38.2 Z-10 F10", "2: the probe touches already"),
        ("G0 Z-9\nG38.4 Z-10 F10", "2: the probe touches to the end"), ("G38.2 Z-9", "1: error:22"),
    ],
)  # fmt: skip
def test_errors(tmp_path: Path, text: str, said: str) -> None:
    """As the alarms of the machine."""
    with pytest.raises(ExpandError, match=said):
        expanded(tmp_path, text)


def test_a_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A grid is probed, and the work zero set by it; without a surface the file is refused."""
    machine, part, map_file = read_machine(MACHINE), tmp_path / "part.ngc", tmp_path / "map.csv"
    part.write_text("G0 X10 Y25\nG38.2 Z-20 F600\nG10 L20 P1 Z0\nG0 Z5\nG0 X20\nG38.2 Z-20\nG1 Z[#5063-1]\n")
    map_file.write_text("".join(f"{x},{y},{height(x, y)}\n" for y in GRID for x in GRID))
    made = read_part(part, machine, surface=SURFACE)
    with open_engine("model", parameters_for(3), machine.clock_hz) as engine:
        played = play_part(made, machine, engine)
    assert not played.problems()
    wanted = np.array([20, 25, height(20, 25) - 1]) * machine.settings.scales
    assert played.end[:3] == pytest.approx(wanted.tolist(), abs=0.51)
    command = ["preview", str(part), "--machine", str(MACHINE), "--out", str(tmp_path / "out")]
    assert main([*command, "--surface", str(map_file)]) == 0
    capsys.readouterr()
    part.write_text("G38.2 Z-20 F600\n")
    assert main(command) != 0 and "--surface MAP.csv" in capsys.readouterr().err
