# SPDX-License-Identifier: MIT
"""Single sentences of passo.h that no other test of the driver needs."""

import pytest
from passo import registers as r
from passo.driver import Driver
from passo.native import ffi, planner
from passo.registers import Operation

from benchmarks.squaring import Gantry, begin, square
from tests.helpers.driver_wire import CLOCK_HZ, Q32, Wire, by_speed, error_of, finish, open_driver, struct
from tests.test_driver_sessions import PARAMETERS


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


def test_no_thread_is_an_error() -> None:
    """Not a crash."""
    assert error_of(open_driver(Wire(PARAMETERS)), "thread", ffi().NULL) == "ARGUMENT"
