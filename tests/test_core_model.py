# SPDX-License-Identifier: MIT
"""The C model against the closed form of docs/architecture.md: each STEP edge on its clock.

PASSO_SEED is the seed of the random motions.
"""

import random
from collections.abc import Sequence

import numpy as np
import pytest
from passo import random_cases
from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine, model_engine
from passo.host import Channel
from passo.link import Link
from passo.moves import PinTiming
from passo.native import planner
from passo.registers import Cause, State

from tests.helpers.closed_form import (
    COSINE,
    EASE,
    HALF,
    ONE,
    SHAPES,
    SIGMOID,
    TABLES,
    Line,
    Ramp,
    step_clocks,
    velocities,
)
from tests.helpers.core_player import PlayerPair
from tests.helpers.motions import SLOW, distance, fill, random_motion, to_line, to_ramp

SEED = random_cases.seed()
AXES = 3


def run_motion(engine: Engine, channel: Channel, lines: Sequence[Line], ramps: Sequence[Ramp]) -> np.ndarray:
    """The pin events of one motion, counted from the rise of `running`. It lasts as long as its profile."""
    clocks = sum(ramp.ticks for ramp in ramps) << engine.parameters.tick_log2
    channel.push_lines([to_line(line) for line in lines])
    channel.push_ramps([to_ramp(ramp) for ramp in ramps])
    engine.drain()
    channel.start()
    left = clocks + 1000
    while left:
        left -= engine.run(left)
    events = engine.drain()
    running = events["clock"][np.flatnonzero(np.diff(events["running"], prepend=0))]
    assert len(running) == 2 and running[1] - running[0] == clocks
    state = channel.state()
    assert (state.state, state.cause, state.drained) == (State.IDLE, Cause.NONE, 0)
    events["clock"] -= running[0]
    return events


def pulses(events: np.ndarray, axis: int) -> list[tuple[int, int]]:
    """Clocks and directions of the rising edges of STEP."""
    level = (events["step"] >> axis & 1).astype(np.int8)
    rising = np.flatnonzero(np.diff(level, prepend=np.int8(0)) == 1)
    negative = events["dir"][rising] >> axis & 1
    return [(int(c), -1 if n else 1) for c, n in zip(events["clock"][rising], negative, strict=True)]


def check_motion(lines: Sequence[Line], ramps: Sequence[Ramp], tick_log2: int = 7) -> int:
    """Check that every step of every axis comes on its clock; return their number."""
    parameters = Parameters(axes=AXES, tick_log2=tick_log2)
    count = 0
    with model_engine(parameters, every_clock=True) as engine:
        channel = Channel(Link(engine), parameters)
        for axis in range(AXES):
            channel.configure_axis(axis, PinTiming())
        events = run_motion(engine, channel, lines, ramps)
        positions = channel.positions()
    for axis in range(AXES):
        expected = step_clocks(lines, ramps, tick_log2, axis)
        assert pulses(events, axis) == expected
        assert len(expected) == sum(abs(line.steps[axis]) for line in lines)
        assert positions[axis] == sum(line.steps[axis] for line in lines)
        count += len(expected)
    return count


def test_tables() -> None:
    """The tables are the formulas of the contract; cosine and sigmoid are odd-symmetric to the bit."""
    for bank, table in TABLES.items():
        assert [planner().passo_shape_point(bank, k) for k in range(257)] == [*table[:256], 65536]
    for bank in (COSINE, SIGMOID):
        assert all(TABLES[bank][k] + TABLES[bank][256 - k] == 65536 for k in range(257))


