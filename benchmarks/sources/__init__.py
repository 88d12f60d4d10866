# SPDX-License-Identifier: MIT
"""Four published methods of making step pulses with the timers of an STM32, with their original arithmetic.

Integer divisions truncate, as in C, and errors of the publications are kept. Where a publication leaves
something open, the interpretation that favors it is used and documented. Common to all: a pulse is placed in
the middle of its period, where it belongs on the ideal curve.
"""

from benchmarks.sources import cosine, multi_axis, sigmoid, trapezoid
from benchmarks.sources.cosine import Cosine
from benchmarks.sources.multi_axis import MultiAxis
from benchmarks.sources.pulses import MILLISECONDS, Pulses
from benchmarks.sources.sigmoid import Sigmoid
from benchmarks.sources.trapezoid import Trapezoid

__all__ = ["MILLISECONDS", "Cosine", "Move", "MultiAxis", "Pulses", "Sigmoid", "Trapezoid", "simulate"]

Move = Trapezoid | Sigmoid | MultiAxis | Cosine


def simulate(move: Move) -> Pulses:
    """What the source makes of its own move."""
    modules = {Trapezoid: trapezoid, Sigmoid: sigmoid, MultiAxis: multi_axis, Cosine: cosine}
    return modules[type(move)].simulate(move)
