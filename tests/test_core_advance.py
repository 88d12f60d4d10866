# SPDX-License-Identifier: MIT
"""passo_core_advance() leads to the same state as passo_core_clock(), compared byte for byte.

PASSO_SEED is the seed of the random motions.
"""

import random
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

import pytest
from passo import random_cases
from passo import registers as r
from passo.build import Parameters
from passo.host import RATE_ONE, Channel
from passo.link import Link, RefusedError
from passo.moves import PinTiming
from passo.registers import Cause, State

from tests.helpers.closed_form import COSINE, HALF, ONE, SIGMOID, Line, Ramp
from tests.helpers.core_player import PlayerPair
from tests.helpers.motions import SLOW, fill, random_motion, to_line, to_ramp
from tests.helpers.random_inputs import RandomInputs

SEED = random_cases.seed()

BUILDS = [
    Parameters(channels=1, axes=3),
    Parameters(channels=2, axes=2, line_queue_log2=2, ramp_queue_log2=2),
    Parameters(channels=3, axes=1, tick_log2=9, ramp_queue_log2=8),
    Parameters(channels=8, axes=8),
    Parameters(channels=1, axes=3, inputs=1),
    Parameters(channels=2, axes=2, ramp_queue_log2=3, inputs=1),
]


class Session:
    """A host that does anything to any channel at any time; refusals are ignored."""

    PUSHES = 0.6  # share of motions in what it does

    def __init__(self, parameters: Parameters, rng: random.Random):
        self.rng = rng
        self.pair = PlayerPair(parameters, rng)
        self.link = Link(self.pair)
        self.channels = [Channel(self.link, parameters, n) for n in range(parameters.channels)]
        self.axes = parameters.axes
        self.inputs = RandomInputs(rng, parameters) if parameters.inputs else None
        self.lines = min(9, 1 << parameters.line_queue_log2)
        self.ramps = min(12, 1 << parameters.ramp_queue_log2)

    def try_to(self, what: Callable[..., None], *arguments: object) -> None:
        """Execute something; ignore a refusal."""
        with suppress(RefusedError):
            what(*arguments)

    def push(self, channel: Channel) -> None:
        """A motion, with pins that may be too slow for it and faults of all kinds."""
        rng = self.rng
        lines, ramps = random_motion(rng, self.axes, self.lines, self.ramps)
        fault = rng.random()
        if fault < 0.1:
            lines[-1] = replace(lines[-1], last=False)  # LINE_UNDERRUN
        elif fault < 0.2:
            ramps = ramps[:-1]  # RAMP_UNDERRUN, or a motion that waits
        elif fault < 0.3:
            lines[-1] = replace(lines[-1], substeps=lines[-1].substeps + rng.randint(1, 30))  # DRAIN
        elif fault < 0.4:
            lines[-1] = replace(lines[-1], endless=True)
        elif fault < 0.5:
            ramps[rng.randrange(len(ramps))] = Ramp(rng.randrange(HALF), rng.randint(0, 9), COSINE)
        elif fault < 0.6:
            ramps[-1] = replace(ramps[-1], now=True)
        first = rng.random() < 0.5
        if first:
            self.try_to(channel.push_lines, [to_line(line) for line in lines])
        self.try_to(channel.push_ramps, [to_ramp(ramp) for ramp in ramps])
        if not first:
            self.try_to(channel.push_lines, [to_line(line) for line in lines])

    def command(self, channel: Channel) -> None:
        """A command, a setting, a level of sync."""
        rng = self.rng
        address = channel.base
        bits = (1 << rng.randrange(16)) - 1
        kind = rng.randrange(9)
        if kind < 2:
            self.try_to(channel.set_rate, rng.choice([0, RATE_ONE, rng.randint(0, RATE_ONE)]))
        elif kind == 2:
            slews = [min(RATE_ONE, rng.getrandbits(rng.randint(1, 17))) for _ in range(2)]
            velocity = rng.getrandbits(rng.randint(1, 31))
            self.try_to(self.link.write, address + r.CHANNEL_RATE_SLEW, *slews, velocity)
        elif kind == 3:
            self.try_to(self.link.write, address + r.CHANNEL_COMMAND, rng.randrange(1, 16))
        elif kind == 4:
            axis = address + r.CHANNEL_AXIS_BASE + rng.randrange(self.axes) * r.CHANNEL_AXIS_STRIDE
            timing = [rng.randint(0, rng.choice([2, 5, 40])) for _ in range(4)]
            words = rng.randrange(32), timing[0] << 16 | timing[1], timing[2] << 16 | timing[3]
            self.try_to(self.link.write, axis, *words)
        elif kind == 5:
            self.pair.sync(bool(rng.randrange(2)))
        elif kind == 6:
            every = (1 << len(self.channels)) - 1
            wait = bits & every if rng.random() < 0.3 else 0
            self.link.write(r.ADDRESS_RUN, wait << 8 | (rng.getrandbits(8) | 1 << channel.number) & every)
        elif kind == 7:
            points = [rng.getrandbits(16) for _ in range(rng.randint(1, 9))]
            self.try_to(self.link.write, r.ADDRESS_COSINE_BASE + rng.randrange(700), *points)
        else:
            self.pair.transfer([rng.getrandbits(32) for _ in range(rng.randint(1, 5))], 40)

    def disturb(self) -> None:
        """Something happens at the inputs of the machine."""
        if self.inputs is None:
            return
        if self.rng.random() < 0.5:
            self.try_to(self.link.write, *self.inputs.write())
        for _ in range(self.rng.randrange(4)):
            self.pair.set(*self.inputs.pin())
            self.pair.run(self.rng.randint(1, self.rng.choice([3, 60, 3000])))

    def go_on(self, clocks: int) -> None:
        """Let time pass and clear what has stopped."""
        self.pair.run(self.rng.randint(1, clocks))
        for channel in self.channels:
            if channel.state().state == State.STOPPED and self.rng.random() < 0.8:
                self.try_to(channel.clear)
                self.try_to(channel.set_rate, RATE_ONE)

    def act(self, channel: Channel) -> None:
        """A motion or a command."""
        if self.rng.random() < self.PUSHES:
            self.push(channel)
        else:
            self.command(channel)

    def play(self, rounds: int) -> None:
        """Whatever host and machine do, pins and state are the same with and without skipping."""
        print(f"PASSO_SEED={SEED}")
        self.link.write(r.ADDRESS_RUN, (1 << len(self.channels)) - 1)
        for _ in range(rounds):
            self.act(self.rng.choice(self.channels))
            self.disturb()
            self.go_on(self.rng.choice([200, 3000, 20000]))
        assert self.pair.compared > 500
        assert self.pair.events > 0


