# SPDX-License-Identifier: MIT
"""`make gcode-peer`: random programs on Passo and on LinuxCNC's interpreter.

A difference that is not in the table of docs/gcode.md ends with status 1, and its program is printed.
"""

import argparse
import random
import sys
from collections import Counter
from collections.abc import Sequence

from passo import random_cases

from benchmarks.gcode_motion import Played, difference, moving
from benchmarks.gcode_passo import play_passo
from benchmarks.gcode_programs import random_program
from benchmarks.gcode_rs274 import play_rs274

PROGRAMS = 2000


def verdict(ours: Played, theirs: Played) -> str:
    """The first difference, with the number of its line; empty: there is none."""
    first = min((played.refused for played in (ours, theirs) if played.refused), default=sys.maxsize)
    mine, other = (
        [motion for motion in moving(played.motions) if motion.label < first] for played in (ours, theirs)
    )
    for a, b in zip(mine, other, strict=False):
        if found := difference(a, b):
            return f"line {min(a.label, b.label)}: {found}: {a} {b}"
    if len(mine) != len(other):
        return f"{len(mine)} motions are {len(other)}"
    if ours.refused != theirs.refused:
        return f"line {first}: refused by one: {ours.why}{theirs.why}"
    return ""


def compare(program: Sequence[str]) -> str:
    """What Passo and rs274 do with a program that is not the same."""
    return verdict(play_passo(program), play_rs274(program))


def main() -> int:
    """Compare; the number of programs and the seed are arguments."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--programs", type=int, default=PROGRAMS)
    asked.add_argument("--seed", type=int, default=random_cases.seed())
    options = asked.parse_args()
    counts: Counter[str] = Counter()
    for number in range(options.programs):
        program = random_program(random.Random(f"{options.seed} {number}"))
        ours = play_passo(program)
        found = verdict(ours, play_rs274(program))
        counts["lines"] += len(program)
        counts["motions"] += len(ours.motions)
        counts["arcs"] += sum(motion.center is not None for motion in ours.motions)
        counts["refused"] += ours.refused > 0
        if found:
            counts["different"] += 1
            print(f"program {number} of seed {options.seed}: {found}", *program, sep="\n")
    figures = ", ".join(
        f"{counts[name]:,} {name}" for name in ("lines", "motions", "arcs", "refused", "different")
    )
    print(f"{options.programs:,} programs of seed {options.seed}: {figures}")
    return counts["different"] > 0


if __name__ == "__main__":
    sys.exit(main())
