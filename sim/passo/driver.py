# SPDX-License-Identifier: MIT
"""The driver (stm32_bridge/driver/passo.h) for Python: the same C code that runs on a microcontroller."""

from collections.abc import Iterable
from typing import Any

from passo.build import Parameters
from passo.link import Hardware, LinkError, error_name, error_text
from passo.moves import PinTiming
from passo.native import ffi, planner
from passo.registers import Cause, State

MICROSECONDS = 1_000_000


class DriverError(LinkError):
    """A call of the driver failed; `name` is that of the error, as "CORE_RESET"."""

    def __init__(self, call: str, error: int):
        super().__init__("", error)
        self.args = (f"{call}: {self.name}: {error_text(error)}",)


class Source:
    """A `struct passo_source` that gives out `struct passo_line` and `struct passo_ramp` of two iterables."""

    def __init__(self, lines: Iterable[Any], ramps: Iterable[Any]):
        """An item None stands for: there is none at the moment."""
        self.ticks: list[int] = []  # of the ramps given out
        self._lines, self._ramps = iter(lines), iter(ramps)
        self._callbacks = (
            ffi().callback("bool(void *, struct passo_line *)", self._line),
            ffi().callback("bool(void *, struct passo_ramp *)", self._ramp),
        )
        self.c = ffi().new("struct passo_source *", (*self._callbacks, ffi().NULL))

    def _line(self, _: Any, line: Any) -> bool:
        item = next(self._lines, None)
        if item is not None:
            line[0] = item
        return item is not None

    def _ramp(self, _: Any, ramp: Any) -> bool:
        item = next(self._ramps, None)
        if item is not None:
            ramp[0] = item
            self.ticks.append(item.ticks)
        return item is not None


class Driver:
    """One channel of the core behind an engine. Methods not listed here are called with `call`."""

    def __init__(
        self,
        engine: Any,
        clock_hz: int | None = None,
        parameters: Parameters | None = None,
        channel: int = 0,
        tries: int = 0,
    ):
        """Open it; `parameters` are what the core must have, unless None. Raise DriverError."""
        self.engine = engine
        self.clock_hz = clock_hz or engine.clock_hz
        self.lib = planner()
        self.hardware = Hardware(engine, tries, self.clock_hz)
        self.host = ffi().new("struct passo_host *")
        self.c = ffi().new("struct passo *")
        self.options = ffi().new("struct passo_options *", {"clock_hz": self.clock_hz, "channel": channel})
        if parameters:
            self.options.channels, self.options.axes = parameters.channels, parameters.axes
            self.options.tick_log2 = parameters.tick_log2
        self._source: Source | None = None
        self.open()

    def open(self) -> None:
        """Make contact, also again."""
        self._check("open", self.lib.passo_open(self.c, self.host, self.hardware.c, self.options))

    def call(self, name: str, *arguments: Any) -> None:
        """Call passo_NAME(); raise DriverError if it fails."""
        self._check(name, self.attempt(name, *arguments))

    def attempt(self, name: str, *arguments: Any) -> int:
        """Call passo_NAME() and return one of enum passo_error."""
        error = getattr(self.lib, f"passo_{name}")(self.c, *arguments)
        self.hardware.check()
        return error

    def configure_axis(self, axis: int, pins: PinTiming, **fields: Any) -> None:
        """Set the pins of an axis, and enable its drive; `fields` are those of struct passo_axis_config."""
        config = {
            "step_high_ns": pins.step_high,
            "step_low_ns": pins.step_low,
            "dir_setup_ns": pins.dir_setup,
            "dir_hold_ns": pins.dir_hold,
            "in_clocks": True,
            **fields,
        }
        self.call("configure_axis", axis, ffi().new("struct passo_axis_config *", config))
        self.call("enable", axis, True)

    def stream(self, source: Source) -> None:
        """Feed the queues from a source; `poll` does it."""
        self._source = source
        self.call("stream", source.c)

    def poll(self) -> None:
        """At most one frame; raise DriverError when something went wrong, once."""
        self.call("poll")

    def wait(self, seconds: float = 0) -> None:
        """Poll until all has ended."""
        self.call("wait", round(seconds * MICROSECONDS))

    @property
    def is_moving(self) -> bool:
        """Something queued has not ended, as far as `poll` has seen."""
        return self.lib.passo_is_moving(self.c)

    @property
    def is_streaming(self) -> bool:
        """Not everything has been sent."""
        return self.lib.passo_is_streaming(self.c)

    @property
    def idle_microseconds(self) -> int:
        """Until `poll` has something to do."""
        return self.lib.passo_idle_time(self.c)

    @property
    def fault(self) -> str:
        """Name of what is wrong until it is cleared, or gets through: OK, if nothing."""
        return error_name(self.lib.passo_fault(self.c))

    @property
    def counters(self) -> Any:
        """The `struct passo_counters`."""
        return self.host.counters

    def positions(self) -> list[int]:
        """Steps made by each axis, all at one moment."""
        positions = ffi().new("int32_t[8]")
        self.call("positions", positions)
        return list(positions[0 : self.c.machine.axes])

    def snapshot(self) -> Any:
        """The `struct passo_snapshot` of now."""
        snapshot = ffi().new("struct passo_snapshot *")
        self.call("read_state", snapshot)
        return snapshot

    @property
    def state(self) -> State:
        """As `poll` saw it last."""
        return State(self.c.snapshot.state)

    @property
    def cause(self) -> Cause:
        """As `poll` saw it last."""
        return Cause(self.c.snapshot.cause)

    def _check(self, call: str, error: int) -> None:
        self.hardware.check()
        if error != self.lib.PASSO_OK:
            raise DriverError(call, error)
