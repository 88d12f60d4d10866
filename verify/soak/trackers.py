# SPDX-License-Identifier: MIT
"""Random histories of both hands: paths, and trackers whose targets jump; stops, holds, switches, resets.

    python -m verify.soak.trackers SEED FIRST COUNT [--rtl [FOLDER]] [--set N] [--fast] [--print]

The judge is that of verify/mutants/trackers_judge.py, which sees pins and replies alone. `--rtl`: the
Verilated core, of sources or of a changed copy, compared with the model on every clock. `--set`: one of
TRACKER_SETS, not all by turns. `--fast`: the first failure is the end. Prints "failed NUMBER CLOCK TEXT" and
"count NAME VALUE".
"""

import argparse
import random
import sys
from collections import Counter
from pathlib import Path

from passo.build import Parameters
from passo.engine import model_engine, rtl_engine
from passo.failure import Failure
from passo.pair_engine import PairEngine
from passo.toolchain import paths

from verify.mutants.trackers_judge import KINDS, OF_INPUTS, Trackers
from verify.soak.parts import TRACKER_SETS

MOST = 4  # scenarios of a history


def play(parameters: Parameters, seed: int, number: int, rtl: Path | None, shows: bool) -> Counter[str]:
    """A history: some scenarios of any kinds, one after the other, on a core that has just begun.

    Raises:
        AssertionError: Pins or replies are not as they are known to be; the clock is the second argument.
        DifferenceError: Nor as those of the model.
    """
    rng = random.Random(f"{seed}/{number}")
    model = model_engine(parameters)
    counts: Counter[str] = Counter()
    with PairEngine(rtl_engine(parameters, rtl=rtl), model) if rtl else model as engine:
        trackers = Trackers(engine, parameters, rng)
        kinds = [name for name in KINDS if parameters.inputs or name not in OF_INPUTS]
        try:
            trackers.set_up()
            trackers.measure()
            for name in rng.choices(kinds, k=rng.randint(1, MOST)):
                if shows:
                    print(f"clock {engine.clock}: {name}")
                KINDS[name](trackers)
                counts[f"both:{name}"] += 1
        except AssertionError as failed:
            raise AssertionError(str(failed), engine.clock) from failed
        return counts + Counter({"histories": 1, "clocks": engine.clock, "steps": trackers.made})


def main() -> None:
    """Play, and exit with 1 if a history fails."""
    parser = argparse.ArgumentParser(prog="python -m verify.soak.trackers", description="Paths and trackers.")
    for name in ("seed", "first", "count"):
        parser.add_argument(name, type=int)
    parser.add_argument("sources", nargs="?", help="their hash, by which results are kept")
    parser.add_argument("--rtl", type=Path, nargs="?", const=paths.rtl)
    parser.add_argument("--set", type=int, choices=range(len(TRACKER_SETS)))
    parser.add_argument("--fast", action="store_true")
    parser.add_argument("--print", action="store_true")
    asked = parser.parse_args()
    sets = TRACKER_SETS if asked.set is None else (TRACKER_SETS[asked.set],)
    counts: Counter[str] = Counter()
    failed = 0
    for number in range(asked.first, asked.first + asked.count):
        parameters = sets[number % len(sets)]
        try:
            counts += play(parameters, asked.seed, number, asked.rtl, asked.print)
        except AssertionError as error:
            says, clock = error.args
            print(f"failed {number} {clock} {says.splitlines()[0] if says else 'not as it is known to be'}")
            failed += 1
        except Failure as error:
            print(f"failed {number} 0 {error}")
            failed += 1
        if failed and asked.fast:
            break
    for name, value in {**counts, "histories": counts["histories"] + failed}.items():
        print(f"count {name} {value}")
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
