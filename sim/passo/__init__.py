"""Simulation package of the Passo step-pulse generator core."""

from pathlib import Path

__version__ = (Path(__file__).parents[2] / "VERSION").read_text(encoding="utf-8").strip()
