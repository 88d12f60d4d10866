# SPDX-License-Identifier: MIT
"""Where boards have their pins: `J2 25`, from the comments of board.toml; and those of the Blue Pill."""

import re
from collections.abc import Iterator, Sequence

from passo.toolchain import paths

from passo_fpga.boards import OF_AXIS, path_of

LINK = ("spi_cs_n", "spi_sclk", "spi_mosi", "spi_miso", "irq")
_PLACE = re.compile(
    r"(?:([A-Z]\w*) )?(\d+)(?: to (\d+))?$"
)  # `J2 5`, `6` on the same connector, `J2 33 to 38`


def _places(note: str) -> Iterator[str]:
    """The places of a comment, until a word that is none: `J3 3, 4; J2 1`, `J5 7, a clock input`."""
    connector = ""
    for word in re.split(r"[,;] *", note):
        found = _PLACE.match(word.strip())
        if not found or not (found[1] or connector):
            return
        connector = found[1] or connector
        yield from (f"{connector} {pin}" for pin in range(int(found[2]), int(found[3] or found[2]) + 1))


def _bits(port: str, value: str) -> Sequence[str]:
    return [f"{port}[{bit}]" for bit in range(value.count(",") + 1)] if value.startswith("[") else [port]


def places(board: str) -> dict[str, str]:
    """The place of each port bit that has one; without connectors the board shows the number of the pin."""
    text = path_of(board).read_text(encoding="utf-8")
    found: dict[str, str] = {}
    for port, value, note in re.findall(r"^(\w+) = (\[[^]]*\]|[^#\n]*?) *# (.*)$", text, re.M):
        found |= zip(_bits(port, value), _places(note), strict=False)
    for axis, note in enumerate(re.findall(r"^  \{ step = .*?\}, *(?:# (.*))?$", text, re.M)):
        found |= zip((f"{port}[{axis}]" for port in OF_AXIS), _places(note), strict=False)
    return found


def host_pins() -> dict[str, str]:
    """Pins of the Blue Pill by the signal of the core, from the table in docs/firmware.md."""
    text = (paths.docs / "firmware.md").read_text(encoding="utf-8")
    found = {signal: pin for pin, signal in re.findall(r"^\| (P\w+) \| [^|]* \| `(\w+)`", text, re.M)}
    assert set(found) == set(LINK), found
    return found
