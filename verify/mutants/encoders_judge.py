# SPDX-License-Identifier: MIT
"""Encoders as judge: motions that follow one make the substeps of its counts, are late, or lose it."""

import random

from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine
from passo.host import Channel
from passo.registers import Cause, State

from tests.helpers.closed_form import ONE, Line, Ramp
from verify.mutants.engine_judge import Check
from verify.mutants.motions_judge import Motions, all_substeps
from verify.soak.numbers import GRAY

MODULES = (
    *("passo_encoders", "passo_encoder_axis", "passo_encoder", "passo_encoder_filter", "passo_follower"),
    *("passo_encoder_registers", "passo_positions", "passo_profile", "passo_path", "passo_core"),
    *("passo_channels", "passo_channel", "passo_channel_path", "passo_channel_control"),
)
FASTEST = 1 << 31  # of FOLLOW_LIMIT: an enabled clock in two
SETTLES = 200  # clocks until a count has been made at the pins


class Encoders(Motions):
    """A core whose first channel follows an encoder."""

    def __init__(self, engine: Engine, parameters: Parameters, rng: random.Random):
        super().__init__(engine, parameters, rng)
        self.at = [0] * parameters.axes
        self.source = 0

    def move(self, counts: int) -> None:
        """The encoder that is followed moves in one clock."""
        self.at[self.source] += counts
        for n, pin in enumerate(("encoder_a", "encoder_b")):
            self.engine.set(pin, sum(GRAY[at % 4][n] << axis for axis, at in enumerate(self.at)))

    def turn(self, counts: int, gap: int) -> None:
        """Some counts, up or down."""
        for _ in range(abs(counts)):
            self.move(1 if counts > 0 else -1)
            self.run(gap)

    def follow(self, limit: int) -> tuple[Channel, Line, int, int]:
        """Begin with a line that repeats: its channel, the velocity, the scale."""
        rng, channel = self.rng, self.channels[0]
        self.source, scale = rng.randrange(self.parameters.axes), rng.randrange(8)
        word = r.ChannelFollowWord(follow=True, source=self.source, scale=scale, wait_index=False)
        self.write(channel, r.CHANNEL_FOLLOW, word.pack(), limit, rng.randrange(4))
        m = rng.randint(1, 60)
        line = Line(m, tuple(rng.randint(-m, m) for _ in range(self.parameters.axes)), endless=True)
        velocity = ONE // rng.randint(60, 90)
        self.push(channel, [line], [Ramp(velocity, 0), Ramp(velocity, 60_000)])
        channel.start()
        self.run(SETTLES)
        assert channel.state().state == State.RUN
        return channel, line, velocity, scale

    def state(self, channel: Channel) -> r.ChannelFollowStateWord:
        """As it is read."""
        return r.ChannelFollowStateWord.unpack(self.link.read(channel.base + r.CHANNEL_FOLLOW_STATE, 1)[0])

    def end(self, channel: Channel, cause: Cause) -> None:
        """It is stopped; then it follows no more."""
        self.run(SETTLES)
        self.see()
        self.check_positions(channel, [0] * self.parameters.axes)
        self.check_end(channel, cause)
        self.write(channel, r.CHANNEL_FOLLOW, 0)

    def follows(self) -> None:
        """The substeps of the furthest count, of which backward counts and those after them repeat none."""
        channel, line, velocity, scale = self.follow(FASTEST)
        gap = (2 << scale) + self.rng.randint(12, 40)
        net = furthest = 0
        for _ in range(6):
            counts = self.rng.randint(-9, 30)
            self.turn(counts, gap)
            net += counts
            furthest = max(furthest, net)
        self.turn(furthest + 1 - net, gap)
        self.run(SETTLES)
        state = self.state(channel)
        assert (state.owed, state.behind, state.lost) == (0, False, False), f"{state}"
        place = channel.base + r.CHANNEL_ENCODER_POSITION_BASE
        assert self.link.read(place + self.source, 1)[0] == furthest + 1, "counts"
        made = (ONE // 4 + velocity * (furthest + 1 << scale)) // ONE
        due = [
            sum(way for _, way in all_substeps([line], axis, made)) for axis in range(self.parameters.axes)
        ]
        assert channel.positions() == due, f"steps of {furthest + 1} counts"
        channel.abort()
        self.end(channel, Cause.ABORT)

    def late(self) -> None:
        """More counts than the limit lets it make: it says so until the next motion."""
        channel, _, _, scale = self.follow(1 << 20)
        counts = self.rng.randint(5, 20)
        self.turn(counts, 30)
        state = self.state(channel)
        assert state.behind and 0 < state.owed <= counts << scale, f"{state}"
        channel.abort()
        self.run(SETTLES)
        assert self.state(channel).behind, "late until the next motion"
        self.end(channel, Cause.ABORT)

    def loses(self) -> None:
        """A and B change on one clock: it stops."""
        channel, _, _, _ = self.follow(FASTEST)
        self.turn(self.rng.randint(1, 9), 300)
        self.move(2)
        self.run(40 * self.tick)
        assert self.state(channel).lost, "it has lost the encoder"
        self.end(channel, Cause.FOLLOWING_ERROR)


def check(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
    """Some of each.

    Raises:
        AssertionError: Something is not as it is known to be.
    """
    if not parameters.encoders:
        return
    encoders = Encoders(engine, parameters, rng)
    encoders.set_up()
    encoders.write(encoders.channels[0], r.CHANNEL_STOP_SLEW, 1 << 14)
    for other in (encoders.late, encoders.loses, encoders.follows):
        encoders.follows()
        other()


CHECK = Check("encoders", "motions", check, MODULES)
