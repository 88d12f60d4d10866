# SPDX-License-Identifier: MIT
"""Shaped ramps as judge: motions of all channels together, which share the tables, whatever these hold."""

import random

from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine
from passo.registers import Cause, Shape

from tests.helpers.closed_form import Line, Ramp, substep_clocks
from tests.helpers.motions import SLOW
from tests.test_register_table import Core as Table
from verify.mutants.engine_judge import Check
from verify.mutants.motions_judge import Motions

ROUNDS = 5
READS = 80  # addresses
POINTS, WORDS = 256, 32  # of a shape; of a frame
SHAPE_END = 1 << 16
MODULES = (
    *("passo_tables", "passo_interpolate", "passo_profile", "passo_path", "passo_core", "passo_positions"),
    *("passo_ramp", "passo_ramp_numbers", "passo_ramp_queue", "passo_ramp_schedule", "passo_ramp_strobes"),
    *("passo_ramp_tick", "passo_memory", "passo_channel", "passo_line_queue", "passo_motion"),
    *("passo_channels", "passo_channel_path", "passo_channel_control"),
)


class Shapes(Motions):
    """A core whose channels move together."""

    def load(self) -> None:
        """Write any other shapes."""
        addresses = {
            Shape.COSINE: r.ADDRESS_COSINE_BASE,
            Shape.SIGMOID: r.ADDRESS_SIGMOID_BASE,
            Shape.EASE: r.ADDRESS_EASE_BASE,
        }
        loaded = {shape: self.rng.choices(range(SHAPE_END), k=POINTS) for shape in addresses}
        for shape, address in addresses.items():
            for k in range(0, POINTS, WORDS):
                self.link.write(address + k, *loaded[shape][k : k + WORDS])
        self.tables = {shape: [*points, SHAPE_END] for shape, points in loaded.items()}

    def together(self) -> None:
        """Any motion on each channel; they begin when they are prepared."""
        self.link.write(r.ADDRESS_RUN, 0)
        most = min(9, 1 << self.parameters.ramp_queue_log2)
        drawn = [self.draw(most) for _ in self.channels]
        for channel, (lines, ramps) in zip(self.channels, drawn, strict=True):
            self.queue(channel, lines, ramps)
        self.events = self.engine.drain()[-1:]
        self.link.write(r.ADDRESS_RUN, (1 << len(self.channels)) - 1)
        for channel in self.channels:
            self.wait(channel)
        for channel, (lines, ramps) in zip(self.channels, drawn, strict=True):
            begin, end = self.runs(channel)
            assert end - begin == sum(ramp.ticks for ramp in ramps) * self.tick, "the profile lasts"
            clocks = substep_clocks(ramps, self.tick.bit_length() - 1, self.tables)
            self.check_steps(channel, lines, [begin + n for n in clocks])
            self.check_positions(channel, [0] * self.parameters.axes)
        for channel in self.channels:
            self.check_end(channel, Cause.NONE)

    def whole(self) -> None:
        """A ramp of each shape that takes each of its points, which no other access has changed."""
        table = Table(self.link, self.parameters)
        for address in self.rng.sample(sorted(table.table), min(READS, len(table.table))):
            table.read(address)
        channel, axes = self.rng.choice(self.channels), self.parameters.axes
        shapes = self.rng.sample(list(self.tables), len(self.tables))
        ramps = [Ramp(SLOW * (n % 2 == 0), POINTS, shape) for n, shape in enumerate(shapes)]
        ramps.append(Ramp(0, 1, last=True))
        clocks = substep_clocks(ramps, self.tick.bit_length() - 1, self.tables)
        lines = [Line(len(clocks), (len(clocks),) * axes, last=True)]
        self.push(channel, lines, ramps)
        channel.start()
        self.wait(channel)
        begin, _ = self.runs(channel)
        self.check_steps(channel, lines, [begin + n for n in clocks])
        self.check_end(channel, Cause.NONE)


def check(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
    """Some motions.

    Raises:
        AssertionError: A step is not where it is known to be.
    """
    shapes = Shapes(engine, parameters, rng)
    shapes.set_up()
    for number in range(ROUNDS):
        shapes.together()
        if number % 2 == 0:
            shapes.load()
            shapes.whole()


CHECK = Check("shapes", "motions", check, MODULES)
