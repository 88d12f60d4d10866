# SPDX-License-Identifier: MIT
"""linux/passo_servo.h on the C model, judged at the pins: clocks that differ, gaps, deaths, bad settings."""

import random
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from passo.driver import DriverError
from passo.engine import model_engine, moves_of
from passo.native import ffi
from passo.registers import Cause, Operation, State
from passo.toolchain import paths

from benchmarks.servo import (
    ACCELERATION,
    BESIDE,
    CONSTANT,
    HARDEST,
    LATE,
    ROUNDING,
    Run,
    Servo,
    Setting,
    cost,
    following,
    gaps,
    one_period,
    run,
    waves,
)
from tests.helpers.driver_wire import Noise

SETTING = Setting()
PAGE = " ".join((paths.docs / "hosts.md").read_text().split())
SECONDS = 2.0
FULL = 65535  # power
PROBLEMS = ("OK", "PERIOD", "AXES", "SPEED", "ACCELERATION", "STOP", "PINS", "LAG")


def wake(seed: int) -> Callable[[int], float]:
    """Wakes that are late by up to 1 ms."""
    rng = random.Random(seed)
    return lambda call: rng.uniform(0, 0.001)


def check_in_step(found: Run, constant: float = CONSTANT) -> None:
    """Each place is passed by all axes within a step, in order, after the same time; nothing is lost."""
    late = found.passes()[found.moved]
    assert not np.isnan(late).any()
    assert late.max() <= found.lag + LATE
    assert np.abs(found.lags - found.lag).max() <= constant
    assert found.positions == found.made == found.commands[-1].tolist()
    assert found.slowed == 0
    assert found.hardest <= ACCELERATION * ROUNDING


@pytest.mark.parametrize("ppm", [-200, 0, 200])
def test_clocks_that_differ(ppm: int) -> None:
    """In step, with wakes late by up to 1 ms; the speed changes by less than the rounding of a line."""
    found = run(SETTING, SECONDS, waves(3, SECONDS), ppm, wake(1))
    check_in_step(found)
    substep = 1e9 / (SETTING.period * SETTING.clock_hz / 2)  # ppb of a line
    assert np.abs(np.diff(found.trims)).max() < substep
    assert np.abs(found.depths[10:] - found.lag).max() <= LATE


def test_the_loop_finds_the_difference_of_the_clocks() -> None:
    """The trim settles at it, and the depth stays; a slow core shows minutes of it."""
    hard = {"acceleration": 200000, "stop": 200000}
    setting = Setting(axes=1, period=0.02, clock_hz=1_000_000, scale=10, **hard, inputs=False)
    found = run(setting, 900, lambda time: [0.0], -200)
    assert abs(np.median(found.trims[-5000:]) / 1000 - 200) < 20
    assert np.abs(np.median(found.depths[-5000:]) - found.lag) <= 1


def test_short_gaps_are_invisible() -> None:
    """Up to the buffer, late wakes included."""
    late = gaps(2, SETTING, SECONDS, 20, (0.001, 0.004))
    check_in_step(run(replace(SETTING, buffer=5), SECONDS, waves(3, SECONDS), 200, late))


def test_long_gaps_slow_the_path() -> None:
    """Along the commands, within the acceleration, without a lost step; the lag is then made up."""
    found = run(SETTING, SECONDS, waves(3, SECONDS), -200, gaps(3, SETTING, SECONDS, 8, (0.02, 0.09)))
    assert found.slowed > 2
    assert not np.isnan(found.passes()[found.moved]).any()
    assert found.positions == found.made == found.commands[-1].tolist()
    assert ACCELERATION * ROUNDING < found.hardest <= HARDEST * ROUNDING
    assert found.depths[-1] < found.depths.max() - 5


