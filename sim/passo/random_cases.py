# SPDX-License-Identifier: MIT
"""Environment variables for random cases; the same seed gives the same cases."""

import os

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
