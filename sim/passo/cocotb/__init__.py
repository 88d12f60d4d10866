# SPDX-License-Identifier: MIT
"""Helpers for cocotb tests of designs that contain the core: docs/cocotb.md."""
