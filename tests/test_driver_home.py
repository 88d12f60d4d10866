# SPDX-License-Identifier: MIT
"""Home, probe and jog (stm32_bridge/driver/passo_home.h) on a simulated machine at the C model."""

import random
from typing import Any

import pytest
from passo.build import Parameters
from passo.driver import Driver, DriverError, Source
from passo.engine import model_engine
from passo.machine import Machine, Switch
from passo.native import ffi
from passo.registers import Cause, State, TriggerSource

from tests.helpers.driver_wire import CLOCK_HZ, Q32, by_speed, error_of, open_driver, struct

PARAMETERS = Parameters(inputs=1)
FITTED = {"limit_low": True, "limit_high": True, "home": True, "limit_soft": True}
FILTER = CLOCK_HZ // 50_000  # 20 us


def machine_of(*switches: Switch, **options: Any) -> Machine:
    return Machine(model_engine(PARAMETERS, CLOCK_HZ), switches, **options)


def driver_of(machine: Machine, **inputs: Any) -> Driver:
    """Axes with all switches, soft stops of 2 ms, a probe."""
    driver = open_driver(machine)
    driver.call("configure_filter", FILTER)
    driver.call("configure_motion", CLOCK_HZ // 500, CLOCK_HZ // 500, 0)
    for axis in range(4):
        driver.call("configure_inputs", axis, struct("input_config", **(FITTED | inputs)))
    driver.call("configure_probe", False)
    return driver


def home(**fields: Any) -> dict[str, Any]:
    """Parameters of a home of axis 0 in negative direction."""
    return {
        "axis": 0,
        "source": TriggerSource.HOME,
        "distance": -5000,
        "back_off": 100,
        "speed": 20_000 * Q32,
        "slow_speed": 2000 * Q32,
        "acceleration": 500_000 * Q32,
    } | fields


def homes(*each: dict[str, Any]) -> Any:
    return ffi().new("struct passo_home[]", list(each))


def finish(driver: Driver, seconds: float = 2) -> str:
    """Poll to the end; the first error, or OK."""
    machine = driver.engine
    end = machine.clock + int(seconds * CLOCK_HZ)
    while driver.is_moving:
        assert machine.clock < end, "it does not end"
        name = error_of(driver, "poll")
        if name != "OK":
            return name
        machine.run(CLOCK_HZ // 10_000)
    return "OK"


def run_home(driver: Driver, *each: dict[str, Any]) -> str:
    array = homes(*each)
    name = error_of(driver, "home", array, len(each))
    return name if name != "OK" else finish(driver)


def is_homed(driver: Driver, axis: int = 0) -> bool:
    return driver.lib.passo_is_homed(driver.c, axis)


def assert_origin(driver: Driver, axis: int, edge: int, position: int = 0) -> None:
    """The driver counts `position` at the edge of the switch, to the step that it saw late."""
    machine = driver.engine
    physical = int(machine.positions[axis])
    assert driver.positions()[axis] - position == pytest.approx(physical - edge, abs=1)
    assert is_homed(driver, axis)


@pytest.mark.parametrize("pull_off", [0, 250])
@pytest.mark.parametrize("start", [0, 3000, -4500])
@pytest.mark.parametrize("sign", [-1, 1])
def test_home(sign: int, start: int, pull_off: int) -> None:
    """From this side of the switch, near or far, and from behind it: the edge is where it was told to be."""
    machine = machine_of(Switch("home", 1, sign * 2000, above=sign > 0), start=[0, -sign * start])
    driver = driver_of(machine)
    wanted = home(axis=1, distance=sign * 9000, pull_off=pull_off, position=-777)
    assert run_home(driver, wanted) == "OK"
    assert_origin(driver, 1, sign * 2000, -777)
    if pull_off:
        assert driver.positions()[1] == -777 - sign * pull_off
    assert driver.state == State.IDLE and driver.fault == "OK"
    assert machine.positions[[0, 2, 3]].tolist() == [0, 0, 0]
    driver.call("move_by_speed", by_speed([0, 500, 0, 0]))
    driver.wait(1)


def test_no_setting_changes_between_two_motions_of_a_home() -> None:
    """Also where the host has not seen the end of the first one: all that need rest wait for the last one."""
    driver = driver_of(machine_of(Switch("home", 0, -2000)))
    array, late = homes(home(pull_off=50)), CLOCK_HZ // 10
    driver.call("home", array, 1)
    phases = set()
    while driver.is_moving:
        driver.engine.run(late)
        phases.add(driver.c.task.phase)
        assert error_of(driver, "enable", 0, False) == "MOVING"
        assert error_of(driver, "configure_inputs", 0, struct("input_config", home=True)) == "MOVING"
        assert error_of(driver, "configure_probe", True) == "MOVING"
        driver.poll()
    assert len(phases) == 4
    assert_origin(driver, 0, -2000)
    driver.call("enable", 0, False)
    assert not is_homed(driver)


@pytest.mark.parametrize("limit_soft", [True, False])
@pytest.mark.parametrize("start", [1000, -50])
def test_home_on_a_limit(limit_soft: bool, start: int) -> None:
    """A limit switch is a home switch as well, active or not; the machine can be driven off it."""
    machine = machine_of(Switch("limit_low", 0, 0), start=[start])
    driver = driver_of(machine, limit_soft=limit_soft)
    wanted = home(source=TriggerSource.LIMIT_LOW, pull_off=50)
    assert run_home(driver, wanted) == "OK"
    assert_origin(driver, 0, 0)
    assert driver.positions()[0] == 50


def test_several_axes_one_after_the_other() -> None:
    """In the order of the call; the others rest meanwhile."""
    machine = machine_of(
        Switch("home", 0, -700), Switch("home", 1, 800, above=True), Switch("limit_high", 2, 900, above=True)
    )
    driver = driver_of(machine)
    array = homes(
        home(axis=1, distance=3000, position=10),
        home(axis=2, distance=3000, source=TriggerSource.LIMIT_HIGH, position=20),
        home(position=30),
    )
    driver.call("home", array, 3)
    while not is_homed(driver, 1):
        assert driver.is_moving
        driver.poll()
        machine.run(CLOCK_HZ // 10_000)
        assert machine.positions[0] == 0
    assert finish(driver) == "OK"
    for axis, edge, position in ((0, -700, 30), (1, 800, 10), (2, 900, 20)):
        assert_origin(driver, axis, edge, position)


def test_a_switch_with_bounce_hysteresis_and_noise() -> None:
    """Chatter and glitches below the filter move the home by less than the way during them."""
    machine = machine_of(Switch("home", 0, -2000, hysteresis=30, bounce=FILTER * 3, inverted=True))
    driver = driver_of(machine, home_inverted=True)
    driver.call("configure_filter", 10 * FILTER)
    machine.noise["alarm"] = 0.05
    assert run_home(driver, home()) == "OK"
    physical = int(machine.positions[0])
    assert driver.positions()[0] == pytest.approx(physical + 2000, abs=3)
    assert driver.cause == Cause.NONE


@pytest.mark.parametrize("stuck", [False, True])
def test_a_switch_that_never_changes(stuck: bool) -> None:
    """It goes no further than the distance, comes to rest on its path, and says so."""
    machine = machine_of(Switch("home", 0, 0, stuck=stuck))
    driver = driver_of(machine)
    assert run_home(driver, home(distance=-1500)) == "SWITCH_MISSED"
    assert driver.positions()[0] == machine.positions[0] == (1500 if stuck else -1500)
    assert not is_homed(driver) and driver.fault == "SWITCH_MISSED"
    driver.call("move_by_speed", by_speed([10, 0, 0, 0]))  # it is ready, and its trigger disarmed
    machine.set("home", 0 if stuck else 1)
    driver.wait(1)


def test_a_switch_that_sticks_after_it_was_found() -> None:
    """The back-off ends at an active switch: it is not taken for an edge."""
    switch = Switch("home", 0, -500)
    driver = driver_of(machine_of(switch))
    driver.call("home", homes_kept := homes(home()), 1)
    while not switch.active:
        driver.poll()
        driver.engine.run(CLOCK_HZ // 10_000)
    switch.stuck = True
    assert finish(driver) == "SWITCH_LEVEL"
    assert not is_homed(driver) and homes_kept


def test_what_is_refused() -> None:
    """Each contradiction has its error, and nothing moves."""
    driver = driver_of(machine_of())
    bare = struct("input_config", limit_low=True)
    driver.call("configure_inputs", 3, bare)
    refused = {
        "NO_SWITCH": home(axis=3),
        "NO_SOURCE": home(source=TriggerSource.NONE),
        "NO_DISTANCE": home(distance=0),
        "TOO_MANY_STEPS": home(distance=-(2**31)),
        "NO_SPEED": home(slow_speed=0),
        "NO_ACCELERATION": home(acceleration=0),
        "PINS_TOO_SLOW": home(speed=2_000_000 * Q32, acceleration=Q32 << 31),
    }
    for name, fields in refused.items():
        assert run_home(driver, fields) == name
    assert run_home(driver, home(back_off=0)) == "NO_DISTANCE"
    for fields in (
        home(axis=4),
        home(source=9),
        home(source=TriggerSource.PROBE),
        home(source=1, distance=1),
    ):
        assert run_home(driver, fields) == "ARGUMENT"
    assert error_of(driver, "home", ffi().NULL, 1) == error_of(driver, "home", homes(home()), 0) == "ARGUMENT"
    assert not driver.is_moving and driver.state == State.IDLE
    assert not driver.engine.positions.any()


def test_no_soft_stop_without_its_time() -> None:
    """After a reset of the core a soft stop would be a blow: home and probe wait until its time is set."""
    driver = open_driver(machine_of())
    driver.call("configure_inputs", 0, struct("input_config", **FITTED))
    driver.call("configure_probe", False)
    assert run_home(driver, home()) == "NO_STOP_TIME"
    assert error_of(driver, "probe", probe([0, 0, -700, 0])) == "NO_STOP_TIME"
    driver.call("configure_motion", CLOCK_HZ // 500, CLOCK_HZ // 500, 0)
    assert run_home(driver, home(distance=-500)) == "SWITCH_MISSED"
    driver.open()
    driver.call("configure_inputs", 0, struct("input_config", **FITTED))
    assert run_home(driver, home()) == "NO_STOP_TIME"


def test_while_it_is_under_way() -> None:
    """Hold and resume work, other motions and triggers wait; a stop ends it, for good."""
    machine = machine_of(Switch("home", 0, -4000))
    driver = driver_of(machine)
    array = homes(home())
    driver.call("home", array, 1)
    for _ in range(100):
        driver.poll()
        machine.run(CLOCK_HZ // 10_000)
    assert error_of(driver, "move_by_speed", by_speed([1, 0, 0, 0])) == "UNDER_WAY"
    assert error_of(driver, "home", array, 1) == "UNDER_WAY"
    trigger = struct("trigger_config", source=TriggerSource.HOME)
    assert error_of(driver, "arm_trigger", trigger) == error_of(driver, "disarm_trigger") == "UNDER_WAY"
    driver.call("hold")
    machine.run(CLOCK_HZ // 100)
    there = machine.positions[0]
    machine.run(CLOCK_HZ // 100)
    assert machine.positions[0] == there != 0
    driver.call("resume")
    machine.run(CLOCK_HZ // 100)
    assert machine.positions[0] < there
    driver.call("stop")
    assert finish(driver) == "OK"
    driver.call("clear")
    there = machine.positions[0]
    for _ in range(20):
        driver.poll()
        machine.run(CLOCK_HZ // 1000)
    assert machine.positions[0] == there == driver.positions()[0] and not is_homed(driver)
    driver.call("move_by_speed", by_speed([-4500, 0, 0, 0]))  # past the switch: its trigger is disarmed
    driver.wait(1)


@pytest.mark.parametrize("at", [1, 12, 55, 103, 120, 200])
def test_estop_in_the_middle(at: int) -> None:
    """In each phase: immediately at rest, drives off, its name; back step by step, without a motion."""
    machine = machine_of(Switch("home", 0, -1000))
    driver = driver_of(machine)
    assert run_home(driver, home()) == "OK"
    array = homes(home(distance=-9000, pull_off=500))
    driver.call("home", array, 1)
    for _ in range(at):
        driver.poll()
        machine.run(CLOCK_HZ // 10_000)
    assert driver.is_moving and machine.enable == 15
    machine.set("estop_n", 0)
    machine.run(CLOCK_HZ // 50_000)
    there = machine.positions.copy()
    assert finish(driver) == "ESTOP"
    assert machine.enable == 0 and driver.cause == Cause.ESTOP and not is_homed(driver)
    assert error_of(driver, "clear") == error_of(driver, "clear_estop") == "ESTOP"
    assert error_of(driver, "move_by_speed", by_speed([1, 0, 0, 0])) == "STOPPED"
    machine.set("estop_n", 1)
    machine.run(CLOCK_HZ // 1000)
    assert error_of(driver, "clear") == "ESTOP" == driver.fault
    driver.call("clear_estop")
    driver.call("clear")
    for _ in range(20):
        driver.poll()
        machine.run(CLOCK_HZ // 1000)
    assert machine.enable == 0 and driver.fault == "OK"
    assert machine.positions.tolist() == there.tolist()
    for axis in range(4):
        driver.call("enable", axis, True)
    assert run_home(driver, home(distance=-9000)) == "OK"
    assert_origin(driver, 0, -1000)


@pytest.mark.parametrize(("pin", "level", "name"), [("estop_n", 0, "ESTOP"), ("alarm", 1, "ALARM")])
def test_the_cause_between_two_polls(pin: str, level: int, name: str) -> None:
    """Whichever poll is next, also one that begins the next phase: it tells why."""
    for polls in range(1, 200):
        machine = machine_of(Switch("home", 0, -100))
        driver = driver_of(machine)
        array = homes(home(distance=-1000, back_off=20, pull_off=20))
        driver.call("home", array, 1)
        for _ in range(polls):
            driver.poll()
            machine.run(CLOCK_HZ // 1000)
        machine.set(pin, level)
        machine.run(CLOCK_HZ // 10_000)
        if (told := finish(driver)) == "OK":
            break  # it was over
        assert told == name == driver.fault
    assert 40 < polls < 199


def test_a_limit_in_the_way_of_home() -> None:
    """The wrong switch: LIMIT, and home may be tried again from there."""
    machine = machine_of(Switch("home", 0, -3000), Switch("limit_low", 0, -1000))
    driver = driver_of(machine)
    assert run_home(driver, home()) == "LIMIT"
    assert driver.cause == Cause.LIMIT and not is_homed(driver)
    driver.call("clear")
    assert run_home(driver, home()) == "LIMIT"
    driver.call("clear")
    driver.call("move_by_speed", by_speed([500, 0, 0, 0]))
    driver.wait(1)


@pytest.mark.parametrize(
    ("task", "pin", "level", "name"),
    [("probe", "limit_low", 5, "LIMIT"), ("probe", "alarm", 2, "ALARM"), ("home", "alarm", 2, "ALARM")],
)
def test_a_stop_behind_the_trigger(task: str, pin: str, level: int, name: str) -> None:
    """However short: the task ends with it, and nothing moves."""
    switch = Switch("home", 0, -2000) if task == "home" else Switch("probe", 2, -300)
    machine = machine_of(switch)
    driver = driver_of(machine, limit_soft=False)
    driver.call("configure_motion", CLOCK_HZ // 500, CLOCK_HZ // 50, 0)
    array, touch = homes(home()), probe([0, 0, -5000, 0])
    driver.call("home", array, 1) if task == "home" else driver.call("probe", touch)
    while not switch.active:
        driver.poll()
        machine.run(CLOCK_HZ // 10_000)
    machine.run(CLOCK_HZ // 2000)
    machine.set(pin, level)
    machine.run(CLOCK_HZ // 5000)
    machine.set(pin, 0)
    machine.run(CLOCK_HZ // 5000)
    there = machine.positions.copy()
    assert finish(driver) == name == driver.fault
    assert error_of(driver, "move_by_speed", by_speed([1, 0, 0, 0])) == "STOPPED"
    machine.run(CLOCK_HZ // 10)
    assert machine.positions.tolist() == there.tolist() and not is_homed(driver)
    driver.call("clear")
    driver.call("move_by_speed", by_speed([10, 0, 10, 0]))
    driver.wait(1)


def test_a_limit_right_behind_the_home_switch() -> None:
    """The axis comes up to the switch again, slowly: the limit may stop it, and does not end the home."""
    machine = machine_of(Switch("home", 0, -2000), Switch("limit_low", 0, -2002))
    driver = driver_of(machine, limit_soft=False)
    assert run_home(driver, home()) == "OK"
    assert_origin(driver, 0, -2000)


def test_an_alarm_of_long_ago() -> None:
    """Its flag is still set: a limit that homes one axis is not taken for it, and forgets no other one."""
    machine = machine_of(Switch("limit_low", 0, -500), Switch("limit_low", 1, -500))
    driver = driver_of(machine)
    machine.set("alarm", 15)
    machine.run(CLOCK_HZ // 1000)
    machine.set("alarm", 0)
    machine.run(CLOCK_HZ // 1000)
    driver.call("clear")
    by_limit = {"source": TriggerSource.LIMIT_LOW, "pull_off": 50}
    assert run_home(driver, home(**by_limit), home(axis=1, **by_limit)) == "OK"
    assert is_homed(driver, 0) and is_homed(driver, 1)


@pytest.mark.parametrize("seed", range(8))
def test_random_homes(seed: int) -> None:
    """Wherever the axis is and however the switch is mounted."""
    rng = random.Random(seed)
    sign = rng.choice([-1, 1])
    edge = rng.randrange(-3000, 3000)
    play = {"hysteresis": rng.randrange(40), "bounce": rng.randrange(FILTER)}
    switch = Switch("home", 2, edge, above=sign > 0, **play)
    driver = driver_of(machine_of(switch, start=[0, 0, rng.randrange(-3000, 3000)], seed=seed))
    driver.call("configure_filter", 4 * FILTER)
    wanted = home(axis=2, distance=sign * 9000, position=rng.randrange(-9999, 9999), back_off=80)
    assert run_home(driver, wanted) == "OK"
    assert_origin(driver, 2, edge, wanted["position"])


# ---------------------------------------------------------------------------------------------- probe ----


def probe(steps: list[int], **fields: Any) -> Any:
    return struct("probe", steps=steps, speed=10_000 * Q32, acceleration=500_000 * Q32, **fields)


def report_of(driver: Driver) -> Any:
    report = struct("trigger_report")
    driver.call("read_trigger", report)
    return report


@pytest.mark.parametrize("away", [False, True])
def test_probe(away: bool) -> None:
    """Toward: the touch; away: the release; the latched position is that of the edge."""
    switch = Switch("probe", 2, -300)
    driver = driver_of(machine_of(switch, start=[0, 0, -900 if away else 0]))
    start = int(driver.engine.positions[2])
    driver.call("probe", probe([50, 0, 2000 if away else -2000, 0], away=away))
    assert finish(driver) == "OK" and driver.state == State.IDLE
    report = report_of(driver)
    assert report.fired and not report.armed
    assert report.positions[2] + start == pytest.approx(switch.edges[-1][0], abs=1)
    assert driver.positions()[2] + start == driver.engine.positions[2]
    assert abs(driver.positions()[2]) > abs(report.positions[2])  # a soft stop


@pytest.mark.parametrize("optional", [False, True])
def test_a_probe_that_touches_nothing(optional: bool) -> None:
    """An error, or not; it reaches its end."""
    driver = driver_of(machine_of())
    driver.call("probe", probe([0, 0, -700, 0], optional=optional))
    assert finish(driver) == ("OK" if optional else "SWITCH_MISSED")
    assert driver.positions() == [0, 0, -700, 0]
    assert not report_of(driver).fired


def test_a_probe_that_is_wrong_from_the_start() -> None:
    """Not configured, touching already, or free already."""
    machine = machine_of()
    driver = open_driver(machine)
    assert error_of(driver, "probe", probe([0, 0, -700, 0])) == "NO_SWITCH"
    driver.call("configure_probe", False)
    driver.call("configure_motion", CLOCK_HZ // 500, CLOCK_HZ // 500, 0)
    assert error_of(driver, "probe", probe([0, 0, 700, 0], away=True)) == "SWITCH_LEVEL"
    machine.set("probe", 1)
    machine.run(10_000)
    assert error_of(driver, "probe", probe([0, 0, -700, 0])) == "SWITCH_LEVEL"
    assert error_of(driver, "probe", probe([0, 0, 0, 0], away=True)) == "NO_STEPS"
    driver.call("configure_probe", True)
    machine.run(10_000)
    driver.call("probe", probe([0, 0, -70, 0], optional=True))
    assert finish(driver) == "OK" and not machine.positions[:2].any()


# ------------------------------------------------------------------------------------------------ jog ----


def jog(**fields: Any) -> Any:
    return struct("jog", **({"speed": 20_000 * Q32, "acceleration": 1_000_000 * Q32} | fields))


@pytest.mark.parametrize("backward", [False, True])
def test_jog_endless(backward: bool) -> None:
    """It runs, changes its speed without a jump, and comes to rest in the time of its ramp; no clear."""
    machine = machine_of()
    driver = driver_of(machine)
    driver.call("jog", jog(axis=1, backward=backward, top_speed=50_000 * Q32))
    machine.run(CLOCK_HZ // 20)
    driver.poll()
    assert driver.is_moving
    before = abs(int(machine.positions[1]))
    driver.call("jog_speed", 40_000 * Q32)
    machine.run(CLOCK_HZ // 20)
    assert abs(int(machine.positions[1])) - before == pytest.approx(40_000 / 20, rel=0.15)
    assert error_of(driver, "jog_speed", 60_000 * Q32) == "ABOVE_TOP"
    before = abs(int(machine.positions[1]))
    driver.call("jog_cancel")
    assert finish(driver) == "OK"
    slowed = abs(int(machine.positions[1])) - before
    assert slowed == pytest.approx(40_000**2 / 2 / 1_000_000, abs=60)
    assert driver.positions()[1] == machine.positions[1] and driver.state == State.IDLE
    driver.call("jog_cancel")  # there is none
    assert error_of(driver, "jog_speed", 20_000 * Q32) == "NOT_TURNING"


@pytest.mark.parametrize("seed", range(12))
def test_jog_by_distance(seed: int) -> None:
    """Exactly this number of steps; or fewer when it is canceled, at rest, and the count is right."""
    rng = random.Random(seed)
    driver = driver_of(machine := machine_of())
    for _ in range(6):
        before = int(machine.positions[3])
        steps = rng.choice([-1, 1]) * int(10 ** rng.uniform(0, 3.3))
        speed = int(10 ** rng.uniform(3, 4.9))
        acceleration = rng.choice([300_000, 9_000_000]) * Q32
        driver.call("jog", jog(axis=3, steps=steps, speed=speed * Q32, acceleration=acceleration))
        assert error_of(driver, "jog", jog(steps=5)) == "MOVING"
        assert finish(driver, 4) == "OK"
        assert machine.positions[3] - before == steps
        driver.call("jog", jog(axis=3, steps=-steps, speed=speed * Q32))
        machine.run(rng.randrange(CLOCK_HZ // 50))
        driver.call("jog_cancel")
        driver.call("jog_cancel")
        assert finish(driver) == "OK" and driver.state == State.IDLE
        assert driver.positions()[3] == machine.positions[3]
        assert abs(machine.positions[3] - before) <= abs(steps)


def test_a_jog_ends_at_a_limit_and_leaves_it() -> None:
    """Into the switch: LIMIT; further in: refused before the pin; off it: as any jog."""
    machine = machine_of(Switch("limit_high", 0, 400, above=True))
    driver = driver_of(machine)
    driver.call("jog", jog())
    with pytest.raises(DriverError, match="LIMIT"):
        driver.wait(1)
    driver.call("clear")
    there = machine.positions[0]
    driver.call("jog", jog())
    with pytest.raises(DriverError, match="LIMIT"):
        driver.wait(1)
    assert machine.positions[0] == there
    driver.call("clear")
    driver.call("jog", jog(steps=-1000))
    driver.wait(1)
    assert machine.positions[0] == there - 1000


def test_what_a_jog_refuses() -> None:
    """Bad numbers, motions that are no jogs, stops."""
    driver = driver_of(machine_of())
    assert error_of(driver, "jog", jog(axis=4)) == error_of(driver, "jog", ffi().NULL) == "ARGUMENT"
    for steps in (0, 3):
        assert error_of(driver, "jog", jog(speed=0, steps=steps)) == "NO_SPEED"
    assert error_of(driver, "jog", jog(acceleration=0, steps=3)) == "NO_ACCELERATION"
    fast = jog(speed=30_000_000 * Q32, acceleration=Q32 << 31, steps=10**6)
    assert error_of(driver, "jog", fast) in ("TOO_FAST", "PINS_TOO_SLOW")
    assert error_of(driver, "jog", jog(top_speed=Q32)) == "ABOVE_TOP"
    driver.call("move_by_speed", by_speed([900, 0, 0, 0]))
    assert error_of(driver, "jog", jog(steps=3)) == error_of(driver, "jog", jog()) == "MOVING"
    assert error_of(driver, "jog_cancel") == "NOT_TURNING"
    driver.wait(1)
    source = Source([], [])
    driver.call("stream", source.c)
    assert error_of(driver, "jog_cancel") == "NOT_TURNING"  # before its first frame, too
    driver.call("stop")
    finish(driver)
    driver.call("clear")
    driver.call("jog", jog(steps=2000))
    assert error_of(driver, "jog_speed", Q32) == "NOT_TURNING"
    driver.call("stop")
    finish(driver)
    assert error_of(driver, "jog", jog()) == "STOPPED"
