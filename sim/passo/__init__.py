"""Simulation package of the Passo step-pulse generator core."""

from importlib.metadata import version
from pathlib import Path

_release = Path(__file__).parents[2] / "VERSION"  # of the repository, newer than its installation

__version__ = _release.read_text(encoding="utf-8").strip() if _release.exists() else version("passo")
