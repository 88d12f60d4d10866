# SPDX-License-Identifier: MIT
"""What stays homed after each cause of a stop, docs/machine.md; and inputs that are not known yet."""

from typing import Any

import pytest
from passo.build import Parameters
from passo.driver import Driver, Source
from passo.native import ffi
from passo.registers import Cause, Operation, State, TriggerAction, TriggerSource

from tests.helpers.driver_wire import CLOCK_HZ, Q32, Wire, by_speed, error_of, open_driver, path, struct

MS = CLOCK_HZ // 1000
PARAMETERS = Parameters(axes=3, inputs=1, encoders=1)
LONGEST = 65_535  # filter, clocks


@pytest.fixture
def driver() -> Driver:
    """All axes are homed, of a machine with a probe and soft stops of 2 ms."""
    made = open_driver(Wire(PARAMETERS))
    made.call("configure_motion", 2 * MS, 2 * MS, 0)
    made.call("configure_probe", False)
    for axis in range(3):
        made.call("configure_inputs", axis, struct("input_config", limit_low=True, home=True))
    made.engine.run(MS)
    home(made)
    return made


def home(driver: Driver) -> None:
    for axis in range(3):
        driver.c.axis[axis].homed = True


def homed(driver: Driver) -> list[bool]:
    return [driver.lib.passo_is_homed(driver.c, axis) for axis in range(3)]


