# SPDX-License-Identifier: MIT
"""Three uses of trackers, on the C model: a host moves an axis a little, a thousand times per second.

python examples/python/trackers.py torch | gantry | leadscrew [--picture FILE]

torch      cuts a warped sheet; the height of the torch follows its noisy voltage
gantry     is squared by its two switches while no path runs; the path's positions stay
leadscrew  is straightened by a table of its errors
"""

import argparse
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from passo.build import Parameters
from passo.driver import Driver, new_track
from passo.engine import model_engine, moves_of
from passo.machine import Machine, Switch
from passo.moves import PinTiming
from passo.native import ffi, planner

CLOCK_HZ, LOOKS = 8_000_000, 1000  # per second
Q32 = 1 << 32
SCALE = 200  # steps/mm


@dataclass
class Result:
    """What happened at each look of the host, mm but for the voltage, and all edges of the pins."""

    seconds: list[float] = field(default_factory=list)
    curves: dict[str, list[float]] = field(default_factory=dict)
    events: Any = None
    path: list[int] = field(default_factory=list)  # positions as the driver counts them

    def add(self, clock: int, **values: float) -> None:
        """A look."""
        self.seconds.append(clock / CLOCK_HZ)
        for name, value in values.items():
            self.curves.setdefault(name, []).append(value)

    def of(self, name: str) -> np.ndarray:
        """A curve."""
        return np.array(self.curves[name])


class Host:
    """A driver that is polled, and the trackers of its axes."""

    def __init__(self, engine: Any, axes: int, speed: int, acceleration: int):
        self.engine, self.driver = engine, Driver(engine, CLOCK_HZ)
        self.tracks = []
        for axis in range(axes):
            self.driver.configure_axis(axis, PinTiming(20, 20, 20, 20))
            self.tracks.append(new_track(axis, 0, Fraction(speed), Fraction(acceleration)))
            self.driver.call("configure_tracker", self.tracks[-1])

    def move(self, steps: list[int], speed: int) -> None:
        """Queue a move."""
        speeds = {"profile": planner().PASSO_PROFILE_SIGMOID, "speed": speed * Q32}
        fields = speeds | {"steps": steps, "acceleration": 20 * speed * Q32}
        self.driver.call("move_by_speed", ffi().new("struct passo_move_by_speed *", fields))

    def track(self, axis: int, target: float) -> None:
        """Send a tracker to a target, in steps."""
        self.driver.call("track_to", self.tracks[axis], round(target))

    def until(self, is_done: Callable[[], bool], look: Callable[[int], None]) -> None:
        """Look a thousand times per second, until it is done."""
        due = self.engine.clock
        while not is_done():
            self.driver.poll()
            look(self.engine.clock)
            due += CLOCK_HZ // LOOKS
            self.engine.run(max(1, due - self.engine.clock))


# ------------------------------------------------------------------------------------------------ torch ----

LENGTH, FEED = 40, 50  # mm, mm/s
HEIGHT, VOLTS, VOLTS_PER_MM, NOISE = 3.0, 110.0, 8.0, 2.0  # wanted height and its voltage; noise: rms
SHARE, SMOOTH = 0.08, 0.25  # of the distance, and of a new voltage, that each look takes


def sheet(x: float) -> float:
    """Height of a warped sheet, mm."""
    return 1.2 * math.sin(2 * math.pi * x / LENGTH) + 0.02 * x


def torch(follows: bool = True) -> Result:
    """X is the path, Z its tracker."""
    rng, result = np.random.default_rng(1), Result()
    with model_engine(Parameters(axes=2, trackers=1), CLOCK_HZ) as engine:
        machine = Machine(engine)
        host = Host(machine, 2, speed=8000, acceleration=400_000)
        host.move([LENGTH * SCALE, 0], FEED * SCALE)
        smooth, target = VOLTS, 0.0

        def look(clock: int) -> None:
            nonlocal smooth, target
            x, z = machine.positions[:2] / SCALE
            height = HEIGHT + z - sheet(x)
            volts = VOLTS + VOLTS_PER_MM * (height - HEIGHT) + NOISE * rng.standard_normal()
            smooth += SMOOTH * (volts - smooth)
            target -= SHARE * (smooth - VOLTS) / VOLTS_PER_MM * SCALE
            if follows:
                host.track(1, target)
            result.add(clock, x=x, sheet=sheet(x), torch=HEIGHT + z, height=height, volts=volts)

        host.until(lambda: machine.positions[0] == LENGTH * SCALE, look)
        result.events = machine.drain()
    return result


