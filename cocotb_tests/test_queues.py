# SPDX-License-Identifier: MIT
"""passo_line_queue and passo_ramp_queue of real depths; the proofs have four entries."""

import pytest

from cocotb_tests.helpers.runner import run


@pytest.mark.parametrize("depth_log2", [5, 8])
def test_line_queue(simulator: str, depth_log2: int) -> None:
    run("cocotb_tests.deep_lines", "passo_line_queue", {"AXES": 1, "DEPTH_LOG2": depth_log2}, simulator)


def test_ramp_queue(simulator: str) -> None:
    run("cocotb_tests.deep_ramps", "passo_ramp_queue", {"DEPTH_LOG2": 8}, simulator)
