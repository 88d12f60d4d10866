# SPDX-License-Identifier: MIT
"""passo_core_advance() of a core with OUTPUTS: the same state as clock by clock, and idle time is skipped.

PASSO_SEED is the seed of the random motions.
"""

import random
from collections.abc import Sequence
from typing import Any

import pytest
from passo import registers as r
from passo.build import Parameters
from passo.host import Channel
from passo.link import Link
from passo.registers import LineOutputWord, State

from tests.helpers.closed_form import ONE, Line, Ramp
from tests.helpers.core_player import PlayerPair
from tests.helpers.motions import SLOW, to_line, to_ramp
from tests.test_core_advance import SEED, Session

BUILDS = [
    Parameters(channels=1, axes=3, outputs=1, raster=1, compare=1),
    Parameters(channels=2, axes=2, line_queue_log2=3, ramp_queue_log2=3, outputs=1, raster=1, compare=1),
]
SETTINGS = range(r.CHANNEL_OUTPUT_LEVELS, r.CHANNEL_COMPARE_INTERVAL + 1)


class OutputChannel(Channel):
    """A channel whose lines have outputs of all kinds."""

    def __init__(self, session: Session, number: int):
        super().__init__(session.link, session.pair.parameters, number)
        self.rng = session.rng

    def push_lines(self, lines: Sequence[Any], outputs: Sequence[LineOutputWord] = ()) -> None:
        """With outputs drawn by chance."""
        super().push_lines(lines, [self.draw() for _ in lines])

    def draw(self) -> LineOutputWord:
        """An output word."""
        rng = self.rng
        raster = rng.random() < 0.3
        power = 0 if raster else rng.choice((0, 0xFFFF, rng.getrandbits(16)))
        return LineOutputWord(
            raster=raster, proportional=rng.random() < 0.5, levels=rng.getrandbits(8), power=power
        )


class OutputSession(Session):
    """A host that also writes settings of the outputs and raster values."""

    PUSHES = 0.5

    def __init__(self, parameters: Parameters, rng: random.Random):
        super().__init__(parameters, rng)
        self.channels = [OutputChannel(self, n) for n in range(parameters.channels)]

    def command(self, channel: Channel) -> None:
        """A command, a setting, values."""
        rng = self.rng
        value = rng.choice((0, 1, 2, 300, rng.getrandbits(rng.randint(1, 32))))
        kind = rng.randrange(3)
        if kind == 0:
            super().command(channel)
        elif kind == 1:
            self.try_to(self.link.write, channel.base + rng.choice(SETTINGS), value)
        else:
            words = [rng.getrandbits(32) for _ in range(rng.randint(1, 20))]
            self.try_to(self.link.push, channel.base + r.CHANNEL_RASTER, words)


@pytest.mark.parametrize("number", range(6))
def test_advance_agrees_with_every_clock(number: int) -> None:
    rng = random.Random(f"{SEED}/outputs/{number}")
    OutputSession(BUILDS[number % len(BUILDS)], rng).play(25)


def test_idle_time_is_skipped() -> None:
    """Before and after a motion, with settings that are not those of a reset."""
    pair = PlayerPair(BUILDS[0], random.Random(SEED))
    channel = Channel(Link(pair), BUILDS[0])
    channel.link.write(channel.base + r.CHANNEL_OUTPUT_LAG, 5000)
    channel.link.write(channel.base + r.CHANNEL_COMPARE_PULSE, 100, 3, 2)
    pair.run(100_000)
    output = LineOutputWord(raster=False, proportional=True, levels=9, power=1 << 15)
    channel.push_lines([to_line(Line(100, (99, -7, 0), last=True))], [output])
    channel.push_ramps([to_ramp(ramp) for ramp in (Ramp(SLOW, 9), Ramp(0, 9, last=True))])
    channel.start()
    pair.run(400_000)
    assert channel.state().state == State.IDLE
    assert channel.positions() == [99, -7, 0]
    assert pair.skipped > pair.clock * 0.8


@pytest.mark.parametrize("power", [0, 20_000, 0xFFFF])
def test_a_motion_is_skipped(power: int) -> None:
    """Within its ticks, between steps and edges of the PWM; levels change."""
    pair = PlayerPair(BUILDS[0], random.Random(SEED))
    channel = Channel(Link(pair), BUILDS[0])
    channel.link.write(channel.base + r.CHANNEL_PWM_STEP, 1 << 12, 1 << 30)
    outputs = [
        LineOutputWord(raster=False, proportional=power == 0, levels=levels, power=power) for levels in (9, 5)
    ]
    lines = [Line(2000, (99, -7, 0)), Line(3000, (30, 0, 50), last=True)]
    channel.push_lines([to_line(line) for line in lines], outputs)
    channel.push_ramps([to_ramp(Ramp(ONE // 60, 500)), to_ramp(Ramp(ONE // 70, 4000))])
    channel.start()
    pair.run(200_000)
    assert channel.state().state == State.RUN
    assert pair.skipped > pair.clock * 0.8
