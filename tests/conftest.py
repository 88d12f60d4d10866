# SPDX-License-Identifier: MIT
"""Fixtures of all tests."""

from typing import Any

import pytest
from passo.driver import Driver

from tests.helpers.driver_wire import Wire, open_driver
from tests.helpers.plans import planner


@pytest.fixture
def c() -> Any:
    """The planner, built such that undefined behavior is fatal."""
    return planner()


@pytest.fixture
def wire() -> Wire:
    """A link to the C model."""
    return Wire()


@pytest.fixture
def driver(wire: Wire) -> Driver:
    """A driver at it."""
    return open_driver(wire)
