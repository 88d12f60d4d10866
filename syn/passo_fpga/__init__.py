# SPDX-License-Identifier: MIT
"""FPGA flow: bitstreams, netlists and reports, with the YoWASP builds of Yosys and nextpnr."""
