# SPDX-License-Identifier: MIT
"""The core in a LiteX SoC: three axes as a peripheral on the Wishbone bus, with an interrupt.

    python motion_litex.py > motion_top.v

writes a SoC without a processor, whose bus is at its pins.
"""

from litex.build.generic_platform import GenericPlatform, Pins
from litex.soc.integration.soc_core import SoCMini
from litex.soc.interconnect import wishbone
from migen.genlib.io import CRG
from passo.litex import Passo

AXES = 3
CLOCK_HZ = 100_000_000
BASE = 0x3000_0000
INPUTS = {"limit_low": AXES, "limit_high": AXES, "estop_n": 1}
OUTPUTS = {"step": AXES, "dir": AXES, "enable": AXES}


def bus_interface() -> wishbone.Interface:
    """32 bits, byte addresses."""
    return wishbone.Interface(data_width=32, adr_width=32, addressing="byte")


class Soc(SoCMini):
    """A SoC whose only master is at the pins."""

    def __init__(self, platform: GenericPlatform) -> None:
        self.crg = CRG(platform.request("clk"), platform.request("rst"))
        SoCMini.__init__(self, platform, CLOCK_HZ)
        # drives with an active-low enable: off at first
        self.passo = Passo(platform, axes=AXES, inputs=1, clock_hz=CLOCK_HZ, enable_reset=0b111)
        self.bus.add_slave("passo", self.passo.bus, Passo.region(BASE))
        master = bus_interface()
        self.comb += master.connect_to_pads(platform.request("wb"), mode="slave")
        self.bus.add_master("pins", master)
        for name in INPUTS:
            self.comb += getattr(self.passo, name).eq(platform.request(name))
        for name in OUTPUTS:
            self.comb += platform.request(name).eq(getattr(self.passo, name))


def pins(count: int) -> Pins:
    """Pins without a place."""
    return Pins(" ".join(["X"] * count))


WIDTHS = {"clk": 1, "rst": 1, **INPUTS, **OUTPUTS}
IO = [(name, 0, pins(width)) for name, width in WIDTHS.items()]

if __name__ == "__main__":
    platform = GenericPlatform("", IO)
    platform.add_extension(bus_interface().get_ios("wb"))
    print(platform.get_verilog(Soc(platform), name="motion_top"))
