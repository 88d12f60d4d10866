# SPDX-License-Identifier: MIT
"""The controller of cncjs, as published, drives the console and the firmware through its own serial port."""

import contextlib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from passo.machine_file import MachineFile, read_machine

from tests.helpers.cncjs import MISSING, Cncjs
from tests.helpers.grbl_machine import MACHINE
from tests.helpers.grbl_terminals import board_at, console_at

pytestmark = pytest.mark.skipif(bool(MISSING), reason=MISSING)
PATIENCE = 60
TRAVEL = 40  # mm: the probe acts at -10
LINES = 100  # more than the look-ahead and the 120 bytes of cncjs hold
PART = ["G21 G90", *(f"G1 X-{2 + i % 2 * 0.1:g} Y-{i * 0.1:g} F6000" for i in range(LINES)), "M2"]
END = [-2.1, -0.1 * (LINES - 1), 0]
BOARD_HZ = 36_000_000


@contextlib.contextmanager
def cncjs_at(link: Path, patience: float = PATIENCE) -> Iterator[Cncjs]:
    """cncjs has read settings and modes; a machine with homes is unlocked."""
    sender = Cncjs(link, patience)
    try:
        sender.until(lambda: "controller:settings" in sender.last and sender.status.get("activeState"))
        if sender.status["activeState"] == "Alarm":
            sender.command("unlock")
        sender.until(lambda: sender.status["activeState"] == "Idle" and sender.parser)
        yield sender
    finally:
        sender.close()


@pytest.fixture
def machine(tmp_path: Path) -> MachineFile:
    path = tmp_path / "machine.toml"
    path.write_text(MACHINE.replace("travel = 200", f"travel = {TRAVEL}"))
    return read_machine(path)


@pytest.fixture
def sender(tmp_path: Path, machine: MachineFile) -> Iterator[Cncjs]:
    with console_at(tmp_path / "grbl", machine), cncjs_at(tmp_path / "grbl") as made:
        yield made


def stream(sender: Cncjs) -> None:
    """Run the job, paused once in its middle, to its end."""
    sender.command("gcode:load", "part", "\n".join(PART))
    sender.command("gcode:start")
    sender.until(lambda: sender.job.get("received", 0) > LINES // 4)
    sender.command("gcode:pause")
    sender.until_state("Hold")
    sender.until(lambda: sender.status["subState"] == 0)
    held = sender.position
    assert sender.rest() == held != END and sender.status["activeState"] == "Hold"
    sender.command("gcode:resume")
    sender.until(lambda: sender.last["workflow:state"] == ["idle"])
    assert sender.job["received"] == sender.job["sent"] == sender.job["total"] == len(PART) + 1  # its %wait
    assert not any(line.startswith(("error", "ALARM")) for line in sender.lines)
    sender.until_state("Idle")
    assert sender.position == pytest.approx(END, abs=0.01)


@pytest.mark.sample(1)
def test_a_job_with_a_pause(sender: Cncjs) -> None:
    """By counting characters; each line is answered once, and cncjs sees the end by itself."""
    settings = sender.last["controller:settings"][1]
    assert settings["settings"]["$110"] == "12000.000" and len(settings["settings"]) == 49
    assert "$110=12000.000 (X-axis maximum rate, mm/min)" in sender.lines
    assert sender.parser["modal"]["units"] == "G21" and sender.parser["modal"]["wcs"] == "G54"
    stream(sender)


def test_a_job_on_the_firmware(tmp_path: Path, machine: MachineFile) -> None:
    """The same, as fast as the emulated board is."""
    slow = replace(machine, settings=replace(machine.settings, clock_hz=BOARD_HZ))
    with board_at(tmp_path / "board", slow), cncjs_at(tmp_path / "board", 3 * PATIENCE) as sender:
        stream(sender)


def test_a_bad_line_stops_a_job(sender: Cncjs) -> None:
    """cncjs sees which line, and what is wrong with it."""
    sender.command("gcode:load", "part", "G0 X-1\nG1 X-2 F600\nG1 Y1 Y2\nG0 X-3")
    sender.command("gcode:start")
    sender.until_said("error:25")
    sender.until(lambda: sender.last["workflow:state"] == ["paused"])
    assert [line for line in sender.lines if line.endswith("(ln=3)")]


def test_jogs_and_overrides(sender: Cncjs) -> None:
    """A jog is canceled; real-time bytes come as cncjs encodes them, in UTF-8."""
    sender.send("$J=G91 X-90 F1200")
    sender.until_state("Jog")
    sender.command("feedOverride", -10)
    sender.command("spindleOverride", 10)
    sender.until(lambda: sender.status.get("ov") == [90, 100, 110])
    sender.command("jogCancel")
    sender.until_state("Idle")
    there = sender.position
    assert -90 < there[0] < 0
    sender.send("$J=G91 X1 F1200", "G4 P0")
    sender.until(lambda: sender.position[0] == pytest.approx(there[0] + 1, abs=0.02))


def test_a_height_map(sender: Cncjs) -> None:
    """cncjs probes a grid, and keeps the heights of all its points."""
    grid = {"startX": -4, "endX": 0, "stepX": 4, "startY": -4, "endY": 0, "stepY": 4, "feedrate": 1200}
    sender.command("autolevel:start", {**grid, "clearanceZ": -8, "startZ": -9, "endZ": -15})
    sender.until(lambda: "autolevel:complete" in sender.last)
    update = sender.last["autolevel:update"][0]
    assert update["current"] == update["total"] == 4
    assert update["minZ"] == pytest.approx(-10, abs=0.1) and update["maxZ"] == pytest.approx(-10, abs=0.1)


def test_tool_length(sender: Cncjs) -> None:
    """As its tool change does it: probe, wait, take the length from the position, and read the parameters.

    cncjs knows the position as last reported, four times a second; on a busy machine the dwell of its
    `%wait` may pass between two reports.
    """
    sender.send("G91 G38.2 Z-15 F600", "G90", "%wait")
    sender.until_said("[PRB:")
    sender.rest()
    sender.send("G43.1 Z[posz + 1.5]", "$#")
    told = sender.until_said("[TLO:")
    length = float(told[5:-1])
    sender.until(lambda: sender.position[2] + 1.5 == pytest.approx(length))
    assert -11 < sender.position[2] < -10
    assert sender.until_said("[PRB:").endswith(":1]")
    sender.until(lambda: float(sender.status["wpos"]["z"]) == pytest.approx(-1.5, abs=0.01))


def test_a_reset_in_motion(sender: Cncjs) -> None:
    """An alarm, which cncjs explains and unlocks; the position is kept."""
    sender.send("G1 X-90 F1200")
    sender.until_state("Run")
    sender.command("reset")
    sender.until_said("ALARM:3 (Abort during cycle")
    sender.until_state("Alarm")
    there = sender.rest()
    sender.command("unlock")
    sender.until_state("Idle")
    assert sender.position == there and -90 < there[0] < 0
    assert sender.last["controller:settings"][1]["version"] == "1.1h"  # of the greeting


def test_homing_and_sleep(sender: Cncjs) -> None:
    """`$H` ends where the switches are; `$SLP` ends with a reset."""
    sender.command("homing")
    sender.until_state("Home")
    sender.until_state("Idle")
    assert sender.position == pytest.approx([-1, -1, -1], abs=0.1)
    sender.command("sleep")
    sender.until_state("Sleep")
    sender.command("reset")
    sender.until_state("Alarm")
