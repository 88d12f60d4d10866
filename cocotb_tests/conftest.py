# SPDX-License-Identifier: MIT
"""Every test of this folder runs once per simulator; `pytest cocotb_tests -k icarus` selects one."""

import pytest

from cocotb_tests.helpers.runner import SIMULATORS


@pytest.fixture(params=SIMULATORS)
def simulator(request: pytest.FixtureRequest) -> str:
    """Name of a simulator for `run`."""
    return request.param
