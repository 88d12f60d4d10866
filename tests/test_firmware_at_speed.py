# SPDX-License-Identifier: MIT
"""The image for the STM32F103CB waits for an input that says that the spindle is at its speed."""

from dataclasses import replace

import pytest
from passo.engine import model_engine
from passo.failure import BuildError
from passo.run import parameters_for
from passo.toolchain import paths
from passo_stm32.grbl_board import LARGE_IMAGE, SMALL_IMAGE, GrblBoard, grbl_elf

HZ = 36_000_000  # of the core
P2 = 0b10  # of the home inputs


def test_the_input() -> None:
    """Motion continues when it rises; else alarm 14 and the spindle off. Another image refuses."""
    elf = grbl_elf(
        paths.build / "tests" / "firmware_CHIP_cb_GRBL_1_AT_SPEED_2", "AT_SPEED=2", image=LARGE_IMAGE
    )
    with model_engine(replace(parameters_for(4), clock_hz=HZ, inputs=1, outputs=1), HZ) as engine:
        board = GrblBoard(engine, elf)
        assert "$394=10.000" in board.line("$$").splitlines() and board.line("$394=0.4") == "ok"
        board.type("M3 S500\nG1 X0.1 F6000\n")
        board.run(0.2)
        assert board.report()["MPos"].startswith("0.000") and board.events()["outputs"][-1] == 1
        engine.set("home", P2)
        board.run(0.1)
        assert board.report()["MPos"].startswith("0.100") and "ALARM" not in board.output
        engine.set("home", 0)
        board.type("M4\nG1 X0.2\n")
        board.run(0.6)
        assert "ALARM:14\r\n" in board.output and board.report()["MPos"].startswith("0.100")
        assert board.events()["outputs"][-1] == 0 and not board.faults
    with pytest.raises(BuildError, match="the image does not wait for a spindle"):
        grbl_elf(paths.build / "tests" / "firmware_GRBL_1_AT_SPEED_2", "AT_SPEED=2", image=SMALL_IMAGE)
