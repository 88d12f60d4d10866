# SPDX-License-Identifier: MIT
"""Verification of the promises: proofs, equality, histories, mutants."""
