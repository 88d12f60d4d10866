# SPDX-License-Identifier: MIT
"""What the tools do not like although they go on and end well: no board is made with any of it."""

import re
from collections.abc import Collection, Mapping
from importlib.resources import as_file, files

# Yosys and nextpnr say "Warning", nextpnr also of clocks that are missed, which are judged by their figures.
# As mere information it says that a file of pins names what is not there; the memory in the package
# of a GW1NR has pins that no such file names.
_COMPLAINT = re.compile(
    r"^(?:(?:\S+:\d+: )?(?:Warning: (?!Max frequency for clock)|ERROR: ).*"
    r"|Info: (?:Cell|Net) (?!I?O_psram_).* not found)$",
    re.M,
)

# Functions of the pins of a Gowin that serve its configuration until the packer is told to make them free.
# Those of the other ways to configure it (D0, DIN, WE_N ...) end with the configuration.
_RELEASES = {
    **dict.fromkeys(("SCLK", "SSPI_CS_N", "SI", "SO", "CLKHOLD_N"), "--sspi_as_gpio"),
    **dict.fromkeys(("MCLK", "MCS_N", "MI", "MO", "FASTRD_N"), "--mspi_as_gpio"),
    **dict.fromkeys(("TMS", "TCK", "TDI", "TDO", "JTAGSEL_N"), "--jtag_as_gpio"),
    **{"READY": "--ready_as_gpio", "DONE": "--done_as_gpio", "RECONFIG_N": "--reconfign_as_gpio"},
}


def complaints(log: str) -> tuple[str, ...]:
    """Of Yosys or nextpnr, each once."""
    return tuple(dict.fromkeys(_COMPLAINT.findall(log)))


def packer_complaints(log: str) -> tuple[str, ...]:
    """Of a packer, which has nothing to say when all is well."""
    return tuple(dict.fromkeys(line for line in log.splitlines() if line.strip()))


def gowin_functions() -> dict[str, list[str]]:
    """The functions of each pin of a GW1NR-9C in QFN88P, beside that of a plain pin."""
    from apycula.chipdb import load_chipdb

    with as_file(files("apycula") / "GW1N-9C.msgpack.xz") as path:
        pins = load_chipdb(path).pinout["GW1NR-9C"]["QFN88P"]
    return {pin: functions for pin, (_, functions) in pins.items()}


def held_pins(
    pins: Mapping[str, str], functions: Mapping[str, Collection[str]], options: Collection[str]
) -> tuple[str, ...]:
    """Ports at pins of a Gowin that its configuration does not set free with these packer options."""
    held = []
    for port, pin in pins.items():
        missing = {_RELEASES[function] for function in functions.get(pin, ()) if function in _RELEASES}
        held += [f"{port}: pin {pin} is not free without {option}" for option in sorted(missing - {*options})]
    return tuple(held)
