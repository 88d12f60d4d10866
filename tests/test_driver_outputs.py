# SPDX-License-Identifier: MIT
"""Outputs of the driver (stm32_bridge/driver/passo_outputs.h), judged at the pins of the C model."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from passo.build import Parameters
from passo.driver import Driver, DriverError, Source
from passo.engine import EVENT, AroundEngine, model_engine
from passo.native import ffi
from passo.path import Path, PathAxis, PathFeed, PathSettings
from passo.registers import TriggerSource

from tests.helpers.driver_wire import CLOCK_HZ, Q32, Wire, by_speed, error_of, open_driver, path, struct

PARAMETERS = Parameters(inputs=1, encoders=1, outputs=1, raster=1, compare=1)
FULL = 65535


class Pins(AroundEngine):
    """An engine that keeps what its pins do; after the last event they stay."""

    def __init__(self, parameters: Parameters = PARAMETERS) -> None:
        super().__init__(model_engine(parameters, CLOCK_HZ))
        self.kept = [np.zeros(1, EVENT)]

    def transfer(self, mosi: Sequence[int], gap: int = 64) -> list[int]:
        """One chip select."""
        return self.engine.transfer(mosi, gap)

    def run(self, clocks: int) -> int:
        """Let time pass."""
        done = self.engine.run(clocks)
        self.kept.append(self.engine.drain())
        return done

    def look(self) -> "Pins":
        """Take the events so far."""
        self.kept = [np.concatenate([*self.kept, self.engine.drain()])]
        return self

    @property
    def events(self) -> np.ndarray:
        """Those of the last look."""
        return self.kept[0]

    def steps(self, axis: int = 0) -> list[int]:
        """Clocks of the rising edges of STEP."""
        return self.rises("step", axis)

    def rises(self, pin: str, bit: int = 0) -> list[int]:
        """Clocks of rising edges."""
        level = self.events[pin] >> np.uint64(bit) & np.uint64(1)
        return self.events["clock"][1:][(level[1:] == 1) & (level[:-1] == 0)].astype(int).tolist()

    def at(self, pin: str, clocks: list[int]) -> list[int]:
        """Levels at these clocks."""
        index = np.searchsorted(self.events["clock"], clocks, side="right") - 1
        return self.events[pin][index].astype(int).tolist()

    def high(self, pin: str, begin: int, end: int) -> int:
        """Clocks during which a pin is high."""
        clocks = np.clip(np.append(self.events["clock"].astype(np.int64), end), begin, end)
        return int((np.diff(clocks) * (self.events[pin].astype(np.int64) & 1)).sum())


def machine(**options: Any) -> tuple[Driver, Pins]:
    """A driver, its outputs configured."""
    pins = Pins()
    driver = open_driver(pins)
    driver.call("configure_outputs", struct("outputs_config", **({"pwm_hz": 100_000} | options)))
    driver.call("configure_motion", CLOCK_HZ // 500, CLOCK_HZ // 500, 0)
    return driver, pins


def output(**fields: Any) -> Any:
    return struct("output", **fields)


def run(driver: Driver, clocks: int) -> None:
    """Let time pass."""
    done = 0
    while done < clocks:
        done += driver.engine.run(min(clocks - done, 20_000))
        driver.poll()


def test_a_core_without_outputs() -> None:
    """Each call says so; a stream with an output word, too; lines have no word."""
    driver = open_driver(Wire())
    word, taken, values = ffi().new("uint32_t *"), ffi().new("size_t *"), ffi().new("uint8_t[4]")
    for call, *arguments in (
        ("set_output", output()),
        ("output_word", output(), word),
        ("set_levels", 1),
        ("configure_outputs", struct("outputs_config", pwm_hz=1000)),
        ("read_outputs", struct("outputs_state")),
        ("set_pitch", 1),
        ("push_raster", values, 4, taken),
        ("arm_compare", struct("compare_config", interval=1, width=1)),
        ("disarm_compare",),
    ):
        assert error_of(driver, call, *arguments) == "NO_OUTPUTS", call
    lines, ramps = path(3)
    lines[0].output = 1
    driver.stream(Source(lines, ramps))
    with pytest.raises(DriverError, match="NO_OUTPUTS"):
        driver.poll() or driver.poll()


def test_settings_that_contradict() -> None:
    """Each has its error."""
    driver, _ = machine()
    assert error_of(driver, "set_output", output(power=FULL + 1)) == "POWER"
    assert error_of(driver, "set_output", output(power=1, raster=True)) == "POWER"
    for config, name in (
        ({"pwm_hz": 0}, "PWM"),
        ({"pwm_hz": 1}, "PWM"),
        ({"pwm_hz": CLOCK_HZ // 2 + 9}, "PWM"),
        ({"reference": (1 << 31) + 1}, "REFERENCE"),
        ({"lag": 1 << 16}, "LAG_TOO_LONG"),
    ):
        wanted = struct("outputs_config", **({"pwm_hz": 1000} | config))
        assert error_of(driver, "configure_outputs", wanted) == name
    assert error_of(driver, "set_pitch", 0) == error_of(driver, "set_pitch", 1 << 30) == "PITCH"
    for config, name in (
        ({"interval": 0}, "INTERVAL"),
        ({"width": 0}, "PULSE"),
        ({"width": 1 << 16}, "PULSE"),
        ({"axis": 4}, "ARGUMENT"),
    ):
        wanted = struct("compare_config", **({"interval": 5, "width": 5} | config))
        assert error_of(driver, "arm_compare", wanted) == name
    driver.call("move_by_speed", by_speed([5000, 0, 0, 0]))
    for call, *arguments in (
        ("set_levels", 1),
        ("configure_outputs", struct("outputs_config", pwm_hz=1000)),
        ("arm_compare", struct("compare_config", interval=1, width=1)),
        ("disarm_compare",),
    ):
        assert error_of(driver, call, *arguments) == "MOVING", call


def test_a_move_above_its_reference() -> None:
    """Before the outputs are configured, faster than its reference speed, or than that of the core."""
    fast = by_speed([4000, 0, 0, 0], speed=100_000)
    driver = open_driver(Pins())
    driver.call("set_output", output(power=9, proportional=True))
    assert error_of(driver, "move_by_speed", fast) == "REFERENCE"
    driver, _ = machine()
    driver.call("set_output", output(power=9, proportional=True, speed=99_000 * Q32))
    assert error_of(driver, "move_by_speed", fast) == "ABOVE_REFERENCE"
    driver.call("set_output", output(power=FULL, proportional=True, speed=100_000 * Q32))
    assert error_of(driver, "move_by_speed", fast) == "OK"
    driver.wait(1)
    driver.call("configure_outputs", struct("outputs_config", pwm_hz=1000, reference=1 << 30))
    driver.call("set_output", output(power=9, proportional=True))
    assert error_of(driver, "move_by_speed", fast) == "ABOVE_REFERENCE"


def test_each_move_has_its_outputs() -> None:
    """Levels change with the first substep of the move, plus the lag, and are kept."""
    changes = []
    for lag in (0, 5000):
        driver, pins = machine(lag=lag)
        for levels in (5, 0x82, 0xFF):
            driver.call("set_output", output(levels=levels))
            driver.call("move_by_speed", by_speed([300, 0, 0, 0]))
        driver.wait(1)
        steps = pins.look().steps()
        assert len(steps) == 900
        # the first substep of a move is at most half a step before its first step
        assert pins.at("outputs", [steps[i] + lag for i in (0, 300, 600)]) == [5, 0x82, 0xFF]
        assert pins.at("outputs", [steps[i] + lag for i in (299, 599)]) == [5, 0x82]
        clocks = pins.events["clock"][1:][np.diff(pins.events["outputs"].astype(np.int64)) != 0]
        changes.append((clocks.astype(int) - steps[0]).tolist())
    assert changes[1] == [clock + 5000 for clock in changes[0]] and len(changes[0]) == 3
    driver.call("set_levels", 0x11)
    driver.engine.run(1000)
    assert pins.look().events["outputs"][-1] == 0x11
    state = struct("outputs_state")
    driver.call("read_outputs", state)
    assert (state.levels, state.overflow, state.raster_empty, state.raster_room) == (0x11, False, False, 1024)
    # a host that was reset takes over the levels
    driver.open()
    for axis in range(4):
        driver.call("configure_axis", axis, struct("axis_config", step_high_ns=1000, step_low_ns=1000))
    driver.call("move_by_speed", by_speed([10, 0, 0, 0]))
    driver.wait(1)
    assert pins.look().events["outputs"][-1] == 0x11


@pytest.mark.parametrize("speed", [5000, 20_000, 100_000])
def test_energy_per_step(speed: int) -> None:
    """The same from 5 % to 100 % of the reference speed, through ramps, hold and override."""
    driver, pins = machine()
    reference, power = 100_000, 50_000
    driver.call("set_output", output(power=power, proportional=True, speed=reference * Q32))
    count = speed // 50
    driver.call("move_by_speed", by_speed([count, 9, 0, 0], speed=speed, acceleration=10_000_000))
    run(driver, CLOCK_HZ // 200)
    driver.call("hold")
    run(driver, CLOCK_HZ // 200)
    pins.look()
    held = driver.engine.clock
    run(driver, CLOCK_HZ // 1000)
    assert pins.look().high("power", held, driver.engine.clock) == 0
    driver.call("resume")
    driver.call("override", 60)
    driver.wait(5)
    steps = pins.look().steps()
    assert len(steps) == count and driver.positions()[:2] == [count, 9]
    ideal = power / FULL * CLOCK_HZ / reference
    assert pins.high("power", 0, driver.engine.clock) / count == pytest.approx(ideal, rel=0.01)


def test_constant_power_and_stops() -> None:
    """On with the motion; off with a stop, and after it until it is set again; levels stay."""
    driver, pins = machine()
    driver.call("set_output", output(levels=3, power=FULL))
    driver.call("move_by_speed", by_speed([20_000, 0, 0, 0]))
    run(driver, CLOCK_HZ // 200)
    steps = pins.look().steps()
    assert pins.high("power", steps[0], steps[-1]) == steps[-1] - steps[0]
    driver.call("abort")
    driver.engine.run(100)
    off = driver.engine.clock
    driver.call("clear")
    driver.call("move_by_speed", by_speed([500, 0, 0, 0]))
    driver.wait(1)
    pins.look()
    assert pins.high("power", off, driver.engine.clock) == 0
    assert set(pins.at("outputs", list(range(off, driver.engine.clock, 100)))) == {3}


def test_home_jog_and_rotation_have_no_power() -> None:
    """Whatever is set."""
    driver, pins = machine()
    driver.call("set_output", output(levels=9, power=FULL))
    driver.call("configure_inputs", 0, struct("input_config", home=True))
    home = ffi().new("struct passo_home[1]")
    home[0] = {
        "source": TriggerSource.HOME, "distance": -60, "back_off": 10, "speed": 50_000 * Q32,
        "slow_speed": 2000 * Q32, "acceleration": 20_000_000 * Q32,
    }  # fmt: skip
    driver.call("home", home, 1)
    with pytest.raises(DriverError, match="SWITCH_MISSED"):
        driver.wait(1)
    for steps in (60, 0):
        jog = struct("jog", steps=steps, speed=50_000 * Q32, acceleration=20_000_000 * Q32)
        driver.call("jog", jog)
        run(driver, CLOCK_HZ // 500)
        driver.call("jog_cancel")
        driver.wait(1)
    turning = struct("turning", steps_per_turn=200, top_rpm=6000 * Q32, acceleration=5_000_000 * Q32)
    driver.call("turn_start", turning, 6000 * Q32)
    run(driver, CLOCK_HZ // 200)
    driver.call("turn_stop")
    driver.wait(1)
    assert len(pins.look().steps()) > 200
    assert pins.rises("power") == [] and pins.events["outputs"][-1] == 9


def test_raster_values_on_their_steps() -> None:
    """One line, many powers; an empty queue is power 0 and a flag; a stop empties it."""
    driver, pins = machine(pwm_hz=2_000_000)
    values = bytes(255 * (n * 7 % 3 == 0) for n in range(301))
    taken = ffi().new("size_t *")
    sent = 0
    while sent < len(values):
        driver.call("push_raster", values[sent:], len(values) - sent, taken)
        assert taken[0] == min(240, len(values) - sent)
        sent += taken[0]
    state = struct("outputs_state")
    driver.call("read_outputs", state)
    assert state.raster_room == 1024 - 304
    move, plan = by_speed([310 * 4, 0, 0, 0], speed=100_000), struct("plan")
    assert driver.lib.passo_plan_by_speed(driver.lib.passo_machine(driver.c), move, plan) == 0
    driver.call("set_pitch", 4 * plan.oversampling)
    driver.call("set_output", output(raster=True))
    driver.call("move_plan", plan, ffi().NULL)
    driver.wait(1)
    steps = pins.look().steps()
    # a value changes half a step before its first step, half a pitch of a step after its last one
    wanted = [value // 255 for value in values] + [0] * 9
    assert pins.at("power", steps[2 : 4 * 310 : 4])[: len(wanted)] == wanted
    driver.call("read_outputs", state)
    assert state.raster_empty
    driver.call("push_raster", values, 1000, taken)
    driver.call("move_by_speed", by_speed([2000, 0, 0, 0]))
    run(driver, 100_000)
    driver.call("abort")
    assert error_of(driver, "push_raster", values, 4, taken) == "STOPPED"
    driver.call("clear")
    driver.call("read_outputs", state)
    assert state.raster_room == 1024 and not state.raster_empty


def test_a_full_raster_queue() -> None:
    """Takes what fits, then nothing."""
    driver, _ = machine()
    taken = ffi().new("size_t *")
    counts = []
    for _ in range(6):
        driver.call("push_raster", bytes(2000), 2000, taken)
        counts.append(taken[0])
    assert counts == [240, 240, 240, 240, 64, 0]


@pytest.mark.parametrize("zero", [0, -1_000_000])
def test_compare_pulses_at_exact_steps(zero: int) -> None:
    """With the step onto each point, each once, there and back; positions as the program counts them."""
    driver, pins = machine()
    driver.call("set_position", 1, zero)
    config = struct("compare_config", axis=1, position=zero + 100, interval=37, width=50)
    driver.call("arm_compare", config)
    for steps in (400, -300, 600):
        driver.call("move_by_speed", by_speed([0, steps, 0, 0]))
    driver.wait(1)
    edges = pins.look().steps(1)
    way = [1] * 400 + [-1] * 300 + [1] * 600
    position, point, expected = 0, 100, []
    for step, clock in zip(way, edges, strict=True):
        position += step
        if position == point:
            expected.append(clock)
            point += 37
    assert pins.rises("compare") == expected and len(expected) == 17
    assert pins.high("compare", 0, driver.engine.clock) == 50 * 17
    driver.call("disarm_compare")
    driver.call("move_by_speed", by_speed([0, 200, 0, 0]))
    driver.wait(1)
    assert pins.look().rises("compare") == expected


@pytest.mark.parametrize("name", ["in_time", "by_speed", "at_speed", "turn", "sigmoid", "jerk", "straight"])
def test_every_kind_of_move(name: str) -> None:
    """Its lines are taken, and it arrives."""
    driver, _ = machine()
    fields: dict[str, dict[str, Any]] = {
        "in_time": {
            "total_clocks": CLOCK_HZ // 100,
            "accelerate_clocks": 72_000,
            "decelerate_clocks": 72_000,
        },
        "by_speed": {"speed": 50_000 * Q32, "acceleration": 1_000_000 * Q32},
        "at_speed": {"speed": 50_000 * Q32, "ramp_clocks": 72_000},
        "turn": {"angle": 90 * Q32, "steps_per_turn": 1600, "rpm": 300 * Q32, "acceleration": 10**6 * Q32},
        "sigmoid": {
            "speed": 50_000 * Q32,
            "accelerate_clocks": 72_000,
            "decelerate_clocks": 72_000,
            "alpha": 20480,
        },
        "jerk": {"speed": 50_000 * Q32, "acceleration": 10**6 * Q32, "jerk": 10**8 * Q32},
        "straight": {
            "distance": [4 * Q32],
            "feed": 50 * Q32,
            "limits": [{"steps_per_mm": 100 * Q32, "speed": 200 * Q32, "acceleration": 1000 * Q32}] * 4,
        },
    }
    known = {field for field, _ in ffi().typeof(f"struct passo_move_{name}").fields}
    wanted = {field: value for field, value in fields[name].items() if field in known}
    if "steps" in known:
        wanted["steps"] = [400]
    driver.call(f"move_{name}", struct(f"move_{name}", **wanted))
    driver.wait(1)
    assert driver.positions() == [400, 0, 0, 0]


@pytest.mark.parametrize("queue", [4, 7])
def test_a_stream_of_lines_with_outputs(queue: int) -> None:
    """Each line's word with its first step, whatever fits into a frame."""
    pins = Pins(Parameters(outputs=1, raster=1, compare=1, axes=3, line_queue_log2=queue))
    driver = open_driver(pins)
    count = 100
    lines, ramps = path(count, 72)
    word = ffi().new("uint32_t *")
    for n, line in enumerate(lines):
        driver.call("output_word", output(levels=n & 255, power=FULL * (n & 1)), word)
        line.output = word[0]
    driver.stream(Source(lines, ramps))
    driver.wait(5)
    steps = pins.look().steps()
    assert len(steps) == 2 * count and driver.positions() == [2 * count, -count, 0]
    assert pins.at("outputs", steps[1::2]) == [n & 255 for n in range(count)]
    assert pins.at("power", steps[1::2]) == [n & 1 for n in range(count)]
    lines[0].output = 1 << 25 | 1
    driver.stream(Source(lines, ramps))
    with pytest.raises(DriverError, match="SUPPLY"):
        driver.wait(1)


