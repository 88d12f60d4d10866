# SPDX-License-Identifier: MIT
"""Trackers in the model: what they promise, seen at the pins; skipped time is the same as clock by clock.

PASSO_SEED is the seed of the targets. The RTL is compared with the model in cocotb_tests/core_trackers.py.
"""

import random

import numpy as np
import pytest
from passo import registers as r
from passo.build import Parameters
from passo.engine import model_engine
from passo.host import Channel
from passo.link import Link

from benchmarks import backlash
from tests.test_core_advance import SEED, Session
from verify.mutants.trackers_judge import Trackers
from verify.soak.parts import TRACKER_SETS

BUILDS = [
    Parameters(channels=1, axes=3, inputs=1, trackers=1),
    Parameters(channels=2, axes=5, line_queue_log2=3, ramp_queue_log2=3, trackers=1),
    Parameters(channels=1, axes=4, inputs=1, trackers=1),
]
STEP = 1 << 32
TICK = 128  # clocks
WINDOWS = 4, 16, 64, 256  # ticks


class TrackerSession(Session):
    """A host that also sends trackers about."""

    def command(self, channel: Channel) -> None:
        """A target, a limit, an enable, or what every host does."""
        rng = self.rng
        kind, axis = rng.randrange(8), rng.randrange(self.axes)
        if kind == 0:
            targets = [rng.randint(-40, 40) % STEP for _ in range(self.axes)]
            self.try_to(self.link.write, channel.base + r.CHANNEL_TRACKER_TARGET_BASE, *targets)
        elif kind == 1:
            target = rng.randint(-40, 40) % STEP
            self.try_to(self.link.write, channel.base + r.CHANNEL_TRACKER_TARGET_DOWN_BASE + axis, target)
        elif kind == 2:
            limits = rng.getrandbits(32) | 1 << 26, rng.getrandbits(28)
            self.try_to(self.link.write, channel.axis_base(axis) + r.AXIS_TRACKER_SPEED, *limits)
        elif kind == 3:
            enable = rng.choice([0xFF, rng.getrandbits(8)])
            self.try_to(self.link.write, channel.base + r.CHANNEL_TRACKER_ENABLE, enable)
        else:
            super().command(channel)


@pytest.mark.parametrize("number", range(3 * len(BUILDS)))
def test_advance_agrees_with_every_clock(number: int) -> None:
    rng = random.Random(f"trackers {SEED}/{number}")
    TrackerSession(BUILDS[number % len(BUILDS)], rng).play(25)


def test_what_waits_for_a_tracker_is_skipped() -> None:
    """Of a tracker that moves all but five clocks a tick, and of a stopped channel everything."""
    session = TrackerSession(BUILDS[2], random.Random(SEED))
    base, first = session.channels[0].base, session.channels[0].axis_base(0)
    session.link.write(first + r.AXIS_TRACKER_SPEED, 1 << 24, 1 << 20)
    session.link.write(base + r.CHANNEL_TRACKER_TARGET_BASE, 1000)
    session.link.write(base + r.CHANNEL_TRACKER_ENABLE, 1)
    for command, least in (0, 93_000), (r.ChannelCommandWord(abort=True).pack(), 99_900):
        session.link.write(base + r.CHANNEL_COMMAND, command)
        session.pair.run(2 * TICK)
        skipped = session.pair.skipped
        session.pair.run(100_000)
        assert session.pair.skipped - skipped > least


def counts(steps: np.ndarray, signs: np.ndarray, ticks: int) -> np.ndarray:
    """The position at the end of each tick, from the clocks and directions of the steps."""
    made = np.zeros(ticks + 1, np.int64)
    np.add.at(made, np.minimum(steps // TICK, ticks), signs)
    return np.cumsum(made)


@pytest.mark.parametrize("number", range(4))
def test_limits_hold_at_the_pins_whatever_the_targets_do(number: int) -> None:
    """Speed and acceleration over windows, to the rounding of steps; no step away from a target at rest."""
    rng = random.Random(f"pins {SEED}/{number}")
    acceleration = int(2 ** rng.uniform(16, 26))
    speed = min(STEP - 1, int(acceleration * 2 ** rng.uniform(2, 7)))
    with model_engine(Parameters(axes=1, trackers=1)) as engine:
        channel = Channel(Link(engine), Parameters(axes=1, trackers=1))
        link, base = channel.link, channel.base
        link.write(channel.axis_base(0) + r.AXIS_TRACKER_SPEED, speed, acceleration)
        reach = max(3, speed * speed // acceleration // STEP)  # steps
        target = 0
        for _ in range(25):
            target = rng.randint(-4 * reach, 4 * reach)
            link.write(base + r.CHANNEL_TRACKER_TARGET_BASE, target % STEP)
            link.write(base + r.CHANNEL_TRACKER_TARGET_DOWN_BASE, target % STEP)
            link.write(base + r.CHANNEL_TRACKER_ENABLE, 1)
            engine.run(rng.randrange(TICK * 8 * speed // acceleration + 1000))
        jumped = engine.clock
        engine.run(TICK * (8 * reach * STEP // speed + 4 * speed // acceleration + 100))
        events = engine.drain()
        ticks = engine.clock // TICK
        assert channel.positions() == [target]
    step, down = events["step"] & 1, events["dir"] & 1
    rising = np.flatnonzero(np.diff(np.concatenate([[0], step]).astype(np.int64)) == 1)
    clocks, signs = events["clock"][rising].astype(np.int64), 1 - 2 * down[rising].astype(np.int64)
    at = counts(clocks, signs, ticks)
    assert at[-1] == target
    for window in WINDOWS:
        moved = at[window:] - at[:-window]
        assert np.abs(moved).max() <= window * speed / STEP + 1
        bent = moved[window:] - moved[:-window]
        assert np.abs(bent).max() <= window * window * acceleration / STEP + 2
    # the target has been at rest since then: once it is on its way, it comes nearer with each step
    places = np.concatenate([[0], np.cumsum(signs)])
    away = np.abs(places[np.searchsorted(clocks, jumped, "right") :] - target)
    assert np.all(np.diff(away[away.argmax() :]) <= 0)


@pytest.mark.parametrize("number", range(6))
def test_stops_and_zero_as_the_judge_at_the_pins_knows_them(number: int) -> None:
    """After ZERO the position of every axis is 0, also of the last one, whose turn ends with the tick."""
    with model_engine(TRACKER_SETS[0]) as engine:
        trackers = Trackers(engine, TRACKER_SETS[0], random.Random(f"{number}"))
        trackers.set_up()
        trackers.measure()
        for hard in (False, True, False):
            trackers.stops(hard)


def test_backlash_makes_a_circle_round() -> None:
    """Ten times as round at least, in no more time."""
    plain, taken = backlash.machine(False), backlash.machine(True)
    assert plain.roundness > 2 * backlash.PLAY_MM - 0.01
    assert plain.roundness > 10 * taken.roundness
    assert taken.seconds <= 1.02 * plain.seconds
