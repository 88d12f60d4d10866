# SPDX-License-Identifier: MIT
"""Encoders in the C model: a thread of a thousand turns, and skipped time.

PASSO_SEED is the seed of everything random.
"""

import random
from fractions import Fraction

import pytest
from passo import random_cases
from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine, model_engine
from passo.host import Channel
from passo.link import Link
from passo.registers import State

from tests.helpers.closed_form import ONE, Line, Ramp
from tests.helpers.motions import to_line, to_ramp
from tests.test_core_advance import Session

SEED = random_cases.seed()
GRAY = ((0, 0), (1, 0), (1, 1), (0, 1))  # A and B while a shaft turns up
BUILDS = [
    Parameters(channels=1, axes=3, encoders=1),
    Parameters(channels=2, axes=2, line_queue_log2=2, ramp_queue_log2=2, encoders=1),
]


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
            while left:
                left -= self.engine.run(left)
            self.at += 1
            a, b = GRAY[self.at % 4]
            self.engine.set("encoder_a", a << 2)
            self.engine.set("encoder_b", b << 2)
            self.engine.set("encoder_index", (self.at % self.PER_TURN == 0) << 2)
            self.counts.append(self.engine.clock)


def test_a_thousand_turns_of_a_wandering_spindle() -> None:
    """Ten passes of 100 turns: each step within a count of the exact pitch, the same counts in each pass."""
    print(f"PASSO_SEED={SEED}")
    rng = random.Random(f"{SEED}/spindle")
    parameters = Parameters(channels=1, axes=3, encoders=1)
    pitch = Fraction(1, 3)  # steps per count
    per_count = int(pitch * ONE)
    ticks = 100 * Spindle.PER_TURN // 128 - 2
    steps = (ONE // 4 + per_count * ticks * 128) // ONE
    passes: set[tuple[int, ...]] = set()
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
            assert channel.state().state == State.IDLE
            events = engine.drain()
            made = [int(clock) for clock in events["clock"][events["step"] & 1 == 1] if clock > start]
            at_clock = {clock + latency: n for n, clock in enumerate(spindle.counts, 1)}
            at = tuple(at_clock[clock] for clock in made)
            assert len(at) == steps
            exact = [(k - Fraction(1, 4)) / pitch for k in range(1, steps + 1)]
            worst = max(worst, *(abs(n - e) for n, e in zip(at, exact, strict=True)))
            passes.add(at)
    print(f"{steps} steps in each of 10 passes, {float(worst):.4f} counts at most from the exact pitch")
    assert worst < 1
    assert len(passes) == 1


class EncoderSession(Session):
    """A host with encoders: their settings, threads, and pins that do anything."""

    def poke(self) -> None:
        """Some levels at the pins of the encoders, each for some clocks."""
        rng = self.rng
        bits = self.axes * len(self.channels)
        for _ in range(rng.randint(1, 30)):
            for pin in rng.sample(("encoder_a", "encoder_b", "encoder_index"), rng.randint(1, 3)):
                self.pair.set(pin, rng.getrandbits(bits))
            self.pair.run(rng.choice((1, 2, 5, rng.randint(1, 40), rng.randint(1, 400))))

    def configure(self, channel: Channel) -> None:
        """A setting of an encoder, or what is followed."""
        rng = self.rng
        axis = channel.base + r.CHANNEL_ENCODER_BASE + rng.randrange(self.axes) * r.CHANNEL_ENCODER_STRIDE
        kind = rng.randrange(5)
        if kind == 0:
            self.try_to(self.link.write, axis, rng.getrandbits(5))
        elif kind == 1:
            self.try_to(self.link.write, axis + 1, rng.getrandbits(rng.randint(1, 32)))
        elif kind == 2:
            self.try_to(self.link.write, axis + 2, rng.getrandbits(rng.randint(1, 16)))
        elif kind == 3:
            follow = rng.choice((0, rng.getrandbits(8), 1 | rng.getrandbits(8) & 0xFC))
            self.try_to(self.link.write, channel.base + r.CHANNEL_FOLLOW, follow)
        else:
            words = rng.getrandbits(rng.randint(1, 31)), rng.randrange(8)
            self.try_to(self.link.write, channel.base + r.CHANNEL_FOLLOW_LIMIT, *words)


@pytest.mark.parametrize("number", range(6))
def test_advance_agrees_with_every_clock(number: int) -> None:
    """Whatever host and shafts do, pins and state are the same with and without skipping."""
    print(f"PASSO_SEED={SEED}")
    rng = random.Random(f"{SEED}/encoders/{number}")
    session = EncoderSession(BUILDS[number % len(BUILDS)], rng)
    session.link.write(r.ADDRESS_RUN, (1 << len(session.channels)) - 1)
    for _ in range(40):
        channel = rng.choice(session.channels)
        what = rng.choice((session.push, session.push, session.command, session.configure))
        what(channel)
        if rng.random() < 0.5:
            session.poke()
        session.go_on(rng.choice([200, 3000, 20000]))
    assert session.pair.compared > 500
    assert session.pair.events > 0
    assert session.pair.skipped > session.pair.clock * 0.1


def test_a_core_with_encoders_that_stand_is_skipped() -> None:
    """Encoders cost no time where nothing follows them."""
    rng = random.Random(SEED)
    session = EncoderSession(BUILDS[0], rng)
    session.pair.set("encoder_a", 5)
    session.pair.run(100_000)
    assert session.pair.skipped > 99_000
