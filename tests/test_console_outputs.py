# SPDX-License-Identifier: MIT
"""The console on a core with outputs: levels, power, raster, compare pulses, judged at the pins."""

from collections.abc import Iterator

import numpy as np
import pytest
from passo.build import Parameters
from passo.engine import rtl_engine
from passo.move_forms import MACHINES

from tests.test_console import CLOCK_HZ, Bench, passo_console

MOVE = "move steps=400,-90 profile=linear speed=20_000 acceleration=400_000"
COMPARE = "compare axis=0 position=100 interval=37 width=20us"


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench(outputs=1, raster=1, compare=1)
    made.ask("enable")
    yield made
    made.close()


class Pins:
    """What the pins of a bench have done so far."""

    def __init__(self, bench: Bench):
        self.events, self.end = bench.terminal.pulses(), bench.engine.clock
        self.clocks = self.events["clock"].astype(np.int64)

    def level(self, pin: str, bit: int = 0) -> np.ndarray:
        return (self.events[pin] >> np.uint64(bit) & np.uint64(1)).astype(np.int64)

    def rises(self, pin: str, bit: int = 0) -> list[int]:
        """Clocks of rising edges."""
        return self.clocks[np.diff(self.level(pin, bit), prepend=0) > 0].tolist()

    def at(self, pin: str, clocks: list[int]) -> list[int]:
        """Levels at these clocks."""
        return self.events[pin][np.searchsorted(self.clocks, clocks, side="right") - 1].astype(int).tolist()

    def high(self, pin: str, begin: int, end: int) -> int:
        """Clocks during which a pin is high."""
        clocks = np.clip(np.append(self.clocks, self.end), begin, end)
        return int((np.diff(clocks) * self.level(pin)).sum())


def test_a_core_without_outputs_says_so() -> None:
    """Each line, and a move that says what they do; a move that does not is as ever."""
    bench = Bench()
    for line in (
        "output levels=1",
        "output pwm=1000",
        "outputs",
        COMPARE,
        "compare 0",
        f"{MOVE} output.levels=0",
        f"{MOVE} output.raster=1",
    ):
        assert bench.ask(line).startswith("error: NO_OUTPUTS: "), line
    assert bench.ask(MOVE) == "ok"


def test_the_keys_of_a_move_are_those_of_move_files(bench: Bench) -> None:
    """The table `output` of a move file has the same keys, ranges and rules."""
    form = MACHINES["output"]
    bench.terminal.line("help move")
    shown = bench.take().splitlines()[-2]
    assert shown.startswith("  move .. ")
    assert [word.lstrip("[").partition("=")[0] for word in shown.split() if "=" in word] == [
        f"output.{key.name}" for key in form.keys
    ]
    values = {"levels": "1", "power": "9", "speed": "90_000", "raster": "1", "pitch": "1"}

    def ask(*keys: str) -> str:
        return bench.ask(" ".join([MOVE, *(f"output.{key}={values[key]}" for key in keys)]))

    for rule in form.rules:
        if rule.kind == "excludes":
            said = f"error: output.{rule.key} and output.{rule.other} are mutually exclusive"
            assert ask(rule.key, rule.other) == said
        elif rule.kind == "needs":
            assert ask(rule.key) == f"error: output.{rule.key} needs output.{rule.other}"
        else:
            values[rule.key] = "0"
            assert ask(rule.key, "power") == f"error: output.{rule.key} must be greater than 0"
    assert len(form.rules) == 4


