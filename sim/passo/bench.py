# SPDX-License-Identifier: MIT
"""Speed of the engines and the link, measured in processor time and written to build/bench.json."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from passo.build import Parameters
from passo.console import cancelable, console, each, table
from passo.engine import Engine, model_engine, rtl_engine
from passo.link_bench import measure_all
from passo.moves import MoveFile, MoveInTime, PinTiming
from passo.output import make_folder, write_json
from passo.plan import plan_file
from passo.run import execute
from passo.toolchain import paths, short

CLOCK_HZ = 100_000_000
PARAMETERS = Parameters(axes=4)
REPORT = paths.results / "bench.json"

ONE_AXIS = (10_000,)  # steps per second
FOUR_AXES = (10_000, 6_000, 4_000, 2_000)


@dataclass(frozen=True)
class Measurement:
    """A motion at constant speed on an engine; `seconds` is simulated time."""

    name: str
    text: str
    steps_per_second: tuple[int, ...]
    seconds: Fraction
    engine: Callable[[], Engine]

    def clocks_per_second(self) -> float:
        """Clocks per second of the processor for the motion, including SPI frames and pin recording."""
        steps = tuple(int(speed * self.seconds) for speed in self.steps_per_second)
        move = MoveInTime(steps, "linear", self.seconds, Fraction(0))
        file = MoveFile(Path(self.name), CLOCK_HZ, PinTiming(), (move,))
        with self.engine() as engine:
            began = time.process_time()
            run = execute(file, plan_file(file, PARAMETERS), engine)
            seconds = time.process_time() - began
        assert not run.problems(), run.problems()
        return run.clocks / seconds


def _rtl() -> Engine:
    return rtl_engine(PARAMETERS)


def _model() -> Engine:
    return model_engine(PARAMETERS, every_clock=True)


def _advance() -> Engine:
    return model_engine(PARAMETERS)


MEASUREMENTS = (
    Measurement("rtl_4_axes", "Verilated core", FOUR_AXES, Fraction(1, 5), _rtl),
    Measurement("model_4_axes", "C model, clock by clock", FOUR_AXES, Fraction(1, 5), _model),
    Measurement("advance_4_axes", "C model, passo_core_advance()", FOUR_AXES, Fraction(20), _advance),
    Measurement("model_1_axis", "C model, clock by clock", ONE_AXIS, Fraction(1, 5), _model),
    Measurement("advance_1_axis", "C model, passo_core_advance()", ONE_AXIS, Fraction(40), _advance),
)


def bench() -> dict[str, Any]:
    """Measure, print, write build/bench.json and return its contents; nothing if it is canceled."""
    shown = table("Core with 1 channel of 4 axes at 100 MHz", "engine", "motion", "clocks/s", "of real time")
    speeds = {}
    with cancelable() as work:
        for m in each("speeds", MEASUREMENTS):
            speed = speeds[m.name] = m.clocks_per_second()
            kilohertz = ", ".join(f"{steps / 1000:g}" for steps in m.steps_per_second)
            shown.add_row(m.text, f"{kilohertz} kHz", f"{speed / 1e6:,.1f} M", f"{speed / CLOCK_HZ:.2g}")
    if work.canceled:
        console.print(shown)
        return {}
    links = table(
        "Lines of 4 axes over the link, core at 72 MHz", "SCLK", "link limit", "fed", "without a gap"
    )
    rates = measure_all()
    for rate in rates:
        links.add_row(
            f"{rate.sclk_hz / 1e6:g} MHz",
            f"{rate.limit:,.0f}/s",
            f"{rate.burst:,.0f}/s ({rate.share:.1%})",
            f"{rate.sustained:,.0f}/s ({rate.sustained / rate.limit:.1%})",
        )
    ratios = {axes: speeds[f"advance_{axes}"] / speeds[f"model_{axes}"] for axes in ("1_axis", "4_axes")}
    report = {
        "clock_hz": CLOCK_HZ,
        "clocks_per_second": {name: round(speed) for name, speed in speeds.items()},
        "advance_ratio": {axes: round(ratio, 1) for axes, ratio in ratios.items()},
        "lines_per_second": {str(rate.sclk_hz): round(rate.sustained) for rate in rates},
    }
    make_folder(REPORT.parent)
    write_json(report, REPORT)
    console.print(shown)
    console.print(links)
    console.print(
        f"passo_core_advance() against clock by clock: {ratios['1_axis']:.0f} times as fast with one axis,\n"
        f"{ratios['4_axes']:.0f} times as fast with four"
    )
    console.print(f"Report: {short(REPORT)}")
    return report
