# SPDX-License-Identifier: MIT
"""Backlash in the grbl console: its settings, and what homes, probes, stops and limits do beside a take-up.

Positions are those of the path; each motor is there, or lower by its backlash while the last line went down.
PASSO_SEED is the seed of the histories.
"""

import random
import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from passo.grbl_setup import SettingsFile, machine_at
from passo.machine_file import MachineFile, read_machine
from passo.make_command import settings_lines
from passo.part import core_of, play_part, read_part
from passo.run import open_engine

from tests.helpers.grbl_console import GrblConsole, watch
from tests.helpers.random_plans import SEED
from tests.test_grbl_home import AXIS

PLAY = 8  # steps of backlash of X, Y and Z
SCALE = 80  # steps per mm
TRAVEL = 20  # mm
MIDDLE = TRAVEL * SCALE // 2  # steps, where axes are at first
SLOW = 16  # mm/s^2: a take-up of 0.1 mm takes 0.16 s
FAST = 20_000
HEAD = "clock_hz = 4_000_000\nprobe = true\n[home]\nseek = 40\nspeed = 10\n"
BACKLASH = "backlash = 0.1\ntake_up = {take_up}\n"
BOUND = re.compile(r"\[MSG:With backlash \$(\d+) is at (?:most|least) ([\d.]+)\]\nerror:12")
PATIENCE = 60  # simulated seconds


def machine_of(
    folder: Path, backlash: str = BACKLASH.format(take_up=FAST), head: str = HEAD, switches: str = ""
) -> MachineFile:
    """X homes low and Y high by limits, Z high by its home switch; or all by `switches`."""
    path = folder / "machine.toml"
    axes = (
        ("X", "low", '["limit_low", "limit_high"]'),
        ("Y", "high", '["limit_high"]'),
        ("Z", "high", '["home"]'),
    )
    path.write_text(
        head + "".join(AXIS.format(name=n, home=h, switches=switches or s) + backlash for n, h, s in axes)
    )
    return read_machine(path, takes_up=True)


class Session(GrblConsole):
    """A console with a machine, and what has left its pins."""

    def __init__(self, engine: Any, machine: MachineFile, *settings: Any):
        self.drained: list[np.ndarray] = []
        drain = engine.drain

        def record() -> np.ndarray:
            self.drained.append(drain())
            return self.drained[-1]

        engine.drain = record
        super().__init__(engine, machine, *settings)

    @property
    def driver(self) -> Any:
        return self.grbl.player.feed.driver

    def places(self) -> list[np.ndarray]:
        """Of each motor, after each of its steps."""
        self.engine.drain()
        events = np.concatenate(self.drained)
        made = []
        for axis in range(3):
            level = (events["step"] >> axis & 1).astype(np.int64)
            rises = np.diff(np.concatenate([[0], level])) == 1
            made.append(np.cumsum(1 - 2 * (events["dir"][rises] >> axis & 1).astype(np.int64)))
        return made

    def motors(self) -> list[int]:
        return [int(places[-1]) if len(places) else 0 for places in self.places()]

    def path(self) -> list[int]:
        """Steps that the status report tells."""
        return [round(place * SCALE) for place in self.fields("MPos")]

    def zeros(self, backlash: int = PLAY) -> list[int]:
        """Where the motors are when the path is at 0 and went up; all trackers are where they have to be."""
        readings = [self.driver.tracker(axis) for axis in range(3)]
        assert all(one.enabled and one.at_target and not one.moves for one in readings)
        assert {one.position for one in readings} <= {0, -backlash}
        return [
            motor - reading.position - path
            for motor, reading, path in zip(self.motors(), readings, self.path(), strict=True)
        ]

    def byte(self, code: int) -> None:
        self.grbl.type(bytes([code]))
        self.grbl.poll()

    def settle(self) -> str:
        self.rest()
        self.grbl.poll()
        return self.take()


Opens = Callable[..., Session]


