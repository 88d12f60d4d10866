# SPDX-License-Identifier: MIT
"""The grbl image in the emulated STM32F103, with a core at its pins."""

import math
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import passo
import pytest
from passo import registers as r
from passo.cli import main
from passo.drives import drives
from passo.engine import model_engine, rtl_engine
from passo.grbl import Grbl
from passo.grbl_setup import machine_at
from passo.machine_file import read_machine
from passo.run import parameters_for
from passo.toolchain import paths
from passo.values import parse_time
from passo_fpga.boards import boards
from passo_stm32.board import Motion, make_firmware, motions
from passo_stm32.bus import TICKS_PER_SECOND
from passo_stm32.flash import FIRST, PAGE
from passo_stm32.grbl_board import GREETING, START, Answers, GrblBoard, grbl_elf
from passo_stm32.machine import Machine

from tests.helpers.grbl_outputs import check_outputs_at_rest

HZ = 36_000_000  # of the core
PARAMETERS = replace(parameters_for(3), clock_hz=HZ)
REGISTER_MAP = r.VERSION_MAJOR_RESET, r.VERSION_MINOR_RESET, r.VERSION_PATCH_RESET
FAST_BAUD = 1_000_000
CODE = 62 << 10
SETTINGS = FIRST + CODE
MACHINE = read_machine(paths.examples / "gcode" / "machine.toml")
PLANNED = {"polls": 2000, "reserve_clocks": HZ // 200, "unrounded": True}  # as by grbl_machine.c
MACHINE = replace(MACHINE, settings=replace(MACHINE.settings, clock_hz=HZ, **PLANNED))
PART = """G21 G90
G1 X2 Y0 F3000
Y2
G2 X0 Y0 R2
M2""".splitlines()
LONG = "G1 X40 F3000"
RESET = "\r\n[MSG:Reset by power]\r\n[MSG:STM32F103x8: no jerk, no axes A B C, no tools, no console]\r\n"


@pytest.fixture(scope="module")
def elf() -> Path:
    """The image for the core of these tests."""
    return grbl_elf(paths.build / "tests" / "firmware_grbl", "AXES=3")


@pytest.fixture(scope="module")
def fast_elf() -> Path:
    """For a fast serial line and a core with inputs: the machine has homes."""
    definitions = "AXES=3", f"BAUD={FAST_BAUD}", "HOMES=7"
    return grbl_elf(paths.build / "tests" / "firmware_grbl_fast", *definitions)


@pytest.fixture
def board(elf: Path) -> Iterator[GrblBoard]:
    """A board with the C model, which is fast while nothing happens."""
    with model_engine(PARAMETERS, HZ) as engine:
        made = GrblBoard(engine, elf)
        yield made
        assert not made.faults and {cause for _, cause in made.resets} == {"power"}


@pytest.mark.sample(1)
def test_it_fits_and_the_page_says_how_large_it_is() -> None:
    """Code, data and stack, with the two pages of settings left free."""
    said = make_firmware("GRBL=1")
    page = (paths.docs / "firmware.md").read_text(encoding="utf-8")
    for name, row, most in (
        ("flash", "flash", CODE),
        ("RAM", "RAM without stack", 13_500),
        ("stack", "worst-case stack", 3_000),
    ):
        (size,) = re.findall(rf"^{name} +(\d+) of", said, re.M)
        assert int(size) <= most
        assert f"| {row} | {int(size):,} |" in page, f"docs/firmware.md: {row} is {int(size):,}"
    assert f"of {CODE} bytes" in said


def test_greeting_and_settings(board: GrblBoard) -> None:
    """What a sender asks for first."""
    assert board.output == RESET + "\r\nGrbl 1.1h ['$' for help]\r\n"
    core = f"[CORE:{'.'.join(map(str, REGISTER_MAP))}:{HZ}:0]"
    firmware = (
        f"[VER:1.1h.passo:]\n[OPT:VNM,48,255]\n[FIRMWARE:Passo {passo.__version__}]\n[KINEMATICS:Cartesian]"
    )
    assert board.line("$I") == f"{firmware}\n{core}\nok"
    settings = board.line("$$").splitlines()
    assert settings[-1] == "ok"
    assert {"$0=2.000", "$11=0.010", "$100=80.000", "$102=400.000", "$110=12000.000"} < set(settings)
    assert "$103=400.000" not in settings
    assert board.line("G5") == "error:20" and board.line("G1 X1") == "error:22"


@pytest.mark.parametrize("clock_hz", [48_000_000, 72_000_000, 150_000_000])
def test_clock_is_that_of_the_core(elf: Path, clock_hz: int) -> None:
    """One image for any board: `$I` tells clock and build, SCLK follows, a move takes its time."""
    with model_engine(replace(PARAMETERS, clock_hz=clock_hz, build=0xDEADBEEF), clock_hz) as engine:
        board = GrblBoard(engine, elf)
        assert f":{clock_hz}:{0xDEADBEEF}]" in board.line("$I")
        sclk_hz = TICKS_PER_SECOND / 2 / board.spi.half_period
        assert sclk_hz == (18e6 if clock_hz >= 72_000_000 else 9e6)
        assert board.line("G1 X2 F6000") == "ok"
        board.rest(1)
        (motion,) = motions(board.events(), axes=4)
        clocks, _ = motion.steps(0)
        assert motion.clocks / clock_hz == pytest.approx(2 / 100 + 100 / 1000, rel=0.3)
        assert len(clocks) == 160 and not board.faults


@pytest.mark.parametrize("clock_hz", sorted({round(board.clock_mhz * 1e6) for board in boards().values()}))
def test_defaults_suit_the_core_of_every_board(fast_elf: Path, clock_hz: int) -> None:
    """Also the filter of the switches, which a core of 108 MHz cannot count to a millisecond."""
    parameters = replace(PARAMETERS, inputs=1, clock_hz=clock_hz)
    with model_engine(parameters, clock_hz) as engine:
        board = GrblBoard(engine, fast_elf, baud=FAST_BAUD)
        assert "error" not in board.output
        assert board.line("$20=0").endswith("ok") and "$26=0.400" in board.line("$$").splitlines()


def test_core_that_does_not_tell_its_clock(elf: Path) -> None:
    """The firmware says so, and nothing moves."""
    with model_engine(replace(PARAMETERS, clock_hz=0), HZ) as engine:
        board = Machine(elf, engine)
        board.run(START)
        board.type("G1 X2 F6000\n$H\n")
        board.run(0.5)
        assert board.output.endswith("[MSG:CLOCK_UNKNOWN]\r\n") and not board.events()["step"].any()


def shortest_times(events: np.ndarray, axis: int, clock_hz: int) -> dict[str, float]:
    """Shortest times at the pins of an axis, in us: STEP high and low, DIR before STEP rises and after."""
    clock = events["clock"].astype(float) / clock_hz * 1e6
    step, dir_ = (events[pin] >> axis & 1 for pin in ("step", "dir"))

    def edges(levels: np.ndarray, level: int) -> np.ndarray:
        changed = np.flatnonzero(np.diff(levels.astype(int)) == 2 * level - 1) + 1
        return clock[changed]

    rises, falls = edges(step, 1), edges(step, 0)
    turns = np.sort(np.concatenate([edges(dir_, 0), edges(dir_, 1)]))
    after = [(turn - rises[rises < turn][-1]) for turn in turns if (rises < turn).any()]
    before = [(rises[rises >= turn][0] - turn) for turn in turns if (rises >= turn).any()]
    assert len(rises) == len(falls) > 100 and len(before) > 5
    return {
        "high": (falls - rises).min(),
        "low": (rises[1:] - falls[:-1]).min(),
        "setup": min(before),
        "hold": min(after),
    }


@pytest.mark.parametrize("name", ["DM542", "TB6600", "A4988", "servo-24V"])
def test_pins_are_as_the_drive_needs(elf: Path, name: str) -> None:
    """By the settings that `$` lines would have, at every reversal of a zigzag."""
    clock_hz = 81_000_000
    microseconds = {key: float(parse_time(key, time, 1)) * 1e6 for key, time in drives()[name].pins.items()}
    pulse = max(microseconds["step_high"], microseconds["step_low"])
    turn = max(microseconds["dir_setup"], microseconds["dir_hold"])
    with model_engine(replace(PARAMETERS, clock_hz=clock_hz), clock_hz) as engine:
        board = GrblBoard(engine, elf)
        for line in (f"$0={pulse:g}", f"$29={turn:g}", f"$4={drives()[name].enable_inverted:d}"):
            assert board.line(line) == "ok"
        board.events()
        board.stream([f"G1 X{i % 2 * 0.2:g} Y{i * 0.1:g} F6000" for i in range(20)], 5)
        board.rest(5)
        events = board.events()
        shortest = shortest_times(events, 0, clock_hz)
        clock = 1e6 / clock_hz
        assert pulse - 1e-6 <= shortest["high"] < pulse + clock
        assert shortest["low"] >= pulse - 1e-6 and shortest["setup"] >= turn - 1e-6
        assert shortest["hold"] >= turn - 1e-6 and not board.faults
        enabled = int(events["enable"][-1]) & 1
        assert enabled != drives()[name].enable_inverted


def test_settings_outlast_a_reset(board: GrblBoard) -> None:
    """The newest copy counts; if it is damaged, the other one does."""
    for value in ("81.000", "82.000"):
        assert board.line(f"$100={value}") == "ok"
    board.restart()
    assert "$100=82.000" in board.line("$$").splitlines()
    copies = [board.read_memory(SETTINGS + page * PAGE, PAGE) for page in (0, 1)]
    numbers = [int.from_bytes(copy[4:8], "little") for copy in copies]
    newest = SETTINGS + PAGE * int(np.argmax(numbers))
    damaged = bytes([board.read_memory(newest + 100, 1)[0] ^ 1])
    board.write_memory(newest + 100, damaged)
    board.restart()
    assert "$100=81.000" in board.line("$$").splitlines()
    assert board.line("$100=83.000") == "ok"
    board.restart()
    assert "$100=83.000" in board.line("$$").splitlines()


def test_worn_flash_is_told(board: GrblBoard) -> None:
    """The setting is refused; the one before outlasts the reset."""
    assert board.line("$100=81") == "ok"
    board.flash.worn = frozenset({62, 63})
    assert board.line("$100=82").startswith("error:")
    board.restart()
    assert "$100=81.000" in board.line("$$").splitlines()


def is_after(report: dict[str, str], steps: int) -> bool:
    """X is where `steps` steps from 0 lead to."""
    return abs(float(report["MPos"].split(",")[0]) - steps / 80) < 0.001


def steps_made(board: GrblBoard) -> int:
    """Steps of X in the motion since the last call."""
    (motion,) = motions(board.events(), axes=4)
    return len(motion.steps(0)[0])


def on_the_pc(lines: list[str]) -> list[Motion]:
    """The motions of the PC's controller."""
    with model_engine(PARAMETERS, HZ) as engine:
        grbl = Grbl(engine, MACHINE, lambda said: None)
        events = [engine.drain()]
        drain = engine.drain

        def keep() -> np.ndarray:
            events.append(drain())
            return events[-1]

        engine.drain = keep
        grbl.type("".join(line + "\n" for line in lines).encode())
        grbl.wait(lambda: False, 0.1)
        assert grbl.wait(lambda: grbl.is_idle)
        grbl.wait(lambda: False, 0.01)
        return motions(np.concatenate(events), axes=engine.parameters.axes)


@pytest.mark.sample(1)
def test_pulses_are_those_of_the_pc(elf: Path) -> None:
    """A square and an arc on the Verilated core: every edge."""
    expected = on_the_pc(["$0=1", *PART])
    with rtl_engine(PARAMETERS, HZ) as engine:
        board = GrblBoard(engine, elf)
        assert board.line("$0=1") == "ok"
        board.events()
        board.stream(PART, 1.0)
        board.rest(3.0)
        made = motions(board.events(), axes=engine.parameters.axes)
    assert len(expected) == len(made) == 1 and len(made[0].step) > 1000
    assert not made[0].same_as(expected[0])


def test_hold_and_resume(board: GrblBoard) -> None:
    """In mid path, and not a step is lost."""
    board.line(LONG)
    board.run(0.3)
    moving = board.report()
    assert moving["state"] == "Run" and 0 < float(moving["MPos"].split(",")[0]) < 40
    assert re.fullmatch(r"\d+,\d+", moving["Bf"]) and moving["FS"] == "3000,0"
    board.type("!")
    board.run(0.1)
    held = board.report()
    assert held["state"] == "Hold:0"
    board.run(0.1)
    assert board.report()["MPos"] == held["MPos"]
    board.type("~")
    board.rest(2.0)
    assert board.report()["MPos"] == "40.000,0.000,0.000"
    assert steps_made(board) == 40 * 80


def test_reset_in_mid_path(board: GrblBoard) -> None:
    """Ctrl-X: an alarm, a soft stop, and the position is that of the steps."""
    board.line(LONG)
    board.run(0.3)
    since = len(board.output)
    board.type("\x18")
    board.expect("Grbl 1.1h", 0.3, since)
    assert board.output[since:].startswith("ALARM:3\r\n")
    report = board.report()
    assert report["state"] == "Alarm"
    made = steps_made(board)
    assert 0 < made < 40 * 80
    assert is_after(report, made)
    assert board.line("G0 X0") == "error:9"
    assert board.line("$X").endswith("ok")
    assert board.line("G0 X0") == "ok"
    board.rest(1.0)
    assert board.report()["MPos"] == "0.000,0.000,0.000"


def test_outputs_at_rest(elf: Path) -> None:
    """`M5` behind the last motion: off when it ends; `M3` at rest: on before a dwell."""
    with model_engine(replace(PARAMETERS, outputs=1), HZ) as engine:
        check_outputs_at_rest(GrblBoard(engine, elf))


def test_reset_of_the_board_in_mid_path(board: GrblBoard) -> None:
    """The core continues; the board stops it and knows where it is."""
    board.line(LONG)
    board.run(0.3)
    since = len(board.output)
    board.restart()
    assert "[MSG:MOVING]" in board.output[since:]
    made = steps_made(board)
    assert 0 < made < 40 * 80
    assert is_after(board.report(), made)


def curve(count: int) -> list[tuple[float, float]]:
    """Ends of lines of 0.1 mm on a circle."""
    radius = 50
    angles = [0.1 / radius * i for i in range(1, count + 1)]
    return [(radius * math.sin(a), radius - radius * math.cos(a)) for a in angles]


def hurry_along(board: GrblBoard, count: int, after: str = "") -> float:
    """A curve of which its speed needs 10,000 lines per second; returns those that were taken per second."""
    for axis in "01":
        assert board.line(f"$11{axis}=60000") == board.line(f"$12{axis}=200000") == "ok"
    began, since, places = board.seconds, len(board.output), curve(count)
    board.stream(["F60000", *(f"G1 X{x:.3f} Y{y:.3f}{after}" for x, y in places)], 1.5)
    rate = count / (board.seconds - began)
    board.rest(0.5)
    assert "ALARM" not in board.output[since:]
    place = [float(mm) for mm in board.report()["MPos"].split(",")]
    assert np.allclose(place, [*places[-1], 0], atol=0.5 / 80 + 0.001)
    return rate


def test_path_that_the_host_cannot_keep_up_with(fast_elf: Path) -> None:
    """It slows down, and ends."""
    with model_engine(replace(PARAMETERS, inputs=1), HZ) as engine:
        board = GrblBoard(engine, fast_elf, baud=FAST_BAUD)
        assert board.line("$X").endswith("ok")
        assert hurry_along(board, 300) > 2000


def test_questions_do_not_starve_the_core(board: GrblBoard) -> None:
    """More status reports are asked for than the serial line can take: some become one, and the path ends."""
    assert hurry_along(board, 90, "?") > 200
    assert board.output.count("<") < 80


def test_damaged_bytes_refuse_their_line(board: GrblBoard) -> None:
    """Noise on the serial line: nothing moves."""
    board.type("G0X")
    board.type("0" * 30, damaged=True)
    assert board.line("1").startswith("error:")
    board.run(0.05)
    assert not board.events()["running"].any()
    assert board.line("G0X1") == "ok"


def test_no_byte_is_lost_while_the_flash_is_written(board: GrblBoard) -> None:
    """Offsets are stored at rest, after their answer; what a sender has under way then is executed."""
    lines = "".join(f"G1X{i % 2}F6000\n" for i in range(11))
    for offset in range(1, 4):
        since, answers = len(board.output), Answers(board)
        board.type(f"G10L2P2X{offset}\n" + lines)
        board.run_until(lambda n=answers: n.count == 12, 2)
        assert board.output[since:].split() == ["ok"] * 12
        board.rest(2)


def test_without_a_core(elf: Path) -> None:
    """It is reported once; no watchdog trips, and fast blinking shows it."""
    machine = Machine(elf, None)
    machine.run(1.5)
    assert machine.output == RESET + "[MSG:STUCK_LOW]\r\n"
    assert machine.resets == [(0, "power")] and len(machine.led) > 15


def test_link_is_lost_in_mid_path(board: GrblBoard) -> None:
    """An alarm; when the core answers again it is stopped, and the position is that of its steps."""
    board.line(LONG)
    board.run(0.3)
    since = len(board.output)
    board.wires.stuck = 0
    board.expect("ALARM:3", 0.2, since)
    board.wires.stuck = None
    board.run(0.3)
    report = board.report()
    assert report["state"] == "Alarm" and is_after(report, steps_made(board))
    assert board.line("$X").endswith("ok") and board.line("G0X0") == "ok"
    board.rest(2.0)


def test_estop_at_the_start(fast_elf: Path) -> None:
    """It is reported, and the greeting follows when it is over. A machine with homes is locked."""
    with model_engine(replace(PARAMETERS, inputs=1), HZ) as engine:
        engine.set("estop_n", 0)
        machine = Machine(fast_elf, engine, baud=FAST_BAUD)
        machine.run(0.1)
        assert machine.output.endswith("[MSG:ESTOP]\r\n")
        engine.set("estop_n", 1)
        machine.expect(GREETING + "[MSG:'$H'|'$X' to unlock]\r\n", 0.4)


@pytest.mark.parametrize(
    "options", [["--grbl"], ["--table", "--lines", "9"], ["--table", "--grbl", "--lines", "0"]]
)
def test_bad_options_of_the_bench(options: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    """One line, before anything is measured."""
    assert main(["firmware", *options]) == 2
    assert capsys.readouterr().err.count("\n") == 1


HOMES = """
clock_hz = 36_000_000
""" + "".join(
    f"""
[[axis]]
name = "{name}"
steps_per_mm = {steps}
speed = 100
acceleration = 1000
travel = 4
home = "low"
switches = ["home"]
"""
    for name, steps in (("X", 80), ("Y", 80), ("Z", 400))
)


@pytest.mark.sample(1)
def test_home(fast_elf: Path, tmp_path: Path) -> None:
    """With switches at the low ends: locked until then, and every axis is its pull-off away from its end."""
    path = tmp_path / "machine.toml"
    path.write_text(HOMES)
    machine = read_machine(path)
    with machine_at("model", machine) as engine:
        board = GrblBoard(engine, fast_elf, baud=FAST_BAUD)
        assert board.report()["state"] == "Alarm"
        for setting in ("23=7", "24=600", "27=0.5", "130=4", "131=4", "132=4", "122=1000"):
            assert board.line(f"${setting}") == "ok"
        assert board.line("$H", 3.0) == "ok"
        report = board.report()
        assert report["state"] == "Idle"
        place = [float(mm) for mm in report["MPos"].split(",")]
        assert np.allclose(place, [-3.5] * 3, atol=0.02)
