# SPDX-License-Identifier: MIT
"""The options of `passo console`; imports nothing slow."""

import argparse
from pathlib import Path
from typing import Any

ENGINES = ("both", "rtl", "model")


def add(commands: Any) -> argparse.ArgumentParser:
    """Add the subcommand; return its parser."""
    console: argparse.ArgumentParser = commands.add_parser(
        "console", help="console of the STM32 board with a simulated core (docs/console.md)"
    )
    console.add_argument("--engine", choices=ENGINES, default="model", help="the core (default model)")
    console.add_argument("--axes", type=int, default=4, metavar="N", help="axes per channel (default 4)")
    console.add_argument(
        "--channels", type=int, default=1, metavar="N", help="channels of the core (default 1)"
    )
    console.add_argument(
        "--clock", type=int, default=100_000_000, metavar="HZ", help="clock of the core (default 100000000)"
    )
    console.add_argument("--inputs", action="store_true", help="build the core with inputs (docs/machine.md)")
    console.add_argument(
        "--switch",
        action="append",
        default=[],
        metavar="PIN:AXIS:..POSITION",
        help="simulate a switch: home:0:..-500 is active at -500 steps and below, "
        "limit_high:1:9000.. at 9000 and above, probe:2:..-300; repeatable, needs --inputs",
    )
    console.add_argument(
        "--outputs",
        action="store_true",
        help="build the core with path-synchronized outputs (docs/machine.md)",
    )
    console.add_argument(
        "--encoders", action="store_true", help="build the core with encoders (docs/machine.md)"
    )
    console.add_argument(
        "--trackers", action="store_true", help="build the core with trackers (docs/machine.md)"
    )
    console.add_argument(
        "--tracked",
        type=int,
        default=0,
        metavar="N",
        help="the last N axes have no lines: only their trackers move them",
    )
    console.add_argument(
        "--encoder",
        action="append",
        default=[],
        metavar="AXIS:COUNTS",
        help="simulate an encoder driven by the pins of an axis: 0:4 has 4 counts per step; repeatable, "
        "needs --encoders",
    )
    console.add_argument(
        "--spindle",
        action="append",
        default=[],
        metavar="AXIS:RPM:COUNTS",
        help="simulate a running spindle with its encoder at the inputs of an axis: 2:600:4000 has 4000 "
        "counts per turn and an index at 600 rpm; repeatable, needs --encoders",
    )
    console.add_argument("--grbl", action="store_true", help="speak the grbl protocol (docs/gcode.md)")
    console.add_argument("--machine", type=Path, metavar="MACHINE.toml", help="with --grbl: axes and limits")
    console.add_argument(
        "--pty", type=Path, metavar="LINK", help="with --grbl: pseudo-terminal, in real time"
    )
    console.add_argument(
        "--settings",
        type=Path,
        metavar="FILE",
        help="with --grbl: store $ settings and offsets here; created if missing",
    )
    console.add_argument(
        "--tools", type=Path, metavar="TOOLS.tbl", help="with --grbl: tool table of LinuxCNC, in mm"
    )
    console.add_argument("--echo", action="store_true", help="echo each line before its answer")
    return console
