# SPDX-License-Identifier: MIT
"""A kit for cocotb tests of designs with the core in them: docs/cocotb.md."""
