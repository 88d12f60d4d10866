# SPDX-License-Identifier: MIT
"""The STM32 firmware drives the simulated core through its SPI pins, on Icarus Verilog only."""

from cocotb_tests.helpers.runner import CORE_TOP as TOP
from cocotb_tests.helpers.runner import ONE_CHANNEL, run


def test_firmware() -> None:
    """Moves typed at the console of the firmware, which runs on the machine, compared on every clock."""
    run("cocotb_tests.core_firmware", TOP, ONE_CHANNEL, "icarus")
