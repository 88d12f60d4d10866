# SPDX-License-Identifier: MIT
"""Random machines and moves for the planner."""

import random

from passo import random_cases
from passo.random_cases import log_uniform

from tests.helpers.plans import AXES, Machine

SEED = random_cases.seed()


def some_machine(rng: random.Random) -> Machine:
    clock_hz = rng.choice(
        (72_000_000, 100_000_000, 50_000_000, 12_000_000, 99_999_989, 1_000_000, 4_294_967_295)
    )
    return Machine(clock_hz, rng.choice((7, 7, 7, 8, 10, 12, 16)))


def some_steps(rng: random.Random, longest: int) -> tuple[int, ...]:
    axes = rng.randint(1, AXES)
    steps = [rng.choice((0, 1, longest, int(log_uniform(rng, 1, longest + 1)))) for _ in range(axes)]
    steps[rng.randrange(axes)] = longest
    return tuple(min(n, longest) * rng.choice((1, -1)) for n in steps)


MOVES = random_cases.moves(300)
