# SPDX-License-Identifier: MIT
"""A sender that others wrote, grbl-streamer, drives the console through a pseudo-terminal, in real time.

And the firmware: the binary in the emulated STM32F103, as fast as that is.
"""

import contextlib
import os
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from passo.engine import model_engine
from passo.grbl import Grbl, pseudo_terminal, serve
from passo.grbl_setup import core_for
from passo.machine_file import MachineFile, read_machine
from passo.part import play_part, read_part
from passo.run import open_engine, parameters_for
from passo.toolchain import paths
from passo_stm32.grbl_board import GrblBoard, grbl_elf

from tests.helpers.sender import Sender

MACHINE = read_machine(paths.examples / "gcode" / "machine.toml")
BOARD = replace(MACHINE, settings=replace(MACHINE.settings, clock_hz=36_000_000))
# More than the 128 bytes of the receive buffer and the 48 lines of the look-ahead: both senders have to wait.
PART = [
    *("G21 G90 G17", "G0 X2 Y0"),
    *(f"G1 X{2 + i % 2 * 0.1:g} Y{i * 0.1:g} F3000" for i in range(80)),
    *("G2 Y5.9 J-1", "M2"),
]


@pytest.fixture
def connected(tmp_path: Path) -> Iterator[tuple[Sender, Grbl]]:
    """The console in a thread, the sender at its pseudo-terminal, booted."""
    link, over = tmp_path / "grbl", threading.Event()
    engine = open_engine("model", parameters_for(3), MACHINE.clock_hz)
    with pseudo_terminal(link) as ours:
        grbl = Grbl(engine, MACHINE, lambda text: os.write(ours, text.encode()))
        thread = threading.Thread(target=serve, args=(grbl, ours, over.is_set))
        thread.start()
        sender = Sender(link)
        try:
            sender.boot()
            yield sender, grbl
        finally:
            sender.grbl.disconnect()
            over.set()
            thread.join()
    engine.close()


@pytest.mark.parametrize("incremental", [True, False], ids=["a line per ok", "counting characters"])
def test_a_job(connected: tuple[Sender, Grbl], tmp_path: Path, incremental: bool) -> None:
    """Each line is sent once, none with an error; the end is that of `passo run`."""
    sender, _ = connected
    sender.start(PART, incremental)
    sender.finish()
    assert sender.events["on_error"] == sender.events["on_alarm"] == 0
    assert sender.events["on_line_sent"] == len(sender.grbl.buffer) <= sender.events["on_processed_command"]
    assert list(sender.grbl.cmpos) == pytest.approx(end_of(PART, MACHINE, tmp_path), abs=5e-4)


def serve_board(elf: Path, terminal: int, until: Callable[[], bool]) -> None:
    """Connect the serial line of a board to a terminal."""
    os.set_blocking(terminal, False)
    with model_engine(core_for(BOARD), BOARD.clock_hz) as engine:
        board, told = GrblBoard(engine, elf), 0
        while not until():
            with contextlib.suppress(BlockingIOError, OSError):
                board.type(os.read(terminal, 4096).decode("latin-1"))
            board.run(0.002)
            os.write(terminal, board.output[told:].encode("latin-1"))
            told = len(board.output)


@pytest.fixture
def firmware(tmp_path: Path) -> Iterator[Sender]:
    """The sender, with the firmware behind its pseudo-terminal, booted."""
    elf = grbl_elf(paths.build / "tests" / "firmware_grbl", "AXES=3")
    link, over = tmp_path / "board", threading.Event()
    with pseudo_terminal(link) as ours:
        thread = threading.Thread(target=serve_board, args=(elf, ours, over.is_set))
        thread.start()
        sender = Sender(link, patience=120)
        try:
            sender.boot()
            yield sender
        finally:
            sender.grbl.disconnect()
            over.set()
            thread.join()


def end_of(part: list[str], machine: MachineFile, folder: Path) -> list[float]:
    """Where `passo run` ends, in mm."""
    path = folder / "part.nc"
    path.write_text("\n".join(part) + "\n")
    with open_engine("model", parameters_for(3), machine.clock_hz) as engine:
        played = play_part(read_part(path, machine), machine, engine)
    scales = [axis.steps_per_mm for axis in machine.settings.axes]
    return [count / float(scale) for count, scale in zip(played.end, scales, strict=True)]


def test_jobs_of_the_firmware(firmware: Sender, tmp_path: Path) -> None:
    """As on the PC, by both protocols; then a hold, and a reset in motion, which keeps the position."""
    for part, incremental in ((PART, False), ([*PART[:12], "M2"], True)):
        firmware.start(part, incremental)
        firmware.finish()
        assert firmware.events["on_error"] == firmware.events["on_alarm"] == 0
        assert list(firmware.grbl.cmpos) == pytest.approx(end_of(part, BOARD, tmp_path), abs=5e-4)
    firmware.start(["G0 X0 Y0", "G1 X20 F1200", "X0"])
    firmware.until(lambda: firmware.grbl.cmpos[0] > 0)
    firmware.grbl.hold()
    firmware.wait_for_state("Hold:0")
    firmware.grbl.resume()
    firmware.wait_for_state("Run")
    firmware.grbl.softreset()
    firmware.wait("on_boot")
    firmware.wait_for_state("Alarm")
    there = firmware.grbl.cmpos
    assert there[0] > 0
    firmware.grbl.killalarm()
    firmware.wait_for_state("Idle")
    assert firmware.grbl.cmpos == there


def test_hold_and_resume(connected: tuple[Sender, Grbl]) -> None:
    """In the middle of a job, which then runs to its end."""
    sender, _ = connected
    sender.start(["G0 X0 Y0", "G1 X20 F1200", "X0"])
    sender.until(lambda: sender.grbl.cmpos[0] > 0)
    sender.grbl.hold()
    sender.wait_for_state("Hold:0")
    held = sender.grbl.cmpos
    assert 0 < held[0] < 20
    time.sleep(0.2)
    assert sender.grbl.cmpos == held
    sender.grbl.resume()
    sender.wait_for_state("Run")
    sender.finish()
    assert sender.grbl.cmpos == (0, 0, 0) and not sender.events["on_error"]


def test_a_reset_in_motion(connected: tuple[Sender, Grbl]) -> None:
    """An alarm, which the sender unlocks; the next job begins where the motion was stopped."""
    sender, _ = connected
    sender.start(["G0 X0 Y0", "G1 X20 F1200", "X0"])
    sender.wait_for_state("Run")
    time.sleep(0.1)
    sender.grbl.softreset()
    sender.wait("on_boot")
    sender.wait_for_state("Alarm")
    there = sender.grbl.cmpos
    assert 0 < there[0] < 20
    sender.grbl.killalarm()
    sender.wait_for_state("Idle")
    sender.start(["G91", "G1 X1 F1200", "G90"])
    sender.finish()
    assert sender.grbl.cmpos[0] == pytest.approx(there[0] + 1, abs=0.013)


def test_a_bad_line(connected: tuple[Sender, Grbl]) -> None:
    """The sender gets its number, and halts."""
    sender, _ = connected
    sender.start(["G0 X1", "G1 X2 F600", "G1 Y1 Y2", "G0 X30"], incremental=True)
    text, command, number = sender.wait("on_error")
    assert text == "error:25" and command == "G01Y1Y2" and number == 3
    time.sleep(0.5)
    assert sender.grbl.cmpos[0] <= 2