@pytest.mark.parametrize(
    ("keys", "problem"),
    [
        ("output.levels=256", "output.levels must be 0 to 255"),
        ("output.power=100.1", "output.power must be at most 100"),
        ("output.power=-1", "output.power must not be negative"),
        ("output.raster=1,256", "output.raster must be 0 to 255"),
        ("output.raster=1,,2", "output.raster must be a whole number, not ''"),
        ("output.raster=" + ",".join("1" * 50), "output.raster has 50 values; the move takes 40"),
        ("output.raster=1 output.pitch=0", "output.pitch must be 1 to 1073741823"),
        ("output.power=5 output.power=6", "duplicate key output.power"),
        ("output.powr=5", "unknown key 'output.powr'; must be one of output.levels, output.power, "),
        ("power=5", "unknown key 'power'"),
        ("output.power=50 output.speed=3000", "ABOVE_REFERENCE: "),
    ],
)
def test_what_a_move_refuses(bench: Bench, keys: str, problem: str) -> None:
    """Each has its sentence, and nothing has moved."""
    assert bench.ask(f"{MOVE.replace('400,-90', '40,-9')} {keys}").startswith(f"error: {problem}")
    assert bench.tell("status")["moving"] == "0"
    assert bench.ask("wait") == "ok"
    assert bench.tell("position")["position"] == "0,0,0,0"
    assert bench.tell("outputs")["raster_room"] == "1024"


def test_more_values_than_a_line_can_have(bench: Bench) -> None:
    """128 at most."""
    said = bench.ask(f"move steps=9 profile=linear speed=9 acceleration=9 output.raster={',' * 128}")
    assert said == "error: output.raster has 129 values; must be 1 to 128"


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("output pwm=0", "PWM: "),
        ("output pwm=0.1", "PWM: "),
        (f"output pwm={CLOCK_HZ}", "PWM: "),
        ("output lag=1s", "LAG_TOO_LONG: "),
        ("output lag=2000s", "LAG_TOO_LONG: "),
        ("output reference=0", "REFERENCE: "),
        ("output reference=0.51", "REFERENCE: "),
        ("output reference=4000", "REFERENCE: "),
        ("output levels=256", "levels must be 0 to 255"),
        (COMPARE.replace("37", "0"), "INTERVAL: "),
        (COMPARE.replace("20us", "0"), "PULSE: "),
        (COMPARE.replace("20us", "1s"), "PULSE: "),
        (COMPARE.replace("axis=0", "axis=4"), "axis must be 0 to 3"),
        ("compare", "position is missing"),
        ("compare position=5", "interval is missing"),
        ("compare position=5 interval=5", "width is missing"),
        ("compare 0 position=5", "compare 0 disarms; it takes no other keys"),
    ],
)
def test_what_the_settings_refuse(bench: Bench, line: str, problem: str) -> None:
    """Each has its error, and nothing has changed."""
    before = bench.ask("output")
    assert before == "ok levels=0 pwm=20000 lag=0clocks reference=0.500"
    assert bench.ask(line).startswith(f"error: {problem}")
    assert bench.ask("output") == before


def test_settings_need_rest(bench: Bench) -> None:
    """Whatever is sent while it moves; the state can be read."""
    bench.ask(MOVE)
    for line in ("output levels=1", "output pwm=1000", COMPARE, "compare 0"):
        assert bench.ask(line).startswith("error: MOVING: "), line
    assert bench.tell("outputs")["levels"] == "0"


def test_what_output_shows_can_be_typed(bench: Bench) -> None:
    """It is kept by `open`; another clock has the settings of the start, and the levels stay."""
    assert bench.ask("output pwm=1000 levels=129 lag=5us reference=0.25") == "ok"
    shown = bench.ask("output")
    assert shown == "ok levels=129 pwm=1000 lag=20clocks reference=0.250"
    assert bench.ask(shown.replace("ok", "output")) == "ok" and bench.ask("output") == shown
    assert bench.ask("open") == "ok" and bench.ask("output") == shown
    assert bench.ask("config clock_hz=2_000_000") == "ok"
    assert bench.ask("output") == "ok levels=129 pwm=20000 lag=0clocks reference=0.500"


