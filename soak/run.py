# SPDX-License-Identifier: MIT
"""Random histories of the core, aimed at the clocks where something changes, checked by a judge.

    .venv/bin/python -m soak.run [--seed N] [--only model,machine,verilator,icarus,driver,defects] [--scale X]
    .venv/bin/python -m soak.run --seed N --history N [--driver | --kind machine]

The first form plays them on all processor cores, prints a table and writes build/soak.json; the second one
prints a single history. docs/soak.md describes what is played and judged.
"""

import argparse
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from typing import Any

from passo.build import rtl_library
from passo.console import table
from passo.report import write_json
from passo.toolchain import paths

from soak.defects import Catch, catch_all
from soak.numbers import measure
from soak.parts import (
    DRIVER_SET,
    SETS,
    Part,
    console,
    play_driver,
    play_icarus,
    play_machine_on_verilator,
    play_model,
    play_verilator,
)
from soak.program import KINDS, build, playing

REPORT = paths.build / "soak.json"

# Number of histories of each part.
HISTORIES = {
    "model": 20_000,
    "driver": 3_000,
    "verilator": 1_500,
    "driver on verilator": 150,
    "icarus": 1_000,
    "machine": 4_000,
    "tries": 15_000,
    "pokes": 60,
    "machine on verilator": 170,
    "machine on icarus": 170,
}
PARTS = ("model", "driver", "verilator", "icarus", "machine", "defects")

JUDGED = {
    "steps": "steps",
    "positions": "positions read",
    "paths": "paths made exactly",
    "quiets": "states that said quiet",
    "aborts": "aborts",
    "stops": "stops",
    "gaps": "gaps after a stop",
    "gates": "words that need rest",
    "resets": "resets",
}


MACHINE_JUDGED = {
    "causes": "causes of stops",
    "slews": "slews of soft stops",
    "latches": "positions latched, to the clock",
    "fired": "clocks until a trigger fired",
    "tries": "steps tried towards an active switch",
    "levels": "levels longer than the filter",
    "glitches": "glitches that it must ignore",
    "estops": "e-stops",
    "counted": "edges of encoders counted",
    "encoders": "encoder positions read",
    "holds": "holds without power",
    "compares": "compare pulses",
    "words": "changes of the outputs",
}


def events(part: Part) -> int:
    """Disturbances of a part."""
    return sum(count for name, count in part.counts.items() if name.startswith("kind:"))


def show_machine(parts: Sequence[Part], numbers: dict[str, Any]) -> None:
    """Print what was judged of a machine, and the numbers of its path."""
    judged = table("A machine", "what", *(part.name for part in parts))
    judged.add_row("events", *(f"{events(part):,}" for part in parts))
    for key, text in MACHINE_JUDGED.items():
        judged.add_row(text, *(f"{part.counts[key]:,}" for part in parts))
    console.print(judged)
    thread, laser, raster = numbers["thread"], numbers["laser"], numbers["raster"]
    bound = table("Bound to the machine", "what", "measured", "ok")
    bound.add_row(
        f"thread: {thread['turns']} turns, spindle +-30 %",
        f"{thread['worst_counts']:.2f} counts from the exact pitch at most, "
        f"{'same' if thread['same_phase'] else 'NOT the same'} phase in every pass",
        "yes" if thread["ok"] else "NO",
    )
    bound.add_row(
        "laser: energy per step, 5 % to 100 %, hold",
        f"within {laser['worst']:.2%}",
        "yes" if laser["ok"] else "NO",
    )
    bound.add_row(
        f"raster: {raster['values']:,} values",
        f"{raster['wrong']} not on their substep",
        "yes" if raster["ok"] else "NO",
    )
    console.print(bound)


def show(parts: Sequence[Part], caught: Sequence[Catch]) -> None:
    """Print the tables."""
    shown = table(
        "Histories", "part", "histories", "clocks", "frames", "aimed", "on the clock", "failed", "s"
    )
    for part in parts:
        counts = part.counts
        aimed = counts["aimed"]
        shown.add_row(
            part.name,
            f"{counts['histories']:,}",
            f"{counts['clocks'] / 1e6:,.0f} M",
            f"{counts['frames']:,}",
            f"{aimed:,}" if aimed else "",
            f"{counts['hit'] / aimed:.0%}" if aimed else "",
            str(len(part.failures)),
            f"{part.seconds:.0f}",
        )
    console.print(shown)
    judged = table("Judged", "what", *(part.name for part in parts))
    for key, text in JUDGED.items():
        judged.add_row(text, *(f"{part.counts[key]:,}" for part in parts))
    console.print(judged)
    wires = [part for part in parts if part.name.startswith("driver")]
    if wires:
        wire = table("The driver's wire", "what", *(part.name for part in wires))
        for key in (
            "retries",
            "flips",
            "lost clocks",
            "doubled clocks",
            "cuts",
            "deaths",
            "moves",
            "lines",
            "errors",
        ):
            wire.add_row(key, *(f"{part.counts[key]:,}" for part in wires))
        console.print(wire)
    if caught:
        made = table("Planted defects", "defect", "caught", "after histories", "s")
        for one in caught:
            made.add_row(
                one.defect.name,
                "yes" if one.good else "NO",
                f"{one.history + 1:,}" if one.history >= 0 else "",
                f"{one.seconds:.0f}",
            )
        console.print(made)


