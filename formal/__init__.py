# SPDX-License-Identifier: MIT
"""Proofs of what the Verilog promises, and the program that runs them."""
