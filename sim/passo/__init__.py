"""Simulation package of the Passo step-pulse generator core."""

from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from passo.host_machine import Machine as Machine

_release = Path(__file__).parents[2] / "VERSION"  # of the repository, newer than its installation

__version__ = _release.read_text(encoding="utf-8").strip() if _release.exists() else version("passo")


def __getattr__(name: str) -> Any:
    """Machine, imported when it is first asked for: `passo --help` does not need numpy and cffi."""
    if name != "Machine":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from passo.host_machine import Machine

    return Machine
