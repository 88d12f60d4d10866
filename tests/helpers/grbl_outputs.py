# SPDX-License-Identifier: MIT
"""Outputs of a board with grbl, at the pins of its core."""

from passo_stm32.grbl_board import GrblBoard

SPINDLE, REVERSE, FLOOD = 1, 2, 4


def check_outputs_at_rest(board: GrblBoard) -> None:
    """Spindle and coolant change at rest, and behind the last motion when it ends; a reset ends them."""

    def levels_after(lines: str, seconds: float) -> int:
        board.type(lines)
        board.run(seconds)
        return int(board.events()["outputs"][-1])

    assert levels_after("M3 S500 M8\n", 0.1) == SPINDLE | FLOOD
    assert levels_after("G1 X5 F1500\nM5\n", 0.1) == SPINDLE | FLOOD
    assert board.report()["state"] == "Run"
    assert levels_after("", 0.4) == FLOOD and board.report()["state"] == "Idle"
    assert levels_after("M4\nG4 P0.3\nG1 X6\n", 0.1) == SPINDLE | REVERSE | FLOOD
    board.rest(1)
    assert levels_after("\x18", 0.2) == 0
    assert levels_after("M3\nG1 X0 F1500\n", 0.1) == SPINDLE
    assert levels_after("\x18", 0.3) == 0
