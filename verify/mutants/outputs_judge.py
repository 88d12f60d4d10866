# SPDX-License-Identifier: MIT
"""Outputs as judge: levels on their clock, and the power on each clock, as docs/architecture.md says."""

import random

import numpy as np
from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine
from passo.host import RATE_ONE
from passo.registers import Cause

from tests.helpers.closed_form import ONE, Line, Ramp, substep_clocks
from verify.mutants.engine_judge import Check
from verify.mutants.motions_judge import Motions

MODULES = (
    *("passo_outputs", "passo_output_registers", "passo_raster", "passo_changes", "passo_power"),
    *("passo_pwm", "passo_core", "passo_channels", "passo_channel", "passo_channel_lines"),
    "passo_channel_control",
)
FULL = 1 << 24  # of the phase of a period
VALUES = (6, 6, 1020)  # of a raster line, by round; the last fills the queue
PUSHED = 60  # words of a frame
LAGS = 1500, 2047  # clocks, until which the velocity has fallen
SEEN = 2000  # clocks of the power
BITS = range(3, 32, 2)  # of a velocity of UQ0.32


def pulses(power: int, step: int, clocks: int, cost: int) -> np.ndarray:
    """The level of the power on each clock from its change on, when an on-clock has this cost."""
    duty = (power + (power >> 15)) << 8
    begins = np.diff(np.arange(clocks, dtype=np.int64) * step // FULL, prepend=0) > 0
    level = np.zeros(clocks, np.int8)
    credit = 0
    for k in range(clocks):
        credit += duty if k == 0 or begins[k] else 0
        if credit > 0:
            level[k] = 1
            credit -= cost
    return level


class Outputs(Motions):
    """A core whose outputs are judged."""

    def level(self, pin: str, number: int, begin: int, end: int) -> np.ndarray:
        """Of a pin on each clock."""
        clocks = self.events["clock"].astype(np.int64)
        at = np.searchsorted(clocks, np.arange(begin, end), side="right") - 1
        return (self.events[pin].astype(np.int64) >> number & 0xFF)[at]

    def lines(self, count: int) -> None:
        """A line of a power, one in proportion to the speed, one of a raster of `count` values, any lag."""
        rng, channel = self.rng, self.channels[0]
        axes = self.parameters.axes
        step = rng.randint(1 << 16, 1 << 20)
        gap = rng.randint(24, 40)
        velocity = ONE // gap
        lag = rng.choice((0, rng.randint(1, 90)) if count > PUSHED else (0, 60, rng.randint(256, 1500)))
        reference = (velocity >> 16) + rng.getrandbits(rng.choice((20, 27, 29)))
        pitch = rng.randint(2, 9) if count < PUSHED else 1
        self.write(channel, r.CHANNEL_OUTPUT_LEVELS, rng.getrandbits(8), lag, step, reference, pitch)
        values = [rng.randint(1, 127) + 128 * (n % 2) for n in range(4 * -(-count // 4))]
        packed = np.array(values, np.uint8).view("<u4").tolist()
        for at in range(0, len(packed), PUSHED):
            self.link.push(channel.base + r.CHANNEL_RASTER, packed[at : at + PUSHED])
        substeps = [rng.randint(20, 40), rng.randint(60, 90), pitch * count]
        powers = [rng.randint(1, 65535), rng.randint(1, 65535), 0]
        words = [
            r.LineOutputWord(
                levels=rng.getrandbits(8) ^ n, power=powers[n], proportional=n == 1, raster=n == 2
            )
            for n in range(3)
        ]
        lines = [Line(m, (m,) * axes, last=n == 2) for n, m in enumerate(substeps)]
        ticks = sum(substeps) * gap // self.tick + 2
        ramps = [Ramp(velocity, 0), Ramp(velocity, ticks, last=True)]
        self.push(channel, lines, ramps, words)
        channel.start()
        self.wait(channel)
        begin, end = self.runs(channel)
        clocks = [begin + n + lag for n in substep_clocks(ramps, self.tick.bit_length() - 1)]
        firsts = [clocks[sum(substeps[:n])] for n in range(3)]
        for n, first in enumerate(firsts):
            until = min(firsts[n + 1] if n < 2 else clocks[sum(substeps) - 1], end)
            seen = self.level("outputs", 8 * channel.number, first, until)
            assert (seen == words[n].levels).all(), f"levels of line {n}"
        self.check_power(firsts[0], firsts[1], powers[0], step)
        for n in range(count):
            at = [clocks[min(substeps[0] + substeps[1] + pitch * k, len(clocks) - 1)] for k in (n, n + 1)]
            self.check_power(at[0], min(at[1], end), 257 * values[n], step)
        self.check_proportional(firsts[1], firsts[2], powers[1], step, (step * reference << 16) // velocity)
        assert not self.level("power", channel.number, end, end + 20).any() & 1, "power at rest"
        self.check_end(channel, Cause.NONE)

    def bits(self) -> None:
        """Lines whose power is one bit each, as short as the PWM can make it."""
        rng, channel, axes = self.rng, self.channels[0], self.parameters.axes
        places = min(16, 1 << self.parameters.line_queue_log2)
        powers = rng.sample([1 << n for n in range(16)], places)
        step, gap, m = rng.randint(1 << 16, 1 << 20), 24, 20
        self.write(channel, r.CHANNEL_OUTPUT_LAG, 0, step)
        words = [
            r.LineOutputWord(levels=n, power=power, proportional=False, raster=False)
            for n, power in enumerate(powers)
        ]
        lines = [Line(m, (m,) * axes, last=n == places - 1) for n in range(places)]
        ramps = [Ramp(ONE // gap, 0), Ramp(ONE // gap, m * places * gap // self.tick + 2, last=True)]
        self.push(channel, lines, ramps, words)
        channel.start()
        self.wait(channel)
        begin, _ = self.runs(channel)
        clocks = [begin + n for n in substep_clocks(ramps, self.tick.bit_length() - 1)]
        for n, power in enumerate(powers[:-1]):
            self.check_power(clocks[n * m], clocks[(n + 1) * m], power, step)
        self.check_end(channel, Cause.NONE)

    def slow(self, bits: int) -> None:
        """Power in proportion to a velocity of `bits` bits, to which it falls after the first substep."""
        rng, channel, axes = self.rng, self.channels[0], self.parameters.axes
        velocity = rng.getrandbits(bits) | 1 << bits - 1
        rate = rng.randint(1, RATE_ONE) if bits > 20 else RATE_ONE
        lag = rng.randint(*LAGS)
        speed = velocity * rate >> 16
        step = int(2 ** rng.uniform(8, 20))
        reference = min(int(speed * 2 ** rng.uniform(0, 6)) + 1, 1 << 31)
        power = rng.randint(1 << 8, 65535)
        self.write(channel, r.CHANNEL_RATE_TARGET, RATE_ONE, RATE_ONE)
        self.write(channel, r.CHANNEL_OUTPUT_LAG, lag, step, reference)
        fast = ONE // 30
        ramps = [Ramp(fast, 0), Ramp(fast, 2), Ramp(velocity << 16, 0), Ramp(velocity << 16, 60_000)]
        word = r.LineOutputWord(levels=0, power=power, proportional=True, raster=False)
        self.push(channel, [Line(1 << 29, (0,) * axes, last=True)], ramps, [word])
        channel.start()
        self.engine.run(3 * self.tick)
        self.write(channel, r.CHANNEL_RATE_TARGET, rate)
        self.engine.run(lag + SEEN)
        channel.abort()
        self.engine.run(100)
        self.see()
        begin, _ = self.runs(channel)
        first = begin + substep_clocks(ramps[:2], self.tick.bit_length() - 1)[0] + lag
        cost = (step * reference >> 1) // max(velocity * rate >> 17, 1)
        self.check_proportional(first, first + SEEN, power, step, cost)
        self.write(channel, r.CHANNEL_OUTPUT_LAG, 0)
        self.check_end(channel, Cause.ABORT)

    def check_power(self, begin: int, end: int, power: int, step: int) -> None:
        """A power that does not depend on the speed."""
        due = pulses(power, step, max(end - begin, 0), step)  # none, if it lags beyond the motion
        assert (self.level("power", 0, begin, end) & 1 == due).all(), f"power {power} of step {step}"

    def check_proportional(self, begin: int, end: int, power: int, step: int, cost: int) -> None:
        """A clock costs as much as the speed says; the quotient is rounded."""
        level = self.level("power", 0, begin, end) & 1
        assert any(
            (level == pulses(power, step, end - begin, max(step, near))).all()
            for near in (cost, cost - 1, cost + 1)
        ), f"power {power} at a cost of {cost}"


def check(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
    """Some motions with outputs.

    Raises:
        AssertionError: Something is not as it is known to be.
    """
    if not parameters.outputs:
        return
    outputs = Outputs(engine, parameters, rng)
    outputs.set_up()
    for count in VALUES:
        outputs.lines(count)
    outputs.bits()
    for bits in BITS:
        outputs.slow(bits)


CHECK = Check("outputs", "motions", check, MODULES)
