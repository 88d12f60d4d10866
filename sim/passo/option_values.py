# SPDX-License-Identifier: MIT
"""Numbers as values of options, within their ranges; imports nothing slow."""

import argparse
from collections.abc import Callable
from contextlib import suppress

DIGITS_MAX = 30  # of a value that an error repeats


def whole(least: int, most: int) -> Callable[[str], int]:
    """The `type` of an option that takes a whole number."""
    return lambda text: int(_within(int, text, least, most, "whole number"))


def number(least: float, most: float) -> Callable[[str], float]:
    """The `type` of an option that takes a number; nan and inf are none."""
    return lambda text: _within(float, text, least, most, "number")


def _within(read: Callable[[str], float], text: str, least: float, most: float, kind: str) -> float:
    with suppress(ValueError):
        value = read(text)
        if least <= value <= most:  # false of nan
            return value
    told = text if len(text) <= DIGITS_MAX else f"{text[:DIGITS_MAX]}..."
    raise argparse.ArgumentTypeError(f"must be a {kind} from {least:,} to {most:,}, not '{told}'")
