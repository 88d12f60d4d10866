# SPDX-License-Identifier: MIT
"""`make report PARTS=1`: what each optional part of the core costs, once and per axis, and the clock with it.

The size is that after synthesis: LUTs, flip-flops and block RAMs of cores with and without the part; for a
motor without lines (TRACKED), of a core with trackers and with these motors besides. The clock is that of the
device of CLOCK_DEVICE, over several seeds, also without a part.
"""

import statistics
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from typing import Any

from passo.console import Estimate, console, stages, table
from passo.output import check_results, write_json
from passo.toolchain import paths

from passo_fpga.design import Design, core
from passo_fpga.devices import DEVICES, SPI_MHZ, Device
from passo_fpga.flow import cells, place, synthesize
from passo_fpga.pages import markdown, mhz, write_block
from passo_fpga.parts import NEEDS, PORTS
from passo_fpga.tools import prepare, workers

REPORT = paths.build / "report-parts.json"
PAGE = paths.docs / "integration.md"
FEW, MANY = 1, 4  # axes
SEEDS = range(1, 9)
CLOCK_DEVICE = "hx8k"
COLUMNS = ("LUT", "FF", "BRAM")
TRACKED = "tracked"
PARTS = (*PORTS, TRACKED)


def design(device: Device, axes: int, part: str = "") -> Design:
    """The core with a part and what that needs, or with none; of "tracked" half of the axes have no lines."""
    if part == TRACKED:
        made = core(device, size=(1, axes), parts=("trackers",))
        return replace(made, name=f"{made.name}-{part}", parameters={**made.parameters, "TRACKED": axes // 2})
    return core(device, size=(1, axes), parts=tuple(name for name in (part, NEEDS.get(part)) if name))


def axes_of(part: str) -> int:
    """Axes of the core whose clock is that of a part: as many with lines."""
    return 2 * MANY if part == TRACKED else MANY


def measure(names: Sequence[str]) -> dict[str, Any]:
    """Synthesise, place and route what is not cached; return the figures."""
    tell = stages()
    devices = [DEVICES[name] for name in names]
    prepare(dict.fromkeys(program for device in devices for program in device.family.programs), tell)
    wanted = [
        design(device, axes, part) for device in devices for axes in (FEW, MANY) for part in ("", *PORTS)
    ]
    wanted += [design(device, axes_of(TRACKED), TRACKED) for device in devices]
    with ThreadPoolExecutor(workers()) as pool:
        estimate = Estimate(len(wanted))
        for count, made in enumerate(pool.map(_synthesized, wanted), 1):
            tell(f"synthesis {estimate.counted(count)}: {made.name}")
        clocks = _clocks(pool, tell) if CLOCK_DEVICE in names else []
    sizes = [row(device, part) for device in devices for part in PARTS]
    return {"axes": [FEW, MANY], "seeds": list(SEEDS), "sizes": sizes, "clocks": clocks}


def _synthesized(made: Design) -> Design:
    synthesize(made)
    return made


def row(device: Device, part: str) -> dict[str, Any]:
    """Cost once and per axis, from cores with few and with many axes."""
    if part == TRACKED:
        alone, beside = cells(design(device, MANY, "trackers")), cells(design(device, axes_of(part), part))
        more = {column: beside[column] - alone[column] for column in COLUMNS}
        each = {column: more[column] / MANY for column in COLUMNS}
        once = dict.fromkeys(COLUMNS, 0.0)
        return {"device": device.name, "part": part, "once": once, "per_axis": each, "of_many": more}
    few, many = (_more(device, axes, part) for axes in (FEW, MANY))
    each = {column: (many[column] - few[column]) / (MANY - FEW) for column in COLUMNS}
    once = {column: few[column] - FEW * each[column] for column in COLUMNS}
    return {"device": device.name, "part": part, "once": once, "per_axis": each, "of_many": many}


def _more(device: Device, axes: int, part: str) -> dict[str, int]:
    without, with_it = cells(design(device, axes, NEEDS.get(part, ""))), cells(design(device, axes, part))
    return {column: with_it[column] - without[column] for column in COLUMNS}


def _clocks(pool: ThreadPoolExecutor, tell: Any) -> list[dict[str, Any]]:
    device = DEVICES[CLOCK_DEVICE]
    target, rows = device.target_mhz, []
    for part in ("", *PARTS):
        made = design(device, axes_of(part), part)
        run = partial(place, made, mhz=target, clock_ports={"clk": target, "spi_sclk": SPI_MHZ})
        reached = []
        for seed, placed in zip(SEEDS, pool.map(run, SEEDS), strict=True):
            reached.append(placed.main_clock[0] if placed.fits else 0.0)
            tell(f"{made.name}, seed {seed}: {reached[-1]:.1f} MHz")
        rows.append({"part": part, "size": placed.used, "f_max": [round(each, 2) for each in reached]})
    return rows


def report(names: Sequence[str], whole: bool) -> None:
    """Measure and print; write the page if all devices were measured."""
    check_results(REPORT, *[PAGE] * whole)
    found = measure(names)
    write_json(found, REPORT)
    for title, header, rows in _tables(found):
        shown = table(title, *header)
        for each in rows:
            shown.add_row(*each)
        console.print(shown)
    if whole:
        write(found)


def write(found: dict[str, Any]) -> None:
    """Write the tables into the page."""
    write_block(PAGE, "\n\n".join(markdown(header, rows) for _, header, rows in _tables(found)))


def _tables(found: dict[str, Any]) -> list[tuple[str, Sequence[str], list[list[str]]]]:
    return [_sizes(found["sizes"]), _clock_table(found["clocks"])]


def _sizes(rows: Sequence[dict[str, Any]]) -> tuple[str, Sequence[str], list[list[str]]]:
    header = ("part", "FPGA", *(f"{column} once + per axis" for column in COLUMNS))
    cells_of = [
        [
            f"`{row['part'].upper()}`",
            DEVICES[row["device"]].title,
            *(f"{row['once'][column]:,.0f} + {row['per_axis'][column]:,.0f}" for column in COLUMNS),
        ]
        for row in sorted(rows, key=lambda row: PARTS.index(row["part"]))
    ]
    return "cost of the parts", header, cells_of


def _clock_table(rows: Sequence[dict[str, Any]]) -> tuple[str, Sequence[str], list[list[str]]]:
    device = DEVICES[CLOCK_DEVICE]
    header = (
        "part",
        f"{device.title}, {MANY} axes with lines",
        "lowest MHz",
        f"median MHz of {len(SEEDS)} seeds",
    )
    made = [
        [
            f"`{row['part'].upper()}`" if row["part"] else "none",
            f"{row['size']:,} {device.family.size_unit}",
            mhz(min(row["f_max"]) or None),
            mhz(statistics.median(row["f_max"])),
        ]
        for row in rows
    ]
    return "clock with a part", header, made
