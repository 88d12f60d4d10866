# SPDX-License-Identifier: MIT
"""A machine file whose values the settings of grbl cannot have."""

from pathlib import Path

import pytest
from passo.failure import BadInputError
from passo.grbl_setup import default_settings
from passo.machine_file import read_machine
from passo.toolchain import paths

MACHINE = read_machine(paths.examples / "gcode" / "machine.toml")


@pytest.mark.parametrize(
    ("text", "key", "limits"),
    [
        ("spindle_maximum = 2000000", "spindle_maximum", "0 to 1e+06, as $30, not 2e+06"),
        ("junction_deviation = 2000", "junction_deviation", "0 to 1000, as $11"),
        ("arc_tolerance = 0.0000001", "arc_tolerance", "more than 0 and at most 1000, as $12"),
        ("[switches]\ndebounce = 2", "switches: debounce", "0 to 0.00102398, as $26, not 2"),
        ("[home]\nseek = 20000", "home: seek", "more than 0 and at most 16666.7, as $25"),
        ("[home]\npull_off = 1001", "home: pull_off", "at most 1000, as $27"),
    ],
)
def test_a_machine_file_outside_the_ranges(tmp_path: Path, text: str, key: str, limits: str) -> None:
    """It is refused with the key and its range: its settings would be lost at the next start."""
    path = tmp_path / "machine.toml"
    path.write_text(
        (text + "\n" if "[" not in text else "") + MACHINE.path.read_text() + "\n" + text * ("[" in text)
    )
    if "[" not in text:
        name = text.split()[0]
        kept = [line for line in MACHINE.path.read_text().splitlines() if not line.startswith(name)]
        path.write_text(text + "\n" + "\n".join(kept))
    with pytest.raises(BadInputError) as failure:
        default_settings(read_machine(path))
    assert f"{path}: {key} must be " in str(failure.value) and limits in str(failure.value)


@pytest.mark.parametrize(
    ("key", "value", "number"),
    [
        ("travel", 200_000, 131),
        ("speed", 200_000, 111),
        ("acceleration", 2_000_000, 121),
        ("steps_per_mm", 2_000_000, 101),
    ],
)
def test_an_axis_outside_the_ranges(tmp_path: Path, key: str, value: float, number: int) -> None:
    path = tmp_path / "machine.toml"
    head, x, y, z = MACHINE.path.read_text().split("[[axis]]")
    y = (
        "\n".join(line for line in y.splitlines() if not line.startswith(f"{key} "))
        + f"\n{key} = {value:f}\n"
    )
    y = y.replace("speed = 200\n", "speed = 1\n") if key == "steps_per_mm" else y
    quick = '[pins]\nstep_high = "16ns"\nstep_low = "16ns"\ndir_setup = "16ns"\ndir_hold = "16ns"\n'
    path.write_text("[[axis]]".join((head + quick, x, y, z)))  # pins that allow it
    with pytest.raises(BadInputError, match=rf"axis 2: {key} must be .*, as \${number}, not "):
        default_settings(read_machine(path))
