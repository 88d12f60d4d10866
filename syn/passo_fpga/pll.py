# SPDX-License-Identifier: MIT
"""PLL dividers for a clock, as parameters of passo_pll in syn/families/."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from passo_fpga.devices import ECP5, GOWIN, ICE40, Family


@dataclass(frozen=True)
class Pll:
    """A clock in MHz and the parameters that generate it."""

    mhz: float
    parameters: dict[str, int | str]


class PllError(ValueError):
    """No dividers give the clock."""


def dividers(family: Family, oscillator_mhz: float, mhz: float) -> Pll:
    """The PLL settings with the clock nearest to `mhz`; among these, those furthest from the VCO limits.

    Raises PllError if none is within 1 %.
    """
    search, lowest, highest = _PLLS[family.place]
    middle = math.sqrt(lowest * highest)

    def distance(possible: tuple[float, float, dict[str, int | str]]) -> tuple[float, float]:
        made, inside, _ = possible
        return round(abs(made - mhz), 6), abs(math.log(inside / middle))

    found = [p for p in search(oscillator_mhz) if lowest <= p[1] <= highest]
    made, _, parameters = min(found, key=distance, default=(0.0, 0.0, {}))
    if abs(made - mhz) > mhz / 100:
        raise PllError(f"the PLL cannot make {mhz:g} MHz of {oscillator_mhz:g} MHz")
    return Pll(made, parameters)


# clock, VCO, parameters
Possible = Iterator[tuple[float, float, dict[str, int | str]]]


def _ice40(oscillator: float) -> Possible:
    """Phase detector 10 to 133 MHz."""
    for divr in range(16):
        reference = oscillator / (divr + 1)
        if not 10 <= reference <= 133:
            continue
        filter_range = sum(reference >= limit for limit in (0, 17, 26, 44, 66, 101))
        for divf in range(128):
            vco = reference * (divf + 1)
            for divq in range(1, 7):
                parameters = {"DIVR": divr, "DIVF": divf, "DIVQ": divq, "FILTER_RANGE": filter_range}
                yield vco / (1 << divq), vco, parameters


def _ecp5(oscillator: float) -> Possible:
    """Phase detector 3.125 to 400 MHz; the output is fed back."""
    for clki in range(1, 9):
        reference = oscillator / clki
        if reference < 3.125:
            continue
        for clkfb in range(1, 81):
            made = reference * clkfb
            for clkop in range(1, 129):
                yield made, made * clkop, {"CLKI_DIV": clki, "CLKFB_DIV": clkfb, "CLKOP_DIV": clkop}


def _gowin(oscillator: float) -> Possible:
    """GW1NR-9C C6/I5: phase detector 3 to 400 MHz, output 3.125 to 600 MHz."""
    fclkin = f"{oscillator:g}"
    for idiv in range(1, 65):
        reference = oscillator / idiv
        if reference < 3:
            continue
        for fbdiv in range(1, 65):
            made = reference * fbdiv
            for odiv in (2, 4, 8, 16, 32, 48, 64, 80, 96, 112, 128):
                if 3.125 <= made <= 600:
                    dividers = {"IDIV_SEL": idiv - 1, "FBDIV_SEL": fbdiv - 1, "ODIV_SEL": odiv}
                    yield made, made * odiv, {"FCLKIN": fclkin, **dividers}


# Per family: possible settings, and the limits of the VCO.
_PLLS: dict[str, tuple[Callable[[float], Possible], float, float]] = {
    ICE40.place: (_ice40, 533, 1066),
    ECP5.place: (_ecp5, 400, 800),
    GOWIN.place: (_gowin, 400, 1200),
}
