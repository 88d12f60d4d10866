# SPDX-License-Identifier: MIT
"""How fast motions are played, against the sources of another commit: the ratio of the times.

    python -m benchmarks.play [COMMIT]

Both play each case in turn, in processes of their own; times are of the processor, those of short cases the
least of several rounds: what else runs makes them longer, and not both alike. Both must make the same steps;
with the same plan, which the path planner of another commit may not make, also the same edges.
"""

import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from passo.console import console, stages, table
from passo.ending import ended
from passo.toolchain import paths

BEFORE = "f7a6a7b"  # frames clock by clock, a poll in each millisecond
CASE = Path(__file__).with_name("play_case.py")
MACHINE = paths.root / "examples" / "gcode" / "machine.toml"


@dataclass(frozen=True)
class Case:
    """A case of play_case.py, and what it is called."""

    name: str
    lines: int
    text: str
    rounds: int = 1


@dataclass(frozen=True)
class Compared:
    """Seconds of the processor that a case takes."""

    before: float
    now: float
    edges: bool  # whether they are the same, not only the steps

    @property
    def ratio(self) -> float:
        """How many times as fast it is."""
        return self.before / self.now


CASES = (
    Case("rosette", 20_000, "`passo run`, 20,000 lines of 0.5 mm at 25 mm/s"),
    Case("circles", 100, "`passo run`, 100 circles at 50 mm/s"),
    Case("zigzag", 200, "`passo run`, 200 lines of 50 mm at 200 mm/s"),
    Case("paths", 20, "the tests' player, 20 paths of 200 lines"),
    Case("rtl", 4, "`passo run --engine rtl`, 4 lines of 50 mm at 200 mm/s"),
    Case("campaign", 1500, "`passo campaign`, 1,500 moves on the model", rounds=5),
)


def extract(commit: str, folder: Path) -> None:
    """The sources of a commit."""
    packed = subprocess.run(["git", "-C", paths.root, "archive", commit], capture_output=True, check=True)
    subprocess.run(["tar", "-x", "-C", folder], input=packed.stdout, check=True)


def play(root: Path, name: str, lines: int) -> tuple[float, list[str]]:
    """Seconds of the processor; hashes of the edges and of the steps."""
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
    return seconds, done.stdout.splitlines()[-1].split()


def compare(
    cases: Sequence[Case], commit: str = BEFORE, tell: Callable[[str], None] = print
) -> list[Compared]:
    """Play cases with the sources of a commit and with these; SystemExit if a step differs."""
    found = []
    with tempfile.TemporaryDirectory() as name:
        extract(commit, Path(name))
        for case in cases:
            for root in (Path(name), paths.root):
                play(root, case.name, 1)  # builds
            seconds: list[tuple[float, float]] = []
            for _ in range(case.rounds):
                old, were = play(Path(name), case.name, case.lines)
                new, are = play(paths.root, case.name, case.lines)
                if were[1] != are[1]:
                    raise SystemExit(f"{case.text}: the steps differ")
                seconds.append((old, new))
            old, new = (min(times) for times in zip(*seconds, strict=True))
            tell(f"{case.text}: {old / new:.1f} times as fast")
            found.append(Compared(old, new, were == are))
    return found


def main() -> None:
    """Of the command."""
    commit = sys.argv[1] if len(sys.argv) > 1 else BEFORE
    rows = table(f"Time of the processor, {commit} and now; the steps are the same", "case")
    for column in ("before [s]", "now [s]", "ratio", "same edges"):
        rows.add_column(column, justify="right")
    for case, found in zip(CASES, compare(CASES, commit, stages()), strict=True):
        times = (f"{found.before:.2f}", f"{found.now:.2f}", f"{found.ratio:.1f}")
        rows.add_row(case.text, *times, "yes" if found.edges else "no")
    console.print(rows)


if __name__ == "__main__":
    sys.exit(ended(main))
