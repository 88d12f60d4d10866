# SPDX-License-Identifier: MIT
"""A sender that others wrote, grbl-streamer, drives the console through a pseudo-terminal, in real time.

And the firmware: the binary in the emulated STM32F103, as fast as that is.
"""

import contextlib
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from passo.machine_file import MachineFile, read_machine
from passo.part import play_part, read_part
from passo.run import open_engine, parameters_for
from passo.toolchain import paths

from tests.helpers.grbl_terminals import board_at, console_at
from tests.helpers.sender import PATIENCE, Sender

MACHINE = read_machine(paths.examples / "gcode" / "machine.toml")
BOARD = replace(MACHINE, settings=replace(MACHINE.settings, clock_hz=36_000_000))
# More than the 128 bytes of the receive buffer and the 48 lines of the look-ahead: both senders have to wait.
PART = [
    *("G21 G90 G17", "G0 X2 Y0"),
    *(f"G1 X{2 + i % 2 * 0.1:g} Y{i * 0.1:g} F3000" for i in range(80)),
    *("G2 Y5.9 J-1", "M2"),
]


@pytest.fixture
def connected(tmp_path: Path) -> Iterator[Sender]:
    """The sender at a console, booted."""
    with console_at(tmp_path / "grbl", MACHINE), booted(tmp_path / "grbl") as sender:
        yield sender


@pytest.fixture
def firmware(tmp_path: Path) -> Iterator[Sender]:
    """The sender at the firmware, booted."""
    with board_at(tmp_path / "board", BOARD), booted(tmp_path / "board", 120) as sender:
        yield sender


@contextlib.contextmanager
def booted(link: Path, patience: float = PATIENCE) -> Iterator[Sender]:
    """The sender; the controller behind the terminal has been reset."""
    sender = Sender(link, patience)
    try:
        sender.boot()
        yield sender
    finally:
        sender.grbl.disconnect()


def test_a_machine_of_two_axes(tmp_path: Path) -> None:
    """Reports have Z, which it expects of every controller."""
    machine = read_machine(paths.examples / "machines" / "laser.toml")
    with console_at(tmp_path / "grbl", machine), booted(tmp_path / "grbl") as sender:
        sender.start(["$X", "G21 G91", "G1 X1 Y2 F6000", "M2"])
        sender.finish()
        assert sender.grbl.cmpos == (1, 2, 0) and sender.events["on_error"] == 0


@pytest.mark.parametrize("incremental", [True, False], ids=["a line per ok", "counting characters"])
def test_a_job(connected: Sender, tmp_path: Path, incremental: bool) -> None:
    """Each line is sent once, none with an error; the end is that of `passo run`."""
    sender = connected
    sender.start(PART, incremental)
    sender.finish()
    assert sender.events["on_error"] == sender.events["on_alarm"] == 0
    assert sender.events["on_line_sent"] == len(sender.grbl.buffer) <= sender.events["on_processed_command"]
    assert list(sender.grbl.cmpos) == pytest.approx(end_of(PART, MACHINE, tmp_path), abs=5e-4)


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


@pytest.mark.sample(1)
def test_hold_and_resume(connected: Sender) -> None:
    """In the middle of a job, which then runs to its end."""
    sender = connected
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


def test_a_reset_in_motion(connected: Sender) -> None:
    """An alarm, which the sender unlocks; the next job begins where the motion was stopped."""
    sender = connected
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


def test_a_bad_line(connected: Sender) -> None:
    """The sender gets its number, and halts."""
    sender = connected
    sender.start(["G0 X1", "G1 X2 F600", "G1 Y1 Y2", "G0 X30"], incremental=True)
    text, command, number = sender.wait("on_error")
    assert text == "error:25" and command == "G01Y1Y2" and number == 3
    time.sleep(0.5)
    assert sender.grbl.cmpos[0] <= 2
