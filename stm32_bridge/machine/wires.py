# SPDX-License-Identifier: MIT
"""The wires between microcontroller and core, and what can be wrong with them."""

import random
from typing import Protocol

from passo import registers as r
from passo.frame import CRC_START, DATA, crc


class CorePins(Protocol):
    """The core's end: `passo.engine.Engine`, or a simulator. Ticks count from the reset of the core."""

    @property
    def irq(self) -> int:
        """Levels of the irq pins."""

    def follow(self, tick: int) -> int:
        """Let time pass up to a tick, or less: until irq changes; return the tick reached."""

    def select(self, selected: bool) -> None:
        """Chip select falls or rises now."""

    def exchange(self, mosi: bytes, half_period: int) -> bytes:
        """SPI mode 0 from now on; SCLK stays `half_period` ticks at each level."""


class Wires:
    """Carries bytes; faults are injected by setting the attributes. Without a core MISO floats."""

    def __init__(self, core: CorePins | None, seed: int = 1):
        self.core = core
        self.floating = 1  # level of MISO when nobody drives it
        self.flip_rate = 0.0  # of the bits, in both directions
        self.stuck: int | None = None  # level of MISO
        self.pretend: dict[int, int] = {}  # what registers seem to hold: a core of another kind
        self.flipped = 0
        self.carried = 0  # bytes
        self.frames = 0
        self._random = random.Random(seed)
        self._mosi = self._miso = b""  # of this chip select, unspoilt

    @property
    def irq(self) -> int:
        """Level of the interrupt pin: that of any channel."""
        return int(self.core is not None and self.core.irq != 0)

    def follow(self, tick: int) -> int:
        """Let the core's time pass; return the tick reached."""
        return tick if self.core is None else self.core.follow(tick)

    def select(self, selected: bool) -> None:
        """Chip select."""
        if selected:
            self.frames += 1
            self._mosi = self._miso = b""
        if self.core is not None:
            self.core.select(selected)

    def exchange(self, mosi: bytes, half_period: int) -> bytes:
        """Some bytes of a frame."""
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
        """The last bytes of the reply as a core with other contents of `pretend` would have sent them."""
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
