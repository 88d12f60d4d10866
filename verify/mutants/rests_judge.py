# SPDX-License-Identifier: MIT
"""Rest as judge: full queues, stopped channels, pins that are not idle yet, and the e-stop."""

import random

from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine
from passo.host import Channel
from passo.registers import Cause, State, Verdict

from tests.helpers.closed_form import ONE, Line, Ramp, substep_clocks
from tests.helpers.motions import SLOW, to_line, to_ramp
from tests.test_register_table import Core as Table
from verify.mutants.engine_judge import Check
from verify.mutants.motions_judge import TIME, Motions

LONG = 4000  # clocks for which the pins are busy, at least: longer than three frames
FULL = r.LineOutputWord(raster=False, proportional=False, levels=0xFF, power=65535)
QUEUES = {"CHANNEL_LINE": r.CHANNEL_LINE, "CHANNEL_RAMP": r.CHANNEL_RAMP}


class Rests(Motions):
    """A core that is asked whether it rests."""

    def full(self) -> None:
        """Each queue takes what it has places for, and no more; a stopped channel takes nothing."""
        table, channel = Table(self.link, self.parameters), self.rng.choice(self.channels)
        self.link.write(r.ADDRESS_RUN, 0)
        room = 1 << self.parameters.line_queue_log2, 1 << self.parameters.ramp_queue_log2
        for (name, place), places in zip(QUEUES.items(), room, strict=True):
            items = table.items[name]
            for _ in range(places):
                assert table.push(channel.base + place, *items) == Verdict.OK, f"{name}: a place"
            assert table.push(channel.base + place, *items) == Verdict.QUEUE_FULL, f"{name}: no place"
        channel.abort()
        for name, place in QUEUES.items():
            assert table.push(channel.base + place, *table.items[name]) == Verdict.BUSY, f"{name}: stopped"
        self.check_end(channel, Cause.ABORT)

    def one_step(self, channel: Channel, axis: int) -> None:
        """One step of an axis, in the shortest motion."""
        ramps = [Ramp(SLOW, 0), Ramp(SLOW, 1, last=True)]
        steps = tuple(int(other == axis) for other in range(self.parameters.axes))
        self.push(
            channel, [Line(len(substep_clocks(ramps, self.tick.bit_length() - 1)), steps, last=True)], ramps
        )
        channel.start()
        self.engine.run(6 * self.tick)
        assert not self.engine.running >> channel.number & 1, "the shortest motion is over"

    def check_quiet(self, channel: Channel, busy: int, what: str) -> None:
        """Idle, but not quiet for `busy` clocks: what needs a quiet channel is refused."""
        zero = channel.base + r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_ZERO_LSB
        table = Table(self.link, self.parameters)
        state = channel.state()
        assert (state.state, state.quiet) == (State.IDLE, False), f"{what}: {state}"
        assert table.write(*zero) == Verdict.BUSY, f"{what}: ZERO"
        self.run(busy)
        assert channel.state().quiet and table.write(*zero) == Verdict.OK, f"{what}: over"

    def pins(self) -> None:
        """A step that has begun keeps its channel from being quiet until its time is over."""
        rng, channel = self.rng, self.rng.choice(self.channels)
        axis = rng.randrange(self.parameters.axes)
        timing = channel.axis_base(axis) + r.AXIS_STEP_TIMING
        high, low = rng.sample((LONG, TIME), 2)
        self.link.write(timing, high << 16 | low)
        self.one_step(channel, axis)
        self.check_quiet(channel, high + low, "STEP")
        self.link.write(timing, self.high[channel.number * self.parameters.axes + axis] << 16 | TIME)
        self.check_end(channel, Cause.NONE)

    def lagging(self) -> None:
        """So does a change of the outputs that waits."""
        channel = self.rng.choice(self.channels)
        self.write(channel, r.CHANNEL_OUTPUT_LAG, LONG)
        self.one_step(channel, 0)
        self.check_quiet(channel, LONG, "a change of the outputs")
        self.write(channel, r.CHANNEL_OUTPUT_LAG, 0)
        self.check_end(channel, Cause.NONE)

    def estop(self) -> None:
        """It takes enables and power in no clock at all, and then stops."""
        channel = self.channels[0]
        self.write(channel, r.CHANNEL_PWM_STEP, 1 << 16)
        self.link.write(r.ADDRESS_RUN, 0)
        axes = self.parameters.axes
        everyone = (1 << axes) - 1
        channel.push_lines([to_line(Line(9, (9,) * axes, endless=True))], [FULL])
        channel.push_ramps([to_ramp(Ramp(ONE // 99, 0)), to_ramp(Ramp(ONE // 99, 60_000))])
        channel.start()
        self.engine.run(2000 + self.rng.randrange(self.tick))
        before = self.engine.drain()[-1]
        assert before["power"] & 1, "full power"
        self.engine.set("estop_n", 0)
        self.engine.run(1)
        after = self.engine.drain()[-1]
        assert not after["power"] & 1, "power after an e-stop"
        disabled = int(before["enable"]) ^ int(after["enable"])
        assert disabled & everyone == everyone, "enables after an e-stop"
        self.engine.run(8)
        assert not self.engine.running, "an e-stop stops"
        self.engine.set("estop_n", 1)
        self.engine.run(2000)
        self.link.write(r.ADDRESS_ESTOP_CLEAR, 1)
        self.check_end(channel, Cause.ESTOP)


def check(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
    """Each of them.

    Raises:
        AssertionError: A channel rests, or does not, when it should not.
    """
    rests = Rests(engine, parameters, rng)
    rests.set_up()
    rests.full()
    for _ in range(2):
        rests.pins()
    if parameters.outputs:
        rests.lagging()
        if parameters.inputs:
            rests.estop()


CHECK = Check("rests", "motions", check)
