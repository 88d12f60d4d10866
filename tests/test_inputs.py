# SPDX-License-Identifier: MIT
"""Random events at the inputs during motions, judged by promises from pins and replies alone.

Position = active edges that left the pins; the latch is exact to the clock; no step goes into an active
switch; no edge of STEP later than 4 clocks after a hard stop; the cause is the first event.
"""

import random
from collections.abc import Callable

import numpy as np
import pytest
from passo import registers as r
from passo.build import Parameters
from passo.engine import EVENT, Engine, model_engine, rtl_engine
from passo.host import Channel
from passo.link import Link
from passo.pair_engine import PairEngine
from passo.random_cases import seed
from passo.registers import Cause, State, TriggerAction, TriggerSource

from tests.helpers.closed_form import ONE, Line, Ramp
from tests.helpers.motions import to_line, to_ramp

PARAMETERS = Parameters(axes=3, inputs=1)
LEVEL = 4  # clocks from a pin to its level with the shortest filter, at most
LAST_STEP = 4  # clocks from a level to the last edge of STEP
LATCH = 4  # clocks from the first clock with the new level of a pin to the latch, plus the filter
NAMES = ("limit", "other limit", "alarm", "probe", "estop", "abort")


class Machine:
    """A core, and what its pins have done."""

    def __init__(
        self, engine: Engine | PairEngine, rng: random.Random, parameters: Parameters = PARAMETERS
    ) -> None:
        self.engine, self.rng = engine, rng
        self.link = Link(engine)
        self.channel = Channel(self.link, parameters)
        self.axes = parameters.axes
        self.events = np.zeros(1, EVENT)
        self.pins: dict[str, int] = {}

    def see(self) -> None:
        """Take the events of the pins."""
        self.events = np.concatenate([self.events, self.engine.drain()])

    def edges(self, axis: int) -> list[tuple[int, int]]:
        """Clock and way of each step that left the pins."""
        step = self.events["step"].astype(np.int64) >> axis & 1
        at = np.flatnonzero(np.diff(step) == 1) + 1
        down = self.events["dir"].astype(np.int64) >> axis & 1
        return [(int(self.events["clock"][i]), -1 if down[i] else 1) for i in at]

    def positions(self, until: int | None = None) -> list[int]:
        """Steps that have left the pins, up to a clock."""
        return [
            sum(way for clock, way in self.edges(axis) if until is None or clock <= until)
            for axis in range(self.axes)
        ]

    def set(self, pin: str, levels: int) -> None:
        """Set a pin."""
        self.pins[pin] = levels
        self.engine.set(pin, levels)

    def queue(self, steps: list[int], gap: int) -> None:
        """Queue a line of these steps that repeats, with a substep every `gap` clocks."""
        line = Line(max(map(abs, steps)), tuple(steps), endless=True)
        self.channel.push_lines([to_line(line)])
        self.channel.push_ramps([to_ramp(Ramp(ONE // gap, 0)), to_ramp(Ramp(ONE // gap, 60_000))])

    def move(self, steps: list[int], gap: int) -> None:
        """Begin with such a line."""
        self.queue(steps, gap)
        self.channel.start()
        self.engine.run(400)

    def clear(self) -> None:
        """Release everything and clear."""
        for pin in list(self.pins):
            self.set(pin, int(pin == "estop_n"))
        self.engine.run(20)
        self.link.write(r.ADDRESS_ESTOP_CLEAR, 1)
        self.channel.clear()
        self.engine.run(20)

    def check_position(self) -> None:
        """At rest: what is read is what left the pins."""
        self.engine.run(200)
        positions = self.channel.positions()
        self.see()
        assert positions == self.positions()


def happen(machine: Machine, name: str, steps: list[int]) -> Cause | None:
    """Let an event happen; return the cause of the stop that it must lead to, if any."""
    axis = machine.rng.randrange(machine.axes)
    way = steps[axis]
    if name in ("limit", "other limit"):
        toward = "limit_high" if way > 0 else "limit_low"
        away = "limit_low" if way > 0 else "limit_high"
        machine.set(toward if name == "limit" else away, 1 << axis)
        return Cause.LIMIT if name == "limit" and way else None
    if name == "alarm":
        machine.set("alarm", 1 << axis)
        return Cause.ALARM
    if name == "probe":
        machine.set("probe", 1)
        return Cause.TRIGGER
    if name == "estop":
        machine.set("estop_n", 0)
        return Cause.ESTOP
    machine.channel.abort()
    return Cause.ABORT


def arm(machine: Machine, action: TriggerAction) -> None:
    """Arm the trigger on the probe."""
    word = r.ChannelTriggerWord(source=TriggerSource.PROBE, axis=0, falling=False, action=action, arm=True)
    machine.link.write(machine.channel.base + r.CHANNEL_TRIGGER, word.pack())


def one_round(machine: Machine) -> None:
    """A motion with one or two events."""
    rng = machine.rng
    steps = [rng.choice((-8, -3, 0, 3, 8)) for _ in range(machine.axes)]
    steps[rng.randrange(machine.axes)] = rng.choice((-8, 8))
    gap = rng.randint(4, 30)
    machine.link.write(r.ADDRESS_INPUT_FILTER, 0)
    arm(machine, TriggerAction.HARD_STOP)
    machine.move(steps, gap)
    assert machine.channel.state().state == State.RUN
    machine.engine.run(rng.randrange(300))
    causes = []
    began = 0
    for name in rng.sample(NAMES, rng.randint(1, 2)):
        at = machine.engine.clock
        cause = happen(machine, name, steps)
        if cause is not None and not causes:
            began = at if name != "abort" else machine.engine.clock
        causes += [cause] if cause is not None else []
        machine.engine.run(LEVEL + LAST_STEP + gap * 9)
    machine.engine.run(600)
    state = machine.channel.state()
    machine.see()
    if not causes:
        assert state.state == State.RUN
        machine.channel.abort()
    else:
        assert (state.state, state.cause) == (State.STOPPED, causes[0])
        last = max(clock for axis in range(machine.axes) for clock, _ in machine.edges(axis)[-1:])
        patience = gap * 9 if causes[0] == Cause.LIMIT else 0  # until the next step toward it
        assert last <= began + LEVEL + LAST_STEP + patience
    machine.check_position()
    machine.clear()


def into_a_switch(machine: Machine) -> None:
    """Hard or soft: it stops the axis, which then cannot be driven further in, but off it."""
    rng = machine.rng
    axis, way = rng.randrange(machine.axes), rng.choice((-1, 1))
    soft = rng.random() < 0.5
    address = machine.channel.axis_base(axis) + r.AXIS_INPUTS
    machine.link.write(address, soft << r.AXIS_INPUTS_LIMIT_SOFT_LSB)
    machine.link.write(machine.channel.base + r.CHANNEL_STOP_SLEW, rng.choice((3000, 65536)))
    steps = [0] * machine.axes
    steps[axis] = 8 * way
    machine.move(steps, rng.randint(2, 20))
    machine.set("limit_high" if way > 0 else "limit_low", 1 << axis)
    machine.engine.run(128 * 40)
    machine.check_position()
    assert machine.channel.state().cause == Cause.LIMIT
    where = machine.positions()[axis]
    for _ in range(rng.randint(1, 3)):
        machine.channel.clear()
        machine.move(steps, rng.randint(2, 20))
        machine.engine.run(500)
        machine.check_position()
        assert machine.channel.state().cause == Cause.LIMIT
        assert machine.positions()[axis] == where, "a step further in"
    machine.channel.clear()
    machine.move([-n for n in steps], rng.randint(2, 20))
    machine.engine.run(300)
    assert machine.channel.state().state == State.RUN
    machine.channel.abort()
    machine.check_position()
    assert (machine.positions()[axis] - where) * way < 0
    machine.clear()
    machine.link.write(address, 0)


def latch_in_motion(machine: Machine) -> None:
    """The latched positions are those of one clock, a constant time after the pin."""
    rng = machine.rng
    length = rng.choice((0, 1, 7, 100))
    machine.link.write(r.ADDRESS_INPUT_FILTER, length)
    arm(machine, TriggerAction.LATCH)
    machine.move([rng.choice((-8, 8)) for _ in range(machine.axes)], rng.randint(2, 9))
    machine.engine.run(rng.randrange(300))
    at = machine.engine.clock
    machine.set("probe", 1)
    machine.engine.run(length + 300)
    words = machine.link.read(machine.channel.base + r.CHANNEL_TRIGGER_POSITION_BASE, machine.axes)
    machine.channel.abort()
    machine.check_position()
    assert [word - (word >> 31 << 32) for word in words] == machine.positions(at + LATCH + length)
    machine.clear()


KINDS: list[Callable[[Machine], None]] = [one_round, one_round, into_a_switch, latch_in_motion]


def play(machine: Machine, rounds: int) -> None:
    """Rounds of all kinds."""
    for number in range(rounds):
        print(f"round {number}, clock {machine.engine.clock}")
        KINDS[number % len(KINDS)](machine)


@pytest.mark.sample(1)
@pytest.mark.parametrize("number", range(4))
def test_promises_hold_in_the_model(number: int) -> None:
    """Some 150 events each."""
    print(f"PASSO_SEED={seed()}")
    with model_engine(PARAMETERS) as engine:
        play(Machine(engine, random.Random(f"inputs {seed()} {number}")), 60)


def test_promises_hold_in_the_rtl() -> None:
    """Every pin of the Verilated core is that of the model."""
    print(f"PASSO_SEED={seed()}")
    with PairEngine(rtl_engine(PARAMETERS), model_engine(PARAMETERS)) as engine:
        play(Machine(engine, random.Random(f"inputs rtl {seed()}")), 60)
