# SPDX-License-Identifier: MIT
"""Fixtures of all tests."""

from collections.abc import Iterator
from typing import Any

import pytest
from passo.driver import Driver

from tests.helpers.browser import Browser
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


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The address of the page of `make web`."""
    from passo.web import build  # takes a second

    return build(tmp_path_factory.mktemp("web")).as_uri()


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """A browser for all tests of a module."""
    with Browser(tmp_path_factory.mktemp("browser")) as browser:
        yield browser
