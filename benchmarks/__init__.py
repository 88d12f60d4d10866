# SPDX-License-Identifier: MIT
"""Passo against published ways of making step pulses with a microcontroller's timers."""
