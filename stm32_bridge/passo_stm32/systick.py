# SPDX-License-Identifier: MIT
"""SysTick: counts down from LOAD to 0, one exception per LOAD + 1 clocks."""

from passo_stm32.bus import NEVER, Peripheral, Register
from passo_stm32.nvic import SYS_TICK

ENABLE, INTERRUPT, SOURCE, COUNTED = 0, 1, 2, 16


class SysTick(Peripheral):
    """The timer of the processor."""

    name = "SysTick"
    base = 0xE000E000
    size = 0x100
    registers = (
        Register("CTRL", 0x10, 0x7, 0x4),
        Register("LOAD", 0x14, 0xFFFFFF),
        Register("VAL", 0x18, 0xFFFFFFFF),
        Register("CALIB", 0x1C, 0, 9000),
    )

    def reset(self) -> None:
        """Disable."""
        super().reset()
        self._value = 0  # while it is off

    @property
    def _step(self) -> int:
        """Ticks per count."""
        return self.machine.clocks.hclk * (1 if self.bit("CTRL", SOURCE) else 8)

    def _count(self) -> int:
        """Counter value; 0 for one count before it is reloaded."""
        if self.due == NEVER:
            return self._value
        left = -(-(self.due - self.machine.now) // self._step)
        return 0 if left > self.value["LOAD"] else max(left, 0)

    def _start(self, count: int) -> None:
        """Count down from `count`; 0 is reloaded first."""
        self._value = count
        running = self.bit("CTRL", ENABLE) and (self.value["LOAD"] or count)
        self.due = self.machine.now + (count or self.value["LOAD"] + 1) * self._step if running else NEVER

    def advance(self, now: int) -> None:
        """The counter reaches 0."""
        self.set_bit("CTRL", COUNTED, True)
        if self.bit("CTRL", INTERRUPT):
            self.machine.exceptions.pending |= 1 << SYS_TICK
        self.due = self.due + (self.value["LOAD"] + 1) * self._step if self.value["LOAD"] else NEVER
        self._value = 0

    def clock_changed(self) -> None:
        """Continue from the present count with the new clock; the fraction of a count is lost."""
        if self.due != NEVER:
            self._start(min(self.value["LOAD"], max(0, self.due - self.machine.now) // self._step))

    def read_ctrl(self) -> int:
        """Reading clears COUNTFLAG."""
        value = self.value["CTRL"]
        self.set_bit("CTRL", COUNTED, False)
        return value

    def write_ctrl(self, value: int) -> None:
        """Start or stop the counter."""
        count = self._count()
        self.value["CTRL"] = value
        self._start(count)

    def read_val(self) -> int:
        """The present count."""
        return self._count()

    def write_val(self, value: int) -> None:
        """Any write clears the counter and the flag."""
        self.set_bit("CTRL", COUNTED, False)
        self._start(0)
