# SPDX-License-Identifier: MIT
"""The console of the STM32 bridge, on the PC, over the C model."""

import os
import random
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator, Sequence
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import passo
import pytest
from passo import registers as r
from passo.build import Parameters
from passo.engine import model_engine, rtl_engine
from passo.machine import Machine, Switch
from passo.move_file import read_channels, read_moves
from passo.move_forms import FORMS
from passo.moves import MoveFile, MoveFileError, q32
from passo.native import console, ffi
from passo.plan import plan_file
from passo.run import execute, open_engine
from passo.shafts import Shaft, Shafts
from passo.terminal import Terminal, talk
from passo.toolchain import paths

CLOCK_HZ = 4_000_000
EXAMPLES = sorted(path for path in paths.examples.glob("*.toml") if not read_channels(path).setup)
IN_TIME = "move steps=200,-120 profile=cosine total_time=0.05 ramp_time=0.02"
ZEROS = ",".join("0" * 16)


class Bench:
    """A terminal that records its output."""

    def __init__(
        self,
        clock_hz: int = CLOCK_HZ,
        axes: int = 4,
        channels: int = 1,
        inputs: int = 0,
        switches: Sequence[Switch] = (),
        shafts: Sequence[Shaft] = (),
        tells: bool = False,  # the core its clock
        **parts: int,  # encoders, outputs
    ):
        self.said: list[str] = []
        told = clock_hz if tells else 0
        parameters = Parameters(channels=channels, axes=axes, inputs=inputs, clock_hz=told, **parts)
        self.engine = model_engine(parameters, clock_hz)
        self.machine = Machine(self.engine, switches)  # only with inputs
        self.terminal = Terminal(
            self.machine if inputs else self.engine,
            self.said.append,
            keep=True,
            shafts=Shafts(self.engine, shafts) if shafts else None,
        )
        self.greeting = self.take()

    def take(self) -> str:
        """The output since the last call."""
        text = "".join(self.said)
        self.said.clear()
        return text

    def ask(self, line: str) -> str:
        """The answer to a line, without what comes before it."""
        self.terminal.line(line)
        text = self.take()
        assert text.endswith("\n")
        lines = [one for one in text.splitlines() if not one.startswith("note: ")]
        assert re.match(r"ok\b|error: ", lines[-1]), text
        assert all(one.startswith("  ") for one in lines[:-1]), text
        return lines[-1]

    def tell(self, line: str) -> dict[str, str]:
        """The values of the answer, which must be ok."""
        answer = self.ask(line)
        assert answer.split(" ")[0] == "ok", answer
        return dict(word.split("=") for word in answer.split(" ")[1:])

    def close(self) -> None:
        self.terminal.close()
        self.engine.close()


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench()
    yield made
    made.close()


def pulses_of(events: np.ndarray, axes: int, channel: int = 0) -> list[tuple[int, int, int]]:
    """Clock since `running` rose, axis and direction bit of each step of a channel with `axes` axes."""
    running = np.diff(events["running"].astype(int) >> channel & 1, prepend=0)
    start = int(events["clock"][running > 0][0])
    found = []
    for axis in range(axes):
        pin = channel * axes + axis
        rising = np.diff((events["step"] >> pin & 1).astype(int), prepend=0) > 0
        found += [
            (int(clock) - start, axis, int(direction) >> pin & 1)
            for clock, direction in zip(events["clock"][rising], events["dir"][rising], strict=True)
        ]
    return sorted(found)


def lasted(bench: Bench) -> list[int]:
    """Clocks that each motion lasted."""
    events = bench.terminal.pulses()
    running = np.diff(events["running"].astype(int), prepend=0)
    return list(events["clock"][running < 0] - events["clock"][running > 0])


def line_of(table: dict[str, Any]) -> str:
    """A table of a move file as the console reads it."""

    def show(value: Any) -> str:
        return ",".join(map(show, value)) if isinstance(value, list) else str(value)

    return " ".join(["move", *(f"{key}={show(value)}" for key, value in table.items() if key != "table")])


# ------------------------------------------------------------------------------------------------ moves ----


def moves_of_examples() -> list[tuple[str, int]]:
    """Name of the file, and number of the move in it, from 1 on."""
    return [
        (path.stem, file.number(i))
        for path in EXAMPLES
        for file in read_channels(path).files
        for i in range(len(file.moves))
    ]


@pytest.mark.parametrize(("name", "number"), moves_of_examples())
def test_a_move_makes_the_pulses_of_its_move_file(name: str, number: int) -> None:
    """Each move of the examples: the same steps on the same clocks as `passo run` makes of it."""
    path = paths.examples / f"{name}.toml"
    table = tomllib.loads(path.read_text(), parse_float=Decimal)["move"][number - 1]
    ((file, move),) = [
        (file, move)
        for file in read_channels(path).files
        for i, move in enumerate(file.moves)
        if file.number(i) == number
    ]
    alone = MoveFile(path, file.clock_hz, file.pins, (move,), file.channel)
    parameters = Parameters(channels=file.channel + 1)
    with open_engine("model", parameters, file.clock_hz) as engine:
        run = execute(alone, plan_file(alone, parameters), engine)
    bench = Bench(file.clock_hz, channels=parameters.channels)
    for axis in range(4):
        pins = " ".join(f"{key}={value}clocks" for key, value in vars(file.pins).items())
        assert bench.ask(f"config axis={axis} channel={file.channel} {pins}") == "ok"
    for row, points in enumerate(chunks(getattr(move, "table", ()))):
        assert bench.ask(f"table {row} {','.join(map(str, points))}") == "ok"
    assert bench.ask(line_of(table)) == "ok"
    assert bench.ask("wait") == "ok"
    made = pulses_of(bench.terminal.pulses(), 4, file.channel)
    wanted = sorted(
        (int(clock), axis, int(direction < 0))
        for axis in range(file.axes)
        for clock, direction in zip(*run.steps(axis), strict=True)
    )
    assert len(wanted) == sum(map(abs, move.steps))
    assert made == wanted
    bench.close()


def chunks(table: tuple[int, ...] | Any) -> list[tuple[int, ...]]:
    return [table[i : i + 16] for i in range(0, len(table), 16)]


