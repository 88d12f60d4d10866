# SPDX-License-Identifier: MIT
"""Random histories of the core, aimed at the clocks where something changes, and their judge."""
