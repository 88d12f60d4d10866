# SPDX-License-Identifier: MIT
"""What tools/generate_registers.py makes of registers/passo.rdl."""
