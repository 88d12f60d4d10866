# SPDX-License-Identifier: MIT
"""Backlash of a machine file: `passo run PART.nc` takes it up with trackers, and the path is that without."""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from passo import cli
from passo.failure import BadInputError
from passo.host_machine import Machine
from passo.machine_file import MachineFile, read_machine
from passo.part import Played, core_of, play_part, read_part
from passo.part_judge import beside
from passo.run import open_engine

AXIS = "[[axis]]\nsteps_per_mm = 80\nspeed = 100\nacceleration = 1000\n"
PLAY = 8, 4, 0  # steps
MACHINE = (
    f"clock_hz = 16_000_000\n{AXIS}backlash = 0.1\ntake_up = 20_000\n{AXIS}backlash = 0.05\n"
    "[[axis]]\nsteps_per_mm = 400\nspeed = 12\nacceleration = 100\n"
)
PART = """G21 G90 G94 F3000
G1 X4 Y0
G3 X4 Y0 I-3 J0
G1 X2 Y-1
M2
"""
SETTLES = 0.025  # s of a take-up, with what the path does meanwhile


def write(folder: Path) -> tuple[Path, Path]:
    machine, part = folder / "machine.toml", folder / "part.nc"
    machine.write_text(MACHINE)
    part.write_text(PART)
    return machine, part


def play(part: Path, machine: MachineFile) -> Played:
    with open_engine("model", core_of(machine), machine.clock_hz) as core:
        return play_part(read_part(part, machine), machine, core)


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Played, Played]]:
    """With its backlash taken up, and the path alone."""
    path, part = write(tmp_path_factory.mktemp("backlash"))
    machine = read_machine(path, takes_up=True)
    plain = replace(machine, ends=tuple(replace(end, backlash=0.0, take_up=0.0) for end in machine.ends))
    yield play(part, machine), play(part, plain)


def places(clocks: np.ndarray, positions: np.ndarray, at: np.ndarray) -> np.ndarray:
    return np.concatenate([[0], positions])[np.searchsorted(clocks, at, side="right")]


def test_the_table_is_where_the_path_is(both: tuple[Played, Played]) -> None:
    """But for a moment at each turn; without the trackers it is off by the play half of the time."""
    played, alone = both
    assert played.problems() == [] and alone.problems() == [] and beside(played, alone) == []
    assert played.seconds == alone.seconds
    end = int(alone.seconds * played.machine.clock_hz)
    at = np.linspace(0, end, 20_000).astype(np.int64)
    for motor, play_steps in enumerate(PLAY):
        path = places(alone.clocks[motor], alone.positions[motor], at)
        shares = []
        for one in (played, alone):
            table, own = 0, places(one.clocks[motor], one.positions[motor], at)
            nut = np.empty(len(at))
            for i, place in enumerate(own.tolist()):
                table = min(max(table, place), place + play_steps)
                nut[i] = table
            shares.append(float((np.abs(nut - path) > 1.5).mean()))
        turns = int((np.diff(np.sign(np.diff(alone.positions[motor]))) != 0).sum())
        if play_steps:
            assert shares[0] <= turns * SETTLES / alone.seconds < 0.5 * shares[1]
            assert played.taken_up[motor] in (0, -play_steps)
        else:
            assert shares == [0, 0] and motor not in played.taken_up


def test_what_is_beside_the_path_is_found(both: tuple[Played, Played]) -> None:
    """A step too low, a path that takes longer, an end that is neither."""
    played, alone = both
    low = [positions - 4 * (np.arange(len(positions)) > 50) for positions in played.positions]
    assert [text.split(" is ")[0] for text in beside(replace(played, positions=low), alone)] == [
        "motor X",
        "motor Y",
    ]
    later = replace(played, motions=[(begin, end + 1) for begin, end in played.motions])
    assert "the path took" in beside(later, alone)[0]
    ended = replace(played, taken_up={0: -3, 1: 0})
    assert any("neither 0 nor the backlash" in problem for problem in ended.problems())