def test_a_thread_that_loses_periods() -> None:
    """It does not catch up after a gap: the path waits until the core has its lines again."""
    found = run(SETTING, SECONDS, waves(3, SECONDS), 0, lambda call: 0.06 if call >= 700 else 0.0)
    assert found.slowed > 0 and found.depths.min() < found.lag / 2
    assert found.depths[-1] >= found.lag - LATE
    assert found.positions == found.made == found.commands[-1].tolist()
    assert not np.isnan(found.passes()[found.moved]).any()
    assert found.hardest <= HARDEST * ROUNDING


def test_bit_errors() -> None:
    """Frames are sent again; nothing is lost or late."""
    noise = Noise(random.Random(4), 1e-4)
    check_in_step(run(SETTING, SECONDS, waves(3, SECONDS), 0, wake(4), noise))
    assert noise.flips > 10


class DeafReads(Noise):
    """No reply to a read arrives while it is on."""

    on_now = reads = False

    def there(self, words: list[int]) -> list[int]:
        self.reads = words[0] >> 28 == Operation.READ
        return words

    def back(self, words: list[int]) -> list[int]:
        return [0] * len(words) if self.reads and self.on_now else words


def test_a_link_that_fails_in_a_read_of_the_state() -> None:
    """Of a call that is late: the axes stop as after any error, and start again."""
    with model_engine(SETTING.core, SETTING.clock_hz) as engine:
        noise = DeafReads(random.Random(6), 1)
        servo = Servo(engine, SETTING, noise=noise)
        servo.start()
        for call in range(300):
            servo.call([0.01 * call, 0, 0])
        servo.wait_until(engine.clock + SETTING.clock_hz / 50)
        noise.on_now = True
        with pytest.raises(DriverError, match="STUCK_LOW"):
            for call in range(300, 310):
                servo.call([0.01 * call, 0, 0])
        noise.on_now = False
        for _ in range(100):
            servo.wait_until(engine.clock + SETTING.clock_hz / 1000)
            servo.driver.poll()
        assert servo.driver.snapshot().state == State.STOPPED
        assert servo.driver.positions()[0] == moves_of(servo.pins, 0).sum() > 0
        servo.start()


@pytest.mark.parametrize("call", [700, 1133])
def test_a_host_that_dies(call: int) -> None:
    """The axes come to rest on the path within the acceleration, then the watchdog stops the core."""
    found = run(SETTING, SECONDS, waves(3, SECONDS), 0, wake(5), die=call)
    assert found.cause == Cause.WATCHDOG.name
    assert found.positions == found.made
    assert found.hardest <= HARDEST * ROUNDING
    known = found.commands[call - found.lag - LATE : call]
    parts = np.linspace(0, 1, 128)[:, None, None]
    path = known[:-1] * (1 - parts) + known[1:] * parts
    assert np.abs(path - found.positions).max(axis=2).min() <= 1
    assert np.any(found.positions != found.commands[call - 1])


def test_a_dead_host_leaves_drives_and_power_off() -> None:
    """The power with the motion, the drives after the time that is set; digital outputs stay."""
    setting = replace(SETTING, outputs=True)
    stop, disable = (round(seconds * setting.clock_hz) for seconds in (0.1, 0.2))
    with model_engine(setting.core, setting.clock_hz) as engine:
        servo = Servo(engine, setting)
        servo.driver.call("configure_watchdog", stop, disable)
        servo.driver.call("configure_outputs", ffi().new("struct passo_outputs_config *", {"pwm_hz": 20000}))
        word, output = ffi().new("uint32_t *"), ffi().new("struct passo_output *")
        output.levels, output.power = 1, FULL
        servo.driver.call("output_word", output, word)
        servo.c.output = word[0]
        servo.start()
        for call in range(400):
            servo.call([0.0002 * call * call if call < 200 else 8 + 0.08 * (call - 200), 0, 0])
        died = engine.clock
        assert [int(servo.pins[pin][-1]) for pin in ("enable", "power", "outputs")] == [7, 1, 1]
        servo.wait_until(died + setting.clock_hz)
        pins = servo.pins
        assert [int(pins[pin][-1]) for pin in ("enable", "power", "running", "outputs")] == [0, 0, 0, 1]
        rest = pins["clock"][np.flatnonzero(pins["running"])[-1] + 1]
        dark = pins["clock"][np.flatnonzero(pins["power"])[-1] + 1]
        off = pins["clock"][np.flatnonzero(pins["enable"])[-1] + 1]
        print(died, rest - died, dark - died, off - died)
        assert dark <= rest and died < rest < off
        assert abs(int(off) - died - stop - disable) <= 3 << 16  # units of the watchdog
        assert servo.driver.snapshot().cause == Cause.WATCHDOG


