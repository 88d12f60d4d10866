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
from passo.console import cancelable, each
from passo.ending import ended

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
    play = gcode_expand.play_expanded
    different = 0
    with cancelable() as work:
        different += _compare("programs", _random(random_program, count, seed), play_passo, _judge)
        for kind, made, judge in gcode_expand.KINDS:
            programs = _random(made, count // len(gcode_expand.KINDS), seed)
            different += _compare(f"expanded {kind}", programs, play, judge)
        for kind, corpus, judge in gcode_expand.CORPORA:
            different += _compare(f"{kind} of the corpus", dict(corpus()), play, judge)
    return different > 0 or work.canceled


def _random(make: Callable[[random.Random], list[str]], count: int, seed: int) -> dict[str, list[str]]:
    names = (f"{number} of seed {seed}" for number in range(count))
    return {name: make(random.Random(f"{seed} {number}")) for number, name in enumerate(names)}


def _compare(
    kind: str,
    programs: dict[str, list[str]],
    play: Callable[[Sequence[str]], Played],
    judge: Callable[[Sequence[str], Played], str],
) -> int:
    """Compare programs of a kind; return how many differ."""
    counts: Counter[str] = Counter()
    try:
        for name, program in each(kind, programs.items()):
            _count(counts, f"{kind}, {name}", program, play(program), judge)
    finally:
        names = ("lines", "motions", "arcs", "refused", "different")
        told = ", ".join(f"{counts[name]:,} {name}" for name in names)
        print(f"{counts['programs']:,} {kind}: {told}", flush=True)
    return counts["different"]


def _count(
    counts: Counter[str],
    name: str,
    program: Sequence[str],
    ours: Played,
    judge: Callable[[Sequence[str], Played], str],
) -> None:
    """Judge a program and say what differs."""
    counts["programs"] += 1
    counts["lines"] += len(program)
    counts["motions"] += len(ours.motions)
    counts["arcs"] += sum(motion.center is not None for motion in ours.motions)
    counts["refused"] += ours.refused > 0
    if found := judge(program, ours):
        counts["different"] += 1
        print(f"{name}: {found}", *program, sep="\n")


if __name__ == "__main__":
    sys.exit(ended(main))
