# SPDX-License-Identifier: MIT
"""The STM32 firmware drives the simulated core through its SPI pins."""

import pytest

from cocotb_tests.helpers.runner import CORE_TOP as TOP
from cocotb_tests.helpers.runner import ONE_CHANNEL, run, skip_icarus

CLOCK_HZ = 100_000_000  # as the bench drives it


@pytest.mark.sample(1)
def test_firmware(simulator: str) -> None:
    """Moves typed at the console of the firmware, which runs on the machine, compared on every clock."""
    skip_icarus(simulator)
    run("cocotb_tests.core_firmware", TOP, ONE_CHANNEL | {"CLOCK_HZ": CLOCK_HZ}, simulator)
