# SPDX-License-Identifier: MIT
"""Encoders of the driver (stm32_bridge/driver/passo_encoder.h): shafts that turn at the C model."""

from collections.abc import Callable
from typing import Any

import pytest
from passo.build import Parameters
from passo.driver import Driver, DriverError
from passo.engine import AroundEngine, model_engine
from passo.registers import Cause, State

from tests.helpers.driver_wire import CLOCK_HZ, Q32, Wire, by_speed, error_of, open_driver, struct

PARAMETERS = Parameters(encoders=1)
GRAY = ((0, 0), (1, 0), (1, 1), (0, 1))  # A and B while a shaft turns up
PER_TURN = 400
SPINDLE = 2
RATIO_ONE = 1 << 16


class Shafts(AroundEngine):
    """The C model with shafts at the encoders of its axes; moves(), while time passes, turns them."""

    GRAIN = 360  # clocks

    def __init__(self) -> None:
        super().__init__(model_engine(PARAMETERS, CLOCK_HZ))
        self.at = [0, 0, 0, 0]  # counts
        self.positions = [0, 0, 0, 0]  # steps that left the pins
        self.steps: list[tuple[int, int]] = []  # clock of each step of axis 0, and count of the spindle
        self.moves: Callable[[], None] = lambda: None
        self._step = 0

    def transfer(self, mosi: list[int], gap: int = 64) -> list[int]:
        """One chip select, in which the shafts rest."""
        miso = self.engine.transfer(mosi, gap)
        self._look()
        return miso

    def run(self, clocks: int) -> int:
        """Let time pass."""
        done = 0
        while done < clocks:
            self.moves()
            done += self.engine.run(min(self.GRAIN, clocks - done))
            self._look()
        return done

    def turn(self, axis: int, counts: int) -> None:
        """Turn a shaft, count by count."""
        for _ in range(abs(counts)):
            self.at[axis] += 1 if counts > 0 else -1
            levels = [GRAY[at % 4] for at in self.at]
            self.engine.set("encoder_a", sum(a << i for i, (a, _) in enumerate(levels)))
            self.engine.set("encoder_b", sum(b << i for i, (_, b) in enumerate(levels)))
            index = sum((at % PER_TURN == 0) << i for i, at in enumerate(self.at))
            self.engine.set("encoder_index", index)
            self.engine.run(12)

    def _look(self) -> None:
        for event in self.engine.drain():
            step, direction = int(event["step"]), int(event["dir"])
            for axis in range(4):
                if (step & ~self._step) >> axis & 1:
                    self.positions[axis] += -1 if direction >> axis & 1 else 1
                    if axis == 0:
                        self.steps.append((int(event["clock"]), self.at[SPINDLE]))
            self._step = step


