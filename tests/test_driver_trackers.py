# SPDX-License-Identifier: MIT
"""Trackers of the driver (stm32_bridge/driver/passo_track.h): a second hand beside moves and stops."""

import math
import random
from fractions import Fraction
from typing import Any

import pytest
from passo import registers as r
from passo.build import Parameters
from passo.driver import Driver
from passo.engine import model_engine
from passo.machine import Machine, Switch
from passo.native import ffi, planner
from passo.registers import Cause, Operation, State, TriggerSource

from tests.helpers.driver_wire import CLOCK_HZ, Q32, Wire, by_speed, error_of, open_driver, struct
from tests.helpers.random_plans import SEED
from tests.test_driver_home import driver_of, home, run_home

PARAMETERS = Parameters(trackers=1, inputs=1)
SPEED, ACCELERATION = 50_000, 5_000_000  # steps/s, steps/s^2
HARD_STOP_DROPS = 7  # steps of a tracker that were not made, at most


def track(axis: int = 0, backlash: int = 0, speed: int = SPEED, acceleration: int = ACCELERATION) -> Any:
    """The limits of a tracker."""
    return struct(
        "track", axis=axis, backlash=backlash, top_speed=speed * Q32, acceleration=acceleration * Q32
    )


def machine() -> tuple[Driver, Wire]:
    """An open driver."""
    wire = Wire(PARAMETERS)
    driver = open_driver(wire)
    driver.call("configure_motion", wire.clock_hz // 1000, wire.clock_hz // 1000, 0)
    return driver, wire


def finish(driver: Driver, wire: Wire | Machine) -> None:
    """Poll until the path has ended; with trackers a poll may be two frames."""
    end = wire.clock + 2 * wire.clock_hz
    while driver.is_moving:
        assert wire.clock < end, "it does not end"
        driver.poll()
        wire.run(wire.clock_hz // 5000)


def reading(driver: Driver, axis: int = 0) -> Any:
    """What the tracker of an axis does."""
    read = struct("track_reading")
    driver.call("read_tracker", axis, read)
    return read


def settle(driver: Driver, wire: Wire | Machine, axis: int = 0) -> None:
    """Wait until it is at its target."""
    for _ in range(1000):
        wire.run(wire.clock_hz // 10_000)
        read = reading(driver, axis)
        if read.at_target and not read.moves:
            wire.run(wire.clock_hz // 10_000)
            return
    pytest.fail("the tracker does not arrive")


def test_an_axis_is_at_the_sum_of_both_hands() -> None:
    """Moves go where they would go without the tracker; positions are those of the path."""
    driver, wire = machine()
    rng = random.Random(f"trackers {SEED}")
    tracks = [track(axis) for axis in range(4)]
    for one in tracks:
        driver.call("configure_tracker", one)
    at, targets = [0] * 4, [0] * 4
    for _ in range(15):
        steps = [rng.randint(-400, 400) for _ in range(4)]
        driver.call("move_by_speed", by_speed(steps))
        at = [was + step for was, step in zip(at, steps, strict=True)]
        for _ in range(3):
            axis = rng.randrange(4)
            targets[axis] = rng.randint(-100, 100)
            driver.call("track_to", tracks[axis], targets[axis])
            wire.run(rng.randrange(20_000))
            driver.poll()
        finish(driver, wire)
        for axis in range(4):
            settle(driver, wire, axis)
        assert list(driver.positions()) == at
        assert [reading(driver, axis).position for axis in range(4)] == targets
        assert wire.counted()[1] == [a + b for a, b in zip(at, targets, strict=True)]


def test_backlash_is_taken_up_where_the_path_turns() -> None:
    """The screw is where the path is, to the step, after each turn."""
    driver, wire = machine()
    one = track(backlash=12)
    driver.call("configure_tracker", one)
    driver.call("track_to", one, 0)
    at = 0
    for steps, back in ((300, 0), (-200, 12), (-50, 12), (70, 0), (-1, 12)):
        driver.call("move_by_speed", by_speed([steps, 5 * steps, 0, 0]))
        finish(driver, wire)
        settle(driver, wire)
        at += steps
        assert wire.counted()[1][0] == at - back
        assert driver.positions()[0] == at


@pytest.mark.parametrize("hard", [False, True], ids=["soft", "hard"])
def test_a_stop_ends_both_hands(hard: bool) -> None:
    """Nothing moves until the tracker gets its next target."""
    driver, wire = machine()
    one = track()
    driver.call("configure_tracker", one)
    driver.call("move_by_speed", by_speed([0, 20_000, 0, 0], speed=20_000))
    driver.call("track_to", one, 5000)
    wire.run(wire.clock_hz // 50)
    driver.call("abort" if hard else "stop")
    for _ in range(200):
        wire.run(wire.clock_hz // 10_000)
        driver.poll()
    state = driver.snapshot()
    assert (state.state, state.cause) == (State.STOPPED, Cause.ABORT if hard else Cause.STOP)
    stopped = wire.counted()[1]
    assert 100 < stopped[0] < 5000
    assert not reading(driver).enabled
    driver.call("clear")
    wire.run(wire.clock_hz // 10)
    assert wire.counted()[1] == stopped
    off = abs(reading(driver).position - stopped[0])
    assert off <= (HARD_STOP_DROPS if hard else 1)
    before = reading(driver).position
    driver.call("track_to", one, 200)
    settle(driver, wire)
    assert wire.counted()[1][0] - stopped[0] == pytest.approx(200 - before, abs=1)


def test_a_new_session_finds_no_tracker_that_moves() -> None:
    """One of the session before slows down; the next one starts where it rests."""
    driver, wire = machine()
    one = track()
    driver.call("configure_tracker", one)
    driver.call("track_to", one, 1_000_000)
    wire.run(wire.clock_hz // 50)
    other = open_driver(wire)
    wire.run(wire.clock_hz // 10)
    rested = wire.counted()[1][0]
    wire.run(wire.clock_hz // 10)
    assert wire.counted()[1][0] == rested > 100
    assert not reading(other).enabled
    other.call("move_by_speed", by_speed([100, 0, 0, 0]))
    finish(other, wire)
    assert wire.counted()[1][0] == rested + 100


@pytest.mark.parametrize("target", [100, -30])
def test_a_switch_is_found_beside_a_tracker(target: int) -> None:
    """The place of an edge is that of the path, as all positions are: a home ends where it says."""
    rig = Machine(model_engine(PARAMETERS, CLOCK_HZ), [Switch("home", 0, -700)])
    driver = driver_of(rig)
    one = track()
    driver.call("configure_tracker", one)
    driver.call("track_to", one, target)
    settle(driver, rig)
    assert run_home(driver, home(pull_off=50, position=40)) == "OK"
    assert driver.positions()[0] == 90 and reading(driver).position == target
    assert rig.positions[0] == pytest.approx(-650, abs=1)
    driver.call("arm_trigger", struct("trigger_config", source=TriggerSource.HOME))
    driver.call("move_by_speed", by_speed([-400, 0, 0, 0], speed=5000))
    finish(driver, rig)
    report = struct("trigger_report")
    driver.call("read_trigger", report)
    assert report.fired and report.positions[0] == pytest.approx(40, abs=2)


@pytest.mark.parametrize(
    ("axis", "begin", "pull_off", "position"),
    [(0, -600, 50, 40), (3, -720, 0, -7)],
    ids=["off the switch", "on it, without lines"],
)
def test_a_motor_is_homed_by_its_tracker(axis: int, begin: int, pull_off: int, position: int) -> None:
    """Its targets count from the edge then, to the step that the slow approach saw late; others stay."""
    core = Parameters(axes=5, trackers=1, inputs=1, tracked=2) if axis else PARAMETERS
    rig = Machine(model_engine(core, CLOCK_HZ), [Switch("home", axis, -700)])
    driver = driver_of(rig)
    own, other = track(axis), track(axis=1)
    for one, target in ((own, begin), (other, 33)):
        driver.call("configure_tracker", one)
        driver.call("track_to", one, target)
        settle(driver, rig, one.axis)
    speeds = {"slow_speed": 10_000 * Q32, "acceleration": 5_000_000 * Q32}
    task = home(axis=axis, pull_off=pull_off, position=position, track=own, **speeds)
    assert run_home(driver, task) == "OK"
    assert driver.lib.passo_is_homed(driver.c, axis) and not driver.is_moving
    assert set(driver.positions()) == {0}
    if pull_off:
        assert reading(driver, axis).position == pytest.approx(position + pull_off, abs=1)
    for target in (position, position + 100, position):
        driver.call("track_to", own, target)
        settle(driver, rig, axis)
        assert rig.positions[axis] == pytest.approx(-700 + target - position, abs=1)
        assert reading(driver, axis).position == target
    assert reading(driver, 1).position == 33 and rig.positions[1] == 33
    driver.call("track_to", other, 0)
    settle(driver, rig, 1)
    driver.call("zero")
    assert reading(driver, axis).position == 0


@pytest.mark.parametrize("arrives", [False, True])
def test_zero_on_a_dying_wire(arrives: bool) -> None:
    """Executed or not: the tracker is at 0, moves only to its next target, and counts from there."""
    driver, wire = machine()
    one = track()
    driver.call("configure_tracker", one)
    driver.call("track_to", one, 50)
    settle(driver, wire)

    def cut(words: list[int]) -> list[int] | None:
        return None if wire.requests[-1][0] >> 28 == Operation.WRITE else words

    if arrives:
        wire.back = lambda words: cut(words) or [0] * len(words)
    else:
        wire.there = cut
    assert error_of(driver, "zero") == "STUCK_LOW"
    wire.there = wire.back = list
    finish(driver, wire)
    driver.call("track_again")
    wire.run(wire.clock_hz // 100)
    assert reading(driver).position == 0 and wire.counted()[1][0] == 50
    driver.call("track_to", one, -30)
    settle(driver, wire)
    assert reading(driver).position == -30 and wire.counted()[1][0] == 20
    assert driver.positions() == [0, 0, 0, 0] and driver.fault == "OK"


def test_what_a_tracker_cannot_home() -> None:
    """A switch that is not fitted, a tracker of another axis or of none."""
    rig = Machine(model_engine(PARAMETERS, CLOCK_HZ), [Switch("home", 0, -700)])
    driver = driver_of(rig)
    own = track()
    assert run_home(driver, home(track=track(axis=1))) == "ARGUMENT"
    assert run_home(driver, home(distance=-100, track=own)) == "SWITCH_MISSED"
    assert rig.positions[0] == -100 and not driver.lib.passo_is_homed(driver.c, 0)
    plain = driver_of(Machine(model_engine(Parameters(inputs=1), CLOCK_HZ), [Switch("home", 0, -700)]))
    assert run_home(plain, home(track=own)) == "NO_TRACKERS"


def test_a_switch_stops_a_tracker() -> None:
    """No step toward it; the other way is free."""
    driver, wire = machine()
    config = struct("input_config")
    driver.call("configure_inputs", 0, config)
    one = track()
    driver.call("configure_tracker", one)
    driver.call("track_to", one, 3000)
    wire.run(wire.clock_hz // 50)
    wire.engine.set("limit_high", 1)
    wire.run(200)
    at = wire.counted()[1][0]
    wire.run(wire.clock_hz // 50)
    assert wire.counted()[1][0] == at
    assert error_of(driver, "poll") == "LIMIT"
    driver.call("clear")
    driver.call("track_to", one, 4000)
    wire.run(wire.clock_hz // 50)
    assert wire.counted()[1][0] == at
    driver.call("clear")
    driver.call("track_to", one, 0)
    settle(driver, wire)
    assert wire.counted()[1][0] < at - 100


def test_what_a_tracker_cannot_do_is_refused() -> None:
    """By name, and nothing moves."""
    driver, wire = machine()
    assert error_of(driver, "configure_tracker", track(acceleration=0)) == "TRACKER_LIMITS"
    assert error_of(driver, "configure_tracker", track(speed=wire.clock_hz // 128)) == "TRACKER_LIMITS"
    assert error_of(driver, "configure_tracker", track(speed=1, acceleration=1 << 31)) == "TRACKER_LIMITS"
    assert error_of(driver, "configure_tracker", track(axis=4)) == "ARGUMENT"
    assert error_of(driver, "track_to", track(axis=4), 5) == "ARGUMENT"
    driver.call("configure_tracker", track())
    driver.call("track_to", track(), 1000)
    wire.run(wire.clock_hz // 1000)
    assert error_of(driver, "configure_tracker", track()) == "MOVING"
    wire.run(wire.clock_hz // 10)
    driver.call("configure_tracker", track())
    plain = open_driver(Wire(Parameters()))
    assert error_of(plain, "track_to", track(), 5) == "NO_TRACKERS"
    assert wire.counted()[1] == [1000, 0, 0, 0]


def test_axes_without_lines() -> None:
    """Moves cannot have steps of them; their trackers move them beside a path, and they stop with it."""
    wire = Wire(Parameters(axes=5, inputs=1, outputs=1, trackers=1, tracked=2))
    driver = open_driver(wire)
    driver.call("configure_motion", wire.clock_hz // 1000, wire.clock_hz // 1000, 0)
    assert (driver.c.axes, driver.c.machine.axes) == (5, 3)
    tracks = [track(axis, speed=20_000) for axis in (3, 4)]
    for one in tracks:
        driver.call("configure_tracker", one)
    for one, target in zip(tracks, (700, -900), strict=True):
        driver.call("track_to", one, target)
    driver.call("move_by_speed", by_speed([300, -200, 100, 0, 0]))
    for axis in (3, 4):
        steps = [0] * 5
        steps[axis] = 5
        assert error_of(driver, "move_by_speed", by_speed(steps)) == "ARGUMENT"
        assert error_of(driver, "move_to_by_speed", 1 << axis, by_speed(steps)) == "ARGUMENT"
    finish(driver, wire)
    for axis in (3, 4):
        settle(driver, wire, axis)
    assert list(driver.positions()) == [300, -200, 100, 0, 0]
    assert [reading(driver, axis).position for axis in range(5)] == [0, 0, 0, 700, -900]
    assert wire.counted()[1] == [300, -200, 100, 700, -900]
    driver.call("track_to", tracks[0], 5000)
    wire.run(wire.clock_hz // 1000)
    driver.call("abort")
    wire.run(wire.clock_hz // 1000)
    stopped = wire.counted()[1]
    wire.run(wire.clock_hz // 10)
    assert 700 < stopped[3] < 5000 and wire.counted()[1] == stopped


@pytest.mark.parametrize("clocks", range(50_000, 62_000, 1000))
def test_a_tracker_that_rests_between_two_steps(clocks: int) -> None:
    """Its position is that of the nearest one, as many as it has made: the path beside it is exact."""
    driver, wire = machine()
    driver.call("configure_tracker", track())
    driver.call("track_to", track(), 5000)
    wire.run(clocks)
    driver.call("untrack", 0)
    while reading(driver).moves:
        wire.run(1000)
    wire.run(wire.clock_hz // 1000)
    made = wire.counted()[1][0]
    assert 0 < made < 5000 and reading(driver).position == made
    driver.call("move_by_speed", by_speed([40]))
    finish(driver, wire)
    assert driver.positions()[0] == 40 and wire.counted()[1][0] == made + 40


def test_targets_of_a_table() -> None:
    """As exact fractions say, halves up; beyond its ends those of the ends, at any position."""
    rng = random.Random(f"table {SEED}")
    at, edge = planner().passo_track_at, 1 << 31
    for number in range(300):
        points, wide = rng.randint(1, 9), number % 3 == 0
        targets = [rng.choice([-32768, 32767, rng.randint(-40, 40)]) for _ in range(points)]
        begin = rng.choice([-edge, edge - 1, rng.randint(-500, 500)]) if wide else rng.randint(-500, 500)
        pitch = rng.choice([1, edge, 2 * edge - 1, rng.randint(1, 300)]) if wide else rng.randint(1, 300)
        values = ffi().new("int16_t[]", targets)
        table = struct("track_table", targets=values, points=points, begin=begin, pitch=pitch)
        places = [-edge, edge - 1, begin, *(rng.randint(-edge, edge - 1) for _ in range(5))]
        places += [begin + rng.randint(-50, points * pitch) for _ in range(40)]
        for place in places:
            if not -edge <= place < edge:
                continue
            point, rest = divmod(place - begin, pitch)
            if place <= begin:
                wanted = Fraction(targets[0])
            elif point >= points - 1:
                wanted = Fraction(targets[-1])
            else:
                wanted = targets[point] + Fraction((targets[point + 1] - targets[point]) * rest, pitch)
            assert at(table, place) == math.floor(wanted + Fraction(1, 2)), (targets, begin, pitch, place)
    empty = struct("track_table", targets=ffi().NULL, points=0, begin=0, pitch=5)
    assert at(empty, 7) == 0
    values = ffi().new("int16_t[]", [3, 9])
    even = struct("track_table", targets=values, points=2, begin=0, pitch=0)
    assert at(even, 7) == 3


@pytest.mark.parametrize(
    ("pin", "level", "after"), [("estop_n", 0, 1), ("limit_high", 1, 1), ("alarm", 1, 0), ("probe", 1, 1)]
)
def test_a_stop_within_the_call_of_another_tracker(pin: str, level: int, after: int) -> None:
    """It is enabled by a read and a write: a tracker that the stop between them has ended stays ended."""
    driver, wire = machine()
    driver.call("configure_inputs", 0, struct("input_config", limit_low=True, limit_high=True))
    driver.call("configure_probe", False)
    for axis in range(2):
        driver.call("configure_tracker", track(axis))
    driver.call("track_to", track(0), 30_000)
    if pin == "probe":
        driver.call("arm_trigger", struct("trigger_config", source=TriggerSource.PROBE, action=2))
    wire.run(wire.clock_hz // 100)
    between: list[list[int]] = []

    def stop(words: list[int]) -> list[int]:
        enables = words[0] & 0xFFF == driver.c.base + r.CHANNEL_TRACKER_ENABLE
        if enables and words[0] >> 28 == Operation.WRITE and not between:
            between.append(words)
            wire.engine.set(pin, level)
            wire.engine.run(wire.clock_hz // 1000)
            wire.engine.set(pin, after)
        return list(words)

    wire.there = stop
    driver.call("track_to", track(1), 500)
    assert between and not reading(driver, 0).enabled and not reading(driver, 1).enabled
    there = reading(driver, 0).position
    if pin == "estop_n":
        driver.call("clear_estop")
    driver.call("clear")
    wire.run(wire.clock_hz // 10)
    assert reading(driver, 0).position == there and not reading(driver, 1).position
