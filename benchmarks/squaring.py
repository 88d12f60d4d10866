# SPDX-License-Identifier: MIT
"""Squares gantries that start skewed, with random switches, offsets, speeds and filters, on the C model.

    python -m benchmarks.squaring [RUNS [SEED]]

Prints the worst figures; 1,000 runs unless given, which write docs/reference/squaring.md.
"""

import math
import os
import random
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from passo.build import Parameters
from passo.console import cancelable, console, in_turn, leave_interrupts, progress
from passo.driver import Driver
from passo.ending import ended
from passo.engine import EVENT, NUMBERS, AroundEngine, model_engine, moves_of
from passo.native import ffi
from passo.output import check_results, write_text
from passo.random_cases import log_uniform
from passo.registers import TriggerSource
from passo.toolchain import paths

from tests.helpers.driver_wire import Q32, error_of, open_driver, struct

CLOCK_HZ = 24_000_000
PARAMETERS = Parameters(inputs=1)
RUNS = 1000
PAGE = paths.reference / "squaring.md"
SECONDS = 30  # simulated, of a cycle at most
POLLS = 2000  # per second
SHARED = 0.1  # of all
FILTERS = 2e-7, 2.7e-3  # s: the core counts 65,535 clocks
NEVER = 1 << 40  # steps
TICK, RATE_ONE = 128, 1 << 16  # clocks of a slew of the rate


