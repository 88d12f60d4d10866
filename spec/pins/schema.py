# SPDX-License-Identifier: MIT
"""Read spec/pins.toml: parameters and pins of the core."""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

SOURCE = "spec/pins.toml"
GENERATED = f"Generated from {SOURCE} by spec/generate_pins.py."
C_TYPES = {"1": "bool", "CHANNELS": "uint8_t"}  # of a width; others have a bit for each axis or more


@dataclass(frozen=True)
class Parameter:
    """A parameter that the host can read back."""

    name: str
    default: int
    text: str
    bits: int = 8


@dataclass(frozen=True)
class Pin:
    """An input or output of passo_spi_top."""

    name: str
    width: str = "1"
    idle: int = 0
    parameter: str = ""
    follows_sclk: bool = False

    @property
    def c_type(self) -> str:
        """Type of its levels."""
        return C_TYPES.get(self.width, "uint64_t")

    @property
    def verilog(self) -> str:
        """Range and name."""
        return self.name if self.width == "1" else f"[{self.width}-1:0] {self.name}"

    @property
    def idle_level(self) -> str:
        """In Verilog, for all bits."""
        return f"1'b{self.idle}" if self.width == "1" else f"{{{self.width}{{1'b{self.idle}}}}}"


@dataclass(frozen=True)
class Source:
    """What the table has."""

    parameters: Sequence[Parameter]
    levels: Sequence[str]
    inputs: Sequence[Pin]
    outputs: Sequence[Pin]  # without MISO

    @classmethod
    def read(cls, root: Path) -> "Source":
        """Read the table."""
        table = tomllib.loads((root / SOURCE).read_text(encoding="utf-8"))
        assert not table.keys() - {"parameter", "level", "input", "output"}
        outputs = [Pin(**pin) for pin in table["output"]]
        assert [pin.name for pin in outputs if pin.follows_sclk] == ["spi_miso"]
        return cls(
            [Parameter(**parameter) for parameter in table["parameter"]],
            [level["name"] for level in table["level"]],
            [Pin(**pin) for pin in table["input"]],
            [pin for pin in outputs if not pin.follows_sclk],
        )
