# SPDX-License-Identifier: MIT
"""A target and a speed that change in motion (stm32_bridge/driver/passo_goto.h), at the C model.

Random histories with a judge of their own are in goto_histories.c.
"""

import os
import subprocess
from pathlib import Path
from typing import Any

import pytest
from passo.build import Parameters, model_library, planner_library
from passo.compiler import STRICT, compile_to, includes
from passo.driver import Driver
from passo.native import ffi
from passo.registers import Cause, State, TriggerSource
from passo.toolchain import paths

from tests.helpers.driver_wire import (
    CLOCK_HZ,
    Q32,
    Noise,
    Wire,
    by_speed,
    error_of,
    open_driver,
    struct,
)

MS = CLOCK_HZ // 1000
WATCHED = Parameters(inputs=1)
HISTORIES = 100


@pytest.fixture
def driver(wire: Wire) -> Driver:
    made = open_driver(wire)
    made.call("configure_motion", 50 * MS, 50 * MS, 0)
    return made


def go(target: int, speed: int = 10_000, **fields: Any) -> Any:
    """Axis 1 of a machine with 20,000 steps/s and 200,000 steps/s^2."""
    given = {"axis": 1, "top_speed": 20_000 * Q32, "acceleration": 200_000 * Q32} | fields
    return struct("goto", target=target, speed=speed * Q32, **given)


def run(driver: Driver, milliseconds: int) -> None:
    """Poll once in a millisecond."""
    for _ in range(milliseconds):
        driver.engine.run(MS)
        driver.poll()


