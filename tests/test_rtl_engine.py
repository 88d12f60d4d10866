# SPDX-License-Identifier: MIT
"""The Verilated engine: how it is compiled, and the clocks that it runs in one evaluation."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from passo.build import CXX_CORE, Parameters, rtl_library
from passo.engine import Engine, model_engine, rtl_engine
from passo.move_file import parse_channels
from passo.plan import plan_channels
from passo.run import execute_channels
from passo.toolchain import paths

MOST = 4096  # clocks in one evaluation: CLOCKS_MOST of engine_rtl.cpp
CORE = Parameters()
MOVES = """
clock_hz = 100_000_000
[[move]]
steps = [40, -7]
speed = 8_000
acceleration = 400_000
profile = "linear"
"""


def verilated() -> Path:
    """The folder of the core that Verilator has made."""
    rtl_library(CORE)
    (folder,) = (paths.build / "lib").glob(f"verilated_{CORE.name}-*")
    return Path(folder)


def test_the_compiler_has_a_profile() -> None:
    """Without it a clock takes a sixth longer."""
    if CXX_CORE == "clang++" and not shutil.which("llvm-profdata"):
        pytest.skip("no llvm-profdata")
    made = list(verilated().glob("rest.profdata" if CXX_CORE == "clang++" else "*.gcda"))
    assert made and all(file.stat().st_size > 1000 for file in made)


@pytest.mark.parametrize("clocks", [1, 2, MOST - 1, MOST, MOST + 1, 5 * MOST + 3])
def test_a_run_at_rest_has_its_clocks(clocks: int) -> None:
    with rtl_engine(CORE) as engine:
        begin = engine.clock
        assert engine.run(clocks) == clocks
        assert engine.clock == begin + clocks


def played(engine: Engine) -> tuple[np.ndarray, int]:
    """Pins and clock of a motion whose steps are further apart than an evaluation."""
    channels = parse_channels(MOVES, Path("moves.toml"))
    with engine:
        (run,) = execute_channels(channels, plan_channels(channels, CORE), engine)
        return run.pins, engine.clock


def test_evaluations_of_many_clocks_change_nothing() -> None:
    """Against the model."""
    (seen, clock), (wanted, end) = played(rtl_engine(CORE)), played(model_engine(CORE))
    apart = np.diff(wanted["clock"])
    assert apart.max() > 2 * MOST and apart.min() < MOST
    assert clock == end and np.array_equal(seen, wanted)
