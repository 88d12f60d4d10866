# SPDX-License-Identifier: MIT
"""Fixtures of all tests."""

from typing import Any

import pytest

from tests.helpers.plans import planner


@pytest.fixture
def c() -> Any:
    """The planner, built such that undefined behaviour is fatal."""
    return planner()
