# SPDX-License-Identifier: MIT
"""The FPGAs that the report measures and that boards have."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from passo_fpga.families.ecp5 import ECP5
from passo_fpga.families.family import Family
from passo_fpga.families.gowin import GW1N, GW2A
from passo_fpga.families.ice40 import ICE40
from passo_fpga.families.xilinx7 import XILINX7

# SCLK comes from the host; a core clock of 100 MHz allows 25 MHz.
SPI_MHZ = 25


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
            GW1N,
            "synth_gowin",
            ("--device", "GW1NR-LV9QN88PC6/I5", "--vopt", "family=GW1N-9C"),
            capacity=8640,
            target_mhz=100,
            pins=(
                *(52, 35, *range(25, 35), *range(36, 43), 48, 49, 51),
                *(*range(53, 58), 63, *range(68, 78), *range(79, 87), 11, *range(13, 21)),
            ),
        ),
        Device(
            "gw2ar-18",
            "GW2AR-18 C8/I7",
            GW2A,
            "synth_gowin -family gw2a",
            ("--device", "GW2AR-LV18QN88C8/I7", "--vopt", "family=GW2A-18C"),
            capacity=20736,
            target_mhz=120,
            pins=(
                *(80, 77, *range(25, 35), *range(36, 43), 48, 49, 51),
                *(*range(53, 57), *range(69, 77), 79, *range(81, 87)),
            ),
        ),
        Device(
            "artix-7",
            "Artix-7 (synthesis only)",
            XILINX7,
            "synth_xilinx -family xc7",
            (),
            capacity=20800,  # XC7A35T
            target_mhz=0,
            core={"STEPS_REGISTER": 1},
        ),
    )
}
