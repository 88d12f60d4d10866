# SPDX-License-Identifier: MIT
"""Lines as judge: of all sizes until an abort, and one of 2^15 substeps, which the upper bits count."""

import random

from passo.build import Parameters
from passo.engine import Engine
from passo.registers import Cause

from tests.helpers.closed_form import HALF, ONE, Line, Ramp, substep_clocks
from verify.mutants.engine_judge import Check
from verify.mutants.motions_judge import TIME, Motions

MODULES = (
    *("passo_line", "passo_lines", "passo_dda", "passo_line_queue", "passo_memory", "passo_channel"),
    *("passo_channel_path", "passo_channel_lines"),
)
SIZES = (9, 12, 15, 18, 21, 24, 27, 30)  # bits of M
COUNT = 1 << 15  # substeps at full speed, and some more


class Lines(Motions):
    """A core whose lines are judged."""

    def begun(self, bits: int) -> None:
        """The first steps of a line of this size."""
        rng, channel = self.rng, self.rng.choice(self.channels)
        m = rng.getrandbits(bits) | 1 << bits - 1
        m -= m == 1 << 30
        steps = tuple(rng.choice((-1, 1)) * rng.randint(m // 3, m) for _ in range(self.parameters.axes))
        velocity = ONE // rng.randint(4 * TIME, 5 * TIME)
        lines, ramps = [Line(m, steps, endless=True)], [Ramp(velocity, 0), Ramp(velocity, 60)]
        self.push(channel, lines, ramps)
        channel.start()
        self.engine.run(3000)
        channel.abort()
        self.engine.run(6 * TIME)
        self.see()
        begin, _ = self.runs(channel)
        clocks = [begin + n for n in substep_clocks(ramps, self.tick.bit_length() - 1)]
        self.check_steps(channel, lines, clocks, exact=False)
        made = [len(self.steps(channel, axis)) for axis in range(self.parameters.axes)]
        assert min(made) > 3000 // (5 * TIME) // 4, f"{made} steps until the abort"
        self.check_positions(channel, [0] * self.parameters.axes)
        self.check_end(channel, Cause.ABORT)

    def counted(self) -> None:
        """Few steps in many substeps at full speed, and a line after them."""
        rng, channel, axes = self.rng, self.rng.choice(self.channels), self.parameters.axes
        m = COUNT + rng.getrandbits(9)
        ramps = [Ramp(HALF, 0), Ramp(HALF, 2 * m // self.tick + 9, last=True)]
        clocks = substep_clocks(ramps, self.tick.bit_length() - 1)
        lines = [
            Line(m, tuple(rng.randint(20, 40) for _ in range(axes))),
            Line(len(clocks) - m, tuple(rng.randint(1, 3) for _ in range(axes)), last=True),
        ]
        self.push(channel, lines, ramps)
        channel.start()
        self.wait(channel)
        begin, _ = self.runs(channel)
        self.check_steps(channel, lines, [begin + n for n in clocks])
        self.check_positions(channel, [0] * axes)
        self.check_end(channel, Cause.NONE)


def check(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
    """Lines of all sizes, and a long one.

    Raises:
        AssertionError: A step is not where it is known to be.
    """
    lines = Lines(engine, parameters, rng)
    lines.set_up()
    for bits in SIZES:
        lines.begun(bits)
    lines.counted()


CHECK = Check("lines", "motions", check, MODULES)