@pytest.fixture
def opens(tmp_path: Path) -> Iterator[Opens]:
    """Sessions of machines, unlocked."""
    with ExitStack() as stack:

        def made(machine: MachineFile | None = None, *settings: Any) -> Session:
            machine = machine or machine_of(tmp_path)
            session = Session(stack.enter_context(machine_at("model", machine)), machine, *settings)
            session.limit(PATIENCE)
            assert session.line("$X").endswith("ok")
            return session

        yield made


def plain_of(folder: Path) -> MachineFile:
    """The same machine, where no axis takes up backlash."""
    return machine_of(folder, "")


def test_values_and_their_bounds(opens: Opens, tmp_path: Path) -> None:
    """What is too much is refused with the most that is not; that is taken."""
    session = opens()
    assert {"$160=0.100", "$162=0.100", "$810=20000.000"} <= set(session.line("$$").splitlines())
    for text, told in (
        ("$160=-1", "error:4"), ("$163=1", "error:3"), ("$160=1000.1", "error:3"),
        ("$810=1000001", "error:3"),
        ("$160=0.001", "[MSG:$160 is 1 to 65535 steps]\nerror:3"),
        ("$161=900", "[MSG:$161 is 1 to 65535 steps]\nerror:3"),
    ):  # fmt: skip
        assert (text, session.line(text)) == (text, told)
    before = session.line("$$")
    most = BOUND.fullmatch(session.line("$0=61"))
    assert most and most[1] == "110"
    assert session.line("$$") == before
    # one step in 62 us: 16129 steps/s; the take-up has sqrt(20000 * 80 * 8), 3578
    for axis in range(3):
        assert session.line(f"$11{axis}=6000") == "ok"
    assert session.line("$0=31") == "ok"
    most = BOUND.fullmatch(session.line("$110=10000"))
    assert most and most[1] == "110" and float(most[2]) == pytest.approx((16129.03 - 3577.7) * 0.75, abs=0.1)
    assert session.line(f"$110={float(most[2]) + 0.001:.3f}").endswith("error:12")
    assert session.line(f"$110={most[2]}") == "ok"
    assert session.line("$29=100") == "ok"  # DIR turns in 262 us: 29,135,000 steps/s^2
    most = BOUND.fullmatch(session.line("$811=500000"))
    assert most and most[1] == "811" and float(most[2]) == pytest.approx(2 / 262e-6**2 / SCALE, abs=0.1)
    assert session.line(f"$811={most[2]}").endswith("ok") or "$111" in session.log
    least = BOUND.fullmatch(session.line("$812=0.000001"))
    assert least and least[1] == "812"
    assert session.line(f"$812={least[2]}") == "ok"
    assert session.line("G1 X1 F100") == "ok" and session.line("$160=0.05") == "error:8"


def test_a_core_without_trackers_refuses_it(opens: Opens, tmp_path: Path) -> None:
    """Backlash is refused, and 0 is not."""
    session = opens(machine_of(tmp_path, ""))
    before = session.line("$$")
    assert session.line("$161=0.1") == "[MSG:$161: the core has no trackers]\nerror:3"
    assert session.line("$161=0") == session.line("$811=500") == session.line("$811=0") == "ok"
    assert session.line("$$") == before
    assert session.line("G0 X1") == "ok"
    session.settle()
    assert session.motors() == [SCALE, 0, 0]


def test_motors_of_two_axes_have_no_backlash(opens: Opens, tmp_path: Path) -> None:
    """X and Y of a CoreXY machine are refused, Z is not."""
    machine = machine_of(tmp_path, "", 'kinematics = "corexy"\n' + HEAD, '["home"]')
    text = machine.path.read_text()
    machine.path.write_text(text + "backlash = 0.1\n")
    session = opens(read_machine(machine.path, takes_up=True))
    for axis in range(2):
        assert session.line(f"$16{axis}=0.1") == f"[MSG:$16{axis}: the axis shares its motors]\nerror:3"
    assert session.line("$162=0.05") == "ok"


