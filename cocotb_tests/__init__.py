# SPDX-License-Identifier: MIT
"""cocotb tests of the RTL: `pytest cocotb_tests`, one pytest function per module and simulator."""
