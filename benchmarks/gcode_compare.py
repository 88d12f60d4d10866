# SPDX-License-Identifier: MIT
"""`make gcode-peer`: random programs on Passo and on LinuxCNC's interpreter, also after `passo expand`.

A difference that is not in the table of docs/gcode.md ends with status 1, and its program is printed.
"""

import argparse
import random
import sys
from collections import Counter
from collections.abc import Sequence

from passo import random_cases

from benchmarks import gcode_expand
from benchmarks.gcode_motion import verdict
from benchmarks.gcode_passo import play_passo
from benchmarks.gcode_programs import random_program
from benchmarks.gcode_rs274 import play_rs274

PROGRAMS = 2000


def compare(program: Sequence[str]) -> str:
    """What Passo and rs274 do with a program that is not the same."""
    return verdict(play_passo(program), play_rs274(program))


def _print(what: str, counts: Counter[str]) -> None:
    names = ("lines", "motions", "arcs", "refused", "different")
    print(f"{what}: {', '.join(f'{counts[name]:,} {name}' for name in names)}")


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
    _print(f"{options.programs:,} programs of seed {options.seed}", counts)
    different = counts["different"]
    for kind in gcode_expand.KINDS:
        different += _compare_expanded(kind, options.programs // len(gcode_expand.KINDS), options.seed)
    return different > 0


def _compare_expanded(kind: str, programs: int, seed: int) -> int:
    """Compare programs that are expanded; return how many differ."""
    counts: Counter[str] = Counter()
    for number in range(programs):
        made = gcode_expand.random_program(kind, random.Random(f"{seed} {number}"))
        found = gcode_expand.compare(kind, made)
        ours = gcode_expand.play_expanded(made)
        counts["lines"] += len(made)
        counts["motions"] += len(ours.motions)
        counts["arcs"] += sum(motion.center is not None for motion in ours.motions)
        counts["refused"] += ours.refused > 0
        if found:
            counts["different"] += 1
            print(f"{kind} {number} of seed {seed}: {found}", *made, sep="\n")
    _print(f"{programs:,} {kind} of seed {seed}, expanded", counts)
    return counts["different"]


if __name__ == "__main__":
    sys.exit(main())
