"""Simulation package of the Passo step-pulse generator core."""

__version__ = "0.1.0"
