# SPDX-License-Identifier: MIT
"""Tests of everything except the RTL alone; shared code is in tests/helpers."""
