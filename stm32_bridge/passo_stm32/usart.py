# SPDX-License-Identifier: MIT
"""USART1, 8N1, connected to the terminal."""

from collections import deque

from passo_stm32.bus import NEVER, TICKS_PER_SECOND, MachineError, Peripheral, Register

INTERRUPT, TRANSMIT_CHANNEL, RECEIVE_CHANNEL = 37, 4, 5
FRAMING, OVERRUN, RECEIVED, COMPLETE, EMPTY = 1, 3, 5, 6, 7
RECEIVER, TRANSMITTER, ENABLE = 2, 3, 13
ERROR_INTERRUPT, RECEIVE_DMA, TRANSMIT_DMA = 0, 6, 7
BITS = 10  # of a character, with start and stop bit
TOLERANCE = 0.04  # largest relative difference between the baud rates


class Usart(Peripheral):
    """Characters take ten bit times in both directions."""

    name = "USART1"
    base = 0x40013800
    registers = (
        Register("SR", 0x00, 0x360, 0xC0),
        Register("DR", 0x04, 0x1FF),
        Register("BRR", 0x08, 0xFFFF),
        Register("CR1", 0x0C, 0x21EC & ~0x100),
        Register("CR2", 0x10),
        Register("CR3", 0x14, 0xC1),
        Register("GTPR", 0x18),
    )

    def reset(self) -> None:
        """Disable. Characters that the terminal has still to send are kept."""
        super().reset()
        # end, character, damaged
        self._incoming: deque[tuple[int, int, bool]] = getattr(self, "_incoming", deque())
        self._sending: int | None = None
        self._sent_at = NEVER
        self._waiting = self._received = 0
        self._status_read = 0
        self._schedule()

    def type(self, text: bytes, baud: int, now: int, *, damaged: bool = False) -> None:
        """Let the terminal send characters; damaged ones arrive with a framing error."""
        at = max([now, *(end for end, *_ in list(self._incoming)[-1:])])
        for i, character in enumerate(text, 1):
            self._incoming.append((at + i * BITS * TICKS_PER_SECOND // baud, character, damaged))
        self._schedule()

    @property
    def typing(self) -> bool:
        """Whether the terminal is still sending."""
        return bool(self._incoming)

    @property
    def baud(self) -> float:
        """The baud rate set in BRR."""
        return TICKS_PER_SECOND / (self.machine.clocks.pclk2 * max(1, self.value["BRR"]))

    def _schedule(self) -> None:
        self.due = min(self._sent_at, self._incoming[0][0] if self._incoming else NEVER)

    def _matches(self) -> bool:
        return abs(self.baud / self.machine.baud - 1) <= TOLERANCE

    def advance(self, now: int) -> None:
        """A character has been sent or received."""
        if self._sent_at <= now:
            end = self._sent_at
            self.machine.receive(self._sending if self._matches() else 0xFF, end)
            self._sending, self._sent_at = None, NEVER
            if not self.bit("SR", EMPTY):
                self._load(end)
            else:
                self.set_bit("SR", COMPLETE, True)
        while self._incoming and self._incoming[0][0] <= now:
            self._take(*self._incoming.popleft()[1:])
            self._requests()
        self._requests()
        self._schedule()

    def _take(self, character: int, damaged: bool) -> None:
        if not self.bit("CR1", ENABLE) or not self.bit("CR1", RECEIVER):
            return
        if self.bit("SR", RECEIVED):
            self.set_bit("SR", OVERRUN, True)
            return
        matches = self._matches() and not damaged
        self._received = character if matches else character ^ 0xE6
        self.set_bit("SR", FRAMING, not matches)
        self.set_bit("SR", RECEIVED, True)

    def _load(self, now: int) -> None:
        self._sending = self._waiting
        self._sent_at = now + BITS * max(1, self.value["BRR"]) * self.machine.clocks.pclk2
        self.set_bit("SR", EMPTY, True)
        self._schedule()

    def read_sr(self) -> int:
        """Read the flags; reading DR next clears the error flags."""
        self._status_read = self.value["SR"]
        return self.value["SR"]

    def write_sr(self, value: int) -> None:
        """Zeros clear RXNE and TC."""
        for bit in (RECEIVED, COMPLETE):
            if not value >> bit & 1:
                self.set_bit("SR", bit, False)
        self._requests()

    def read_dr(self) -> int:
        """Read the received character."""
        self.set_bit("SR", RECEIVED, False)
        for bit in (OVERRUN, FRAMING):
            if self._status_read >> bit & 1:
                self.set_bit("SR", bit, False)
        self._status_read = 0
        self._requests()
        return self._received

    def write_dr(self, value: int) -> None:
        """Send a character."""
        if not self.bit("CR1", ENABLE) or not self.bit("CR1", TRANSMITTER):
            raise MachineError("USART1.DR is written while the transmitter is disabled")
        if not self.bit("SR", EMPTY):
            raise MachineError("USART1.DR is written before TXE: a character is lost")
        self._waiting = value & 0xFF
        self.set_bit("SR", EMPTY, False)
        self.set_bit("SR", COMPLETE, False)
        if self._sending is None:
            self._load(self.machine.now)
        self._requests()

    def write_brr(self, value: int) -> None:
        """Set the baud rate; not while a character is being sent."""
        if self._sending is not None:
            raise MachineError("USART1.BRR is written while a character is being sent")
        self.value["BRR"] = value

    def write_cr1(self, value: int) -> None:
        """Enable bits and interrupts."""
        self.value["CR1"] = value
        self._requests()

    def write_cr3(self, value: int) -> None:
        """Enable DMA."""
        self.value["CR3"] = value
        self._requests()

    def dma_enabled(self) -> None:
        """A DMA channel was enabled."""
        self._requests()

    def _requests(self) -> None:
        dma = self.machine.dma
        if self.bit("CR3", RECEIVE_DMA) and self.bit("SR", RECEIVED):
            dma.request(RECEIVE_CHANNEL)
        if self.bit("CR3", TRANSMIT_DMA) and self.bit("SR", EMPTY) and self.bit("CR1", TRANSMITTER):
            dma.request(TRANSMIT_CHANNEL)
        status, enabled = self.value["SR"], self.value["CR1"]
        wanted = status & enabled & (1 << RECEIVED | 1 << COMPLETE | 1 << EMPTY)
        overrun = status >> OVERRUN & enabled >> RECEIVED & 1
        by_dma = self.bit("CR3", ERROR_INTERRUPT) & self.bit("CR3", RECEIVE_DMA)
        error = by_dma & (status >> FRAMING | status >> OVERRUN) & 1
        self.machine.exceptions.set_line(INTERRUPT, wanted or overrun or error)
