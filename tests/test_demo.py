# SPDX-License-Identifier: MIT
"""The examples of machines whose motors are not their axes, as the demonstration has them."""

from pathlib import Path

import numpy as np
import pytest
from passo.demo_gantry import run_gantry
from passo.machine_file import read_machine
from passo.part import read_part
from passo.part_command import play_to
from passo.toolchain import paths

GCODE = paths.examples / "gcode"


def test_a_gantry_is_squared(tmp_path: Path) -> None:
    """With a picture; a gantry that is not is a problem. The demonstration itself has both engines."""
    summary = run_gantry(GCODE / "gantry.toml", tmp_path, "model")
    assert summary["ok"] and (tmp_path / "motion.png").stat().st_size > 10_000
    wrong = tmp_path / "wrong.toml"
    wrong.write_text((GCODE / "gantry.toml").read_text().replace("racking = 4", "racking = 2"))
    assert run_gantry(wrong, tmp_path / "wrong", "model")["problems"]


def test_an_engraving(tmp_path: Path) -> None:
    """Lines at 45 degrees are steps of one motor."""
    machine = read_machine(GCODE / "corexy.toml")
    played, _, summary = play_to(tmp_path, read_part(GCODE / "engraving.nc", machine), machine, "model")
    assert summary["ok"] and (tmp_path / "path.png").exists()
    assert summary["limits"]["speed"]["share"] == pytest.approx(1, abs=0.01)
    assert all(np.abs(np.diff(place)).max() == 1 for place in played.positions)
