# SPDX-License-Identifier: MIT
"""Warnings of the tools that are treated as errors: no bitstream is made with any of them."""

import re

# Yosys and nextpnr print "Warning". nextpnr's warnings of missed clocks are excluded: the figures are
# checked. It reports unknown names in a pin file only as information; the pins of the memory in the package
# of a GW1NR or GW2AR are never in such a file. On a GW2A it tries its long wires for data as well: a net that
# does not get them, to the input of a LUT, is routed as any other.
_COMPLAINT = re.compile(
    r"^(?:(?:\S+:\d+: )?(?:Warning: (?!Max frequency for clock"
    r"|Failed to route net \S+ from \S+ to X\d+Y\d+/[A-D]\d using dedicated)|ERROR: ).*"
    r"|Info: (?:Cell|Net) (?!I?O_(?:psram|sdram)_).* not found)$",
    re.M,
)


def complaints(log: str) -> tuple[str, ...]:
    """Warnings in a log of Yosys or nextpnr, without duplicates."""
    return tuple(dict.fromkeys(_COMPLAINT.findall(log)))


def packer_complaints(log: str) -> tuple[str, ...]:
    """Messages of a packer, which prints nothing on success."""
    return tuple(dict.fromkeys(line for line in log.splitlines() if line.strip()))
