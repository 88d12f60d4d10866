# SPDX-License-Identifier: MIT
"""The processor: memories, instruction counts, measurement of calls."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from passo.native import ffi, processor

from passo_stm32.bus import MachineError
from passo_stm32.elf import Elf

FLASH, FLASH_SIZE = 0x08000000, 64 << 10  # the size unless the program is linked for another
RAM, RAM_SIZE = 0x20000000, 20 << 10
UNTOUCHED = 0xA5  # contents of RAM at power-on
REGISTERS, LINK_REGISTER = 17, 14  # of passo_cpu_registers()
EXCEPTION_RETURN = 0xFFFFFFF0  # values of LR from here on
Read = Callable[[Any, int, int], int]
Write = Callable[[Any, int, int, int], None]
Program = Callable[[Any, int, int, int], bool]


class Processor:
    """A processor (sim/engine/passo_cpu.h) with an ELF file in its flash, as far as that goes."""

    def __init__(self, elf: Path, read: Read, write: Write, program: Program, flash_size: int | None = None):
        self.elf = Elf.read(elf)
        self.flash_size = flash_size or self.elf.symbols.get("FLASH_BYTES", FLASH_SIZE)
        self._measured: list[int] = []
        self._profile_measured = False
        self._make_processor(read, write, program)

    @property
    def instructions(self) -> int:
        """Instructions executed since power-on."""
        return self.cpu.instructions

    def _make_processor(self, read: Read, write: Write, program: Program) -> None:
        c = self._c = processor()
        self._read_callback = ffi().callback("uint32_t(void *, uint32_t, uint32_t)", read)
        self._write_callback = ffi().callback("void(void *, uint32_t, uint32_t, uint32_t)", write)
        self._program_callback = ffi().callback("bool(void *, uint32_t, uint32_t, uint32_t)", program)
        callbacks = self._read_callback, self._write_callback, self._program_callback
        config = ffi().new("struct passo_cpu_config *", (self.flash_size, RAM_SIZE, *callbacks, ffi().NULL))
        cpu = c.passo_cpu_create(config)
        if cpu == ffi().NULL:
            raise MachineError("unicorn has no Cortex-M3")
        self.cpu = ffi().gc(cpu, c.passo_cpu_destroy)
        self.write_memory(RAM, bytes([UNTOUCHED]) * RAM_SIZE)
        for address, data in self.elf.segments:
            self.write_memory(address, data[: FLASH + self.flash_size - address])

    def profile(self, on: bool = True) -> None:
        """Start or stop counting the instructions of each address."""
        self.cpu.profile = self._start_profile() if on else ffi().NULL

    def _start_profile(self) -> Any:
        self._counters = ffi().new("uint32_t[]", self.flash_size // 2)
        return self._counters

    def profiled(self) -> dict[str, int]:
        """Instructions by function since `profile`, the largest first."""
        counts = np.frombuffer(ffi().buffer(self._counters), np.uint32)
        found: dict[str, int] = {}
        for at in np.flatnonzero(counts):
            name = self.elf.function_at(FLASH + 2 * int(at))
            found[name] = found.get(name, 0) + int(counts[at])
        return dict(sorted(found.items(), key=lambda item: -item[1]))

    def measure(self, function: str, profile: bool = False) -> None:
        """Count the instructions of the next call of a function, including its callees and interrupts.

        With `profile` these instructions are also counted by address.
        """
        self._measured: list[int] = []
        self._profile_measured = profile
        self.cpu.breakpoint = self.elf.symbols[function]

    def measured(self) -> int | None:
        """The result of `measure`; None until the function has returned."""
        return self._measured[1] - self._measured[0] if len(self._measured) == 2 else None

    def stack_used(self) -> int:
        """Bytes from the top of RAM to the lowest byte ever written, except for the guard word."""
        names = [name for name in ("ram_used_end", "_ebss") if name in self.elf.symbols]
        bottom = self.elf.symbols[names[0]] if names else RAM
        stack = self.read_memory(bottom, RAM + RAM_SIZE - bottom)
        gap = bytes([UNTOUCHED]) * 64
        return len(stack) - max(0, stack.rfind(gap) + len(gap))

    def read_memory(self, address: int, size: int) -> bytes:
        """Read bytes of flash or RAM."""
        return bytes(ffi().buffer(self._memory(address, size), size))

    def write_memory(self, address: int, data: bytes) -> None:
        """Write bytes of flash or RAM; code that has been executed must not be changed."""
        ffi().memmove(self._memory(address, len(data)), data, len(data))

    def _memory(self, address: int, size: int) -> Any:
        left = ffi().new("uint32_t *")
        memory = self._c.passo_cpu_memory(self.cpu, address, left)
        if memory == ffi().NULL or left[0] < size:
            raise MachineError(f"there is no memory of {size} bytes at 0x{address:08X}")
        return memory

    def _at_breakpoint(self) -> None:
        """The measured function starts, or has returned."""
        self._measured.append(self.instructions)
        if self._profile_measured:
            self.cpu.profile = ffi().NULL if len(self._measured) == 2 else self._start_profile()
        if len(self._measured) == 1:
            registers = ffi().new("uint32_t[]", REGISTERS)
            self._c.passo_cpu_registers(self.cpu, registers)
            self.cpu.breakpoint = registers[LINK_REGISTER] & ~1

    def _at_exception_return(self) -> None:
        """A measured handler has returned."""
        if self.cpu.breakpoint >= EXCEPTION_RETURN:
            self.cpu.breakpoint = 0
            self._at_breakpoint()