@pytest.mark.parametrize("engine", ["model", "both"])
def test_the_command(tmp_path: Path, engine: str) -> None:
    """It judges both, and says what was taken up."""
    machine, part = write(tmp_path)
    out = tmp_path / "out"
    arguments = ["run", str(part), "--machine", str(machine), "--engine", engine, "--out", str(out)]
    assert cli.main(arguments) == 0
    summary: dict[str, Any] = json.loads((out / "summary.json").read_text())
    assert summary["ok"] and summary["taken_up"] == {"X": -8, "Y": -4}
    assert summary["end"]["steps"] == [160, -80, 0]


GOOD = AXIS + "backlash = 0.1\n"
PINS = "[pins]\nstep_high = 0.00002\nstep_low = 0.000019\n"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (AXIS + "backlash = -1\n", "axis 1: backlash must not be negative"),
        (AXIS + "backlash = 0.001\n", "axis 1: backlash is 0 steps; must be 1 to 65535"),
        (AXIS + "backlash = 900\n", "axis 1: backlash is 72000 steps; must be 1 to 65535"),
        (AXIS + "take_up = 5\n", "axis 1: take_up needs backlash"),
        (GOOD + "take_up = 1e9\n", "axis 1: backlash: acceleration must be at most 1e+09 steps/s"),
        (
            GOOD.replace("= 100\n", "= 2000\n", 1),
            "axis 1: backlash: speed must be less than 125000 steps/s, a step per 128 clocks",
        ),
        ('kinematics = "corexy"\n' + GOOD + AXIS, "axis 1: backlash: the axis shares its motors"),
        (  # 25,641 steps/s; the take-up makes 800
            PINS + GOOD.replace("= 100\n", "= 315\n", 1),
            "axis 1: backlash: speed must be at most 24841 steps/s: the take-up adds to it",
        ),
        (
            PINS + "dir_hold = 0.0001\n" + GOOD + "take_up = 1_600_000\n",
            "axis 1: backlash: acceleration must be at most 1.02041e+08 steps/s^2: a step while DIR turns",
        ),
    ],
)
def test_bad_input(tmp_path: Path, text: str, told: str) -> None:
    path = tmp_path / "machine.toml"
    path.write_text("clock_hz = 16_000_000\n" + text)
    with pytest.raises(BadInputError) as refused:
        read_machine(path, takes_up=True)
    assert told in str(refused.value)


REFUSED = "axis 1: backlash: only passo run, make and console --grbl take backlash up"


def test_others_refuse_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What does not configure trackers must not turn with the play of such a machine."""
    machine, _ = write(tmp_path)
    assert cli.main(["serve", "unused", "--machine", str(machine)]) == 2
    assert REFUSED in capsys.readouterr().err
    with pytest.raises(BadInputError, match=REFUSED):
        Machine.from_file(machine)


@pytest.mark.parametrize(
    ("head", "told"),
    [
        ('board = "hx8k"\n', "backlash: the firmware for STM32F103C8 has no trackers"),
        ('host = "linuxcnc"\n', "backlash: LinuxCNC has its own, BACKLASH in machine.ini"),
    ],
)
def test_make_refuses_it_of_others(
    tmp_path: Path, head: str, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """The small chip has no trackers, and LinuxCNC moves the axes itself."""
    machine, _ = write(tmp_path)
    text = machine.read_text()
    machine.write_text(head + (text.replace("clock_hz = 16_000_000\n", "") if "board" in head else text))
    out = tmp_path / "out"
    assert cli.main(["make", str(machine), "--out", str(out), "--no-build"]) == 2
    assert told in capsys.readouterr().err and not out.exists()


def test_parts_of_the_core(tmp_path: Path) -> None:
    """It gets trackers, of all motors of a ganged axis."""
    path = tmp_path / "machine.toml"
    path.write_text("clock_hz = 16_000_000\n" + GOOD + "motors = 2\n" + AXIS)
    machine = read_machine(path, takes_up=True)
    assert machine.parts == ("trackers",) and core_of(machine).trackers == 1
    assert list(machine.trackers) == [0, 2]
    path.write_text("clock_hz = 16_000_000\n" + AXIS)
    assert core_of(read_machine(path, takes_up=True)).trackers == 0