def test_settings_outlast_a_loss_of_power(opens: Opens, tmp_path: Path) -> None:
    """The next start takes up what was stored, not what the machine file says."""
    file = tmp_path / "settings"
    first = opens(None, SettingsFile(file))
    assert first.line("$160=0.2") == first.line("$811=4000") == "ok"
    again = opens(None, SettingsFile(file))
    assert {"$160=0.200", "$161=0.100", "$811=4000.000"} <= set(again.line("$$").splitlines())
    again.line("G1 X-1 F600")
    again.settle()
    assert again.motors() == [-SCALE - 2 * PLAY, 0, 0]


def test_a_change_moves_what_is_taken_up(opens: Opens) -> None:
    """Only of an axis whose last line went down; lines wait until then, and start at the same place."""
    session = opens()
    session.line("G1 X-1 Y1 F600")
    session.settle()
    assert session.motors() == [-SCALE - PLAY, SCALE, 0]
    for width, steps in (("0.2", 2 * PLAY), ("0", 0), ("0.15", PLAY * 3 // 2)):
        assert session.line(f"$160={width}") == "ok"
        assert session.line("G4 P0") == "ok"
        assert session.motors() == [-SCALE - steps, SCALE, 0]
        assert session.path() == [-SCALE, SCALE, 0]
    session.line("G1 X-2 F600")
    session.settle()
    assert session.motors()[0] == -2 * SCALE - PLAY * 3 // 2


def test_it_makes_the_steps_of_passo_run(opens: Opens, tmp_path: Path) -> None:
    """Each motor passes the same places in the same order."""
    machine = machine_of(tmp_path)
    part = tmp_path / "part.nc"
    part.write_text("G21 G90 G94 F3000\nG1 X4 Y2\nG1 X1 Y-1\nG3 X1 Y-1 I-2 J0\nG1 X2 Z-1\nG1 X0 Z0\nM2\n")
    session = opens(machine)
    for line in part.read_text().splitlines():
        session.line(line)
    session.settle()
    with open_engine("model", core_of(machine), machine.clock_hz) as core:
        played = play_part(read_part(part, machine), machine, core)
    assert played.problems() == []
    for made, wanted in zip(session.places(), played.positions, strict=True):
        np.testing.assert_array_equal(made, wanted)
    assert [one.position for one in map(session.driver.tracker, range(3))] == list(played.taken_up.values())


def test_the_lines_of_make_set_it(opens: Opens, tmp_path: Path) -> None:
    """In their order none is refused, on a board that has other settings."""
    wanted = machine_of(
        tmp_path, BACKLASH.format(take_up=9000), HEAD.replace("probe", 'chip = "STM32F103CB"\nprobe')
    )
    lines = settings_lines(wanted)
    assert {"$160=0.1", "$162=0.1", "$811=9000"} <= set(lines)
    session = opens()
    assert session.line("$160=0.3") == session.line("$812=0") == "ok"
    assert [session.line(line) for line in lines] == ["ok"] * len(lines)
    assert {"$160=0.100", "$812=9000.000"} <= set(session.line("$$").splitlines())
    small = machine_of(tmp_path, "")
    assert not any(line.startswith(("$16", "$81")) for line in settings_lines(small))


HOMED = "Idle|MPos:-19.000,-1.000,-1.000|"


def homed(session: Session) -> list[int]:
    """Places of the motors after $H."""
    assert session.line("$H").endswith("ok")
    assert session.path() == [-19 * SCALE, -SCALE, -SCALE]
    return session.motors()


@pytest.mark.parametrize("take_up", [FAST, 40])
@pytest.mark.parametrize("places", ["G0 X1", "X-9.9 Y9.9 Z9.9", "X-10.4 Y10.4 Z10.4"])
def test_home_is_where_it_is_without_backlash(
    opens: Opens, tmp_path: Path, take_up: int, places: str
) -> None:
    """Wherever it begins: the edge is the same place of the table.

    X approaches its switch downward, so its screw is lower there by the play; Y and Z leave theirs downward.
    """
    ends = []
    for machine in (plain_of(tmp_path), machine_of(tmp_path, BACKLASH.format(take_up=take_up))):
        session = opens(machine)
        if not places.startswith("G0"):
            assert session.line("$21=0") == "ok"
        for word in places.removeprefix("G0 ").split():
            session.line(f"G1 {word} F1500")
        session.settle()
        session.line("$21=1")
        ends.append(homed(session))
        session.line("G53 G0 X-10 Y-10 Z-10")
        session.settle()
        ends.append(session.motors())
    (plain, before), (taken, after) = ends[:2], ends[2:]
    assert np.subtract(taken, plain).tolist() == pytest.approx([PLAY, -PLAY, -PLAY], abs=1)
    assert np.subtract(after, before).tolist() == pytest.approx([PLAY, -PLAY, -PLAY], abs=1)


def test_home_ends_at_the_same_place_again(opens: Opens, tmp_path: Path) -> None:
    """The edge comes at any moment of a slow take-up."""
    rng = random.Random(f"homes {SEED}")
    session = opens(machine_of(tmp_path, BACKLASH.format(take_up=40)))
    first = homed(session)
    for _ in range(5):
        session.line("G53 G0 X-18 Y-3 Z-3")
        near = rng.uniform(0.02, 0.6)
        session.line(f"G53 G1 X{near - 20:.3f} Y{-near:.3f} Z{-near:.3f} F3000")
        session.line(f"G53 G1 X{near - 19.9:.3f} Y{-near - 0.1:.3f} Z{-near - 0.1:.3f} F3000")
        session.settle()
        assert homed(session) == pytest.approx(first, abs=1), near
    assert "ALARM" not in session.log


def test_probe_tells_the_place_of_the_path(opens: Opens, tmp_path: Path) -> None:
    """Z comes down on the plate with its backlash taken up: the path is higher than the motor by that."""
    touched = []
    for machine in (plain_of(tmp_path), machine_of(tmp_path)):
        session = opens(machine)
        said = session.line("G38.2 Z-9 F300")
        (z,) = re.findall(r"\[PRB:[^,]*,[^,]*,([^:]*):1\]", said)
        touched.append(float(z) * SCALE)
        session.settle()
        session.line("G0 Z0")
        session.settle()
        assert session.motors() == [0, 0, 0]
    assert touched[1] - touched[0] == pytest.approx(PLAY, abs=1.01)


def jog(rng: random.Random) -> str:
    return f"$J=G91 {rng.choice('XYZ')}{rng.choice('-+')}{rng.randint(1, 30) / 20} F{rng.randint(200, 3000)}"


def test_whatever_interrupts_a_take_up_no_step_is_lost(opens: Opens, tmp_path: Path) -> None:
    """Canceled jogs, holds, resets: motors, trackers and path agree at rest; home is where it was."""
    rng = random.Random(f"backlash {SEED}")
    session = opens(machine_of(tmp_path, BACKLASH.format(take_up=SLOW)))
    home = homed(session)
    session.line("G0 X-10 Y-10 Z-10")
    session.settle()
    zeros = session.zeros()
    for what in ("cancel", "hold", "reset") * 5:
        session.grbl.type(f"{jog(rng) if what != 'reset' else 'G91 G1 X-0.5 Z0.5 F600'}\n".encode())
        session.run(rng.uniform(0, 0.2))
        if what == "cancel":
            session.byte(0x85)
        elif what == "hold":
            session.byte(ord("!"))
            session.run(rng.uniform(0, 0.2))
            session.byte(ord("~"))
        elif what == "reset":
            session.byte(0x18)
        session.rest()
        session.line("$X")
        assert session.zeros() == zeros, what
        target = [rng.randint(-13, -7) for _ in range(3)]
        session.line("G90 G0 X{} Y{} Z{}".format(*target))
        session.settle()
        assert session.path() == [place * SCALE for place in target], what
        assert session.zeros() == zeros, what
    assert homed(session) == pytest.approx(home, abs=1)
    assert "error:9" not in session.log and "ALARM:1" not in session.log


def test_an_estop_in_a_take_up(opens: Opens, tmp_path: Path) -> None:
    """It drops up to seven steps of a tracker; what follows agrees with what left the pins."""
    session = opens(machine_of(tmp_path, BACKLASH.format(take_up=SLOW)))
    session.line("G1 X-2 F1200")
    session.run(0.1)
    session.engine.set("estop_n", 0)
    session.run(0.1)
    assert "ALARM:3" in session.log
    session.engine.set("estop_n", 1)
    session.settle()
    assert session.line("$X").endswith("ok")
    zeros = session.zeros()
    assert abs(zeros[0]) <= 7
    for line in ("G91 G1 X1 F600", "G1 X-1", "G1 X-1"):
        assert session.line(line) == "ok"
        session.settle()
        assert session.zeros() == zeros


@pytest.mark.parametrize(("axis", "way", "end"), [("X", -1, "low"), ("X", 1, "high"), ("Y", 1, "high")])
def test_a_limit_in_a_take_up(opens: Opens, tmp_path: Path, axis: str, way: int, end: str) -> None:
    """No step toward the switch; off it all is as before, and the take-up of the other way is made."""
    session = opens(machine_of(tmp_path, BACKLASH.format(take_up=SLOW)))
    zeros, number = session.zeros(), "XYZ".index(axis)
    near = way * (TRAVEL / 2 - 0.5)
    session.line(f"G1 {axis}{near} F3000")
    session.line(f"G1 {axis}{near - way} F3000")
    session.settle()
    session.line(f"G1 {axis}{near + 2 * way} F6000")
    assert session.grbl.wait(lambda: "ALARM:1" in session.log)
    path = session.driver.positions()[number]
    session.settle()
    assert session.driver.positions()[number] == pytest.approx(path, abs=1)  # no step counts that is not made
    switch = MIDDLE * way
    stopped = session.motors()[number]
    assert 0 <= (stopped - switch) * way < 2.5 * SCALE
    session.run(1)
    assert (session.motors()[number] - stopped) * way <= 0
    assert session.line("$X").endswith("ok")
    assert session.line(f"$J=G91 {axis}{-4 * way} F3000") == "ok"
    session.settle()
    assert session.zeros() == zeros
    assert session.log.count("ALARM") == 1
    for target in (0, near - way, 0):
        session.line(f"G1 {axis}{target} F3000")
        session.settle()
        assert session.zeros() == zeros
    assert session.motors()[number] == zeros[number] - (PLAY if way > 0 else 0)


def test_another_motion_at_the_limit_leaves_the_axis_there(opens: Opens, tmp_path: Path) -> None:
    """X stays at its switch without a step while Y moves, and takes up its backlash when it comes back."""
    session = opens(machine_of(tmp_path, BACKLASH.format(take_up=SLOW)))
    zeros = session.zeros()
    session.line("G1 X-9.5 F3000")
    session.line("G1 X-9 F3000")
    session.settle()
    session.line("G1 X-12 F6000")
    session.settle()
    assert "ALARM:1" in session.log and session.line("$X").endswith("ok")
    at = session.motors()[0]
    for target in (2, -1):
        assert session.line(f"G1 Y{target} F3000") == "ok"
        session.settle()
        assert session.motors()[0] == at
    assert session.line("G1 X-5 F3000") == "ok"
    session.settle()
    assert session.line("G1 X-6") == "ok"
    session.settle()
    assert session.zeros() == zeros and session.driver.tracker(0).position == -PLAY


@pytest.mark.parametrize("line", ["M3 S500", "M64 P0", "M66 P1", "M5\nM3 S500"])
def test_what_begins_at_rest_waits_for_a_take_up(opens: Opens, tmp_path: Path, line: str) -> None:
    """It is not lost behind the last step of the path, while a motor takes up its backlash slowly."""
    head = "spindle_maximum = 1000\n" + HEAD
    session = opens(machine_of(tmp_path, BACKLASH.format(take_up=SLOW), head))
    levels = watch(session.engine, "outputs")
    session.line("$X")
    session.line("G0 X1")
    session.rest()
    answered = len(session.answers)
    session.send(f"G0 X0.95\n{line}\nG0 Y1\n".encode(), 1)
    session.finish()
    assert set(session.answers[answered:]) == {"ok"} and session.fields("MPos")[:2] == [0.95, 1]
    assert bool(levels()) == ("M66" not in line)
