# SPDX-License-Identifier: MIT
"""Single sentences of passo.h that no other test of the driver needs."""

import faulthandler
from typing import Any

import pytest
from passo import registers as r
from passo.build import Parameters
from passo.driver import Driver
from passo.native import ffi, planner
from passo.registers import Operation

from benchmarks.squaring import Gantry, begin, square
from tests.helpers.driver_wire import CLOCK_HZ, Q32, Wire, by_speed, error_of, finish, open_driver, struct


def test_no_time_at_a_pin_is_a_clock(driver: Driver) -> None:
    """Times are rounded up to 1 .. PASSO_PIN_CLOCKS_MAX, whatever their unit: a step takes two."""
    for in_clocks in (False, True):
        driver.call("configure_axis", 1, struct("axis_config", in_clocks=in_clocks))
        assert planner().passo_highest_speed(driver.c, 1, Q32) == CLOCK_HZ // 2 * Q32
    driver.call("enable", 1, True)
    driver.call("move_by_speed", by_speed([0, 300, 0, 0]))
    finish(driver)
    assert driver.engine.counted()[1][1] == driver.positions()[1] == 300


def test_the_bound_of_racking_is_allowed() -> None:
    """Motors may end exactly that far apart."""
    for offset, error in ((20, "OK"), (21, "SWITCH_MISSED")):
        made = square(Gantry((900, 1280), (0, 0), offsets=(0, offset, 0), racking=400))
        assert made.error == error


def test_fresh_tables_are_not_loaded() -> None:
    """After a reset the core has those of all profiles."""
    for profile in ("COSINE", "SIGMOID"):
        driver = open_driver(Wire())
        move = by_speed([400, 0, 0, 0], acceleration=2_000_000)
        move.profile = getattr(planner(), f"PASSO_PROFILE_{profile}")
        driver.engine.requests.clear()
        driver.call("move_by_speed", move)
        written = [request for request in driver.engine.requests if request[0] >> 28 == Operation.WRITE]
        assert not any(request[0] & 0xFFF >= r.ADDRESS_COSINE_BASE for request in written)
        finish(driver)


@pytest.mark.parametrize(("racking", "error"), [(102, "OK"), (101, "ARGUMENT")])
def test_the_bound_of_racking_is_twice_the_way_to_the_slow_speed(racking: int, error: str) -> None:
    """v^2 / 2 a, and a step, is the way."""
    driver, rig, (homes, _) = begin(Gantry((900, 900), (0, 0), racking=racking, slow=2000, speed=2000))
    assert error_of(driver, "home", homes, 1) == error
    rig.engine.close()


NULL = ffi().NULL
WITH_ALL = Parameters(inputs=1, outputs=1, raster=1, compare=1, encoders=1, trackers=1)
POINTERS = [
    *[(call, NULL) for call in ("arm_trigger", "read_trigger", "read_inputs", "probe", "jog", "goto")],
    *[(call, NULL) for call in ("set_output", "configure_outputs", "read_outputs", "arm_compare")],
    *[(call, NULL) for call in ("thread", "pass", "read_thread", "configure_tracker", "stream")],
    *[(call, NULL) for call in ("positions", "target", "move_turn", "move_straight", "move_jerk")],
    *[(call, 0, NULL) for call in ("configure_axis", "configure_inputs", "configure_encoder")],
    *[(call, 0, NULL) for call in ("read_encoder", "read_tracker", "lost_steps")],
    *[("home", NULL, 1), ("track_to", NULL, 5), ("turn_start", NULL, Q32), ("move_plan", NULL, NULL)],
    *[("push_raster", NULL, 4, ffi().new("size_t *")), ("angle", 0, 1600, NULL), ("rpm", 1600, NULL)],
]


@pytest.fixture(scope="module")
def with_all() -> Driver:
    return open_driver(Wire(WITH_ALL))


@pytest.mark.parametrize("call", POINTERS, ids=[name for name, *_ in POINTERS])
def test_no_pointer_is_an_error(with_all: Driver, call: tuple[Any, ...]) -> None:
    """Not a crash, and nothing is sent."""
    frames = with_all.engine.frames
    assert error_of(with_all, *call) == "ARGUMENT" and with_all.engine.frames == frames


@pytest.mark.parametrize(
    ("call", "rest"),
    [
        *[(call, (NULL,)) for call in ("set_output", "configure_outputs", "read_outputs", "arm_compare")],
        *[(call, (NULL, NULL)) for call in ("output_word",)],
        *[("set_levels", (0,)), ("set_pitch", (1,)), ("disarm_compare", ())],
        *[("push_raster", (NULL, 0, NULL)), ("thread", (NULL,)), ("pass", (NULL,))],
    ],
)
def test_no_channel_is_an_error(call: str, rest: tuple[Any, ...]) -> None:
    assert getattr(planner(), f"passo_{call}")(NULL, *rest) == planner().PASSO_ERROR_ARGUMENT


def test_an_axis_that_is_none_has_no_speed(with_all: Driver) -> None:
    for axis in (with_all.c.axes, 255):
        assert planner().passo_highest_speed(with_all.c, axis, Q32) == 0


def test_a_frame_that_is_gone_is_sent_again() -> None:
    """The host was opened again for another channel: one whose hold was due does not wait for it forever."""
    wire = Wire(Parameters(channels=2))
    driver, lib = open_driver(wire), planner()
    host, other = driver.c.host, ffi().new("struct passo *")
    options = [struct("options", channel=channel, clock_hz=wire.clock_hz) for channel in range(2)]
    assert lib.passo_open_channel(other, host, options[1]) == 0
    wire.there = lambda words: None
    lib.passo_hold(other)
    lib.passo_poll(other)
    wire.there = list
    hardware = ffi().new("struct passo_hardware *", host.hardware)
    assert lib.passo_open(driver.c, host, hardware, options[0]) == 0
    faulthandler.dump_traceback_later(60, exit=True)
    assert lib.passo_clear(other) == 0
    faulthandler.cancel_dump_traceback_later()


def test_a_motion_whose_inputs_stay_unknown_is_given_up() -> None:
    """After 0.1 s, if they change within the filter all the time: it was not begun."""
    engine, told, between = Wire(Parameters(inputs=1), 8_000_000), [], 60_000
    driver = open_driver(engine)
    driver.call("configure_filter", 65_535)
    driver.call("move_by_speed", by_speed([100, 0, 0, 0]))
    for change in range(16):
        engine.engine.set("home", change % 2)
        engine.run(between)
        told += [error for error in [error_of(driver, "poll")] if error != "OK"]
        assert not told or change * between > engine.clock_hz // 10
    assert told == ["INPUTS_UNKNOWN"] and engine.counted()[0] == [0, 0, 0, 0]
