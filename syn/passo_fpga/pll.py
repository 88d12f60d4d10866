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


def possible(family: Family, oscillator_mhz: float) -> list[Pll]:
    """The settings within the VCO limits, those furthest from them first."""
    lowest, highest = family.vco
    middle = math.sqrt(lowest * highest)
    found = [p for p in family.pll(oscillator_mhz) if lowest <= p[1] <= highest]
    found.sort(key=lambda setting: abs(math.log(setting[1] / middle)))
    return [Pll(made, parameters) for made, _, parameters in found]


def dividers(family: Family, oscillator_mhz: float, mhz: float) -> Pll:
    """The PLL settings with the clock nearest to `mhz`; among these, those furthest from the VCO limits.

    Raises PllError if none is within 1 %.
    """
    made = min(
        possible(family, oscillator_mhz), key=lambda pll: round(abs(pll.mhz - mhz), 6), default=Pll(0.0, {})
    )
    if abs(made.mhz - mhz) > mhz / 100:
        raise PllError(f"the PLL cannot generate {mhz:g} MHz from {oscillator_mhz:g} MHz")
    return made