def machine(**config: Any) -> tuple[Driver, Shafts]:
    """A driver; with a configuration, the encoder of axis 0 has it."""
    shafts = Shafts()
    driver = open_driver(shafts)
    driver.call("configure_motion", CLOCK_HZ // 1000, CLOCK_HZ // 1000, 0)
    if config:
        driver.call("configure_encoder", 0, struct("encoder_config", **config))
    return driver, shafts


def reading(driver: Driver, axis: int = 0) -> Any:
    now = struct("encoder_reading")
    driver.call("read_encoder", axis, now)
    return now


def thread(**fields: Any) -> Any:
    """On the spindle, with a top speed above the speed at which spin() turns it."""
    return struct("thread", **({"encoder": SPINDLE, "top_speed": 300_000 * Q32} | fields))


def test_a_core_without_encoders() -> None:
    """Each call says so."""
    driver = open_driver(Wire())
    config = struct("encoder_config", ratio=1, limit=1)
    for call, *arguments in (
        ("configure_encoder", 0, config),
        ("configure_encoder_filter", 1),
        ("read_encoder", 0, struct("encoder_reading")),
        ("adopt_encoder", 0),
        ("thread", thread(steps=[1], counts=9)),
        ("read_thread", struct("thread_state")),
    ):
        assert error_of(driver, call, *arguments) == "NO_ENCODERS", call


def test_settings_that_contradict() -> None:
    """Each has its error."""
    driver, _ = machine()
    for config, name in (
        ({"ratio": 0}, "RATIO"),
        ({"limit": 0}, "FOLLOWING_LIMIT"),
        ({"stop": 3}, "ARGUMENT"),
    ):
        wanted = struct("encoder_config", **({"ratio": 9, "limit": 9} | config))
        assert error_of(driver, "configure_encoder", 0, wanted) == name
    assert error_of(driver, "configure_encoder", 4, struct("encoder_config")) == "ARGUMENT"
    assert error_of(driver, "configure_encoder_filter", 256) == "ENCODER_FILTER"
    assert error_of(driver, "adopt_encoder", 0) == "RATIO"
    for fields, name in (
        ({"steps": [0]}, "NO_STEPS"),
        ({"counts": 0}, "NO_COUNTS"),
        ({"steps": [6401]}, "STEEP"),
        ({"steps": [1 << 30]}, "TOO_MANY_STEPS"),
        ({"top_speed": 0}, "FOLLOW_SPEED"),
        ({"top_speed": CLOCK_HZ * Q32}, "FOLLOW_SPEED"),
        ({"steps": [1000]}, "PINS_TOO_SLOW"),
        ({"encoder": 4}, "ARGUMENT"),
        ({"steps": [0, 0, 0, 0, 1]}, "ARGUMENT"),
    ):
        assert error_of(driver, "thread", thread(**({"steps": [20], "counts": 100} | fields))) == name
    driver.call("move_by_speed", by_speed([5000, 0, 0, 0]))
    assert error_of(driver, "thread", thread(steps=[20], counts=100)) == "MOVING"
    wanted = struct("encoder_config", ratio=9, limit=9)
    assert error_of(driver, "configure_encoder", 0, wanted) == "MOVING"


def test_counts_are_transitions() -> None:
    """Up and down, either polarity, the index, the speed; a change of both lines is none."""
    driver, shafts = machine()
    shafts.turn(0, 1000)
    shafts.turn(1, -77)
    shafts.engine.run(100)
    now = reading(driver)
    assert (now.counts, now.latch, now.indexes, now.illegal) == (1000, 800, 2, 0)
    assert now.speed == -(1 << 63) and reading(driver, 1).counts == -77
    shafts.run(CLOCK_HZ // 1000)
    before = now.at
    shafts.turn(0, 250)
    driver.call("read_encoder", 0, now)
    assert now.counts == 1250
    assert now.speed / Q32 == pytest.approx(250e6 / (now.at - before), rel=1e-3)
    config = struct("encoder_config", ratio=RATIO_ONE, limit=9, inverted=True)
    driver.call("configure_encoder", 1, config)
    start = reading(driver, 1).counts
    shafts.turn(1, 40)
    shafts.engine.run(100)
    assert reading(driver, 1).counts == start - 40
    assert reading(driver, 3).illegal == 0
    shafts.engine.set("encoder_a", 8)
    shafts.engine.set("encoder_b", 8)
    shafts.engine.run(100)
    assert reading(driver, 3).illegal == 1
    driver.call("zero")
    assert reading(driver).counts == 0


def follow_steps(shafts: Shafts, counts: int, slip: int = 0) -> Callable[[], None]:
    """The shaft of axis 0 goes where the steps tell it, but for every slip-th step."""

    def move() -> None:
        made = shafts.positions[0]
        lost = made // slip if slip else 0
        shafts.turn(0, (made - lost) * counts - shafts.at[0])

    return move


def test_an_axis_that_follows() -> None:
    """2 counts per step: nothing is stopped, and the error ends below a count."""
    driver, shafts = machine(ratio=RATIO_ONE * 2, limit=40, stop=2)
    shafts.moves = follow_steps(shafts, 2)
    driver.call("move_by_speed", by_speed([500, 0, 0, 0], speed=20_000))
    driver.wait(1)
    shafts.run(2000)
    now = reading(driver)
    assert now.counts == 1000 and now.error == 0 and 2 <= now.greatest < 40 and not now.exceeded


@pytest.mark.parametrize("stop", [1, 2])
def test_lost_steps_and_the_way_back(stop: int) -> None:
    """FOLLOWING within its limit; clear alone moves nothing; adopt: the position is that of the shaft."""
    driver, shafts = machine(ratio=RATIO_ONE * 2, limit=60, stop=stop)
    shafts.moves = follow_steps(shafts, 2, slip=10)
    driver.call("set_position", 0, 5000)
    driver.call("move_by_speed", by_speed([9000, 0, 0, 0], speed=10_000))
    with pytest.raises(DriverError, match="FOLLOWING"):
        driver.wait(2)
    shafts.run(CLOCK_HZ // 100)
    assert driver.cause == Cause.FOLLOWING_ERROR and driver.fault == "FOLLOWING"
    made = shafts.positions[0]
    # a step in ten is lost: 30 lost steps are the limit; a soft stop makes some more
    assert 240 <= made <= 320 and driver.positions()[0] == 5000 + made
    shafts.moves = lambda: None
    shafts.turn(0, -20)
    shafts.engine.run(100)
    assert reading(driver).exceeded and reading(driver).error == (2 * made - shafts.at[0]) << 8
    driver.call("clear")
    driver.call("move_by_speed", by_speed([900, 0, 0, 0], speed=10_000))
    with pytest.raises(DriverError, match="FOLLOWING"):
        driver.wait(2)
    assert shafts.positions[0] == made
    driver.call("adopt_encoder", 0)
    driver.call("clear")
    shafts.run(CLOCK_HZ // 100)
    assert shafts.positions[0] == made and driver.state == State.IDLE
    assert driver.positions()[0] == 5000 + shafts.at[0] // 2
    assert reading(driver).error == 0 and not reading(driver).exceeded
    start, base = shafts.at[0], made
    shafts.moves = lambda: shafts.turn(0, start + 2 * (shafts.positions[0] - base) - shafts.at[0])
    driver.call("move_to_by_speed", 1, by_speed([5000, 0, 0, 0], speed=10_000))
    driver.wait(2)
    assert driver.positions()[0] == 5000 and shafts.at[0] == 0


@pytest.mark.parametrize("map_of_motors", ["ganged", "corexy"])
def test_an_encoder_is_of_a_motor(map_of_motors: str) -> None:
    """One motor that loses steps stops all on one clock; adopting moves the position of that motor alone."""
    sign = 1 if map_of_motors == "ganged" else -1  # of the second motor: +Y of a CoreXY, X + Y and X - Y
    driver, shafts = machine(ratio=RATIO_ONE * 2, limit=60, stop=1)
    driver.call("configure_encoder", 1, struct("encoder_config", ratio=RATIO_ONE * 2, limit=60, stop=1))
    slips = (0, 10)  # a step in ten of the second motor is lost
    shafts.moves = lambda: [
        shafts.turn(axis, 2 * (at - (int(at / slip) if slip else 0)) - shafts.at[axis])
        for axis, (at, slip) in enumerate(zip(shafts.positions[:2], slips, strict=True))
    ]
    driver.call("move_by_speed", by_speed([9000, 9000 * sign, 0, 0], speed=10_000))
    with pytest.raises(DriverError, match="FOLLOWING"):
        driver.wait(2)
    shafts.run(CLOCK_HZ // 100)
    made = shafts.positions[0]
    assert 240 <= made <= 330 and shafts.positions[1] == sign * made
    shafts.moves = lambda: None
    shafts.turn(1, -20 * sign)
    shafts.engine.run(100)
    assert reading(driver, 1).exceeded and not reading(driver, 0).exceeded
    assert not any(driver.lib.passo_is_homed(driver.c, motor) for motor in (0, 1))
    driver.call("adopt_encoder", 1)
    driver.call("clear")
    shafts.run(CLOCK_HZ // 100)
    places = driver.positions()
    assert places[0] == made and places[1] == shafts.at[1] // 2 != sign * made


def test_an_error_off_its_scale() -> None:
    """It cannot tell where the axis is."""
    driver, shafts = machine(ratio=0xFFFFFFFF, limit=0xFFFF)
    driver.call("move_by_speed", by_speed([3, 0, 0, 0]))
    driver.wait(1)
    assert error_of(driver, "adopt_encoder", 0) == "OFF_SCALE"
    assert shafts.positions[0] == 3


def spin(shafts: Shafts, counts: int = 1) -> Callable[[], None]:
    """The spindle turns whenever time passes."""
    return lambda: shafts.turn(SPINDLE, counts)


@pytest.mark.parametrize(("steps", "counts"), [(700, 3000), (-333, 2000), (3000, 2000), (2048, 4096)])
def test_a_thread_has_its_pitch_and_phase(steps: int, counts: int) -> None:
    """Every step within a count of the exact pitch, also with more steps than counts; each pass the same."""
    driver, shafts = machine()
    passes = []
    for _ in range(3):
        shafts.moves = spin(shafts)
        driver.call("move_to_by_speed", 3, by_speed([0, 0, 0, 0]))
        driver.wait(1)
        shafts.steps.clear()
        driver.call("thread", thread(steps=[steps, steps // 3], counts=counts, wait_index=True))
        driver.wait(5)
        assert driver.positions()[:2] == [steps, steps // 3] == shafts.positions[:2]
        made = [at for _, at in shafts.steps]
        index = (made[0] - 1) // PER_TURN * PER_TURN
        pitch = counts / abs(steps)
        late = [at - index - k * pitch for k, at in enumerate(made, 1)]
        assert max(late) - min(late) < 1 + 1e-6 and -pitch <= min(late) and max(late) <= 1
        passes.append([at - index for at in made])
        state = struct("thread_state")
        driver.call("read_thread", state)
        assert not state.lost
    assert passes[0] == passes[1] == passes[2]


def test_moves_after_a_thread_have_the_cores_clock() -> None:
    """Though the spindle is stationary, and a thread with it."""
    driver, shafts = machine()
    driver.call("thread", thread(steps=[100], counts=400))
    shafts.run(CLOCK_HZ // 1000)
    driver.poll()
    assert driver.is_moving and shafts.positions[0] == 0
    assert error_of(driver, "move_by_speed", by_speed([5, 0, 0, 0])) == "MOVING"
    shafts.turn(SPINDLE, 200)
    shafts.run(100_000)
    assert shafts.positions[0] == pytest.approx(50, abs=1)
    shafts.turn(SPINDLE, -100)
    shafts.run(100_000)
    assert shafts.positions[0] == pytest.approx(50, abs=1)
    driver.call("stop")
    shafts.run(CLOCK_HZ // 100)
    driver.call("clear")
    there = shafts.positions[0]
    driver.call("move_by_speed", by_speed([7, 0, 0, 0]))
    driver.wait(1)
    assert shafts.positions[0] == there + 7 == driver.positions()[0]


def together(shafts: Shafts, times: int) -> None:
    """A and B of the spindle change in the same clock."""
    for level in range(times):
        for pin in ("encoder_a", "encoder_b"):
            shafts.engine.set(pin, (level % 2 == 0) << SPINDLE)
        shafts.run(12)


def test_an_encoder_that_makes_only_illegal_transitions() -> None:
    """It has not moved; their number saturates."""
    driver, shafts = machine()
    together(shafts, 100)
    now = reading(driver, SPINDLE)
    assert (now.counts, now.illegal) == (0, 100)
    together(shafts, 300)
    now = reading(driver, SPINDLE)
    assert (now.counts, now.illegal) == (0, 255)


def test_a_thread_that_loses_its_phase_stops() -> None:
    """At the first illegal transition; the driver tells."""
    driver, shafts = machine()
    driver.call("thread", thread(steps=[1000], counts=4000))
    shafts.turn(SPINDLE, 400)
    shafts.run(CLOCK_HZ // 100)
    together(shafts, 2)
    shafts.turn(SPINDLE, 400)
    shafts.run(CLOCK_HZ // 100)
    assert error_of(driver, "poll") == "FOLLOWING" and driver.snapshot().cause == Cause.FOLLOWING_ERROR
    state = struct("thread_state")
    driver.call("read_thread", state)
    assert state.lost and state.illegal == 2
    there = shafts.positions[0]
    assert there == pytest.approx(100, abs=2)
    shafts.turn(SPINDLE, 400)
    assert shafts.positions[0] == there == driver.positions()[0]


def test_an_electronic_gear() -> None:
    """Continues until it is stopped, exactly in its ratio; its end is where it is."""
    driver, shafts = machine()
    driver.call("thread", thread(steps=[3], counts=7, endless=True))
    for turns in range(1, 8):
        shafts.turn(SPINDLE, 1000)
        shafts.run(300_000)
        assert shafts.positions[0] == pytest.approx(turns * 1000 * 3 / 7, abs=1.5)
        driver.poll()
    assert driver.is_moving
    driver.call("stop")
    shafts.run(CLOCK_HZ // 100)
    driver.poll()
    driver.call("clear")
    assert driver.positions()[0] == shafts.positions[0]
