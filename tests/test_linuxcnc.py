# SPDX-License-Identifier: MIT
"""The HAL component in a headless LinuxCNC (tools/setup.sh linuxcnc) at a simulated core."""

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from passo.cli import main
from passo.engine import moves_of
from passo.failure import BadInputError
from passo.linuxcnc_files import linuxcnc_files
from passo.machine_file import read_machine
from passo.toolchain import paths

from benchmarks.linuxcnc import (
    ARCS,
    HOME_WHERE_IT_IS,
    LATHE,
    THREADS,
    figure,
    fits,
    is_in_step,
    measure,
    programs,
    threads,
)
from benchmarks.servo import LATE, SHARE_MAX
from tests.helpers.linuxcnc import (
    COMPONENT,
    EXAMPLE,
    component,
    number_of,
    run_hal,
    run_linuxcnc,
    share_of_wire,
)

pytestmark = pytest.mark.first  # one LinuxCNC runs at a time

END = [50.0, 50.0, 73.0]
SCALES = [80.0, 80.0, 400.0]
PERIOD = 0.001
FASTEST = 100.0  # mm/s of the program
PAGE = (paths.docs / "hosts.md").read_text()
HAL, INI = ((EXAMPLE / f"machine.{kind}").read_text() for kind in ("hal", "ini"))


@pytest.mark.sample(1)
def test_homing_and_arcs() -> None:
    """Three axes on their switches, a circle and arcs at 6,000 mm/min: the end is exact, without a fault."""
    found = run_linuxcnc(ARCS)
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
    assert is_in_step(found, SCALES)
    for joint in (0, 1):  # one step plus the lag
        assert found.ferror[joint] <= FASTEST * PERIOD * (lag + 3) + 1 / SCALES[joint]


def test_a_short_period() -> None:
    """4 kHz, a faster wire and axes that bear 40,000 mm/s^2: a lag of 14 periods, 3.5 ms."""
    changes = HOME_WHERE_IT_IS | {
        "SERVO_PERIOD = 1000000\n": "SERVO_PERIOD = 250000\n",
        "axes=[KINS]JOINTS": "axes=[KINS]JOINTS buffer=1 speed_hz=12000000",
        "STOPACCEL = 2000\n": "STOPACCEL = 40000\n",
        "STOPACCEL = 800\n": "STOPACCEL = 40000\n",
    }
    text = (EXAMPLE / "machine.toml").read_text().replace("16_000_000", "48_000_000")
    found = run_linuxcnc("G21 G90 G64 P0.01\nG1 F6000 X12 Y6\nX2\nM2\n", changes=changes, text=text)
    assert found.homed and found.ended and not found.said, (found.said, found.log)
    assert found.positions == pytest.approx([2, 6, 0], abs=1e-9)
    assert number_of(found.pins["passo.0.queue.lag"]) == 14
    assert max(found.ferror) <= FASTEST * PERIOD / 4 * (14 + LATE) + 1 / SCALES[0]


def test_threads() -> None:
    """Passes of G33, from different places, in step with the encoder: pitch and phase at the pins.

    Before M9 LinuxCNC halves the acceleration into the second one: its phase is later. G61 mends it.
    """
    found = run_linuxcnc(THREADS, text=LATHE)
    assert found.homed and found.ended and not found.said, (found.said, found.log)
    assert found.positions == pytest.approx([8, 2], abs=1e-9)
    assert is_in_step(found, [200, 200])
    assert fits(threads(found)), threads(found)


def test_short_lines_on_the_verilated_core() -> None:
    """And the model, compared at each edge; more of them: `make hosts`."""
    found = measure(programs(100)["both"])
    assert found.is_good, figure(found)
    assert found.edges > 3000


