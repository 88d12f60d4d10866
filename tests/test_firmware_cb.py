# SPDX-License-Identifier: MIT
"""The images for the STM32F103CB: grbl, and grbl with the console."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from passo.engine import model_engine
from passo.grbl import Grbl
from passo.grbl_setup import machine_at
from passo.machine_file import CHIPS, read_machine
from passo.make_command import CHIP_AXES, IMAGE, LARGE, settings_lines
from passo.run import parameters_for
from passo.toolchain import paths
from passo_stm32.board import make_firmware, motions
from passo_stm32.flash import PAGE
from passo_stm32.grbl_board import BOTH_IMAGE, GREETING, LARGE_IMAGE, SMALL_IMAGE, GrblBoard, grbl_elf
from passo_stm32.machine import Machine
from passo_stm32.processor import FLASH

from tests.helpers.grbl_outputs import check_outputs_at_rest

HZ = 36_000_000  # of the core
PARAMETERS = replace(parameters_for(4), clock_hz=HZ, inputs=1, outputs=1, encoders=1)
CODE, SIZE, SETTINGS = 120 << 10, 128 << 10, 4 << 10
SMALL_SIZE = 64 << 10
CONSOLE = "help lists the commands\n"
SECONDS = 0.5  # until one has become the other


IMAGES = [LARGE_IMAGE, BOTH_IMAGE]
LEFT_OUT = {LARGE_IMAGE: ": no console", BOTH_IMAGE: ": no tools"}
LINES = {LARGE_IMAGE: 30, BOTH_IMAGE: 40}  # of the look-ahead

with_console = pytest.mark.parametrize("image", [BOTH_IMAGE], ids="_".join, indirect=True)


@pytest.fixture(scope="module", params=IMAGES, ids="_".join)
def image(request: pytest.FixtureRequest) -> tuple[str, ...]:
    """As the makefile calls it."""
    return request.param


@pytest.fixture(scope="module")
def elf(image: tuple[str, ...]) -> Path:
    """The program."""
    folder = "_".join(("firmware", *image)).replace("=", "_")  # make takes a name with = for a variable
    return grbl_elf(paths.build / "tests" / folder, image=image)


@pytest.fixture
def board(elf: Path) -> Iterator[GrblBoard]:
    """A board with the C model of a core that has everything."""
    with model_engine(PARAMETERS, HZ) as engine:
        made = GrblBoard(engine, elf)
        yield made
        assert not made.faults


def as_console(board: GrblBoard) -> GrblBoard:
    """The same board, after the line that makes it a console."""
    since = len(board.output)
    assert board.line("$CONSOLE") == "ok"
    board.expect(CONSOLE, SECONDS, since)
    board.run(0.05)
    return board


def typed(board: Machine, line: str, seconds: float = 0.2) -> str:
    """What the console says to a line."""
    since = len(board.output)
    board.type(line + "\r")
    board.run(seconds)
    return board.output[since:]


@pytest.mark.sample(1)
def test_it_fits_and_the_page_says_how_large_it_is(image: tuple[str, ...]) -> None:
    """Below 120 KiB; of the one with both, the deepest stack of the one fits beside the data of the other."""
    said = make_firmware(*image)
    page = (paths.docs / "firmware.md").read_text(encoding="utf-8")
    sizes = {name: int(size) for name, size in re.findall(r"^(flash|RAM|stack) +(\d+) of", said, re.M)}
    assert sizes["flash"] < CODE
    row = " | " + " | ".join(f"{size:,}" for size in sizes.values()) + " |"
    assert row in page, f"docs/firmware.md: {row}"


def test_it_says_what_it_is(image: tuple[str, ...], board: GrblBoard) -> None:
    """The chip that was found, and what is left out."""
    chip = f"STM32F103xB{LEFT_OUT[image]}"
    assert board.output == f"\r\n[MSG:Reset by power]\r\n[MSG:{chip}]\r\n\r\n{GREETING}"
    assert f"[OPT:VNM,{LINES[image]},255]" in board.line("$I")
    assert board.line("$CONSOLE") == ("error:3" if image == LARGE_IMAGE else "ok")


@pytest.mark.parametrize("speaks_grbl", [False, True])
def test_small_images_say_what_they_leave_out(speaks_grbl: bool) -> None:
    """On the small chip and on the large one."""
    folder = paths.build / "tests" / f"firmware_small_{speaks_grbl}"
    make_firmware(*(SMALL_IMAGE if speaks_grbl else ()), f"OUT={folder}", str(folder / "passo.elf"))
    for size, name in ((None, "STM32F103x8"), (SIZE, "STM32F103xB")):
        machine = Machine(folder / "passo.elf", None, flash_size=size)
        machine.run(0.2)
        of_grbl = "no jerk, no axes A B C, no tools, no console"
        left_out = of_grbl if speaks_grbl else "no goto, outputs, encoders"
        assert f"{name}: {left_out}" in machine.output


def test_a_chip_that_is_too_small(elf: Path) -> None:
    """It has only a part of the image: a sentence, again after each line, and nothing is sent to the core."""
    with model_engine(PARAMETERS, HZ) as engine:
        machine = Machine(elf, engine, flash_size=SMALL_SIZE)
        machine.run(2.5)
        sentence = "[MSG:This image needs 128 KB of flash, this STM32F103x8 has less: nothing moves]\r\n"
        assert machine.output == "\r\n" + sentence
        machine.type("G0 X1\n")
        machine.run(0.2)
        assert machine.output == 2 * ("\r\n" + sentence)
        assert not machine.wires.frames and not machine.events()["step"].any()
        assert machine.resets == [(0, "power")] and not machine.faults and len(machine.led) > 15


@with_console
def test_one_becomes_the_other(board: GrblBoard) -> None:
    """By a line; what it is outlasts any reset but that of the power. Positions are those of the core."""
    assert board.line("G1 X2 F3000") == "ok"
    board.rest(2)
    as_console(board)
    assert "ok position=160,0,0,0" in typed(board, "position")
    since = len(board.output)
    board.request_reset("pin")
    board.expect(CONSOLE, SECONDS, since)
    since = len(board.output)
    typed(board, "grbl")
    board.expect(GREETING, SECONDS, since)
    assert board.report()["MPos"].startswith("2.000,")
    as_console(board)
    board.restart()
    assert board.line("G1 X0 F3000") == "ok"


@with_console
def test_none_of_them_leaves_a_motion(board: GrblBoard) -> None:
    """Both refuse while something moves."""
    assert board.line("G1 X10 F3000") == "ok"
    board.run(0.1)
    assert board.line("$CONSOLE") == "error:8"
    board.rest(3)
    as_console(board)
    typed(board, "move steps=1000 profile=linear total_time=0.3 ramp_time=0.1", 0.1)
    assert "error: MOVING" in typed(board, "grbl")
    board.run(0.3)
    assert "ok position=1800,0,0,0" in typed(board, "position")


@with_console
def test_the_console_has_what_the_small_one_leaves_out(board: GrblBoard) -> None:
    """Goto, outputs, encoders."""
    as_console(board)
    board.events()
    assert "ok" in typed(board, "output levels=5")
    assert "ok" in typed(board, "goto target=-300 speed=4000 acceleration=40000", 0.4)
    assert "ok position=-300,0,0,0" in typed(board, "position")
    assert "ok counts=0,0,0,0" in typed(board, "encoders")
    assert board.events()["step"].any()


def test_grbl_has_jerk_and_more_axes(board: GrblBoard) -> None:
    """Profile jerk as soon as every axis has one, and not otherwise; four axes move."""
    durations = []
    for jerk in ("0", "20000"):
        for axis in range(4):
            assert board.line(f"$80{axis}={jerk}") == "ok"
        board.events()
        for line in ("G1 X2 Y1 Z0.05 A0.2 F6000", "G1 X0 Y0 Z0 A0"):
            assert board.line(line) == "ok"
        board.rest(10)
        (motion,) = motions(board.events(), axes=4)
        assert [len(motion.steps(axis)[0]) for axis in range(4)] == [320, 160, 40, 160]
        durations.append(motion.clocks)
    assert durations[1] > 1.05 * durations[0]
    assert board.line("$804=1") == "error:3" and board.line("$800=-1") == "error:4"
    board.restart()
    assert "$803=20000.000" in board.line("$$").splitlines()


def test_outputs_at_rest(board: GrblBoard) -> None:
    """As in the image for the small chip."""
    check_outputs_at_rest(board)


def test_a_tool_change(image: tuple[str, ...], board: GrblBoard) -> None:
    """With a table that outlasts a reset; the image with the console refuses its words."""
    if image == BOTH_IMAGE:
        words = "M6", "M61 Q1", "G43", "G43.2 H1", "H1", "G10 L1 P1 Z1", "M62 P0", "$TPW", "$TLR", "$394=1"
        assert [board.line(word) for word in words] == ["error:20"] * 7 + ["error:3"] * 3
        return
    for line in ("G10 L1 P16 Z-2.5", "$394=0.3", "T16 M3"):
        assert board.line(line) == "ok"
    board.run(0.4)
    assert board.line("G10 L1 P17 Z1") == "error:38"
    board.restart()
    assert "[T:16,0.000,0.000,-2.500,0.000,0.000]" in board.line("$#").splitlines()
    for line in ("M3 S500", "G1 X1 F6000", "T16 M6"):
        assert board.line(line).endswith("ok")
    board.type("G43\nG1 Z0 F6000\n")
    board.run(0.2)
    assert "[MSG:Tool change: T16]" in board.output and board.report()["state"] == "Tool"
    assert board.events()["outputs"][-1] == 0
    board.type("~")
    board.run(0.2)
    assert board.report()["MPos"].startswith("1.000,0.000,0.000") and board.events()["outputs"][-1] == 1
    board.run(1)
    assert board.report()["MPos"].startswith("1.000,0.000,-2.500")


JERK = """
clock_hz = 36_000_000
profile = "jerk"
""" + "".join(
    f"""
