# SPDX-License-Identifier: MIT
"""Squaring (stm32_bridge/driver/passo_square.c): each motor of an axis at its own switch."""

import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import pytest
from passo.driver import Driver
from passo.engine import AroundEngine
from passo.machine import Switch
from passo.native import ffi
from passo.random_cases import seed
from passo.registers import (
    ADDRESS_CHANNEL_BASE,
    CHANNEL_TRIGGER,
    CHANNEL_TRIGGER_ARM_LSB,
    CHANNEL_TRIGGER_STATE,
    CHANNEL_TRIGGER_STATE_ARMED_LSB,
    CHANNEL_TRIGGER_STATE_ARMING_LSB,
    Operation,
    TriggerSource,
)

from benchmarks import squaring
from benchmarks.squaring import CLOCK_HZ, Gantry, begin, gantry_of, problems, square
from tests.helpers.driver_wire import Q32, by_speed, error_of, open_driver, struct
from tests.test_driver_home import driver_of, home, machine_of
from tests.test_driver_home import homes as home_array

SKEWED = Gantry((900, 1200), (0, 10))


def test_random_gantries() -> None:
    """The short form of `python -m benchmarks.squaring`."""
    rng = random.Random(seed())
    for _ in range(12):
        gantry = gantry_of(rng)
        assert problems(gantry, square(gantry)) == [], gantry


@pytest.mark.parametrize("high", [False, True])
@pytest.mark.parametrize("start", [(1500, 1300), (-20, 400), (-20, -5), (300, -60), (40, 40)])
def test_wherever_it_starts(start: tuple[int, int], high: bool) -> None:
    """Also with a motor, or both, at its switch: square, and at one position."""
    sign = -1 if high else 1
    gantry = Gantry((sign * start[0], sign * start[1]), (0, 0), high, (0, 25, 0), racking=500)
    made = square(gantry)
    assert problems(gantry, made) == [] and made.skewed is None
    assert made.positions == [sign * gantry.pull_off] * 2


@pytest.mark.parametrize(("start", "motor"), [((900, 1450), 1), ((1450, 900), 0), ((900, 1000, 1450), 2)])
def test_a_skew_beyond_the_bound_names_its_motor(start: tuple[int, ...], motor: int) -> None:
    """And the motors are not further apart than the bound."""
    made = square(Gantry(start, (0,) * len(start), racking=400))
    assert (made.error, made.skewed) == ("SWITCH_MISSED", motor)
    assert made.racking <= 400


@pytest.mark.parametrize("start", [(2799, 2764), (2787, 2764), (2786, 2764), (2600, 2764)])
def test_a_motor_close_to_its_edge_has_its_speed_there(start: tuple[int, int]) -> None:
    """So the filter, which is two steps late here, is as late for each of them."""
    gantry = Gantry(start, (13, -10), racking=703, slow=1919, speed=4966, filter=0.00098398, stop=0.007)
    made = square(gantry)
    assert problems(gantry, made) == [] and made.square == 0


@pytest.mark.parametrize("skew", [190, 240, 255, 285, 299, 301])
def test_an_edge_near_the_end_of_the_bound(skew: int) -> None:
    """Its motor has its speed there, or would stop, and the cycle ends: it is never told late."""
    gantry = Gantry((900, 900 + skew), (0, 0), racking=300, slow=2500, speed=3000, filter=0.0027)
    made = square(gantry)
    assert made.racking <= 300
    if skew < 300 - 2500**2 / (2 * 20 * 3000) - 5:
        assert problems(gantry, made) == []
    else:
        assert (made.error, made.skewed) == ("SWITCH_MISSED", 1)


@pytest.mark.parametrize(("offset", "error"), [(-40, "OK"), (0, "OK"), (15, "OK"), (40, "SWITCH_MISSED")])
def test_the_bound_is_also_one_of_offsets(offset: int, error: str) -> None:
    """The motors would end further apart than it: they do not go there."""
    made = square(Gantry((900, 1280), (0, 0), offsets=(0, offset, 0)))
    assert (made.error, made.skewed) == (error, 1 if error != "OK" else None)
    assert made.racking <= 400


@pytest.mark.parametrize("motor", [0, 1])
def test_a_switch_that_is_never_pressed(motor: int) -> None:
    """The other motor finds its own; then the bound ends it."""
    made = square(replace(SKEWED, stuck={motor: False}))
    assert (made.error, made.skewed) == ("SWITCH_MISSED", motor) and made.racking <= SKEWED.racking


