# SPDX-License-Identifier: MIT
"""Parses values as users write them: the grammar of the console (stm32_bridge/console/passo_number.c)."""

import re
from decimal import Decimal, DecimalTuple
from difflib import get_close_matches
from fractions import Fraction
from functools import lru_cache
from typing import Any, Self

from passo.move_forms import DECIMALS_MAX, NUMBER_MAX

# Powers of ten of a second; a time may also be in clocks.
UNITS = {"clocks": 0, "ns": -9, "us": -6, "ms": -3, "s": 0}
MICRO = str.maketrans("\N{MICRO SIGN}\N{GREEK SMALL LETTER MU}", "uu")
NUMBER = re.compile(r"[+-]?(\d(_?\d)*\.?(\d(_?\d)*)?|\.\d(_?\d)*)([eE][+-]?0*\d{1,5})?", re.ASCII)


class BadValueError(ValueError):
    """A value is invalid; the text does not say where yet."""


class Written(Decimal):
    """A decimal that remembers how it was written."""

    text: str

    def __new__(cls, text: str) -> Self:
        made = super().__new__(cls, text)
        made.text = text
        return made


def shown(value: Any) -> str:
    """A value as text for an error message: short and on one line."""
    try:
        if isinstance(value, Written):
            text = value.text
        else:
            text = str(value).lower() if isinstance(value, bool) else repr(value)
    except ValueError:  # Python refuses to print very long numbers
        return "a very long number"
    return text if len(text) <= 40 else text[:37] + "..."


def meant(word: object, known: tuple[str, ...]) -> str:
    """`; did you mean ...?` if a known word is like this one, else empty."""
    near = get_close_matches(word, known, 1) if isinstance(word, str) else []
    return f"; did you mean {near[0]}?" if near else ""


def check_number(key: str, value: int | Decimal, largest: int) -> Fraction:
    """The number as a fraction, if it is not above the largest and not too fine."""
    if value > largest:
        raise BadValueError(f"{key} must be at most {largest}")
    if value < -largest:
        raise BadValueError(f"{key} must be at least -{largest}")
    if isinstance(value, Decimal) and value.as_tuple().exponent < -DECIMALS_MAX:
        raise BadValueError(f"{key} must have at most {DECIMALS_MAX} decimals")
    return Fraction(value)


@lru_cache(4096)  # most files have the same few
def parse_time(key: str, text: str, clock_hz: int | None = None) -> Fraction:
    """Seconds of a text such as `400ms`, `400 ms` or `4µs`; the unit `clocks` needs a clock."""
    plain = text.strip().translate(MICRO)
    unit = next((unit for unit in UNITS if plain.endswith(unit) and len(plain) > len(unit)), "")
    number = plain.removesuffix(unit).rstrip() if unit else text
    if not NUMBER.fullmatch(number) or (unit == "clocks" and clock_hz is None):
        raise BadValueError(f'{key} must be a number or a text such as "400ms", not {shown(text)}')
    mantissa, _, power = number.replace("_", "").lower().partition("e")
    sign, digits, exponent = Decimal(mantissa).as_tuple()
    exponent += int(power or 0) + UNITS.get(unit, 0)
    value = check_number(key, Decimal(DecimalTuple(sign, digits, exponent)), NUMBER_MAX)
    if value < 0:
        raise BadValueError(f"{key} must not be negative")
    return value / clock_hz if unit == "clocks" and clock_hz else value
