# SPDX-License-Identifier: MIT
"""Random histories of both hands: paths, and trackers whose targets jump; stops, holds, switches, resets.

    python -m verify.soak.trackers SEED FIRST COUNT [--rtl] [--print]

The judge is that of verify/mutants/trackers_judge.py, which sees pins and replies alone. `--rtl`: the
Verilated core, compared with the model on every clock. Prints "failed NUMBER CLOCK TEXT" and "count NAME
VALUE".
"""

import random
import sys
from collections import Counter

from passo.build import Parameters
from passo.engine import model_engine, rtl_engine
from passo.failure import Failure
from passo.pair_engine import PairEngine

from verify.mutants.trackers_judge import KINDS, OF_INPUTS, Trackers
from verify.soak.parts import TRACKER_SETS

MOST = 4  # scenarios of a history


def play(parameters: Parameters, seed: int, number: int, rtl: bool, shows: bool) -> Counter[str]:
    """A history: some scenarios of any kinds, one after the other, on a core that has just begun.

    Raises:
        AssertionError: Pins or replies are not as they are known to be; the clock is the second argument.
        DifferenceError: Nor as those of the model.
    """
    rng = random.Random(f"{seed}/{number}")
    model = model_engine(parameters)
    counts: Counter[str] = Counter()
    with PairEngine(rtl_engine(parameters), model) if rtl else model as engine:
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
    seed, first, count = map(int, sys.argv[1:4])
    counts: Counter[str] = Counter()
    failed = 0
    for number in range(first, first + count):
        parameters = TRACKER_SETS[number % len(TRACKER_SETS)]
        try:
            counts += play(parameters, seed, number, "--rtl" in sys.argv, "--print" in sys.argv)
        except AssertionError as error:
            says, clock = error.args
            print(f"failed {number} {clock} {says.splitlines()[0] if says else 'not as it is known to be'}")
            failed += 1
        except Failure as error:
            print(f"failed {number} 0 {error}")
            failed += 1
    for name, value in {**counts, "histories": count}.items():
        print(f"count {name} {value}")
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