def test_levels_of_a_move_are_its_own(bench: Bench) -> None:
    """They change with its first substep plus the lag; a move without has those that were set at rest."""
    assert bench.ask("output levels=8 lag=1ms") == "ok"
    bench.ask("run 0.001")
    began = bench.engine.clock
    for keys in ("output.levels=5", "", "output.levels=255"):
        assert bench.ask(f"{MOVE} {keys}") == "ok"
    bench.ask("wait")
    bench.ask("run 0.002")
    pins = Pins(bench)
    steps = pins.rises("step")
    lag = CLOCK_HZ // 1000
    assert len(steps) == 1200
    assert pins.at("outputs", [steps[i] + lag for i in (0, 399, 400, 799, 800)]) == [5, 5, 8, 8, 255]
    assert pins.at("outputs", [began]) == [8] and bench.tell("outputs")["levels"] == "255"


def test_power_is_constant_or_in_proportion(bench: Bench) -> None:
    """Share of the time, and energy per step; it is that of the move alone."""
    bench.ask("output pwm=100_000")
    for keys in ("output.power=25", "", "output.power=80 output.speed=20_000"):
        bench.ask(f"{MOVE} {keys}")
        bench.ask("wait")
    pins = Pins(bench)
    steps = pins.rises("step")
    power = [pins.high("power", steps[i], steps[i + 399]) for i in (0, 400, 800)]
    assert power[0] / (steps[399] - steps[0]) == pytest.approx(0.25, rel=0.01)
    assert power[1] == 0
    assert power[2] / 399 == pytest.approx(0.8 * CLOCK_HZ / 20_000, rel=0.02)
    rests = pins.clocks[np.diff(pins.level("running"), prepend=0) < 0][-1]
    assert pins.high("power", rests, pins.end) == 0


def test_power_that_the_reference_does_not_reach(bench: Bench) -> None:
    """A lower reference makes room for more power, and limits the speed."""
    assert bench.ask("output reference=0.1") == "ok"
    assert bench.ask(f"{MOVE} output.power=9 output.speed=20_000").startswith("error: ABOVE_REFERENCE: ")
    assert bench.ask("output reference=0.5") == "ok"
    assert bench.ask(f"{MOVE} output.power=9 output.speed=20_000") == "ok"


def test_jog_and_rotation_have_the_levels_and_no_power(bench: Bench) -> None:
    """Also after a move with power."""
    bench.ask("output levels=6")
    bench.ask(f"{MOVE} output.power=100 output.levels=1")
    bench.ask("wait")
    began = bench.engine.clock
    bench.ask("jog axis=0 steps=200 speed=4000 acceleration=100_000")
    bench.ask("wait")
    bench.ask("turn steps_per_turn=200 rpm=600 acceleration=9999")
    bench.ask("run 0.1")
    pins = Pins(bench)
    assert pins.high("power", 0, began) > 0 and pins.high("power", began, pins.end) == 0
    assert pins.events["outputs"][-1] == 6
    raster = bench.ask(f"{MOVE} output.raster=255")
    assert raster.startswith("error: MOVING: ")  # it never ends by itself


