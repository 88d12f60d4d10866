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
from cocotbext.axi import AxiProt, AxiResp
from passo import registers as r
from passo.build import Parameters
from passo.cocotb.bus import SELECT, WORD, AxiLite, Bus, BusHost, Wishbone
from passo.cocotb.clocks import PERIOD, Clocks, Recorder, read
from passo.cocotb.host import plain_test, wait
from passo.cocotb.thread import Thread
from passo.driver import Driver
from passo.engine import Engine, model_engine
from passo.host import Channel
from passo.link import Link
from passo.registers import Cause, LineOutputWord, Operation

from cocotb_tests.helpers import core_frames as frames
from cocotb_tests.helpers.bench import patience, rng
from cocotb_tests.helpers.core_bench import ONE, Line, Ramp
from cocotb_tests.helpers.core_shaft import GRAY
from cocotb_tests.helpers.runner import BUS_CORE
from tests.helpers.driver_wire import by_speed, configure

PARAMETERS = Parameters(**{name.lower(): value for name, value in BUS_CORE.items()})
CLOCK_HZ = 10_000_000  # of plans
READ_WAIT = 264  # clocks of a read, at most
WAIT = 128  # clocks after a word or a change of SELECT
MOVES = ((30, -17), (-5, 0), (1, 40), (-26, -23))
FULL = LineOutputWord(raster=False, proportional=False, levels=0x3C, power=0xFFFF)


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


@bus_test
def what_an_access_leaves_open(core: BusCore) -> None:
    """The byte of the address within a word, and AXI's PROT, do not matter."""
    if not isinstance(core.bus, AxiLite):
        assert [core.read(SELECT + byte) for byte in range(4)] == [2] * 4
        return
    master, all_rights = core.bus._master, AxiProt.PRIVILEGED | AxiProt.NONSECURE | AxiProt.INSTRUCTION

    async def select() -> bytes:
        answers = [await master.read(SELECT + byte, 1, prot=all_rights) for byte in range(4)]
        answers.append(await master.write(SELECT, bytes(4), prot=all_rights))
        assert {answer.resp for answer in answers} == {AxiResp.OKAY}
        return b"".join(answer.data for answer in answers[:4])

    assert int.from_bytes(core._thread.wait(select()), "little") == 2


@bus_test
def inputs_come_to_the_core(core: BusCore) -> None:
    """Each pin of each axis is read at its place; the probe; the counts of the encoders."""
    channel = Channel(Link(core), PARAMETERS)
    for kind, name in enumerate(("limit_low", "limit_high", "home", "alarm")):
        for axis in range(PARAMETERS.axes):
            core.set(name, 1 << axis)
            core.run(20)
            assert channel.link.read(channel.base + r.CHANNEL_INPUT_LEVELS, 1) == [1 << 8 * kind + axis]
            core.set(name, 0)
    assert channel.state().cause == Cause.ALARM
    core.set("probe", 1)
    core.run(20)
    (state,) = channel.link.read(channel.base + r.CHANNEL_TRIGGER_STATE, 1)
    assert r.ChannelTriggerStateWord.unpack(state).probe
    core.set("probe", 0)
    expected = [0] * PARAMETERS.axes
    for axis in range(PARAMETERS.axes):
        for a, b in (*GRAY[1:], GRAY[0], GRAY[1], GRAY[0]):
            core.set("encoder_a", a << axis)
            core.set("encoder_b", b << axis)
            core.run(10)
        core.set("encoder_index", 1 << axis)
        core.run(10)
        core.set("encoder_index", 0)
        expected[axis] = 4
        assert channel.link.read(channel.base + r.CHANNEL_ENCODER_POSITION_BASE, len(expected)) == expected
        index = channel.base + r.CHANNEL_ENCODER_BASE + axis * r.CHANNEL_ENCODER_STRIDE + r.ENCODER_INDEX
        assert r.EncoderIndexWord.unpack(channel.link.read(index, 1)[0]).indexes == 1


@bus_test
def outputs_come_from_the_core(core: BusCore) -> None:
    """Levels, power, compare; a motion begins with sync; the e-stop ends it, and the host is interrupted."""
    channel = Channel(Link(core), PARAMETERS)
    for levels in (0xA5, 0x5A, 0):
        channel.link.write(channel.base + r.CHANNEL_OUTPUT_LEVELS, levels)
        core.run(10)
        assert read(core.dut.outputs) == levels
    channel.link.write(channel.base + r.CHANNEL_COMPARE_PULSE, 2, 5, 5)
    step, compare = core.record(core.dut.step), core.record(core.dut.compare)
    line = Line(9, (9,) * PARAMETERS.axes, endless=True).words()
    channel.push_line_words([line], [FULL])
    channel.link.push(channel.base + r.CHANNEL_RAMP, Ramp(ONE // 20, 0).words())
    channel.link.push(channel.base + r.CHANNEL_RAMP, Ramp(ONE // 20, 60_000).words())
    channel.link.write(r.ADDRESS_RUN, 1 << r.RUN_WAIT_SYNC_LSB | 1)
    core.run(1000)
    assert not read(core.dut.running)
    core.set("sync", 1)
    core.run(1000)
    assert read(core.dut.running) and read(core.dut.power) and not read(core.dut.irq)
    rises = [clock for clock, level in step.changes if level]
    assert read(core.dut.outputs) == FULL.levels
    assert [clock for clock, level in compare.changes if level] == rises[4::5]
    core.set("estop_n", 0)
    core.run(20)
    assert read(core.dut.irq) and not read(core.dut.running) and not read(core.dut.power)
    core.set("sync", 0)
    core.set("estop_n", 1)
    core.run(20)
    channel.link.write(r.ADDRESS_ESTOP_CLEAR, 1)
    assert channel.state().cause == Cause.ESTOP
    channel.clear()
    assert not read(core.dut.irq)