[[axis]]
name = "{name}"
steps_per_mm = 80
speed = 100
acceleration = 1000
jerk = 30000
"""
    for name in "XY"
)


def test_its_settings_are_those_of_the_file(tmp_path: Path) -> None:
    """Those of a machine with profile jerk: also of the console on the PC."""
    path = tmp_path / "machine.toml"
    path.write_text(f'chip = "{LARGE}"\n{JERK}')
    machine = read_machine(path)
    assert "$801=30000" in settings_lines(machine)
    said: list[str] = []
    with machine_at("model", machine) as engine:
        Grbl(engine, machine, said.append).line(b"$$")
    assert "$800=30000.000\r\n$801=30000.000\r\n" in "".join(said)


def test_settings_are_at_the_end_of_its_flash(board: GrblBoard) -> None:
    """Two pages of two of the chip; the newer one counts."""
    assert board.elf.symbols["settings_pages"] == FLASH + SIZE - SETTINGS
    assert len(board.settings) == SETTINGS
    for value in ("81.000", "82.000", "83.000"):
        assert board.line(f"$100={value}") == "ok"
    board.restart()
    assert "$100=83.000" in board.line("$$").splitlines()
    tags = np.frombuffer(board.settings, np.uint32)[:: SETTINGS // 8]
    assert len(set(tags >> 16)) == 1
    board.flash.worn = frozenset(range((SIZE - SETTINGS) // PAGE, SIZE // PAGE))
    assert board.line("$100=84") == "error:7"
    board.restart()
    assert "$100=83.000" in board.line("$$").splitlines()


def place(board: GrblBoard) -> int:
    """Steps of the first motor since the last call."""
    events = board.events()
    level = events["step"].astype(np.int64) & 1
    rising = np.flatnonzero(np.diff(level, prepend=0) == 1)
    return int((1 - 2 * (events["dir"][rising].astype(np.int64) & 1)).sum())


def test_backlash_is_taken_up(image: tuple[str, ...], elf: Path) -> None:
    """With settings that outlast a reset; the other image, and a core without trackers, refuse it."""
    with model_engine(replace(PARAMETERS, trackers=1), HZ) as engine:
        board = GrblBoard(engine, elf)
        if image == BOTH_IMAGE:
            assert board.line("$160=0.1") == board.line("$810=5000") == "error:3"
            return
        assert board.line("$160=0.1") == board.line("$810=5000") == "ok"
        for line in ("G1 X0.5 F3000", "G1 X0.25", "G4 P0.05"):
            assert board.line(line) == "ok"
        assert place(board) == 20 - 8 and board.report()["MPos"].startswith("0.250,")
        board.restart()
        assert {"$160=0.100", "$810=5000.000"} <= set(board.line("$$").splitlines())
        assert board.report()["MPos"].startswith("0.250,")
        for line in ("G91 G1 X0.25 F3000", "G4 P0.05"):
            assert board.line(line) == "ok"
        assert place(board) == 20 + 8 and board.report()["MPos"].startswith("0.500,")
        assert not board.faults
    with model_engine(PARAMETERS, HZ) as engine:
        board = GrblBoard(engine, elf)
        assert board.line("$162=0.1") == "[MSG:$162: the core has no trackers]\nerror:3"
        assert not board.faults


def test_every_chip_has_an_image() -> None:
    """Of those that a machine file can have."""
    assert set(CHIPS) == set(IMAGE) == set(CHIP_AXES)
