# SPDX-License-Identifier: MIT
"""What spec/generate_registers.py makes of spec/passo.rdl."""
