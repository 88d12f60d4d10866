# SPDX-License-Identifier: MIT
"""Machines whose motors are not their axes: file, `passo run`, the grbl console, `passo make`."""

import json
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from passo.cli import main
from passo.engine import AroundEngine
from passo.failure import BadInputError
from passo.grbl_setup import SettingsFile, attach, core_for, machine_at
from passo.machine_check import check_machine
from passo.machine_file import MachineFile, read_machine
from passo.make_command import definitions, settings_lines
from passo.run import open_engine
from passo.toolchain import paths

from tests.helpers.grbl_console import GrblConsole

HEAD = "clock_hz = 4_000_000\nprobe = true\n{head}\n[home]\nseek = 40\nspeed = 10\n{home}\n"
AXIS = (
    '[[axis]]\nname = "{name}"\nsteps_per_mm = {scale}\nspeed = 100\nacceleration = 1000\n'
    "travel = {travel}\n{more}\n"
)
HOMES = {"X": 'home = "low"\nswitches = ["home"]', "Y": 'home = "high"\nswitches = ["home"]'}
TRAVELS = {"X": 30, "Y": 20, "Z": 15, "A": 90}
PART = "G21 G90\nG0 X5 Y3\nG1 X12 Y3 F3000\nG2 X12 Y9 J3\nG1 X5 Y3 Z1\nM2\n"


def machine_of(
    folder: Path, head: str = "", axes: str = "XYZ", scales: str = "", home: str = "", **more: str
) -> MachineFile:
    """A machine with keys at the top, and more of some axes."""
    homes = {**HOMES, "Z": 'home = "high"\nswitches = ["home"]', **more}
    given = dict(word.split("=") for word in scales.split())
    path = folder / "machine.toml"
    path.write_text(
        HEAD.format(head=head, home=home)
        + "".join(
            AXIS.format(name=name, scale=given.get(name, 80), travel=TRAVELS[name], more=homes.get(name, ""))
            for name in axes
        )
    )
    return read_machine(path)


COREXY, COREXZ = 'kinematics = "corexy"', 'kinematics = "corexz"'
GANGED = {"Y": f"motors = 2\n{HOMES['Y']}"}
LIMITS = {"Y": 'motors = 2\nhome = "high"\nswitches = ["limit_high"]'}


def test_names_and_maps(tmp_path: Path) -> None:
    """In the order of the core."""
    assert machine_of(tmp_path).motors == ["X", "Y", "Z"] and machine_of(tmp_path).settings.motors.rows == ()
    assert machine_of(tmp_path, COREXY).motors == ["X+Y", "X-Y", "Z"]
    assert machine_of(tmp_path, COREXZ).motors == ["X+Z", "Y", "X-Z"]
    machine = machine_of(tmp_path, X="motors = 2", Y="motors = 3")
    assert machine.motors == ["X", "Y", "Z", "X2", "Y2", "Y3"]
    assert machine.motors_of(1) == [1, 4, 5] and machine.limited == ["X", "Y", "Z"]
    machine = machine_of(tmp_path, COREXY, Z="motors = 2")
    assert machine.motors == ["X+Y", "X-Y", "Z", "Z2"]
    assert machine.limited == ["X", "Y", "Z", "X+Y", "X-Y"]


