# SPDX-License-Identifier: MIT
"""Encoders in the C model: a thread of a thousand turns, and skipped time.

PASSO_SEED is the seed of everything random.
"""

import random
from dataclasses import replace

import pytest
from passo import random_cases
from passo import registers as r
from passo.build import Parameters
from passo.host import RATE_ONE, Channel
from passo.registers import State

from tests.helpers.closed_form import ONE, Line, Ramp
from tests.helpers.motions import to_line, to_ramp
from tests.test_core_advance import Session
from tests.test_outputs_advance import OutputChannel
from verify.soak import numbers

SEED = random_cases.seed()
BUILDS = [
    Parameters(channels=1, axes=3, encoders=1),
    Parameters(channels=2, axes=2, line_queue_log2=2, ramp_queue_log2=2, encoders=1),
]


def test_a_thousand_turns_of_a_wandering_spindle() -> None:
    """Ten passes of 100 turns: each step within a count of the exact pitch, the same counts in each pass."""
    print(f"PASSO_SEED={SEED}")
    made = numbers.thread(SEED)
    print(made)
    assert made["worst_counts"] < 1
    assert made["same_phase"]


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

    def disturb(self) -> None:
        """Something happens at the inputs, or at the encoders."""
        if self.rng.random() < 0.5:
            self.poke()
        super().disturb()

    def act(self, channel: Channel) -> None:
        """A motion, a command or a setting."""
        self.rng.choice((self.push, self.push, self.command, self.configure))(channel)

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
    rng = random.Random(f"{SEED}/encoders/{number}")
    session = EncoderSession(BUILDS[number % len(BUILDS)], rng)
    session.play(40)
    assert session.pair.skipped > session.pair.clock * 0.1


QUADRATURE = (0, 1, 3, 2)


class Thread(EncoderSession):
    """A motion that begins with an index and follows the second encoder."""

    def __init__(self, name: str, outputs: bool) -> None:
        build = replace(BUILDS[0], outputs=1, raster=1, compare=1) if outputs else BUILDS[0]
        super().__init__(build, random.Random(f"{SEED}/{name}"))
        self.channel = OutputChannel(self, 0) if outputs else self.channels[0]
        self.at = 0
        self.link.write(r.ADDRESS_RUN, 1)
        self.link.write(self.channel.base + r.CHANNEL_ENCODER_FILTER, self.rng.choice((20, 200)))

    def follow(self, scale: int) -> None:
        """Counts of 2^scale enabled clocks."""
        word = r.ChannelFollowWord(follow=1, wait_index=1, source=1, scale=scale).pack()
        limit = self.rng.choice((1 << 30, 1 << 25))  # with the lower one it stays behind
        self.try_to(self.link.write, self.channel.base + r.CHANNEL_FOLLOW, word, limit)

    def begin(self) -> None:
        """The index."""
        self.pair.run(self.rng.randint(1, 3000))
        self.pair.set("encoder_index", 2)

    def turn(self, counts: int, clocks: int) -> None:
        """One count up or down, and what comes until the next."""
        self.at += counts
        for name, level in (
            ("encoder_a", QUADRATURE[self.at % 4] & 1),
            ("encoder_b", QUADRATURE[self.at % 4] >> 1),
        ):
            self.pair.set(name, level << 1)
        self.pair.run(clocks)


@pytest.mark.parametrize("outputs", [False, True])
@pytest.mark.parametrize("number", range(3))
def test_advance_agrees_in_a_motion_that_follows(number: int, outputs: bool) -> None:
    """The shaft turns back now and then; the motion is held, slowed down, stopped."""
    session = Thread(f"thread/{number}", outputs)
    rng, channel = session.rng, session.channel
    counts, runs = 1, 0
    for _ in range(5):
        session.try_to(channel.clear)
        session.follow(rng.randrange(4))
        session.push(channel)
        session.begin()
        for _ in range(rng.randint(5, 60)):
            if rng.random() < 0.1:
                counts = rng.choice((1, 1, 1, -1))
            if rng.random() < 0.05:
                session.try_to(channel.set_rate, rng.choice((0, RATE_ONE, RATE_ONE, RATE_ONE // 3)))
            session.turn(counts, rng.randint(40, 900))
            runs += channel.state().state == State.RUN
        session.pair.set("encoder_index", 0)
        session.try_to(rng.choice((channel.stop, channel.abort)))
        session.pair.run(2000)
    assert runs > 10


@pytest.mark.parametrize("outputs", [False, True])
def test_time_between_counts_is_skipped(outputs: bool) -> None:
    """Of a motion that waits for its index, and follows then."""
    session = Thread("slow thread", outputs)
    session.follow(3)
    session.channel.push_lines([to_line(Line(1 << 20, (1 << 19, 0, 0), last=True))])
    session.channel.push_ramps([to_ramp(Ramp(ONE // 4, 1)), to_ramp(Ramp(ONE // 4, 1 << 20))])
    session.begin()
    for _ in range(100):
        session.turn(1, 2000)
    assert session.channel.state().state == State.RUN and session.channel.positions()[0] > 20
    assert session.pair.skipped > session.pair.clock * 0.9


def test_a_core_with_encoders_that_stand_is_skipped() -> None:
    """Encoders cost no time where nothing follows them."""
    rng = random.Random(SEED)
    session = EncoderSession(BUILDS[0], rng)
    session.pair.set("encoder_a", 5)
    session.pair.run(100_000)
    assert session.pair.skipped > 99_000
