# SPDX-License-Identifier: MIT
"""Random moves in each form of spec/moves.toml, as tables of a move file."""

import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from passo.move_forms import PROFILES
from passo.random_cases import log_uniform
from passo.shaper import SHAPERS

SHORTEST, LONGEST, RARELY = 2**8, 2**17, 2**21  # clocks of a move, roughly
LARGEST = 4e9  # acceleration, jerk; for all axes

Data = dict[str, Any]


@dataclass(frozen=True)
class Bank:
    """What the moves of a file have in the table that can be loaded: one of BANKS, or nothing."""

    kind: str
    file: str  # of a user's shape
    alpha: float  # of a sigmoid


BANKS = ("user", "shaped", "alpha")


def _short(value: float) -> float:
    return float(f"{value:.5g}")


class FormDraw:
    """A move of some clocks and steps, within what the pins allow."""

    def __init__(self, rng: random.Random, clock_hz: int, axes: int, between: float, bank: Bank):
        self.rng, self.clock_hz, self.axes, self.bank = rng, clock_hz, axes, bank
        longest = RARELY if rng.random() < 0.01 else LONGEST
        self.flat = int(log_uniform(rng, max(SHORTEST, 2 * between), longest))  # clocks at full speed
        self.longest = int(log_uniform(rng, 1, self.flat / between))
        if rng.random() < 0.1:
            self.longest = int(self.flat / between)
        self.speed = _short(self.longest * clock_hz / self.flat)
        self.ramp = int(rng.choice((rng.uniform(0, self.flat), log_uniform(rng, 64, self.flat))))

    def move(self) -> Data:
        """In any form."""
        if self.bank.kind == "user":
            form = self.rng.choice(("in_time", "by_speed"))
        elif self.bank.kind == "shaped":
            form = "in_time"
        elif self.bank.kind == "alpha":
            form = "sigmoid"
        else:
            form = self.rng.choice(tuple(FORMS))
        return FORMS[form](self)

    def steps(self) -> list[int]:
        """Of each axis, one of them the longest."""
        some = (0, 1, self.longest, int(log_uniform(self.rng, 1, self.longest + 1)))
        steps = [self.rng.choice(some) for _ in range(self.axes)]
        steps[self.rng.randrange(self.axes)] = self.longest
        return [n * self.rng.choice((1, -1)) for n in steps]

    def time(self, clocks: float) -> str | float:
        """In one of two units."""
        return f"{int(clocks)}clocks" if self.rng.random() < 0.5 else _short(clocks / self.clock_hz)

    def slower(self) -> float:
        """A start or stop speed."""
        return self.rng.choice((0, _short(self.speed * self.rng.random()), self.speed))

    def speeds(self) -> Data:
        """Full, start and stop speed."""
        return {"speed": self.speed, "start_speed": self.slower(), "stop_speed": self.slower()}

    def profile(self) -> Data:
        """One of those built in."""
        return {"profile": self.rng.choice(PROFILES)}

    def shape(self) -> Data:
        """Any of a move in time or by speed."""
        if self.bank.kind == "user":
            return {"profile": "user", "table": self.bank.file}
        if self.bank.kind == "shaped":
            frequency = _short(self.clock_hz / max(self.ramp, 1) * self.rng.uniform(1.1, 3))
            damping = round(self.rng.uniform(0, 0.5), 3)
            facts = {"name": self.rng.choice(tuple(SHAPERS)), "frequency": frequency, "damping": damping}
            return {"profile": "shaped", "shaper": facts}
        return self.profile()

    def acceleration(self) -> float:
        """A full ramp takes the ramp time; where the largest is not enough, the move is shorter."""
        seconds = self.flat / self.clock_hz
        made = min(max(_short(self.speed * self.clock_hz / (self.ramp + 1)), 1e-3), LARGEST)
        self.longest = max(1, min(self.longest, int(made * seconds**2 / 4)))
        return made

    def jerk(self, acceleration: float) -> float:
        """The acceleration is reached in a part of the ramp time; the same."""
        seconds = self.flat / self.clock_hz
        wanted = acceleration * self.clock_hz / (self.ramp + 1) * log_uniform(self.rng, 1, 100)
        made = min(_short(wanted), LARGEST)
        self.longest = max(1, min(self.longest, int(made * seconds**3 / 32)))
        return made


