# SPDX-License-Identifier: MIT
"""Compares the recorded pins of the core with the C model on every clock."""

from dataclasses import asdict

import numpy as np

from passo.build import Parameters, judge_library
from passo.native import ffi, load
from passo.pins import INPUTS, OUTPUTS

SIGNALS = (*(pin.name for pin in OUTPUTS), "miso")
COLUMNS = ("clock", *(f"in_{pin.name}" for pin in INPUTS), "pin_miso", *SIGNALS[:-1])


class DifferenceError(AssertionError):
    """The pins differ from the model."""


class Judge:
    """The C model, fed with the waveforms at the inputs of the core."""

    def __init__(self, parameters: Parameters):
        self.parameters = parameters
        self._c = load(judge_library())
        self._judge = ffi().new("uint64_t[]", self._c.judge_size() // 8 + 1)
        wanted = ffi().new("struct passo_parameters *", asdict(parameters))
        assert self._c.judge_reset(self._judge, wanted)

    def follow(self, rows: np.ndarray, until: int) -> None:
        """Compare up to a clock; `rows` (COLUMNS) were recorded since the last call."""
        rows = np.ascontiguousarray(rows, np.uint64)
        pointer = ffi().from_buffer(rows)
        if not self._c.judge_follow(self._judge, pointer, len(rows), until):
            raise DifferenceError(self._difference())

    def _difference(self) -> str:
        found = ffi().new("uint64_t[4]")
        self._c.judge_difference(self._judge, found)
        clock, signal, expected, actual = found
        different = expected ^ actual
        bit = (different & -different).bit_length() - 1
        name = SIGNALS[signal]
        place = ""
        width = {pin.name: pin.width for pin in OUTPUTS}.get(name)
        if width == "CHANNELS":
            place = f" of channel {bit}"
        elif width == "CHANNELS*AXES":
            channel, axis = divmod(bit, self.parameters.axes)
            place = f" of channel {channel}, axis {axis}"
        return (
            f"clock {clock}: {name}{place} (bit {bit}) differs: "
            f"expected {expected >> bit & 1} (model), actual {actual >> bit & 1} (RTL)"
        )

    def summary(self) -> str:
        """Summary of what was compared."""
        matched = ffi().new("uint64_t[]", len(SIGNALS))
        self._c.judge_matched(self._judge, matched)
        edges = ", ".join(f"{name} {n}" for name, n in zip(SIGNALS, matched, strict=True) if name != "miso")
        return f"edges that agree: {edges}; bits of MISO that agree: {matched[len(SIGNALS) - 1]}"