def end(driver: Driver) -> str:
    """Poll until all is over; the first error."""
    for _ in range(2000):
        if not driver.is_moving:
            return "OK"
        if (name := error_of(driver, "poll")) != "OK":
            return name
        driver.engine.run(MS // 2)
    raise AssertionError("it does not end")


def begin(driver: Driver, steps: tuple[int, int, int] = (3000, -1000, 0)) -> None:
    driver.call("move_by_speed", by_speed(list(steps), speed=50_000))
    driver.engine.run(10 * MS)


KEPT, MOVED, NONE = [True, True, True], [False, False, True], [False, False, False]


def test_a_soft_stop_keeps_them(driver: Driver) -> None:
    begin(driver)
    driver.call("stop")
    assert end(driver) == "OK" and homed(driver) == KEPT
    driver.call("clear")
    assert homed(driver) == KEPT


def test_an_abort(driver: Driver) -> None:
    """The axes that moved; at rest none."""
    driver.call("abort")
    assert end(driver) == "OK" and homed(driver) == KEPT
    driver.call("clear")
    begin(driver)
    driver.call("abort")
    end(driver)
    driver.call("clear")
    assert homed(driver) == MOVED


def test_an_abort_after_a_stop(driver: Driver) -> None:
    """The cause is that of the stop."""
    begin(driver)
    driver.call("stop")
    driver.call("abort")
    end(driver)
    assert driver.snapshot().cause == Cause.STOP
    assert homed(driver) == MOVED


@pytest.mark.parametrize(("soft", "several"), [(False, True), (False, False), (True, True), (True, False)])
def test_a_limit(driver: Driver, soft: bool, several: bool) -> None:
    for axis in range(3):
        driver.call("configure_inputs", axis, struct("input_config", limit_low=True, limit_soft=soft))
    driver.engine.run(MS)
    begin(driver, (3000, -2900, 0) if several else (0, -3000, 0))
    driver.engine.engine.set("limit_low", 2)
    assert end(driver) == "LIMIT"
    assert homed(driver) == (MOVED if several else [True, soft, True])


@pytest.mark.parametrize("overtaken", [False, True])
@pytest.mark.parametrize(("pin", "name"), [("alarm", "ALARM"), ("estop_n", "ESTOP")])
def test_an_alarm_and_an_estop(driver: Driver, pin: str, name: str, overtaken: bool) -> None:
    """All axes; also where the cause is that of a soft stop before."""
    begin(driver)
    if overtaken:
        driver.call("configure_motion", 2 * MS, 100 * MS, 0)
        driver.call("stop")
        driver.engine.run(MS)
    driver.engine.engine.set(pin, 1 if pin == "alarm" else 0)
    assert end(driver) == ("OK" if overtaken else name)
    driver.engine.engine.set(pin, 0 if pin == "alarm" else 1)
    driver.engine.run(MS)
    if pin == "estop_n":
        driver.call("clear_estop")
    driver.call("clear")
    assert homed(driver) == NONE


@pytest.mark.parametrize("pin", ["limit_low", "probe"])
def test_a_stop_that_was_not_made_soft(driver: Driver, pin: str) -> None:
    """It is as hard as before if the frame of its setting did not arrive."""

    def set_up(soft: bool) -> str:
        if pin == "limit_low":
            config = struct("input_config", limit_low=True, limit_soft=soft)
            return error_of(driver, "configure_inputs", 0, config)
        action = TriggerAction.SOFT_STOP if soft else TriggerAction.HARD_STOP
        return error_of(
            driver, "arm_trigger", struct("trigger_config", source=TriggerSource.PROBE, action=action)
        )

    wire = driver.engine
    assert set_up(soft=False) == "OK"
    wire.there = lambda words: None if words[0] >> 28 == Operation.WRITE else words
    assert set_up(soft=True) == "STUCK_LOW"
    wire.there = list
    begin(driver, (-3000, 0, 0))
    wire.engine.set(pin, 1)
    assert end(driver) == ("LIMIT" if pin == "limit_low" else "TRIGGER")
    assert homed(driver) == [False, True, True]


def test_an_alarm_at_rest(driver: Driver) -> None:
    driver.engine.engine.set("alarm", 1)
    driver.engine.run(MS)
    assert error_of(driver, "move_by_speed", by_speed([1, 0, 0])) == "STOPPED"
    assert homed(driver) == NONE


@pytest.mark.parametrize("action", [TriggerAction.SOFT_STOP, TriggerAction.HARD_STOP])
def test_a_trigger(driver: Driver, action: TriggerAction) -> None:
    driver.call("arm_trigger", struct("trigger_config", source=TriggerSource.PROBE, action=action))
    begin(driver)
    driver.engine.engine.set("probe", 1)
    assert end(driver) == "TRIGGER"
    assert homed(driver) == (KEPT if action == TriggerAction.SOFT_STOP else MOVED)


@pytest.mark.parametrize("pressed", [1, 300])
def test_a_limit_at_the_end_of_a_probe(driver: Driver, pressed: int) -> None:
    """Found, it stops softly: a hard limit within that stop overrides and ends it, one at rest does not."""
    driver.call("configure_motion", 2 * MS, 100 * MS, 0)
    given = struct("probe", steps=[-20_000, 0, 0], speed=20_000 * Q32, acceleration=500_000 * Q32)
    driver.call("probe", given)
    driver.engine.run(100 * MS)
    driver.engine.engine.set("probe", 1)
    driver.engine.run(pressed * MS)
    driver.engine.engine.set("limit_low", 1)
    assert end(driver) == ("LIMIT" if pressed == 1 else "OK")
    assert homed(driver) == [pressed == 300, True, True]


def test_a_soft_stop_of_many_short_lines(driver: Driver) -> None:
    """It takes its time on the path, though the core holds less than that: the stream continues."""
    driver.call("configure_motion", 50 * MS, 50 * MS, 0)
    lines, ramps = path(20_000, 200)
    driver.stream(Source(lines, ramps))
    while driver.positions()[0] < 3000:
        driver.poll()
        driver.engine.run(MS // 50)
    driver.call("stop")
    stopped_at = driver.engine.clock
    while driver.is_moving:
        driver.poll()
        driver.engine.run(MS // 50)
    assert 49 * MS < driver.engine.clock - stopped_at < 70 * MS
    assert driver.cause == Cause.STOP and homed(driver) == KEPT
    driver.call("clear")
    assert driver.positions() == driver.engine.counted()[1]


@pytest.mark.parametrize("kind", ["lines", "ramps"])
def test_a_queue_that_runs_dry(driver: Driver, kind: str) -> None:
    """Without lines it stops dead, without ramps on its path."""
    lines, ramps = path(40)
    for line in lines:
        line.steps[1] = 0
        line.last = False
    ramps[-1].last = False
    lines[-1].last = kind == "ramps"
    ramps[-1].last = kind == "lines"
    driver.call("configure_motion", 2 * MS, 2 * MS, 0)
    if kind == "lines":
        ramps[-1].ticks *= 2
    driver.stream(Source([*lines, *[None] * 1000], [*ramps, *[None] * 1000]))
    for _ in range(20):
        driver.poll()
    driver.call("stream_start")
    assert end(driver) == ("LINE_UNDERRUN" if kind == "lines" else "RAMP_UNDERRUN")
    assert homed(driver) == ([False, True, True] if kind == "lines" else KEPT)


def test_the_watchdog_a_disable_and_a_reset(driver: Driver) -> None:
    """Drives that were or may be off."""
    begin(driver, (0, 60_000, 0))
    driver.engine.run(CLOCK_HZ)
    assert end(driver) == "WATCHDOG" and homed(driver) == NONE
    driver.call("clear")
    home(driver)
    driver.call("enable", 1, False)
    assert homed(driver) == [True, False, True]
    driver.engine.reset_core()
    driver.engine.run(2 * MS)
    assert error_of(driver, "poll") == "CORE_RESET" and homed(driver) == NONE


# --------------------------------------------------------------------------------------------- unknown ----


def blind(driver: Driver) -> None:
    """The filter has just been written."""
    driver.call("configure_filter", LONGEST)


def readings(driver: Driver) -> bool:
    now = struct("readings")
    driver.call("read_inputs", now)
    return now.unknown


def test_a_motion_waits_for_its_inputs(driver: Driver) -> None:
    """passo_wait() does not take it as ended."""
    blind(driver)
    driver.call("move_by_speed", by_speed([100, 0, 0]))
    assert readings(driver)
    for _ in range(4):
        driver.poll()
    assert driver.is_moving and driver.engine.counted()[1] == [0, 0, 0]
    driver.wait(1)
    assert driver.engine.counted()[1] == [100, 0, 0] and not readings(driver)


def flicker(driver: Driver, milliseconds: int) -> str:
    """A limit switch that never settles."""
    for n in range(4 * milliseconds):
        driver.engine.engine.set("limit_high", n % 2)
        driver.engine.run(MS // 4)
        if (name := error_of(driver, "poll")) != "OK":
            return name
    return "OK"


def test_inputs_that_never_stand_still(driver: Driver) -> None:
    """An error of its own after the stated time; then nothing is left that could begin."""
    blind(driver)
    driver.call("move_by_speed", by_speed([100, 0, 0]))
    assert flicker(driver, 90) == "OK" and driver.is_moving
    assert flicker(driver, 20) == "INPUTS_UNKNOWN"
    assert end(driver) == "OK" and driver.fault == "INPUTS_UNKNOWN"
    driver.engine.engine.set("limit_high", 0)
    driver.engine.run(20 * MS)
    assert driver.engine.counted()[1] == [0, 0, 0]
    driver.call("clear")
    driver.call("move_by_speed", by_speed([100, 0, 0]))
    assert end(driver) == "OK" and driver.engine.counted()[1] == [100, 0, 0]


@pytest.mark.parametrize("steps", [0, 500])
def test_a_jog_that_waits_is_cancelled(driver: Driver, steps: int) -> None:
    """It never begins, and nothing is to be cleared."""
    blind(driver)
    driver.call("jog", struct("jog", speed=10_000 * Q32, acceleration=10**6 * Q32, steps=steps))
    if not steps:
        assert error_of(driver, "jog_speed", 5000 * Q32) == "INPUTS_UNKNOWN"
    driver.call("jog_cancel")
    assert end(driver) == "OK" and driver.state == State.IDLE
    driver.engine.run(20 * MS)
    assert driver.engine.counted()[1] == [0, 0, 0]
    driver.call("move_by_speed", by_speed([7, 0, 0]))
    assert end(driver) == "OK" and driver.engine.counted()[1] == [7, 0, 0]


def test_a_goto_that_waits_is_changed(driver: Driver) -> None:
    """It goes to the new target, and never beyond it."""
    blind(driver)
    wanted = {"speed": 10_000 * Q32, "acceleration": 10**6 * Q32}
    driver.call("goto", struct("goto", target=500, **wanted))
    driver.call("goto", struct("goto", target=100, **wanted))
    assert end(driver) == "OK" and driver.engine.counted() == ([100, 0, 0], [100, 0, 0])


def changed(driver: Driver, frame: int, call: str, *arguments: Any) -> None:
    """A motion that waits for its inputs and for sync is changed; its inputs are known before a frame."""
    wire = driver.engine
    first = wire.frames + frame
    wire.before_frame = lambda number: wire.engine.run(2 * MS) if number == first else None
    driver.call(call, *arguments)
    wire.before_frame = lambda _: None
    for _ in range(20):
        wire.run(MS)
        driver.poll()
    assert wire.counted()[0] == [0, 0, 0]
    for edge in range(300):
        wire.engine.set("sync", edge % 2)
        wire.run(MS)
        driver.poll()
    assert not driver.is_moving


@pytest.mark.parametrize("frame", range(1, 7))
def test_a_motion_that_waits_for_sync_does_so_while_it_is_changed(driver: Driver, frame: int) -> None:
    """Whenever its inputs become known: no step before an edge, then it goes to the new target."""
    blind(driver)
    wanted = {"speed": 10_000 * Q32, "acceleration": 10**6 * Q32}
    driver.call("wait_for_sync", True)
    driver.call("goto", struct("goto", target=500, **wanted))
    changed(driver, frame, "goto", struct("goto", target=100, **wanted))
    assert driver.engine.counted() == ([100, 0, 0], [100, 0, 0])


@pytest.mark.parametrize("frame", range(1, 7))
def test_a_jog_that_waits_for_sync_does_so_while_it_is_cancelled(driver: Driver, frame: int) -> None:
    """No step before an edge, nor more than a few after it."""
    blind(driver)
    driver.call("wait_for_sync", True)
    driver.call("jog", struct("jog", speed=10_000 * Q32, acceleration=10**6 * Q32, steps=500))
    changed(driver, frame, "jog_cancel")
    assert 0 <= driver.positions()[0] == driver.engine.counted()[1][0] < 5


@pytest.mark.parametrize("pressed", [False, True])
def test_home_knows_its_switch_before_it_moves(driver: Driver, pressed: bool) -> None:
    """A pressed switch is left, however long the filter; it was taken for a free one."""
    driver.engine.engine.set("home", int(pressed))
    blind(driver)
    fields = {"source": TriggerSource.HOME, "distance": -3000, "back_off": 50, "speed": 20_000 * Q32}
    homes = ffi().new(
        "struct passo_home[]", [{**fields, "slow_speed": 2000 * Q32, "acceleration": 10**6 * Q32}]
    )
    driver.call("home", homes, 1)
    driver.engine.run(5 * MS)
    assert (driver.engine.counted()[1][0] > 0) == pressed


def report(driver: Driver) -> Any:
    now = struct("trigger_report")
    driver.call("read_trigger", now)
    return now


@pytest.mark.parametrize("late", range(0, 2400, 75))
def test_a_pulse_no_longer_than_the_filter_fires_no_trigger(driver: Driver, late: int) -> None:
    """Also while it is being armed, whatever the clock."""
    driver.call("configure_filter", 1000)
    driver.engine.run(3000)
    driver.call("arm_trigger", struct("trigger_config", source=TriggerSource.PROBE))
    driver.engine.run(late)
    driver.engine.engine.set("probe", 1)
    driver.engine.run(1000)
    driver.engine.engine.set("probe", 0)
    driver.engine.run(4000)
    now = report(driver)
    assert now.armed and not now.fired
    driver.engine.engine.set("probe", 1)
    driver.engine.run(2100)
    assert report(driver).fired


@pytest.mark.parametrize("level", [0, 1])
def test_a_trigger_armed_on_an_unknown_input(driver: Driver, level: int) -> None:
    """It is armed when the input is known, at the level that it has; the next edge to active fires it."""
    blind(driver)
    driver.engine.engine.set("probe", level)
    driver.call("arm_trigger", struct("trigger_config", source=TriggerSource.PROBE))
    assert report(driver).arming
    driver.engine.run(3 * LONGEST)
    now = report(driver)
    assert now.armed and not now.arming and not now.fired
    for wanted in (0, 1):
        driver.engine.engine.set("probe", wanted)
        driver.engine.run(2 * LONGEST)
    assert report(driver).fired


def test_a_shorter_filter_counts_at_once(driver: Driver) -> None:
    """Not after a period of the old one."""
    blind(driver)
    driver.call("configure_filter", 4)
    driver.engine.run(100)
    assert not readings(driver)


def test_a_filter_changed_while_a_motion_runs(driver: Driver) -> None:
    """It goes on; a switch stops it when it has been active for the new filter."""
    driver.call("move_by_speed", by_speed([-20_000, 0, 0], speed=20_000))
    driver.engine.run(50 * MS)
    blind(driver)
    before = driver.engine.counted()[1][0]
    driver.engine.engine.set("limit_low", 1)
    driver.engine.run(2 * LONGEST + MS)
    made = before - driver.engine.counted()[1][0]
    assert 0 < made <= 20_000 * (2 * LONGEST + MS) / CLOCK_HZ + 5
    there = driver.engine.counted()[1]
    assert end(driver) == "LIMIT" and driver.engine.counted()[1] == there == driver.positions()


def test_a_polarity_written_while_a_switch_bounces(driver: Driver) -> None:
    """Nothing begins before it rests; then it has the new meaning."""
    driver.call("configure_filter", 40_000)
    driver.engine.engine.set("limit_high", 1)
    driver.engine.run(3 * MS)
    driver.call("clear_flags")
    driver.call("configure_inputs", 0, struct("input_config", limit_high=True, limit_high_inverted=True))
    driver.call("move_by_speed", by_speed([100, 0, 0]))
    assert flicker(driver, 20) == "OK" and driver.engine.counted()[1] == [0, 0, 0] and readings(driver)
    driver.engine.engine.set("limit_high", 1)  # inactive, as it is inverted now
    assert end(driver) == "OK" and driver.engine.counted()[1] == [100, 0, 0]
