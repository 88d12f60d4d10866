# SPDX-License-Identifier: MIT
"""Generate from the pins and parameters of the core: structs in C, a table in Python, benches in Verilog.

Their source is spec/pins.toml.
"""

import sys
from collections.abc import Callable
from pathlib import Path

from generated import is_check, keep
from pins import c, python, verilog
from pins.schema import SOURCE, Source

ROOT = Path(__file__).resolve().parent.parent

OUTPUTS: dict[str, Callable[[Source], str]] = {
    "c_model/core/passo_pins.h": c.header,
    "sim/engine/passo_engine.v": verilog.engine,
    "sim/passo/pins.py": python.module,
    "cocotb_tests/probes/passo_spi_top.vh": verilog.probe,
    "verify/soak/player_pins.vh": verilog.player,
}


def main() -> int:
    check = is_check(f"Generate what runs the core from {SOURCE}.")
    source = Source.read(ROOT)
    return keep(ROOT, {name: write(source) for name, write in OUTPUTS.items()}, check)


if __name__ == "__main__":
    sys.exit(main())
