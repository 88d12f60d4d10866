# SPDX-License-Identifier: MIT
"""A sender that others wrote, grbl-streamer, drives the console through a pseudo-terminal, in real time."""

import logging
import os
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from grbl_streamer import GrblStreamer
from passo.grbl import Grbl, pseudo_terminal, serve
from passo.machine_file import read_machine
from passo.part import play_part, read_part
from passo.run import open_engine, parameters_for
from passo.toolchain import paths

MACHINE = read_machine(paths.examples / "gcode" / "machine.toml")
PATIENCE = 30  # seconds
# More than the 128 bytes of the receive buffer and the 48 lines of the look-ahead: both senders have to wait.
PART = [
    *("G21 G90 G17", "G0 X2 Y0"),
    *(f"G1 X{2 + i % 2 * 0.5:g} Y{i * 0.1:g} F3000" for i in range(80)),
    *("G2 Y5.9 J-1", "M2"),
]


class Sender:
    """The sender and what it has been told."""

    def __init__(self, link: Path) -> None:
        logging.getLogger("GrblStreamer").setLevel(logging.CRITICAL)
        self.events: Counter[str] = Counter()
        self.last: dict[str, tuple[Any, ...]] = {}
        self.grbl = GrblStreamer(self._told)
        self.grbl.cnect(str(link), 115200)

    def _told(self, event: str, *data: Any) -> None:
        self.events[event] += 1
        self.last[event] = data

    def wait(self, event: str) -> tuple[Any, ...]:
        """Wait for an event; return what came with it."""
        self.until(lambda: self.events[event])
        return self.last[event]

    def start(self, lines: list[str], incremental: bool = False) -> None:
        """Run a job."""
        self.events.clear()
        self.grbl.job_new()
        self.grbl.incremental_streaming = incremental
        self.grbl.write("\n".join(lines))
        self.grbl.job_run()

    def finish(self) -> None:
        """Wait for the end of the job and of its motion."""
        self.wait("on_job_completed")
        self.grbl.cmode = None  # of the last report, perhaps before the job
        self.wait_for_state("Idle")

    def until(self, condition: Callable[[], object]) -> None:
        """Wait for a condition."""
        end = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < end, (self.grbl.cmode, self.events, self.last)
            time.sleep(0.01)

    def wait_for_state(self, state: str) -> None:
        """Wait for a report with this state."""
        self.until(lambda: self.grbl.cmode == state)


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
            sender.grbl.softreset()
            sender.wait("on_boot")
            sender.grbl.poll_interval = 0.05
            sender.grbl.poll_start()
            first = ("on_settings_downloaded", "on_hash_stateupdate", "on_gcode_parser_stateupdate")
            for event in first:
                sender.wait(event)
            # $# is an error in motion, for the sender too; it may have seen two greetings
            time.sleep(0.3)
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
    path = tmp_path / "part.nc"
    path.write_text("\n".join(PART) + "\n")
    with open_engine("model", parameters_for(3), MACHINE.clock_hz) as engine:
        played = play_part(read_part(path, MACHINE), MACHINE, engine)
    scales = [axis.steps_per_mm for axis in MACHINE.settings.axes]
    wanted = [count / float(scale) for count, scale in zip(played.end, scales, strict=True)]
    assert list(sender.grbl.cmpos) == pytest.approx(wanted, abs=5e-4)


def test_hold_and_resume(connected: tuple[Sender, Grbl]) -> None:
    """In the middle of a job, which then goes on to its end."""
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
    """The sender is told which, and halts."""
    sender, _ = connected
    sender.start(["G0 X1", "G1 X2 F600", "G1 Y1 Y2", "G0 X30"], incremental=True)
    text, command, number = sender.wait("on_error")
    assert text == "error:25" and command == "G01Y1Y2" and number == 3
    time.sleep(0.5)
    assert sender.grbl.cmpos[0] <= 2
