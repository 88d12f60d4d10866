# SPDX-License-Identifier: MIT
"""Firmware in the loop: the ELF that is flashed to the STM32F103 drives the core.

PASSO_SEED is the seed of the random cases.
"""

import random
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from passo import random_cases
from passo.build import Parameters
from passo.driver import Driver, DriverError, Source
from passo.engine import Engine, model_engine, rtl_engine
from passo.move_file import read_channels
from passo.moves import PinTiming
from passo.native import ffi
from passo.toolchain import paths
from passo_stm32 import bench, demo
from passo_stm32.bench import memory_report
from passo_stm32.board import START, Board, Motion, firmware_elf, motions
from passo_stm32.bus import TICKS_PER_SECOND
from passo_stm32.lines import move_line
from passo_stm32.machine import Machine
from passo_stm32.play import on_the_model, planned_clocks, play, type_move

from tests.helpers.firmware_cases import random_moves

PARAMETERS = Parameters(axes=4)
HZ = 72_000_000  # of the core; SCLK is 18 MHz
SLOW_HZ = 36_000_000  # SCLK is 9 MHz
EXAMPLES = sorted(path.stem for path in paths.examples.glob("*.toml") if not read_channels(path).setup)
SHORT_EXAMPLES = ("triangle", "cosine")  # for the Verilated core
MOVE = "move steps=100,-50 profile=linear total_time=0.01 ramp_time=0.002"


def model_board(**options: object) -> Board:
    """A board with the C model, which is fast while nothing happens."""
    return Board(model_engine(PARAMETERS, HZ), **options)


def compare(board: Board, lines: list[str], expected: Motion, seconds: float) -> None:
    """Type the lines of one move; compare its pulses."""
    made = type_move(board, lines, seconds)
    assert not (difference := made.same_as(expected)), f"{lines[-1]}: {difference}"


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_by_the_firmware(name: str) -> None:
    """Each example typed at the console, on the C model: every edge as planned on the PC."""
    played, _, _ = play(paths.examples / f"{name}.toml", HZ, "model")
    assert played and not [move.difference for move in played if move.difference]


@pytest.mark.parametrize("name", SHORT_EXAMPLES)
def test_examples_on_the_verilated_core(name: str) -> None:
    """The same with the Verilated core."""
    played, _, _ = play(paths.examples / f"{name}.toml", SLOW_HZ, "rtl")
    assert played and not [move.difference for move in played if move.difference]


