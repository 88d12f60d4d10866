# SPDX-License-Identifier: MIT
"""A host interface for a CPU in the same FPGA, driven by a third-party bus master.

Checked against the driver library, which accepts only valid replies; the C model with SPI, which must give
the same replies and pulses for the same frames; and the rules of passo_words.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import cocotb
import numpy as np
from cocotb.handle import HierarchyObject
from passo.build import Parameters
from passo.cocotb.bus import SELECT, WORD, AxiLite, Bus, BusHost, Wishbone
from passo.cocotb.clocks import PERIOD, Clocks, Recorder, read
from passo.cocotb.host import plain_test, wait
from passo.cocotb.thread import Thread
from passo.driver import Driver
from passo.engine import Engine, model_engine
from passo.registers import Operation

from cocotb_tests.helpers import core_frames as frames
from cocotb_tests.helpers.bench import patience, rng
from cocotb_tests.helpers.runner import BUS_CORE
from tests.helpers.driver_wire import by_speed, configure

PARAMETERS = Parameters(**{name.lower(): value for name, value in BUS_CORE.items()})
CLOCK_HZ = 10_000_000  # of plans
READ_WAIT = 264  # clocks of a read, at most
WAIT = 128  # clocks after a word or a change of SELECT
MOVES = ((30, -17), (-5, 0), (1, 40), (-26, -23))


class BusCore(BusHost):
    """The core behind a bus, with the clock of the plans and all that was recorded."""

    def __init__(self, dut: HierarchyObject, thread: Thread, clocks: Clocks, bus: Bus, base: int = 0):
        super().__init__(dut, thread, clocks, bus, base)
        self.clock_hz = CLOCK_HZ
        self.changes = [Recorder(clocks, signal) for signal in (dut.running, dut.step, dut.dir)]

    def pulses(self) -> list[tuple[int, int, int]]:
        """All edges of STEP, as `motion_edges` has them."""
        return motion_edges([recorder.changes for recorder in self.changes])


def motion_edges(signals: Sequence[Sequence[tuple[int, int]]]) -> list[tuple[int, int, int]]:
    """Of changes of running, step and dir (clock, level), those of step: (clock in the motion, step, dir)."""
    running, step, direction = signals
    made = []
    for clock, level in step:
        (began, _) = max((begin, on) for begin, on in running if on and begin <= clock)
        made.append((clock - began, level, max(((0, 0), *((c, d) for c, d in direction if c <= clock)))[1]))
    return made


async def _begin(dut: HierarchyObject, thread: Thread) -> BusCore:
    return await BusCore.begin(dut, thread, Wishbone if hasattr(dut, "wb_cyc_i") else AxiLite)


def bus_test(body: Callable[[BusCore], None]) -> Any:
    """Make a cocotb test of plain code."""
    return plain_test(_begin, body)


def moves() -> Sequence[tuple[int, ...]]:
    """Steps of the axes."""
    return MOVES[: patience(verilator=len(MOVES), icarus=1)]


def drive(engine: Any) -> list[int]:
    """Some moves, by the driver library; the positions after them."""
    driver = Driver(engine, CLOCK_HZ, PARAMETERS)
    configure(driver)
    for profile, steps in enumerate(moves()):
        move = by_speed(steps, 60_000, 40_000_000)
        move.profile = profile % 3
        driver.call("move_by_speed", move)
        driver.wait(1)
        engine.run(400)  # the last pulse
    assert driver.counters.retries == 0
    return driver.positions()


@bus_test
def the_driver_moves(core: BusCore) -> None:
    """Pulses, on their clocks, and positions equal those of the C model with SPI."""
    positions = drive(core)
    assert positions == [sum(steps) for steps in zip(*moves(), strict=True)]
    assert read(core.dut.enable) == 3
    with model_engine(PARAMETERS, CLOCK_HZ) as engine:
        assert drive(engine) == positions
        expected = engine_edges(engine)
    made = core.pulses()
    levels = [0, *(step for _, step, _ in made)]
    rises = [now & ~before for before, now in pairwise(levels)]
    pulses = [sum(rise >> axis & 1 for rise in rises) for axis in range(PARAMETERS.axes)]
    assert pulses == [sum(map(abs, steps)) for steps in zip(*moves(), strict=True)]
    differ = [pair for pair in zip(made, expected, strict=True) if pair[0] != pair[1]]
    assert not differ, differ[:4]


def engine_edges(engine: Engine) -> list[tuple[int, int, int]]:
    """`motion_edges` of what an engine has recorded."""
    events = engine.drain()
    signals = []
    for name in ("running", "step", "dir"):
        levels = events[name]
        at = np.flatnonzero(levels[1:] != levels[:-1]) + 1
        signals.append([(int(events["clock"][i]), int(levels[i])) for i in at])
    return motion_edges(signals)


@bus_test
def replies_are_those_over_spi(core: BusCore) -> None:
    """Valid and refused frames, duplicates, cut and corrupt frames: compared word by word."""
    random = rng("replies_are_those_over_spi")
    channel = 0x100
    sent = [
        frames.request(Operation.READ, 1, 20, 0),
        frames.request(Operation.WRITE, 2, 1, 0, [0]),
        frames.request(Operation.PUSH, 3, 4, channel, [0, 5, 1, 2]),
        frames.request(5, 4, 1, 0, [1]),
        frames.request(Operation.READ, 5, 61, 0),
    ]
    for sequence in range(6, 6 + patience(verilator=20, icarus=5)):
        operation = random.choice([Operation.READ, Operation.WRITE, Operation.PUSH])
        address = random.choice([0, 1, channel, channel + 1, channel + 0x20, 0x500])
        payload = [random.getrandbits(32) for _ in range(random.randrange(1, 9))]
        words = frames.request(operation, sequence, len(payload), address, payload)
        if random.random() < 0.2:
            words[random.randrange(len(words))] ^= 1 << random.randrange(32)
        sent += [words] if random.random() < 0.8 else [words, words]
        if random.random() < 0.2:
            sent.append(words[: random.randrange(1, len(words))])
    sent.append(frames.request(Operation.READ, 99, 20, 0))
    gap = 8 * WAIT
    with model_engine(PARAMETERS, CLOCK_HZ) as engine:
        for words in sent:
            assert core.transfer(words, gap) == engine.transfer(words, gap), [hex(word) for word in words]


@bus_test
def an_access_waits_for_the_one_before(core: BusCore) -> None:
    """For 128 clocks after a word or a change of SELECT, except reading SELECT."""
    few, enough = 20, WAIT - 20

    def clocks_of(access: Callable[[], object]) -> int:
        before = core.clock
        assert access() is not None
        return core.clock - before

    status = frames.request(Operation.READ, 1, 1, 0)
    assert clocks_of(lambda: core.write(SELECT, 0)) < few
    assert clocks_of(lambda: core.write(SELECT, 1)) < few
    assert clocks_of(lambda: core.read(SELECT)) < few
    assert core.read(SELECT) == 1
    assert clocks_of(lambda: core.read(WORD)) > enough - 3 * few
    assert core.read(SELECT) == 3
    for word in status:
        assert clocks_of(lambda word=word: core.write(WORD, word)) < few
        assert core.read(SELECT) == 1
        assert clocks_of(lambda: core.read(WORD)) > enough - 2 * few
        assert clocks_of(lambda: core.read(WORD)) < few
    assert clocks_of(lambda: core.write(SELECT, 1)) < few
    assert core.read(SELECT) == 3
    core.write(WORD, 0)
    assert clocks_of(lambda: core.write(WORD, 0)) > enough
    assert clocks_of(lambda: core.write(SELECT, 0)) > enough
    assert core.read(SELECT) == 0


@bus_test
def reads_pass_a_stream_of_writes(core: BusCore) -> None:
    """On a bus that has both simultaneously: a read waits for one write at most."""
    if not isinstance(core.bus, AxiLite):
        return
    bus, writes, reads = core.bus, patience(verilator=160, icarus=20), patience(verilator=12, icarus=3)

    async def both() -> list[int]:
        ends = [cocotb.start_soon(bus.write(SELECT, 1 - i % 2)) for i in range(writes)]
        waited = []
        for _ in range(reads):
            before = core.clock
            assert await bus.read(WORD) is not None
            waited.append(core.clock - before)
        assert not ends[-1].done()
        for end in ends:
            assert await end is not None
        return waited

    assert max(core._thread.wait(both())) <= READ_WAIT


@bus_test
def what_is_an_error(core: BusCore) -> None:
    """Writes of WORD while no frame is open, and byte accesses; they have no effect."""
    assert core.write(WORD, 0x12345678) is None
    assert core.read(SELECT) == 2
    for lanes in (1, 2, 4, 8, 3, 6, 12, 7, 14):
        assert core.write(SELECT, 0xFFFFFFFF, lanes) is None
        assert core.read(SELECT) == 2
    core.write(SELECT, 1)
    first = core.read(WORD)
    for lanes in (1, 3, 7, 14):
        assert core.write(WORD, 0, lanes) is None
    assert core.read(WORD) == first
    core.write(SELECT, 0)
    # nothing of it came to the core
    with model_engine(PARAMETERS, CLOCK_HZ) as engine:
        words = frames.request(Operation.READ, 1, 20, 0)
        assert core.transfer(words) == engine.transfer(words)


@bus_test
def a_reset_closes_the_frame(core: BusCore) -> None:
    """In the middle of a word, too."""

    async def reset() -> None:
        core.dut.rst.value = 1
        await wait(3 * PERIOD)
        core.dut.rst.value = 0
        await wait(3 * PERIOD)

    with model_engine(PARAMETERS, CLOCK_HZ) as engine:
        words = frames.request(Operation.READ, 1, 20, 0)
        expected = engine.transfer(words)
    for clocks in (0, 64, 65, 66, 127, 128)[: patience(verilator=6, icarus=2)]:
        core.write(SELECT, 1)
        core.write(WORD, words[0])
        core.run(clocks)
        core._thread.wait(reset())
        assert core.read(SELECT) == 2
        assert core.transfer(words) == expected
