# SPDX-License-Identifier: MIT
"""Mutation testing: the small faults that judges see without knowing the model."""
