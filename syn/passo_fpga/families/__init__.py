# SPDX-License-Identifier: MIT
"""The families of FPGAs, a module each; its cells for the board top are in syn/families/NAME.v."""