@pytest.mark.parametrize("motor", [0, 1])
def test_a_switch_that_sticks(motor: int) -> None:
    """All motors leave it together, and it is not left: no racking."""
    made = square(replace(SKEWED, stuck={motor: True}))
    assert (made.error, made.skewed) == ("SWITCH_MISSED", None) and made.racking == 0


@pytest.mark.parametrize("start", [(900, 1280, 1000), (900, 1000, 1280)])
def test_a_motor_whose_edge_is_known_is_in_line_again(start: tuple[int, ...]) -> None:
    """Before the next one goes away from its own: they are not further apart than the bound."""
    gantry = Gantry(start, (0, 0, 0), racking=400)
    assert problems(gantry, square(gantry)) == []


@pytest.mark.parametrize("racking", [361, 400])
def test_a_switch_that_is_not_left_within_the_bound(racking: int) -> None:
    """Its motor goes as far as it may, to the step."""
    made = square(Gantry((900, 900), (0, 0), racking=racking, hysteresis=500))
    assert (made.error, made.skewed, made.racking) == ("SWITCH_LEVEL", None, racking)


def play(driver: Driver, homes: Any, change: Callable[[list[int]], None]) -> tuple[str, int]:
    """Home the motors of a machine whose switches change; the error, and how far they were apart."""
    machine, error, apart = driver.engine, error_of(driver, "home", homes, 1), 0
    begin = machine.positions[0] - machine.positions[1]
    while error == "OK" and driver.is_moving:
        machine.run(CLOCK_HZ // 2000)
        change(machine.positions.tolist())
        apart = max(apart, abs(machine.positions[0] - machine.positions[1] - begin))
        error = error_of(driver, "poll")
    return error, apart


def pair(**fields: Any) -> Any:
    """Both motors of an axis at their low limits."""
    return home_array(home(source=TriggerSource.LIMIT_LOW, forward=3, back_off=60, pull_off=150, **fields))


def test_another_switch_that_is_first_the_second_time() -> None:
    """The motors leave it as they left the first one."""
    first, second = Switch("limit_low", 0, 0), Switch("limit_low", 1, 0)
    driver = driver_of(machine_of(first, second, start=[120, 100]))

    def change(places: list[int]) -> None:
        if second.edges and places[1] > 50:
            first.at = 40

    error, apart = play(driver, pair(racking=400), change)
    assert error == "OK" and apart <= 400
    assert driver.engine.positions[:2].tolist() == pytest.approx([190, 150], abs=2)


def test_a_switch_that_is_earlier_the_second_time() -> None:
    """Its motor is behind the line then, and the bound of the other one counts from there."""
    first, second = Switch("limit_low", 0, 0), Switch("limit_low", 1, 0, stuck=False)
    driver = driver_of(machine_of(first, second, start=[100, 100]))

    def change(places: list[int]) -> None:
        if places[0] - places[1] > 50:
            first.at = 30

    error, apart = play(driver, pair(racking=400), change)
    assert error == "SWITCH_MISSED" and 390 <= apart <= 400


def test_an_alarm_stops_all_motors_on_one_clock() -> None:
    driver, machine, (homes, _) = begin(SKEWED)
    driver.call("configure_inputs", 1, struct("input_config", limit_low=True, limit_soft=True))
    driver.call("home", homes, 1)
    machine.run(CLOCK_HZ // 50)
    driver.call("poll")
    machine.set("alarm", 2)
    machine.run(CLOCK_HZ // 100)
    one, other = machine.positions[0] - SKEWED.start[0], machine.positions[1] - SKEWED.start[1]
    assert one == other < 0
    assert error_of(driver, "poll") == "ALARM" and not driver.lib.passo_is_homed(driver.c, 0)
    machine.engine.close()


def test_power_off_within_the_cycle() -> None:
    """Neither motor is homed, and the next cycle squares what is left."""
    driver, machine, (homes, _) = begin(SKEWED)
    driver.call("home", homes, 1)
    for _ in range(400):
        driver.call("poll")
        machine.run(CLOCK_HZ // 2000)
    places = tuple(int(place) for place in machine.positions[:2])
    assert places != SKEWED.start and driver.is_moving
    assert not any(driver.lib.passo_is_homed(driver.c, motor) for motor in (0, 1))
    machine.engine.close()
    rest = replace(SKEWED, start=places)
    assert problems(rest, square(rest)) == []


@pytest.mark.parametrize(
    ("changes", "error"),
    [
        ({"backward": 2}, "ARGUMENT"),
        ({"forward": 0}, "ARGUMENT"),
        ({"forward": 7}, "NO_SWITCH"),  # the switch of the third motor is missing
        ({"source": 3}, "NO_SWITCH"),  # one home switch for all
        ({"back_off": 401}, "ARGUMENT"),
        ({"pull_off": 5}, "ARGUMENT"),  # the offset is more
        ({"slow_speed": 13_000 * Q32}, "ARGUMENT"),  # takes more than half the bound to stop
    ],
)
def test_what_no_gantry_has_is_refused(changes: dict[str, int], error: str) -> None:
    driver, machine, (homes, kept) = begin(replace(SKEWED, offsets=(0, 6, 0)))
    for name, value in changes.items():
        setattr(homes[0], name, value)
    assert error_of(driver, "home", homes, 1) == error and len(kept)
    machine.engine.close()


def test_as_often_as_one_likes() -> None:
    """What a cycle has known or tried is forgotten by the next one."""
    driver, machine, (homes, kept) = begin(SKEWED)
    for _ in range(10):
        driver.call("home", homes, 1)
        while driver.is_moving:
            driver.call("poll")
            machine.run(CLOCK_HZ // 2000)
        assert driver.fault == "OK" and driver.positions()[:2] == [SKEWED.pull_off] * 2
        driver.call("move_by_speed", by_speed([40, 90], speed=2000))
        driver.wait(1)
    machine.engine.close()
    assert len(kept)


@pytest.mark.parametrize(("racking", "error"), [((1 << 28) - 1, "OK"), (1 << 28, "ARGUMENT")])
def test_the_greatest_bound(racking: int, error: str) -> None:
    """A quarter of a line."""
    driver, machine, (homes, kept) = begin(SKEWED)
    homes[0].racking = racking
    assert error_of(driver, "home", homes, 1) == error and len(kept)
    machine.engine.close()


class Lossy(AroundEngine):
    """A link on which nothing arrives from a certain disarming of the trigger on, until it is mended."""

    def __init__(self, engine: Any, disarming: int):
        super().__init__(engine)
        self.disarmings, self.lost_from, self.is_lost = 0, disarming, False

    def __getattr__(self, name: str) -> Any:
        return getattr(self.engine, name)

    def transfer(self, mosi: Sequence[int], gap: int = 16) -> list[int]:
        """A frame."""
        write, address = mosi[0] >> 28 == Operation.WRITE, mosi[0] & 0xFFF
        if (
            write
            and address == ADDRESS_CHANNEL_BASE + CHANNEL_TRIGGER
            and not self.is_lost
            and mosi[1] >> CHANNEL_TRIGGER_ARM_LSB & 1 == 0
        ):
            self.is_lost = self.disarmings == self.lost_from
            self.disarmings += 1
        return [0] * len(mosi) if self.is_lost else self.engine.transfer(mosi, gap)


@pytest.mark.parametrize(("start", "disarming"), [((1200, 900), 0), ((1450, 900), 0), ((1450, 900), 1)])
def test_a_trigger_whose_disarming_is_lost_is_disarmed_by_clear(
    start: tuple[int, int], disarming: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the limit of another motor has stopped the axis. Otherwise it stops a later move."""
    links: list[Lossy] = []

    def opened(engine: Any) -> Driver:
        links.append(Lossy(engine, disarming + 1))  # the first is that of the opening
        return open_driver(links[-1])

    monkeypatch.setattr(squaring, "open_driver", opened)
    driver, rig, (homes, _) = begin(Gantry(start, (10, 0)))
    error = error_of(driver, "home", homes, 1)
    while error == "OK" and driver.is_moving:
        error = error_of(driver, "poll")
        rig.run(CLOCK_HZ // 2000)
    assert links[0].is_lost
    links[0].is_lost, links[0].lost_from = False, -1
    rig.run(CLOCK_HZ // 10)
    assert error_of(driver, "clear") == "OK"
    word = ffi().new("uint32_t *")
    address = driver.c.base + CHANNEL_TRIGGER_STATE
    assert driver.lib.passo_host_read(driver.c.host, address, word, 1) == 0
    assert word[0] >> CHANNEL_TRIGGER_STATE_ARMED_LSB & 1 == 0
    assert word[0] >> CHANNEL_TRIGGER_STATE_ARMING_LSB & 1 == 0
    rig.engine.close()
