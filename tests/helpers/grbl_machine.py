# SPDX-License-Identifier: MIT
"""A console of a machine with homes and a probe."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from passo.grbl_setup import machine_at
from passo.machine_file import read_machine

from tests.helpers.grbl_console import GrblConsole

MACHINE = """
clock_hz = 4_000_000
probe = true
spindle_maximum = 1000
[home]
seek = 40
speed = 10
""" + "".join(
    f"""
[[axis]]
name = "{name}"
steps_per_mm = 80
speed = 200
acceleration = 1000
travel = 200
home = "high"
switches = ["home"]
"""
    for name in "XYZ"
)
PATIENCE = 10  # simulated seconds


@pytest.fixture
def session(tmp_path: Path) -> Iterator[GrblConsole]:
    """A machine with homes and a probe, unlocked."""
    path = tmp_path / "machine.toml"
    path.write_text(MACHINE)
    machine = read_machine(path)
    with machine_at("model", machine) as engine:
        made = GrblConsole(engine, machine)
        made.limit(PATIENCE)
        assert made.line("$X").endswith("ok")
        yield made


def x_of(session: GrblConsole) -> float:
    return session.fields("MPos")[0]
