# SPDX-License-Identifier: MIT
"""The options of `passo campaign`; imports nothing that takes time."""

import argparse
from pathlib import Path
from typing import Any


def add(commands: Any) -> argparse.ArgumentParser:
    """Add the subcommand; return its parser."""
    made = commands.add_parser("campaign", help="random moves on all cores, judged at the pins")
    made.add_argument("--moves", type=int, required=True, metavar="N", help="how many")
    made.add_argument("--seed", type=int, required=True, metavar="S", help="the same seed, the same moves")
    made.add_argument("--first", type=int, default=0, metavar="K", help="number of the first (default 0)")
    made.add_argument(
        "--engine",
        default="model",
        metavar="ENGINE",
        help="model (default), or rtl: the Verilated core too, compared edge for edge",
    )
    made.add_argument("--jobs", type=int, metavar="N", help="processes (default: one for each core)")
    made.add_argument("--scheduler", metavar="ADDRESS", help="a running Dask cluster, tcp://host:8786")
    made.add_argument(
        "--out", type=Path, default=Path(), metavar="DIR", help="of moves that fail (default here)"
    )
    made.add_argument("--json", type=Path, metavar="FILE", help="the results (default build/campaign.json)")
    return made
