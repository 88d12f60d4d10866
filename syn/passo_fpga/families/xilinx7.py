# SPDX-License-Identifier: MIT
"""Xilinx 7 series: synthesis only."""

from passo_fpga.families.family import Family

XILINX7 = Family(
    name="xilinx7",
    size_unit="LUT",
    cells={
        "LUT": {"LUT1": 1, "LUT2": 1, "LUT3": 1, "LUT4": 1, "LUT5": 1, "LUT6": 1, "RAM32M": 4, "RAM64M": 4},
        "FF": {"FDRE": 1, "FDSE": 1, "FDCE": 1, "FDPE": 1},
        "carry": {"CARRY4": 4},
        "BRAM": {"RAMB18E1": 1, "RAMB36E1": 2},  # of 18 Kbit
        "DSP": {"DSP48E1": 1},
    },
)