@dataclass(frozen=True)
class Gantry:
    """Motors of an axis at their places, and where their switches are; in steps, seconds."""

    start: tuple[int, ...]
    edges: tuple[int, ...]
    high: bool = False  # homes at its high end
    offsets: tuple[int, ...] = (0, 0, 0)
    racking: int = 400
    back_off: int = 60
    pull_off: int = 150
    speed: int = 20_000
    slow: int = 1500
    filter: float = 2e-5
    stop: float = 0.01  # s, of a soft stop from full speed
    hysteresis: int = 3
    bounce: float = 0.0
    stuck: dict[int, bool] = field(default_factory=dict)  # motors whose switches are always the same
    shared: bool = False  # a home switch at the first motor, for all

    @property
    def pin(self) -> str:
        """The input of its switches."""
        return "home" if self.shared else "limit_high" if self.high else "limit_low"

    @property
    def skew(self) -> int:
        """Steps from the first motor at its switch to the last."""
        left = [abs(place - edge) for place, edge in zip(self.start, self.edges, strict=True)]
        return max(left) - min(left)

    @property
    def begins_at_a_switch(self) -> bool:
        """Whether one is pressed at the start."""
        sign = 1 if self.high else -1
        places = list(zip(self.start, self.edges, strict=True))[: 1 if self.shared else None]
        return any(sign * (place - edge) >= 0 for place, edge in places)

    @property
    def most_late(self) -> float:
        """Steps from an edge at slow speed until the filter tells it."""
        return self.slow * (self.filter + self.bounce) + 2

    @property
    def stop_distance(self) -> float:
        """Steps from an edge at full speed: filter and soft stop."""
        slew = max(1, int(RATE_ONE * TICK / (self.stop * CLOCK_HZ)))
        slowing = (RATE_ONE // slew + 1) * TICK / CLOCK_HZ
        return self.speed * (slowing / 2 + 2 * self.filter + self.bounce) + 2


def gantry_of(rng: random.Random) -> Gantry:
    """One whose bound allows its skew; some begin at a switch, or beyond it."""
    motors, high, racking = rng.choice((2, 2, 3)), rng.random() < 0.5, rng.randrange(100, 800)
    sign = 1 if high else -1
    edges = tuple(rng.randrange(-30, 30) for _ in range(motors))
    way = rng.choice((rng.randrange(-60, 200), rng.randrange(200, 3000)))
    skews = [rng.randrange(0, racking - 60) for _ in range(motors)]
    skews[rng.randrange(motors)] = 0
    pull_off = rng.randrange(40, 400)
    speed, pause = round(log_uniform(rng, 3000, 40_000)), log_uniform(rng, *FILTERS)
    shared, back_off = rng.random() < SHARED, rng.randrange(10, 60)
    return Gantry(
        tuple(edge - sign * (way + skew) for edge, skew in zip(edges, skews, strict=True)),
        edges,
        high,
        tuple(rng.randrange(-20, 21) for _ in range(3)),
        racking,
        back_off + (math.ceil(speed * pause) if shared else 0),  # from the edge as the filter tells it
        pull_off,
        speed,
        round(log_uniform(rng, 300, 2500)),
        pause,
        log_uniform(rng, 0.002, 0.02),
        rng.randrange(0, 8),
        rng.choice((0.0, 2e-5)),
        shared=shared,
    )


@dataclass
class Squared:
    """What a cycle came to. Lengths are steps."""

    error: str
    square: float  # by which a motor is further from its switch than another, beside their offsets
    late: float  # by which a motor is not where its edge and the pull-off say, at most
    racking: int  # by which one motor has moved further than another, at most
    passed: int  # farthest that a motor was beyond its switch
    skewed: int | None  # the motor that has not reached its switch
    positions: list[int]


class Rig(AroundEngine):
    """A core with a gantry at its pins, exact to the clock."""

    def __init__(self, gantry: Gantry):
        super().__init__(model_engine(PARAMETERS, CLOCK_HZ))
        config = ffi().new("struct passo_rig_config *")
        config.seed, config.axes = 1, PARAMETERS.axes
        config.start[0 : len(gantry.start)] = gantry.start
        for motor, edge in enumerate(gantry.edges[: 1 if gantry.shared else None]):
            always = gantry.stuck.get(motor)
            config.wire[motor] = {
                "input": NUMBERS[gantry.pin],
                "bit": motor,
                "axis": motor,
                "is_switch": True,
                "above": gantry.high,
                "at": edge if always is None else NEVER if always != gantry.high else -NEVER,
                "hysteresis": gantry.hysteresis,
                "bounce": round(gantry.bounce * CLOCK_HZ),
            }
            config.wires = motor + 1
        ((self._c, self._rig),) = self.engine.attach(config)
        self._events: list[np.ndarray] = []

    @property
    def positions(self) -> list[int]:
        """Of the motors."""
        return [self._c.passo_rig_position(self._rig, motor) for motor in range(PARAMETERS.axes)]

    def set(self, pin: str, levels: int) -> None:
        """Set the levels of an input pin that has no switch."""
        self.engine.set(pin, levels)

    def run(self, clocks: int) -> None:
        """Let time pass."""
        while clocks > 0:
            clocks -= self.engine.run(clocks)
            self._events.append(self.engine.drain())

    def drain(self) -> np.ndarray:
        """The pin events since the last call."""
        events, self._events = self._events, []
        return np.concatenate([np.empty(0, EVENT), *events])


def begin(gantry: Gantry) -> tuple[Driver, Rig, Any]:
    """A driver and its rig, and the parameters of the cycle."""
    rig, pin = Rig(gantry), gantry.pin
    driver = open_driver(rig.engine)
    driver.call("configure_filter", max(1, round(gantry.filter * CLOCK_HZ)))
    stop = round(gantry.stop * CLOCK_HZ)
    driver.call("configure_motion", stop, stop, 0)
    for motor in range(1 if gantry.shared else len(gantry.edges)):
        driver.call("configure_inputs", motor, struct("input_config", **{pin: True, "limit_soft": True}))
    offsets = ffi().new("int32_t[8]", list(gantry.offsets))
    homes = ffi().new("struct passo_home[1]")
    homes[0] = {
        "axis": 0,
        "forward": (1 << len(gantry.start)) - 1,
        "racking": 0 if gantry.shared else gantry.racking,
        "offset": offsets,
        "source": TriggerSource[pin.upper()],
        "distance": 8000 if gantry.high else -8000,
        "back_off": gantry.back_off,
        "pull_off": gantry.pull_off,
        "speed": gantry.speed * Q32,
        "slow_speed": gantry.slow * Q32,
        "acceleration": 20 * gantry.speed * Q32,
    }
    return driver, rig, (homes, offsets)


def square(gantry: Gantry) -> Squared:
    """Home a gantry."""
    driver, rig, (homes, _) = begin(gantry)
    error, end = error_of(driver, "home", homes, 1), rig.clock + SECONDS * CLOCK_HZ
    while error == "OK" and driver.is_moving and rig.clock < end:
        error = error_of(driver, "poll")
        rig.run(CLOCK_HZ // POLLS)
    rig.run(CLOCK_HZ // 100)
    if driver.is_moving:
        error = "ENDLESS"
    made = judged(gantry, error, driver, rig)
    rig.engine.close()
    return made


def judged(gantry: Gantry, error: str, driver: Driver, rig: Rig) -> Squared:
    """From the steps at the pins."""
    events, moved, beyond, sign = rig.drain(), [], 0, 1 if gantry.high else -1
    for motor, (start, edge) in enumerate(zip(gantry.start, gantry.edges, strict=True)):
        moved.append(np.append(0, np.cumsum(moves_of(events, motor))))
        place = start + moved[-1]
        began = max(0, sign * (start - edge))
        if motor == 0 or not gantry.shared:
            beyond = max(beyond, int((sign * (place - edge)).max()) - began)
    skewed = ffi().new("uint8_t *")
    is_skewed = driver.lib.passo_home_is_skewed(driver.c, skewed)
    apart = [int(np.abs(one - other).max()) for i, one in enumerate(moved) for other in moved[:i]]
    ends = [
        position - edge + offset
        for position, edge, offset in zip(rig.positions, gantry.edges, gantry.offsets, strict=False)
    ]
    if gantry.shared:
        ends = [ends[0] - gantry.offsets[0]] * len(ends)
    late = [-sign * end - gantry.pull_off for end in ends]
    return Squared(
        error,
        max(ends) - min(ends),
        max(map(abs, late)),
        max(apart),
        beyond,
        skewed[0] if is_skewed else None,
        driver.positions()[: len(ends)],
    )


def problems(gantry: Gantry, made: Squared) -> list[str]:
    """What a cycle may not be, of a gantry whose bound allows its skew."""
    found = []
    racking = 0 if gantry.shared else gantry.racking
    if made.error != "OK":
        return [f"it ended with {made.error}"]
    if made.square > 1:
        found.append(f"a motor is {made.square} steps off")
    if made.late > gantry.most_late:
        found.append(f"a motor is {made.late} steps from where its switch says")
    if made.racking > racking:
        found.append(f"racking of {made.racking} of {racking} steps")
    if made.passed > gantry.stop_distance:
        found.append(f"a switch was passed by {made.passed} steps of {gantry.stop_distance:.0f}")
    if len(set(made.positions)) != 1:
        found.append(f"positions {made.positions}")
    return found


def page(gantries: Sequence[Gantry], seed: int, worst: dict[str, float]) -> str:
    """docs/reference/squaring.md."""
    pressed = sum(gantry.begins_at_a_switch for gantry in gantries)
    shared = sum(gantry.shared for gantry in gantries)
    return f"""<!-- Made by `python -m benchmarks.squaring`; do not edit. -->
# Squaring

{len(gantries):,} random gantries of two and three motors (seed {seed}), homed on the C model by
[`passo_home()`](../machine.md#home), judged by the steps at the pins. Start, switches, offsets,
bound, speeds (seek 3,000 to 40,000 steps/s, slow 300 to 2,500), stop time and hysteresis are
random, filters {FILTERS[0] * CLOCK_HZ:.0f} clocks to {FILTERS[1] * 1e3:g} ms; {pressed} begin
with a switch pressed, {shared} have one switch for all motors.

| | worst | bound |
|---|---:|---:|
| motor further from its switch than another, steps | {worst["square"]:g} | 1 |
| motor off its place, of what the slow approach makes within the filter time | {worst["late"]:.3f} | 1 |
| racking, of its bound | {worst["racking"]:.3f} | 1 |
| switch passed, of the stop distance | {worst["passed"]:.3f} | 1 |
"""


def main(words: list[str]) -> None:
    """Run, print, write."""
    runs, seed = ([int(word) for word in words] + [RUNS, 1][len(words) :])[:2]
    check_results(*[PAGE] * (runs >= RUNS))
    rng, bad = random.Random(seed), 0
    gantries = [gantry_of(rng) for _ in range(runs)]
    worst = {"square": 0.0, "late": 0.0, "racking": 0.0, "passed": 0.0}
    square(gantries[0])  # builds the model before the workers begin
    done = 0
    with (
        cancelable() as work,
        ProcessPoolExecutor(os.cpu_count(), initializer=leave_interrupts) as pool,
        progress("gantries", runs) as report,
    ):
        for number, (gantry, made) in enumerate(zip(gantries, in_turn(pool, square, gantries), strict=True)):
            worst["square"] = max(worst["square"], made.square)
            worst["late"] = max(worst["late"], made.late / gantry.most_late)
            worst["racking"] = max(worst["racking"], made.racking / gantry.racking)
            worst["passed"] = max(worst["passed"], made.passed / gantry.stop_distance)
            for problem in problems(gantry, made):
                bad += 1
                console.print(f"{number}: {problem}: {gantry}", soft_wrap=True)
            done += 1
            report(done)
    shown = ", ".join(f"{name} {value:.3f}" for name, value in worst.items())
    console.print(f"{done:,} gantries: at most {shown} (steps; the others of their bounds)")
    if work.canceled:
        raise SystemExit("canceled")
    if bad:
        raise SystemExit(f"{bad} faults")
    if runs >= RUNS:
        write_text(PAGE, page(gantries, seed, worst))


if __name__ == "__main__":
    sys.exit(ended(lambda: main(sys.argv[1:])))
