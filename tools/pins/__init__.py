# SPDX-License-Identifier: MIT
"""What tools/generate_pins.py makes of schema/pins.toml."""
