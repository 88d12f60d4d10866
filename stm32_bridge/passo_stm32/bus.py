# SPDX-License-Identifier: MIT
"""Peripherals and their registers. Access to anything that is not modeled is an error."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from passo_stm32.chip import Chip

TICKS_PER_SECOND = 576_000_000
NEVER = 1 << 63  # ticks
BLOCK_LOG2 = 8  # a peripheral owns whole blocks of 256 bytes
WORD = 0xFFFFFFFF
SYSTEM = 0xE0000000  # from here on: peripherals of the processor, which have bytes


class MachineError(Exception):
    """The firmware does something that is not modeled, or that the microcontroller forbids."""


@dataclass(frozen=True)
class Register:
    """A register: its offset, the mask of bits that software may write, and its value after reset."""

    name: str
    offset: int
    writable: int = 0
    reset: int = 0


class Peripheral:
    """A block of registers. Subclasses add `read_NAME` and `write_NAME` for registers with side effects."""

    name: str
    base: int
    size = 0x400
    registers: Sequence[Register] = ()
    due = NEVER  # tick of the next call of `advance`

    def __init__(self, machine: "Chip"):
        self.machine = machine
        self._at = {register.offset: register for register in self.registers}
        self._readers = {r.offset: getattr(self, f"read_{r.name.lower()}", None) for r in self.registers}
        self._writers = {r.offset: getattr(self, f"write_{r.name.lower()}", None) for r in self.registers}
        self.value: dict[str, int] = {}
        self.reset()

    def reset(self) -> None:
        """Reset the peripheral."""
        self.value = {register.name: register.reset for register in self.registers}
        self.due = NEVER

    def advance(self, now: int) -> None:
        """Process the events due at or before tick `now`."""

    def clock_changed(self) -> None:
        """Called when the bus clock has changed."""

    def read(self, offset: int) -> int:
        """Read the register at an offset."""
        register = self._at.get(offset)
        if register is None:
            raise MachineError(f"read of an unmodeled register: {self.name} + 0x{offset:02X}")
        reader = self._readers[offset]
        return reader() if reader else self.value[register.name]

    def write(self, offset: int, value: int) -> None:
        """Write the register at an offset."""
        register = self._at.get(offset)
        if register is None:
            raise MachineError(f"write to an unmodeled register: {self.name} + 0x{offset:02X} = 0x{value:X}")
        fixed = ~register.writable & WORD
        if (value ^ self.value[register.name]) & fixed & value:
            bits = (value ^ self.value[register.name]) & fixed & value
            raise MachineError(f"{self.name}.{register.name}: bits 0x{bits:X} are not modeled")
        value = (value & register.writable) | (self.value[register.name] & fixed)
        writer = self._writers[offset]
        if writer:
            writer(value)
        else:
            self.value[register.name] = value

    def bit(self, register: str, number: int) -> int:
        """A bit of a register."""
        return self.value[register] >> number & 1

    def set_bit(self, register: str, number: int, level: object) -> None:
        """Change a bit of a register."""
        mask = 1 << number
        self.value[register] = self.value[register] | mask if level else self.value[register] & ~mask


class Bus:
    """Address decoder."""

    def __init__(self, has_clock: Callable[[str], bool]) -> None:
        self._blocks: dict[int, Peripheral] = {}
        self._has_clock = has_clock  # a peripheral of this name

    def add(self, peripheral: Peripheral) -> None:
        """Map a peripheral."""
        first = peripheral.base >> BLOCK_LOG2
        for block in range(first, first + max(1, peripheral.size >> BLOCK_LOG2)):
            self._blocks[block] = peripheral

    def read(self, address: int, size: int) -> int:
        """Load bytes of a word; raises MachineError."""
        peripheral = self._find(address)
        word = peripheral.read((address & ~3) - peripheral.base)
        return word >> 8 * (address & 3) & ((1 << 8 * size) - 1)

    def write(self, address: int, size: int, value: int) -> None:
        """Store bytes of a word; raises MachineError."""
        peripheral = self._find(address)
        offset, shift = (address & ~3) - peripheral.base, 8 * (address & 3)
        if size < 4 and address >= SYSTEM:
            mask = ((1 << 8 * size) - 1) << shift
            value = peripheral.read(offset) & ~mask | value << shift
        elif shift:
            raise MachineError(f"{peripheral.name}: write of {size} bytes to 0x{address:08X}")
        peripheral.write(offset, value)

    def _find(self, address: int) -> Peripheral:
        peripheral = self._blocks.get(address >> BLOCK_LOG2)
        if peripheral is None:
            raise MachineError(f"nothing is modeled at 0x{address:08X}")
        if not self._has_clock(peripheral.name):
            raise MachineError(f"{peripheral.name} (0x{address:08X}) has no clock")
        return peripheral