def test_moves_are_queued_behind_each_other(bench: Bench) -> None:
    """With flow=refuse moves are accepted until FULL, which changes nothing; all accepted ones are made."""
    assert bench.ask("config flow=refuse") == "ok"
    taken = 0
    while (answer := bench.ask("move steps=10,-5 profile=linear total_time=0.01 ramp_time=0.004")) == "ok":
        taken += 1
    assert answer.startswith("error: FULL: ")
    assert 5 <= taken <= 6  # 16 ramps, three a move, and those of the first have left the queue
    assert bench.ask("wait") == "ok"
    assert bench.tell("position")["position"] == f"{10 * taken},{-5 * taken},0,0"


# --------------------------------------------------------------------------------------------- flow=wait ----

SHORT = "move steps=2,-1 profile=linear total_time=0.001 ramp_time=0.0003"
LONG = "move steps=100 profile=linear total_time=1 ramp_time=0.2"
WAITING = "error: WAITING: a move waits for queue space: send {} after its answer\n"
MANY = int(os.environ.get("PASSO_CONSOLE_LINES", "1000"))


def test_a_sender_that_waits_for_answers_loses_no_move(bench: Bench) -> None:
    """Each line after the answer of the one before: none is refused. PASSO_CONSOLE_LINES: how many."""
    for _ in range(MANY):
        assert bench.ask(SHORT) == "ok"
    assert bench.ask("wait") == "ok"
    assert bench.tell("position")["position"] == f"{2 * MANY},{-MANY},0,0"


def test_shapes_that_change_wait_for_rest(bench: Bench) -> None:
    """A move that needs another table is not refused either."""
    sigmoid = "move method=sigmoid steps=20 speed=900 accelerate_time=0.01 alpha={}"
    for alpha in (3.25, 4.5, 3.25, 5):
        assert bench.ask(sigmoid.format(alpha)) == "ok"
    assert bench.ask("wait") == "ok"
    assert bench.tell("position")["position"] == "80,0,0,0"


def fill(bench: Bench, line: str = IN_TIME) -> int:
    """Send moves until one waits, without letting time pass; return how many were queued."""
    for queued in range(20):
        bench.terminal.type(f"{line}\n".encode())
        if not (said := bench.take()):
            return queued
        assert said.endswith("ok\n")
    raise AssertionError("no move waits")


def test_urgent_lines_pass_a_move_that_waits(bench: Bench) -> None:
    """Readings, hold, resume and override are answered meanwhile; other lines are refused."""
    queued = fill(bench)
    type_ = bench.terminal.type
    type_(b"status\n")
    assert " waiting=1" in bench.take()
    for line in ("hold", "override 50", "sync 0", "resume", "override 100", ""):
        type_(f"{line}\n".encode())
        assert bench.take() == "ok\n", line
    for line in ("position", "angle 200", "version", "help", "? move"):
        type_(f"{line}\n".encode())
        assert bench.take().splitlines()[-1].startswith("ok"), line
    for line in ("clear", "zero", "enable", "open", "table", "config", "config flow=refuse", "turn", IN_TIME):
        type_(f"{line}\n".encode())
        assert bench.take() == WAITING.format(line.split(" ")[0])
    type_(b"bla\n")
    assert bench.take() == "error: unknown command 'bla'; help lists the commands\n"
    bench.terminal.run(60_000)
    assert bench.take() == "ok\n"  # of the move
    assert bench.tell("status")["waiting"] == "0"
    assert bench.ask("wait") == "ok"
    assert bench.tell("position")["position"] == f"{200 * (queued + 1)},{-120 * (queued + 1)},0,0"


@pytest.mark.parametrize("how", ["stop", "abort"])
def test_a_stop_answers_the_move_that_waits(bench: Bench, how: str) -> None:
    """First the stop, then the move, which is not made."""
    fill(bench)
    bench.terminal.type(f"{how}\n".encode())
    assert bench.take() == "ok\nerror: STOPPED: the channel is stopped: clear it first\n"
    bench.terminal.run(200_000)
    assert bench.take() == ""
    assert bench.ask("clear") == "ok"
    before = bench.tell("position")
    bench.terminal.run(200_000)
    assert bench.tell("position") == before


