# SPDX-License-Identifier: MIT
"""Passo compared with published methods of making step pulses with microcontroller timers."""
