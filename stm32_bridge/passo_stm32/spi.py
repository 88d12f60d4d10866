# SPDX-License-Identifier: MIT
"""SPI1 as a full-duplex master in mode 0, 8 or 16 bits, with polling, interrupts or DMA."""

from passo_stm32.bus import NEVER, MachineError, Peripheral, Register

RECEIVE_CHANNEL, TRANSMIT_CHANNEL, INTERRUPT = 2, 3, 35
PHASE, POLARITY, MASTER, ENABLE, LSB_FIRST, SELECT_LEVEL, SELECT_BY_SOFTWARE, WIDE = 0, 1, 2, 6, 7, 8, 9, 11
RECEIVE_DMA, TRANSMIT_DMA, RECEIVED_INTERRUPT, EMPTY_INTERRUPT = 0, 1, 6, 7
RECEIVED, EMPTY, OVERRUN, BUSY = 0, 1, 6, 7


class Spi(Peripheral):
    """A word is in flight from `started` to `due`; it is exchanged at its end.

    Consecutive words that DMA sends and receives are exchanged together, at the end of the last one.
    """

    name = "SPI1"
    base = 0x40013000
    registers = (
        Register("CR1", 0x00, 0x0B7C),
        Register("CR2", 0x04, 0xE3 & ~0x20),
        Register("SR", 0x08, 0, 1 << EMPTY),
        Register("DR", 0x0C, 0xFFFF),
    )

    def reset(self) -> None:
        """Disable."""
        super().reset()
        self.started: int | None = None
        self._shifting = self._waiting = self._received = 0
        self._burst = 1  # words until `due`
        self._status_read = False

    def write_cr1(self, value: int) -> None:
        """Check that the configuration is modeled."""
        if value >> ENABLE & 1:
            if (
                not value >> MASTER & 1
                or not value >> SELECT_BY_SOFTWARE & 1
                or not value >> SELECT_LEVEL & 1
            ):
                raise MachineError(
                    "SPI1 is modeled as a master with chip select by software (MSTR, SSM, SSI)"
                )
        elif self.started is not None:
            raise MachineError("SPI1 is disabled while it is busy")
        self.value["CR1"] = value

    def write_cr2(self, value: int) -> None:
        """Enable DMA and interrupts."""
        self.value["CR2"] = value
        self._requests()

    def read_dr(self) -> int:
        """Read the received word."""
        self.set_bit("SR", RECEIVED, False)
        if self._status_read:
            self.set_bit("SR", OVERRUN, False)
        self._interrupt()
        return self._received

    def read_sr(self) -> int:
        """Read the flags."""
        self._status_read = bool(self.bit("SR", OVERRUN))
        return self.value["SR"]

    def write_dr(self, value: int) -> None:
        """Send a word."""
        if not self.bit("CR1", ENABLE):
            raise MachineError("SPI1.DR is written while SPI1 is disabled")
        if not self.bit("SR", EMPTY):
            raise MachineError("SPI1.DR is written before TXE: a word is lost")
        self._waiting = value
        self.set_bit("SR", EMPTY, False)
        if self.started is None:
            self._load(self.machine.now)
        self._requests()

    @property
    def half_period(self) -> int:
        """Ticks per SCLK level."""
        return self.machine.clocks.pclk2 << (self.value["CR1"] >> 3 & 7)

    @property
    def bits(self) -> int:
        """Bits per word."""
        return 16 if self.bit("CR1", WIDE) else 8

    @property
    def _duration(self) -> int:
        """Ticks per word."""
        return 2 * self.bits * self.half_period

    def _load(self, now: int) -> None:
        self._shifting = self._waiting
        self.started = now
        self.due = now + self._duration
        self._burst = 1
        self.set_bit("SR", EMPTY, True)
        self.set_bit("SR", BUSY, True)

    def _extend(self) -> None:
        """Extend the transfer to all words that DMA sends, if it receives as many."""
        if self.started is None or self.value["CR2"] & 3 != 3 or self.bit("SR", RECEIVED):
            return
        dma, size = self.machine.dma, self.bits // 8
        waiting = not self.bit("SR", EMPTY)
        if waiting and dma.block(RECEIVE_CHANNEL) and dma.item_size(RECEIVE_CHANNEL) == size:
            same = dma.item_size(TRANSMIT_CHANNEL) == size
            follow = 1 + (dma.block(TRANSMIT_CHANNEL) if same else 0)
            self._burst = min(1 + follow, dma.block(RECEIVE_CHANNEL))
            self.due = self.started + self._burst * self._duration

    def advance(self, now: int) -> None:
        """A word or a burst has ended."""
        end, size, started = self.due, self.bits // 8, self.started
        mask = (1 << self.bits) - 1
        sent = (self._shifting & mask).to_bytes(size, "big")
        if self._burst > 1:
            sent += (self._waiting & mask).to_bytes(size, "big")
            sent += self._fetch(self._burst - 2, size)
        received = self.machine.exchange(sent, started, self.half_period)
        if self._burst > 1:
            self._store(received[:-size], size)
            self.set_bit("SR", EMPTY, True)
        self._take(int.from_bytes(received[-size:], "big"))
        self.started, self.due = None, NEVER
        if not self.bit("SR", EMPTY):
            self._load(end)
        else:
            self.set_bit("SR", BUSY, False)
        self._requests()

    def _take(self, word: int) -> None:
        if self.bit("SR", RECEIVED):
            self.set_bit("SR", OVERRUN, True)
        else:
            self._received = word
            self.set_bit("SR", RECEIVED, True)

    def _fetch(self, count: int, size: int) -> bytes:
        """The next words that DMA sends, in the order on the wire."""
        if not count:
            return b""
        address = self.machine.dma.serve_block(TRANSMIT_CHANNEL, count)
        return _swap(self.machine.read_memory(address, count * size), size)

    def _store(self, received: bytes, size: int) -> None:
        """Store words that DMA receives."""
        address = self.machine.dma.serve_block(RECEIVE_CHANNEL, len(received) // size)
        self.machine.write_memory(address, _swap(received, size))

    def _requests(self) -> None:
        """Raise DMA and interrupt requests."""
        dma = self.machine.dma
        if self.bit("CR2", RECEIVE_DMA) and self.bit("SR", RECEIVED):
            dma.request(RECEIVE_CHANNEL)
        if self.bit("CR2", TRANSMIT_DMA) and self.bit("SR", EMPTY) and self.bit("CR1", ENABLE):
            dma.request(TRANSMIT_CHANNEL)
        self._extend()
        self._interrupt()

    def dma_enabled(self) -> None:
        """A DMA channel was enabled: it may serve a waiting request."""
        self._requests()

    def _interrupt(self) -> None:
        wanted = self.bit("CR2", RECEIVED_INTERRUPT) & self.bit("SR", RECEIVED) | self.bit(
            "CR2", EMPTY_INTERRUPT
        ) & self.bit("SR", EMPTY)
        self.machine.exceptions.set_line(INTERRUPT, wanted)


def _swap(data: bytes, size: int) -> bytes:
    """Swap bytes between memory (low byte first) and wire (high byte first)."""
    return data if size == 1 else b"".join(data[i : i + 2][::-1] for i in range(0, len(data), 2))
