# SPDX-License-Identifier: MIT
"""Errors of worker processes arrive as they were raised."""

import importlib
import inspect
import pickle
import pkgutil
from collections.abc import Iterator

import passo
import pytest


def errors() -> Iterator[type[Exception]]:
    """All exceptions of the package."""
    for module in pkgutil.walk_packages(passo.__path__, "passo."):
        if module.name.endswith("__main__") or module.name.startswith("passo.litex"):
            continue
        for _, kind in inspect.getmembers(importlib.import_module(module.name), inspect.isclass):
            if issubclass(kind, Exception) and kind.__module__ == module.name and kind.__name__[0] != "_":
                yield kind


ERRORS = {kind.__name__: kind for kind in errors()}


def test_all_of_them_are_tried() -> None:
    assert {
        "PlanError",
        "RefusedError",
        "DriverError",
        "GcodeError",
        "ExpandError",
        "PulseError",
    } <= ERRORS.keys()


@pytest.mark.parametrize("kind", ERRORS.values(), ids=ERRORS)
def test_another_process_raises_it_as_it_is(kind: type[Exception]) -> None:
    """Whatever its constructor takes."""
    made = kind.__new__(kind)
    made.args = ("what it says",)
    made.detail = 7
    again = pickle.loads(pickle.dumps(made))
    assert type(again) is kind and again.args == made.args and again.detail == 7
