# SPDX-License-Identifier: MIT
"""Warnings of the tools that are treated as errors: no bitstream is made with any of them."""

import re
from collections.abc import Collection, Mapping
from importlib.resources import as_file, files

# Yosys and nextpnr print "Warning". nextpnr's warnings of missed clocks are excluded: the figures are
# checked. It reports unknown names in a pin file only as information; the pins of the memory in the package
# of a GW1NR are never in such a file.
_COMPLAINT = re.compile(
    r"^(?:(?:\S+:\d+: )?(?:Warning: (?!Max frequency for clock)|ERROR: ).*"
    r"|Info: (?:Cell|Net) (?!I?O_psram_).* not found)$",
    re.M,
)

# Configuration functions of Gowin pins that stay active unless the packer releases them. Those of the other
# configuration modes (D0, DIN, WE_N, ...) end with the configuration.
_RELEASES = {
    **dict.fromkeys(("SCLK", "SSPI_CS_N", "SI", "SO", "CLKHOLD_N"), "--sspi_as_gpio"),
    **dict.fromkeys(("MCLK", "MCS_N", "MI", "MO", "FASTRD_N"), "--mspi_as_gpio"),
    **dict.fromkeys(("TMS", "TCK", "TDI", "TDO", "JTAGSEL_N"), "--jtag_as_gpio"),
    **{"READY": "--ready_as_gpio", "DONE": "--done_as_gpio", "RECONFIG_N": "--reconfign_as_gpio"},
}


def complaints(log: str) -> tuple[str, ...]:
    """Warnings in a log of Yosys or nextpnr, without duplicates."""
    return tuple(dict.fromkeys(_COMPLAINT.findall(log)))


def packer_complaints(log: str) -> tuple[str, ...]:
    """Messages of a packer, which prints nothing on success."""
    return tuple(dict.fromkeys(line for line in log.splitlines() if line.strip()))


def gowin_functions() -> dict[str, list[str]]:
    """The special functions of each pin of a GW1NR-9C in QFN88P."""
    from apycula.chipdb import load_chipdb

    with as_file(files("apycula") / "GW1N-9C.msgpack.xz") as path:
        pins = load_chipdb(path).pinout["GW1NR-9C"]["QFN88P"]
    return {pin: functions for pin, (_, functions) in pins.items()}


def held_pins(
    pins: Mapping[str, str], functions: Mapping[str, Collection[str]], options: Collection[str]
) -> tuple[str, ...]:
    """Ports at Gowin pins that these packer options do not release from configuration."""
    held = []
    for port, pin in pins.items():
        missing = {_RELEASES[function] for function in functions.get(pin, ()) if function in _RELEASES}
        held += [f"{port}: pin {pin} is not free without {option}" for option in sorted(missing - {*options})]
    return tuple(held)
