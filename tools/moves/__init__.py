# SPDX-License-Identifier: MIT
"""What tools/generate_moves.py makes of schema/moves.toml."""
