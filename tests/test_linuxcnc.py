# SPDX-License-Identifier: MIT
"""The HAL component in a headless LinuxCNC (tools/setup.sh linuxcnc) at a simulated core."""

import re
from pathlib import Path

import pytest
from passo.engine import moves_of
from passo.toolchain import paths

from tests.helpers.linuxcnc import COMPONENT, EXAMPLE, component, run_hal, run_linuxcnc

PROGRAM = """
G21 G90 G17 G64 P0.01
G0 X60 Y60 Z74
G1 F6000 X80
G2 I15 J0
G3 X110 Y90 I15 J15
G1 X60 Y70
G0 X50 Y50 Z73
M2
"""
END = [50.0, 50.0, 73.0]
SCALES = [80, 80, 400]
PERIOD = 0.001
FASTEST = 100.0  # mm/s of the program
PAGE = (paths.docs / "hosts.md").read_text()
HAL, INI = ((EXAMPLE / f"machine.{kind}").read_text() for kind in ("hal", "ini"))


def test_homing_and_arcs() -> None:
    """Three axes on their switches, a circle and arcs at 6,000 mm/min: the end is exact, without a fault."""
    found = run_linuxcnc(PROGRAM)
    assert found.homed and found.ended and not found.said, (found.said, found.log)
    assert found.positions == pytest.approx(END, abs=1e-9)
    value = found.pins.__getitem__
    assert (value("passo.0.fault"), value("passo.0.watchdog.has-bit")) == ("FALSE", "FALSE")
    assert (int(value("passo.0.queue.slowed"), 0), int(value("passo.0.link.retries"), 0)) == (0, 0)
    for axis in range(3):
        counts = int(value(f"passo.0.stepgen.{axis:02}.counts"))
        assert counts == int(moves_of(found.events, axis).sum())
    lag = int(value("passo.0.queue.lag"), 0)
    assert abs(int(value("passo.0.queue.depth")) - lag) <= 3
    for joint in (0, 1):  # one step plus the lag
        assert found.ferror[joint] <= FASTEST * PERIOD * (lag + 3) + 1 / SCALES[joint]


SCRIPT = """
loadrt threads name1=servo period1=1000000 name2=slow period2=2000000
loadrt passo device=CORE axes=AXES
addf passo.0.read servo
addf passo.0.write servo
setp passo.0.stepgen.00.position-scale 80
setp passo.0.stepgen.00.maxvel 100
setp passo.0.stepgen.00.maxaccel 4000
start
"""
PAUSE = "loadusr -w sleep 0.3\n"
STEPGEN = "setp passo.0.stepgen.00."
CHANGES = {
    "position-scale 0": "stepgen.00.position-scale is 0: set it to the steps per unit, above 0",
    "position-scale -80": "stepgen.00.position-scale is -80: set it to the steps per unit, above 0",
    "maxvel 0": "stepgen.00.maxvel is 0: set it to the MAX_VELOCITY of the joint",
    "maxaccel 0": "stepgen.00.maxaccel is 0: set it to twice the MAX_ACCELERATION of the joint",
    "maxaccel 200": "to stop from maxvel within maxaccel takes 1000 periods, the core has ",
    "steplen 200000": "stepgen.00.maxvel needs more steps than steplen and stepspace allow: ",
    "position-cmd 1e9": "stepgen.00.position-cmd is 1e+09: beyond 2^31 steps",
}
GOOD = {"position-scale": "80", "maxvel": "100", "maxaccel": "4000", "steplen": "5000", "position-cmd": "0"}


def test_settings_that_are_wrong() -> None:
    """One sentence each, and nothing moves; then it can be enabled, and a period that changes stops it."""
    script = SCRIPT.replace("AXES", "1")
    for change in CHANGES:
        name = change.split()[0]
        script += f"{STEPGEN}{change}\n{STEPGEN}enable 1\n{PAUSE}"
        script += f"{STEPGEN}enable 0\n{STEPGEN}{name} {GOOD[name]}\n{PAUSE}"
    script += f"{STEPGEN}enable 1\n{PAUSE}getp passo.0.fault\ngetp passo.0.state\n"
    script += f"stop\n{PAUSE}"
    for function in ("read", "write"):
        script += f"delf passo.0.{function} servo\n"
    script += f"addf passo.0.read slow\naddf passo.0.write slow\nstart\n{PAUSE}getp passo.0.fault\n"
    said, events = run_hal(script)
    sentences = [line for line in said.splitlines() if line.startswith("passo: ")]
    expected = [
        *CHANGES.values(),
        "the servo period changes from 1000000 to 2000000 ns: let all functions of ",
    ]
    assert len(sentences) == len(expected), said
    for sentence, part in zip(sentences, expected, strict=True):
        assert sentence.startswith(f"passo: {part}")
    assert re.findall(r"^(TRUE|FALSE|\d)$", said, re.M) == ["FALSE", "3", "TRUE"]
    assert not any(moves_of(events, axis).any() for axis in range(3))


@pytest.mark.parametrize(
    ("axes", "device", "sentence"),
    [
        ("8", "", "axes, the program needs 8: build it with AXES=8"),
        ("9", "", "passo: axes=9: a core has 1 to 8 axes"),
        ("3", "/dev/none", "passo: /dev/none: there is no such device: switch SPI on"),
    ],
)
def test_what_cannot_be_loaded(axes: str, device: str, sentence: str) -> None:
    """One sentence says why."""
    said, events = run_hal(SCRIPT.replace("AXES", axes), device)
    assert said.count(sentence) == 1, said
    assert not any(moves_of(events, axis).any() for axis in range(3))


def test_the_page_lists_the_pins() -> None:
    """Each pin and parameter of the component, and no other; the example uses its functions."""
    source = (COMPONENT / "passo.c").read_text()
    own = set(re.findall(r'name, axis, "([a-z-]+)"', source))
    rest = set(re.findall(r'PREFIX "([a-z.-]+)"', source)) - {"read", "write"}
    assert len(own) == 18 and len(rest) > 8
    for name in own | rest:
        assert f"`{name}`" in PAGE or f"`passo.0.{name}`" in PAGE, name
    assert "addf passo.0.read" in HAL and "addf passo.0.write" in HAL


def test_it_compiles_without_a_warning() -> None:
    assert component().exists()


def test_the_example_is_complete() -> None:
    """The machine file of the simulation has the axes of the INI file."""
    names = {path.name for path in Path(EXAMPLE).iterdir()}
    assert names == {"machine.ini", "machine.hal", "machine.toml", "tool.tbl"}
