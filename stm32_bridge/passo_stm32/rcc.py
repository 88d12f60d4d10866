# SPDX-License-Identifier: MIT
"""Reset and clock control."""

from dataclasses import dataclass

from passo_stm32.bus import NEVER, TICKS_PER_SECOND, MachineError, Peripheral, Register

HSI_HZ = 8_000_000
CRYSTAL_HZ = 8_000_000
CRYSTAL_START = TICKS_PER_SECOND // 1000 * 2
PLL_LOCK = TICKS_PER_SECOND // 1_000_000 * 200

HSION, HSIRDY, HSEON, HSERDY, PLLON, PLLRDY = 0, 1, 16, 17, 24, 25
PLLSRC, PLLXTPRE = 16, 17
FROM_HSI, FROM_HSE, FROM_PLL = 0, 1, 2
PIN_RESET, POWER_RESET, SOFTWARE_RESET, WATCHDOG_RESET = 26, 27, 28, 29
CAUSES = {"power": POWER_RESET, "pin": PIN_RESET, "software": SOFTWARE_RESET, "watchdog": WATCHDOG_RESET}

# Enable bits: register, bit.
ENABLES = {
    **{"DMA1": ("AHBENR", 0), "CRC": ("AHBENR", 6)},
    **{"AFIO": ("APB2ENR", 0), "GPIOA": ("APB2ENR", 2), "GPIOB": ("APB2ENR", 3), "GPIOC": ("APB2ENR", 4)},
    **{"GPIOD": ("APB2ENR", 5), "SPI1": ("APB2ENR", 12), "USART1": ("APB2ENR", 14)},
}


@dataclass
class Clocks:
    """Ticks per clock of the buses."""

    hclk: int = TICKS_PER_SECOND // HSI_HZ
    pclk1: int = TICKS_PER_SECOND // HSI_HZ
    pclk2: int = TICKS_PER_SECOND // HSI_HZ


class Rcc(Peripheral):
    """Oscillators, PLL, prescalers, enable bits and reset cause."""

    name = "RCC"
    base = 0x40021000
    registers = (
        Register("CR", 0x00, 1 << HSION | 0x1F << 3 | 1 << HSEON | 1 << PLLON, 0x83),
        Register("CFGR", 0x04, 0x3FFFF3),
        Register("CIR", 0x08),
        Register("APB2RSTR", 0x0C, 0x503D),
        Register("APB1RSTR", 0x10),
        Register("AHBENR", 0x14, 0x55, 0x14),
        Register("APB2ENR", 0x18, 0x503D),
        Register("APB1ENR", 0x1C, 1 << 28 | 1 << 27),
        Register("BDCR", 0x20),
        Register("CSR", 0x24, 1 << 24),
    )

    def reset(self) -> None:
        """Select the internal oscillator. The reset flags are kept."""
        flags = self.value.get("CSR", 0)
        super().reset()
        self.value["CSR"] = flags
        self._ready = {HSERDY: NEVER, PLLRDY: NEVER}
        self._apply()

    def note_reset(self, cause: str) -> None:
        """Set the flag of a reset cause; every reset also pulls the pin."""
        self.value["CSR"] |= 1 << CAUSES[cause] | 1 << PIN_RESET

    def enabled(self, name: str) -> bool:
        """Whether the clock of a peripheral is enabled."""
        register, bit = ENABLES.get(name, ("", 0))
        return not register or bool(self.bit(register, bit))

    def write_cr(self, value: int) -> None:
        """Switch oscillators on and off; they are ready after a delay."""
        source = self.value["CFGR"] & 3
        self.value["CR"] = value
        for on, ready, time in ((HSEON, HSERDY, CRYSTAL_START), (PLLON, PLLRDY, PLL_LOCK)):
            if not value >> on & 1:
                self.set_bit("CR", ready, False)
                self._ready[ready] = NEVER
                if source == (FROM_HSE if on == HSEON else FROM_PLL):
                    raise MachineError("the system clock is switched off")
            elif not self.bit("CR", ready) and self._ready[ready] == NEVER and self._works(on):
                self._ready[ready] = self.machine.now + time
        self.set_bit("CR", HSIRDY, value >> HSION & 1)
        self.due = min(self._ready.values())

    def _works(self, oscillator: int) -> bool:
        return oscillator != HSEON or self.machine.crystal

    def advance(self, now: int) -> None:
        """Oscillators become ready."""
        for ready, tick in self._ready.items():
            if tick <= now:
                self.set_bit("CR", ready, True)
                self._ready[ready] = NEVER
        self.due = min(self._ready.values())

    def write_cfgr(self, value: int) -> None:
        """Select the system clock and the prescalers."""
        self.value["CFGR"] = value
        self._apply()

    def _pll_hz(self) -> int:
        factor = min(16, (self.value["CFGR"] >> 18 & 15) + 2)
        if not self.bit("CFGR", PLLSRC):
            return HSI_HZ // 2 * factor
        return CRYSTAL_HZ // (1 + self.bit("CFGR", PLLXTPRE)) * factor

    def _apply(self) -> None:
        source = self.value["CFGR"] & 3
        ready = {FROM_HSI: HSIRDY, FROM_HSE: HSERDY, FROM_PLL: PLLRDY}.get(source)
        if ready is None or not self.bit("CR", ready):
            raise MachineError("the system clock source is not ready")
        hz = {FROM_HSI: HSI_HZ, FROM_HSE: CRYSTAL_HZ, FROM_PLL: self._pll_hz()}[source]
        if TICKS_PER_SECOND % hz:
            raise MachineError(f"a system clock of {hz} Hz is not modeled")
        self.value["CFGR"] = self.value["CFGR"] & ~0xC | source << 2
        ahb = self.value["CFGR"] >> 4 & 15
        shift = 0 if ahb < 8 else ahb - 7 + (ahb >= 12)
        hclk = TICKS_PER_SECOND // hz << shift
        dividers = [0 if code < 4 else code - 3 for code in (self.value["CFGR"] >> at & 7 for at in (8, 11))]
        self.machine.set_clocks(Clocks(hclk, hclk << dividers[0], hclk << dividers[1]))

    def write_apb2rstr(self, value: int) -> None:
        """Reset peripherals."""
        self.value["APB2RSTR"] = value
        for name, (register, bit) in ENABLES.items():
            if register == "APB2ENR" and value >> bit & 1 and name in self.machine.peripherals:
                self.machine.peripherals[name].reset()

    def write_csr(self, value: int) -> None:
        """RMVF clears the reset flags."""
        if value >> 24 & 1:
            self.value["CSR"] = 0
