# SPDX-License-Identifier: MIT
"""What spec/generate_moves.py makes of spec/moves.toml."""