def _in_time(draw: FormDraw) -> Data:
    shape = draw.shape()
    ramps = 2 if shape["profile"] == "user" else 1  # a user's ramps may cover next to nothing
    total = draw.flat + draw.ramp * ramps
    ramp = min(draw.ramp, total // 2 - 2)
    if draw.bank.kind != "shaped" and draw.rng.random() < 0.2:
        ramp = 0
    in_clocks = {"total_time": f"{total}clocks", "ramp_time": f"{ramp}clocks"}
    seconds = (_short(total * 1.001 / draw.clock_hz), _short(ramp / draw.clock_hz))
    in_seconds = dict(zip(("total_time", "ramp_time"), seconds, strict=True))
    return {"steps": draw.steps(), **shape, **draw.rng.choice((in_clocks, in_seconds))}


def _by_speed(draw: FormDraw) -> Data:
    ramps: Data = {}
    if draw.rng.random() < 0.5:
        ramps["ramp_time"] = draw.time(draw.ramp + 1)
    else:
        ramps["acceleration"] = draw.acceleration()
        if draw.rng.random() < 0.5:
            other = ramps["acceleration"] * log_uniform(draw.rng, 0.25, 4)
            ramps["deceleration"] = min(_short(other), LARGEST)
    return {"steps": draw.steps(), **draw.shape(), **draw.speeds(), **ramps}


def _below_speed(draw: FormDraw) -> Data:
    total = (draw.flat + draw.ramp) * 1.001 + 256
    return {
        "method": "below_speed",
        "steps": draw.steps(),
        **draw.profile(),
        "total_time": draw.time(total),
        "speed": draw.speed,
    }


def _at_speed(draw: FormDraw) -> Data:
    ramp = draw.time(draw.rng.choice((0, draw.ramp * 0.99)))
    move = {"method": "at_speed", "steps": draw.steps(), **draw.profile()}
    return move | {"speed": draw.speed, "ramp_time": ramp}


def _axes(draw: FormDraw) -> Data:
    move = {"method": "axes", "steps": draw.steps(), "start_speed": draw.slower(), "speed": draw.speed}
    return move | {"ramp_time": draw.time(draw.ramp + 1)}


def _turn(draw: FormDraw) -> Data:
    acceleration = draw.acceleration()
    per_turn = draw.rng.choice((1, 200, 1600, 3200, 51_200))
    sign = draw.rng.choice((1, -1))
    return {
        "method": "turn",
        "axis": draw.rng.randrange(draw.axes),
        "axes": draw.axes,
        "steps_per_turn": per_turn,
        "angle": _short(sign * 360 * (draw.longest + draw.rng.uniform(-0.4, 0.4)) / per_turn),
        "rpm": _short(60 * draw.speed / per_turn),
        "minimum_rpm": _short(60 * draw.slower() / per_turn * 0.999),
        "acceleration": acceleration,
    }


def _sigmoid(draw: FormDraw) -> Data:
    move = {"method": "sigmoid", "steps": draw.steps(), **draw.speeds()}
    move["accelerate_time"] = draw.time(draw.ramp + 1)
    if draw.rng.random() < 0.5:
        move["decelerate_time"] = draw.time(draw.ramp * draw.rng.random() + 1)
    if draw.bank.kind == "alpha":
        move["alpha"] = draw.bank.alpha
    return move


def _jerk(draw: FormDraw) -> Data:
    acceleration = draw.acceleration()
    limits = {"acceleration": acceleration, "jerk": draw.jerk(acceleration)}
    return {"method": "jerk", "steps": draw.steps(), **draw.speeds(), **limits}


def _straight(draw: FormDraw) -> Data:
    """Limits of each axis such that the leading one could reach the speed."""
    rng, acceleration = draw.rng, draw.acceleration()
    limits = {"speed": draw.speed, "acceleration": acceleration}
    if rng.random() < 0.5:
        limits["jerk"] = draw.jerk(acceleration)
    steps = draw.steps()
    scales = [rng.choice((80, 400, 12.5)) for _ in steps]
    return {
        "method": "straight",
        "distance": [_short(n / scale) for n, scale in zip(steps, scales, strict=True)],
        "feed": _short(draw.speed / min(scales) * rng.uniform(0.5, 4)),
        "steps_per_mm": scales,
        **{name: [_short(value / scale) for scale in scales] for name, value in limits.items()},
    }


FORMS: dict[str, Callable[[FormDraw], Data]] = {
    "in_time": _in_time,
    "by_speed": _by_speed,
    "below_speed": _below_speed,
    "at_speed": _at_speed,
    "axes": _axes,
    "turn": _turn,
    "sigmoid": _sigmoid,
    "jerk": _jerk,
    "straight": _straight,
}
