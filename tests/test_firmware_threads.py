# SPDX-License-Identifier: MIT
"""A rigid tap by the image for the STM32F103CB, whose main loop minds the spindle."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
from passo.engine import model_engine, moves_of
from passo.machine_file import read_machine
from passo.part import Played, core_of
from passo.spindle_at import SpindleAt
from passo.toolchain import paths
from passo_stm32.grbl_board import LARGE_IMAGE, GrblBoard, grbl_elf
from passo_stm32.machine import Machine

from benchmarks.rigid_tapping import AXIS, COUNTS, STEPS_PER_MM, WITHIN
from tests.test_rigid_tapping import errors

HZ = 36_000_000  # of the core
TEXT = f"clock_hz = {HZ}\nspindle_maximum = 1000\n[spindle]\ncounts = {COUNTS}\nstart_up = 0.05\n"
TOP, DEPTH, PITCH = 0.5, -0.5, 0.25


def test_a_tap(tmp_path: Path) -> None:
    """Down within a count of the spindle, and back to where it began; a core without the inputs is named."""
    path = tmp_path / "machine.toml"
    path.write_text(TEXT + "".join(AXIS.format(name, STEPS_PER_MM if name == "Z" else 80) for name in "XYZ"))
    machine = read_machine(path)
    core = replace(core_of(machine), clock_hz=HZ)
    elf = grbl_elf(
        paths.build / "tests" / "firmware_CHIP_cb_GRBL_1_TURN_COUNTS_1000",
        f"TURN_COUNTS={COUNTS}",
        image=LARGE_IMAGE,
    )
    with model_engine(core, HZ) as engine:
        spindle = SpindleAt(engine, machine)
        board = GrblBoard(engine, elf)
        spindle.drive(round(0.6 * 65535))
        for line in ("M3 S600", f"G0 Z{TOP}", f"G33.1 Z{DEPTH} K{PITCH}"):
            assert board.line(line, 5) == "ok"
        board.rest(3)
        assert board.report()["MPos"] == f"0.000,0.000,{TOP:.3f}" and not board.faults
        events = board.events()
        moves = moves_of(events, 2)
        made = np.flatnonzero(moves)
        steps = SimpleNamespace(
            clocks=[[], [], events["clock"][made].astype(np.int64)],
            positions=[[], [], np.cumsum(moves[made])],
            counts=spindle.changes(),
            origin=0,
            machine=machine,
        )
    found = errors(cast(Played, steps), [TOP, DEPTH], [(TOP - DEPTH) / PITCH * COUNTS])
    inside = found[round(0.45 * STEPS_PER_MM) : round((TOP - DEPTH - 0.01) * STEPS_PER_MM)]
    assert len(inside) > 0.5 * STEPS_PER_MM and np.abs(inside).max() <= WITHIN
    with model_engine(replace(core, encoders=0), HZ) as engine:
        small = Machine(elf, engine)
        small.run(0.5)
        assert "NO_ENCODERS" in small.output
