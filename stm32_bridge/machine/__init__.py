# SPDX-License-Identifier: MIT
"""An STM32F103 that executes firmware: unicorn for the instructions, models for what is around them.

`Machine` is the whole; each other module is one part of it. Time runs in ticks of 1/576 µs, of which the
clocks of all usual frequencies are whole multiples.
"""

from passo_stm32.bus import MachineError
from passo_stm32.machine import Machine

__all__ = ["Machine", "MachineError"]
