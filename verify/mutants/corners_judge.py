# SPDX-License-Identifier: MIT
"""Corner cases as judge: resets in motion, NOW ramps, ramps that take no time, many drained substeps."""

import random
from dataclasses import replace

from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine
from passo.host import RATE_ONE
from passo.registers import Cause, State

from tests.helpers.closed_form import SHAPES, Line, Ramp, substep_clocks
from tests.helpers.motions import SLOW, to_ramp
from verify.mutants.engine_judge import Check
from verify.mutants.motions_judge import Motions

RESETS = 4
AROUND = range(-4, 5)  # ticks, in one of which a NOW ramp begins


class Corners(Motions):
    """A core to which seldom things happen."""

    def reset(self) -> None:
        """A reset in a motion: nothing of it remains, and the next one is as ever."""
        rng, axes = self.rng, self.parameters.axes
        self.link.write(r.ADDRESS_RUN, 0)
        for channel in self.channels:
            lines, ramps = self.cruise(SLOW, 500, axes)
            self.queue(channel, lines, [*ramps, Ramp(0, 3), Ramp(SLOW, 5, last=True)])
            rates = rng.randint(1 << 12, RATE_ONE), rng.randint(1, 3000), rng.randint(1, 3000)
            self.write(channel, r.CHANNEL_RATE_TARGET, *rates)
        self.link.write(r.ADDRESS_RUN, (1 << len(self.channels)) - 1)
        self.engine.run(rng.randint(1000, 4000))
        stopped = rng.choice(self.channels)
        rng.choice((stopped.stop, stopped.abort, lambda: stopped.set_rate(0)))()
        self.engine.run(rng.randint(1, 400))
        self.engine.set("rst", 1)
        self.engine.run(rng.randint(1, 9))
        self.engine.set("rst", 0)
        self.engine.run(40 * 8)
        self.lacked = [0] * len(self.channels)
        for channel in self.channels:
            state = channel.state()
            assert (state.state, state.cause, state.stopping) == (State.IDLE, Cause.NONE, False), f"{state}"
            assert self.link.read(channel.base + r.CHANNEL_RATE, 1) == [RATE_ONE], "rate after a reset"
            assert channel.positions() == [0] * axes, "positions after a reset"
        assert not self.engine.irq and not self.engine.running, "irq, running"
        for channel in self.channels:
            self.exact(channel)

    def changed(self) -> None:
        """A NOW ramp: at the end of a tick the velocity leaves the one that it has."""
        rng, channel = self.rng, self.rng.choice(self.channels)
        velocity = SLOW - rng.getrandbits(42)
        lines, ramps = self.cruise(velocity, 500, self.parameters.axes)
        self.push(channel, lines, [*ramps[:1], replace(ramps[1], last=False), Ramp(SLOW, 9, last=True)])
        channel.start()
        self.engine.run(rng.randint(1500, 4000))
        turn = Ramp(SLOW // rng.randint(2, 9), rng.randint(5, 30), rng.choice(SHAPES), last=True, now=True)
        channel.push_ramps([to_ramp(turn)])
        at = self.engine.clock
        self.wait(channel)
        begin, end = self.runs(channel)
        ticks = (end - begin) // self.tick - turn.ticks
        assert abs(ticks - (at - begin) // self.tick) < len(AROUND), "when the NOW ramp begins"
        clocks = substep_clocks([ramps[0], Ramp(velocity, ticks), turn], self.tick.bit_length() - 1)
        self.check_steps(channel, lines, [begin + n for n in clocks])
        self.check_positions(channel, [0] * self.parameters.axes)
        self.check_end(channel, Cause.NONE)

    def stalled(self) -> None:
        """More ramps without a tick than it can take in time: steps are late, none is lost."""
        channel = self.rng.choice(self.channels)
        _, ramps = self.cruise(SLOW, 40, self.parameters.axes)
        jumps = [Ramp(SLOW // self.rng.randint(1, 5), 0) for _ in range(5)]
        m = len(substep_clocks(ramps, self.tick.bit_length() - 1))
        lines = [Line(m, (m,) * self.parameters.axes, last=True)]
        self.push(channel, lines, [*jumps, *ramps])
        channel.start()
        self.wait(channel)
        begin, end = self.runs(channel)
        assert 0 <= end - begin - 40 * self.tick < 3 * self.tick, "the profile lasts, with its stalls"
        assert [len(self.steps(channel, axis)) for axis in range(self.parameters.axes)] == list(
            lines[0].steps
        )
        self.check_positions(channel, [0] * self.parameters.axes)
        self.check_end(channel, Cause.NONE)

    def lacking(self) -> None:
        """A line that lacks most of its substeps, at the greatest drain velocity."""
        rng, channel = self.rng, self.rng.choice(self.channels)
        self.write(channel, r.CHANNEL_DRAIN_VELOCITY, 1 << 31)
        ramps = [Ramp(SLOW, 0), Ramp(SLOW, 5, last=True)]
        made = len(substep_clocks(ramps, self.tick.bit_length() - 1))
        lacks = rng.randint(1024, 2000)
        steps = tuple(rng.randint(1, 50) for _ in range(self.parameters.axes))
        self.push(channel, [Line(made + lacks, steps, last=True)], ramps)
        channel.start()
        self.wait(channel)
        begin, end = self.runs(channel)
        assert abs(end - begin - 5 * self.tick - 2 * lacks) < self.tick, "the drain lasts"
        self.check_positions(channel, [0] * self.parameters.axes)
        assert channel.positions() == list(steps), "the line is made"
        self.check_end(channel, Cause.NONE, lacks)


def check(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
    """Each of them, and some resets.

    Raises:
        AssertionError: Something is not as it is known to be.
    """
    corners = Corners(engine, parameters, rng)
    corners.set_up()
    corners.lacking()
    corners.changed()
    corners.stalled()
    for _ in range(RESETS):
        corners.reset()


CHECK = Check("corners", "motions", check)