@pytest.mark.parametrize("mirror", [False, True])
@pytest.mark.parametrize("shape", SHAPES)
def test_each_shape_up_and_down(shape: int, mirror: bool) -> None:
    """A ramp up, a cruise and a ramp down in one shape."""
    top = ONE // 9 + 12345
    ramps = [
        Ramp(top, 61, shape, mirror),
        Ramp(top, 20),
        Ramp(ONE // 1000, 47, shape, not mirror),
        Ramp(0, 1, shape, mirror, last=True),
    ]
    assert check_motion(fill(ramps, [(100, -62, 1)]), ramps) > 1000


@pytest.mark.parametrize("mirror", [False, True])
@pytest.mark.parametrize("shape", SHAPES)
def test_velocity_of_every_tick(shape: int, mirror: bool) -> None:
    """All 48 bits of it, for ramps of many lengths between velocities of all sizes."""
    rng = random.Random(f"{SEED}/{shape}/{mirror}")
    parameters = Parameters(axes=1)
    ramps = [Ramp(HALF, 1, shape, mirror), Ramp(0, 2, shape, mirror), Ramp(HALF - 1, 256, shape, mirror)]
    ramps += [Ramp(rng.getrandbits(rng.randint(1, 47)), rng.randint(1, 90), shape, mirror) for _ in range(12)]
    ramps.append(Ramp(0, 1, last=True))
    player = PlayerPair(parameters, rng)
    link = Link(player)
    channel = Channel(link, parameters)
    channel.push_lines([to_line(Line(10**9, (0,), endless=True))])
    channel.push_ramps([to_ramp(ramp) for ramp in ramps])
    state = player.each.core.channel[0]
    link.write(r.ADDRESS_RUN, 1 << r.RUN_WAIT_SYNC_LSB | 1)
    assert state.motion.state == State.ARMED
    player.sync(True)
    while not state.motion.running:
        player.run(1)
    player.run(60)  # into the middle of a tick
    for tick, velocity in enumerate(velocities(ramps)):
        path = state.path
        assert path.velocity_high << 24 | path.velocity_low == velocity, f"tick {tick}"
        player.run(128)
    assert state.motion.state == State.IDLE


def test_full_speed_is_a_substep_every_second_clock() -> None:
    """T = 0 sets the velocity immediately; at 1/2 every axis can step on every second clock."""
    ramps = [Ramp(HALF, 0), Ramp(HALF, 20), Ramp(0, 0, last=True)]
    assert distance(ramps) == 20 * 64
    assert check_motion([Line(1280, (1280, 1280, -1280), last=True)], ramps) == 3 * 1280


def test_jumps_in_the_middle() -> None:
    """Ramps of length 0 between others, one after another too, take no time."""
    ramps = [
        Ramp(SLOW, 0),
        Ramp(SLOW, 3),
        Ramp(3 * SLOW, 0),
        Ramp(2 * SLOW, 0),
        Ramp(SLOW, 17, COSINE),
        Ramp(SLOW // 7, 0),
        Ramp(2 * SLOW, 9, EASE, True),
        Ramp(0, 0, last=True),
    ]
    check_motion(fill(ramps, [(90, -30, 0)]), ramps)


def test_velocity_zero_in_the_middle() -> None:
    """A motion at velocity 0 keeps its phase."""
    ramps = [Ramp(SLOW, 11), Ramp(0, 12), Ramp(0, 5), Ramp(SLOW, 13, SIGMOID), Ramp(0, 14, COSINE, last=True)]
    check_motion(fill(ramps, [(100, 50, -25)]), ramps)


def test_lines_follow_each_other_without_a_lost_clock() -> None:
    """Many short lines, all different, under ramps that do not end where the lines do."""
    ramps = [Ramp(SLOW, 40, COSINE), Ramp(SLOW, 90), Ramp(0, 40, COSINE, last=True)]
    shares = [(100, 50, -33), (-100, 100, 0), (7, -100, 100), (0, 0, 0), (-1, 99, -100)] * 8
    lines = fill(ramps, shares)
    assert max(line.substeps for line in lines[:-1]) < 30
    check_motion(lines, ramps)


@pytest.mark.parametrize("tick_log2", [8, 10])
def test_longer_ticks(tick_log2: int) -> None:
    """TICK_LOG2 affects only the length of a tick."""
    ramps = [Ramp(ONE // 10, 23, SIGMOID), Ramp(0, 11, EASE, True, last=True)]
    check_motion(fill(ramps, [(100, -100, 3)], tick_log2), ramps, tick_log2)


@pytest.mark.parametrize("number", range(25))
def test_random_motions(number: int) -> None:
    """Random lines under random ramps."""
    lines, ramps = random_motion(random.Random(f"{SEED}/{number}"), AXES)
    print(f"PASSO_SEED={SEED}")
    check_motion(lines, ramps)
