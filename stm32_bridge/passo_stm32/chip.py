# SPDX-License-Identifier: MIT
"""The microcontroller alone: an ELF in flash, peripherals at their addresses, exceptions, resets, time."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from pathlib import Path
from typing import Any

from passo_stm32.bus import TICKS_PER_SECOND, Bus, MachineError, Peripheral
from passo_stm32.crc import Crc
from passo_stm32.dma import Dma
from passo_stm32.flash import Flash
from passo_stm32.gpio import PORTS, Afio, Exti, Gpio
from passo_stm32.iwdg import Debug, Iwdg
from passo_stm32.nvic import HARD_FAULT, SUPERVISOR_CALL, Exceptions, Nvic, SystemControl
from passo_stm32.processor import Processor
from passo_stm32.rcc import ENABLES, Clocks, Rcc
from passo_stm32.spi import RECEIVE_CHANNEL, Spi
from passo_stm32.systick import SysTick
from passo_stm32.usart import Usart

SLICE = 256  # instructions after which the outside catches up while the processor is awake
STOP_MESSAGES = {6: "read", 7: "write to", 8: "fetch from", 12: "write to", 13: "read", 14: "fetch from"}


class Chip(Processor, ABC):
    """A microcontroller without what is at its pins, which `passo_stm32.machine.Machine` adds."""

    baud: int  # of the terminal

    def __init__(self, elf: Path, *, crystal: bool, flash_size: int | None):
        super().__init__(elf, self._on_read, self._on_write, self._on_program, flash_size)
        self.crystal = crystal
        self.resets: list[tuple[int, str]] = []  # tick and cause
        self.faults: list[str] = []  # causes of hard faults
        self.asleep_ticks = 0
        self._asleep = self._locked_up = False
        self._reset_cause: str | None = None
        self._error: Exception | None = None

    def _make_peripherals(self) -> None:
        self.exceptions = Exceptions()
        self.clocks = Clocks()
        self.peripherals: dict[str, Peripheral] = {}
        self._bus = Bus(lambda name: name not in ENABLES or self.rcc.enabled(name))
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

    def _add(self, peripheral: Any) -> Any:
        self.peripherals[peripheral.name] = peripheral
        self._bus.add(peripheral)
        return peripheral

    @property
    def now(self) -> int:
        """Ticks since power-on."""
        return self.cpu.now

    @property
    def seconds(self) -> float:
        """Seconds since power-on."""
        return self.cpu.now / TICKS_PER_SECOND

    # ------------------------------------------------------------------------------------ at the pins ----

    @abstractmethod
    def receive(self, character: int, tick: int) -> None:
        """The terminal receives a character."""

    @abstractmethod
    def pin_changed(self, letter: str, pin: int, level: int) -> None:
        """A pin has a new level."""

    @abstractmethod
    def exchange(self, mosi: bytes, tick: int, half_period: int) -> bytes:
        """Exchange the word that SPI1 started to send at a tick."""

    @abstractmethod
    def _follow(self, tick: int) -> int:
        """Advance the core to a tick, or until an input pin changes; return the tick reached."""

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
            raise MachineError("CONTROL is not 0: process stack and unprivileged threads are not modeled")
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
                raise MachineError(f"{self._place()}: a return that is not modeled, or from a broken stack")
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
        """The processor stalls, after the current instruction."""
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
        return self._bus.read(address, size)

    def write(self, address: int, size: int, value: int) -> None:
        """Store by processor or DMA."""
        if address < 0x40000000:
            self.write_memory(address, value.to_bytes(size, "little"))
        else:
            self._bus.write(address, size, value)

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