def finish(driver: Driver, seconds: float = 6) -> int:
    """To the end; the position of axis 1, by the pulses."""
    wire = driver.engine
    end = wire.clock + int(seconds * CLOCK_HZ)
    while driver.is_moving:
        assert wire.clock < end, "it does not end"
        driver.poll()
        wire.run(MS // 4)
    assert driver.fault == "OK" and driver.state == State.IDLE
    return wire.counted()[1][1]


def position(driver: Driver) -> int:
    return driver.engine.counted()[1][1]


@pytest.mark.parametrize("target", [1, -1, 2, -3, 1000, -20_000])
def test_a_target_that_stays(driver: Driver, target: int) -> None:
    """It is one motion, and ends there; no other axis moves."""
    driver.call("goto", go(target))
    assert finish(driver) == target
    assert driver.engine.counted()[1] == [0, target, 0, 0] == driver.positions()
    driver.call("goto", go(target))  # it is there
    assert not driver.is_moving
    driver.call("move_by_speed", by_speed([10, 0, 0, 0]))


def test_positions_are_those_of_the_program(driver: Driver) -> None:
    """Also after set_position, across the wrap."""
    driver.call("set_position", 1, 2**31 - 500)
    driver.call("goto", go(-(2**31) + 400))
    run(driver, 20)
    driver.call("goto", go(-(2**31) + 700, 20_000))
    assert finish(driver) == 1200
    assert driver.positions()[1] == -(2**31) + 700


@pytest.mark.parametrize("speed", [10_000, 20_000, 2000])
@pytest.mark.parametrize("target", [3000, 9000, 600, -2000])
def test_a_change(driver: Driver, target: int, speed: int) -> None:
    """Further, nearer, behind; faster, slower: three frames, no stop on the way, the end exact."""
    driver.call("goto", go(3000))
    run(driver, 100)
    frames = driver.engine.frames
    driver.call("goto", go(target, speed))
    assert driver.engine.frames - frames <= 3
    run(driver, 60)
    at = position(driver)
    run(driver, 10)
    if target == 9000:
        assert position(driver) - at == pytest.approx(10 * speed / 1000, rel=0.03)
    assert finish(driver) == target == driver.positions()[1]


def test_the_same_again_costs_nothing(driver: Driver) -> None:
    """A program may call it in its loop."""
    driver.call("goto", go(5000))
    run(driver, 50)
    frames = driver.engine.frames
    driver.call("goto", go(5000))
    assert driver.engine.frames == frames
    assert finish(driver) == 5000


def test_changes_around_the_end(driver: Driver) -> None:
    """Whatever the moment: before, within and after the last ramp."""
    for delay in range(0, 60):
        at = position(driver)
        driver.call("goto", go(at + 400))
        driver.engine.run(70 * MS + delay * MS // 2)
        if delay % 2:
            driver.poll()
        target = at + (-300 if delay % 3 else 800)
        driver.call("goto", go(target, 20_000))
        assert finish(driver) == target


def test_a_target_that_runs_away(driver: Driver) -> None:
    """It is followed without a stop, and met when it rests."""
    driver.call("goto", go(200, 20_000))
    speeds = []
    for n in range(200):
        at = position(driver)
        run(driver, 5)
        if n > 40:
            speeds.append((position(driver) - at) / 0.005)
        driver.call("goto", go(200 + 50 * n, 20_000))
    assert min(speeds) > 5000
    assert finish(driver) == 200 + 50 * 199


@pytest.mark.parametrize("after", [10, 60, 100, 200])
def test_a_host_that_falls_silent(after: int) -> None:
    """Without a watchdog: the axis rests on its way, short of the target by no more than stated."""
    driver = open_driver(Wire(WATCHED))
    driver.call("configure_motion", 50 * MS, 50 * MS, 0)
    driver.call("configure_watchdog", 0, 0)
    driver.call("goto", go(3000))
    run(driver, after)
    driver.call("goto", go(4000, 20_000))
    driver.engine.run(2 * CLOCK_HZ)
    short = 4000 - position(driver)
    assert 0 <= short <= 5 + 20_000 * 0.00102 + 1
    assert driver.snapshot().state == State.IDLE and driver.cause == Cause.NONE
    assert finish(driver) == 4000


def test_the_watchdog_stops_it_on_its_way() -> None:
    """As every motion: a host that sends nothing for half a second."""
    driver = open_driver(Wire(WATCHED))
    driver.call("configure_motion", 50 * MS, 50 * MS, 0)
    driver.call("goto", go(50_000))
    driver.engine.run(CLOCK_HZ)
    assert 0 < position(driver) < 10_000
    assert error_of(driver, "poll") == "WATCHDOG" and not driver.is_moving
    assert error_of(driver, "goto", go(0)) == "STOPPED"
    driver.call("clear")
    driver.call("goto", go(0))
    assert finish(driver) == 0


def test_a_host_that_is_too_slow(wire: Wire, driver: Driver) -> None:
    """Before the frame: refused, it goes on as it was. Within the frame: a soft stop on the way."""
    driver.call("goto", go(3000))
    run(driver, 50)
    frames = wire.frames
    wire.before_frame = lambda _: wire.run(2 * MS)
    assert error_of(driver, "goto", go(-3000)) == "LATE"
    assert wire.frames - frames == 6  # nothing was sent
    wire.before_frame = lambda _: None
    assert finish(driver) == 3000
    driver.call("goto", go(0))
    run(driver, 50)
    slow = lambda _: wire.run(2 * MS if wire.requests[-1][0] >> 28 == 3 else 0)  # noqa: E731
    wire.before_frame = slow
    assert error_of(driver, "goto", go(-5000)) == "LATE"
    wire.before_frame = lambda _: None
    while driver.is_moving:
        driver.poll()
        wire.run(MS)
    assert driver.state == State.STOPPED and driver.fault == "OK"
    assert 0 < position(driver) < 3000
    driver.call("clear")
    driver.call("goto", go(-5000, late_clocks=20 * MS))
    run(driver, 50)
    wire.before_frame = slow  # it may be that slow
    driver.call("goto", go(0, late_clocks=20 * MS))
    wire.before_frame = lambda _: None
    assert finish(driver) == 0


def test_a_wire_that_dies_in_a_change(wire: Wire, driver: Driver) -> None:
    """In a read: as it was. In the frame: a soft stop that is resent."""
    driver.call("goto", go(3000))
    run(driver, 50)
    wire.stuck = 1
    assert error_of(driver, "goto", go(9000)) == "STUCK_HIGH"
    wire.stuck = None
    assert finish(driver) == 3000
    driver.call("goto", go(9000))
    run(driver, 50)
    frames = wire.frames

    def die(frame: int) -> None:
        wire.stuck = 1 if frame > frames + 2 else None

    wire.before_frame = die
    assert error_of(driver, "goto", go(6000)) == "STUCK_HIGH"
    assert driver.fault == "NOT_STOPPED"
    wire.before_frame, wire.stuck = lambda _: None, None
    while driver.is_moving:
        driver.poll()
        wire.run(MS)
    driver.call("clear")
    assert 3000 < position(driver) < 9000
    driver.call("goto", go(0))
    assert finish(driver) == 0


def test_noise(wire: Wire) -> None:
    """Retries make a change late, never wrong."""
    import random

    noise = Noise(random.Random(3), 3e-4)
    noise.on(wire)
    driver = open_driver(wire, tries=40)
    driver.call("configure_motion", 50 * MS, 50 * MS, 0)
    late = 0
    for n in range(60):
        target = 1000 * (n % 7) - 2000
        name = error_of(driver, "goto", go(target, 4000 + 2000 * (n % 9)))
        assert name in ("OK", "LATE")
        late += name == "LATE"
        run(driver, 17)
        if driver.state == State.STOPPED or name == "LATE":
            while driver.is_moving:
                driver.poll()
                wire.run(MS)
            if driver.state == State.STOPPED:
                driver.call("clear")
    driver.call("goto", go(77))
    while driver.is_moving:
        driver.poll()
        wire.run(MS // 4)
    assert position(driver) == 77 and late < 10 and noise.flips > 50


def test_hold_override_stop_and_cancel(driver: Driver) -> None:
    """A change during a hold takes effect after it; stop and abort need a clear, cancel does not."""
    driver.call("goto", go(3000))
    run(driver, 50)
    driver.call("override", 30)
    driver.call("hold")
    run(driver, 100)
    at = position(driver)
    driver.call("goto", go(4000, 20_000))
    run(driver, 100)
    assert position(driver) == at and driver.is_moving
    driver.call("resume")
    run(driver, 100)
    driver.call("override", 100)
    assert finish(driver) == 4000
    driver.call("goto", go(0))
    run(driver, 50)
    driver.call("jog_cancel")
    rest = finish(driver)
    assert 0 < rest < 4000
    for command in ("stop", "abort"):
        driver.call("goto", go(0))
        run(driver, 20)
        driver.call(command)
        assert error_of(driver, "goto", go(100)) == "STOPPED"
        while driver.is_moving:
            driver.poll()
            driver.engine.run(MS)
        driver.call("clear")
    driver.call("goto", go(0))
    assert finish(driver) == 0


def test_it_waits_for_sync(driver: Driver) -> None:
    """Prepared, changed, started."""
    driver.call("wait_for_sync", True)
    driver.call("goto", go(500))
    run(driver, 20)
    driver.call("goto", go(-500))
    run(driver, 20)
    assert position(driver) == 0
    driver.call("wait_for_sync", False)
    assert finish(driver) == -500


def test_what_it_refuses(wire: Wire, driver: Driver) -> None:
    """Each bad value has its error, at rest and on the way, where nothing changes; so do other motions."""
    bad = [
        ("NO_SPEED", {"speed": 0}),
        ("ABOVE_TOP", {"speed": 20_001}),
        ("NO_ACCELERATION", {"acceleration": 0}),
        ("ARGUMENT", {"axis": 4}),
    ]
    for _ in range(2):
        for name, fields in bad:
            assert error_of(driver, "goto", go(3000, **fields)) == name
        assert error_of(driver, "goto", ffi().NULL) == "ARGUMENT"
        driver.call("goto", go(3000))
        run(driver, 20)
    assert error_of(driver, "goto", go(3000, axis=2)) == "UNDER_WAY"
    for call in (
        ("move_by_speed", by_speed([1, 0, 0, 0])),
        ("jog", struct("jog", speed=Q32, acceleration=Q32)),
    ):
        assert error_of(driver, *call) == "UNDER_WAY"
    assert error_of(driver, "jog_speed", 1000 * Q32) == "NOT_TURNING"
    assert error_of(driver, "set_position", 1, 0) == "UNDER_WAY"
    assert finish(driver) == 3000
    fast = {"top_speed": 0, "acceleration": 2**63}
    assert error_of(driver, "goto", go(0, CLOCK_HZ // 3, **fast)) == "TOO_FAST"
    assert error_of(driver, "goto", go(0, CLOCK_HZ // 5, **fast)) == "PINS_TOO_SLOW"
    assert error_of(driver, "goto", go(0, acceleration=Q32)) == "TOO_LONG"
    driver.call("move_by_speed", by_speed([1000, 0, 0, 0]))
    assert error_of(driver, "goto", go(0)) == "MOVING"
    assert wire.counted()[1][1] == 3000
    driver.call("abort")
    assert error_of(driver, "goto", go(0)) == "STOPPED"


def test_home_and_goto_exclude_each_other() -> None:
    """Either is refused while the other is under way."""
    driver = open_driver(Wire(WATCHED))
    driver.call("configure_motion", 5 * MS, 5 * MS, 0)
    driver.call("configure_inputs", 1, struct("input_config", home=True))
    wanted = {
        "axis": 1,
        "source": TriggerSource.HOME,
        "distance": -5000,
        "back_off": 100,
        "speed": 5000 * Q32,
        "slow_speed": 2000 * Q32,
        "acceleration": 500_000 * Q32,
    }
    homes = ffi().new("struct passo_home[]", [wanted])
    driver.call("goto", go(3000))
    run(driver, 20)
    assert error_of(driver, "home", homes, 1) == "UNDER_WAY"
    assert finish(driver) == 3000
    driver.call("home", homes, 1)
    run(driver, 20)
    assert error_of(driver, "goto", go(0)) == "UNDER_WAY"


def test_a_hardware_without_a_clock(wire: Wire, driver: Driver) -> None:
    driver.host.hardware.microseconds = ffi().NULL
    assert error_of(driver, "goto", go(5)) == "NO_CLOCK"


def test_random_histories(tmp_path: Path) -> None:
    """Thousands of changes by hosts that are late, interrupted, silent or dead; see goto_histories.c."""
    folders = (paths.driver, paths.planner, paths.protocol, paths.core, paths.engine)
    libraries = [planner_library(), model_library()]
    linked = [str(library) for library in libraries]
    linked += [f"-Wl,-rpath,{library.parent}" for library in libraries]
    flags = [*STRICT, "-O2", *includes(*folders)]
    program = compile_to(tmp_path / "histories", *flags, paths.tests / "goto_histories.c", *linked, "-lm")
    first = 1_000_000 * int(os.environ.get("PASSO_SEED", "0"))
    done = subprocess.run([program, str(first), str(HISTORIES)], capture_output=True, text=True, timeout=500)
    print(done.stdout)
    assert done.returncode == 0, done.stdout
