# SPDX-License-Identifier: MIT
"""Probes of a simulated surface: where G38 ends."""

from collections.abc import Sequence
from itertools import pairwise

from passo.expand.height_map import HeightMap
from passo.expand.place import LineError

PROBES = range(382, 386)  # toward, toward, away, away; every other one needs no touch
AWAY, OPTIONAL = (384, 385), (383, 385)
PROBING = "grbl, LinuxCNC"
FINE = 1e-9  # share of a motion


def share_of_probe(
    surface: HeightMap, command: int, begin: Sequence[float], end: Sequence[float]
) -> float | None:
    """Share of a motion of the tip, in mm and machine coordinates, up to the change of contact; None: none.

    Raises LineError if one is needed, or if the contact is as wanted from the beginning on.
    """
    away = command in AWAY
    start, way = complex(*begin[:2]), complex(end[0] - begin[0], end[1] - begin[1])

    def reached(share: float) -> bool:
        height = begin[2] + share * (end[2] - begin[2])
        return (height > surface.height(start + share * way)) == away

    if reached(0):
        raise LineError("the probe touches already" if not away else "the probe does not touch", PROBING)
    shares = [0.0, *(surface.cuts_of_line(start, start + way) if way else [1.0])]
    for low, high in pairwise(shares):
        if reached(high):
            while high - low > FINE:
                middle = (low + high) / 2
                low, high = (low, middle) if reached(middle) else (middle, high)
            return high
    if command not in OPTIONAL:
        raise LineError("the probe touches nothing" if not away else "the probe touches to the end", PROBING)
    return None
