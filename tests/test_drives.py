# SPDX-License-Identifier: MIT
"""Drives by name (sim/passo/drives.toml) in machine files."""

import math
from dataclasses import replace
from pathlib import Path

import pytest
from passo.drives import drives
from passo.failure import BadInputError
from passo.grbl_setup import default_settings
from passo.machine_file import MachineFile, read_machine
from passo.native import planner
from passo.toolchain import paths

TEXT = (paths.examples / "gcode" / "machine.toml").read_text()
CLOCKS = (48_000_000, 64_000_000, 81_000_000, 108_000_000, 150_000_000)


def machine(folder: Path, head: str, text: str = TEXT) -> MachineFile:
    """The example with more lines in front."""
    path = folder / "machine.toml"
    path.write_text(f"{head}\n{text}")
    return read_machine(path)


@pytest.mark.parametrize("name", drives())
@pytest.mark.parametrize("clock_hz", CLOCKS)
def test_pins_are_never_shorter_than_the_drive_needs(tmp_path: Path, name: str, clock_hz: int) -> None:
    """In clocks of each board; nor are the settings $0 and $29, which are no longer than needed."""
    text = TEXT.replace("clock_hz = 64_000_000", f"clock_hz = {clock_hz}")
    made = machine(tmp_path, f'drive = "{name}"', text)
    for key, time in drives()[name].pins.items():
        needed = float(time[:-2]) * (1e-6 if time.endswith("us") else 1e-9) * clock_hz
        assert needed <= getattr(made.pins, key) + 1e-6 < needed + 1 + 1e-5
    c, settings = planner(), default_settings(made)
    pulse, turn = (settings.value[number] / 1e6 for number in (c.PASSO_GRBL_PULSE, c.PASSO_GRBL_TURN))
    pins, microsecond = made.pins, clock_hz / 1e6
    assert math.ceil(pulse * microsecond - 1e-6) == max(pins.step_high, pins.step_low)
    assert math.ceil(turn * microsecond - 1e-6) == max(pins.dir_setup, pins.dir_hold)
    assert settings.value[c.PASSO_GRBL_ENABLES_INVERTED] == drives()[name].enable_inverted * 1_000_000


def test_own_timings_go_before_those_of_the_drive(tmp_path: Path) -> None:
    """Each key by itself, and the polarity."""
    own = '[pins]\nstep_high = "4us"\nenable_inverted = true\n'
    made = machine(tmp_path, 'drive = "DM542"', TEXT.replace("[[axis]]", f"{own}[[axis]]", 1))
    drive = machine(tmp_path, 'drive = "DM542"')
    assert made.pins == replace(drive.pins, step_high=256) and made.enable_inverted
    assert not drive.enable_inverted


@pytest.mark.parametrize(
    ("head", "text", "said"),
    [
        ('drive = "DM524"', TEXT, "drive must be one of .*, not 'DM524'; did you mean DM542?"),
        ("drive = 542", TEXT, "drive must be one of .*, not 542"),
        (
            'drive = "TB6600"',
            TEXT.replace("speed = 200", "speed = 1251", 1),
            "axis 1: speed is 1251; the pins allow at most 1250: step_high and step_low are 640 clocks",
        ),
        (
            'drive = "TB6600"',
            TEXT.replace("[[axis]]", "[pins]\nenable_inverted = 1\n[[axis]]", 1),
            "pins: enable_inverted must be true or false, not 1",
        ),
    ],
)
def test_what_is_wrong_is_told(tmp_path: Path, head: str, text: str, said: str) -> None:
    """In a line, with the nearest name or the highest speed."""
    with pytest.raises(BadInputError, match=said):
        machine(tmp_path, head, text)


def test_settings_have_one_time_for_both_halves(tmp_path: Path) -> None:
    """$0 is the longer one of STEP active and inactive: a speed that needs the shorter one is refused."""
    own = '[pins]\nstep_high = "1us"\nstep_low = "9us"\n'
    text = TEXT.replace("[[axis]]", f"{own}[[axis]]", 1).replace("speed = 200", "speed = 1000", 1)
    made = machine(tmp_path, "", text)
    said = r"as \$0 and \$29: axis 1: speed is 1000; the pins allow at most 694\.444"
    with pytest.raises(BadInputError, match=said):
        default_settings(made)
