# SPDX-License-Identifier: MIT
"""Every test of this folder runs once per simulator: `pytest cocotb_tests -k icarus` takes one of them."""

import pytest

from cocotb_tests.helpers.runner import SIMULATORS


@pytest.fixture(params=SIMULATORS)
def simulator(request: pytest.FixtureRequest) -> str:
    """Name of a simulator, as `run` wants it."""
    return request.param
