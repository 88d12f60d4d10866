# SPDX-License-Identifier: MIT
"""An emulated STM32F103 that executes firmware: unicorn for the instructions, models for the peripherals.

`Machine` is the whole microcontroller; each other module is a part of it. Time counts in ticks of 1/576 µs,
of which all usual clock periods are integer multiples.
"""

from passo_stm32.bus import MachineError
from passo_stm32.machine import Machine

__all__ = ["Machine", "MachineError"]
