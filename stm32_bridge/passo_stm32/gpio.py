# SPDX-License-Identifier: MIT
"""GPIO ports, AFIO and EXTI: edges of inputs drive the EXTI lines."""

from typing import TYPE_CHECKING

from passo_stm32.bus import Peripheral, Register

if TYPE_CHECKING:
    from passo_stm32.chip import Chip

OUTPUT_PUSH_PULL, ALTERNATE_PUSH_PULL = 0, 2
INPUT_ANALOG, INPUT_FLOATING, INPUT_PULLED = 0, 1, 2
PORTS = "ABCD"


class Gpio(Peripheral):
    """One port."""

    registers = (
        Register("CRL", 0x00, 0xFFFFFFFF, 0x44444444),
        Register("CRH", 0x04, 0xFFFFFFFF, 0x44444444),
        Register("IDR", 0x08),
        Register("ODR", 0x0C, 0xFFFF),
        Register("BSRR", 0x10, 0xFFFFFFFF),
        Register("BRR", 0x14, 0xFFFF),
    )

    def __init__(self, machine: "Chip", letter: str):
        self.letter = letter
        self.name = f"GPIO{letter}"
        self.base = 0x40010800 + 0x400 * PORTS.index(letter)
        self.external: dict[int, int] = {}  # levels driven from outside
        super().__init__(machine)

    def reset(self) -> None:
        """Make all pins inputs."""
        before = [self.level(pin) for pin in range(16)] if self.value else []
        super().reset()
        self._tell(before)

    def mode(self, pin: int) -> tuple[bool, int]:
        """Whether a pin is an output, and its configuration bits."""
        code = self.value["CRH" if pin >= 8 else "CRL"] >> 4 * (pin % 8) & 15
        return bool(code & 3), code >> 2

    def level(self, pin: int) -> int:
        """Level of a pin; a floating pin reads as high."""
        output, configuration = self.mode(pin)
        if output and configuration in (0, 1):
            open_high = configuration == 1 and self.value["ODR"] >> pin & 1
            return self.external.get(pin, 1) if open_high else self.value["ODR"] >> pin & 1
        if pin in self.external:
            return self.external[pin]
        return self.value["ODR"] >> pin & 1 if not output and configuration == INPUT_PULLED else 1

    def drive(self, pin: int, level: int) -> None:
        """Drive a pin from outside."""
        if self.external.get(pin) != level:
            before = self.level(pin)
            self.external[pin] = level
            self._tell([before], pin)

    def _tell(self, before: list[int], first: int = 0) -> None:
        for pin, old in enumerate(before, first):
            if (new := self.level(pin)) != old:
                self.machine.pin_changed(self.letter, pin, new)

    def _change(self, register: str, value: int) -> None:
        first, end = 0, 16
        if register == "ODR":
            different = self.value[register] ^ value
            first, end = (different & -different).bit_length() - 1, different.bit_length()
        before = [self.level(pin) for pin in range(max(first, 0), end)]
        self.value[register] = value
        self._tell(before, first)

    def write_crl(self, value: int) -> None:
        """Modes of pins 0 to 7."""
        self._change("CRL", value)

    def write_crh(self, value: int) -> None:
        """Modes of pins 8 to 15."""
        self._change("CRH", value)

    def read_idr(self) -> int:
        """Pin levels; an analog input reads as 0."""
        return sum(self.level(pin) << pin for pin in range(16) if self.mode(pin) != (False, INPUT_ANALOG))

    def write_odr(self, value: int) -> None:
        """Set all outputs."""
        self._change("ODR", value)

    def write_bsrr(self, value: int) -> None:
        """Set bits and reset bits; set has priority."""
        self._change("ODR", self.value["ODR"] & ~(value >> 16) | value & 0xFFFF)

    def write_brr(self, value: int) -> None:
        """Reset bits."""
        self._change("ODR", self.value["ODR"] & ~value)


class Afio(Peripheral):
    """Port selection of the EXTI lines; the only remapping modeled is that of the debug pins."""

    name = "AFIO"
    base = 0x40010000
    registers = (
        Register("EVCR", 0x00),
        Register("MAPR", 0x04, 7 << 24),
        *(Register(f"EXTICR{n}", 4 + 4 * n, 0xFFFF) for n in (1, 2, 3, 4)),
    )

    def port_of(self, line: int) -> str:
        """The port selected for an EXTI line."""
        code = self.value[f"EXTICR{line // 4 + 1}"] >> 4 * (line % 4) & 15
        return PORTS[code] if code < len(PORTS) else ""


class Exti(Peripheral):
    """Edge interrupts."""

    name = "EXTI"
    base = 0x40010400
    registers = (
        Register("IMR", 0x00, 0xFFFF),
        Register("EMR", 0x04),
        Register("RTSR", 0x08, 0xFFFF),
        Register("FTSR", 0x0C, 0xFFFF),
        Register("SWIER", 0x10, 0xFFFF),
        Register("PR", 0x14, 0xFFFF),
    )

    def edge(self, line: int, level: int) -> None:
        """An EXTI line has a new level."""
        if self.bit("RTSR" if level else "FTSR", line):
            self.set_bit("PR", line, True)
            self._request()

    def _request(self) -> None:
        waiting = self.value["PR"] & self.value["IMR"]
        for line in range(5):
            self.machine.exceptions.set_line(6 + line, waiting >> line & 1)
        self.machine.exceptions.set_line(23, waiting & 0x03E0)
        self.machine.exceptions.set_line(40, waiting & 0xFC00)

    def write_imr(self, value: int) -> None:
        """Masks."""
        self.value["IMR"] = value
        self._request()

    def write_swier(self, value: int) -> None:
        """Interrupts by software."""
        self.value["SWIER"] |= value
        self.value["PR"] |= value & self.value["IMR"]
        self._request()

    def write_pr(self, value: int) -> None:
        """Ones clear."""
        self.value["PR"] &= ~value
        self.value["SWIER"] &= ~value
        self._request()
