# SPDX-License-Identifier: MIT
"""Pin timings as judge: a step up and a step down that waits for it, with timings of all lengths."""

import random

import numpy as np
from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine
from passo.moves import PinTiming

from tests.helpers.closed_form import Line, Ramp, substep_clocks
from tests.helpers.motions import SLOW
from verify.mutants.engine_judge import Check
from verify.mutants.motions_judge import TIME, Motions

GREATEST = (7, 60, 400, 2000, 65535)  # timing of each round
MODULES = (
    *("passo_axes", "passo_axis", "passo_axis_settings", "passo_axis_registers"),
    *("passo_channel", "passo_channel_control", "passo_channel_drives"),
)


class Timings(Motions):
    """A core whose axes have any timings and polarities."""

    greatest = 3 * TIME  # clocks for which a change of the pins keeps an axis busy

    def play(self, greatest: int, way: int) -> None:
        """All axes of all channels together: first as DIR is, then back."""
        rng, axes = self.rng, self.parameters.axes
        self.run(self.greatest)
        places = [(channel, axis) for channel in self.channels for axis in range(axes)]
        timings = [PinTiming(*(rng.randint(1, greatest) for _ in range(4))) for _ in places]
        flags = [r.AxisPinsWord.unpack(rng.getrandbits(4) << r.AXIS_PINS_STEP_INVERTED_LSB) for _ in places]
        settings = list(zip(places, flags, timings, strict=True))
        rng.shuffle(settings)  # what is written to one axis leaves all others
        for (channel, axis), flag, _ in settings:
            self.link.write(channel.axis_base(axis), flag.pack())
            self.run(self.greatest)
        for (channel, axis), _, timing in settings:
            words = timing.step_high << 16 | timing.step_low, timing.dir_setup << 16 | timing.dir_hold
            self.link.write(channel.axis_base(axis) + r.AXIS_STEP_TIMING, *words)
        self.greatest = 3 * greatest
        self.run(self.greatest)
        lines = [Line(1, (way,) * axes), Line(1, (-way,) * axes, last=True)]
        ramps = [Ramp(SLOW, 0), Ramp(SLOW, 1, last=True)]
        self.link.write(r.ADDRESS_RUN, 0)
        for channel in self.channels:
            self.queue(channel, lines, ramps)
        self.events = self.engine.drain()[-1:]
        self.link.write(r.ADDRESS_RUN, (1 << len(self.channels)) - 1)
        self.run(max(sum(vars(timing).values()) + timing.step_high for timing in timings) + 1000)
        self.see()
        first = substep_clocks(ramps, self.tick.bit_length() - 1)[0]
        for bit, ((channel, axis), timing, flag) in enumerate(zip(places, timings, flags, strict=True)):
            begin, _ = self.runs(channel)
            level = self.events["step"].astype(np.int64) >> bit & 1
            edges = self.events["clock"].astype(np.int64)[np.flatnonzero(np.diff(level)) + 1]
            up = begin + first
            turned = up + timing.step_high + timing.dir_hold + timing.dir_setup
            if flag.both_edges:
                due = [up, max(turned, up + substep_gap(ramps))]
            else:
                down = max(turned + timing.step_low, up + substep_gap(ramps))
                due = [up, up + timing.step_high, down, down + timing.step_high]
            where = f"axis {axis} of channel {channel.number}"
            assert edges.tolist() == due, f"{where}: edges at {edges.tolist()} instead of {due}"
            assert level[0] == flag.step_inverted, f"{where}: STEP at rest"
            assert channel.positions()[axis] == 0, f"{where}: position"


def substep_gap(ramps: list[Ramp]) -> int:
    """From the first substep to the second."""
    first, second = substep_clocks(ramps, 7)[:2]
    return second - first


def check(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
    """Two steps of each axis, with timings of all lengths.

    Raises:
        AssertionError: They do not come when they must.
    """
    timings = Timings(engine, parameters, rng)
    timings.set_up()
    for number, greatest in enumerate(GREATEST):
        timings.play(greatest, -1 if number % 2 else 1)


CHECK = Check("timings", "motions", check, MODULES)
