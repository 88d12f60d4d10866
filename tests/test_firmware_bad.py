# SPDX-License-Identifier: MIT
"""What is wrong at the board of the grbl images: a sentence each, and nothing moves."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from passo.engine import model_engine
from passo.run import parameters_for
from passo.toolchain import paths
from passo_stm32.grbl_board import BOTH_IMAGE, LARGE_IMAGE, SMALL_IMAGE, GrblBoard, grbl_elf
from passo_stm32.machine import Machine

HZ = 36_000_000  # of the core
PARAMETERS = replace(parameters_for(3), clock_hz=HZ)
MACHINE = "AXES=3", "HOMES=7", "PROBE=1", "OUTPUTS=1"
FULL = replace(PARAMETERS, inputs=1, outputs=1)
SECONDS = 0.4  # until it has been said
TEXTS = {
    "NO_INPUTS": "the core has no inputs",
    "NO_OUTPUTS": "the core has no such outputs",
    "PARAMETERS": "the core's channels, axes or ticks do not match",
    "VERSION": "the register map has an unsupported version",
    "NOT_PASSO": "the device is not a Passo core",
    "CLOCK_UNKNOWN": "the core does not tell its clock: set it",
}


@pytest.fixture(scope="module", params=[SMALL_IMAGE, LARGE_IMAGE, BOTH_IMAGE], ids="_".join)
def elf(request: pytest.FixtureRequest) -> Path:
    """The images of a machine that needs three axes, inputs and outputs."""
    folder = paths.build / "tests" / "_".join(("firmware_bad", *request.param))
    return grbl_elf(folder, *MACHINE, image=request.param)


@pytest.fixture
def board(elf: Path) -> Iterator[GrblBoard]:
    """A good board, unlocked."""
    with model_engine(FULL, HZ) as engine:
        made = GrblBoard(engine, elf)
        assert made.line("$X").endswith("ok")
        yield made


@pytest.mark.parametrize(
    ("changed", "registers", "name"),
    [
        ({"inputs": 0}, {}, "NO_INPUTS"),
        ({"outputs": 0}, {}, "NO_OUTPUTS"),
        ({"axes": 2}, {}, "PARAMETERS"),
        ({"clock_hz": 0}, {}, "CLOCK_UNKNOWN"),
        ({}, {1: 0x00090000}, "VERSION"),
        ({}, {0: 0x12345678}, "NOT_PASSO"),
    ],
)
def test_a_core_of_another_machine(
    elf: Path, changed: dict[str, int], registers: dict[int, int], name: str
) -> None:
    """It lacks what the machine needs, has another version, or is something else: there is no greeting."""
    with model_engine(replace(FULL, **changed), HZ) as engine:
        machine = Machine(elf, engine)
        machine.wires.pretend = registers
        machine.run(SECONDS)
        told = f"{name}: {TEXTS[name]}" if "CHIP=cb" in elf.parent.name else name
        assert machine.output.endswith(f"\r\n[MSG:{told}]\r\n") and "Grbl" not in machine.output
        machine.type("$X\nG0 X1\n$H\n")
        machine.run(SECONDS)
        assert machine.output.endswith(f"[MSG:{told}]\r\n") and not machine.events()["step"].any()
        assert machine.resets == [(0, "power")] and not machine.faults


def test_a_core_that_loses_its_clock(board: GrblBoard) -> None:
    """The PLL unlocks, which resets the core: an alarm, no step after it, and nothing moves until `$X`."""
    assert board.line("G1 X40 F3000") == "ok"
    board.run(0.2)
    since = len(board.output)
    board.wires.core.set("rst", 1)
    board.run(0.01)
    board.events()
    board.wires.core.set("rst", 0)
    board.expect("ALARM:3", SECONDS, since)
    board.run(SECONDS)
    assert not board.events()["step"].any()
    assert board.report()["state"] == "Alarm" and board.line("G0 X0") == "error:9"
    assert "Grbl 1.1h" in board.output[since:]  # it was opened again: pins and inputs are set
    assert board.line("$X").endswith("ok") and board.line("G1 X1 F3000") == "ok"


def test_settings_of_a_machine_with_more_axes(board: GrblBoard) -> None:
    """Each is refused; the others are taken."""
    for line in ("$103=80", "$113=6000", "$123=500", "$133=100"):
        assert board.line(line) == "error:3"
    assert board.line("$102=300") == "ok"
    settings = board.line("$$").splitlines()
    assert "$102=300.000" in settings and not any(line.startswith("$103") for line in settings)
    assert board.line("G0 A1") == "error:20" and not board.events()["step"].any()


def test_power_lost_while_settings_are_written(board: GrblBoard) -> None:
    """At any moment of the erasing and writing: the value before or the new one, and nothing moves."""
    assert board.line("$100=80") == "ok"
    value, seen = 80, set()
    for moment in range(0, 100, 9):
        board.type(f"$100={value + 1}\n")
        board.run(0.001 * moment)
        board.restart()
        now = next(line for line in board.line("$$").splitlines() if line.startswith("$100="))
        assert now in (f"$100={value}.000", f"$100={value + 1}.000"), (moment, now)
        seen.add(now == f"$100={value + 1}.000")
        value = int(float(now.partition("=")[2]))
        assert "error" not in board.output.rpartition("Reset by")[2].partition("$0")[0]
    assert seen == {True, False} and not board.events()["step"].any()
