# SPDX-License-Identifier: MIT
"""Throughput of the driver over the link, in lines per second of simulated time."""

from dataclasses import dataclass
from typing import Any

from passo.build import Parameters, model_library
from passo.driver import Driver, DriverError, Source
from passo.engine import Engine
from passo.moves import PinTiming
from passo.native import ffi

CLOCK_HZ = 72_000_000
PARAMETERS = Parameters(axes=4)
WORDS_PER_LINE = PARAMETERS.axes + 2
SCLK_HZ = (9_000_000, 18_000_000)
LINES = 3000
VELOCITY = 1 << 47  # a substep every two clocks
LOOP_CLOCKS = 72  # of an idle round of the main loop


@dataclass(frozen=True)
class LinkRate:
    """Throughput of the link at one SCLK frequency, in lines of all axes per second."""

    sclk_hz: int
    limit: float  # SCLK / 32 words per second, in lines
    burst: float  # while the queue is never full
    sustained: float  # the fastest path tried that had no underrun

    @property
    def share(self) -> float:
        """Burst rate relative to the limit."""
        return self.burst / self.limit


def _path(substeps: int, lines: int) -> tuple[list[Any], list[Any]]:
    """Lines of `substeps` each at full velocity, and the ramps for all of them."""
    line = ffi().new("struct passo_line *", {"substeps": substeps, "steps": [1] * PARAMETERS.axes})
    last = ffi().new("struct passo_line *", {"substeps": substeps, "steps": [1] * PARAMETERS.axes})
    last.last = True
    ticks = (2 * substeps * lines >> PARAMETERS.tick_log2) + 1
    jump = ffi().new("struct passo_ramp *", {"velocity_end": VELOCITY})
    cruise = ffi().new("struct passo_ramp *", {"velocity_end": VELOCITY, "ticks": ticks, "last": True})
    cruise.progress_step = (1 << 48) // ticks
    return [line[0]] * (lines - 1) + [last[0]], [jump[0], cruise[0]]


def _stream(sclk_hz: int, substeps: int, lines: int) -> tuple[bool, float]:
    """Whether a path had no underrun, and the lines per second supplied during it."""
    config = {"clock_hz": CLOCK_HZ, "spi_half_period": CLOCK_HZ // sclk_hz // 2}
    with Engine(model_library(), PARAMETERS, **config) as engine:
        driver = Driver(engine)
        for axis in range(PARAMETERS.axes):
            driver.configure_axis(axis, PinTiming())
        path, ramps = _path(substeps, lines)
        given: list[int] = []  # clock at which each line was requested

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
    """Measure the burst rate with a path slightly faster than the link, then find the sustained rate."""
    limit = sclk_hz / 32 / WORDS_PER_LINE
    _, burst = _stream(sclk_hz, int(0.95 * CLOCK_HZ / 2 / limit), LINES)
    substeps = -int(-CLOCK_HZ / 2 / burst // 1)
    while True:
        whole, _ = _stream(sclk_hz, substeps, LINES)
        if whole:
            return LinkRate(sclk_hz, limit, burst, CLOCK_HZ / 2 / substeps)
        substeps += max(1, substeps // 100)


def measure_all() -> list[LinkRate]:
    """Measure at each frequency in SCLK_HZ."""
    return [measure(sclk_hz) for sclk_hz in SCLK_HZ]
