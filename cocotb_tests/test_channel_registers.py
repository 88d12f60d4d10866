# SPDX-License-Identifier: MIT
"""passo_channel_registers: address decoding, what commands need, writes and reads."""

import cocotb
from cocotb.handle import HierarchyObject
from cocotb.triggers import ReadOnly, Timer
from passo import registers as r
from passo.cocotb.clocks import PERIOD, read

from cocotb_tests.helpers.bench import Bench, rng
from cocotb_tests.helpers.runner import run

AXES = 8
LINE_QUEUE_LOG2 = RAMP_QUEUE_LOG2 = 8
COMMAND, RATE_TARGET, RATE_SLEW, STOP_SLEW, DRAIN_VELOCITY = range(5)
STATE, RATE, ROOM, VELOCITY = range(8, 12)
LINE, RAMP, POSITIONS, AXIS = 0x20, 0x21, 0x40, 0x80
STOP, ABORT, CLEAR, ZERO = (1 << bit for bit in range(4))
SETTINGS = {
    RATE_TARGET: "rate_target",
    RATE_SLEW: "rate_slew",
    STOP_SLEW: "stop_slew",
    DRAIN_VELOCITY: "drain_velocity",
}
COMMANDS = ("command_stop", "command_abort", "command_clear", "command_zero")
STATES = {
    "state": 3, "quiet": 1, "cause": 4, "stopping": 1, "overrun": AXES, "drained": 15, "rate": 17,
    "velocity": 32, "line_room": LINE_QUEUE_LOG2 + 1, "ramp_room": RAMP_QUEUE_LOG2 + 1,
}  # fmt: skip


def test_channel_registers(simulator: str) -> None:
    depths = {"LINE_QUEUE_LOG2": LINE_QUEUE_LOG2, "RAMP_QUEUE_LOG2": RAMP_QUEUE_LOG2}
    run(__name__, "passo_channel_registers", {"AXES": AXES, **depths}, simulator)


class Registers(Bench):
    """The module under test."""

    INPUTS = (
        "bus_check", "bus_write", "bus_read", "bus_push", "select", "bus_address", "bus_data", *STATES,
    )  # fmt: skip

    async def access(self, name: str, address: int, data: int = 0, push: bool = False) -> None:
        """Put an access on the bus and raise a strobe for a clock."""
        dut = self.dut
        dut.select.value = 1
        dut.bus_address.value = address
        dut.bus_data.value = data
        dut.bus_push.value = push
        await self.clocks.wait(2)
        await self.strobe(name)


def command_of(data: int) -> int:
    """The effective bits of a command."""
    return ABORT if data & ABORT else STOP if data & STOP else data


@cocotb.test()
async def every_address_means_its_block(dut: HierarchyObject) -> None:
    """One bit for the addressed axis or position, pushes to a queue, and nothing while not selected."""
    bench = await Registers.begin(dut)
    for selected in (1, 0):
        for address in range(0x100):
            for push in (0, 1):
                dut.select.value = selected
                dut.bus_address.value = address
                dut.bus_push.value = push
                await bench.clocks.wait(1)
                axis, position = address - AXIS >> 3, address - POSITIONS
                assert read(dut.select_axis) == (selected << axis if 0 <= axis < AXES else 0)
                assert read(dut.select_position) == (selected and 0 <= position < AXES)
                assert read(dut.select_line_queue) == (selected and push and address == LINE)
                assert read(dut.select_ramp_queue) == (selected and push and address == RAMP)


@cocotb.test()
async def commands_say_what_they_need(dut: HierarchyObject) -> None:
    """With the strobe of the check: CLEAR requires no motion, ZERO a quiet channel, a stop nothing."""
    bench = await Registers.begin(dut)
    for name in ("bus_check", "bus_write", "bus_read"):
        for address in (COMMAND, RATE_TARGET, STATE, LINE):
            for command in range(16):
                needs = []

                async def watch(needs: list[tuple[int, int]] = needs) -> None:
                    for _ in range(5):
                        await ReadOnly()
                        needs.append((read(dut.needs_idle), read(dut.needs_quiet)))
                        await Timer(PERIOD, "step")

                watching = cocotb.start_soon(watch())
                await bench.access(name, address, command)
                await watching
                meant = command_of(command) if (name, address) == ("bus_check", COMMAND) else 0
                assert needs.count((0, 0)) == 5 - (meant & (CLEAR | ZERO) != 0)
                assert all(need in ((0, 0), (meant & CLEAR != 0, meant & ZERO != 0)) for need in needs)


@cocotb.test()
async def what_is_written_stands(dut: HierarchyObject) -> None:
    """Settings keep the last value written; a command lasts one clock; other writes have no effect."""
    random = rng("channel registers, writes")
    bench = await Registers.begin(dut)
    settings = {RATE_TARGET: 1 << 16, RATE_SLEW: 0x400, STOP_SLEW: 0x400, DRAIN_VELOCITY: 1 << 24}
    for _ in range(300):
        address = random.choice((*range(12), LINE, RAMP, POSITIONS + RATE_TARGET, AXIS + RATE_TARGET))
        data = random.getrandbits(32 if address == DRAIN_VELOCITY else 17)
        await bench.access("bus_write", address, data)
        if address in settings:
            settings[address] = data
        for clock in range(2):
            now = [read(getattr(dut, name)) for name in COMMANDS]
            wanted = command_of(data) if address == COMMAND and clock == 0 else 0
            assert now == [wanted >> bit & 1 for bit in range(4)]
            await bench.clocks.wait(1)
        assert {n: read(getattr(dut, name)) for n, name in SETTINGS.items()} == settings


@cocotb.test()
async def states_are_read_as_they_are(dut: HierarchyObject) -> None:
    """All bits of all states, for one clock; at other addresses there are none."""
    random = rng("channel registers, reads")
    bench = await Registers.begin(dut)
    for _ in range(100):
        values = {
            name: random.choice((0, (1 << bits) - 1, random.getrandbits(bits)))
            for name, bits in STATES.items()
        }
        for name, value in values.items():
            getattr(dut, name).value = value
        v = values
        words = {
            STATE: v["drained"] << r.CHANNEL_STATE_DRAINED_LSB
            | v["overrun"] << 8
            | v["stopping"] << r.CHANNEL_STATE_STOPPING_LSB
            | v["cause"] << 4
            | v["quiet"] << 3
            | v["state"],
            RATE: v["rate"],
            ROOM: v["line_room"] << 16 | v["ramp_room"],
            VELOCITY: v["velocity"],
        }
        address = random.choice((*words, *words, *range(0x30)))
        await bench.access("bus_read", address)
        assert read(dut.read_data) == words.get(address, 0)
        await bench.clocks.wait(1)
        assert read(dut.read_data) == 0