def test_a_raster_has_its_values_on_its_steps(bench: Bench) -> None:
    """From the first step on, each `pitch` steps; two moves, the second waits for rest."""
    bench.ask("output pwm=1_000_000")
    rows = [[255 * (i * 7 % 3 == 0) for i in range(count)] for count in (41, 10)]
    for row in rows:
        values = ",".join(map(str, row))
        assert bench.ask(f"{MOVE} output.raster={values} output.pitch=8 output.levels=2") == "ok"
    bench.ask("wait")
    pins = Pins(bench)
    steps = pins.rises("step")
    assert len(steps) == 800
    for row, first in zip(rows, (0, 400), strict=True):
        wanted = [value // 255 for value in row] + [0] * (50 - len(row))
        # the middle of a value is 3.5 steps after the first of its steps
        assert pins.at("power", steps[first + 4 : first + 400 : 8]) == wanted
    assert pins.at("outputs", [steps[5], steps[405]]) == [2, 2]
    state = bench.tell("outputs")
    assert state["raster_empty"] == "1" and state["overflow"] == "0"
    bench.ask("config flow=refuse")
    assert bench.ask(MOVE) == "ok"
    assert bench.ask(f"{MOVE} output.raster=1").startswith("error: FULL: ")


def test_a_raster_that_is_refused_leaves_nothing(bench: Bench) -> None:
    """Neither values in the queue nor a closed gate; a gate that was closed stays so."""
    bench.ask("abort")
    assert bench.ask(f"{MOVE} output.raster=255,255").startswith("error: STOPPED: ")
    bench.ask("clear")
    assert bench.tell("outputs")["raster_room"] == "1024"
    bench.ask("sync 1")
    assert bench.ask(f"{MOVE} output.raster=255,255") == "ok"
    bench.ask("run 0.1")
    assert bench.tell("position")["position"] == "0,0,0,0"
    bench.ask("start")
    bench.ask("wait")
    assert bench.tell("position")["position"] == "400,-90,0,0"
    assert Pins(bench).high("power", 0, bench.engine.clock) > 0


def test_a_raster_of_a_straight_line_in_millimetres(bench: Bench) -> None:
    """The scale may be that of the axis."""
    bench.ask("config axis=1 steps_per_unit=80")
    line = "move method=straight distance=0,1 feed=50 speed=100 acceleration=1000"
    assert bench.ask(f"{line} output.raster=255,0,255 output.pitch=30").startswith("ok")
    bench.ask("wait")
    pins = Pins(bench)
    assert pins.at("power", [pins.rises("step", 1)[i] for i in (15, 45, 75)]) == [1, 0, 1]
    said = bench.ask(f"{line} output.raster=1,2,3,4 output.pitch=30")
    assert said == "error: output.raster has 4 values; the move takes 3"


def test_compare_pulses_on_exact_steps(bench: Bench) -> None:
    """With the step onto each point, as positions are counted; none after `compare 0`."""
    bench.ask(MOVE)
    bench.ask("wait")
    bench.ask("zero")
    assert bench.ask(COMPARE) == "ok"
    bench.ask(MOVE)
    bench.ask("wait")
    pins = Pins(bench)
    edges = pins.rises("step")[400:]
    points = list(range(100, 401, 37))
    assert pins.rises("compare") == [edges[point - 1] for point in points]
    assert pins.high("compare", 0, pins.end) == len(points) * CLOCK_HZ * 20 // 1_000_000
    assert bench.ask("compare 0") == "ok"
    bench.ask(MOVE)
    bench.ask("wait")
    assert len(Pins(bench).rises("compare")) == len(points)


def test_each_channel_has_its_outputs() -> None:
    """The line names it."""
    bench = Bench(outputs=1, raster=1, compare=1, channels=2, axes=2)
    assert bench.ask("output levels=3 channel=1") == "ok"
    assert bench.ask(f"{MOVE} output.levels=9 output.power=100 channel=1") == "ok"
    bench.ask("wait")
    pins = Pins(bench)
    assert pins.level("power", 0).sum() == 0 and pins.level("power", 1).sum() > 0
    assert (bench.tell("output")["levels"], bench.tell("output channel=1")["levels"]) == ("0", "3")
    assert int(pins.events["outputs"][-1]) == 9 << 8


def test_the_command_has_a_core_with_outputs() -> None:
    """--outputs, on the model and on the Verilated core."""
    typed = f"enable\noutput levels=2\n{MOVE} output.power=50\nwait\noutputs\n"
    rtl_engine(Parameters(outputs=1, raster=1, compare=1)).close()  # is built before
    said = {
        engine: passo_console(typed, "--engine", engine, "--outputs", "--clock", "4000000")
        for engine in ("model", "both")
    }
    assert said["model"] == said["both"]
    assert said["model"].endswith("ok levels=2 overflow=0 raster_empty=0 raster_room=1024\n")
