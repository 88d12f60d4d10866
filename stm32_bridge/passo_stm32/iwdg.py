# SPDX-License-Identifier: MIT
"""The independent watchdog, on an internal oscillator of exactly 40 kHz, and the debug unit's freeze bits."""

from passo_stm32.bus import NEVER, TICKS_PER_SECOND, MachineError, Peripheral, Register

LSI = TICKS_PER_SECOND // 40_000
UPDATE = 5 * LSI  # delay of an update of PR or RLR
RELOAD_KEY, ACCESS_KEY, START_KEY = 0xAAAA, 0x5555, 0xCCCC


class Iwdg(Peripheral):
    """Counts down from RLR; resets the chip at 0."""

    name = "IWDG"
    base = 0x40003000
    registers = (
        Register("KR", 0x00, 0xFFFF),
        Register("PR", 0x04, 7),
        Register("RLR", 0x08, 0xFFF, 0xFFF),
        Register("SR", 0x0C),
    )

    def reset(self) -> None:
        """Disable until it is started."""
        super().reset()
        self._updated = {"PR": 0, "RLR": 0}
        self._open = False

    def write_kr(self, value: int) -> None:
        """Start, reload, or open the other registers."""
        self._open = value == ACCESS_KEY
        if value == START_KEY or (value == RELOAD_KEY and self.due != NEVER):
            period = (self.value["RLR"] + 1) * LSI << min(self.value["PR"], 6) + 2
            self.due = self.machine.now + period

    def _update(self, register: str, value: int) -> None:
        if not self._open:
            raise MachineError(f"IWDG.{register} is written without its key")
        if self.machine.now < self._updated[register]:
            raise MachineError(f"IWDG.{register} is written while its update flag is set")
        self.value[register] = value
        self._updated[register] = self.machine.now + UPDATE

    def write_pr(self, value: int) -> None:
        """Prescaler 4 to 256; takes effect with the next reload."""
        self._update("PR", value)

    def write_rlr(self, value: int) -> None:
        """Reload value."""
        self._update("RLR", value)

    def read_sr(self) -> int:
        """PVU and RVU: an update is in progress."""
        now = self.machine.now
        return (now < self._updated["PR"]) | (now < self._updated["RLR"]) << 1

    def advance(self, now: int) -> None:
        """The counter has reached 0."""
        self.due = NEVER
        self.machine.request_reset("watchdog")


class Debug(Peripheral):
    """Device identification; the freeze bits have no effect without a debugger."""

    name = "DBGMCU"
    base = 0xE0042000
    size = 0x100
    registers = (Register("IDCODE", 0x00, 0, 0x20036410), Register("CR", 0x04, 0x3FFF27))