# ----------------------------------------------------------------------------------------------- gantry ----

SKEW, AWAY, PULL_OFF = 1.6, 4.0, 2.0  # mm


class Motor:
    """One of a gantry: fast to its switch, to rest, slowly back to where the switch opens, and off it."""

    def __init__(self, host: Host, axis: int):
        self.host, self.axis, self.phase = host, axis, "seek"
        self.target = -2 * (AWAY + SKEW) * SCALE

    def look(self, is_active: bool) -> None:
        """A millisecond or two later."""
        reading = self.host.driver.tracker(self.axis)
        if self.phase == "seek" and is_active:
            self.phase, self.target = "rest", reading.position
            self.host.driver.call("untrack", self.axis)
        elif self.phase == "rest" and not reading.moves:
            self.phase, self.target = "back", reading.position
        elif self.phase == "back" and is_active:
            self.target += 1
        elif self.phase == "back":
            self.phase, self.target = "off", self.target + PULL_OFF * SCALE
        if self.phase != "rest":
            self.host.track(self.axis, self.target)

    @property
    def is_done(self) -> bool:
        """Off its switch, at rest."""
        return self.phase == "off" and bool(self.host.driver.tracker(self.axis).at_target)


def gantry() -> Result:
    """Motors 0 and 1 carry a beam; each has a switch, at 0."""
    result = Result()
    with model_engine(Parameters(axes=2, inputs=1, trackers=1), CLOCK_HZ) as engine:
        start = [round(AWAY * SCALE), round((AWAY + SKEW) * SCALE)]
        machine = Machine(engine, [Switch("home", axis, 0) for axis in (0, 1)], start)
        host = Host(machine, 2, speed=4000, acceleration=100_000)
        for axis in (0, 1):
            config = ffi().new("struct passo_input_config *", {"home": True})
            host.driver.call("configure_inputs", axis, config)
        motors = [Motor(host, axis) for axis in (0, 1)]

        def look(clock: int) -> None:
            readings = ffi().new("struct passo_readings *")
            host.driver.call("read_inputs", readings)
            for motor in motors:
                motor.look(bool(readings.home >> motor.axis & 1))
            y0, y1 = machine.positions[:2] / SCALE
            result.add(clock, y0=y0, y1=y1, skew=y1 - y0)

        host.until(lambda: all(motor.is_done for motor in motors), look)
        look(machine.clock)
        result.path, result.events = host.driver.positions()[:2], machine.drain()
    return result


# -------------------------------------------------------------------------------------------- leadscrew ----

TRAVEL, FAST = 60, 150  # mm, mm/s
TABLE = np.array([0.0, 0.03, 0.07, 0.04, -0.02, -0.05, 0.01])  # mm too far, every 10 mm


def error(x: np.ndarray | float) -> Any:
    """How much too far the screw takes the nut, mm."""
    return np.interp(x, np.linspace(0, TRAVEL, len(TABLE)), TABLE)