@pytest.mark.parametrize("number", range(2 * len(BUILDS)))
def test_advance_agrees_with_every_clock(number: int) -> None:
    rng = random.Random(f"{SEED}/{number}")
    Session(BUILDS[number % len(BUILDS)], rng).play(25)


def test_advance_jumps_far() -> None:
    """Most of a slow motion, of a hold and of the time between motions is skipped."""
    parameters = BUILDS[0]
    pair = PlayerPair(parameters, random.Random(SEED))
    channel = Channel(Link(pair), parameters)
    channel.configure_axis(0, PinTiming(100, 100, 100, 100))
    pair.run(100_000)
    ramps = [Ramp(ONE // 2000, 300, SIGMOID), Ramp(0, 300, SIGMOID, last=True)]
    channel.push_lines([to_line(line) for line in fill(ramps, [(50, -30, 1)])])
    channel.push_ramps([to_ramp(ramp) for ramp in ramps])
    channel.start()
    pair.run(30_000)
    channel.set_rate(0)
    pair.run(100_000)
    channel.set_rate(RATE_ONE)
    pair.run(200_000)
    assert channel.state().state == State.IDLE
    assert pair.skipped > pair.clock * 0.9


def test_endless_line_is_jumped_through() -> None:
    """A jog of millions of clocks with a repeating line ends in the same state."""
    parameters = BUILDS[0]
    pair = PlayerPair(parameters, random.Random(SEED))
    channel = Channel(Link(pair), parameters)
    channel.push_lines([to_line(Line(1000, (999, -7, 0), endless=True))])
    channel.push_ramps([to_ramp(ramp) for ramp in (Ramp(SLOW // 100, 50, COSINE), Ramp(SLOW // 100, 10_000))])
    channel.start()
    pair.run(1_500_000)
    channel.push_ramps([to_ramp(Ramp(0, 20, now=True, last=True))])
    pair.run(10_000)
    assert channel.state().state == State.IDLE
    assert channel.positions()[0] > 300


def test_reads_are_jumped_through() -> None:
    """Reads of any length and place, granted or refused, on a link that is fast or waits between frames."""
    pair = PlayerPair(BUILDS[1], random.Random(SEED))
    link = Link(pair)
    refused = 0
    for _ in range(60):
        address, length = pair.rng.choice([0x000, 0x100, 0x110, 0x200, 0x7FC, 0xFF0]), pair.rng.randint(1, 9)
        try:
            link.read(address + pair.rng.randrange(16), length)
        except RefusedError:
            refused += 1
        pair.run(pair.rng.choice([1, 7, 100]))
    assert 5 < refused < 55
    assert pair.skipped > pair.clock * 0.7


@pytest.mark.parametrize("tick_log2", [7, 16])
def test_the_watchdog_is_jumped_to(tick_log2: int) -> None:
    """It stops a motion, disables the drives, and stops one that begins later, on the same clocks."""
    parameters = Parameters(channels=1, axes=1, tick_log2=tick_log2, inputs=1)
    pair = PlayerPair(parameters, random.Random(SEED))
    link = Link(pair)
    channel = Channel(link, parameters)
    link.write(channel.axis_base(0) + r.AXIS_ENABLE, 1)
    link.write(channel.base + r.CHANNEL_STOP_SLEW, RATE_ONE)

    def jog() -> None:
        channel.push_lines([to_line(Line(1000, (999,), endless=True))])
        channel.push_ramps([to_ramp(Ramp(SLOW // 100, ticks)) for ticks in (0, 10_000)])

    jog()
    channel.start()
    link.write(r.ADDRESS_WATCHDOG, r.WatchdogWord(stop_after=2, disable_after=1).pack())
    pair.run(6 << 16)
    assert channel.state().state == State.STOPPED and channel.state().cause == Cause.WATCHDOG
    channel.clear()
    link.write(r.ADDRESS_RUN, 1 << 8 | 1)
    jog()
    pair.run(3 << 16)  # armed, and silent
    pair.sync(True)
    pair.run(4 << 16)
    assert channel.state().state == State.STOPPED and channel.state().cause == Cause.WATCHDOG
    assert pair.skipped > pair.clock * 0.8