def report(
    seed: int, parts: Sequence[Part], caught: Sequence[Catch], numbers: dict[str, Any]
) -> dict[str, Any]:
    """The contents of soak.json."""
    return {
        "seed": seed,
        "ok": not any(part.failures for part in parts)
        and all(one.good for one in caught)
        and all(number["ok"] for number in numbers.values()),
        "machine": {
            **numbers,
            **{
                part.name: {"events": events(part), **{key: part.counts[key] for key in MACHINE_JUDGED}}
                for part in parts
                if part.name.split()[0] in KINDS
            },
        },
        "parts": {
            part.name: {
                "seconds": round(part.seconds, 1),
                "failed": len(part.failures),
                "failures": [
                    {"history": one.history, "clock": one.clock, "text": one.text, "again": one.again}
                    for one in part.failures
                ],
                **part.counts,
            }
            for part in parts
        },
        "defects": [
            {
                "name": one.defect.name,
                "says": one.defect.says,
                "caught": one.good,
                "seed": seed,
                "histories": one.history + 1,
                "broken": one.says,
            }
            for one in caught
        ],
    }


def soak(seed: int, only: Sequence[str], scale: float, jobs: int) -> bool:
    """Play all selected parts; return whether everything passed."""
    program = build()
    wanted = {name: max(1, round(number * scale)) for name, number in HISTORIES.items()}
    parts = []
    if "model" in only:
        parts.append(play_model(program, seed, wanted["model"], jobs))
    if "driver" in only:
        parts.append(play_driver(program, seed, wanted["driver"], jobs))
    if "verilator" in only:
        parts.append(play_verilator(program, seed, wanted["verilator"], jobs))
        library = rtl_library(SETS[DRIVER_SET])
        parts.append(play_driver(program, seed, wanted["driver on verilator"], jobs, library))
    if "icarus" in only:
        parts.append(play_icarus(program, seed, wanted["icarus"], jobs))
    numbers: dict[str, Any] = {}
    machine = []
    if "machine" in only:
        machine = [play_model(program, seed, wanted[kind], jobs, kind) for kind in KINDS]
        number = wanted["machine on verilator"]
        machine.append(play_machine_on_verilator(program, seed, number, jobs))
        machine.append(play_icarus(program, seed, wanted["machine on icarus"], jobs, machine=True))
        numbers = measure(seed)
    caught = catch_all(seed, jobs) if "defects" in only else []
    made = report(seed, [*parts, *machine], caught, numbers)
    write_json(made, REPORT)
    show([*parts, *machine], caught)
    if machine:
        show_machine(machine, numbers)
    console.print(f"Report: {REPORT.relative_to(paths.root)}")
    return made["ok"]


def _end(*_: object) -> None:
    for process in list(playing):
        process.terminate()
    sys.exit(1)


def main() -> None:
    """Parse the command line and run; exit status 1 if a history failed or a defect was not caught."""
    parser = argparse.ArgumentParser(prog="python -m soak.run", description=__doc__.split("\n")[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--history", type=int, help="print a single history")
    parser.add_argument("--driver", action="store_true", help="play the history through the driver")
    parser.add_argument("--kind", choices=KINDS, help="play the history of a machine")
    parser.add_argument("--only", default=",".join(PARTS), help="parts to play (default: %(default)s)")
    parser.add_argument("--scale", type=float, default=1.0, help="multiply the number of histories")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    arguments = parser.parse_args()

    signal.signal(signal.SIGTERM, _end)
    only = arguments.only.split(",")
    if unknown := set(only) - set(PARTS):
        parser.error(f"no such part: {', '.join(sorted(unknown))}")
    if arguments.history is not None:
        command = [build(), str(arguments.seed), str(arguments.history), "1", "--print"]
        command += ["--driver"] if arguments.driver else []
        command += [f"--{arguments.kind}"] if arguments.kind else []
        sys.exit(subprocess.run(command).returncode)
    sys.exit(not soak(arguments.seed, only, arguments.scale, arguments.jobs))


if __name__ == "__main__":
    main()
