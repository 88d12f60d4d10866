# SPDX-License-Identifier: MIT
"""Drives by name: the pin timings and polarities of drives.toml."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

TABLE = Path(__file__).with_name("drives.toml")


@dataclass(frozen=True)
class Drive:
    """What the inputs of a drive need; times as texts with a unit, minima."""

    name: str
    step_high: str
    step_low: str
    dir_setup: str  # before the active edge of STEP
    dir_hold: str  # after the end of STEP low
    enable_inverted: bool  # EN is active low
    input: str  # logic, opto-5V, 24V, RS-422
    source: str  # of the figures

    @property
    def pins(self) -> dict[str, str]:
        """As a table [pins]."""
        return {key: getattr(self, key) for key in ("step_high", "step_low", "dir_setup", "dir_hold")}


@cache
def drives() -> Mapping[str, Drive]:
    """All drives by name."""
    table = tomllib.loads(TABLE.read_text(encoding="utf-8"))
    return {drive["name"]: Drive(**drive) for drive in table["drive"]}
