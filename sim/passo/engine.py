# SPDX-License-Identifier: MIT
"""The engines that execute the core: the C model and the Verilated RTL; both in lockstep: pair_engine.py."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Self

import numpy as np

from passo.build import Parameters, model_library, rtl_library
from passo.failure import Failure
from passo.native import ffi, load
from passo.pins import INPUTS, OUTPUTS
from passo.toolchain import paths

# Pin levels after each clock on which an output pin changes; clock 1 is the first one after reset. A pin has
# a bit per axis, channel * axes + axis, or per channel.
EVENT = np.dtype([("clock", "u8"), *((pin.name, "u8") for pin in OUTPUTS)])
NUMBERS = {pin.name: number for number, pin in enumerate(INPUTS)}


def moves_of(events: np.ndarray, bit: int) -> np.ndarray:
    """The step that the pins of a bit make at each of all events (EVENT): -1, 0, 1."""
    level, back = ((events[pin] >> np.uint64(bit) & np.uint64(1)).astype(np.int8) for pin in ("step", "dir"))
    rises = level.copy()
    rises[1:] &= ~level[:-1]
    return rises * (1 - 2 * back)


def bits_of(words: np.ndarray, count: int) -> np.ndarray:
    """The lowest bits of words, each in a column: words x `count`, 0 or 1."""
    return np.unpackbits(words.astype("<u8")[:, None].view(np.uint8), axis=1, count=count, bitorder="little")


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


class Closed:
    """Closes itself at the end of a with statement."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Free what it has."""
        raise NotImplementedError


class Engine(Closed):
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
        config.core = vars(parameters)
        config.clock_hz, config.spi_half_period, config.every_clock = clock_hz, spi_half_period, every_clock
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

    def pass_looks(self, period: int, look: int) -> int:
        """Run through periods in which a host would read what it did before; see passo_engine.h."""
        return self._c.passo_engine_pass_looks(self._engine, period, look)

    def connect(self, hardware: Any, timed: bool) -> None:
        """Make this engine a `struct passo_hardware`, with a clock if `timed`, without Python between."""
        for name in ("transfer", "microseconds", "wait") if timed else ("transfer",):
            setattr(hardware, name, ffi().addressof(self._c, f"passo_engine_host_{name}"))
        hardware.context = self._engine

    @property
    def waiting(self) -> int:
        """Events that are waiting to be drained."""
        return self._c.passo_engine_waiting(self._engine)

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
        events = np.empty(self.waiting, EVENT)
        if len(events):
            into = ffi().from_buffer("struct passo_pin_event[]", events)
            self._c.passo_engine_drain(self._engine, into, len(events))
        return events

    def open_waves(self, path: Path, begin: int, end: int) -> None:
        """Record all signals of the core to an FST file; requires an engine built with waves.

        From `begin` to `end` clocks after the motion has started; with `begin` 0 from now on.
        """
        if not self._c.passo_engine_open_waves(self._engine, str(path).encode(), begin, end):
            raise OSError(f"cannot write waves to {path}")

    def close_waves(self) -> None:
        """Close the waves file."""
        self._c.passo_engine_close_waves(self._engine)


class AroundEngine:
    """Something around an engine that a host takes for one."""

    def __init__(self, engine: Any):
        self.engine = engine
        self.parameters, self.clock_hz = engine.parameters, engine.clock_hz

    @property
    def clock(self) -> int:
        """Clocks since reset."""
        return self.engine.clock

    @property
    def irq(self) -> int:
        """Level of the irq pins."""
        return self.engine.irq


def model_engine(parameters: Parameters, clock_hz: int = 100_000_000, every_clock: bool = False) -> Engine:
    """The C model."""
    return Engine(model_library(), parameters, clock_hz, every_clock=every_clock)


def rtl_engine(
    parameters: Parameters, clock_hz: int = 100_000_000, waves: bool = False, rtl: Path = paths.rtl
) -> Engine:
    """The Verilated core; `rtl`: a folder with a changed copy of it."""
    return Engine(rtl_library(parameters, waves, rtl), parameters, clock_hz)
