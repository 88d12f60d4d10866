# SPDX-License-Identifier: MIT
"""Make mutants of RTL and C sources, and try them on the judges that do not know the model.

    .venv/bin/python -m verify.mutants.run [--seed N] [--only NAME,...] [--each N] [--count N]
        [--tests NAME,...]

`--only` takes `rtl`, `c`, modules of rtl/ and C sources; `--tests` files of tests, or c_long, which then are
all that judges C. A run continues
where the last one ended: the fates are kept in build/mutants, and all that was killed is killed once more
when the sources or the judges are others. A run writes docs/reference/mutants.md, one of a part its rows
there, if its mutants are those of the page; `--page` writes what is known without a run.
"""

import argparse
import sys
import time
from collections.abc import Collection, Sequence

from passo.console import Estimate, console
from passo.ending import ended
from passo.output import check_results

from verify import page as modules_page
from verify.mutants import (
    c_equal,
    c_judge,
    c_source,
    corners_judge,
    encoders_judge,
    engine_judge,
    equivalence,
    formal_judge,
    frames_judge,
    inputs_judge,
    lines_judge,
    motions_judge,
    outputs_judge,
    registers_judge,
    rests_judge,
    rtl_judge,
    shapes_judge,
    timings_judge,
    trackers_judge,
)
from verify.mutants.fates import Fates, hash_of
from verify.mutants.netlist import CORES, MOST, Core, Mutant, drawn, first_of, library
from verify.mutants.page import PAGE, Score, scores, show_table, write
from verify.soak.program import build as program

SEED = 1
EACH = 16  # of a module of the RTL, in each core that it is in
COUNT = 800  # of the C sources


def _say(text: str) -> None:
    console.print(f"{time.strftime('%T')} {text}", highlight=False, markup=False, soft_wrap=True)


def _of_core(core: Core, seed: int, each: int, only: Collection[str]) -> tuple[list[Mutant], str]:
    """The mutants of a core, of some modules or of all, and what identifies it."""
    if only and not any(core.mutates(module) for module in only):
        return [], ""
    mutants, hashed = drawn(core, seed, max(each, MOST))
    return [mutant for mutant in first_of(mutants, each) if not only or mutant.module in only], hashed


def run_core(core: Core, seed: int, each: int, only: Collection[str]) -> list[Score]:
    """All judges of the RTL: the quick ones first."""
    chosen, hashed = _of_core(core, seed, each, only)
    if not chosen:
        return []
    soak = program()
    fates = Fates(f"rtl_{core.name}", hash_of([soak], hashed, str(seed)))
    if not core.played:
        formal_judge.judge(core, chosen, fates, _say, formal_judge.LIMIT)
        return scores(chosen, fates)
    verilated = library(core)
    pins = rtl_judge.Pins(core, chosen, fates, soak, verilated, seed, _say)
    first, second, third = rtl_judge.ROUNDS.get(core.name, rtl_judge.NONE)
    pins.judge(first)
    for check in (
        trackers_judge.CHECK,
        *(frames_judge.CHECK, motions_judge.CHECK, timings_judge.CHECK, lines_judge.CHECK),
        rests_judge.CHECK,
        *(shapes_judge.CHECK, corners_judge.CHECK, inputs_judge.CHECK, outputs_judge.CHECK),
        *(encoders_judge.CHECK, *registers_judge.CHECKS, *trackers_judge.TABLES),
    ):
        engine_judge.judge(core, chosen, fates, verilated, seed, _say, check)
    pins.judge(second)
    equivalence.judge(core, chosen, fates, _say, equivalence.MODULE)
    formal_judge.judge(core, chosen, fates, _say, formal_judge.LIMIT)
    pins.judge(third)
    equivalence.judge(core, chosen, fates, _say, equivalence.CORE)
    return scores(chosen, fates)


def known_of(core: Core, seed: int, each: int, only: Collection[str]) -> list[Score]:
    """What is known of it."""
    chosen, _ = _of_core(core, seed, each, only)
    return scores(chosen, Fates(f"rtl_{core.name}", "", again=False))


def run_c(seed: int, count: int, only: Collection[str], tests: Collection[str], play: bool) -> list[Score]:
    """The tests as judges of the C sources; or what is known of them."""
    mutants, hashed = c_source.drawn(seed, count)
    chosen = [mutant for mutant in mutants if not only or mutant.file in only]
    fates = Fates("c", hashed, again=False)
    if play:
        c_equal.judge(chosen, fates, _say)
        c_judge.judge(mutants, chosen, fates, _say, tests)
    return scores(chosen, fates)


def _chosen(only: Sequence[str], kind: str, ending: str) -> list[str] | None:
    """The names of one kind; None: nothing of it, an empty list: everything."""
    if not only or kind in only:
        return []
    names = [name for name in only if name.endswith(".c") == bool(ending) and name not in ("rtl", "c")]
    return names or None


def main() -> None:
    """Run, print the table, and exit with 1 if the judges find fault with the sources themselves."""
    parser = argparse.ArgumentParser(prog="python -m verify.mutants.run", description=__doc__.split("\n")[0])
    parser.add_argument("--seed", type=int, default=SEED, help="seed of mutants and scenarios")
    parser.add_argument("--only", default="", help="rtl, c, modules, files")
    parser.add_argument("--each", type=int, default=EACH, help="mutants of a module (default: %(default)s)")
    parser.add_argument("--count", type=int, default=COUNT, help="mutants in C (default: %(default)s)")
    parser.add_argument("--tests", default="", help="files of tests that judge C (default: all)")
    parser.add_argument("--page", action="store_true", help="only write the page, from what is known")
    arguments = parser.parse_args()
    only = [name for name in arguments.only.split(",") if name]
    drawn = (arguments.seed, arguments.each, arguments.count)
    whole = not only or drawn == (SEED, EACH, COUNT)
    check_results(*[PAGE, modules_page.PAGE] * whole)
    began = time.monotonic()
    rtl: list[Score] = []
    c: list[Score] = []
    modules, files = _chosen(only, "rtl", ""), _chosen(only, "c", ".c")
    cores = CORES if modules is not None else ()
    parts = len(cores) + (files is not None)
    estimate = Estimate(parts)
    for number, core in enumerate(cores, 1):
        run = known_of if arguments.page else run_core
        rtl += run(core, arguments.seed, arguments.each, modules or [])
        _say(f"{core.name}: done, {estimate.counted(number)}")
    if files is not None:
        tests = [name for name in arguments.tests.split(",") if name]
        c = run_c(arguments.seed, arguments.count, files, tests, not arguments.page)
        _say(f"C: done, {estimate.counted(parts)}")
    show_table(rtl, c)
    _say(f"{time.monotonic() - began:.0f} s")
    if whole:
        write(rtl, c, arguments.seed)
    for case in rtl_judge.unfair:
        _say(f"the judge finds fault with the core itself: {case}")
    sys.exit(bool(rtl_judge.unfair))


if __name__ == "__main__":
    sys.exit(ended(main))
