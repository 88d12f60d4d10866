# SPDX-License-Identifier: MIT
"""ELF files: segments to load, and symbols."""

import struct
from bisect import bisect_right
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

PT_LOAD = 1
SHT_SYMTAB = 2
STT_FUNC = 2
ARM = 40


class ElfError(Exception):
    """The file is not an executable for the microcontroller."""


@dataclass(frozen=True)
class Elf:
    """A linked executable."""

    path: Path
    segments: list[tuple[int, bytes]] = field(default_factory=list)  # load address, contents
    symbols: dict[str, int] = field(default_factory=dict)  # functions without the Thumb bit
    functions: dict[int, str] = field(default_factory=dict)  # by address

    @classmethod
    def read(cls, path: Path) -> "Elf":
        """Read a file; raises ElfError."""
        try:
            data = path.read_bytes()
        except OSError as error:
            raise ElfError(f"{path}: {error.strerror}") from None
        try:
            return cls._parse(path, data)
        except (struct.error, IndexError, UnicodeDecodeError):
            raise ElfError(f"{path}: the file is damaged") from None

    @classmethod
    def _parse(cls, path: Path, data: bytes) -> "Elf":
        if data[:6] != b"\x7fELF\x01\x01" or struct.unpack_from("<H", data, 18)[0] != ARM:
            raise ElfError(f"{path}: not an ELF file for a 32-bit ARM")
        elf = cls(path)
        phoff, shoff, _, _, phsize, phcount, shsize, shcount = struct.unpack_from("<IIIHHHHH", data, 28)
        for i in range(phcount):
            kind, offset, _, load_address, size = struct.unpack_from("<IIIII", data, phoff + i * phsize)
            if kind == PT_LOAD and size:
                elf.segments.append((load_address, data[offset : offset + size]))
        sections = [struct.unpack_from("<10I", data, shoff + i * shsize) for i in range(shcount)]
        for section in sections:
            if section[1] == SHT_SYMTAB:
                elf._read_symbols(data, section, sections[section[6]])
        return elf

    def _read_symbols(self, data: bytes, table: tuple[int, ...], strings: tuple[int, ...]) -> None:
        for at in range(table[4], table[4] + table[5], 16):
            name_at, value, _, info = struct.unpack_from("<IIIB", data, at)
            start = strings[4] + name_at
            name = data[start : data.index(b"\0", start)].decode()
            function = info & 15 == STT_FUNC
            if name and not name.startswith("$"):
                self.symbols[name] = value & ~1 if function else value
                if function:
                    self.functions[value & ~1] = name

    @cached_property
    def _addresses(self) -> list[int]:
        return sorted(self.functions)

    def function_at(self, address: int) -> str:
        """Name of the function that contains an address, or the address itself."""
        at = bisect_right(self._addresses, address)
        return self.functions[self._addresses[at - 1]] if at else f"0x{address:08X}"
