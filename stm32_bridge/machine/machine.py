# SPDX-License-Identifier: MIT
"""The whole microcontroller: an ELF in flash, a terminal at USART1, a core at the SPI pins."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from passo.engine import EVENT, Engine
from passo_stm32.bus import TICKS_PER_SECOND, Bus, MachineError, Peripheral
from passo_stm32.crc import Crc
from passo_stm32.dma import Dma
from passo_stm32.flash import Flash
from passo_stm32.gpio import ALTERNATE_PUSH_PULL, PORTS, Afio, Exti, Gpio
from passo_stm32.iwdg import Debug, Iwdg
from passo_stm32.nvic import HARD_FAULT, SUPERVISOR_CALL, Exceptions, Nvic, SystemControl
from passo_stm32.processor import FLASH, FLASH_SIZE, Processor
from passo_stm32.rcc import ENABLES, Clocks, Rcc
from passo_stm32.spi import RECEIVE_CHANNEL, Spi
from passo_stm32.systick import SysTick
from passo_stm32.usart import Usart
from passo_stm32.wires import CorePins, Wires

SLICE = 256  # instructions after which the core catches up while the processor is awake
HANG = FLASH_SIZE - 2  # address of the endless loop of `hang`
BRANCH_TO_ITSELF = b"\xfe\xe7"
STOP_MESSAGES = {6: "read", 7: "write to", 8: "fetch from", 12: "write to", 13: "read", 14: "fetch from"}


class Machine(Processor):
    """A powered microcontroller; the first `run` starts the firmware.

    The engine must be new; its clock_hz is the clock of the core. Without `crystal` there is no crystal.
    """

    def __init__(
        self,
        elf: Path,
        core: CorePins | None = None,
        *,
        crystal: bool = True,
        baud: int = 115_200,
        select: str = "PA4",
        irq: str = "PB0",
        seed: int = 1,
    ):
        super().__init__(elf, self._on_read, self._on_write, self._on_program)
        self.crystal = crystal
        self.baud = baud  # of the terminal
        self.wires = Wires(core, seed)
        self.output = ""  # what the terminal received
        self.output_ticks: list[int] = []  # when the reception of each character ended
        self.resets: list[tuple[int, str]] = []  # tick and cause
        self.faults: list[str] = []  # causes of hard faults
        self.asleep_ticks = 0
        self.led: list[tuple[int, int]] = []  # tick and level of PC13
        self._select, self._irq = _pin(select), _pin(irq)
        self._chip_selected = False
        self._asleep = self._locked_up = False
        self._reset_cause: str | None = None
        self._error: Exception | None = None
        self._events: list[np.ndarray] = []
        self._make_peripherals()
        if isinstance(core, Engine):
            core.pace(core.clock_hz, TICKS_PER_SECOND)
        self._reset("power")

    def _make_peripherals(self) -> None:
        self.exceptions = Exceptions()
        self.clocks = Clocks()
        self.peripherals: dict[str, Peripheral] = {}
        self._bus = Bus()
        self.flash = self._add(Flash(self))
        self.rcc = self._add(Rcc(self))
        self.ports = {letter: self._add(Gpio(self, letter)) for letter in PORTS}
        self.dma = self._add(Dma(self))
        self.usart = self._add(Usart(self))
        self.spi = self._add(Spi(self))
        self.afio, self.exti = self._add(Afio(self)), self._add(Exti(self))
        for kind in (Crc, Iwdg, Debug, Nvic, SystemControl, SysTick):
            self._add(kind(self))
        self._timed = tuple(self.peripherals[n] for n in ("SPI1", "USART1", "SysTick", "IWDG", "RCC"))
        letter, pin = self._irq
        self._irq_level = self.ports[letter].external[pin] = self.wires.irq

    def _add(self, peripheral: Any) -> Any:
        self.peripherals[peripheral.name] = peripheral
        self._bus.add(peripheral)
        return peripheral

    # ------------------------------------------------------------------------------------ for the user ----

    @property
    def now(self) -> int:
        """Ticks since power-on."""
        return self.cpu.now

    @property
    def seconds(self) -> float:
        """Seconds since power-on."""
        return self.cpu.now / TICKS_PER_SECOND

    def run(self, seconds: float) -> None:
        """Let time pass; raises MachineError."""
        self._run(self.now + round(seconds * TICKS_PER_SECOND), lambda: False)

    def run_until(self, condition: Callable[[], object], seconds: float) -> None:
        """Let time pass until a condition is true; raises TimeoutError after `seconds`."""
        if not self._run(self.now + round(seconds * TICKS_PER_SECOND), condition) and not condition():
            raise TimeoutError(f"nothing for {seconds} s; the terminal shows ...{self.output[-200:]!r}")

    def type(self, text: str, baud: int | None = None) -> None:
        """Send characters from the terminal at its baud rate."""
        self.usart.type(text.encode("latin-1"), baud or self.baud, self.now)
        self._next_due = self.now

    def expect(self, text: str, seconds: float, since: int = 0) -> None:
        """Run until the output contains a text after its first `since` characters."""
        self.run_until(lambda: text in self.output[since:], seconds)

    def command(self, line: str, seconds: float, prompt: str) -> str:
        """Type a line and run until `prompt`; return the output before it."""
        since = len(self.output)
        self.type(line + "\r")
        self.expect(prompt, seconds, since)
        return self.output[since:].rpartition(prompt)[0]

    def events(self) -> np.ndarray:
        """The pin events of the core (passo.engine.EVENT) since the last call."""
        self._drain()
        events, self._events = self._events, []
        return np.concatenate([np.empty(0, EVENT), *events])

    def hang(self) -> None:
        """Inject a fault: the processor enters an endless loop; interrupts keep working."""
        self.write_memory(FLASH + HANG, BRANCH_TO_ITSELF)
        self.jump(FLASH + HANG)

    def jump(self, address: int) -> None:
        """Inject a fault: the processor continues at an address."""
        self._c.passo_cpu_set_pc(self.cpu, address)
        self._asleep = False

    # ---------------------------------------------------------------------------------------- the loop ----

    def _run(self, until: int, condition: Callable[[], object]) -> bool:
        cpu = self.cpu
        while cpu.now < until and not condition():
            self._advance()
            if self._reset_cause is not None:
                self._reset(self._reset_cause)
            if self._take_exception():
                continue
            target = min(until, self._next_due)
            if self._asleep or self._locked_up:
                began = cpu.now
                cpu.now = max(began, self._follow(max(began, target)))
                self.asleep_ticks += cpu.now - began
            else:
                self._execute(min(target, cpu.now + SLICE * cpu.step))
        return cpu.now < until

    def _advance(self) -> None:
        """Process due events, then let the core catch up."""
        self._catch_up()
        self._follow(self.now)

    def _follow(self, tick: int) -> int:
        """Advance the core to a tick, or to the start of a word in flight; return the tick reached."""
        wires = self.wires
        limit = tick if self.spi.started is None else min(tick, self.spi.started)
        reached = wires.follow(limit)
        while reached < limit and wires.irq == self._irq_level:
            self._drain()
            reached = wires.follow(limit)
        if wires.irq == self._irq_level:
            return tick
        self._irq_level = wires.irq
        letter, pin = self._irq
        self.ports[letter].drive(pin, self._irq_level)
        return reached

    def _drain(self) -> None:
        if isinstance(self.wires.core, Engine):
            events = self.wires.core.drain()
            if len(events):
                self._events.append(events)

    def _take_exception(self) -> bool:
        waiting = self.exceptions.pending & self.exceptions.enabled
        if not waiting or self._locked_up:
            return False
        masks = self._c.passo_cpu_masks(self.cpu)
        number = self.exceptions.next(masks)
        if number is None:
            self._asleep = self._asleep and not self.exceptions.wakes(masks)
            return False
        self._enter(number, masks)
        return True

    def _enter(self, number: int, masks: int) -> None:
        if masks >> 8 & 3:
            raise MachineError("CONTROL is not 0: process stack and unprivileged threads are not modelled")
        self._asleep = False
        self.exceptions.enter(number)
        table = self.peripherals["SCB"].value["VTOR"]
        handler = int.from_bytes(self.read_memory(table + 4 * number, 4), "little")
        self._c.passo_cpu_enter(self.cpu, number, handler)

    def _execute(self, deadline: int) -> None:
        c, cpu = self._c, self.cpu
        cpu.deadline = deadline
        cpu.watch_masks = bool(self.exceptions.pending & self.exceptions.enabled)
        stop = c.passo_cpu_run(cpu)
        if self._error is not None:
            error, self._error = self._error, None
            raise error
        if stop == c.PASSO_CPU_SLEEP:
            self._asleep = True
        elif stop == c.PASSO_CPU_EXCEPTION_RETURN:
            self._at_exception_return()
            self.exceptions.leave()
            if not c.passo_cpu_return(cpu):
                raise MachineError(f"{self._place()}: a return that is not modelled, or from a broken stack")
        elif stop == c.PASSO_CPU_BREAKPOINT:
            self._at_breakpoint()
        elif stop == c.PASSO_CPU_SUPERVISOR_CALL:
            self.exceptions.pending |= 1 << SUPERVISOR_CALL
        elif stop == c.PASSO_CPU_FAULT:
            self._hard_fault()

    def _hard_fault(self) -> None:
        """Take a hard fault."""
        cpu = self.cpu
        what = STOP_MESSAGES.get(cpu.fault)
        self.faults.append(
            f"{self._place()}: " + (f"{what} 0x{cpu.fault_address:08X}" if what else f"exception {cpu.fault}")
        )
        if self.exceptions.running(self._c.passo_cpu_masks(cpu) & 2) <= -1:
            self._locked_up = True  # a fault in the fault handler: until reset
        else:
            self._enter(HARD_FAULT, self._c.passo_cpu_masks(cpu))

    def _place(self) -> str:
        address = self.cpu.address
        return f"pc 0x{address:08X} ({self.elf.function_at(address)}), {self.seconds:.6f} s"

    # -------------------------------------------------------------------------- for the peripherals ----

    def _on_read(self, _: Any, address: int, size: int) -> int:
        try:
            if self.cpu.now >= self._next_due:
                self._catch_up()
                self._reschedule()
            return self.read(address, size)  # a read never schedules an earlier event
        except Exception as error:
            return self._fail(error)

    def _on_write(self, _: Any, address: int, size: int, value: int) -> None:
        try:
            if self.cpu.now >= self._next_due:
                self._catch_up()
            self.write(address, size, value)
            self._reschedule()
        except Exception as error:
            self._fail(error)

    def _on_program(self, _: Any, address: int, size: int, value: int) -> bool:
        try:
            done = self.flash.program(address, size, value)
            self._reschedule()
            return done
        except Exception as error:
            return bool(self._fail(error))

    def stall(self, ticks: int) -> None:
        """The processor stands still, after the present instruction."""
        self.cpu.now += ticks

    def _catch_up(self) -> None:
        """Process the due events of peripherals, so that they are up to date before an access."""
        now = self.cpu.now
        for peripheral in self._timed:
            while peripheral.due <= now:
                peripheral.advance(now)
        self._next_due = min([p.due for p in self._timed])

    def _fail(self, error: Exception) -> int:
        """Record an exception of a callback, which cannot raise, and stop the processor."""
        if isinstance(error, MachineError):
            error = MachineError(f"{self._place()}: {error}")
        if self._error is None:
            self._error = error
        self.cpu.deadline = self.cpu.now
        return 0

    def read(self, address: int, size: int) -> int:
        """Load by processor or DMA."""
        if address < 0x40000000:
            return int.from_bytes(self.read_memory(address, size), "little")
        peripheral = self._peripheral(address)
        word = peripheral.read((address & ~3) - peripheral.base)
        return word >> 8 * (address & 3) & ((1 << 8 * size) - 1)

    def write(self, address: int, size: int, value: int) -> None:
        """Store by processor or DMA."""
        if address < 0x40000000:
            self.write_memory(address, value.to_bytes(size, "little"))
            return
        peripheral = self._peripheral(address)
        offset, shift = (address & ~3) - peripheral.base, 8 * (address & 3)
        if size < 4 and address >= 0xE0000000:
            mask = ((1 << 8 * size) - 1) << shift
            value = peripheral.read(offset) & ~mask | value << shift
        elif shift:
            raise MachineError(f"{peripheral.name}: write of {size} bytes to 0x{address:08X}")
        peripheral.write(offset, value)

    def _peripheral(self, address: int) -> Peripheral:
        """The peripheral at an address; raises MachineError."""
        peripheral = self._bus.find(address)
        if peripheral.name in ENABLES and not self.rcc.enabled(peripheral.name):
            raise MachineError(f"{peripheral.name} (0x{address:08X}) has no clock")
        return peripheral

    def _reschedule(self) -> None:
        """Stop after this instruction if an exception is pending, and at the next event."""
        cpu = self.cpu
        if self.exceptions.pending & self.exceptions.enabled:
            cpu.watch_masks = True
            if self.exceptions.next(self._c.passo_cpu_masks(cpu)) is not None:
                cpu.deadline = cpu.now
        due = self._next_due = min([p.due for p in self._timed])
        if due < cpu.deadline:
            cpu.deadline = due
        if self._reset_cause is not None:
            cpu.deadline = cpu.now

    def set_clocks(self, clocks: Clocks) -> None:
        """Set the system clocks."""
        self.flash.check(clocks.hclk)
        self.clocks = clocks
        self.cpu.step = clocks.hclk
        for peripheral in self.peripherals.values():
            peripheral.clock_changed()

    def request_reset(self, cause: str) -> None:
        """Reset the chip after this instruction."""
        self._reset_cause = cause

    def _reset(self, cause: str) -> None:
        """Reset the chip; the Passo core is not affected."""
        self.resets.append((self.now, cause))
        self.rcc.note_reset(cause)
        self.exceptions.reset()
        for peripheral in self.peripherals.values():
            peripheral.reset()
        self._reset_cause = None  # until here chip select may be cut off in a word
        self._asleep = self._locked_up = False
        self._next_due = self.now
        self._c.passo_cpu_reset(self.cpu)

    def dma_enabled(self, channel: int) -> None:
        """A DMA channel was enabled: serve waiting requests."""
        (self.spi if channel in (RECEIVE_CHANNEL, RECEIVE_CHANNEL + 1) else self.usart).dma_enabled()

    def receive(self, character: int, tick: int) -> None:
        """The terminal receives a character."""
        self.output += chr(character)
        self.output_ticks.append(tick)

    def pin_changed(self, letter: str, pin: int, level: int) -> None:
        """A pin has a new level."""
        if self.afio.port_of(pin) == letter:
            self.exti.edge(pin, level)
        if (letter, pin) == ("C", 13):
            self.led.append((self.now, level))
        output, _ = self.ports[letter].mode(pin)
        if (letter, pin) == self._select and (selected := output and level == 0) != self._chip_selected:
            if self.spi.started is not None and self._reset_cause is None:
                raise MachineError("chip select changes in the middle of a word")
            self._chip_selected = selected
            self._follow(self.now)
            self.wires.select(selected)

    def exchange(self, mosi: bytes, tick: int, half_period: int) -> bytes:
        """Exchange the word that SPI1 started to send at a tick."""
        port = self.ports["A"]
        for pin in (5, 7):
            if port.mode(pin) != (True, ALTERNATE_PUSH_PULL):
                raise MachineError(f"SPI1 sends, but PA{pin} is not its push-pull output")
        if port.mode(6)[0]:
            raise MachineError("SPI1 sends, but PA6 is not an input")
        self.wires.floating = port.level(6)
        core = self.wires.core
        if isinstance(core, Engine) and half_period * core.clock_hz < TICKS_PER_SECOND:
            raise MachineError("SCLK is too fast for the core's clock: less than a clock at each level")
        while self.wires.follow(tick) < tick:
            self._drain()
        return self.wires.exchange(mosi, half_period)


def _pin(name: str) -> tuple[str, int]:
    """Parse a pin name: PA4 is ("A", 4)."""
    if len(name) < 3 or name[0] != "P" or name[1] not in PORTS or not name[2:].isdigit():
        raise ValueError(f"no pin {name}")
    return name[1], int(name[2:])
