# SPDX-License-Identifier: MIT
"""The options of `passo serve`; imports nothing slow."""

import argparse
from pathlib import Path
from typing import Any

AXES, CLOCK_HZ = 4, 100_000_000


def add(commands: Any) -> argparse.ArgumentParser:
    """Add the subcommand; return its parser."""
    serve: argparse.ArgumentParser = commands.add_parser(
        "serve", help="a simulated core at a Unix socket, for programs on Linux (docs/hosts.md)"
    )
    serve.add_argument("socket", type=Path, metavar="SOCKET", help="its path; a host opens unix:SOCKET")
    serve.add_argument(
        "--machine",
        type=Path,
        metavar="MACHINE.toml",
        help="the core of this machine file, with its axes in the middle of their travel, and its switches",
    )
    serve.add_argument("--axes", type=int, metavar="N", help=f"without a machine: axes (default {AXES})")
    serve.add_argument(
        "--clock", type=int, metavar="HZ", help=f"without a machine: clock (default {CLOCK_HZ})"
    )
    serve.add_argument(
        "--engine", choices=("both", "rtl", "model"), default="model", help="the core (default model)"
    )
    serve.add_argument(
        "--real-time", action="store_true", help="follow the clock of this computer, also without a host"
    )
    serve.add_argument("--once", action="store_true", help="end when the first host is gone")
    serve.add_argument(
        "--edges", type=Path, metavar="FILE.npy", help="at the end, write all changes of the output pins"
    )
    return serve