def leadscrew(corrected: bool = True) -> Result:
    """There and back; the host sends the tracker to what the table says of the path's position."""
    result = Result()
    with model_engine(Parameters(axes=1, trackers=1), CLOCK_HZ) as engine:
        machine = Machine(engine)
        host = Host(machine, 1, speed=4000, acceleration=400_000)
        targets = ffi().new("int16_t[]", [round(-off * SCALE) for off in TABLE])
        facts = {"targets": targets, "points": len(TABLE), "pitch": TRAVEL * SCALE // (len(TABLE) - 1)}
        table = ffi().new("struct passo_track_table *", facts)
        for steps in (TRAVEL * SCALE, -TRAVEL * SCALE):
            host.move([steps], FAST * SCALE)

        def look(clock: int) -> None:
            if corrected:
                at = planner().passo_track_at(table, host.driver.positions()[0])
                host.track(0, at)
            result.add(clock)

        host.until(lambda: not host.driver.is_moving, look)
        result.events = machine.drain()
    return result


def nut_errors(result: Result, path: Result) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Seconds, path in mm, and how far the nut is from it, at each step; `path`: the same path alone."""
    clocks, places = steps_of(result, 0)
    own, wanted = steps_of(path, 0)
    at = np.interp(clocks, own, wanted) / SCALE
    motor = places / SCALE
    return clocks / CLOCK_HZ, at, motor + error(motor) - at


# ------------------------------------------------------------------------------------------------ what ----


def steps_of(result: Result, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Clocks of all steps of an axis, since the path began, and its positions in the middle of each."""
    events: np.ndarray = result.events
    moves = moves_of(events, axis)
    start = int(events["clock"][np.argmax(events["running"] & np.uint64(1))])
    clocks = events["clock"][moves != 0].astype(np.int64) - start
    return clocks, np.cumsum(moves[moves != 0], dtype=np.int64) - moves[moves != 0] / 2


def draw_torch(panels: Any) -> str:
    """Torch over the sheet, its height, its voltage."""
    follows, rests = torch(), torch(follows=False)
    first, second = panels
    first.plot(follows.of("x"), follows.of("sheet"), color="#57606a", label="sheet")
    first.plot(rests.of("x"), rests.of("torch"), "--", color="#8c959f", label="torch without tracker")
    first.plot(follows.of("x"), follows.of("torch"), label="torch with tracker")
    first.set(title="A torch over a warped sheet", ylabel="mm")
    first.legend()
    second.plot(follows.of("x"), follows.of("volts"), ".", markersize=2, color="#8c959f")
    second.set(title="Its voltage, read every millisecond", xlabel="X, mm", ylabel="V")
    offs = [np.abs(one.of("height") - HEIGHT).max() for one in (rests, follows)]
    same = np.array_equal(steps_of(follows, 0)[0], steps_of(rests, 0)[0])
    said = f"height off by at most {offs[0]:.2f} mm without, {offs[1]:.2f} mm with tracker"
    return f"{said}; the same steps of X: {'yes' if same else 'no'}"


def draw_gantry(panels: Any) -> str:
    """Both motors, and the skew."""
    result = gantry()
    first, second = panels
    for name in ("y0", "y1"):
        first.plot(result.seconds, result.of(name), label=f"motor {name[1]}")
    first.set(title="A gantry is squared while no path runs", ylabel="mm from its switch")
    first.legend()
    second.plot(result.seconds, result.of("skew"), color="#8c959f")
    second.set(title="Skew", xlabel="s", ylabel="mm")
    return f"skew {result.of('skew')[0]:.3f} mm before, {result.of('skew')[-1]:.3f} mm after"


def draw_leadscrew(panels: Any) -> str:
    """Errors over the path, and over time."""
    corrected, plain = leadscrew(), leadscrew(corrected=False)
    offs = []
    for name, one in (("without tracker", plain), ("with tracker", corrected)):
        seconds, at, off = nut_errors(one, plain)
        panels[0].plot(at, 1000 * off, label=name)
        panels[1].plot(seconds, 1000 * off)
        offs.append(1000 * np.abs(off).max())
    panels[0].set(title="Error of a leadscrew, there and back", xlabel="X, mm", ylabel="µm")
    panels[0].legend()
    panels[1].set(xlabel="s", ylabel="µm")
    return f"off by at most {offs[0]:.0f} µm without, {offs[1]:.0f} µm with tracker"


USES = {"torch": draw_torch, "gantry": draw_gantry, "leadscrew": draw_leadscrew}


def main() -> None:
    """Run one and draw it."""
    import matplotlib.pyplot as plt
    from passo.plot import STYLE, save

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("use", choices=USES, nargs="?", default="gantry", help="default: gantry")
    parser.add_argument("--picture", type=Path, help="draw it into this file")
    arguments = parser.parse_args()
    with plt.rc_context(STYLE):  # type: ignore[arg-type]
        figure, panels = plt.subplots(2, 1, figsize=(9, 6), height_ratios=[2, 1], layout="constrained")
        print(USES[arguments.use](panels))
        if arguments.picture:
            save(figure, arguments.picture, 110)


if __name__ == "__main__":
    main()
