# SPDX-License-Identifier: MIT
"""Fixtures of all tests."""

from typing import Any

import pytest

from tests.helpers.plans import planner


@pytest.fixture
def c() -> Any:
    """The planner, every use of undefined behaviour being fatal."""
    return planner()
