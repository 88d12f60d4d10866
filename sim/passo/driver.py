# SPDX-License-Identifier: MIT
"""Python binding of the driver (stm32_bridge/driver/passo.h): the same C code as on a microcontroller."""

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from passo.build import Parameters
from passo.link import MICROSECONDS, Hardware, LinkError, error_name, error_text
from passo.moves import Move, PinTiming, q32
from passo.native import ffi, planner, unopened
from passo.plan import struct_of
from passo.registers import Cause, State


class DriverError(LinkError):
    """A call of the driver failed; `name` is the name of the error, such as "CORE_RESET"."""

    def __init__(self, call: str, error: int, text: str = ""):
        super().__init__("", error)
        self.args = (f"{call}: {self.name}: {text or error_text(error)}",)


def new_track(axis: int, backlash: int, speed: Fraction, acceleration: Fraction) -> Any:
    """A `struct passo_track`; in steps, steps/s, steps/s^2."""
    fields = {"top_speed": q32(speed), "acceleration": q32(acceleration)}
    return ffi().new("struct passo_track *", {"axis": axis, "backlash": backlash, **fields})


class Source:
    """A `struct passo_source` with the `struct passo_line` and `struct passo_ramp` of two iterables."""

    def __init__(self, lines: Iterable[Any], ramps: Iterable[Any]):
        """An item None means: none available at the moment."""
        self.ticks: list[int] = []  # of the ramps supplied so far
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
    """One channel of the core of an engine. Functions of passo.h without a method are called with `call`.

    Methods raise DriverError, and the engine's own exceptions.
    """

    _config: tuple[Any, Any] | None = None  # of the last configured axis, and its struct

    def __init__(
        self,
        engine: Any,
        clock_hz: int | None = None,
        parameters: Parameters | None = None,
        channel: int = 0,
        tries: int = 0,
        beside: "Driver | None" = None,
    ):
        """Open the channel; `parameters`, unless None, must match those of the core.

        `beside` is the driver of another channel of the core, which is open already.
        """
        self.engine = engine
        self.clock_hz = clock_hz or engine.clock_hz
        self.lib = planner()
        self.hardware = beside.hardware if beside else Hardware(engine, tries, self.clock_hz)
        self.host = beside.host if beside else unopened("passo_host")
        self.c = unopened("passo")
        self.options = ffi().new("struct passo_options *", {"clock_hz": self.clock_hz, "channel": channel})
        if parameters:
            self.options.channels, self.options.axes = parameters.channels, parameters.axes
            self.options.tick_log2 = parameters.tick_log2
        self._source: Source | None = None
        if beside:
            self._check("open_channel", self.lib.passo_open_channel(self.c, self.host, self.options))
        else:
            self.open()

    def open(self) -> None:
        """Open the channel, or reopen it."""
        error = self.lib.passo_open(self.c, self.host, self.hardware.c, self.options)
        if error == self.lib.PASSO_ERROR_CLOCK:
            told = f"the core runs at {self.c.machine.clock_hz} Hz, not {self.options.clock_hz} Hz"
            raise DriverError("open", error, told)
        self._check("open", error)

    def call(self, name: str, *arguments: Any) -> None:
        """Call passo_NAME(); raises DriverError if it fails."""
        self._check(name, self.attempt(name, *arguments))

    def attempt(self, name: str, *arguments: Any) -> int:
        """Call passo_NAME() and return its enum passo_error."""
        error = getattr(self.lib, f"passo_{name}")(self.c, *arguments)
        self.hardware.check()
        return error

    def move(self, move: Move) -> None:
        """Queue a move, as passo_move_FORM() does; of those with a table of their own: `call`."""
        self.call(f"move_{move.form.name}", struct_of(move, self.clock_hz))

    def configure_axis(self, axis: int, pins: PinTiming, **fields: Any) -> None:
        """Set the pins of an axis and enable its drive; `fields` are members of struct passo_axis_config."""
        if self._config is None or self._config[0] != (pins, fields):  # mostly all axes have one
            config = {
                "step_high_ns": pins.step_high,
                "step_low_ns": pins.step_low,
                "dir_setup_ns": pins.dir_setup,
                "dir_hold_ns": pins.dir_hold,
                "in_clocks": True,
                **fields,
            }
            self._config = (pins, fields), ffi().new("struct passo_axis_config *", config)
        self.call("configure_axis", axis, self._config[1])
        self.call("enable", axis, True)

    def stream(self, source: Source) -> None:
        """Start to stream from a source; `poll` feeds the queues."""
        self._source = source
        self.call("stream", source.c)

    def poll(self) -> None:
        """passo_poll(): at most one frame; raises each error once."""
        self.call("poll")

    def wait(self, seconds: float = 0) -> None:
        """Poll until all motions have ended; 0: no timeout."""
        self.call("wait", round(seconds * self.clock_hz))

    @property
    def is_moving(self) -> bool:
        """Whether a queued motion has not ended yet, as of the last `poll`."""
        return self.lib.passo_is_moving(self.c)

    @property
    def is_streaming(self) -> bool:
        """Whether a stream has not been sent completely yet."""
        return self.lib.passo_is_streaming(self.c)

    @property
    def idle_microseconds(self) -> int:
        """Time until `poll` has something to do."""
        return self.lib.passo_idle_time(self.c)

    @property
    def idle_clocks(self) -> int:
        """The same in clocks, rounded up."""
        return -(-self.idle_microseconds * self.clock_hz // MICROSECONDS)

    @property
    def fault(self) -> str:
        """Name of the present error (passo_fault()), or "OK"."""
        return error_name(self.lib.passo_fault(self.c))

    @property
    def counters(self) -> Any:
        """The `struct passo_counters`."""
        return self.host.counters

    def tracker(self, axis: int) -> Any:
        """The `struct passo_track_reading`."""
        reading = ffi().new("struct passo_track_reading *")
        self.call("read_tracker", axis, reading)
        return reading

    def positions(self) -> list[int]:
        """Steps made by each axis, all sampled at the same time."""
        positions = ffi().new("int32_t[8]")
        self.call("positions", positions)
        return list(positions[0 : self.c.axes])

    def snapshot(self) -> Any:
        """Read the present `struct passo_snapshot`."""
        snapshot = ffi().new("struct passo_snapshot *")
        self.call("read_state", snapshot)
        return snapshot

    @property
    def state(self) -> State:
        """State of the channel, as of the last read."""
        return State(self.c.snapshot.state)

    @property
    def cause(self) -> Cause:
        """Cause of the last stop, as of the last read."""
        return Cause(self.c.snapshot.cause)

    def _check(self, call: str, error: int) -> None:
        self.hardware.check()
        if error != self.lib.PASSO_OK:
            raise DriverError(call, error)