@pytest.mark.parametrize(
    ("head", "more", "told"),
    [
        ('kinematics = "delta"', {}, "kinematics must be one of cartesian, corexy, corexz"),
        (COREXY, {"axes": "X"}, 'kinematics = "corexy" needs an axis Y'),
        (COREXZ, {"axes": "XY"}, 'kinematics = "corexz" needs an axis Z'),
        (COREXY, {"scales": "X=80 Y=160"}, "X and Y share their motors, but steps_per_mm is 80 and 160"),
        (COREXY, GANGED, 'axis 2: motors is 2, but with kinematics = "corexy" X and Y share two'),
        (
            COREXY,
            {"X": 'home = "low"\nswitches = ["limit_low"]'},
            "axis 1: switches: limit_low would block a motor",
        ),
        ("", {"Y": "motors = 4"}, "axis 2: motors must be 1 to 3"),
        ("", {"Y": "motors = 1.5"}, "axis 2: motors must be a whole number"),
        ("", {"X": "motors = 3", "Y": "motors = 3"}, "there are 7 motors; must be at most 6"),
        (f"{COREXY}\n[motors]\nspeed = 0", {}, "motors: speed must be greater than 0"),
        (f"{COREXY}\n[motors]\njump = 1", {}, "motors: unknown key 'jump'"),
        ("[motors]\nspeed = 100", {}, "motors: its limits are those of motors that two axes share"),
        (
            f"{COREXY}\n[motors]\nspeed = 30000",
            {},
            "motors: speed is 21213.2; the pins allow at most 4419.41",
        ),
    ],
)
def test_files_that_contradict_themselves(tmp_path: Path, head: str, more: dict[str, str], told: str) -> None:
    """One sentence each, with the key."""
    with pytest.raises(BadInputError) as failure:
        machine_of(tmp_path, head, **more)
    text = str(failure.value)
    assert told in text and "\n" not in text


@pytest.mark.parametrize(
    ("head", "more"), [(COREXY, {}), (COREXZ, {}), ("", GANGED)], ids=["xy", "xz", "ganged"]
)
def test_a_part(tmp_path: Path, head: str, more: dict[str, str]) -> None:
    """Exact, within all limits, and as many steps of each motor as the end says."""
    machine = machine_of(tmp_path, head, **more)
    part = tmp_path / "part.nc"
    part.write_text(PART)
    words = ["run", str(part), "--machine", str(machine.path), "--out", str(tmp_path / "out"), "--plot"]
    assert main(words) == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    ends = machine.settings.motors.map(3) @ np.array([5, 3, 1]) * machine.settings.scales
    assert summary["end"]["steps"] == ends.tolist() and summary["motors"] == machine.motors
    assert summary["limits"]["acceleration"]["share"] > 0.9