def test_a_path_with_laser_power() -> None:
    """Each line of a path has its word; energy per millimeter is the same on all lines that have power."""
    driver, pins = machine()
    settings = PathSettings((PathAxis(100, 200, 20_000),) * 3, clock_hz=CLOCK_HZ)
    planner = Path(settings, PARAMETERS, 48)
    feed = PathFeed(driver, planner)
    velocity = driver.lib.passo_path_velocity(planner.c, 100 * Q32)
    assert velocity / 2**32 * CLOCK_HZ == pytest.approx(100 * planner.substeps_per_mm, rel=1e-5)
    assert driver.lib.passo_path_substeps(planner.c, Q32 // 4) == round(planner.substeps_per_mm / 4)
    driver.call("configure_outputs", struct("outputs_config", pwm_hz=200_000, reference=velocity))
    word = ffi().new("uint32_t *")
    corners = [(2, 0, 0), (2, 1, 0), (0, 1, 0), (0, 0, 0), (2, 1, 0), (0, 0, 0)]
    for n, corner in enumerate(corners):
        driver.call("output_word", output(levels=n + 1, power=60_000 * (n % 2), proportional=True), word)
        planner.add(corner, 100 if n % 2 else 50, word[0])
    planner.end()
    while feed.is_moving:
        feed.poll()
        driver.engine.run(20_000)
    pins.look()
    assert driver.positions()[:3] == [0, 0, 0]
    changes = [int(pins.events["clock"][np.argmax(pins.events["outputs"] == n + 1)]) for n in range(6)]
    ends = [*changes[1:], driver.engine.clock]
    millimeters = [2, 1, 2, 1, 5**0.5, 5**0.5]
    for n, (begin, end) in enumerate(zip(changes, ends, strict=True)):
        high = pins.high("power", begin, end)
        ideal = 60_000 / FULL * CLOCK_HZ / 100 * millimeters[n] * (n % 2)
        assert high == pytest.approx(ideal, rel=0.01), n
