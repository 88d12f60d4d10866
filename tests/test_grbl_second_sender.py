# SPDX-License-Identifier: MIT
"""Another sender, pygrbl-streamer, at the pseudo-terminal of a console with homes and a probe."""

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from passo.grbl import Grbl
from passo.machine_file import read_machine
from pygrbl_streamer import GrblStreamer

from tests.helpers.grbl_machine import MACHINE
from tests.helpers.grbl_terminals import console_at

PATIENCE = 60  # seconds
PART = ["G21 G90", *(f"G1 X-{2 + i % 2 * 0.1:g} Y-{i * 0.1:g} F6000" for i in range(60)), "G4 P0.1", "M30"]


class Sender(GrblStreamer):
    """Keeps all answers; it asks for the state at the ends of jobs only."""

    def __init__(self, port: str):
        super().__init__(port)
        self.told: list[str] = []

    def receive_callback(self, data: str) -> None:
        self.told.append(data.strip())

    def progress_callback(self, percent: int, command: str) -> None:
        """Nothing is printed."""

    def log_callback(self, level: str, message: str) -> None:
        """Nothing is printed."""


@pytest.fixture
def connected(tmp_path: Path) -> Iterator[tuple[Sender, Grbl]]:
    """Connected, and unlocked."""
    link, path = tmp_path / "grbl", tmp_path / "machine.toml"
    path.write_text(MACHINE)
    with console_at(link, read_machine(path)) as grbl:
        sender = Sender(str(link))
        try:
            sender.connect(status_timeout=PATIENCE)
            assert sender.command("$X", timeout=PATIENCE)
            yield sender, grbl
        finally:
            sender.disconnect()


def until(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_a_job_with_a_pause(connected: tuple[Sender, Grbl]) -> None:
    """By counting characters; every line is answered, and the end is exact."""
    sender, grbl = connected
    done: list[bool] = []
    job = threading.Thread(target=lambda: done.append(sender.stream(PART, ack_timeout=PATIENCE)))
    job.start()
    until(lambda: grbl.player.chords > 10)
    sender.pause()
    until(lambda: bool(grbl.c.held) and not grbl.player.feed.driver.snapshot().rate)
    there = grbl.engine.clock
    until(lambda: grbl.engine.clock > there + 400_000)
    sender.resume()
    job.join(PATIENCE)
    assert (
        done == [True] and "[MSG:Pgm End]" in sender.told and not any("error" in line for line in sender.told)
    )
    until(lambda: grbl.is_idle)


def test_probe_tool_length_jog_and_reset(connected: tuple[Sender, Grbl]) -> None:
    """What a height map and a panel of buttons do."""
    sender, grbl = connected
    assert sender.command("G38.2 Z-60 F3000", timeout=PATIENCE)
    until(lambda: sender.told[-1] == "ok" and sender.told[-2].startswith("[PRB"))
    assert sender.told[-2].startswith("[PRB:0.000,0.000,-50.0") and sender.told[-2].endswith(":1]")
    assert sender.command("G43.1 Z-1.5", timeout=PATIENCE) and sender.command("$#", timeout=PATIENCE)
    until(lambda: "[TLO:-1.500]" in sender.told)  # an answer of before may have been taken for its own
    assert sender.command("$J=G91 X-100 F6000", timeout=PATIENCE)
    until(lambda: grbl.player.feed.is_moving)
    sender.realtime(b"\x85")
    assert sender.command("G4 P0", timeout=PATIENCE) and grbl.is_idle
    assert sender.reset() and sender.command("G0 X-1", timeout=PATIENCE)
