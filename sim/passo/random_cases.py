# SPDX-License-Identifier: MIT
"""What the environment says about random cases: the same seed gives the same cases."""

import os

SEED_VARIABLE = "PASSO_SEED"


def seed() -> int:
    """Seed of all random cases: PASSO_SEED, default 1."""
    return int(os.environ.get(SEED_VARIABLE, "1"))


def moves(default: int) -> int:
    """How many random moves are planned: PASSO_MOVES."""
    return int(os.environ.get("PASSO_MOVES", default))


def fuzz_seconds() -> float:
    """How long each fuzzer runs: PASSO_FUZZ_SECONDS, default 5."""
    return float(os.environ.get("PASSO_FUZZ_SECONDS", "5"))
