# SPDX-License-Identifier: MIT
"""passo_registers: what is read, RUN of every channel, the status word of any room."""

from random import Random

import cocotb
import pytest
from cocotb.handle import HierarchyObject
from passo import registers as r
from passo.cocotb.clocks import Clocks, read

from cocotb_tests.helpers.bench import Bench, rng
from cocotb_tests.helpers.runner import run

AXES, TICK_LOG2, LINE_QUEUE_LOG2, RAMP_QUEUE_LOG2 = 8, 16, 8, 7
REGISTERS = range(8)
CLOCK_HZ, BUILD = 108_000_000, 0xDEADBEEF
RUN = 3
DATA = 0x7FFFF  # what RUN has
ROOM_SHOWN = 255  # at most


@pytest.mark.parametrize("channels", [1, 8])
def test_registers(simulator: str, channels: int) -> None:
    parameters = {
        "CHANNELS": channels,
        "AXES": AXES,
        "TICK_LOG2": TICK_LOG2,
        "LINE_QUEUE_LOG2": LINE_QUEUE_LOG2,
        "RAMP_QUEUE_LOG2": RAMP_QUEUE_LOG2,
        "CLOCK_HZ": CLOCK_HZ,
        "BUILD": BUILD,
    }
    run(__name__, "passo_registers", parameters, simulator)


class Registers(Bench):
    """The module under test."""

    INPUTS = (
        "bus_write", "bus_read", "bus_address", "bus_data", "last_sequence", "any_stopped", "any_occupied",
        "line_room", "ramp_room",
    )  # fmt: skip

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        super().__init__(dut, clocks)
        self.channels = len(dut.run)

    def put(self, address: int, data: int = 0) -> None:
        """Put an access on the bus."""
        self.dut.bus_address.value = address
        self.dut.bus_data.value = data & DATA

    async def access(self, name: str, address: int, data: int = 0) -> None:
        """Put an access on the bus and raise a strobe for a clock; what is read is there on return."""
        self.put(address, data)
        await self.clocks.wait(2)
        await self.strobe(name)

    def good_run(self, random: Random) -> int:
        """A word that RUN takes."""
        bits = [random.getrandbits(self.channels) for _ in range(2)]
        return random.randrange(self.channels) << 16 | bits[1] << 8 | bits[0]

    def takes(self, word: int) -> bool:
        """It has bits for existing channels only."""
        run, wait, status = word & 0xFF, word >> 8 & 0xFF, word >> 16 & 7
        return max(run, wait) >> self.channels == 0 and status < self.channels


@cocotb.test()
async def only_channels_that_are_there_are_taken(dut: HierarchyObject) -> None:
    """Good words of RUN and those with a bit too many; of other addresses no word is bad."""
    random = rng("registers, checks")
    bench = await Registers.begin(dut)
    for _ in range(20):
        for address in (*REGISTERS, 0x13, 0x103, 0xFFF):
            word = bench.good_run(random) ^ random.choice((0, 0, 1 << random.randrange(19)))
            bench.put(address, word)
            await bench.clocks.wait(2)
            assert read(dut.bad_value) == (address == RUN and not bench.takes(word)), hex(address)
            assert read(dut.is_counters) == (address in (4, 5))


@cocotb.test()
async def run_is_written_and_read(dut: HierarchyObject) -> None:
    """RUN and WAIT_SYNC of every channel, STATUS_CHANNEL; the other registers are what was built."""
    random = rng("registers, run")
    bench = await Registers.begin(dut)
    parameters = (
        RAMP_QUEUE_LOG2 << r.PARAMETERS_RAMP_QUEUE_LOG2_LSB
        | LINE_QUEUE_LOG2 << r.PARAMETERS_LINE_QUEUE_LOG2_LSB
        | TICK_LOG2 << r.PARAMETERS_TICK_LOG2_LSB
        | AXES << r.PARAMETERS_AXES_LSB
        | bench.channels
    )
    version = r.VERSION_MAJOR_RESET << 16 | r.VERSION_MINOR_RESET << 8 | r.VERSION_PATCH_RESET
    for _ in range(60):
        word = bench.good_run(random)
        await bench.access("bus_write", RUN, word)
        assert read(dut.run) == word & 0xFF and read(dut.wait_sync) == word >> 8 & 0xFF
        # of another register nothing is written
        await bench.access("bus_write", random.choice((0, 2, 4, 0x103)), ~word & 0x7FFFF)
        told = (r.IDENTIFICATION_RESET, version, parameters, word, 0, 0, CLOCK_HZ, BUILD)
        for address, expected in enumerate(told):
            await bench.access("bus_read", address)
            assert read(dut.read_data) == expected
            await bench.clocks.wait(1)


@cocotb.test()
async def the_status_word_has_it_all(dut: HierarchyObject) -> None:
    """Whenever nothing is read: state, sequence, the room of the chosen channel, 255 for more."""
    random = rng("registers, status")
    bench = await Registers.begin(dut)
    for _ in range(200):
        depths = {"line_room": LINE_QUEUE_LOG2, "ramp_room": RAMP_QUEUE_LOG2}
        rooms = {
            name: [random.choice((0, 1 << log2, random.randrange(1 << log2))) for _ in range(bench.channels)]
            for name, log2 in depths.items()
        }
        for name, log2 in depths.items():
            packed = sum(room << (log2 + 1) * n for n, room in enumerate(rooms[name]))
            getattr(dut, name).value = packed
        chosen = random.randrange(bench.channels)
        stopped, occupied, sequence = random.randrange(2), random.randrange(2), random.randrange(256)
        dut.any_stopped.value, dut.any_occupied.value = stopped, occupied
        dut.last_sequence.value = sequence
        await bench.access("bus_write", RUN, chosen << 16)
        shown = [min(rooms[name][chosen], ROOM_SHOWN) for name in depths]
        assert read(dut.read_data) == (
            2 << 30
            | stopped << 29
            | occupied << 28
            | chosen << 24
            | sequence << 16
            | shown[0] << 8
            | shown[1]
        )
