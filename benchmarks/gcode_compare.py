# SPDX-License-Identifier: MIT
"""`make gcode-peer`: random programs on Passo and on LinuxCNC's interpreter, also after `passo expand`.

A difference that is not in spec/gcode_differences.toml ends with status 1, and its program is printed.
"""

import argparse
import random
import sys
from collections import Counter
from collections.abc import Callable, Sequence

from passo import random_cases

from benchmarks import gcode_expand
from benchmarks.gcode_motion import Played, verdict
from benchmarks.gcode_passo import play_passo
from benchmarks.gcode_programs import random_program
from benchmarks.gcode_rs274 import play_rs274

PROGRAMS = 2000


def _judge(program: Sequence[str], ours: Played) -> str:
    return verdict(ours, play_rs274(program))


def compare(program: Sequence[str]) -> str:
    """What Passo and rs274 do with a program that is not the same."""
    return _judge(program, play_passo(program))


def main() -> int:
    """Compare; the number of programs and the seed are arguments."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--programs", type=int, default=PROGRAMS)
    asked.add_argument("--seed", type=int, default=random_cases.seed())
    options = asked.parse_args()
    count, seed = options.programs, options.seed
    different = _compare("programs", count, seed, random_program, play_passo, _judge)
    for kind, made, judge in gcode_expand.KINDS:
        share = count // len(gcode_expand.KINDS)
        different += _compare(f"expanded {kind}", share, seed, made, gcode_expand.play_expanded, judge)
    return different > 0


def _compare(
    kind: str,
    programs: int,
    seed: int,
    make: Callable[[random.Random], list[str]],
    play: Callable[[Sequence[str]], Played],
    judge: Callable[[Sequence[str], Played], str],
) -> int:
    """Compare programs of a kind; return how many differ."""
    counts: Counter[str] = Counter()
    for number in range(programs):
        program = make(random.Random(f"{seed} {number}"))
        ours = play(program)
        counts["lines"] += len(program)
        counts["motions"] += len(ours.motions)
        counts["arcs"] += sum(motion.center is not None for motion in ours.motions)
        counts["refused"] += ours.refused > 0
        if found := judge(program, ours):
            counts["different"] += 1
            print(f"{kind}, {number} of seed {seed}: {found}", *program, sep="\n")
    names = ("lines", "motions", "arcs", "refused", "different")
    told = ", ".join(f"{counts[name]:,} {name}" for name in names)
    print(f"{programs:,} {kind} of seed {seed}: {told}")
    return counts["different"]


if __name__ == "__main__":
    sys.exit(main())
