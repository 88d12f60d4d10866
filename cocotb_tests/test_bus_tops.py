# SPDX-License-Identifier: MIT
"""The host interfaces for a CPU in the same FPGA: passo_wishbone and passo_axi_lite."""

import pytest

from cocotb_tests.helpers.runner import BUS_CORE, BUS_TOPS, run, skip_icarus


@pytest.mark.sample(1)
@pytest.mark.parametrize("top", BUS_TOPS)
def test_bus_top(top: str, simulator: str) -> None:
    """Driver, frames and registers through a public bus master."""
    if top != BUS_TOPS[0]:
        skip_icarus(simulator)
    run("cocotb_tests.bus_tops", top, BUS_CORE, simulator)
