# SPDX-License-Identifier: MIT
"""The STM32 firmware at the SPI pins of the simulated core, in co-simulation.

While the emulated machine executes instructions the simulator is paused; then the core catches up. Time in
which the core is at rest, without chip select or motion, is skipped: waiting for the serial line would take
hours.
"""

from pathlib import Path

from cocotb.triggers import First, Timer, ValueChange
from cocotb.utils import get_sim_time
from passo.cocotb.clocks import PERIOD, read
from passo.plan import plan_move
from passo_stm32.board import START, firmware_elf
from passo_stm32.bus import TICKS_PER_SECOND
from passo_stm32.lines import move_line
from passo_stm32.machine import Machine

from cocotb_tests.helpers.bench import seed
from cocotb_tests.helpers.core_bench import Core, PinTiming, core_test, planned
from tests.helpers.firmware_cases import random_moves

STEP_PER_SECOND = 10**12  # of the simulator
HZ = STEP_PER_SECOND // PERIOD  # the default of the console
TYPING = 2_000_000  # baud; high, to save simulation time
AWAKE = TICKS_PER_SECOND // 100_000  # 10 us, after a frame or a motion
MOVES = 2


class SimulatedPins:
    """The pins of the dut for the machine (passo_stm32.wires.CorePins)."""

    def __init__(self, core: Core) -> None:
        self._core, self._dut = core, core.dut
        self._origin = int(get_sim_time("step"))  # time of tick 0
        self._selected = False
        self._awake_until = 0  # tick

    @property
    def irq(self) -> int:
        """Level of irq."""
        return read(self._dut.irq)

    def _time(self, tick: int) -> int:
        return self._origin + tick * STEP_PER_SECOND // TICKS_PER_SECOND | 1  # odd: on no edge of the clock

    def _tick(self) -> int:
        return -(-(int(get_sim_time("step")) - self._origin) * TICKS_PER_SECOND // STEP_PER_SECOND)

    async def _wait(self, tick: int, *changes: ValueChange) -> None:
        time = self._time(tick) - int(get_sim_time("step"))
        if time > 0:
            await First(Timer(time, "step"), *changes)

    def follow(self, tick: int) -> int:
        """Simulate up to a tick, or a change of irq; skip time when the core is at rest."""
        before = self.irq
        if self._selected or read(self._dut.running):
            self._awake_until = tick + AWAKE
        self._core._thread.wait(self._wait(min(tick, self._awake_until), ValueChange(self._dut.irq)))
        if self.irq != before:
            return min(tick, self._tick())
        if tick > self._awake_until and not read(self._dut.running):
            self._origin -= self._time(tick) - int(get_sim_time("step"))
        return tick

    def select(self, selected: bool) -> None:
        """Chip select."""

        async def set_pin() -> None:
            self._dut.spi_cs_n.value = int(not selected)

        self._selected = selected
        self._awake_until = self._tick() + AWAKE
        self._core._thread.wait(set_pin())

    def exchange(self, mosi: bytes, half_period: int) -> bytes:
        """Bits."""
        return self._core._thread.wait(self._exchange(mosi, half_period))

    async def _exchange(self, mosi: bytes, half_period: int) -> bytes:
        received, tick = 0, self._tick()
        for bit in range(8 * len(mosi)):
            self._dut.spi_mosi.value = mosi[bit // 8] >> (7 - bit % 8) & 1
            await self._wait(tick + (2 * bit + 1) * half_period)
            received = received << 1 | read(self._dut.spi_miso)
            self._dut.spi_sclk.value = 1
            await self._wait(tick + (2 * bit + 2) * half_period)
            self._dut.spi_sclk.value = 0
        return received.to_bytes(len(mosi), "big")


@core_test
def moves_of_the_firmware(core: Core) -> None:
    """Lines typed at the console: pulses as planned on the PC, and equal to the C model on every clock."""
    core.watch(PinTiming(100, 100, 100, 100))
    machine = Machine(firmware_elf(), SimulatedPins(core))
    machine.expect("help lists the commands\n", START)
    position = [0] * core.axes
    moves = random_moves(seed(), 100, HZ, core.parameters, Path(), longest=0.0005)
    fitting = [m for m in moves if len(m[1].moves[0].steps) <= core.axes][:MOVES]
    assert len(fitting) == MOVES
    for move, file, plan in fitting:
        since, began = len(machine.output), core.clock
        machine.type(move_line(move) + "\r", TYPING)
        machine.expect("ok\n", 0.02, since)
        machine.run(plan.clocks / HZ + 0.0004)
        core.compare()
        ((start, end),) = core.motions(0, began)
        assert end - start == plan.clocks
        for axis, steps in enumerate(file.moves[0].steps):
            made = core.steps(axis, began)
            assert len(made) == abs(steps), (move, axis)
            position[axis] += steps
        expected = plan_move(file.moves[0], HZ, core.parameters)
        assert planned(expected, core.axes) == planned(plan, core.axes)
    since = len(machine.output)
    machine.type("position\r", TYPING)
    machine.expect(f"ok position={','.join(map(str, position))}\n", 0.02, since)
