# SPDX-License-Identifier: MIT
"""What spec/generate_pins.py makes of spec/pins.toml."""
