# SPDX-License-Identifier: MIT
"""What a path bound to a machine keeps, in the C model: pitch of a thread, energy per step, raster."""

import random
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray
from passo import registers as r
from passo.build import Parameters
from passo.engine import EVENT, Engine, model_engine
from passo.host import Channel
from passo.link import Link
from passo.registers import LineOutputWord, State

from tests.helpers.closed_form import ONE, Line, Ramp
from tests.helpers.motions import to_line, to_ramp

GRAY = ((0, 0), (1, 0), (1, 1), (0, 1))  # A and B while a shaft turns up
RATE_ONE = 1 << 16
PERCENTS = (5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100)


class Spindle:
    """An encoder of axis 2 whose speed wanders by 30 %; it never stops."""

    PER_TURN = 400  # counts
    CLOCKS = 12  # per count, at the mean speed

    def __init__(self, engine: Engine, rng: random.Random) -> None:
        self.engine, self.rng = engine, rng
        self.at = 0
        self.time = 0.0
        self.period = float(self.CLOCKS)
        self.counts: list[int] = []  # clocks since the last index

    def turn(self) -> None:
        """One turn, from index to index."""
        low, high = self.CLOCKS / 1.3, self.CLOCKS * 1.43
        for _ in range(self.PER_TURN):
            self.period = min(high, max(low, self.period + self.rng.uniform(-0.2, 0.2)))
            self.time += self.period
            left = int(self.time)
            self.time -= left
            run(self.engine, left)
            self.at += 1
            a, b = GRAY[self.at % 4]
            self.engine.set("encoder_a", a << 2)
            self.engine.set("encoder_b", b << 2)
            self.engine.set("encoder_index", (self.at % self.PER_TURN == 0) << 2)
            self.counts.append(self.engine.clock)


def run(engine: Engine, clocks: int) -> None:
    """Run this many clocks."""
    while clocks:
        clocks -= engine.run(clocks)


