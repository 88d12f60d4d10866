# SPDX-License-Identifier: MIT
"""Tests of everything but the RTL alone; what several of them share is in tests/helpers."""
