# SPDX-License-Identifier: MIT
"""From Verilog to bitstreams, netlists and figures, with the YoWASP builds of Yosys and nextpnr."""
