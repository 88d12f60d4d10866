# SPDX-License-Identifier: MIT
"""The front doors for a CPU in the same FPGA: passo_wishbone and passo_axi_lite."""

import pytest

from cocotb_tests.helpers.runner import DOORS, run

PARAMETERS = {"CHANNELS": 1, "AXES": 2, "TICK_LOG2": 7, "LINE_QUEUE_LOG2": 5, "RAMP_QUEUE_LOG2": 4}


@pytest.mark.parametrize("top", DOORS)
def test_door(top: str, simulator: str) -> None:
    """Driver, frames and registers through a public bus master."""
    run("cocotb_tests.doors", top, PARAMETERS, simulator)
