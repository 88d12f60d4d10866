# SPDX-License-Identifier: MIT
"""Encoders in a machine file: each belongs to a motor, whatever axes that moves."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from passo.cli import main
from passo.failure import BadInputError
from passo.grbl_setup import attach, core_for
from passo.machine_file import MachineFile, read_machine
from passo.make_command import definitions
from passo.run import open_engine
from passo.toolchain import paths

from tests.helpers.grbl_console import GrblConsole

HEAD = 'clock_hz = 4_000_000\nchip = "STM32F103CB"\n{}\n'
AXIS = '[[axis]]\nname = "{}"\nsteps_per_mm = 80\nspeed = 100\nacceleration = 1000\n{}\n'
KINDS = {  # the top of the file, keys of X, Y and Z, and counts per mm of each motor
    "one": ("", ("encoders = [40]\nfollowing = 0.2", "", ""), {"X": 40}),
    "ganged": ("", ("", "motors = 2\nencoders = [100, 320]\nfollowing = 0.2", ""), {"Y": 100, "Y2": 320}),
    "half": ("", ("", "motors = 2\nencoders = [0, 320]\nfollowing = 0.2", ""), {"Y2": 320}),
    "corexy": (
        'kinematics = "corexy"',
        ("encoders = [200]\nfollowing = 0.2", "encoders = [40]\nfollowing = 0.3", ""),
        {"X+Y": 200, "X-Y": 40},
    ),
}


def machine_of(folder: Path, kind: str, head: str = "") -> MachineFile:
    top, more, _ = KINDS[kind]
    return written(folder, head + top, *more)


def written(folder: Path, top: str, *more: str) -> MachineFile:
    path = folder / "machine.toml"
    path.write_text(HEAD.format(top) + "".join(map(AXIS.format, "XYZ", more)))
    return read_machine(path)


@pytest.mark.parametrize("kind", KINDS)
def test_a_part(kind: str, tmp_path: Path) -> None:
    """The encoders of its motors follow it; the summary has their greatest errors."""
    machine, part = machine_of(tmp_path, kind), tmp_path / "part.nc"
    part.write_text("G21 G90\nG1 X8 Y3 F3000\nG2 X8 Y9 J3\nG0 X1 Y2 Z1\n")
    assert main(["run", str(part), "--machine", str(machine.path), "--out", str(tmp_path / "out")]) == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert list(summary["following"]) == list(KINDS[kind][2])
    for name, error in summary["following"].items():
        assert 0 < error <= 2 / min(80, KINDS[kind][2][name])


def positions(session: GrblConsole) -> list[int]:
    return session.grbl.player.feed.driver.positions()[: len(session.grbl.machine.motors)]


@pytest.mark.parametrize("kind", KINDS)
def test_a_motor_that_leaves_its_encoder(kind: str, tmp_path: Path) -> None:
    """All motors stop on one path; where they are is what the encoders say, and the next line is right."""
    machine = machine_of(tmp_path, kind)
    with open_engine("model", core_for(machine), machine.clock_hz) as engine:
        ((library, rig),) = attach(engine, machine)
        session = GrblConsole(engine, machine)
        session.limit(60)
        motor, (counts, _) = list(machine.encoders.items())[-1]
        start = [library.passo_rig_position(rig, other) for other in range(len(machine.motors))]
        session.send(b"G0 X20 Y30\n", 0.2)
        library.passo_rig_slip(rig, len(machine.encoders) - 1, -round(counts))  # a millimeter
        session.run(0.5)
        assert "ALARM:3" in session.log and session.status()["state"] == "Alarm"
        made = library.passo_rig_position(rig, motor) - start[motor]
        assert session.line("$X").endswith("ok")
        begun = positions(session)
        assert begun[motor] == pytest.approx(made - 80, abs=3)
        start = [library.passo_rig_position(rig, other) for other in range(len(machine.motors))]
        assert session.line("G0 X20 Y30") == "ok"
        session.rest()
        rows = machine.settings.motors.map(3)
        wanted = (rows @ np.array([20, 30, 0]) * 80).tolist()
        assert positions(session) == wanted
        made = [library.passo_rig_position(rig, other) - was for other, was in enumerate(start)]
        assert made == [end - was for end, was in zip(wanted, begun, strict=True)]


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ("encoders = [10, 10]", "axis 2: encoders must be an array of 1 numbers, one for each motor"),
        ("motors = 2\nencoders = [10]", "axis 2: encoders must be an array of 2 numbers, one for each motor"),
        ("encoders = [10]", "axis 2: encoders and following need each other"),
        ("following = 0.1", "axis 2: encoders and following need each other"),
        ("encoders = [-10]\nfollowing = 0.1", "axis 2: encoders must not be negative"),
        ("motors = 2\nencoders = [0, 0]\nfollowing = 0.1", "axis 2: encoders: no motor has one"),
        ("encoders = [4]\nfollowing = 0.1", "axis 2: following is 0.4 counts; must be 1 to 65535"),
        ("encoders = [9000]\nfollowing = 1", "axis 2: encoders make 900000 counts/s at speed; the core"),
    ],
)
def test_files_that_contradict_themselves(tmp_path: Path, more: str, told: str) -> None:
    with pytest.raises(BadInputError) as failure:
        written(tmp_path, "", "", more, "")
    assert told in str(failure.value) and "\n" not in str(failure.value)


def test_a_machine_with_a_board(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Core, sheet and firmware have them; the small chip has none."""
    text = (paths.examples / "machines" / "router.toml").read_text()
    text = text.replace('name = "Y"', 'name = "Y"\nmotors = 2\nencoders = [0, 40]\nfollowing = 0.5')
    path = tmp_path / "machine.toml"
    path.write_text(text.replace('drive = "DM542"', 'drive = "DM542"\nchip = "STM32F103CB"'))
    assert main(["make", str(path), "--out", str(tmp_path / "out"), "--no-build"]) == 0
    wires = (tmp_path / "out" / "wiring.txt").read_text()
    assert re.search(r"encoder_b\[3\] .* encoder Y2: B", wires) and not re.search(r"encoder [XYZ]:", wires)
    assert "encoders" in capsys.readouterr().out
    assert definitions(read_machine(path))["ENCODERS"] == f"0,0,0,0,0,0,{40 << 32},20"
    path.write_text(text.replace("motors = 2\nencoders = [0, 40]", "encoders = [40]"))
    assert main(["make", str(path), "--no-build"]) == 2
    assert "the firmware for STM32F103C8 has no encoders" in capsys.readouterr().err
