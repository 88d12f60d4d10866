# SPDX-License-Identifier: MIT
"""The flash controller: wait states, keys, erasing pages, programming half-words."""

from passo_stm32.bus import TICKS_PER_SECOND, WORD, MachineError, Peripheral, Register

KEYS = (0x45670123, 0xCDEF89AB)
FIRST, PAGE = 0x08000000, 1024
HALF_WORD = 2
ERASED = b"\xff"
PROGRAM, PAGE_ERASE, MASS_ERASE, START, LOCK = 0, 1, 2, 6, 7  # bits of CR
PROGRAM_ERROR, PROTECTION_ERROR, END = 2, 4, 5  # bits of SR; BSY is never seen
ERASE_TIME = TICKS_PER_SECOND // 1000 * 20
PROGRAM_TIME = TICKS_PER_SECOND // 10_000_000 * 525


class Flash(Peripheral):
    """Erases and programs the pages that hold no part of the program.

    The processor stalls meanwhile: it fetches from the same flash. `worn` are pages that fail.
    """

    name = "FLASH"
    base = 0x40022000
    registers = (
        Register("ACR", 0x00, 0x1F, 0x30),
        Register("KEYR", 0x04, WORD),
        Register("SR", 0x0C, 1 << END | 1 << PROTECTION_ERROR | 1 << PROGRAM_ERROR),
        Register("CR", 0x10, 1 << PROGRAM | 1 << PAGE_ERASE | 1 << START | 1 << LOCK, 1 << LOCK),
        Register("AR", 0x14, WORD),
    )
    worn: frozenset[int] = frozenset()  # numbers of pages

    def reset(self) -> None:
        """Lock it."""
        super().reset()
        self._keys = 0  # given so far, of those expected
        self._jammed = False

    def check(self, hclk: int) -> None:
        """Check the wait states: one above 24 MHz, two above 48 MHz."""
        hz = TICKS_PER_SECOND // hclk
        if self.value["ACR"] & 7 < (hz > 24_000_000) + (hz > 48_000_000):
            raise MachineError(f"flash has too few wait states for {hz} Hz")

    def read_keyr(self) -> int:
        """Keys cannot be read."""
        return 0

    def write_keyr(self, value: int) -> None:
        """Both keys unlock CR; a wrong one keeps it locked until the next reset."""
        if self._jammed or not self.bit("CR", LOCK) or value != KEYS[self._keys]:
            self._jammed = True
            self.set_bit("CR", LOCK, True)
            return
        self._keys = (self._keys + 1) % len(KEYS)
        self.set_bit("CR", LOCK, self._keys)

    def write_sr(self, value: int) -> None:
        """Ones clear flags."""
        self.value["SR"] &= ~value

    def write_ar(self, value: int) -> None:
        """The page to be erased; nothing while locked."""
        if not self.bit("CR", LOCK):
            self.value["AR"] = value

    def write_cr(self, value: int) -> None:
        """Modes and start; nothing while locked."""
        if self.bit("CR", LOCK):
            return
        self.value["CR"] = value & ~(1 << START)
        if value >> START & 1:
            if not value >> PAGE_ERASE & 1 or value >> PROGRAM & 1:
                raise MachineError("FLASH.CR: only the erasing of a page can be started")
            self._erase(self.value["AR"])

    def _erase(self, address: int) -> None:
        page = self._page(address, PAGE)
        self._end(ERASE_TIME, page not in self.worn)
        if page not in self.worn:
            self.machine.write_memory(FIRST + page * PAGE, ERASED * PAGE)

    def program(self, address: int, size: int, value: int) -> bool:
        """Store into flash; false: the processor takes a fault."""
        if self.bit("CR", LOCK) or not self.bit("CR", PROGRAM) or size != HALF_WORD:
            return False
        page = self._page(address, size)
        good = page not in self.worn
        if good and value:  # 0 can be written at any time
            good = self.machine.read_memory(address, size) == ERASED * size
        if good:
            self.machine.write_memory(address, value.to_bytes(size, "little"))
        self._end(PROGRAM_TIME, good)
        return True

    def _page(self, address: int, size: int) -> int:
        page = (address - FIRST) // PAGE
        if not self.machine.rcc.bit("CR", 0):
            raise MachineError("flash is changed without the internal oscillator")
        if not 0 <= page < self.machine.flash_size // PAGE:
            raise MachineError(f"there is no flash at 0x{address:08X}")
        begin = FIRST + page * PAGE
        if any(at < begin + PAGE and begin < at + len(data) for at, data in self.machine.elf.segments):
            raise MachineError(f"the program changes itself: {size} bytes at 0x{address:08X}")
        return page

    def _end(self, ticks: int, good: bool) -> None:
        self.machine.stall(ticks)
        self.set_bit("SR", END, good)
        self.set_bit("SR", PROGRAM_ERROR, not good)