def test_a_broken_wire_answers_the_move_that_waits(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the error of the wire; the moves that were queued are made."""
    queued = fill(bench)
    with monkeypatch.context() as patch:
        patch.setattr(bench.engine, "transfer", lambda mosi, gap: [0] * len(mosi))
        bench.terminal.run(20_000)
        wire = "STUCK_LOW: MISO stays low: no core, no power or no connection\n"
        assert bench.take() == f"note: {wire}error: {wire}"
    bench.terminal.run(500_000)
    assert bench.take() == "note: the core answers\n"
    assert bench.tell("position")["position"] == f"{200 * queued},{-120 * queued},0,0"


def test_a_lost_stop_answers_the_move_that_waits(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """The stop is resent, and the move is refused immediately."""
    fill(bench)
    with monkeypatch.context() as patch:
        patch.setattr(bench.engine, "transfer", lambda mosi, gap: [0] * len(mosi))
        bench.terminal.type(b"stop\n")
        stop, move = bench.take().splitlines()
        assert stop.startswith("error: STUCK_LOW: ")
        assert move.startswith("error: NOT_STOPPED: ")


def test_a_core_that_is_reset_answers_the_move_that_waits(bench: Bench) -> None:
    """Another core, fresh from its reset, on the same wires."""
    fill(bench)
    old = bench.engine
    with model_engine(old.parameters, old.clock_hz) as other:
        bench.terminal.engine = other
        bench.terminal.run(20_000)
        notes, answer = bench.take().splitlines()
        assert notes.startswith("note: CORE_RESET: ") and answer.startswith("error: CORE_RESET: ")
        bench.terminal.engine = old


def test_a_held_motion_leaves_the_move_waiting(bench: Bench) -> None:
    """On the PC the next lines are read: they can let it go on, and it is then answered, after them."""
    queued = fill(bench, LONG)
    bench.terminal.line("hold")
    note = "note: the move waits: the motion does not go on: it is held, or waits for the sync input\n"
    assert bench.take() == "ok\n" + note
    bench.terminal.line("status")
    assert "state=RUN" in (said := bench.take()) and said.count("\n") == 1
    bench.terminal.line("resume")
    assert bench.take() == "ok\nok\n"
    assert bench.ask("wait") == "ok"
    assert bench.tell("position")["position"] == f"{100 * (queued + 1)},0,0,0"


def test_the_end_of_the_input_answers_the_move_that_waits(bench: Bench) -> None:
    """No line stays without an answer."""
    fill(bench, LONG)
    talk(["hold"], bench.terminal)
    assert bench.take().splitlines()[-1].startswith("error: the motion does not go on")


def test_a_move_that_never_fits_is_refused() -> None:
    """More ramps than the core has places: FULL at rest, not a wait without end."""
    with model_engine(Parameters(ramp_queue_log2=2), CLOCK_HZ) as engine:
        said: list[str] = []
        with Terminal(engine, said.append) as terminal:
            said.clear()
            terminal.line("move method=jerk steps=900 speed=900 acceleration=3000 jerk=9e5")
        assert "".join(said).splitlines()[-1].startswith("error: FULL: ")


# ------------------------------------------------------------------------- the same words as move files ----

GOOD: dict[str, dict[str, str]] = {
    "in_time": {"steps": "10,-4", "profile": "linear", "total_time": "0.01", "ramp_time": "0.002"},
    "by_speed": {
        **{"steps": "10,-4", "profile": "cosine", "start_speed": "100", "speed": "3000", "stop_speed": "50"},
        **{"acceleration": "40000", "deceleration": "30000"},
    },
    "below_speed": {"steps": "7", "profile": "sigmoid", "total_time": "0.01", "speed": "1000"},
    "at_speed": {"steps": "7,7", "profile": "jerk", "speed": "1000", "ramp_time": "0.001"},
    "axes": {"steps": "3,8", "start_speed": "10", "speed": "5000", "ramp_time": "0.01"},
    "turn": {
        **{"axis": "1", "axes": "3", "steps_per_turn": "1600", "angle": "-10.5", "rpm": "60"},
        **{"minimum_rpm": "1", "acceleration": "20000"},
    },
    "sigmoid": {
        **{"steps": "30,4", "start_speed": "40", "speed": "5000", "stop_speed": "40"},
        **{"accelerate_time": "0.01", "decelerate_time": "0.02", "alpha": "3.5"},
    },
    "jerk": {
        **{"steps": "30,4", "start_speed": "40", "speed": "5000", "stop_speed": "40"},
        **{"acceleration": "100000", "jerk": "8000000"},
    },
    "straight": {
        **{"distance": "1.5,-0.25", "feed": "100", "steps_per_mm": "80,40", "speed": "200"},
        **{"acceleration": "3000,2000", "jerk": "60000"},
    },
}
NUMBERS = (
    *(
        "0",
        "1",
        "-1",
        "-0",
        "3.5",
        "0.5",
        "1e-6",
        "1e3",
        "20_000",
        "4294967295",
        "4294967295.5",
        "4294967296",
    ),
    *(
        "1e20",
        "0.0000000000000000000000000000001",
        "1e-31",
        "1073741823",
        "1073741824",
        "2147483647",
        "2147483648",
        "-2147483647.5",
        "+4",
    ),
)
LISTS = (
    *NUMBERS,
    "1,2,3",
    "1,2",
    "0,0",
    "1073741823,-4",
    "1,-1073741824",
    "2147483648,1",
    "1.5,2",
    "1,2,3,4,5,6,7,8,9",
    "-3",
)


def toml_of(values: dict[str, str]) -> str:
    """The same values as a table of a move file."""

    def show(key: str, value: str) -> str:
        if key in ("steps", "distance") or "," in value:
            return f"[{value.replace(',', ', ')}]"
        return f'"{value}"' if key in ("profile", "method") else value

    rows = "".join(f"{key} = {show(key, value)}\n" for key, value in values.items())
    return f"clock_hz = {CLOCK_HZ}\n[[move]]\n{rows}"


def problem_of_file(path: Path, values: dict[str, str]) -> str:
    """Error of `passo run` for a move; empty if it is accepted."""
    path.write_text(toml_of(values))
    try:
        plan_file(read_moves(path), Parameters(axes=8))
    except MoveFileError as error:
        return str(error).removeprefix(f"{path}: ").removeprefix("move 1: ")
    return ""


def broken(random_: random.Random) -> dict[str, str]:
    """A valid move with up to two errors."""
    method = random_.choice(list(GOOD))
    values = dict(GOOD[method])
    if method not in ("in_time", "by_speed") or random_.random() < 0.3:
        values = {"method": method, **values}
    for _ in range(random_.choice((1, 1, 2))):
        key = random_.choice([key for key in values if key != "method"])
        action = random_.randrange(4)
        if action == 0:
            del values[key]
        elif action == 1:
            other = random_.choice(list(GOOD.values()))
            key = random_.choice(list(other))
            values[key] = other[key]
        elif key == "profile":
            values[key] = random_.choice(("linear", "user", "sinus"))
        else:
            values[key] = random_.choice(LISTS if key in ("steps", "distance", "acceleration") else NUMBERS)
        if len(values) < 2:
            break
    return values


# Differences: the console shows a wrong value as typed, not as Python's repr; a shape is not a file; for an
# unknown key it lists the known ones, where the file suggests one.
DIFFERENT = re.compile(r"profile = \"user\"|must be a (whole )?number, not|table")
UNKNOWN = re.compile(r"unknown (key|method) '.*?'")


@pytest.mark.parametrize("seed", range(4))
def test_errors_are_those_of_move_files(seed: int, tmp_path: Path) -> None:
    """Random moves with errors: console and move file reject them with the same message, or accept them."""
    random_ = random.Random(seed)
    bench = Bench(axes=8)
    bench.ask("config flow=refuse")
    compared = {"": 0}
    for _ in range(300):
        values = broken(random_)
        wanted = problem_of_file(tmp_path / "moves.toml", values)
        line = " ".join(["move", *(f"{key}={value}" for key, value in values.items())])
        answer = bench.ask(line)
        if "FULL" in answer or "TABLE" in answer:
            bench.ask("abort")
            bench.ask("clear")
            answer = bench.ask(line)
        if DIFFERENT.search(wanted):
            assert answer.startswith("error: "), line
        elif unknown := UNKNOWN.match(wanted):
            assert answer.startswith(f"error: {unknown[0]}"), line
        elif wanted.startswith("PINS_TOO_SLOW"):
            assert answer.startswith("error: PINS_TOO_SLOW: "), line
        elif wanted.startswith("steps_per_mm is missing"):
            assert answer.startswith("error: "), line
        elif wanted:
            assert answer == f"error: {wanted}", line
        else:
            assert answer == "ok", line
        kind = re.sub(r"\d+|'.*'", "_", wanted)
        compared[kind] = compared.get(kind, 0) + 1
    print(f"seed {seed}: {compared}")
    assert len(compared) > 25
    bench.close()


# ---------------------------------------------------------------------------------------------- numbers ----


def read_decimal(text: str, power: int = 0) -> Any:
    number = ffi().new("struct passo_decimal *")
    data = text.encode()
    return number if console().passo_decimal_read(number, data, len(data), power) else None


@pytest.mark.parametrize("seed", range(3))
def test_numbers_are_exact(seed: int) -> None:
    """Nearest with ties to even, and rounded up, against fractions: any decimal, any factor."""
    random_ = random.Random(seed)
    for _ in range(3000):
        digits = "".join(random_.choices("0123456789", k=random_.randint(0, 9)))
        decimals = "".join(
            random_.choices("05" if random_.random() < 0.3 else "0123456789", k=random_.randint(0, 30))
        )
        if not digits + decimals:
            continue
        text = (
            random_.choice(("", "-", "+"))
            + digits
            + ("." + decimals if decimals else random_.choice(("", ".")))
        )
        factor = random_.choice((1, 2**32, 4096, random_.randint(1, 2**32)))
        value = abs(Fraction(Decimal(text)))
        number = read_decimal(text)
        assert console().passo_decimal_times(number, factor) == round(value * factor), (text, factor)
        assert console().passo_decimal_times_ceil(number, factor) == -(-value * factor // 1), (text, factor)
        assert number.negative == text.startswith("-")


def test_a_tie_goes_to_even() -> None:
    """As the planner's Python side rounds."""
    number = read_decimal("0.5")
    assert console().passo_decimal_times(number, 1) == 0
    assert console().passo_decimal_times(read_decimal("1.5"), 1) == 2
    assert console().passo_decimal_times(read_decimal("2.500000000000000000000000000001"), 1) == 3


@pytest.mark.parametrize(
    "text",
    [
        "",
        ".",
        "-",
        "+",
        "e5",
        "1e",
        "1e+",
        "1.2.3",
        "1_",
        "_1",
        "1__0",
        "1_.5",
        "0x10",
        "1 ",
        "--1",
        "nan",
        "1e5.0",
    ],
)
def test_what_is_no_number(text: str) -> None:
    """Anything but sign, digits, point and exponent is refused."""
    assert read_decimal(text) is None


@pytest.mark.parametrize(
    ("text", "power"),
    [
        ("12.5e-3", 0),
        ("1e9", -9),
        ("0.000_001e6", 0),
        ("12345678901234567890", -15),
        ("5E+2", 0),
        ("0e99999", 3),
    ],
)
def test_exponents_shift_the_point(text: str, power: int) -> None:
    """The exponent and the unit are powers of ten, and cost nothing."""
    value = Fraction(Decimal(text.replace("_", ""))) * Fraction(10) ** power
    assert console().passo_decimal_times(read_decimal(text, power), 2**32) == q32(value)


def test_huge_numbers_saturate() -> None:
    """They are above every limit, not wrapped."""
    for text in ("99999999999999999999999999", "1e40", "1e99999999999"):
        assert read_decimal(text).whole == 2**64 - 1


# --------------------------------------------------------------------------------------------- commands ----


def test_hold_and_resume_make_the_same_steps(bench: Bench) -> None:
    """A held motion stops; `wait` reports that instead of waiting forever; after resume it continues."""
    bench.ask(IN_TIME)
    bench.ask("run 0.01")
    assert bench.ask("hold") == "ok"
    bench.ask("run 0.06")
    held = bench.tell("position")["position"]
    assert bench.tell("status")["rate"] == "0.000"
    assert bench.ask("wait") == "error: the motion does not go on: it is held, or waits for the sync input"
    assert bench.tell("position")["position"] == held != "200,-120,0,0"
    assert bench.ask("resume") == "ok"
    assert bench.ask("wait") == "ok"
    assert bench.tell("position")["position"] == "200,-120,0,0"


def test_override_slows_down(bench: Bench) -> None:
    """At 50 percent the motion lasts twice as long."""
    for percent in (100, 50):
        bench.ask(f"override {percent}")
        bench.ask("run 0.1")
        bench.ask(IN_TIME)
        bench.ask("wait")
    full, half = lasted(bench)
    assert full == pytest.approx(0.05 * CLOCK_HZ, abs=64)
    assert half == 2 * full


@pytest.mark.parametrize(("command", "cause"), [("stop", "STOP"), ("abort", "ABORT")])
def test_a_stopped_channel_must_be_cleared(bench: Bench, command: str, cause: str) -> None:
    """stop and abort end the motion and drop what is queued; moves are refused until clear."""
    bench.ask("config stop_time=10ms")
    bench.ask(IN_TIME)
    bench.ask(IN_TIME)
    bench.ask("run 0.02")
    assert bench.ask(command) == "ok"
    bench.ask("run 0.1")
    status = bench.tell("status")
    assert (status["state"], status["cause"]) == ("STOPPED", cause)
    assert bench.ask(IN_TIME).startswith("error: STOPPED: ")
    assert bench.ask("clear") == "ok"
    assert bench.tell("status")["state"] == "IDLE"
    x = int(bench.tell("position")["position"].split(",")[0])
    assert 0 < x < 200
    bench.ask(IN_TIME)
    bench.ask("wait")
    assert bench.tell("position")["position"].split(",")[0] == str(x + 200)


def test_zero_sets_the_positions(bench: Bench) -> None:
    """At rest only."""
    bench.ask(IN_TIME)
    assert bench.ask("zero").startswith("error: MOVING: ")
    bench.ask("wait")
    assert bench.ask("zero") == "ok"
    assert bench.tell("position")["position"] == "0,0,0,0"


def test_turning_without_end(bench: Bench) -> None:
    """turn, rpm, rpm 0: angle and speed read back; no other move meanwhile."""
    assert bench.ask("rpm 60").startswith("error: NOT_TURNING: ")
    assert (
        bench.ask("turn axis=1 steps_per_turn=1600 rpm=60 top_rpm=120 acceleration=20000 backward=1") == "ok"
    )
    bench.ask("run 1")
    before = float(bench.tell("angle 1600 axis=1")["angle"])
    assert float(bench.tell("angle steps_per_turn=1600")["rpm"]) == pytest.approx(60, abs=0.01)
    bench.ask("run 1")
    assert float(bench.tell("angle 1600 axis=1")["angle"]) - before == pytest.approx(-360, abs=1.5)
    assert bench.ask(IN_TIME).startswith("error: MOVING: ")
    assert bench.ask("rpm 121").startswith("error: ABOVE_TOP: ")
    assert bench.ask("rpm 120") == "ok"
    bench.ask("run 0.5")
    assert float(bench.tell("angle 1600")["rpm"]) == pytest.approx(120, abs=0.01)
    assert bench.ask("rpm 0") == "ok"
    assert bench.ask("wait") == "ok"
    assert bench.tell("status")["state"] == "IDLE"


def test_sync_holds_moves_back(bench: Bench) -> None:
    """With `sync 1` a move is prepared and waits; `sync 0` lets it go."""
    assert bench.ask("sync 1") == "ok"
    bench.ask(IN_TIME)
    bench.ask("run 0.01")
    assert bench.tell("status")["state"] == "ARMED"
    assert bench.ask("wait").startswith("error: the motion does not go on")
    assert bench.ask("sync 0") == "ok"
    assert bench.ask("wait") == "ok"
    assert bench.tell("position")["position"] == "200,-120,0,0"


def test_enable_switches_the_drives(bench: Bench) -> None:
    """Of one axis or of all, at the pins."""

    def enabled() -> int:
        bench.ask("run 0.001")
        return int(bench.terminal.pulses()["enable"][-1])

    assert bench.ask("enable 2") == "ok"
    assert enabled() == 0b0100
    bench.ask("enable")
    assert enabled() == 0b1111
    bench.ask("disable axis=0")
    assert enabled() == 0b1110
    bench.ask("disable")
    assert enabled() == 0


DISABLED = "note: axis {} is not enabled\n"


def test_a_move_without_its_drives_is_noted(bench: Bench) -> None:
    """Once for each axis that moves, and again after the drive was switched off."""
    for axis in (0, 1):
        bench.ask(f"config axis={axis} steps_per_unit=100")
    bench.ask("enable 3")
    bench.terminal.line("move steps=5,0,0,5 profile=linear total_time=0.01 ramp_time=0.002")
    assert bench.take() == DISABLED.format(0) + "ok\n"
    bench.terminal.line("move method=straight distance=0.1,-0.1 feed=10 speed=10 acceleration=1000")
    assert bench.take() == DISABLED.format(1) + "ok\n"
    bench.terminal.line("move method=turn axis=2 steps_per_turn=1600 angle=9 rpm=60 acceleration=20000")
    assert bench.take() == DISABLED.format(2) + "ok\n"
    bench.ask("enable")
    bench.ask("wait")
    bench.ask("disable 2")
    bench.terminal.line("move steps=5,5,5,5 profile=linear total_time=0.01 ramp_time=0.002")
    assert bench.take() == DISABLED.format(2) + "ok\n"
    bench.ask("wait")
    bench.terminal.line("turn axis=2 steps_per_turn=200 rpm=60 acceleration=9999")
    assert bench.take() == "ok\n"
    bench.ask("rpm 0")
    bench.ask("wait")
    # one that turns continuously, unless it is refused
    bench.ask("enable 3")
    bench.ask("disable 3")
    bench.terminal.line("turn axis=3 steps_per_turn=200 rpm=60 top_rpm=50 acceleration=9999")
    assert bench.take().startswith("error: ABOVE_TOP: ")
    bench.terminal.line("turn axis=3 steps_per_turn=200 rpm=60 acceleration=9999")
    assert bench.take() == DISABLED.format(3) + "ok\n"


def test_a_move_without_its_drives_can_be_refused(bench: Bench) -> None:
    """With need_enable=1 nothing moves unless all its drives are on."""
    assert bench.ask("config need_enable=1") == "ok"
    assert bench.tell("config")["need_enable"] == "1"
    bench.ask("enable 0")
    assert bench.ask(IN_TIME) == "error: NOT_ENABLED: axis 1 is not enabled"
    turn = "turn axis=3 steps_per_turn=200 rpm=60 acceleration=9999"
    assert bench.ask(turn) == "error: NOT_ENABLED: axis 3 is not enabled"
    assert bench.ask("wait") == "ok"
    assert bench.tell("position")["position"] == "0,0,0,0"
    bench.ask("enable 1")
    assert bench.ask(IN_TIME) == "ok"
    assert bench.ask("disable 1").startswith("error: MOVING: ")
    assert bench.ask(IN_TIME) == "ok"
    assert bench.ask("open").startswith("error: MOVING: ")
    assert bench.ask("wait") == "ok"
    assert bench.ask("open") == "ok"
    assert bench.ask(IN_TIME) == "ok"


def test_pin_times_reach_the_pins(bench: Bench) -> None:
    """A step is as long as configured, in clocks or in seconds, rounded up."""
    assert bench.ask("config axis=0 step_high=2.1us step_low=3clocks") == "ok"
    assert bench.tell("config axis=0")["step_high"] == "9clocks"
    assert bench.ask("config axis=1 dir_hold=1ns") == "ok"
    assert bench.tell("config axis=1")["dir_hold"] == "1clocks"
    bench.ask("move steps=3 profile=linear total_time=0.01 ramp_time=0.001")
    bench.ask("wait")
    events = bench.terminal.pulses()
    level = events["step"] & 1
    rises = events["clock"][1:][(level[1:] > level[:-1])]
    falls = events["clock"][1:][(level[1:] < level[:-1])]
    assert list(falls - rises) == [9, 9, 9]


def test_a_refused_setting_changes_nothing(bench: Bench) -> None:
    """If the last key is invalid, none of the others takes effect."""
    before = bench.ask("config axis=2"), bench.ask("config")
    assert (
        bench.ask("config axis=2 step_high=5us step_inverted=1 both_edges=2")
        == "error: both_edges must be 0 to 1"
    )
    assert bench.ask("config hold_time=1ms stop_time=x") == "error: stop_time must be a number, not 'x'"
    assert bench.ask("config hold_time=1ms baud=115200") == "error: not available without a board"
    assert (bench.ask("config axis=2"), bench.ask("config")) == before


def test_only_what_is_given_changes(bench: Bench) -> None:
    """The other settings of the axis stay as they were."""
    bench.ask("config axis=1 step_high=2us enable_inverted=1")
    before = bench.tell("config axis=1")
    assert bench.ask("config axis=1 step_low=3us") == "ok"
    assert bench.tell("config axis=1") == {**before, "step_low": "12clocks"}


def test_what_config_shows_can_be_typed(bench: Bench) -> None:
    """The answer of `config axis=` is a line of its own form."""
    bench.ask("config axis=1 step_high=2us dir_hold=77clocks direction_inverted=1 steps_per_unit=80.125")
    shown = bench.ask("config axis=1").removeprefix("ok ")
    bench.ask("config axis=1 step_high=1us dir_hold=1us direction_inverted=0 steps_per_unit=0")
    assert bench.ask(f"config {shown}") == "ok"
    assert bench.ask("config axis=1").removeprefix("ok ") == shown


def test_hold_time_is_kept(bench: Bench) -> None:
    """From full speed to rest in the configured time."""
    bench.ask("config hold_time=20ms")
    bench.ask("turn steps_per_turn=200 rpm=600 acceleration=100000")
    bench.ask("run 0.1")
    bench.ask("hold")
    bench.ask("run 0.015")
    assert bench.tell("status")["rate"] != "0.000"
    bench.ask("run 0.007")
    assert bench.tell("status")["rate"] == "0.000"


def test_another_clock(bench: Bench) -> None:
    """The core is reopened with default times; the new clock applies to the times of moves."""
    bench.ask("config axis=0 step_high=9us")
    assert bench.ask("config clock_hz=2_000_000") == "ok"
    assert bench.tell("config axis=0")["step_high"] == "2clocks"
    assert bench.tell("version")["clock_hz"] == "2000000"
    assert bench.ask(IN_TIME) == "ok"
    assert bench.ask("config clock_hz=4000000").startswith("error: MOVING: ")
    bench.ask("wait")
    assert lasted(bench) == pytest.approx([0.05 * 2_000_000], abs=64)


def test_core_tells_its_clock() -> None:
    """Times are those of the core; a clock that it does not have is refused, and its own stays."""
    bench = Bench(tells=True)
    assert bench.ask(f"config clock_hz={CLOCK_HZ}") == "ok"
    refused = f"error: CLOCK: the core runs at {CLOCK_HZ} Hz, not 2000000 Hz"
    assert bench.ask("config clock_hz=2_000_000") == refused
    assert bench.ask(IN_TIME).startswith("error: NOT_OPEN")
    assert bench.ask("open") == "ok"
    assert bench.tell("version")["clock_hz"] == f"{CLOCK_HZ}"
    assert bench.tell("config axis=0")["step_high"] == "4clocks"


def test_versions(bench: Bench) -> None:
    """The console has that of the release, the core that of its register map and link."""
    told = bench.tell("version")
    assert told["console"] == passo.__version__
    register_map = (r.VERSION_MAJOR_RESET, r.VERSION_MINOR_RESET, r.VERSION_PATCH_RESET)
    assert told["core"] == "{}.{}.{}".format(*register_map)


def test_version_needs_no_core() -> None:
    """It says what is wrong instead."""
    with model_engine(Parameters(), CLOCK_HZ) as engine, pytest.MonkeyPatch.context() as patch:
        patch.setattr(engine, "transfer", lambda mosi, gap: [0] * len(mosi))
        said: list[str] = []
        with Terminal(engine, said.append) as terminal:
            said.clear()
            terminal.line("version")
        assert "".join(said) == (
            f"ok console={passo.__version__} core=none fault=STUCK_LOW clock_hz={CLOCK_HZ}\n"
        )


def test_table_is_checked(bench: Bench) -> None:
    """Row by row; it must be complete, start at 0 and not decrease."""
    assert bench.ask("table") == "error: table is missing"
    user = "move steps=10 profile=user total_time=0.01 ramp_time=0.002"
    assert bench.ask(user) == "error: table is missing"
    assert bench.ask("table 3") == "error: row and points must be given together"
    assert bench.ask(f"table points={ZEROS}") == "error: row and points must be given together"
    for row in range(16):
        points = ",".join(str((row * 16 + k) * 256) for k in range(16))
        assert bench.ask(f"table {row} {points}") == "ok"
    assert bench.tell("table") == {"mean": "0.500", "symmetric": "1"}
    assert bench.ask(user) == "ok"
    bench.ask("wait")
    assert bench.ask(f"table 7 {ZEROS}") == "ok"
    assert bench.ask("table") == "error: TABLE_FALLS: point 112: A shape must not decrease."
    assert bench.ask(user) == "error: TABLE_FALLS: A shape must not decrease."
    assert bench.tell("position")["position"] == "10,0,0,0"


def test_steps_per_mm_can_come_from_the_settings(bench: Bench) -> None:
    """`straight` without steps_per_mm takes the axis' steps per unit."""
    straight = "move method=straight distance=1.5 feed=10 speed=10 acceleration=1000"
    assert bench.ask(straight).startswith("error: ")
    assert bench.ask("config axis=0 steps_per_unit=80") == "ok"
    assert bench.ask(straight) == "ok"
    bench.ask("wait")
    assert bench.tell("position")["position"] == "120,0,0,0"


def test_a_target_that_changes(bench: Bench) -> None:
    """Faster and further on the way; back; other motions and bad values are refused."""
    bench.ask("enable")
    bench.ask("config stop_time=50ms")
    assert bench.ask("goto 2000 speed=5000 top_speed=10_000 acceleration=100_000") == "ok"
    bench.ask("run 0.1")
    assert bench.ask("goto 4000 speed=10_000 acceleration=100_000 late=50ms") == "ok"
    assert bench.ask("goto 4000 axis=1 speed=10_000 acceleration=100_000").startswith("error: UNDER_WAY: ")
    assert bench.ask("goto 4000 speed=10_001 acceleration=100_000").startswith("error: ABOVE_TOP: ")
    assert bench.ask("goto 4000 speed=0 acceleration=100_000").startswith("error: NO_SPEED: ")
    assert bench.ask("wait") == "ok"
    assert bench.tell("position")["position"].startswith("4000,0,")
    assert bench.ask("goto -100 speed=5000 acceleration=100_000") == "ok"
    bench.ask("run 0.2")
    assert bench.ask("jog_cancel") == "ok"
    assert bench.ask("wait") == "ok"
    assert 2000 < int(bench.tell("position")["position"].split(",")[0]) < 4000
    assert bench.tell("status")["state"] == "IDLE"


def test_help_knows_every_command(bench: Bench) -> None:
    """Each command in the list has help of its own; another one has not."""
    bench.terminal.line("help")
    names = re.findall(r"^  (\w+): ", bench.take(), re.M)
    assert len(names) > 20
    for name in set(names) - {"run", "wait", "pin", "slip"}:
        bench.terminal.line(f"help {name}")
        text = bench.take().replace("[,..]", "").replace(f"  {name} ..", f"  {name}")
        # each key, what it takes, and what it is if left out, in brackets
        keys = re.sub(r" ([\w.]+=[^][ ]+|\[[\w.]+=[^][ ]+(, or [^][]+)?\])(?= |\n)", "", text)
        assert re.fullmatch(rf"(  {name}\n)+ok\n", keys), text
    assert bench.ask("help nothing") == "error: unknown command 'nothing'"


def test_help_shows_every_key_of_every_form(bench: Bench) -> None:
    """Optional keys in brackets; keys of move files only are not listed. Last those of the outputs."""
    bench.terminal.line("help move")
    lines = bench.take().splitlines()
    assert len(lines) == len(FORMS) + 2
    for line, form in zip(lines, FORMS.values(), strict=False):
        assert line.startswith(
            f"  move [method={form.name}] " if form.told_by else f"  move method={form.name} "
        )
        shown = re.findall(r" (\[?)(\w+)=", line)[1:]
        assert [key for _, key in shown] == [key.name for key in form.keys if not key.file_only]
        may_miss = {key for bracket, key in shown if bracket}
        assert may_miss >= {key.name for key in form.keys if key.default is not None}


def test_a_motion_outlives_the_console(bench: Bench) -> None:
    """A console that starts during a motion leaves it alone; at rest it takes the core over."""
    bench.ask(IN_TIME)
    bench.ask("run 0.01")
    bench.terminal.close()
    bench.terminal = Terminal(bench.engine, bench.said.append, keep=True)
    assert "note: MOVING: " in bench.take()
    assert bench.ask(IN_TIME).startswith("error: ")
    assert bench.tell("status")["state"] == "RUN"
    bench.terminal.line("run 0.1")
    assert bench.take() == "note: the core is at rest\nok\n"
    assert bench.tell("position")["position"] == "200,-120,0,0"
    assert bench.ask(IN_TIME) == "ok"
    assert bench.ask("wait") == "ok"
    assert bench.tell("position")["position"] == "400,-240,0,0"


def test_a_broken_wire_is_told_once(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """One note when the link fails, one when it recovers; commands in between report the error."""
    with monkeypatch.context() as patch:
        patch.setattr(bench.engine, "transfer", lambda mosi, gap: [0] * len(mosi))
        bench.terminal.line("run 0.5")
        assert bench.take().splitlines() == [
            "note: STUCK_LOW: MISO stays low: no core, no power or no connection",
            "ok",
        ]
        assert bench.ask("position").startswith("error: STUCK_LOW: ")
    bench.terminal.line("run 0.5")
    assert bench.take() == "note: the core answers\nok\n"
    assert bench.tell("position")["position"] == "0,0,0,0"


@pytest.mark.parametrize("how", ["stop", "abort", "hold"])
def test_a_stop_that_gets_lost(bench: Bench, monkeypatch: pytest.MonkeyPatch, how: str) -> None:
    """It is resent until it is acknowledged; the error in between is reported once."""
    fault = "NOT_HELD" if how == "hold" else "NOT_STOPPED"
    for _ in range(4):
        assert bench.ask(IN_TIME) == "ok"
    bench.ask("run 0.02")
    with monkeypatch.context() as patch:
        patch.setattr(bench.engine, "transfer", lambda mosi, gap: [0] * len(mosi))
        assert bench.ask(how).startswith("error: STUCK_LOW: ")
        bench.terminal.line("run 0.01")
        notes = bench.take().splitlines()
        assert notes[0].startswith(f"note: {fault}: ") and notes[1:] == ["ok"]
        assert bench.ask(IN_TIME).startswith(f"error: {fault}: ")
        assert bench.ask("open").startswith("error: MOVING: ")
    bench.terminal.line("run 0.4")
    assert bench.take() == "note: the core answers\nok\n"
    status = bench.tell("status")
    assert status["fault"] == "OK" and status["rate"] == ("0.000" if how == "hold" else "100.000")
    assert status["state"] == ("RUN" if how == "hold" else "STOPPED")
    assert 0 < int(bench.tell("position")["position"].split(",")[0]) < 400
    if how == "hold":
        assert bench.ask("resume") == "ok"
        assert bench.ask("wait") == "ok"
        assert bench.tell("position")["position"] == "800,-480,0,0"
    else:
        assert bench.ask("clear") == "ok"


def test_open_again(bench: Bench) -> None:
    """Positions and settings survive; in motion it is refused."""
    bench.ask("config axis=1 step_high=3us")
    bench.ask(IN_TIME)
    assert bench.ask("open").startswith("error: MOVING: ")
    bench.ask("wait")
    assert bench.ask("open") == "ok"
    assert bench.tell("position")["position"] == "200,-120,0,0"
    assert bench.tell("config axis=1")["step_high"] == "12clocks"


# ------------------------------------------------------------------------------------------------ lines ----


def test_ends_of_lines(bench: Bench) -> None:
    """LF, CR and CR LF end a line; comments and blanks are ignored."""
    bench.terminal.type(b"version\nversion\rversion\r\n\tversion # or so\r\n\n  # nothing\r\r")
    answers = bench.take().splitlines()
    assert [a[:10] for a in answers] == ["ok console"] * 4 + ["ok"] * 3


def test_backspace_takes_a_character_back(bench: Bench) -> None:
    """BS and DEL; at the beginning of the line they do nothing."""
    bench.terminal.type(b"\b\x7fposx\bition\n")
    assert bench.take() == "ok position=0,0,0,0\n"


@pytest.mark.parametrize("byte", [*range(1, 8), 11, 12, 27, 31, 128, 195, 255])
def test_a_byte_that_is_no_text_spoils_its_line(bench: Bench, byte: int) -> None:
    """The line is refused with the byte's number; the next one is good."""
    bench.terminal.type(b"zero" + bytes([byte]) + b"\nposition\n")
    assert bench.take() == f"error: character {byte} is not printable\nok position=0,0,0,0\n"


def test_a_lost_byte_spoils_its_line(bench: Bench) -> None:
    """The mark of the serial line's driver."""
    bench.terminal.type(b"ze\0ro\n")
    assert bench.take() == "error: bytes of this line were lost\n"


def test_lines_have_255_characters(bench: Bench) -> None:
    """255 are taken, 256 are not, whatever follows; backspace cannot save the line."""
    bench.terminal.type(b"position" + b" " * 247 + b"\n")
    assert bench.take() == "ok position=0,0,0,0\n"
    bench.terminal.type(b"position" + b" " * 300 + b"\b" * 299 + b"\nposition\n")
    assert bench.take() == "error: the line is longer than 255 characters\nok position=0,0,0,0\n"


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("bla", "error: unknown command 'bla'; help lists the commands"),
        ("move=3", "error: unknown command 'move'; help lists the commands"),
        ("hold now", "error: 'now' is not key=value"),
        ("open it=now", "error: key 'it' not allowed here"),
        ("hold it=now", "error: unknown key 'it'; must be one of channel"),
        ("override 50 percent=60", "error: duplicate key percent"),
        ("move steps=1 steps=2", "error: duplicate key steps"),
        ("override =5", "error: missing key before ="),
        ("override 50.0", "error: percent must be a whole number, not '50.0'"),
        ("override percent=", "error: percent must be a whole number, not ''"),
        ("move " + "a " * 24, "error: more than 24 words"),
        (
            "move profile=" + "x" * 60 + " steps=1 total_time=1",
            "error: profile must be one of linear, cosine, sigmoid, jerk, user, not '" + "x" * 40 + "...'",
        ),
        ("move method=straight distance=1,a,3", "error: distance must be a number, not 'a'"),
        ("config axis=0 step_high=1h", "error: step_high must be a number, not '1h'"),
        ("config hold_time=5clocks", "error: hold_time must be in s, ms, us or ns, not '5clocks'"),
        ("config axis=0 step_high=0", "error: step_high is 0 clocks; must be 1 to 65535"),
        ("config axis=0 step_low=0us", "error: step_low is 0 clocks; must be 1 to 65535"),
        ("config axis=0 dir_setup=0clocks", "error: dir_setup is 0 clocks; must be 1 to 65535"),
        ("config axis=0 dir_hold=65536clocks", "error: dir_hold is 65536 clocks; must be 1 to 65535"),
        ("config flow=stop", "error: flow must be wait or refuse, not 'stop'"),
        (
            "config x=5",
            "error: unknown key 'x'; must be one of clock_hz, hold_time, stop_time, flow, need_enable, baud, "
            "spi_slow, input_filter, watchdog, watchdog_disable",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(bench: Bench, line: str, answer: str) -> None:
    """Each error has its message."""
    assert bench.ask(line) == answer


def test_times_have_units() -> None:
    """Seconds, or with a unit, or clocks: the same motion."""
    made = []
    for times in (
        "total_time=0.05 ramp_time=0.02",
        "total_time=50ms ramp_time=20000us",
        "total_time=200000clocks ramp_time=20_000_000ns",
    ):
        bench = Bench()
        assert bench.ask(f"move steps=20 profile=cosine {times}") == "ok"
        bench.ask("wait")
        made.append(pulses_of(bench.terminal.pulses(), 1))
        bench.close()
    assert len(made[0]) == 20
    assert made[0] == made[1] == made[2]


# ------------------------------------------------------------------------------------------ the command ----

SESSION = "move steps=20,-9 profile=cosine total_time=0.001 ramp_time=0.0004\nstatus\nwait\nposition\nbla\n"


def passo_console(text: str, *options: str) -> str:
    """What the command says; everything is built before."""
    Bench().close()
    rtl_engine(Parameters()).close()
    command = [sys.executable, "-m", "passo.cli", "console", *options]
    done = subprocess.run(command, input=text, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_pipe_always_says_the_same() -> None:
    """`passo console` reads lines from a pipe; simulated time makes its answers repeatable."""
    said = passo_console(SESSION, "--engine", "model", "--echo")
    assert said == passo_console(SESSION, "--engine", "model", "--echo")
    assert "> position\nok position=20,-9,0,0\n" in said
    assert said.endswith("> bla\nerror: unknown command 'bla'; help lists the commands\n")


def test_the_verilated_core_answers_like_the_model() -> None:
    """RTL and model under the same console, every word of every frame compared."""
    assert passo_console(SESSION, "--engine", "both") == passo_console(SESSION, "--engine", "model")


def test_the_session_in_the_documentation_is_real() -> None:
    """What docs/console.md shows is what `passo console` says."""
    shown = re.search(r"```text\n(.*?)```", (paths.docs / "console.md").read_text(), re.S)[1]
    typed = "".join(f"{line}\n" for line in re.findall(r"^> (.*)$", shown, re.M))
    assert typed.count("\n") > 15
    assert passo_console(typed, "--engine", "model", "--echo") == shown