def test_home_by_index() -> None:
    """The switch, then the index of the motor's encoder, which becomes the place of the home."""
    example = (EXAMPLE / "machine.toml").read_text()
    text = example.replace("steps_per_mm = 80\n", "steps_per_mm = 80\nencoders = [40]\nfollowing = 1\n", 1)
    changes = {
        "[JOINT_0]\n": "[JOINT_0]\nHOME_USE_INDEX = YES\n",
        "net fault ": "net x-index passo.0.stepgen.00.index-enable joint.0.index-enable\nnet fault ",
    }
    found = run_linuxcnc("G21 G90\nG0 X50 Y50\nG0 X55\nM2\n", changes=changes, text=text, per_turn=200)
    assert found.homed and found.ended and not found.said, (found.said, found.log)
    home = int(moves_of(found.events, 0).sum()) - 55 * SCALES[0]
    per_turn = 200 * SCALES[0] // 40
    assert abs((home + per_turn // 2) % per_turn - per_turn // 2) <= 2  # a count
    switch = -100 * SCALES[0]  # from the middle of the travel
    assert switch - per_turn < home < switch + 5 * SCALES[0]
    assert found.pins["passo.0.stepgen.00.index-enable"] == "FALSE"


def test_encoder_pins() -> None:
    """Counts, scale, reset and the sentences; without pins where none is asked for."""
    script = SCRIPT.replace("AXES", "1 encoders=0 watchdog_ms=0").replace("start\n", "")
    script += f"setp passo.0.encoder.00.scale 40\n{STEPGEN}position-cmd 0.5\n{STEPGEN}enable 1\nstart\n"
    script += 8 * PAUSE + "getp passo.0.encoder.00.count\ngetp passo.0.encoder.00.position\n"
    script += f"setp passo.0.encoder.00.reset 1\n{PAUSE}getp passo.0.encoder.00.count\n"
    script += "getp passo.0.encoder.00.rawcounts\n"
    said, _ = run_hal(script, text=ENCODERS)
    assert [float(value) for value in re.findall(r"^-?[\d.]+$", said, re.M)] == [20, 0.5, 0, 20], said


ENCODERS = LATHE.replace("steps_per_mm = 200", "steps_per_mm = 80\nencoders = [40]\nfollowing = 1", 1)

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
    "maxaccel 0": "stepgen.00.maxaccel is 0: set it to the MAX_ACCELERATION of the joint, or more",
    "maxaccel 200": "to stop from maxvel within stopaccel takes 500 periods, the core has ",
    "stopaccel -1": "stepgen.00.stopaccel is -1: set it to what the axis bears; 0: as maxaccel",
    "steplen 200000": "stepgen.00.maxvel needs more steps than steplen and stepspace allow: ",
    "position-cmd 1e9": "stepgen.00.position-cmd is 1e+09: beyond 2^31 steps",
}
GOOD = {
    "position-scale": "80",
    "maxvel": "100",
    "maxaccel": "4000",
    "stopaccel": "0",
    "steplen": "5000",
    "position-cmd": "0",
}


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


def test_a_thread_that_stops() -> None:
    """The core stops the axis and switches its drive off; `has-bit` says so until it is cleared."""
    pause = "loadusr -w sleep 1\n"
    script = SCRIPT.replace("AXES", "1 watchdog_ms=2000").replace("maxaccel 4000", "maxaccel 2000")
    script += f"{STEPGEN}enable 1\n{pause}{STEPGEN}position-cmd 300\n{pause}stop\nloadusr -w sleep 8\n"
    look = "getp passo.0.watchdog.has-bit\ngetp passo.0.fault\n"
    script += f"start\n{pause}{look}{STEPGEN}enable 0\n{pause}{STEPGEN}enable 1\n{pause}getp passo.0.state\n"
    script += f"{STEPGEN}enable 0\nsetp passo.0.watchdog.has-bit 0\n{pause}{STEPGEN}enable 1\n{pause}"
    script += f"{look}getp passo.0.state\n"
    said, events = run_hal(script, real_time=True)
    assert said.count("passo: motion: WATCHDOG: ") == 1, said
    idle, running = "0", "3"
    assert re.findall(r"^(TRUE|FALSE|\d)$", said, re.M) == ["TRUE", "TRUE", idle, "FALSE", "FALSE", running]
    on = np.flatnonzero(np.diff(events["enable"] & np.uint64(1), prepend=np.uint64(0)) == 1)
    assert len(on) == 2 and moves_of(events[on[0] : on[1]], 0).any()


@pytest.mark.parametrize(
    ("axes", "device", "sentence"),
    [
        ("8", "", "axes, the program needs 8: build it with AXES=8"),
        ("9", "", "passo: axes=9: a core has 1 to 8 axes"),
        ("1 encoders=0", "", "passo: encoders=0: the core has no encoders: build it with ENCODERS=1"),
        ("1 encoders=9", "", "passo: encoders=9: numbers of encoders from 0 to 3, with commas between them"),
        (
            "1",
            "core without inputs",
            "passo: the core has no inputs, and so no watchdog: build it with INPUTS=1, ",
        ),
        ("1 watchdog_ms=999999", "", "passo: watchdog_ms=999999: at most "),
        ("3", "/dev/none", "passo: /dev/none: there is no such device: switch SPI on"),
    ],
)
def test_what_cannot_be_loaded(axes: str, device: str, sentence: str) -> None:
    """One sentence says why."""
    text, device = (ENCODERS, "") if device == "core without inputs" else ("", device)
    said, events = run_hal(SCRIPT.replace("AXES", axes), device, text)
    assert said.count(sentence) == 1, said
    assert not any(moves_of(events, axis).any() for axis in range(3))


def test_six_axes_on_a_slow_wire() -> None:
    """With inputs they take a fifth of 4 MHz at 1 kHz: positions and inputs are read in turns."""
    assert 0.1 < share_of_wire() <= SHARE_MAX


def test_the_page_lists_the_pins() -> None:
    """Each pin and parameter of the component, and no other; the example uses its functions."""
    source = (COMPONENT / "passo.c").read_text()
    own = set(re.findall(r'name, axis, "([a-z-]+)"', source))
    rest = set(re.findall(r'PREFIX "([a-z.-]+)"', source)) - {"read", "write"}
    assert len(own) == 28 and len(rest) > 8
    for name in own | rest:
        assert f"`{name}`" in PAGE or f"`passo.0.{name}`" in PAGE, name
    assert "addf passo.0.read" in HAL and "addf passo.0.write" in HAL


def test_it_compiles_without_a_warning() -> None:
    assert component().exists()


def test_it_compiles_for_2_10(tmp_path: Path) -> None:
    """Against declarations of its HAL alone, in which pins and parameters are opaque."""
    folders = (
        paths.tests / "linuxcnc" / "hal_2_10",
        paths.linux,
        paths.driver,
        paths.planner,
        paths.protocol,
    )
    flags = ["-std=gnu11", "-Wall", "-Wextra", "-Werror", "-Wno-unused-variable", "-DRTAPI", "-DUSPACE"]
    command = ["cc", *flags, *(f"-I{folder}" for folder in folders), "-c", COMPONENT / "passo.c"]
    for defines in ([], ["-DHAL_BOOL=1", "-DHAL_API_BEFORE_ITS_VERSION"]):
        done = subprocess.run(
            [*command, *defines, "-o", tmp_path / "passo.o"], capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
    known = subprocess.run(["nm", "-u", tmp_path / "passo.o"], capture_output=True, text=True).stdout.split()
    used = {name for name in known if name.startswith("hal_")}
    assert {"hal_pin_new_bool", "hal_param_new_real", "hal_get_si32", "hal_set_ui32"} <= used
    assert not {name for name in used if re.match("hal_(pin|param)_(bit|float|s32|u32)_new", name)}


def test_the_example_is_what_make_makes(tmp_path: Path) -> None:
    """Of its machine file."""
    assert main(["make", str(EXAMPLE / "machine.toml"), "--out", str(tmp_path)]) == 0
    for name in ("machine.ini", "machine.hal", "tool.tbl"):
        assert (tmp_path / name).read_text() == (EXAMPLE / name).read_text()
    names = {path.name for path in EXAMPLE.iterdir()}
    assert names == {"machine.ini", "machine.hal", "machine.toml", "tool.tbl"}


def test_make_for_a_board(tmp_path: Path) -> None:
    """Its wires lead to a Raspberry Pi; what the component does not drive is refused."""
    router = (paths.examples / "machines" / "router.toml").read_text()
    (tmp_path / "router.toml").write_text('host = "linuxcnc"\n' + router)
    assert main(["make", str(tmp_path / "router.toml"), "--out", str(tmp_path / "out"), "--no-build"]) == 0
    names = {path.name for path in (tmp_path / "out").iterdir()}
    drawn = {f"wiring.{kind}" for kind in ("txt", "svg", "html")}
    assert names == {"machine.ini", "machine.hal", "tool.tbl", "summary.txt"} | drawn
    wires = (tmp_path / "out" / "wiring.txt").read_text()
    assert re.search(r"^spi_sclk .* Raspberry Pi 23$", wires, re.M) and "Blue Pill" not in wires
    shared = 'host = "linuxcnc"\nclock_hz = 8_000_000\nkinematics = "corexy"\n'
    (tmp_path / "h.toml").write_text(shared + TWO_AXES)
    with pytest.raises(BadInputError, match="LinuxCNC drives one for each axis"):
        linuxcnc_files(read_machine(tmp_path / "h.toml"))


AXIS = "[[axis]]\nsteps_per_mm = 80\nspeed = 100\nacceleration = 500\n"
TWO_AXES = AXIS + AXIS
