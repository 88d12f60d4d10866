# SPDX-License-Identifier: MIT
"""The engines that execute the core: the C model, the Verilated RTL, and both in lockstep."""

from collections.abc import Sequence
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any, Self

import numpy as np

from passo.build import Parameters, model_library, rtl_library
from passo.failure import Failure
from passo.native import ffi, load
from passo.pins import INPUTS, OUTPUTS

# Pin levels after each clock on which an output pin changes; clock 1 is the first one after reset. A pin has
# a bit per axis, channel * axes + axis, or per channel.
EVENT = np.dtype([("clock", "u8"), *((pin.name, "u8") for pin in OUTPUTS)])
SIGNALS = EVENT.names[1:]
EVENTS_PER_DRAIN = 65536
NUMBERS = {pin.name: number for number, pin in enumerate(INPUTS)}


@cache
def _untouched() -> Any:
    """Allocates without clearing: a short motion uses little of the megabytes for its events."""
    return ffi().new_allocator(should_clear_after_alloc=False)


class DifferenceError(Failure):
    """RTL and model differ: `expected` is the model's level or word, `actual` the RTL's."""

    def __init__(self, clock: int, signal: str, index: int, expected: int, actual: int):
        self.clock, self.signal, self.index = clock, signal, index
        self.expected, self.actual = expected, actual
        of_axes = [pin.name for pin in OUTPUTS if "AXES" in pin.width]
        place = "word" if signal == "miso" else "axis" if signal in of_axes else "bit"
        show = hex if signal == "miso" else str
        super().__init__(
            f"clock {clock}: {signal} of {place} {index} differs: "
            f"expected (model) {show(expected)}, actual (rtl) {show(actual)}"
        )

    def __reduce__(self) -> tuple[type, tuple[int | str, ...]]:
        """Can be passed between processes."""
        return type(self), (self.clock, self.signal, self.index, self.expected, self.actual)


class _Closed:
    """Closes itself at the end of a with statement."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Free what it has."""
        raise NotImplementedError


class Engine(_Closed):
    """A core that is accessed through its pins; see sim/engine/passo_engine.h."""

    def __init__(
        self,
        library: Path,
        parameters: Parameters,
        clock_hz: int = 100_000_000,
        spi_half_period: int = 2,
        every_clock: bool = False,
    ):
        self.parameters = parameters
        self.clock_hz = clock_hz
        self._c = load(library)
        config = ffi().new("struct passo_engine_config *")
        config.core = asdict(parameters)
        config.clock_hz, config.spi_half_period, config.every_clock = clock_hz, spi_half_period, every_clock
        self._events = _untouched()("struct passo_pin_event[]", EVENTS_PER_DRAIN)
        self._engine = self._c.passo_engine_create(config)
        if self._engine == ffi().NULL:
            raise RuntimeError(f"{library} does not support {parameters}")

    def close(self) -> None:
        """Free the engine; it cannot be used any more."""
        self._c.passo_engine_destroy(self._engine)
        self._engine = ffi().NULL

    @property
    def clock(self) -> int:
        """Clocks since reset."""
        return self._c.passo_engine_clock(self._engine)

    def transfer(self, mosi: Sequence[int], gap: int = 16) -> list[int]:
        """One chip select: send the words and return those received, then wait for `gap` clocks."""
        miso = ffi().new("uint32_t[]", len(mosi))
        self._c.passo_engine_transfer(self._engine, ffi().new("uint32_t[]", mosi), miso, len(mosi), gap)
        return list(miso)

    def run(self, clocks: int) -> int:
        """Run for up to `clocks`, fewer if many events are waiting; return the clocks executed."""
        return self._c.passo_engine_run(self._engine, clocks)

    def pace(self, clocks: int, ticks: int) -> None:
        """Set the time unit of an external master: `ticks` last as long as `clocks`. Tick 0 is now."""
        self._c.passo_engine_pace(self._engine, clocks, ticks)

    def follow(self, tick: int) -> int:
        """Run to the end of a tick, or until irq changes or many events wait; return the tick reached."""
        return self._c.passo_engine_follow(self._engine, tick)

    def select(self, selected: bool) -> None:
        """Assert or release chip select now."""
        self._c.passo_engine_select(self._engine, selected)

    def exchange(self, mosi: bytes, half_period: int) -> bytes:
        """Exchange bytes in SPI mode 0; each SCLK level lasts `half_period` ticks."""
        miso = ffi().new("uint8_t[]", len(mosi))
        self._c.passo_engine_exchange(self._engine, mosi, miso, len(mosi), half_period)
        return bytes(miso)

    @property
    def irq(self) -> int:
        """Level of the irq pins, one bit per channel."""
        return self._c.passo_engine_irq(self._engine)

    @property
    def running(self) -> int:
        """Level of the running pins, one bit per channel."""
        return self._c.passo_engine_running(self._engine)

    def attach(self, config: Any) -> list[tuple[Any, Any]]:
        """Connect a machine (`struct passo_rig_config`); return it, with the library of its functions."""
        return [(self._c, self._c.passo_engine_attach(self._engine, config))]

    def set(self, pin: str, levels: int) -> None:
        """Set the levels of an input pin, a bit per axis or channel."""
        self._c.passo_engine_set(self._engine, NUMBERS[pin], levels)

    def sync(self, level: bool) -> None:
        """Set the sync input."""
        self.set("sync", level)

    def drain(self) -> np.ndarray:
        """The pin events (EVENT) since the last call."""
        chunks = [self._drain_some()]
        while len(chunks[-1]) == EVENTS_PER_DRAIN:
            chunks.append(self._drain_some())
        return chunks[0] if len(chunks) == 1 else np.concatenate(chunks)

    def _drain_some(self) -> np.ndarray:
        count = self._c.passo_engine_drain(self._engine, self._events, EVENTS_PER_DRAIN)
        return np.frombuffer(ffi().buffer(self._events), EVENT, count).copy()

    def open_waves(self, path: Path, begin: int, end: int) -> None:
        """Record all signals of the core to an FST file; requires an engine built with waves.

        From `begin` to `end` clocks after the motion has started; with `begin` 0 from now on.
        """
        if not self._c.passo_engine_open_waves(self._engine, str(path).encode(), begin, end):
            raise OSError(f"cannot write waves to {path}")

    def close_waves(self) -> None:
        """Close the waves file."""
        self._c.passo_engine_close_waves(self._engine)


def model_engine(parameters: Parameters, clock_hz: int = 100_000_000, every_clock: bool = False) -> Engine:
    """The C model."""
    return Engine(model_library(), parameters, clock_hz, every_clock=every_clock)


def rtl_engine(parameters: Parameters, clock_hz: int = 100_000_000, waves: bool = False) -> Engine:
    """The Verilated core."""
    return Engine(rtl_library(parameters, waves), parameters, clock_hz)


class PairEngine(_Closed):
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
        self._compare()
        for i, (e, a) in enumerate(zip(expected, actual, strict=True)):
            if e != a:
                raise DifferenceError(clock, "miso", i, e, a)
        return actual

    def run(self, clocks: int) -> int:
        """Run both and compare their pins."""
        actual, expected = self.rtl.run(clocks), self.model.run(clocks)
        self._compare()
        assert actual == expected  # the same events fill both logs on the same clock
        return actual

    @property
    def irq(self) -> int:
        """Level of the irq pins; their changes are compared like those of all pins."""
        return self.rtl.irq

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

    def _compare(self) -> None:
        actual, expected = self.rtl.drain(), self.model.drain()
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
