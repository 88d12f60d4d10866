# SPDX-License-Identifier: MIT
"""Random histories of the core, aimed at the clocks where something changes, checked by a judge.

    .venv/bin/python -m verify.soak.run [--seed N] [--only PART,PART] [--scale X]
    .venv/bin/python -m verify.soak.run --seed N --history N [--driver | --kind machine]

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
from passo.ending import ended
from passo.output import check_results, write_json
from passo.toolchain import paths

from verify.soak import trackers
from verify.soak.defects import catch_all
from verify.soak.numbers import measure
from verify.soak.page import PAGE, write
from verify.soak.parts import (
    DRIVER_SET,
    SETS,
    console,
    play_driver,
    play_endings,
    play_icarus,
    play_machine_on_verilator,
    play_model,
    play_trackers,
    play_verilator,
)
from verify.soak.program import DRIVER_KINDS, KINDS, build, build_endings, playing
from verify.soak.report import report, show, show_machine

REPORT = paths.build / "soak.json"

# Number of histories of each part; 20,000 have filters of milliseconds: `starts`, `endings`, `sessions`.
HISTORIES = {
    "model": 20_000,
    "driver": 3_000,
    "endings": 7_500,
    "sessions": 2_500,
    "verilator": 1_500,
    "driver on verilator": 150,
    "icarus": 1_000,
    "machine": 4_000,
    "tries": 15_000,
    "starts": 10_000,
    "pokes": 60,
    "machine on verilator": 170,
    "machine on icarus": 170,
    "trackers": 100_000,
    "trackers on verilator": 2_000,
}
PARTS = ("model", "driver", *DRIVER_KINDS, "verilator", "icarus", *KINDS, "trackers", "defects")


def soak(seed: int, only: Sequence[str], scale: float, jobs: int) -> bool:
    """Play all selected parts; return whether everything passed."""
    check_results(REPORT, *[PAGE] * (seed == 1))
    program = build()
    wanted = {name: max(1, round(number * scale)) for name, number in HISTORIES.items()}
    parts = []
    if "model" in only:
        parts.append(play_model(program, seed, wanted["model"], jobs))
    if "driver" in only:
        parts.append(play_driver(program, seed, wanted["driver"], jobs))
    for kind in DRIVER_KINDS:
        if kind in only:
            parts.append(play_endings(build_endings(), kind, seed, wanted[kind], jobs))
    if "verilator" in only:
        parts.append(play_verilator(program, seed, wanted["verilator"], jobs))
        library = rtl_library(SETS[DRIVER_SET])
        parts.append(play_driver(program, seed, wanted["driver on verilator"], jobs, library))
    if "icarus" in only:
        parts.append(play_icarus(program, seed, wanted["icarus"], jobs))
    numbers: dict[str, Any] = {}
    machine = [play_model(program, seed, wanted[kind], jobs, kind) for kind in KINDS if kind in only]
    if "machine" in only:
        number = wanted["machine on verilator"]
        machine.append(play_machine_on_verilator(program, seed, number, jobs))
        machine.append(play_icarus(program, seed, wanted["machine on icarus"], jobs, machine=True))
        numbers = measure(seed)
    if "trackers" in only:
        parts.append(play_trackers(seed, wanted["trackers"], jobs))
        parts.append(play_trackers(seed, wanted["trackers on verilator"], jobs, rtl=True))
    caught = catch_all(seed, jobs) if "defects" in only else []
    made = report(seed, [*parts, *machine], caught, numbers)
    write_json(made, REPORT)
    if seed == 1:
        written = write(HISTORIES, [*parts, *machine], caught, numbers)
        console.print(f"In docs/reference/soak.md: {', '.join(written) or 'nothing new'}")
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
    parser = argparse.ArgumentParser(prog="python -m verify.soak.run", description=__doc__.split("\n")[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--history", type=int, help="play and print a single scenario")
    parser.add_argument("--driver", action="store_true", help="play the scenario through the driver")
    parser.add_argument(
        "--kind", choices=(*KINDS, *DRIVER_KINDS, "trackers"), help="play a scenario of this kind"
    )
    parser.add_argument("--only", default=",".join(PARTS), help="parts to play (default: %(default)s)")
    parser.add_argument("--scale", type=float, default=1.0, help="multiply the number of scenarios")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    arguments = parser.parse_args()

    signal.signal(signal.SIGTERM, _end)
    only = arguments.only.split(",")
    if unknown := set(only) - set(PARTS):
        parser.error(f"no such part: {', '.join(sorted(unknown))}")
    if arguments.history is not None and arguments.kind in DRIVER_KINDS:
        command = [build_endings(), arguments.kind, str(arguments.seed), str(arguments.history), "1"]
        sys.exit(subprocess.run(command).returncode)
    if arguments.history is not None and arguments.kind == "trackers":
        sys.argv[1:] = [str(arguments.seed), str(arguments.history), "1", "--print"]
        trackers.main()
    if arguments.history is not None:
        command = [build(), str(arguments.seed), str(arguments.history), "1", "--print"]
        command += ["--driver"] if arguments.driver else []
        command += [f"--{arguments.kind}"] if arguments.kind else []
        sys.exit(subprocess.run(command).returncode)
    sys.exit(not soak(arguments.seed, only, arguments.scale, arguments.jobs))


if __name__ == "__main__":
    sys.exit(ended(main))