def test_a_command_that_jumps() -> None:
    """It is approached within speed and acceleration, and reached."""
    found = run(SETTING, 1.0, lambda time: [0.0 if time < 0.1 else 30.0, 0.0, 0.0 if time < 0.2 else -0.003])
    assert found.made == [24000, 0, -2]
    assert found.hardest <= ACCELERATION * ROUNDING


def test_it_goes_on_after_a_stop() -> None:
    """From where the axes have come to rest."""
    with model_engine(SETTING.core, SETTING.clock_hz) as engine:
        servo = Servo(engine, SETTING)
        with pytest.raises(DriverError, match="NOT_PREPARED"):
            servo.call([0, 0, 0])
        servo.start()
        for call in range(400):
            servo.call([0.0002 * call * call if call < 200 else 8 + 0.08 * (call - 200), 0, 0])
        servo.stop()
        servo.wait_until(engine.clock + SETTING.clock_hz / 2)
        rest = servo.driver.positions()[0]
        assert 1000 < rest < 24 * SETTING.scale
        servo.start()
        for _ in range(200):
            servo.call([rest / SETTING.scale, 0, 1])
        assert servo.driver.snapshot().state == State.RUN
        assert servo.driver.positions()[:3] == [rest, 0, 1 * SETTING.scale]
        pins = servo.pins
        assert not moves_of(pins, 0)[pins["clock"] > servo.begun].any()


@pytest.mark.parametrize("stop", [2000, 20_000])
def test_a_stop_of_the_driver_brakes_as_the_axis_bears(stop: float) -> None:
    """From full speed, in the time that the hardest stop of an axis takes, and no sooner."""
    setting = replace(SETTING, stop=stop)
    with model_engine(setting.core, setting.clock_hz) as engine:
        servo = Servo(engine, setting)
        servo.start()
        for call in range(400):
            servo.call([0.00005 * call * call if call < 200 else 2 + 0.02 * (call - 200), 0, 0])
        servo.driver.call("stop")
        at = engine.clock
        servo.wait_until(engine.clock + setting.clock_hz / 2)
        assert servo.driver.snapshot().cause == Cause.STOP
        last = servo.pins["clock"][np.flatnonzero(moves_of(servo.pins, 0))[-1]]
        due = setting.speed / stop * setting.clock_hz
        assert 0.8 * due < int(last) - at < 1.05 * due + 3000


def test_more_lines_than_it_can_keep_stop_it() -> None:
    """A thread that calls without a pause: an error, and the axes come to rest at their commands."""
    with model_engine(SETTING.core, SETTING.clock_hz) as engine:
        servo = Servo(engine, SETTING)
        servo.start()
        servo.period = 0
        with pytest.raises(DriverError, match="FULL"):
            for call in range(2000):
                servo.call([0.001 * call, 0, 0])
        with pytest.raises(DriverError, match="NOT_PREPARED"):
            servo.call([0, 0, 0])
        servo.wait_until(engine.clock + SETTING.clock_hz / 2)
        assert servo.driver.snapshot().state == State.STOPPED
        assert servo.driver.positions()[0] == moves_of(servo.pins, 0).sum() > 0


