# SPDX-License-Identifier: MIT
"""How many lines per second the driver brings over the link, in simulated time."""

from dataclasses import dataclass
from typing import Any

from passo.build import Parameters, model_library
from passo.driver import Driver, DriverError, Source
from passo.engine import Engine
from passo.native import ffi

CLOCK_HZ = 72_000_000
PARAMETERS = Parameters(axes=4)
WORDS_PER_LINE = PARAMETERS.axes + 2
SCLK_HZ = (9_000_000, 18_000_000)
LINES = 3000
VELOCITY = 1 << 47  # a substep every two clocks
LOOP_CLOCKS = 72  # of a main loop that has nothing to send


@dataclass(frozen=True)
class LinkRate:
    """What the link carries at one speed of SCLK, in lines of all axes per second."""

    sclk_hz: int
    limit: float  # SCLK / 32 words per second, in lines
    burst: float  # while the queue never fills up
    sustained: float  # the quickest path tried that was made without a gap

    @property
    def share(self) -> float:
        """Of the wire's limit."""
        return self.burst / self.limit


def _path(substeps: int, lines: int) -> tuple[list[Any], list[Any]]:
    """Lines of so many substeps at full velocity; one ramp covers them all."""
    line = ffi().new("struct passo_line *", {"substeps": substeps, "steps": [1] * PARAMETERS.axes})
    last = ffi().new("struct passo_line *", {"substeps": substeps, "steps": [1] * PARAMETERS.axes})
    last.last = True
    ticks = (2 * substeps * lines >> PARAMETERS.tick_log2) + 1
    jump = ffi().new("struct passo_ramp *", {"velocity_end": VELOCITY})
    cruise = ffi().new("struct passo_ramp *", {"velocity_end": VELOCITY, "ticks": ticks, "last": True})
    cruise.progress_step = (1 << 48) // ticks
    return [line[0]] * (lines - 1) + [last[0]], [jump[0], cruise[0]]


def _stream(sclk_hz: int, substeps: int, lines: int) -> tuple[bool, float]:
    """Whether a path was made without a gap, and the lines per second given out while it was made."""
    config = {"clock_hz": CLOCK_HZ, "spi_half_period": CLOCK_HZ // sclk_hz // 2}
    with Engine(model_library(), PARAMETERS, **config) as engine:
        driver = Driver(engine)
        path, ramps = _path(substeps, lines)
        given: list[int] = []  # clock at which each line was asked for

        def asked() -> Any:
            for line in path:
                given.append(engine.clock)
                yield line

        driver.stream(Source(asked(), ramps))
        whole = True
        try:
            while driver.is_moving:
                driver.poll()
                if driver.idle_microseconds:
                    engine.run(LOOP_CLOCKS)
                engine.drain()
        except DriverError as error:
            if error.name != "LINE_UNDERRUN":
                raise
            whole = False
    fed = given[1 << PARAMETERS.line_queue_log2 :]
    return whole, len(fed) * CLOCK_HZ / (fed[-1] - fed[0]) if fed[-1] > fed[0] else 0.0


def measure(sclk_hz: int) -> LinkRate:
    """The core consumes a little faster than the wire can bring; then a little slower than it did."""
    limit = sclk_hz / 32 / WORDS_PER_LINE
    _, burst = _stream(sclk_hz, int(0.95 * CLOCK_HZ / 2 / limit), LINES)
    substeps = -int(-CLOCK_HZ / 2 / burst // 1)
    while True:
        whole, _ = _stream(sclk_hz, substeps, LINES)
        if whole:
            return LinkRate(sclk_hz, limit, burst, CLOCK_HZ / 2 / substeps)
        substeps += max(1, substeps // 100)


def measure_all() -> list[LinkRate]:
    """At each speed of SCLK."""
    return [measure(sclk_hz) for sclk_hz in SCLK_HZ]
