# SPDX-License-Identifier: MIT
"""The wires between microcontroller and core, with fault injection."""

import random
from typing import Protocol

from passo import registers as r
from passo.frame import CRC_START, DATA, crc


class CorePins(Protocol):
    """The core's end: `passo.engine.Engine`, or a simulator. Ticks count from the core reset."""

    @property
    def irq(self) -> int:
        """Levels of the irq pins."""

    def follow(self, tick: int) -> int:
        """Advance to a tick, or until irq changes; return the tick reached."""

    def select(self, selected: bool) -> None:
        """Assert or release chip select now."""

    def exchange(self, mosi: bytes, half_period: int) -> bytes:
        """Exchange bytes in SPI mode 0; each SCLK level lasts `half_period` ticks."""


class Wires:
    """Carries bytes and injects faults according to its attributes. Without a core MISO floats."""

    def __init__(self, core: CorePins | None, seed: int = 1):
        self.core = core
        self.floating = 1  # level of an undriven MISO
        self.flip_rate = 0.0  # bit error rate in both directions
        self.stuck: int | None = None  # level of a stuck MISO
        self.pretend: dict[int, int] = {}  # faked register values by address
        self.flipped = 0
        self.carried = 0  # bytes
        self.frames = 0
        self._random = random.Random(seed)
        self._mosi = self._miso = b""  # of this chip select, without faults

    @property
    def irq(self) -> int:
        """Level of the interrupt pin: OR over all channels."""
        return int(self.core is not None and self.core.irq != 0)

    def follow(self, tick: int) -> int:
        """Advance the core; return the tick reached."""
        return tick if self.core is None else self.core.follow(tick)

    def select(self, selected: bool) -> None:
        """Chip select."""
        if selected:
            self.frames += 1
            self._mosi = self._miso = b""
        if self.core is not None:
            self.core.select(selected)

    def exchange(self, mosi: bytes, half_period: int) -> bytes:
        """Exchange bytes of a frame."""
        self.carried += len(mosi)
        if self.core is None:
            miso = (b"\xff" if self.floating else b"\0") * len(mosi)
        else:
            miso = self.core.exchange(self._spoil(mosi), half_period)
            self._mosi += mosi
            self._miso += miso
            if self.pretend:
                miso = self._pretended(len(mosi))
        if self.stuck is not None:
            return (b"\xff" if self.stuck else b"\0") * len(mosi)
        return self._spoil(miso)

    def _spoil(self, data: bytes) -> bytes:
        if not self.flip_rate:
            return data
        noise = 0
        for bit in range(8 * len(data)):
            if self._random.random() < self.flip_rate:
                noise |= 1 << bit
                self.flipped += 1
        return (int.from_bytes(data, "big") ^ noise).to_bytes(len(data), "big")

    def _pretended(self, length: int) -> bytes:
        """The last bytes of the reply, with the register values of `pretend` and a matching CRC."""
        begin = len(self._mosi) - length
        header = int.from_bytes(self._mosi[:4], "big")
        count, address = header >> 12 & 0xFF, header & 0xFFF
        reply = self._miso
        if header >> 28 == r.Operation.READ:
            words = [int.from_bytes(reply[i : i + 4], "big") for i in range(0, len(reply) - 3, 4)]
            data = words[DATA : DATA + count]
            for i in range(len(data)):
                data[i] = self.pretend.get(address + i, data[i])
            check = [crc([header, *data], CRC_START)] if len(words) > DATA + count else []
            whole = [*words[:DATA], *data, *check, *words[DATA + count + 1 :]]
            reply = b"".join(word.to_bytes(4, "big") for word in whole)
            reply += self._miso[len(reply) :]
        return reply[begin : begin + length]
