# SPDX-License-Identifier: MIT
"""Home of the grbl console, on a simulated machine."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from passo.grbl_setup import machine_at
from passo.machine_file import MachineFile, read_machine

from tests.helpers.grbl_console import GrblConsole

AXIS = """
[[axis]]
name = "{name}"
steps_per_mm = 80
speed = 100
acceleration = 1000
travel = 20
home = "{home}"
switches = {switches}
"""
HEAD = "clock_hz = 4_000_000\nprobe = true\nspindle_maximum = 1000\n[home]\nseek = 40\nspeed = 10\n"


def machine_of(
    folder: Path, head: str = HEAD, switches: str = '["home", "limit_low", "limit_high"]'
) -> MachineFile:
    path = folder / "machine.toml"
    axes = (("X", "low", switches), ("Y", "high", '["limit_high"]'), ("Z", "high", '["home"]'))
    path.write_text(head + "".join(AXIS.format(name=n, home=h, switches=s) for n, h, s in axes))
    return read_machine(path)


class Session(GrblConsole):
    """A console with a machine."""

    def line(self, text: str) -> str:
        self.take()
        return super().line(text)

    def byte(self, code: int) -> None:
        self.grbl.type(bytes([code]))
        self.grbl.poll()

    def run(self, seconds: float) -> None:
        self.grbl.wait(lambda: False, seconds)

    def settle(self) -> str:
        self.take()
        super().rest()
        self.grbl.poll()
        return self.take()

    def report(self) -> str:
        return re.findall(r"<(.*)>", self.line("?"))[0]


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    machine = machine_of(tmp_path)
    with machine_at("model", machine) as engine:
        yield Session(engine, machine)


def test_home(session: Session) -> None:
    """Locked until then; positions are those of the ends less the pull-off."""
    assert "to unlock]" in session.take()
    assert session.report().startswith("Alarm") and session.line("G0 X1") == "error:9"
    session.grbl.type(b"$H\n")
    session.run(0.1)
    assert session.report().startswith("Home|")
    assert session.grbl.wait(lambda: session.grbl.is_idle, 60) and "ok" in session.take()
    assert session.report().startswith("Idle|MPos:-19.000,-1.000,-1.000|")
    assert session.line("$20=1") == "ok" and session.line("$J=X1F100") == "error:15"
    assert session.line("G0 X-19 Y-2") == "ok"
    assert session.line("G0 X0.5").splitlines() == ["ALARM:2", "error:9"]


@pytest.mark.parametrize("home", ["low", "high"])
@pytest.mark.parametrize("home_switch", ["", '"home", '])
def test_limits_are_at_their_ends(tmp_path: Path, home: str, home_switch: str) -> None:
    """Whichever of them the axis homes at."""
    switches = f'[{home_switch}"limit_low", "limit_high"]'
    path = tmp_path / "machine.toml"
    path.write_text(HEAD + "[switches]\nstop = true\n" + AXIS.format(name="X", home=home, switches=switches))
    machine = read_machine(path)
    with machine_at("model", machine) as engine:
        session = Session(engine, machine)
        assert session.line("$H") == "ok"
        for target, low, high in ((-40, -27, -20), (20, 0, 7)):
            assert session.line(f"G53 G0 X{target}") == "ok"
            assert "ALARM:1" in session.settle() and low < session.fields("MPos")[0] < high
            session.line("$X")


@pytest.mark.parametrize("code", [0x85, 0x21, 0x84])
def test_a_limit_on_the_way_to_rest_is_an_alarm(tmp_path: Path, code: int) -> None:
    """The jog was canceled just before its limit. None follows on the way off the switch, or away from it."""
    machine = machine_of(tmp_path, HEAD + "[switches]\nstop = true\n", '["limit_low", "limit_high"]')
    with machine_at("model", machine) as engine:
        session = Session(engine, machine)
        assert session.line("$H") == "ok"
        session.line("G53 G0 X-5")
        session.rest()
        session.line("$J=G91 X-50 F6000")
        assert session.grbl.wait(lambda: session.fields("MPos")[0] < -19, 2)
        session.byte(code)
        session.run(0.5)
        assert -26 < session.fields("MPos")[0] < -20 and session.report().startswith("Alarm")
        assert session.log.count("ALARM:1") == 1 and session.line("G0 X0") == "error:9"
        session.line("$X")
        for way in "1.5", "20":
            session.line(f"$J=G91 X{way} F600")
            session.run(0.1)
            session.byte(0x85)
            session.run(0.3)
            assert session.report().startswith("Idle")
        assert session.log.count("ALARM") == 1


def test_an_alarm_of_a_drive_on_the_way_to_rest_is_an_alarm(tmp_path: Path) -> None:
    """Alarm 3, once, and it is no limit."""
    machine = machine_of(tmp_path)
    with machine_at("model", machine) as engine:
        session = Session(engine, machine)
        session.line("$X")
        session.line("$J=G91 X-8 F6000")
        session.run(0.1)
        session.byte(0x85)
        engine.set("alarm", 1)
        session.run(0.3)
        engine.set("alarm", 0)
        session.run(0.3)
        assert session.log.count("ALARM:3") == session.log.count("ALARM") == 1


@pytest.mark.parametrize(("code", "alarm"), [(0x18, 6), (0x84, 7)])
def test_a_home_that_is_stopped(session: Session, code: int, alarm: int) -> None:
    session.grbl.type(b"$H\n")
    session.run(0.1)
    session.take()
    session.byte(code)
    session.grbl.wait(lambda: session.grbl.is_idle)
    assert f"ALARM:{alarm}\n" in session.take() and session.report().startswith("Alarm")


def test_an_input_without_a_switch_is_never_active(tmp_path: Path) -> None:
    """Whatever `$5` says: it is connected to ground."""
    path = tmp_path / "bare.toml"
    axes = [AXIS.format(name=name, home="low", switches='["home"]') for name in "XYZ"]
    axes[2] = axes[2].replace('home = "low"\nswitches = ["home"]\n', "")
    path.write_text(HEAD + "".join(axes))
    machine = read_machine(path)
    with machine_at("model", machine) as engine:
        session = Session(engine, machine)
        session.line("$X")
        assert "|Pn:" not in session.report()
        assert session.line("$5=1") == "ok"
        assert "|Pn:XY|" in session.report()  # as if both were pressed


def test_a_home_without_its_switch(tmp_path: Path) -> None:
    """The travel of the settings is too short to get there."""
    machine = machine_of(tmp_path)
    with machine_at("model", machine) as engine:
        session = Session(engine, machine)
        session.line("$X")
        assert session.line("$132=4") == "ok"
        said = session.line("$H")
        assert "ALARM:9" in said and "error:9" in said


def test_no_setting_lets_a_limit_pass(tmp_path: Path) -> None:
    """`$21=0` does not: the core stops at each limit that is fitted; off it the axis moves as before."""
    machine = machine_of(tmp_path)
    with machine_at("model", machine) as engine:
        session = Session(engine, machine)
        session.line("$X")
        assert session.line("$21=0") == session.line("G0 X-9") == "ok"
        session.settle()
        session.line("G1 X-15 F1000")
        assert session.settle() == "ALARM:1"
        assert -10.5 < session.fields("MPos")[0] < -9.9
        assert session.line("$X").endswith("ok") and session.line("G0 X-8") == "ok"
        assert session.settle() == "" and session.fields("MPos")[0] == -8
