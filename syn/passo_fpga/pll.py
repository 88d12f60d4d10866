# SPDX-License-Identifier: MIT
"""PLL dividers for a clock, as parameters of passo_pll in syn/families/."""

import math
from dataclasses import dataclass

from passo_fpga.families.family import Family


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
    lowest, highest = family.vco
    middle = math.sqrt(lowest * highest)

    def distance(possible: tuple[float, float, dict[str, int | str]]) -> tuple[float, float]:
        made, inside, _ = possible
        return round(abs(made - mhz), 6), abs(math.log(inside / middle))

    found = [p for p in family.pll(oscillator_mhz) if lowest <= p[1] <= highest]
    made, _, parameters = min(found, key=distance, default=(0.0, 0.0, {}))
    if abs(made - mhz) > mhz / 100:
        raise PllError(f"the PLL cannot generate {mhz:g} MHz from {oscillator_mhz:g} MHz")
    return Pll(made, parameters)
