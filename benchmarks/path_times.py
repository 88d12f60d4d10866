# SPDX-License-Identifier: MIT
"""Kept paths, each with the time of the fastest motion that a solver finds for it: what a plan may take.

    .venv/bin/python -m benchmarks.path_times

solves them again (path_reference.py, path_reference_jerk.py) and writes path_times.json. On each of them
one decision of the planner makes the difference: where a ramp ends, or how a path speeds up.
"""

import json
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from passo.console import each
from passo.ending import ended
from passo.output import check_results, write_text
from passo.path import PathSettings

from benchmarks.path_measure import FAST_POLLS
from benchmarks.path_paths import Case, case_of
from benchmarks.path_plan import Planned, plan
from benchmarks.path_reference import seconds
from benchmarks.path_reference_jerk import soft_seconds

KEPT = Path(__file__).with_suffix(".json")
SPARE = 4  # places beyond all lines
# What a plan takes at most, all lines known: linear ramps are the fastest motion; profile jerk has cosine
# ramps, which a path of few lines cannot share: one to the top and one down again.
BOUNDS = {"linear": 1.002, "jerk": 1.37}


@dataclass(frozen=True)
class Kept:
    """A path, and the seconds of its fastest motion."""

    case: Case
    seconds: float

    @property
    def settings(self) -> PathSettings:
        """Without a limit by the host."""
        return replace(self.case.settings, polls=FAST_POLLS)

    @property
    def ratio(self) -> float:
        """Of the time that is planned to that of the fastest motion."""
        return self.planned().seconds / self.seconds

    def planned(self) -> Planned:
        """All lines known."""
        return plan(self.case.lines, self.settings, len(self.case.lines) + SPARE)

    def solved(self) -> float:
        """Seconds of the fastest motion, found again."""
        solve = soft_seconds if self.case.profile == "jerk" else seconds
        return solve(self.case.lines, self.settings)


def read() -> dict[str, Kept]:
    """By name."""
    found: dict[str, dict[str, Any]] = json.loads(KEPT.read_text(encoding="utf-8"))
    return {name: Kept(case_of(one["case"]), one["seconds"]) for name, one in found.items()}


def main() -> None:
    """Solve all of them."""
    check_results(KEPT)
    found = {
        name: {"seconds": round(kept.solved(), 6), "case": kept.case.to_json()}
        for name, kept in each("paths solved", read().items())
    }
    rows = ",\n".join(f"  {json.dumps(name)}: {json.dumps(one)}" for name, one in found.items())
    write_text(KEPT, "{\n" + rows + "\n}\n")


if __name__ == "__main__":
    sys.exit(ended(main))
