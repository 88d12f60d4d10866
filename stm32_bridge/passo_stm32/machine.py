# SPDX-License-Identifier: MIT
"""The whole microcontroller: an ELF in flash, a terminal at USART1, a core at the SPI pins."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from passo.engine import EVENT, Engine

from passo_stm32.bus import TICKS_PER_SECOND, MachineError
from passo_stm32.chip import Chip
from passo_stm32.gpio import ALTERNATE_PUSH_PULL, PORTS
from passo_stm32.processor import FLASH
from passo_stm32.wires import CorePins, Wires

BRANCH_TO_ITSELF = b"\xfe\xe7"


class Machine(Chip):
    """A powered microcontroller; the first `run` starts the firmware.

    The engine must be new; its clock_hz is the clock of the core. Without `crystal` there is no crystal. The
    flash has `flash_size` bytes, or as many as the program is linked for.
    """

    def __init__(
        self,
        elf: Path,
        core: CorePins | None = None,
        *,
        crystal: bool = True,
        baud: int = 115_200,
        select: str = "PA4",
        irq: str = "PB0",
        seed: int = 1,
        flash_size: int | None = None,
    ):
        super().__init__(elf, crystal=crystal, flash_size=flash_size)
        self.baud = baud  # of the terminal
        self.wires = Wires(core, seed)
        self.output = ""  # what the terminal received
        self.output_ticks: list[int] = []  # when the reception of each character ended
        self.led: list[tuple[int, int]] = []  # tick and level of PC13
        self._select, self._irq = _pin(select), _pin(irq)
        self._chip_selected = False
        self._events: list[np.ndarray] = []
        self._make_peripherals()
        letter, pin = self._irq
        self._irq_level = self.ports[letter].external[pin] = self.wires.irq
        if isinstance(core, Engine):
            core.pace(core.clock_hz, TICKS_PER_SECOND)
        self._reset("power")

    def run(self, seconds: float) -> None:
        """Let time pass; raises MachineError."""
        self._run(self.now + round(seconds * TICKS_PER_SECOND), lambda: False)

    def run_until(self, condition: Callable[[], object], seconds: float) -> None:
        """Let time pass until a condition is true; raises TimeoutError after `seconds`."""
        if not self._run(self.now + round(seconds * TICKS_PER_SECOND), condition) and not condition():
            raise TimeoutError(
                f"timeout: no output for {seconds} s; the terminal shows ...{self.output[-200:]!r}"
            )

    def type(self, text: str, baud: int | None = None, *, damaged: bool = False) -> None:
        """Send characters from the terminal at its baud rate; damaged ones arrive with a framing error."""
        self.usart.type(text.encode("latin-1"), baud or self.baud, self.now, damaged=damaged)
        self._next_due = self.now

    def expect(self, text: str, seconds: float, since: int = 0) -> None:
        """Run until the output contains a text after its first `since` characters."""
        self.run_until(lambda: text in self.output[since:], seconds)

    def command(self, line: str, seconds: float, prompt: str) -> str:
        """Type a line and run until `prompt`; return the output before it."""
        since = len(self.output)
        self.type(line + "\r")
        self.expect(prompt, seconds, since)
        return self.output[since:].rpartition(prompt)[0]

    def events(self) -> np.ndarray:
        """The pin events of the core (passo.engine.EVENT) since the last call."""
        self._drain()
        events, self._events = self._events, []
        return np.concatenate([np.empty(0, EVENT), *events])

    def hang(self) -> None:
        """Inject a fault: the processor enters an endless loop; interrupts keep working."""
        end = FLASH + self.flash_size - len(BRANCH_TO_ITSELF)
        self.write_memory(end, BRANCH_TO_ITSELF)
        self.jump(end)

    def jump(self, address: int) -> None:
        """Inject a fault: the processor continues at an address."""
        self._c.passo_cpu_set_pc(self.cpu, address)
        self._asleep = False

    def _follow(self, tick: int) -> int:
        """Advance the core to a tick, or to the start of a word in flight; return the tick reached."""
        wires = self.wires
        limit = tick if self.spi.started is None else min(tick, self.spi.started)
        reached = wires.follow(limit)
        while reached < limit and wires.irq == self._irq_level:
            self._drain()
            reached = wires.follow(limit)
        if wires.irq == self._irq_level:
            return tick
        self._irq_level = wires.irq
        letter, pin = self._irq
        self.ports[letter].drive(pin, self._irq_level)
        return reached

    def _drain(self) -> None:
        if isinstance(self.wires.core, Engine):
            events = self.wires.core.drain()
            if len(events):
                self._events.append(events)

    def receive(self, character: int, tick: int) -> None:
        """The terminal receives a character."""
        self.output += chr(character)
        self.output_ticks.append(tick)

    def pin_changed(self, letter: str, pin: int, level: int) -> None:
        """A pin has a new level."""
        if self.afio.port_of(pin) == letter:
            self.exti.edge(pin, level)
        if (letter, pin) == ("C", 13):
            self.led.append((self.now, level))
        output, _ = self.ports[letter].mode(pin)
        if (letter, pin) == self._select and (selected := output and level == 0) != self._chip_selected:
            if self.spi.started is not None and self._reset_cause is None:
                raise MachineError("chip select changes in the middle of a word")
            self._chip_selected = selected
            self._follow(self.now)
            self.wires.select(selected)

    def exchange(self, mosi: bytes, tick: int, half_period: int) -> bytes:
        """Exchange the word that SPI1 started to send at a tick."""
        port = self.ports["A"]
        for pin in (5, 7):
            if port.mode(pin) != (True, ALTERNATE_PUSH_PULL):
                raise MachineError(f"SPI1 sends, but PA{pin} is not its push-pull output")
        if port.mode(6)[0]:
            raise MachineError("SPI1 sends, but PA6 is not an input")
        self.wires.floating = port.level(6)
        core = self.wires.core
        if isinstance(core, Engine) and half_period * core.clock_hz < TICKS_PER_SECOND:
            raise MachineError("SCLK is too fast for the core's clock: less than a clock at each level")
        while self.wires.follow(tick) < tick:
            self._drain()
        return self.wires.exchange(mosi, half_period)


def _pin(name: str) -> tuple[str, int]:
    """Parse a pin name: PA4 is ("A", 4)."""
    if len(name) < 3 or name[0] != "P" or name[1] not in PORTS or not name[2:].isdigit():
        raise ValueError(f"no pin {name}")
    return name[1], int(name[2:])
