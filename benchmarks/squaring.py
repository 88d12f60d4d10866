# SPDX-License-Identifier: MIT
"""Squares gantries that start skewed, with random switches, offsets, speeds and filters, on the C model.

    python -m benchmarks.squaring [RUNS [SEED]]

Prints the worst figures; 1,000 runs unless given.
"""

import random
import sys
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from passo.build import Parameters
from passo.console import console
from passo.driver import Driver
from passo.engine import model_engine, moves_of
from passo.machine import Machine, Switch
from passo.native import ffi
from passo.random_cases import log_uniform
from passo.registers import TriggerSource

from tests.helpers.driver_wire import CLOCK_HZ, Q32, error_of, open_driver, struct

PARAMETERS = Parameters(inputs=1)
RUNS = 1000
SECONDS = 30  # simulated, of a cycle at most
POLLS = 2000  # per second
LOOK = 2.5e-4  # s: how late a switch of the machine may be, which sees nothing during a frame
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

    @property
    def skew(self) -> int:
        """Steps from the first motor at its switch to the last."""
        left = [abs(place - edge) for place, edge in zip(self.start, self.edges, strict=True)]
        return max(left) - min(left)


def gantry_of(rng: random.Random) -> Gantry:
    """One whose bound allows its skew; some begin at a switch, or beyond it."""
    motors, high, racking = rng.choice((2, 2, 3)), rng.random() < 0.5, rng.randrange(100, 800)
    sign = 1 if high else -1
    edges = tuple(rng.randrange(-30, 30) for _ in range(motors))
    way = rng.choice((rng.randrange(-60, 200), rng.randrange(200, 3000)))
    skews = [rng.randrange(0, racking - 60) for _ in range(motors)]
    skews[rng.randrange(motors)] = 0
    pull_off = rng.randrange(40, 400)
    return Gantry(
        tuple(edge - sign * (way + skew) for edge, skew in zip(edges, skews, strict=True)),
        edges,
        high,
        tuple(rng.randrange(-20, 21) for _ in range(3)),
        racking,
        rng.randrange(10, 60),
        pull_off,
        round(log_uniform(rng, 3000, 40_000)),
        round(log_uniform(rng, 300, 2500)),
        log_uniform(rng, 2e-6, 1e-4),
        log_uniform(rng, 0.002, 0.02),
        rng.randrange(0, 8),
        rng.choice((0.0, 2e-5)),
    )


@dataclass
class Squared:
    """What a cycle came to. Lengths are steps."""

    error: str
    square: float  # farthest motor from where it should be beside the first one
    racking: int  # by which one motor has moved further than another, at most
    passed: int  # farthest that a motor was beyond its switch
    skewed: int | None  # the motor that has not reached its switch
    positions: list[int]


def begin(gantry: Gantry) -> tuple[Driver, Machine, Any]:
    """A driver and its machine, and the parameters of the cycle."""
    pin = "limit_high" if gantry.high else "limit_low"
    bounce = round(gantry.bounce * CLOCK_HZ)
    switches = [
        Switch(pin, motor, edge, gantry.high, gantry.hysteresis, bounce, stuck=gantry.stuck.get(motor))
        for motor, edge in enumerate(gantry.edges)
    ]
    machine = Machine(model_engine(PARAMETERS, CLOCK_HZ), switches, gantry.start)
    driver = open_driver(machine)
    driver.call("configure_filter", max(1, round(gantry.filter * CLOCK_HZ)))
    stop = round(gantry.stop * CLOCK_HZ)
    driver.call("configure_motion", stop, stop, 0)
    for motor in range(len(gantry.start)):
        driver.call("configure_inputs", motor, struct("input_config", **{pin: True, "limit_soft": True}))
    offsets = ffi().new("int32_t[8]", list(gantry.offsets))
    homes = ffi().new("struct passo_home[1]")
    homes[0] = {
        "axis": 0,
        "forward": (1 << len(gantry.start)) - 1,
        "racking": gantry.racking,
        "offset": offsets,
        "source": TriggerSource.LIMIT_HIGH if gantry.high else TriggerSource.LIMIT_LOW,
        "distance": 8000 if gantry.high else -8000,
        "back_off": gantry.back_off,
        "pull_off": gantry.pull_off,
        "speed": gantry.speed * Q32,
        "slow_speed": gantry.slow * Q32,
        "acceleration": 20 * gantry.speed * Q32,
    }
    return driver, machine, (homes, offsets)