@pytest.fixture(params=["xy", "xz", "ganged", "limits"])
def session(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[GrblConsole]:
    """A console of each kind of machine."""
    heads = {"xy": (COREXY, {}), "xz": (COREXZ, {}), "ganged": ("", GANGED), "limits": ("", LIMITS)}
    head, more = heads[request.param]
    machine = machine_of(tmp_path, head, **more)
    with machine_at("model", machine) as engine:
        made = GrblConsole(engine, machine)
        made.limit(60)
        yield made


def motors_of(session: GrblConsole) -> list[float]:
    """Where the motors are, mm."""
    settings = session.grbl.machine.settings
    positions = session.grbl.player.feed.driver.positions()
    return [place / scale for place, scale in zip(positions, settings.scales, strict=False)]


def test_home_jog_probe_and_limits_of_travel(session: GrblConsole) -> None:
    """In axes, whatever the motors; after home the switches are at the ends of the travel."""
    assert session.line("$H").endswith("ok")
    assert session.fields("MPos") == pytest.approx([-29, -1, -1], abs=0.02)
    assert session.line("$20=1") == "ok"
    assert session.line("$J=G53 X1 F100") == "error:15"
    assert session.line("$J=G91 X4 Y-3 F2000") == "ok"
    session.rest()
    assert session.fields("MPos") == pytest.approx([-25, -4, -1], abs=0.02)
    rows = session.grbl.machine.settings.motors.map(3)
    assert motors_of(session) == pytest.approx((rows @ session.fields("MPos")).tolist(), abs=0.01)
    said = session.line("G91 G38.2 X1 Y1 Z-13 F300")
    assert said.startswith("[PRB:") and said.endswith("ok")
    x, y, z = (float(number) for number in re.findall(r"PRB:(.*):1", said)[0].split(","))
    assert z == pytest.approx(-15 + 15 / 4, abs=0.05)
    share = (z + 1) / -13
    assert (x, y) == pytest.approx((-25 + share, -4 + share), abs=0.02)
    assert "P" in session.status()["Pn"]
    assert session.line("G90 G53 G0 Y0.1").splitlines() == ["ALARM:2", "error:9"]


def test_a_stop_in_a_motion(session: GrblConsole) -> None:
    """The position is that of all motors, and the next line leads to its target."""
    assert session.line("$H").endswith("ok")
    session.send(b"G53 G0 X-10 Y-12\n")
    session.run(0.15)
    session.send(b"\x18", 1)
    x, y, z = session.fields("MPos")
    assert -29 < x < -10 and -12 < y < -1 and z == pytest.approx(-1, abs=0.02)
    rows = session.grbl.machine.settings.motors.map(3)
    assert motors_of(session) == pytest.approx((rows @ [x, y, z]).tolist(), abs=0.02)
    session.line("$X")
    assert session.line("G53 G0 X-10 Y-12 Z-3") == "ok"
    session.rest()
    assert session.fields("MPos") == pytest.approx([-10, -12, -3], abs=0.001)
    assert motors_of(session) == pytest.approx((rows @ [-10, -12, -3]).tolist(), abs=1e-9)


def test_the_switch_of_a_ganged_axis_has_its_letter(tmp_path: Path) -> None:
    """Also at the second motor, whose input is another one; and it stops all motors on one clock."""
    machine = machine_of(tmp_path, **LIMITS)
    with machine_at("model", machine) as engine:
        session = GrblConsole(engine, machine)
        session.limit(60)
        session.line("$X")
        session.send(b"G91 G1 Y15 F3000\n")
        assert session.grbl.wait(lambda: "ALARM:1" in session.log, 5)
        session.run(1)
        assert session.status()["Pn"] == "Y"
        one, other = (session.grbl.player.feed.driver.positions()[motor] for motor in (1, 3))
        assert 850 < one == other


def squaring(folder: Path, more: str = "", racking: str = "racking = 3") -> MachineFile:
    """A gantry of two motors, each with its own limit switch."""
    return machine_of(folder, home=racking, **{"Y": f"{LIMITS['Y']}\n{more}"})


@pytest.mark.parametrize(("skew", "offset"), [(0, 0.0), (-100, 0.0), (180, 0.5), (-150, -0.25)])
def test_home_squares_a_gantry_that_starts_skewed(tmp_path: Path, skew: int, offset: float) -> None:
    """Its motors are as far from their switches as the pull-off and their offsets say; then lines keep it."""
    machine = squaring(tmp_path, f"offsets = [0, {offset}]")
    with open_engine("model", core_for(machine), machine.clock_hz) as engine:
        ((library, rig),) = attach(engine, machine, {3: skew})
        session = GrblConsole(engine, machine)
        session.limit(60)
        assert session.line("$H").endswith("ok")
        for y in (-1.0, -9.0):
            session.line(f"G53 G0 Y{y}")
            session.rest()
            ends = [library.passo_rig_position(rig, motor) - 80 * 20 for motor in (1, 3)]
            assert ends == pytest.approx([80 * y, 80 * (y - offset)], abs=1)


def test_offsets_are_settings(tmp_path: Path) -> None:
    """Signed, of each motor, stored; within the pull-off, and that within the bound."""
    machine = squaring(tmp_path, "offsets = [0, 0.25]")
    kept = SettingsFile(tmp_path / "settings")
    with open_engine("model", core_for(machine), machine.clock_hz) as engine:
        ((library, rig),) = attach(engine, machine, {3: 40})
        session = GrblConsole(engine, machine, kept)
        session.limit(60)
        asked = session.line("$$").splitlines()
        assert [line for line in asked if line.startswith("$17")] == [
            "$170=0.000", "$171=0.000", "$172=0.000", "$173=0.250",
        ]  # fmt: skip
        refused = "[MSG:Where motors square $27 is at most the racking, $170 and up at most $27"
        for line in ("$173=1.01", "$173=-1.01", "$171=2", "$172=0.1", "$27=3.1", "$27=0.2"):
            assert refused in session.line(line) and session.answers[-1] == "error:3"
        for line in ("$174=0", "$173=1001"):
            assert session.line(line) == "error:3"
        assert session.line("$131=-1") == "error:4"
        assert session.line("$173=-0.75") == session.line("$171=0.125") == "ok"
        assert session.line("$H").endswith("ok")
        session.line("G53 G0 Y-4")
        session.rest()
        ends = [library.passo_rig_position(rig, motor) - 80 * 20 for motor in (1, 3)]
        assert ends == pytest.approx([80 * -4.125, 80 * -3.25], abs=1)
    with machine_at("model", machine) as engine:
        session = GrblConsole(engine, machine, kept)
        session.limit(60)
        assert {"$171=0.125", "$173=-0.750"} < set(session.line("$$").splitlines())
        session.line("$RST=$")
        session.run(0.1)
        assert {"$171=0.000", "$173=0.250"} < set(session.line("$$").splitlines())
    with machine_at("model", machine_of(tmp_path, **LIMITS)) as engine:  # does not square
        session = GrblConsole(engine, machine_of(tmp_path, **LIMITS))
        assert session.line("$170=0").endswith("error:3") and "$170" not in session.line("$$")


def test_settings_that_no_gantry_squares_with(tmp_path: Path) -> None:
    """Offsets further apart than the racking, and a speed that a motor cannot have or end within it."""
    machine = squaring(tmp_path, racking="racking = 1.5")
    with machine_at("model", machine) as engine:
        session = GrblConsole(engine, machine)
        session.limit(60)
        session.take_all()
        assert session.line("$171=-0.8") == "ok"
        assert "no further apart than the racking]" in session.line("$173=0.8")
        assert session.line("$173=0.7") == session.line("$24=6000") == "ok"
        assert session.line("$H").splitlines() == [
            "[MSG:$24 is too fast to stop within half the racking]", "error:5",
        ]  # fmt: skip


def test_positions_of_motors(session: GrblConsole) -> None:
    """`$#` shows them beside those of the axes."""
    session.line("$X")
    session.line("G91 G0 X4 Y-1.5 Z0.25")
    session.rest()
    (shown,) = re.findall(r"\[MOTORS:(.*)\]", session.line("$#"))
    rows = session.grbl.machine.settings.motors.map(3)
    assert [float(place) for place in shown.split(",")] == (rows @ [4, -1.5, 0.25]).tolist()


def test_an_alarm_of_one_motor_stops_all(tmp_path: Path) -> None:
    """Of a ganged axis, in a move, on one clock; the machine is not homed any more."""
    machine = machine_of(tmp_path, **GANGED)
    with machine_at("model", machine) as engine:
        session = GrblConsole(engine, machine)
        session.limit(60)
        session.line("$X")
        session.send(b"G91 G1 Y8 F3000\n", 0.1)
        engine.set("alarm", 8)
        events = [engine.drain()]
        session.run(0.2)
        events = np.concatenate([*events, engine.drain()])
        one, other = (session.grbl.player.feed.driver.positions()[motor] for motor in (1, 3))
        assert 0 < one == other < 640
        steps = events["step"].astype(np.int64)
        assert ((steps >> 1 & 1) == (steps >> 3 & 1)).all()
        assert "ALARM:3" in session.log and session.status()["state"] == "Alarm"


@pytest.mark.parametrize(("skew", "name"), [(-300, "Y2"), (300, "Y")])
def test_a_gantry_that_is_too_skewed(tmp_path: Path, skew: int, name: str) -> None:
    """The error names the motor and the distance, and the machine stays locked."""
    machine = squaring(tmp_path)
    with open_engine("model", core_for(machine), machine.clock_hz) as engine:
        attach(engine, machine, {3: skew})
        session = GrblConsole(engine, machine)
        session.limit(60)
        said = session.line("$H")
        assert f"[MSG:Motor {name}: no switch within 3.000 mm]" in said and "ALARM:9" in said
        assert session.status()["state"] == "Alarm"


def test_a_switch_of_a_gantry_that_sticks(tmp_path: Path) -> None:
    """It is not left, by no motor before another: alarm 9, the position is unknown, the motors are held."""
    machine = squaring(tmp_path)
    with open_engine("model", core_for(machine), machine.clock_hz) as engine:
        ((library, rig),) = attach(engine, machine, {3: 10_000})  # its switch is active wherever it is
        before = [library.passo_rig_position(rig, motor) for motor in (1, 3)]
        session = GrblConsole(engine, machine)
        session.limit(60)
        assert session.line("$H").splitlines()[-2:] == ["ALARM:9", "error:9"]
        driver = session.grbl.player.feed.driver
        one, other = (library.passo_rig_position(rig, motor) for motor in (1, 3))
        assert one - before[0] == other - before[1] < 0
        assert session.status()["state"] == "Alarm" and session.line("G0 X1") == "error:9"
        assert not any(driver.lib.passo_is_homed(driver.c, motor) for motor in (1, 3))


class Wired(AroundEngine):
    """A core that can be replaced by one that is fresh from its reset."""

    def transfer(self, mosi: Sequence[int], gap: int) -> list[int]:
        """One chip select."""
        return list(self.engine.transfer(mosi, gap))

    def run(self, clocks: int) -> int:
        """Let time pass."""
        return int(self.engine.run(clocks))

    def drain(self) -> np.ndarray:
        """The pin events."""
        return self.engine.drain()


def in_mid_squaring(session: GrblConsole, library: Any, rig: Any) -> None:
    """Begin a home, until one motor is on its own."""
    session.grbl.type(b"$H\n")
    skew = library.passo_rig_position(rig, 3) - library.passo_rig_position(rig, 1)
    assert session.grbl.wait(
        lambda: library.passo_rig_position(rig, 3) - library.passo_rig_position(rig, 1) != skew, 30
    )


def test_a_reset_of_the_core_in_mid_squaring(tmp_path: Path) -> None:
    """Alarm 3; the position is unknown, the drives are off; the next start squares what is left."""
    machine = squaring(tmp_path)
    with (
        open_engine("model", core_for(machine), machine.clock_hz) as engine,
        open_engine("model", core_for(machine), machine.clock_hz) as other,
    ):
        ((library, rig),) = attach(engine, machine, {3: -100})
        session = GrblConsole(wired := Wired(engine), machine)
        in_mid_squaring(session, library, rig)
        left = library.passo_rig_position(rig, 3) - library.passo_rig_position(rig, 1)
        ((library, rig),) = attach(other, machine, {3: left})
        wired.engine = other
        session.run(0.1)
        assert session.log.endswith("ALARM:3\r\nerror:9\r\n") and session.status()["state"] == "Alarm"
        driver = session.grbl.player.feed.driver
        assert driver.fault == "CORE_RESET" and not driver.lib.passo_is_homed(driver.c, 1)
        assert not other.drain()["enable"].any()
        assert_squares(GrblConsole(other, machine), library, rig)


def test_a_host_that_dies_in_mid_squaring(tmp_path: Path) -> None:
    """The watchdog of the core stops the motors within the bound, and holds them; so does the next start."""
    machine = squaring(tmp_path)
    with open_engine("model", core_for(machine), machine.clock_hz) as engine:
        ((library, rig),) = attach(engine, machine, {3: -100})
        in_mid_squaring(GrblConsole(engine, machine), library, rig)
        for _ in range(100):
            engine.run(machine.clock_hz // 100)
        ends = [library.passo_rig_position(rig, motor) for motor in (1, 3)]
        engine.drain()
        engine.run(machine.clock_hz)
        assert [library.passo_rig_position(rig, motor) for motor in (1, 3)] == ends
        assert abs(ends[1] - ends[0] + 100) <= 3 * 80 and not len(engine.drain())
        session = GrblConsole(engine, machine)
        assert session.status()["state"] == "Alarm"
        assert_squares(session, library, rig)


def assert_squares(session: GrblConsole, library: Any, rig: Any) -> None:
    session.limit(60)
    assert session.line("$H").endswith("ok")
    ends = [library.passo_rig_position(rig, motor) - 80 * 20 for motor in (1, 3)]
    assert ends == pytest.approx([-80, -80], abs=1)


@pytest.mark.parametrize(
    ("more", "racking", "told"),
    [
        ("", "racking = 0.5", "home: racking must be at least pull_off, 1 mm"),
        ("", "racking = 0.09\npull_off = 0.05", "axis 2: home: speed needs 0.05 mm to stop"),
        ("offsets = [-1, 0.5]", "racking = 1", "axis 2: offsets are 1.5 mm apart; must be at most racking"),
        ("offsets = [0, 2]", "racking = 3", "axis 2: offsets must be at most pull_off, 1 mm"),
        ("offsets = [0]", "racking = 3", "axis 2: offsets must be an array of 2 numbers"),
        ("offsets = [0, 0.1]", "", "axis 2: offsets are of motors that square: home: racking is missing"),
    ],
)
def test_gantries_that_contradict_themselves(tmp_path: Path, more: str, racking: str, told: str) -> None:
    with pytest.raises(BadInputError) as failure:
        squaring(tmp_path, more, racking)
    assert told in str(failure.value)


def test_two_motors_need_two_switches(tmp_path: Path) -> None:
    """One home switch squares nothing; nor does an axis with one motor."""
    for more, told in ((GANGED, "2 motors and one home switch"), ({}, "home: racking needs an axis")):
        with pytest.raises(BadInputError, match=told):
            machine_of(tmp_path, home="racking = 3", **more)


def test_a_machine_with_a_board(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Sheet, summary and firmware name each motor; the small chip has none of this."""
    text = (paths.examples / "machines" / "router.toml").read_text()
    text = text.replace('drive = "DM542"', 'drive = "DM542"\nchip = "STM32F103CB"')
    path = tmp_path / "machine.toml"
    path.write_text(text.replace('name = "Y"', 'name = "Y"\nmotors = 2'))
    assert main(["make", str(path), "--out", str(tmp_path / "out"), "--no-build"]) == 0
    wires = (tmp_path / "out" / "wiring.txt").read_text()
    assert re.search(r"step\[3\] .* drive Y2: STEP \(PUL\)", wires) and "home[3]" in wires
    said = capsys.readouterr().out
    assert "core   4 of" in said and "motors Y, Y2" in said
    made = definitions(read_machine(path))
    assert made["MOTORS"] == 4 and made["MOTORS_PLUS"] == 0x02040201 and made["MOTORS_MINUS"] == 0
    gantry = text.replace('name = "Y"', 'name = "Y"\nmotors = 2\noffsets = [0, -0.12]')
    gantry = gantry.replace("[switches]", "[home]\nracking = 4\n[switches]")
    i = gantry.index('name = "Y"')
    path.write_text(gantry[:i] + gantry[i:].replace('["home"]', '["limit_low"]', 1))
    made = definitions(read_machine(path))
    assert (made["SQUARED"], made["RACKING"]) == (2, 4000)
    lines = settings_lines(read_machine(path))
    assert lines.index("$173=0") < lines.index("$27=1") < lines.index("$173=-0.12") and "$170=0" in lines
    path.write_text(text.replace("[switches]", 'kinematics = "corexy"\n[motors]\nspeed = 200\n[switches]'))
    made = definitions(read_machine(path))
    assert (made["MOTORS_PLUS"], made["MOTORS_MINUS"], made["MOTORS_SPEED"]) == (0x040103, 0x0200, 200)
    path.write_text(path.read_text().replace("STM32F103CB", "STM32F103C8"))
    with pytest.raises(BadInputError, match="axes: 5 requested, but the table has pins for 4"):
        path.with_name("big.toml").write_text(text.replace('name = "Y"', 'name = "Y"\nmotors = 3'))
        read_machine(path.with_name("big.toml"))
    assert main(["make", str(path), "--no-build"]) == 2
    assert "the motors are X+Y, X-Y, Z; the firmware for STM32F103C8" in capsys.readouterr().err


@pytest.mark.parametrize(("head", "more"), [(COREXY, {}), ("", LIMITS)], ids=["xy", "limits"])
def test_the_first_power_on(tmp_path: Path, head: str, more: dict[str, str]) -> None:
    """`passo check` moves each axis by a step, and presses each switch once."""
    check_machine(machine_of(tmp_path, head, **more).path, None)
