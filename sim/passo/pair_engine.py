# SPDX-License-Identifier: MIT
"""RTL and model in lockstep."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from passo.engine import EVENT, Closed, DifferenceError, Engine

SIGNALS = EVENT.names[1:]


class PairEngine(Closed):
    """RTL and model with the same input waveforms; all outputs are compared, see DifferenceError."""

    def __init__(self, rtl: Engine, model: Engine):
        self.rtl, self.model = rtl, model
        self.parameters, self.clock_hz = rtl.parameters, rtl.clock_hz
        self.matched_edges = 0  # edges of STEP, DIR and EN that agree
        self._last = np.zeros(1, EVENT)
        self._events: list[np.ndarray] = []

    def close(self) -> None:
        """Free both engines."""
        self.rtl.close()
        self.model.close()

    @property
    def clock(self) -> int:
        """Clocks since reset."""
        return self.rtl.clock

    def transfer(self, mosi: Sequence[int], gap: int = 16) -> list[int]:
        """Send the same words to both and compare the replies."""
        clock = self.clock
        actual, expected = self.rtl.transfer(mosi, gap), self.model.transfer(mosi, gap)
        self._compare(self.rtl.drain())
        for i, (e, a) in enumerate(zip(expected, actual, strict=True)):
            if e != a:
                raise DifferenceError(clock, "miso", i, e, a)
        return actual

    def run(self, clocks: int) -> int:
        """Run both and compare their pins."""
        actual, expected = self.rtl.run(clocks), self.model.run(clocks)
        self._compare(self.rtl.drain())
        assert actual == expected  # the same events fill both logs on the same clock
        return actual

    def pass_looks(self, period: int, look: int) -> int:
        """Run both, as far as the model knows that there is nothing to read."""
        clocks = left = self.model.pass_looks(period, look)
        events = [np.empty(0, EVENT)]
        while left:
            left -= self.rtl.run(left)
            events.append(self.rtl.drain())
        self._compare(np.concatenate(events))
        return clocks

    @property
    def waiting(self) -> int:
        """None are in the log, as they are kept here."""
        return 0

    @property
    def irq(self) -> int:
        """Level of the irq pins; their changes are compared like those of all pins."""
        return self.rtl.irq

    @property
    def running(self) -> int:
        """Level of the running pins."""
        return self.rtl.running

    def attach(self, config: Any) -> list[tuple[Any, Any]]:
        """Connect equal machines to both."""
        return self.rtl.attach(config) + self.model.attach(config)

    def set(self, pin: str, levels: int) -> None:
        """Set the levels of an input pin of both."""
        self.rtl.set(pin, levels)
        self.model.set(pin, levels)

    def sync(self, level: bool) -> None:
        """Set the sync input of both."""
        self.set("sync", level)

    def drain(self) -> np.ndarray:
        """The pin events (EVENT) since the last call, which are the same in both."""
        events, self._events = self._events, []
        return np.concatenate([np.empty(0, EVENT), *events])

    def open_waves(self, path: Path, begin: int, end: int) -> None:
        """Record the waves of the RTL."""
        self.rtl.open_waves(path, begin, end)

    def close_waves(self) -> None:
        """Close the waves file."""
        self.rtl.close_waves()

    def _compare(self, actual: np.ndarray) -> None:
        """Of the RTL, with those of the model."""
        expected = self.model.drain()
        if not np.array_equal(actual, expected):
            raise first_difference(expected, actual, self._last[0])
        if len(actual):
            self.matched_edges += count_edges(np.concatenate([self._last, actual]))
            self._last = actual[-1:]
            self._events.append(actual)


def count_edges(events: np.ndarray) -> int:
    """Edges of STEP, DIR and EN from the first event on."""
    changed = (events[s][1:] ^ events[s][:-1] for s in ("step", "dir", "enable"))
    return sum(int(np.bitwise_count(bits).sum()) for bits in changed)


def first_difference(expected: np.ndarray, actual: np.ndarray, before: np.void) -> DifferenceError:
    """The first difference between two lists of events that follow the same event `before`."""
    common = min(len(expected), len(actual))
    at = int(np.argmax(expected[:common] != actual[:common])) if common else 0
    if common and expected[at] == actual[at]:
        at = common
    last = before if at == 0 else expected[at - 1]
    e = expected[at] if at < len(expected) else None
    a = actual[at] if at < len(actual) else None
    clock = min(int(event["clock"]) for event in (e, a) if event is not None)
    # The engine whose event comes later still has its previous pin levels.
    e = e if e is not None and e["clock"] == clock else last
    a = a if a is not None and a["clock"] == clock else last
    signal = next(s for s in SIGNALS if e[s] != a[s])
    different = int(e[signal]) ^ int(a[signal])
    bit = (different & -different).bit_length() - 1
    return DifferenceError(clock, signal, bit, int(e[signal]) >> bit & 1, int(a[signal]) >> bit & 1)