def thread(seed: int) -> dict[str, Any]:
    """Ten passes of 100 turns: how far steps are from the exact pitch, whether all passes are the same."""
    rng = random.Random(f"{seed}/spindle")
    parameters = Parameters(channels=1, axes=3, encoders=1)
    pitch = Fraction(1, 3)  # steps per count
    per_count = int(pitch * ONE)
    ticks = 100 * Spindle.PER_TURN // 128 - 2
    steps = (ONE // 4 + per_count * ticks * 128) // ONE
    passes: list[tuple[int, ...]] = []
    worst = Fraction(0)
    with model_engine(parameters) as engine:
        spindle = Spindle(engine, rng)
        channel = Channel(Link(engine), parameters)
        follow = 1 << r.CHANNEL_FOLLOW_FOLLOW_LSB | 1 << r.CHANNEL_FOLLOW_WAIT_INDEX_LSB
        source = 2 << r.CHANNEL_FOLLOW_SOURCE_LSB
        channel.link.write(channel.base + r.CHANNEL_FOLLOW, follow | source, 1 << 31)
        channel.link.write(channel.base + r.CHANNEL_ENCODER_FILTER, 2)
        latency = 2 + 14  # filter, and pin to STEP
        for _ in range(10):
            channel.push_lines([to_line(Line(steps, (steps, 0, 0), last=True))])
            channel.push_ramps([to_ramp(Ramp(per_count, 0)), to_ramp(Ramp(per_count, ticks, last=True))])
            channel.start()
            engine.drain()
            spindle.turn()  # the index at its end starts the motion
            start = engine.clock
            spindle.counts.clear()
            for _ in range(101):
                spindle.turn()
            ended = channel.state().state == State.IDLE
            events = engine.drain()
            made = [int(clock) for clock in events["clock"][events["step"] & 1 == 1] if clock > start]
            at_clock = {clock + latency: n for n, clock in enumerate(spindle.counts, 1)}
            at = tuple(at_clock.get(clock, -1) for clock in made)
            if not ended or len(at) != steps or -1 in at:
                passes.append(())
                continue
            exact = [(k - Fraction(1, 4)) / pitch for k in range(1, steps + 1)]
            worst = max(worst, *(abs(n - e) for n, e in zip(at, exact, strict=True)))
            passes.append(at)
    return {
        "turns": 1010,
        "steps": sum(map(len, passes)),
        "worst_counts": float(worst),
        "same_phase": len(set(passes)) == 1 and passes[0] != (),
        "ok": worst < 1 and len(set(passes)) == 1 and passes[0] != (),
    }


class _Laser:
    """A core with outputs, one axis of which moves, with a step every substep."""

    def __init__(self, engine: Engine, **settings: int) -> None:
        parameters = Parameters(channels=1, axes=3, outputs=1, raster=1, compare=1)
        self.engine = engine
        self.channel = Channel(Link(engine), parameters)
        for name, value in settings.items():
            self.channel.link.write(self.channel.base + getattr(r, f"CHANNEL_{name.upper()}"), value)
        self.events = np.zeros(1, EVENT)

    def see(self, clocks: int) -> NDArray[Any]:
        """Run, and take all events so far."""
        run(self.engine, clocks)
        self.events = np.concatenate([self.events[-1:], self.engine.drain()])
        return self.events

    def energy(self, clocks: int) -> float:
        """Clocks with power per step."""
        self.see(0)
        events = self.see(clocks)
        step, power = events["step"] & 1, events["power"] & 1
        rises = np.flatnonzero((step[1:] == 1) & (step[:-1] == 0)) + 1
        first, last = int(rises[0]), int(rises[-1])
        lengths = np.diff(events["clock"].astype(np.int64))[first:last]
        return float((lengths * power[first:last]).sum() / (len(rises) - 1))


def laser() -> dict[str, Any]:
    """Energy per step from 5 % to 100 % of the speed, and through holds and resumes: relative errors."""
    with model_engine(Parameters(channels=1, axes=3, outputs=1, raster=1, compare=1)) as engine:
        core = _Laser(engine, pwm_step=(1 << 24) // 50, power_reference=1 << 31)
        core.channel.configure_motion(400, RATE_ONE, 1 << 28)
        word = LineOutputWord(raster=False, proportional=True, levels=0, power=50_000)
        core.channel.push_lines([to_line(Line(10, (10, 0, 0), endless=True))], [word])
        core.channel.push_ramps([to_ramp(Ramp(ONE // 2, 20)), to_ramp(Ramp(ONE // 2, 1 << 20))])
        core.channel.start()
        core.see(10_000)
        ideal = 2 * 50_001 / 65536
        errors = {}
        for percent in PERCENTS:
            core.channel.set_rate(RATE_ONE * percent // 100)
            core.see(30_000)
            errors[f"{percent} %"] = core.energy(20_000 if percent > 20 else 100_000) / ideal - 1
        core.channel.set_rate(RATE_ONE)
        core.see(30_000)
        core.see(0)
        parts = []
        for _ in range(3):
            for rate in (0, RATE_ONE):
                core.channel.set_rate(rate)
                parts.append(core.see(40_000)[:-1])
        core.events = np.concatenate([*parts, core.events[-1:]])
        step, power = core.events["step"] & 1, core.events["power"] & 1
        lengths = np.diff(core.events["clock"].astype(np.int64))
        made = int(((step[1:] == 1) & (step[:-1] == 0)).sum())
        errors["hold and resume"] = float((lengths * power[:-1]).sum() / made / ideal - 1)
    worst = max(map(abs, errors.values()))
    return {"errors": errors, "worst": worst, "ok": worst < 0.01}


def raster(seed: int) -> dict[str, Any]:
    """Values that come with their exact substep."""
    rng = random.Random(f"{seed}/raster")
    values = wrong = 0
    with model_engine(Parameters(channels=1, axes=3, outputs=1, raster=1, compare=1)) as engine:
        core = _Laser(engine)
        for pitch in (1, 2, 3, 7):
            core.channel.link.write(core.channel.base + r.CHANNEL_RASTER_PITCH, pitch)
            for _ in range(20):
                row = [rng.choice((0, 255)) for _ in range(rng.randrange(1, 100))]
                padded = bytes(row + [0] * (-len(row) % 4))
                words = [int.from_bytes(padded[i : i + 4], "little") for i in range(0, len(padded), 4)]
                substeps = pitch * len(row)
                core.channel.link.push(core.channel.base + r.CHANNEL_RASTER, words)
                word = LineOutputWord(raster=True, proportional=False, levels=0, power=0)
                core.channel.push_lines([to_line(Line(substeps, (substeps, 0, 0), last=True))], [word])
                ramps = [Ramp(ONE // 2, 0), Ramp(ONE // 2, 1 + substeps // 64, last=True)]
                core.see(0)
                core.channel.push_ramps([to_ramp(ramp) for ramp in ramps])
                core.channel.start()
                events = core.see(3000)
                step, power = events["step"] & 1, events["power"] & 1
                rises = np.flatnonzero((step[1:] == 1) & (step[:-1] == 0)) + 1
                wanted = np.repeat([value // 255 for value in row], pitch)
                values += len(row)
                wrong += len(row) if len(rises) != substeps else int((power[rises] != wanted).sum())
    return {"values": values, "wrong": wrong, "ok": wrong == 0}


def measure(seed: int) -> dict[str, Any]:
    """All of it."""
    return {"thread": thread(seed), "laser": laser(), "raster": raster(seed)}
