# SPDX-License-Identifier: MIT
"""Environment variables for random cases; the same seed gives the same cases."""

import math
import os
import random

SEED_VARIABLE = "PASSO_SEED"


def seed() -> int:
    """Seed of all random cases: PASSO_SEED, default 1."""
    return int(os.environ.get(SEED_VARIABLE, "1"))


def moves(default: int) -> int:
    """Number of random moves: PASSO_MOVES."""
    return int(os.environ.get("PASSO_MOVES", default))


def fuzz_seconds() -> float:
    """Duration of each fuzzer in seconds: PASSO_FUZZ_SECONDS, default 5."""
    return float(os.environ.get("PASSO_FUZZ_SECONDS", "5"))


def log_uniform(rng: random.Random, low: float, high: float) -> float:
    """A number from `low` to `high`, both above 0; each order of magnitude is as likely."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))