def test_demonstration_tells_what_it_does(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A line before and after each example; its examples are there, and short together."""
    assert set(demo.EXAMPLES) <= set(EXAMPLES)
    files = [paths.examples / f"{name}.toml" for name in demo.EXAMPLES]
    clocks = sum(planned_clocks(file, demo.CLOCK_HZ) for file in files)
    assert clocks < 1.2 * demo.CLOCK_HZ
    monkeypatch.setattr(demo, "FOLDER", paths.build / "firmware_demo_test")
    assert demo.demo([paths.examples / "triangle.toml"], "model")
    said = capsys.readouterr().out
    assert re.search(r"^\[ *0:\d\d\] triangle: .* of motion", said, re.M)
    assert re.search(r"^\[ *0:\d\d\] triangle: 2,500 edges, all as expected$", said, re.M)


@pytest.mark.sample(1)
@pytest.mark.parametrize(("clock_hz", "count"), [(HZ, 10), (SLOW_HZ, 50)])
def test_random_moves_on_the_verilated_core(clock_hz: int, count: int, tmp_path: Path) -> None:
    """Moves of all methods: the pulses of the firmware and the Verilated core are those of PC and C model."""
    with rtl_engine(PARAMETERS, clock_hz) as engine:
        board = Board(engine)
        position = [0] * PARAMETERS.axes
        for move, file, plan in random_moves(random_cases.seed(), count, clock_hz, PARAMETERS, tmp_path):
            expected = on_the_model(file, 0, plan, PARAMETERS)
            compare(board, [move_line(move)], expected, plan.clocks / clock_hz)
            for axis, steps in enumerate(file.moves[0].steps):
                position[axis] += steps
        assert board.positions() == position
        assert board.resets == [(0, "power")] and not board.faults


@pytest.mark.parametrize("clock_hz", [72_000_000, 100_000_000, 123_456_789])
def test_core_and_processor_do_not_drift(clock_hz: int) -> None:
    """After a motion and many frames the core has executed exactly the clocks of the elapsed time."""
    with model_engine(PARAMETERS, clock_hz) as engine:
        board = Board(engine)
        for seconds in (0.1, 0.2337):
            board.must(MOVE)
            board.run(seconds)
            board.run_until(lambda: board.spi.started is None, 0.001)
            passed = board.now * clock_hz // TICKS_PER_SECOND
            assert (
                0 <= passed - engine.clock <= 300 * clock_hz // HZ
            )  # the core catches up every 256 instructions


@pytest.mark.parametrize("clock_hz", [48_000_000, 150_000_000])
def test_clock_is_that_of_the_core(clock_hz: int) -> None:
    """Nothing has to be configured: the console says what it found, and a move takes its time."""
    with model_engine(replace(PARAMETERS, clock_hz=clock_hz), clock_hz) as engine:
        board = Board(engine)
        assert f"note: the core runs at {clock_hz} Hz; pin timings are 1 us\n" in board.output
        assert board.must("version").endswith(f" clock_hz={clock_hz}")
        assert board.must("config axis=0").startswith(f"ok axis=0 step_high={clock_hz // 1_000_000}clocks")
        sclk_hz = TICKS_PER_SECOND / 2 / board.spi.half_period
        assert sclk_hz == (18e6 if clock_hz >= HZ else 9e6)
        refused = board.ask("config clock_hz=72000000")
        assert refused == f"error: CLOCK: the core runs at {clock_hz} Hz, not 72000000 Hz"
        board.run(1)
        board.must("move steps=1000 profile=linear total_time=0.1 ramp_time=0.01")
        board.wait_motion(0.2)
        (motion,) = motions(board.events())
        assert motion.clocks / clock_hz == pytest.approx(0.1, rel=1e-4)


# ------------------------------------------------------------------------------------------- bad inputs ----


REFUSED = [
    ("mvoe steps=1", "unknown command 'mvoe'"),
    ("move", "missing"),
    ("move steps=1,2,3,4,5 profile=linear speed=100 ramp_time=0.01", "5 axes"),
    ("move steps=5,-1073741824 profile=linear speed=100 ramp_time=0.01", "axis 1 has too many steps"),
    ("move steps=99999999999 profile=linear speed=100 ramp_time=0.01", "too many steps"),
    ("move steps=100 profile=linear speed=1e9 acceleration=1", "TOO_FAST"),
    ("move steps=100 profile=linear speed=99999999999 acceleration=1", "at most"),
    ("move steps=100 profile=triangle total_time=1 ramp_time=0", "profile must be one of"),
    ("move steps=100 profile=linear total_time=0.1 ramp_time=0.2", "RAMP_TOO_LONG"),
    ("move steps=0,0 profile=linear total_time=0.1 ramp_time=0", "NO_STEPS"),
    ("move steps=100 profile=linear total_time=-1 ramp_time=0", "must not be negative"),
    ("move steps=100 profile=linear total_time=0.0000001 ramp_time=0", "NO_TIME"),
    ("move steps=1,,2 profile=linear total_time=1 ramp_time=0", "whole numbers"),
    ("move steps=100 steps=100 profile=linear total_time=1 ramp_time=0", "duplicate key"),
    ("move steps=100 profile=user total_time=0.1 ramp_time=0.02", "table is missing"),
    ("move steps=1073741823 profile=linear total_time=0.01 ramp_time=0", "TOO_FAST"),
    ("override 0", "1 to 100"),
    ("override 101", "1 to 100"),
    ("config axis=4 step_high=1us", "0 to 3"),
    ("config axis=0 step_high=1", "must be 1 to 65535"),
    ("config clock_hz=3", "clock_hz must be"),
    ("table 16 1", "row must be"),
    ("turn axis=9 steps_per_turn=200 rpm=1 acceleration=1", "0 to 3"),
    ("rpm 5", "NOT_TURNING"),
    ("\x01\x02", "not printable"),
    ("x" * 256, "longer than 255"),
    ("move " + "9" * 3000, "longer than 255"),
]


def test_nonsense_is_refused_and_nothing_happens() -> None:
    """Each invalid line gives one `error:` line with the reason; the console keeps working."""
    board = model_board()
    board.must(MOVE)
    board.wait_motion(0.1)
    board.events()
    for line, reason in REFUSED:
        answer = board.ask(line, 4.0)
        assert answer.startswith("error:") and reason in answer, (line[:60], answer)
    board.run(0.05)
    assert not len(board.events()), "a refused line made pulses"
    assert board.positions() == [100, -50, 0, 0]
    board.must(MOVE)
    board.wait_motion(0.1)
    assert board.positions() == [200, -100, 0, 0]
    assert board.resets == [(0, "power")] and not board.faults


@pytest.mark.parametrize("burst", [4, 30])
def test_line_that_lost_characters_is_refused(burst: int) -> None:
    """Noise on the serial line: the line is not executed, although it still makes sense without what was
    damaged."""
    board = model_board()
    line, rest = "move steps=", "100,-50 profile=linear total_time=0.01 ramp_time=0.002"
    since = len(board.output)
    board.type(line)
    board.type("0" * burst, damaged=True)
    board.type(rest + "\r")
    board.run_until(lambda: board.output[since:].endswith("\n"), 1.0)
    assert board.output[since:].startswith("error:")
    board.run(0.05)
    lost = board.must("status").partition("lost_bytes=")[2]
    assert int(lost) > 0
    assert board.positions() == [0, 0, 0, 0]
    board.must(line + "0" * burst + rest)
    board.wait_motion(0.1)
    assert board.positions() == [100, -50, 0, 0]


def test_flood_of_lines_loses_no_answer() -> None:
    """200 lines without a pause at the full baud rate: each is answered, or refused for lost characters."""
    board = model_board()
    since = len(board.output)
    board.type("position\r" * 200)
    board.run_until(lambda: not board.usart.typing, 2.0)
    board.run(0.2)
    answers = [line for line in board.output[since:].splitlines() if line]
    assert all(line.startswith(("ok position=0,0,0,0", "error:")) for line in answers), answers[:5]
    board.ask("", 0.1)  # ends the last line, whose end may be among the lost
    lost = int(board.must("status").partition("lost_bytes=")[2])
    assert len(answers) == 200 or lost


def test_the_core_hears_from_a_board_that_has_much_to_say() -> None:
    """The watchdog of a core with inputs, half a second, is fed between long answers at the slowest rate."""
    board = Board(model_engine(Parameters(inputs=1), HZ), fast=False)
    board.must("jog axis=0 speed=5000 acceleration=100000")
    board.type("help\rhelp move\rhelp\rhelp config\r" * 2)
    board.run(3.5)
    assert board.output.count("  move [method=in_time]") == 2
    status = board.must("status")
    assert "state=RUN" in status and "fault=OK" in status
    board.must("jog_cancel")
    board.run(0.2)
    assert "state=IDLE cause=NONE" in board.must("status")


def test_home_by_the_firmware() -> None:
    """A switch that comes: its line is answered when the axis is home."""
    engine = model_engine(Parameters(inputs=1), HZ)
    board = Board(engine)
    board.must("config stop_time=2ms")
    board.must("input axis=1 home=active_low")
    engine.set("home", 2)
    board.type("home axis=1 distance=-2000 back_off=20 speed=5000 slow_speed=500 acceleration=99999\r")
    since = len(board.output)
    board.run(0.1)
    for level, seconds in ((0, 0.02), (2, 0.06), (0, 0.05)):  # found, backed off, found again
        assert "ok" not in board.output[since:] and "error" not in board.output[since:]
        engine.set("home", level)
        board.run(seconds)
    assert "ok" in board.output[since:]
    assert "homed=1" in board.must("status")


def test_a_move_waits_for_room() -> None:
    """Each line after the answer of the one before: none is refused, and the motion does not pause."""
    board = model_board()
    count = 200
    for _ in range(count):
        board.must("move steps=20,-10 profile=linear total_time=0.004 ramp_time=0.001")
    board.run(0.1)
    assert board.positions() == [20 * count, -10 * count, 0, 0]
    starts = [motion.start for motion in motions(board.events())]
    assert len(starts) == count and max(np.diff(starts)) < 1.01 * 0.004 * HZ


def test_urgent_lines_pass_a_move_that_waits() -> None:
    """Status and hold are answered immediately, the move when the motion has continued."""
    board = model_board()
    long = "move steps=100 profile=linear total_time=0.1 ramp_time=0.02"
    for _ in range(5):
        board.must(long)
    since = len(board.output)
    board.type(long + "\r")
    board.run(0.02)
    assert board.output[since:] == ""
    assert " waiting=1" in board.ask("status", 0.01)
    assert board.ask("hold", 0.01) == "ok"
    board.run(0.3)
    assert " waiting=1" in board.ask("status", 0.01)
    assert board.ask(long, 0.01).startswith("error: WAITING: ")
    since = len(board.output)
    assert board.ask("resume", 0.01) == "ok"
    board.run(0.15)
    assert board.output[since:].split() == ["ok", "ok"]
    board.run(0.6)
    assert board.positions() == [600, 0, 0, 0]


def test_core_is_missing() -> None:
    """The console reports it, refuses moves, and finds the core when it appears."""
    machine = Machine(firmware_elf(), None)
    machine.run(START)
    assert "note: STUCK_LOW" in machine.output  # PA6 is pulled down
    assert "core=none fault=STUCK_LOW" in machine.command("version", 1.0, "\n"), machine.output
    for line in (MOVE, "position", "stop"):
        assert "error: NOT_OPEN" in machine.command(line, 1.0, "\n"), machine.output
    machine.run(2.0)
    assert machine.resets == [(0, "power")]


@pytest.mark.parametrize(
    ("registers", "name"),
    [
        ({0: 0x12345678}, "NOT_PASSO"),
        ({1: 0x00020000}, "VERSION"),
        ({2: 0x04080000}, "PARAMETERS"),
    ],
)
def test_core_is_another_one(registers: dict[int, int], name: str) -> None:
    """Something else answers, or a core of another version or with impossible parameters: no move is made."""
    engine = model_engine(PARAMETERS, HZ)
    machine = Machine(firmware_elf(), engine)
    machine.wires.pretend = registers
    machine.run(START)
    assert f"note: {name}" in machine.output
    assert "error:" in machine.command(MOVE, 1.0, "\n")
    machine.run(0.05)
    assert not machine.events()["step"].any()


@pytest.mark.parametrize(
    "parameters",
    [Parameters(axes=8), Parameters(axes=2), Parameters(axes=3, tick_log2=9), Parameters(axes=2, channels=2)],
)
def test_core_has_other_parameters(parameters: Parameters) -> None:
    """The firmware asks the core for its axes, ticks and queues."""
    board = Board(model_engine(parameters, HZ))
    board.must(MOVE)
    board.wait_motion(0.1)
    assert board.positions() == [100, -50, *[0] * (parameters.axes - 2)]
    too_many = ",".join(["1"] * (parameters.axes + 1))
    assert "axes" in board.ask(f"move steps={too_many} profile=linear total_time=0.01 ramp_time=0")


@pytest.mark.parametrize(("level", "name"), [(0, "STUCK_LOW"), (1, "STUCK_HIGH")])
def test_miso_is_stuck(level: int, name: str) -> None:
    """Each command is refused with the reason; afterwards the position is as it was, and moves are made."""
    board = model_board()
    board.must(MOVE)
    board.wait_motion(0.1)
    board.wires.stuck = level
    for line in ("position", MOVE, "stop"):
        answer = board.ask(line, 2.0)
        assert answer.startswith("error:") and name in answer, (line, answer)
    board.events()
    board.wires.stuck = None
    board.run(0.6)
    board.must("open")
    board.run(0.05)
    assert not board.events()["step"].any(), "a refused move was made"
    if board.ask("status").partition("state=")[2].startswith("STOPPED"):
        board.must("clear")
    assert board.positions() == [100, -50, 0, 0]
    board.must(MOVE)
    board.wait_motion(0.1)
    assert board.positions() == [200, -100, 0, 0]
    assert len(board.resets) == 1 and not board.faults


def test_every_move_arrives_exactly_once_over_a_noisy_wire() -> None:
    """1 of 10,000 bits is flipped in both directions: no move is lost or made twice."""
    board = model_board(seed=random_cases.seed())
    board.wires.flip_rate = 1e-4
    rng = random.Random(random_cases.seed())
    position = [0] * PARAMETERS.axes
    for _ in range(100):
        steps = [rng.randint(-60, 60) or 1 for _ in position]
        line = f"move steps={','.join(map(str, steps))} profile=cosine total_time=0.004 ramp_time=0.001"
        board.must(line)
        position = [p + s for p, s in zip(position, steps, strict=True)]
    board.run(0.3)
    assert board.wires.flipped > 20
    assert board.positions() == position
    made = motions(board.events())
    assert len(made) == 100
    for axis, expected in enumerate(position):
        assert sum(int(motion.steps(axis)[1].sum()) for motion in made) == expected
    retries = int(board.must("status").partition("retries=")[2].split()[0])
    assert retries > 0
    assert len(board.resets) == 1


def test_watchdog_resets_firmware_that_hangs() -> None:
    """An endless loop in the middle of a motion: the chip is reset, the core ends the motion by itself."""
    board = model_board()
    board.must("move steps=1000 profile=linear total_time=1.5 ramp_time=0.1")
    board.run(0.1)
    board.hang()
    began = board.seconds
    board.run_until(lambda: len(board.resets) > 1, 3.0)
    (_, _), (_, cause) = board.resets
    assert cause == "watchdog"
    assert 0.5 < board.seconds - began < 1.2
    since = len(board.output)
    board.baud = 115_200
    board.expect("note: reset by watchdog", 0.5, since)
    board.run(1.5)
    board.ask("open")
    assert motions(board.events())[0].clocks > 1.4 * HZ
    board.must(f"config clock_hz={HZ}")
    assert board.positions() == [1000, 0, 0, 0]
    board.must(MOVE)
    board.wait_motion(0.1)
    assert board.positions() == [1100, -50, 0, 0]


def test_fault_of_the_firmware_resets_it() -> None:
    """A jump to nowhere: the fault handler notes exception and address, and resets."""
    board = model_board()
    since = len(board.output)
    board.jump(0x30000000)
    board.baud = 115_200
    board.expect("note: reset by fault", 0.5, since)
    board.run(0.1)
    assert "exception 3" in board.output[since:]
    assert len(board.faults) == 1 and board.resets[-1][1] == "software"


def test_crystal_is_broken() -> None:
    """The firmware says so and works at 64 MHz, with the baud rate as it should be."""
    board = model_board(crystal=False)
    assert "note: no crystal" in board.output
    board.must(MOVE)
    board.wait_motion(0.1)
    assert board.positions() == [100, -50, 0, 0]


def test_processor_has_little_to_do_during_a_motion() -> None:
    """A second at a million steps/s on all axes: below 1 % of the processor."""
    hz = 200_000_000
    board = Board(model_engine(PARAMETERS, hz))
    for axis in range(PARAMETERS.axes):
        board.must(f"config axis={axis} step_high=50clocks step_low=50clocks")
    board.must("move steps=990000,990000,990000,990000 profile=linear total_time=1 ramp_time=0.01")
    board.run(0.02)
    executed, began = board.instructions, board.now
    board.run(0.9)
    load = (board.instructions - executed) * board.cpu.step / (board.now - began)
    assert isinstance(board.wires.core, Engine) and board.wires.core.running
    assert load < 0.01, f"{100 * load:.2f} %"


def test_it_fits_and_the_page_says_how_large_it_is() -> None:
    """`make firmware` ends well: flash, RAM, and the stack by all calls, those by pointer included."""
    said = memory_report()
    page = (paths.docs / "firmware.md").read_text(encoding="utf-8")
    for name, row in (("flash", "flash"), ("RAM", "RAM without stack"), ("stack", "worst-case stack")):
        (size,) = re.findall(rf"^{name} +(\d+) of", said, re.M)
        assert f"| {row} | {int(size):,} |" in page, f"docs/firmware.md: {row} is {int(size):,}"


@pytest.mark.parametrize("sclk_hz", [9_000_000, 18_000_000])
def test_lines_are_streamed_at_the_speed_of_the_wire(sclk_hz: int) -> None:
    """The program of `make firmware-bench`: frames are prepared while others are on the wire."""
    rate, limit = bench.lines_per_second(sclk_hz)
    assert 0.85 * limit < rate < limit


def test_a_stream_by_dma_makes_the_same_pulses() -> None:
    """Of a processor that prepares frames while others are on the wire, and of one that waits for each."""
    count, substeps, seconds = 400, 500, 0.02
    machine = Machine(bench.stream_elf(), model_engine(bench.PARAMETERS, bench.HZ))
    machine.run(0.01)
    for name, value in {"substeps": substeps, "fast": 1, "lines": count, "go": 1}.items():
        machine.write_memory(machine.elf.symbols[f"stream_{name}"], value.to_bytes(4, "little"))
    machine.run(seconds)

    engine = model_engine(bench.PARAMETERS, bench.HZ)
    driver = Driver(engine)
    for axis in range(bench.PARAMETERS.axes):
        driver.configure_axis(axis, PinTiming(36, 36, 36, 36))
    driver.stream(Source(*stream_items(count, substeps)))
    with pytest.raises(DriverError, match="TIMEOUT"):  # the ramp is longer than the lines
        driver.wait(seconds)
    pulses = step_edges(machine.events())
    assert np.array_equal(pulses, step_edges(engine.drain()))
    assert len(pulses) == 2 * count


def step_edges(events: np.ndarray) -> np.ndarray:
    """Clocks since the first, and levels, of all changes of STEP."""
    step = events["step"].astype(np.int64)
    changed = np.flatnonzero(np.diff(step, prepend=0))
    clocks = events["clock"][changed].astype(np.int64)
    return np.stack([clocks - clocks[0], step[changed]], axis=1)


def stream_items(count: int, substeps: int) -> tuple[list[Any], list[Any]]:
    """The lines and ramps of benchmarks/stm32_stream.c."""
    lines = [ffi().new("struct passo_line *", {"substeps": substeps, "steps": [1] * 4}) for _ in range(count)]
    lines[-1].last = True
    fast = {"velocity_end": 1 << 47}
    cruise = {**fast, "ticks": 1 << 24, "progress_step": 1 << 24, "last": True}
    ramps = [ffi().new("struct passo_ramp *", fields) for fields in (fast, cruise)]
    return [line[0] for line in lines], [ramp[0] for ramp in ramps]
