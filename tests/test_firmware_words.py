# SPDX-License-Identifier: MIT
"""The table of docs/gcode.md of words and images: each image and the PC are asked for each word."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from passo.engine import model_engine
from passo.expand.expander import Options, expand_file, needs_expanding
from passo.expand.tools import Tool
from passo.run import parameters_for
from passo.toolchain import paths
from passo_stm32.board import make_firmware
from passo_stm32.grbl_board import BOTH_IMAGE, LARGE_IMAGE, SMALL_IMAGE, GrblBoard, grbl_elf
from passo_stm32.machine import Machine

HZ = 36_000_000  # of the core
# Six axes, and the inputs of one more for the encoder of the spindle.
PARAMETERS = replace(parameters_for(7), clock_hz=HZ, inputs=1, outputs=1, encoders=1)
PAGE = (paths.docs / "gcode.md").read_text(encoding="utf-8")
HEAD, *ROWS = (
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in PAGE[PAGE.index("| word |") :].split("\n\n")[0].splitlines()
    if line.startswith("| ")
)
TAKES = {
    word: dict(zip(HEAD[1:], row[1:], strict=True)) for row in ROWS for word in re.findall("`(.+?)`", row[0])
}
PLAIN = [word for word, takes in TAKES.items() if re.fullmatch(r"[A-Z][0-9.]*", word) and takes["grbl CB"]]
IMAGES = {"grbl C8": SMALL_IMAGE, "grbl CB": LARGE_IMAGE, "both CB": BOTH_IMAGE}
SPINDLE = {"grbl CB": ("TURN_COUNTS=1000",)}
NOT_TAKEN = ("error:20", "error:23")
PAUSE = "M0"
EXPANDED = {
    "G41": "G41 D1 G1 X1\nG40", "G41.1": "G41.1 D.1\nG1 X1\nG40", "G42": "G42 D1 G1 X1\nG40",
    "G42.1": "G42.1 D.1\nG1 X1\nG40", "M98": "M98 P1\nM2\nO1\nG0 X2\nM99",
    "M99": "M98 P1\nM2\nO1\nG0 X2\nM99", "O": "o1 if [1]\nG0 X1\no1 endif", "#": "#1=2\nG0 X#1",
    "[": "G0 X[1+1]",
}  # fmt: skip


def test_it_has_a_column_for_each_image() -> None:
    assert HEAD[1:] == ["console C8", *IMAGES, "PC"]
    assert len(PLAIN) > 80 and set(TAKES) - set(PLAIN) == EXPANDED.keys()


@pytest.mark.parametrize("name", IMAGES)
def test_an_image(name: str) -> None:
    """A word is taken, or its line lacks something; or it is not supported."""
    given = SPINDLE.get(name, ())
    folder = "_".join(("firmware", *IMAGES[name], *given)).replace("=", "_")
    elf = grbl_elf(paths.build / "tests" / folder, *given, image=IMAGES[name])
    found = {}
    with model_engine(PARAMETERS, HZ) as engine:
        board = GrblBoard(engine, elf)
        for word in PLAIN:
            said = board.line(word if len(word) > 1 else f"{word}0")
            found[word] = said.splitlines()[-1] not in NOT_TAKEN
            if word == PAUSE:
                board.type("~")
        assert not board.faults
    assert found == {word: bool(TAKES[word][name]) for word in PLAIN}


def test_the_console_has_none() -> None:
    """It has commands of its own."""
    folder = paths.build / "tests" / "firmware_small_False"
    make_firmware(f"OUT={folder}", str(folder / "passo.elf"))
    with model_engine(PARAMETERS, HZ) as engine:
        board = Machine(folder / "passo.elf", engine)
        board.run(0.2)
        since = len(board.output)
        board.type("".join(f"{word}\r" for word in ("G0", "G0 X1", "M3", "F100")))
        board.run(0.2)
        assert board.output[since:].count("error") == 4
    assert not any(takes["console C8"] for takes in TAKES.values())


def test_the_pc(tmp_path: Path) -> None:
    """What is not a plain word is expanded."""
    assert all(takes["PC"] for takes in TAKES.values())
    for word, text in EXPANDED.items():
        (tmp_path / "part.ngc").write_text(f"F100\nG0 X0 Y0\n{text}\n")
        assert needs_expanding(text.encode()), word
        expanded = expand_file(tmp_path / "part.ngc", Options(tools={1: Tool(1, 0.1)}, at_zero=True))
        assert expanded and not any(word in line.text for line in expanded), word
