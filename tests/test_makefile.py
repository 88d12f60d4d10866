# SPDX-License-Identifier: MIT
"""Names on the command line of make that nothing reads are refused, with the nearest known one."""

import os
import subprocess

import pytest
from passo.toolchain import paths


def make(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Only what make would do."""
    own = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MAKELEVEL")}
    command = ["make", "--dry-run", *arguments]
    return subprocess.run(command, cwd=paths.root, env=own, capture_output=True, text=True)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("firmware", "BOARD="), "make firmware: unknown variable BOARD; must be one of CHIP, GRBL, MACHINE"),
        (("firmware", "GRLB=1"), "make firmware: unknown variable GRLB; did you mean GRBL?"),
        (("synth", "BORD=hx8k"), "make synth: unknown variable BORD; did you mean BOARD?"),
        (("synth", "board=hx8k"), "make synth: unknown variable board; did you mean BOARD?"),
        (("test", "SEED=1"), "make test: unknown variable SEED: it takes none"),
        (("report", "lint", "ONYL=hx8k"), "make report lint: unknown variable ONYL; did you mean ONLY?"),
    ],
)
def test_unknown_variables(arguments: tuple[str, ...], said: str) -> None:
    """Nothing is begun."""
    done = make(*arguments)
    assert done.returncode == 2 and not done.stdout
    assert done.stderr.strip().endswith(f"*** {said}.  Stop.")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("GRBL=1", "MACHINE=-DHOME=7"), "MACHINE: unknown definition HOME; did you mean HOMES?"),
        (
            ("GRBL=1", "MACHINE=-DAXES=3 -DX=1"),
            "MACHINE: unknown definition X; must be one of AT_SPEED, AXES, ",
        ),
        (("GRBL=1", "MACHINE=AXES=3"), "MACHINE has AXES=3, which is not of the form -DNAME=VALUE"),
        (("MACHINE=-DAXES=3",), "MACHINE needs GRBL=1 or CHIP=cb"),
        (("CHIP=cb", "MACHINE=-DHOME=7"), "MACHINE: unknown definition HOME; did you mean HOMES?"),
        (("CHIP=c9",), "unknown value of CHIP: c9; must be one of c8, cb"),
    ],
)
def test_unknown_definitions(arguments: tuple[str, ...], said: str) -> None:
    """Of the machine, for the grbl image."""
    done = make("-C", str(paths.firmware), *arguments)
    assert done.returncode == 2 and f"*** {said}" in done.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ("firmware", "GRBL=1", "MACHINE=-DAXES=3 -DPROBE=1"),
        ("firmware", "CHIP=cb", "MACHINE=-DAXES=4"),
        ("firmware", "CHIP=cb", "GRBL=1", "MACHINE=-DAXES=4"),
        ("synth", "BOARD=hx8k", "AXES=2", "CLOCK=48", "PARTS=inputs"),
        ("report", "ONLY=hx8k", "QUICK=1", "PARTS=1"),
        ("verify", "ONLY=formal axis", "SEED=1", "SCALE=2"),
        ("test", "PASSO_SEED=7"),
        ("test-all", "TIMES=1"),
    ],
)
def test_known_variables(arguments: tuple[str, ...]) -> None:
    """Those of the help, and what the tests read in their environment."""
    assert make(*arguments).returncode == 0
