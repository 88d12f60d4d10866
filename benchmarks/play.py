# SPDX-License-Identifier: MIT
"""How fast motions are played, against the sources of another commit: the same edges, the ratio of the times.

    python -m benchmarks.play [COMMIT]

Both play each case in turn, in processes of their own; times are of the processor. A difference of any edge
is an error.
"""

import os
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from passo.console import console, stages, table
from passo.toolchain import paths

BEFORE = "f7a6a7b"  # frames clock by clock, a poll in each millisecond
PLAN = ("c_model/planner", "c_model/gcode", "c_model/protocol", "stm32_bridge")
CASE = Path(__file__).with_name("play_case.py")
MACHINE = paths.root / "examples" / "gcode" / "machine.toml"


@dataclass(frozen=True)
class Case:
    """A case of play_case.py, and what it is called."""

    name: str
    lines: int
    text: str


@dataclass(frozen=True)
class Compared:
    """Seconds of the processor that a case takes."""

    before: float
    now: float

    @property
    def ratio(self) -> float:
        """How many times as fast it is."""
        return self.before / self.now


CASES = (
    Case("rosette", 20_000, "`passo run`, 20,000 lines of 0.5 mm at 25 mm/s"),
    Case("circles", 100, "`passo run`, 100 circles at 50 mm/s"),
    Case("zigzag", 200, "`passo run`, 200 lines of 50 mm at 200 mm/s"),
    Case("paths", 20, "the tests' player, 20 paths of 200 lines"),
    Case("rtl", 20, "`passo run --engine rtl`, 20 lines of 50 mm at 200 mm/s"),
    Case("campaign", 300, "`passo campaign`, 300 moves on the model"),
)


def extract(commit: str, folder: Path) -> None:
    """The sources of a commit, with what decides the plan as it is now."""
    packed = subprocess.run(["git", "-C", paths.root, "archive", commit], capture_output=True, check=True)
    subprocess.run(["tar", "-x", "-C", folder], input=packed.stdout, check=True)
    for own in PLAN:
        shutil.rmtree(folder / own)
        shutil.copytree(paths.root / own, folder / own)


def play(root: Path, name: str, lines: int) -> tuple[float, str]:
    """Seconds of the processor, and the hash of the edges."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [sys.executable, CASE, name, str(lines), MACHINE, folder],
            env={**os.environ, "PYTHONPATH": f"{root / 'sim'}:{root}"},
            capture_output=True,
            text=True,
        )
    if done.returncode:
        raise SystemExit(done.stderr)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return seconds, done.stdout.splitlines()[-1]


def compare(
    cases: Sequence[Case], commit: str = BEFORE, tell: Callable[[str], None] = print
) -> list[Compared]:
    """Play cases with the sources of a commit and with these; SystemExit if an edge differs."""
    found = []
    with tempfile.TemporaryDirectory() as name:
        extract(commit, Path(name))
        for case in cases:
            for root in (Path(name), paths.root):
                play(root, case.name, 1)  # builds
            old, edges = play(Path(name), case.name, case.lines)
            new, same = play(paths.root, case.name, case.lines)
            if edges != same:
                raise SystemExit(f"{case.text}: the edges differ")
            tell(f"{case.text}: {old / new:.1f} times as fast")
            found.append(Compared(old, new))
    return found


def main() -> None:
    """Of the command."""
    commit = sys.argv[1] if len(sys.argv) > 1 else BEFORE
    rows = table(f"Time of the processor, {commit} and now; the edges are the same", "case")
    for column in ("before [s]", "now [s]", "ratio"):
        rows.add_column(column, justify="right")
    for case, found in zip(CASES, compare(CASES, commit, stages()), strict=True):
        rows.add_row(case.text, f"{found.before:.2f}", f"{found.now:.2f}", f"{found.ratio:.1f}")
    console.print(rows)


if __name__ == "__main__":
    main()
