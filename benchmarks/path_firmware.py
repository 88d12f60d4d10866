# SPDX-License-Identifier: MIT
"""Instructions of the path planner on the emulated STM32F103, and its results compared with a PC's."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path as FilePath

from passo.build import Parameters
from passo.native import ffi
from passo.path import LOOK_AHEAD, PathSettings
from passo.path_rounding import Line
from passo.toolchain import paths
from passo_stm32.board import program_elf
from passo_stm32.machine import Machine

from benchmarks.path_plan import plan

SOURCE = paths.root / "benchmarks" / "stm32_path.c"
BATCH = 32  # moves at a time
PRIME, START = 16777619, 2166136261  # of the hash
WORD = 0xFFFFFFFF


@dataclass(frozen=True)
class FirmwareCost:
    """Of a path on the STM32F103."""

    per_line: int  # instructions
    same: bool  # lines and ramps are those of a PC
    bytes_used: int  # RAM of planner and look-ahead


def path_elf() -> FilePath:
    """Build the program; return the path of its ELF file."""
    return program_elf("firmware_path", SOURCE, "LEFT_OUT=-DPASSO_WITHOUT_GOTO -DPASSO_PATH_AXES_MAX=3u")


def in_micrometers(lines: Sequence[Line]) -> list[Line]:
    """The same path with targets in whole micrometers, as the program takes them."""
    return [(tuple(Fraction(round(mm * 1000), 1000) for mm in target), feed) for target, feed in lines]


def hash_of(lines: Sequence[Line], settings: PathSettings) -> int:
    """The hash of all lines and ramps, as planned here."""
    found = START
    for word in plan(lines, settings, LOOK_AHEAD).words:
        found = (found ^ word) * PRIME & WORD
    return found


def measure(lines: Sequence[Line], settings: PathSettings) -> FirmwareCost:
    """Plan a path on the microcontroller; targets are rounded to micrometers, feeds to mm/s."""
    lines = in_micrometers(lines)
    machine = Machine(path_elf(), None)
    machine.run(0.05)
    symbols = machine.elf.symbols
    struct = settings.struct(Parameters())
    machine.write_memory(symbols["path_settings"], bytes(ffi().buffer(struct)))

    def put(name: str, value: int) -> None:
        machine.write_memory(symbols[f"path_{name}"], value.to_bytes(4, "little"))

    def get(name: str) -> int:
        return int.from_bytes(machine.read_memory(symbols[f"path_{name}"], 4), "little")

    put("go", 1)
    machine.run_until(lambda: get("go") == 0, 1.0)
    total = 0
    for begin in range(0, len(lines), BATCH):
        batch = lines[begin : begin + BATCH]
        words = [
            number & WORD
            for target, feed in batch
            for number in (*(int(mm * 1000) for mm in target), round(feed) if feed else 0)
        ]
        moves = b"".join(word.to_bytes(4, "little") for word in words)
        machine.write_memory(symbols["path_moves"], moves)
        put("count", len(batch))
        put("ends", int(begin + BATCH >= len(lines)))
        machine.measure("path_batch")
        put("go", 1)
        machine.run_until(lambda: machine.measured() is not None and get("go") == 0, 5.0)
        total += machine.measured() or 0
    if get("error"):
        raise AssertionError(f"planner error {get('error')}")
    same = get("check") == hash_of(lines, settings)
    size = ffi().sizeof("struct passo_path_planner") + LOOK_AHEAD * ffi().sizeof("struct passo_path_item")
    return FirmwareCost(round(total / len(lines)), same, size)
