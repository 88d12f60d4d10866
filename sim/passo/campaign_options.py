# SPDX-License-Identifier: MIT
"""The options of `passo campaign`; imports nothing slow."""

import argparse
from pathlib import Path
from typing import Any


def add(commands: Any) -> argparse.ArgumentParser:
    """Add the subcommand; return its parser."""
    made = commands.add_parser(
        "campaign", help="run random moves on all CPU cores and check every edge at the pins"
    )
    made.add_argument("--moves", type=int, required=True, metavar="N", help="number of moves")
    made.add_argument("--seed", type=int, required=True, metavar="S", help="seed of the random moves")
    made.add_argument(
        "--first", type=int, default=0, metavar="K", help="number of the first move (default 0)"
    )
    made.add_argument(
        "--engine",
        default="model",
        metavar="ENGINE",
        help="model (default); rtl: compare with the Verilated core, edge for edge",
    )
    made.add_argument("--jobs", type=int, metavar="N", help="processes (default: one per CPU core)")
    made.add_argument("--scheduler", metavar="ADDRESS", help="use a running Dask cluster: tcp://host:8786")
    made.add_argument(
        "--out",
        type=Path,
        default=Path(),
        metavar="DIR",
        help="folder for the moves that fail (default: the current one)",
    )
    made.add_argument(
        "--json", type=Path, metavar="FILE", help="write the results here (default build/campaign.json)"
    )
    return made