def square(gantry: Gantry) -> Squared:
    """Home a gantry."""
    driver, machine, (homes, _) = begin(gantry)
    error = error_of(driver, "home", homes, 1)
    end, events = machine.clock + SECONDS * CLOCK_HZ, []
    while error == "OK" and driver.is_moving and machine.clock < end:
        error = error_of(driver, "poll")
        machine.run(CLOCK_HZ // POLLS)
        events.append(machine.drain())
    machine.run(CLOCK_HZ // 100)
    events.append(machine.drain())
    if driver.is_moving:
        error = "ENDLESS"
    made = judged(gantry, error, driver, machine, np.concatenate(events))
    machine.engine.close()
    return made


def judged(gantry: Gantry, error: str, driver: Driver, machine: Machine, events: np.ndarray) -> Squared:
    """From the steps at the pins."""
    moved, beyond, sign = [], 0, 1 if gantry.high else -1
    for motor, (start, edge) in enumerate(zip(gantry.start, gantry.edges, strict=True)):
        moved.append(np.append(0, np.cumsum(moves_of(events, motor))))
        place = start + moved[-1]
        began = max(0, sign * (start - edge))
        beyond = max(beyond, int((sign * (place - edge)).max()) - began)
    skewed = ffi().new("uint8_t *")
    is_skewed = driver.lib.passo_home_is_skewed(driver.c, skewed)
    apart = [int(np.abs(one - other).max()) for i, one in enumerate(moved) for other in moved[:i]]
    ends = [
        int(machine.positions[motor]) - edge + gantry.offsets[motor]
        for motor, edge in enumerate(gantry.edges)
    ]
    return Squared(
        error,
        max(abs(end + sign * gantry.pull_off) for end in ends),
        max(apart),
        beyond,
        skewed[0] if is_skewed else None,
        driver.positions()[: len(ends)],
    )


def problems(gantry: Gantry, made: Squared) -> list[str]:
    """What a cycle may not be, of a gantry whose bound allows its skew."""
    found = []
    slew = max(1, int(RATE_ONE * TICK / (gantry.stop * CLOCK_HZ)))
    slowing = (RATE_ONE // slew + 1) * TICK / CLOCK_HZ
    stop = gantry.speed * (slowing / 2 + 2 * gantry.filter + gantry.bounce + LOOK) + 2
    if made.error != "OK":
        return [f"it ended with {made.error}"]
    if made.square > 1:
        found.append(f"a motor is {made.square} steps off")
    if made.racking > gantry.racking + max(gantry.offsets) - min(gantry.offsets):
        found.append(f"racking of {made.racking} of {gantry.racking} steps")
    if made.passed > stop:
        found.append(f"a switch was passed by {made.passed} steps of {stop:.0f}")
    if len(set(made.positions)) != 1:
        found.append(f"positions {made.positions}")
    return found


def main(words: list[str]) -> None:
    """Run and print."""
    runs, seed = ([int(word) for word in words] + [RUNS, 1][len(words) :])[:2]
    rng, bad = random.Random(seed), 0
    worst = {"square": 0.0, "racking": 0.0, "passed": 0.0}
    for number in range(runs):
        gantry = gantry_of(rng)
        made = square(gantry)
        worst["square"] = max(worst["square"], made.square)
        worst["racking"] = max(worst["racking"], made.racking / gantry.racking)
        worst["passed"] = max(worst["passed"], made.passed / (gantry.speed * gantry.stop / 2))
        for problem in problems(gantry, made):
            bad += 1
            console.print(f"{number}: {problem}: {gantry}", soft_wrap=True)
    shown = ", ".join(f"{name} {value:.3f}" for name, value in worst.items())
    console.print(f"{runs:,} gantries: at most {shown} (steps, of the bound, of the stop distance)")
    if bad:
        raise SystemExit("a gantry was not squared")


if __name__ == "__main__":
    main(sys.argv[1:])
