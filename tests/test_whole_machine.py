# SPDX-License-Identifier: MIT
"""The machine of a file as a whole: sender, firmware, board, wires, drives and switches."""

import os
import re
from pathlib import Path

import numpy as np
import pytest
from passo.drives import drives
from passo.engine import EVENT
from passo.toolchain import paths

from tests.helpers.whole_machine import WholeMachine, drive, run

MACHINES = paths.examples / "machines"
ROUTER = (MACHINES / "router.toml").read_text()
PART = [
    "G21 G90 G17 G54",
    "M3 S8000",
    "G1 X0.3 Y0.2 F3000",
    "G3 X0.1 Y0.4 I-0.2",
    "G1 X0 Y0.1 Z-0.1",
    "M5",
    "M30",
]
HOME = "[home]\nseek = 20\nspeed = 10\npull_off = 0.05\n\n"
HZ = 36_000_000


def small(folder: Path) -> Path:
    """A router that homes in a moment, on a board with one pin for home and limit, at its slowest clock."""
    text = ROUTER.replace('"hx8k"', f'"icebreaker"\nclock_hz = {HZ}').replace(
        "[switches]", f"{HOME}[switches]"
    )
    path = folder / "small.toml"
    path.write_text(
        re.sub(r"travel = \d+", "travel = 0.6", text).replace(
            'switches = ["home"]', 'switches = ["limit_low"]', 1
        )
    )
    return path


@pytest.mark.first
def test_a_part_on_the_whole_machine(tmp_path: Path) -> None:
    """It homes and ends within half a step; no drive sees a timing that its data sheet does not allow."""
    seen = run(WholeMachine(small(tmp_path), tmp_path / "made"), PART)
    assert all(len(driven.seconds) > 50 and driven.turns > 2 for driven in seen)


WHOLE = "PASSO_WHOLE"


@pytest.mark.skipif(WHOLE not in os.environ, reason="make whole-machine")
def test_four_motors(tmp_path: Path) -> None:
    """The example and its whole part, by the image of the large chip: a quarter of an hour."""
    lines = (MACHINES / "motors.nc").read_text().splitlines()
    assert len(run(WholeMachine(MACHINES / "motors.toml", tmp_path / "made"), lines)) == 4


@pytest.mark.skipif(WHOLE not in os.environ, reason="make whole-machine")
@pytest.mark.parametrize(("name", "axes"), [("laser", 2), ("router", 3)])
def test_an_example_that_homes(tmp_path: Path, name: str, axes: int) -> None:
    """With its whole part, on its board at its clock; only its travel is shorter, as is the way home."""
    text = (MACHINES / f"{name}.toml").read_text()
    path = tmp_path / f"{name}.toml"
    path.write_text(re.sub(r"travel = \d+", "travel = 2", text).replace("[switches]", f"{HOME}[switches]"))
    lines = (MACHINES / f"{name}.nc").read_text().splitlines()
    seen = run(WholeMachine(path, tmp_path / "made"), lines)
    assert len(seen) == axes and all(len(driven.seconds) > 100 and driven.turns > 2 for driven in seen)


GOOD = {
    "back": 10,
    "rise": 20,
    "fall": 25,
    "rise again": 30,
    "fall again": 35,
    "forth": 40,
}  # half microseconds


@pytest.mark.parametrize(
    ("changed", "faults"),
    [
        ({}, []),
        ({"back": 11}, ["dir_setup of 4.5 us, not 5us"]),
        ({"fall": 24}, ["step_high of 2 us, not 2.5us"]),
        ({"rise again": 29}, ["step_low of 2 us, not 2.5us"]),
        ({"forth": 39}, ["dir_hold of 2 us, not 2.5us"]),
        ({"off": 15}, ["steps while it is off"]),
    ],
)
def test_a_drive_tells_what_it_does_not_like(changed: dict[str, int], faults: list[str]) -> None:
    """Each of its times half a microsecond too short, and steps while it is off."""
    levels, rows = {"step": 0, "dir": 0, "enable": 1}, []
    for name, clock in sorted((GOOD | changed).items(), key=lambda edge: edge[1]):
        pin = {"rise": "step", "fall": "step", "off": "enable"}.get(name.partition(" ")[0], "dir")
        levels[pin] = int(name.startswith(("rise", "back")))
        rows.append((clock, levels["step"] << 1, levels["dir"] << 1, levels["enable"] << 1))
    events = np.zeros(len(rows), EVENT)
    for row, values in zip(events, rows, strict=True):
        row["clock"], row["step"], row["dir"], row["enable"] = values
    seen = drive(events, 1, drives()["DM542"], 2_000_000)
    assert seen.faults == faults and seen.positions.tolist() == [-1, -2] and seen.turns == 2
