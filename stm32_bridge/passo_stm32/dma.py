# SPDX-License-Identifier: MIT
"""DMA1: each request of a peripheral moves one item between its data register and memory, immediately."""

from passo_stm32.bus import MachineError, Peripheral, Register

CHANNELS = 7
ENABLE, COMPLETE_INTERRUPT, HALF_INTERRUPT, ERROR_INTERRUPT, FROM_MEMORY, CIRCULAR = range(6)
PERIPHERAL_INCREMENT, MEMORY_INCREMENT, PERIPHERAL_SIZE, MEMORY_SIZE, MEMORY_TO_MEMORY = 6, 7, 8, 10, 14
GLOBAL_FLAG, COMPLETE_FLAG, HALF_FLAG = 0, 1, 2


class Dma(Peripheral):
    """Seven channels, 1 to 7."""

    name = "DMA1"
    base = 0x40020000
    registers = (
        Register("ISR", 0x00),
        Register("IFCR", 0x04, 0x0FFFFFFF),
        *(
            Register(f"{name}{n}", 0x08 + 20 * (n - 1) + offset, writable)
            for n in range(1, CHANNELS + 1)
            for name, offset, writable in (
                ("CCR", 0, 0x3FBF),
                ("CNDTR", 4, 0xFFFF),
                ("CPAR", 8, 0xFFFFFFFF),
                ("CMAR", 12, 0xFFFFFFFF),
            )
        ),
    )

    def reset(self) -> None:
        """Disable all channels."""
        super().reset()
        self._done = [0] * (CHANNELS + 1)  # items transferred in this round
        self._round = [0] * (CHANNELS + 1)

    def write(self, offset: int, value: int) -> None:
        """All channels have the same registers; those of an enabled channel must not be changed."""
        if offset < 0x08:
            super().write(offset, value)
            return
        channel, which = (offset - 0x08) // 20 + 1, (offset - 0x08) % 20
        if which and self.bit(f"CCR{channel}", ENABLE):
            raise MachineError(f"DMA1 channel {channel} is changed while it is enabled")
        was = self.value.get(f"CCR{channel}", 0) & 1
        super().write(offset, value)
        if which == 0 and value & 1 and not was:
            self._done[channel] = 0
            self._round[channel] = self.value[f"CNDTR{channel}"]
            self.machine.dma_enabled(channel)
        self._request(channel)

    def write_ifcr(self, value: int) -> None:
        """Ones clear flags; the global flag clears all flags of its channel."""
        for channel in range(1, CHANNELS + 1):
            flags = value >> 4 * (channel - 1) & 15
            flags = 15 if flags & 1 else flags
            self.value["ISR"] &= ~(flags << 4 * (channel - 1))
            self._request(channel)

    def ready(self, channel: int) -> bool:
        """Whether a request would be served."""
        return bool(self.bit(f"CCR{channel}", ENABLE) and self.value[f"CNDTR{channel}"])

    def request(self, channel: int) -> bool:
        """Move one item; return whether the channel served the request."""
        if not self.ready(channel):
            return False
        control = self.value[f"CCR{channel}"]
        sizes = [1 << (control >> at & 3) for at in (PERIPHERAL_SIZE, MEMORY_SIZE)]
        places = [self.value[f"CPAR{channel}"], self.value[f"CMAR{channel}"]]
        for i, bit in enumerate((PERIPHERAL_INCREMENT, MEMORY_INCREMENT)):
            if control >> bit & 1:
                places[i] += self._done[channel] * sizes[i]
        source, target = (1, 0) if control >> FROM_MEMORY & 1 else (0, 1)
        value = self.machine.read(places[source], sizes[source])
        self._count(channel, control)  # first, because the write may cause another request immediately
        self.machine.write(places[target], sizes[target], value & ((1 << 8 * sizes[target]) - 1))
        return True

    def block(self, channel: int) -> int:
        """Number of requests that can be served as one block: equal item sizes, not circular."""
        control = self.value[f"CCR{channel}"]
        plain = control >> MEMORY_INCREMENT & 1 and not control >> CIRCULAR & 1
        same = control >> PERIPHERAL_SIZE & 3 == control >> MEMORY_SIZE & 3
        return self.value[f"CNDTR{channel}"] if control & 1 and plain and same else 0

    def item_size(self, channel: int) -> int:
        """Bytes per item in memory."""
        return 1 << (self.value[f"CCR{channel}"] >> MEMORY_SIZE & 3)

    def serve_block(self, channel: int, count: int) -> int:
        """Serve `count` requests of a block; return the address of the items, which the caller transfers."""
        address = self.value[f"CMAR{channel}"] + self._done[channel] * self.item_size(channel)
        self._count(channel, self.value[f"CCR{channel}"], count)
        return address

    def _count(self, channel: int, control: int, count: int = 1) -> None:
        half = self._round[channel] // 2
        before = self._done[channel]
        self._done[channel] += count
        left = self._round[channel] - self._done[channel]
        self.value[f"CNDTR{channel}"] = left
        if before < half <= self._done[channel]:
            self._flag(channel, HALF_FLAG)
        if left == 0:
            self._flag(channel, COMPLETE_FLAG)
            if control >> CIRCULAR & 1:
                self._done[channel] = 0
                self.value[f"CNDTR{channel}"] = self._round[channel]
        self._request(channel)

    def _flag(self, channel: int, flag: int) -> None:
        self.value["ISR"] |= (1 << flag | 1 << GLOBAL_FLAG) << 4 * (channel - 1)

    def _request(self, channel: int) -> None:
        flags = self.value["ISR"] >> 4 * (channel - 1)
        control = self.value[f"CCR{channel}"]
        wanted = (flags >> COMPLETE_FLAG & control >> COMPLETE_INTERRUPT) | (
            flags >> HALF_FLAG & control >> HALF_INTERRUPT
        )
        self.machine.exceptions.set_line(10 + channel, wanted & 1)
