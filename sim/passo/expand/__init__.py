# SPDX-License-Identifier: MIT
"""`passo expand`: the language of LinuxCNC becomes plain lines that any Passo takes."""
