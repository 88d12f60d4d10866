# SPDX-License-Identifier: MIT
"""Formal proofs of the RTL, and the program that runs them."""
