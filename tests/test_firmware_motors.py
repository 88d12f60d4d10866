# SPDX-License-Identifier: MIT
"""The grbl image for the STM32F103CB on machines whose motors are not their axes."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from passo.engine import model_engine
from passo.grbl_setup import attach, core_for, machine_at
from passo.machine_file import MachineFile, read_machine
from passo.make_command import definitions, settings_lines
from passo.run import open_engine
from passo.toolchain import paths
from passo_stm32.grbl_board import LARGE_IMAGE, GrblBoard, grbl_elf
from passo_stm32.machine import Machine

HEAD = 'clock_hz = 36_000_000\nchip = "STM32F103CB"\n'
AXIS = '[[axis]]\nname = "{}"\nsteps_per_mm = {}\nspeed = {}\nacceleration = {}\ntravel = 200\n{}\n'
SQUARING = 'motors = 2\nhome = "high"\nswitches = ["limit_high"]\noffsets = [0, 0.3]'
KINDS = {
    "corexy": ('kinematics = "corexy"\n', ""),
    "ganged": ("", "motors = 2"),
    "gantry": ("[home]\nracking = 0.6\npull_off = 0.5\n", SQUARING),
}


def firmware_of(
    name: str, folder: Path, head: str, axes: Sequence[tuple[str, int, int, int, str]]
) -> tuple[MachineFile, Path]:
    """A machine, and the image with the definitions that `passo make` gives it."""
    path = folder / "machine.toml"
    path.write_text(HEAD + head + "".join(AXIS.format(*axis) for axis in axes))
    machine = read_machine(path)
    given = [f"{name}={value}" for name, value in definitions(machine).items()]
    return machine, grbl_elf(paths.build / "tests" / f"firmware_motors_{name}", *given, image=LARGE_IMAGE)


def assert_settings(board: GrblBoard, machine: MachineFile) -> None:
    """Those of `passo make` are taken in their order, twice, and kept; offsets are within the pull-off."""
    offsets = ["$170=0.000", "$171=0.000", "$172=0.000", "$173=0.300"] if machine.squared else []
    for line in (*settings_lines(machine), *settings_lines(machine)):
        assert board.line(line, 5) == "ok", line
    assert [line for line in board.line("$$").splitlines() if line.startswith("$17")] == offsets
    for line in ("$173=0.501", "$27=0.2", "$27=0.61") if offsets else ("$170=0", "$173=0.1"):
        assert board.line(line, 5).endswith("error:3")


@pytest.mark.parametrize("kind", KINDS)
def test_lines_of_axes_move_motors(kind: str, tmp_path: Path) -> None:
    """Of the firmware itself, with the definitions that `passo make` gives it; a core with fewer says so."""
    head, more = KINDS[kind]
    limits = (("X", 80, 200, 1000, ""), ("Y", 80, 200, 1000, more), ("Z", 400, 12, 100, ""))
    machine, elf = firmware_of(kind, tmp_path, head, limits)
    with machine_at("model", machine) as engine:
        board = GrblBoard(engine, elf)
        board.line("$X")
        for line in ("G0 X2 Y1", "G1 X1 Y3 Z0.1 F3000", "G4 P0.01"):
            assert board.line(line, 5) == "ok"
        rows = machine.settings.motors.map(3)
        events = board.events()
        for motor, place in enumerate((rows @ np.array([1, 3, 0.1]) * machine.settings.scales).tolist()):
            level = events["step"].astype(np.int64) >> motor & 1
            rising = np.flatnonzero(np.diff(level, prepend=0) == 1)
            back = events["dir"][rising].astype(np.int64) >> motor & 1
            assert int((1 - 2 * back).sum()) == place
        assert not board.faults
        assert_settings(board, machine)
    with model_engine(replace(core_for(machine), axes=len(rows) - 1), machine.clock_hz) as engine:
        small = Machine(elf, engine)
        small.run(0.5)
        assert "[MSG:PARAMETERS: " in small.output and "Grbl" not in small.output


@pytest.mark.sample(1)
def test_a_motor_that_leaves_its_encoder(tmp_path: Path) -> None:
    """It stops both motors of its axis; a core without encoders is none for this machine."""
    more = "motors = 2\nencoders = [0, 320]\nfollowing = 0.2"
    machine, elf = firmware_of(
        "encoders", tmp_path, "", [("X", 80, 200, 1000, ""), ("Y", 80, 200, 1000, more)]
    )
    with open_engine("model", core_for(machine), machine.clock_hz) as engine:
        ((library, rig),) = attach(engine, machine)
        start = library.passo_rig_position(rig, 1) - library.passo_rig_position(rig, 2)
        board = GrblBoard(engine, elf)
        assert board.line("G0 Y2", 5) == board.line("G0 Y12", 5) == "ok"
        board.run(0.02)
        library.passo_rig_slip(rig, 0, -320)
        board.expect("ALARM:3", 0.5)
        board.run(0.3)
        assert library.passo_rig_position(rig, 1) - library.passo_rig_position(rig, 2) == start
        assert board.line("$X", 5).endswith("ok") and board.line("G0 Y12", 5) == "ok"
        board.rest(3)
        assert board.report()["MPos"] == "0.000,12.000,0.000" and not board.faults
        assert library.passo_rig_position(rig, 2) - library.passo_rig_position(rig, 1) + start == 80
    with model_engine(replace(core_for(machine), encoders=0), machine.clock_hz) as engine:
        small = Machine(elf, engine)
        small.run(0.5)
        assert "[MSG:NO_ENCODERS: " in small.output and "Grbl" not in small.output
