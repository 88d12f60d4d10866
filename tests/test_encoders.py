# SPDX-License-Identifier: MIT
"""Encoders in the C model: a thread of a thousand turns, and skipped time.

PASSO_SEED is the seed of everything random.
"""

import random

import pytest
from passo import random_cases
from passo import registers as r
from passo.build import Parameters
from passo.host import Channel

from tests.test_core_advance import Session
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


def test_a_core_with_encoders_that_stand_is_skipped() -> None:
    """Encoders cost no time where nothing follows them."""
    rng = random.Random(SEED)
    session = EncoderSession(BUILDS[0], rng)
    session.pair.set("encoder_a", 5)
    session.pair.run(100_000)
    assert session.pair.skipped > 99_000