@pytest.mark.parametrize(("stop", "buffer"), [(1000, 2), (10_000, 1), (40_000, 2), (40_000, 1)])
def test_an_axis_that_bears_more_has_a_shorter_lag(stop: float, buffer: int) -> None:
    """As the page says; nothing else changes: in step, and within its acceleration when the host is gone."""
    setting = replace(SETTING, stop=stop, buffer=buffer)
    found = run(setting, SECONDS, waves(3, SECONDS), 200, wake(6))
    check_in_step(found, constant=2 if buffer == 1 else CONSTANT)  # wakes are late by all of the buffer
    stated = 2 * buffer + 4 + setting.speed / stop / 2 / setting.period
    assert stated - 1 <= found.lag <= stated + 2
    if buffer == 2:
        assert re.search({1000: r"\b59 with 1,000\b", 40_000: r"\b10 periods .* 40,000 mm"}[int(stop)], PAGE)
        assert found.lag == {1000: 59, 40_000: 10}[int(stop)]
    dead = run(setting, SECONDS, waves(3, SECONDS), -200, wake(7), die=977)
    assert dead.cause == Cause.WATCHDOG.name and dead.positions == dead.made
    assert dead.hardest <= (ACCELERATION + stop) * ROUNDING


def test_a_shorter_period_has_a_shorter_lag() -> None:
    """On a faster wire: 3 ms, as the page says, and a following error of little more than their way."""
    setting, seconds = BESIDE[-1], 1.0
    found = run(setting, seconds, waves(3, seconds), 200, lambda call: 0.00001 * (call % 5))
    check_in_step(found)
    assert (setting.buffer, setting.period, setting.stop) == (1, 0.00025, 40_000)
    assert found.lag * setting.period == pytest.approx(0.003)
    assert "`SERVO_PERIOD = 250000` with `buffer=1` and 12 MHz makes 3 ms" in PAGE
    fastest = np.abs(np.diff(found.places, axis=0)).max()
    assert following(found) <= (found.lag + 1) * fastest


def test_the_cost_of_a_call() -> None:
    """Six axes: a line, the positions, and every second call a ramp; the loop costs little time."""
    instructions, words = cost()
    assert words < 12 + 14 + 9 / 2 + 1
    assert np.isnan(instructions) or instructions < 8000


def test_a_design_with_a_lag_of_one_period() -> None:
    """hostmot2's: it follows by the way of a period, and leaves the path where the host is late."""
    command = waves(3, SECONDS)
    steady = one_period(SECONDS, command, lambda call: 0.0)
    places = np.array([command(call * SETTING.period) for call in range(int(SECONDS / SETTING.period))])
    assert steady.following == pytest.approx(np.abs(np.diff(places, axis=0)).max(), rel=0.05)
    assert one_period(SECONDS, command, gaps(1, SETTING, SECONDS, 4, (0.02, 0.05))).off > 1


@pytest.mark.parametrize(
    ("problem", "change"),
    [
        ("PERIOD", {"period": 0.06}),
        ("PERIOD", {"period": 0.00001}),
        ("SPEED", {"speed": 0}),
        ("ACCELERATION", {"acceleration": 0}),
        ("PINS", {"scale": 8000}),
        ("STOP", {"stop": 0}),
        ("LAG", {"stop": 100}),
    ],
)
def test_settings_that_cannot_be(problem: str, change: dict[str, float]) -> None:
    """Each is named, and nothing moves."""
    setting = Setting(**change)  # type: ignore[arg-type]
    with (
        model_engine(SETTING.core, SETTING.clock_hz) as engine,
        pytest.raises(DriverError, match=f"problem {PROBLEMS.index(problem)}"),
    ):
        Servo(engine, setting)


def test_an_axis_that_the_core_does_not_have() -> None:
    with model_engine(SETTING.core, SETTING.clock_hz) as engine:
        servo = Servo(engine, SETTING)
        for axes in (0, 4):
            servo.options.axes = axes
            with pytest.raises(DriverError, match=f"problem {PROBLEMS.index('AXES')}"):
                servo.check()
