# SPDX-License-Identifier: MIT
"""How fast the engines are; every figure is measured, and also written to build/bench.json."""

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from passo.build import Parameters
from passo.engine import Engine, model_engine, rtl_engine
from passo.moves import MoveFile, MoveInTime, PinTiming
from passo.plan import plan_file
from passo.report import write_json
from passo.run import execute
from passo.toolchain import paths

CLOCK_HZ = 100_000_000
STEPS_PER_SECOND = (10_000, 6_000, 4_000, 2_000)
PARAMETERS = Parameters(axes=4)
REPORT = paths.build / "bench.json"

# Name, what it is, seconds of motion, engine.
ENGINES: tuple[tuple[str, str, Fraction, Callable[[], Engine]], ...] = (
    ("rtl", "Verilated core", Fraction(1, 5), lambda: rtl_engine(PARAMETERS)),
    ("model", "C model, clock by clock", Fraction(1, 5), lambda: model_engine(PARAMETERS, every_clock=True)),
    ("advance", "C model, passo_core_advance()", Fraction(20), lambda: model_engine(PARAMETERS)),
)


def bench() -> dict[str, Any]:
    """Measure, print, write the report and return it."""
    speeds = {name: _clocks_per_second(make, seconds) for name, _, seconds, make in ENGINES}
    table = Table(title="1 channel, 4 axes at 10, 6, 4 and 2 kHz, 100 MHz clock", title_justify="left")
    table.add_column("engine")
    table.add_column("clocks/s", justify="right")
    table.add_column("real time / simulated time", justify="right")
    for name, text, _, _ in ENGINES:
        table.add_row(text, f"{speeds[name] / 1e6:,.2f} M", f"{CLOCK_HZ / speeds[name]:.2g}")
    report = {
        "clock_hz": CLOCK_HZ,
        "steps_per_second": list(STEPS_PER_SECOND),
        "clocks_per_second": {name: round(speed) for name, speed in speeds.items()},
        "advance_ratio": round(speeds["advance"] / speeds["model"], 1),
    }
    write_json(report, REPORT)
    console = Console()
    console.print(table)
    console.print(f"passo_core_advance() is {report['advance_ratio']} times as fast as clock by clock")
    console.print(f"Report: {REPORT.relative_to(paths.root)}")
    return report


def _clocks_per_second(make: Callable[[], Engine], seconds: Fraction) -> float:
    """Speed of an engine during a motion, SPI frames and the recording of the pins included."""
    steps = tuple(int(speed * seconds) for speed in STEPS_PER_SECOND)
    file = MoveFile(
        Path("bench"), CLOCK_HZ, PinTiming(), (MoveInTime(steps, "linear", seconds, Fraction(0)),)
    )
    with make() as engine:
        run = execute(file, plan_file(file, PARAMETERS), engine)
    assert not run.problems(), run.problems()
    return run.clocks / run.seconds
