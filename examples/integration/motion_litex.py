# SPDX-License-Identifier: MIT
"""The core in a LiteX SoC: three axes as a peripheral on the Wishbone bus, with an interrupt.

    python motion_litex.py > motion_top.v

writes a SoC without a processor, whose bus is at its pins. The C driver runs on the processor of a SoC: its
`transfer` is that of stm32_bridge/examples/soft_cpu.c.
"""

from litex.build.generic_platform import GenericPlatform, Pins
from litex.gen import LiteXModule
from litex.soc.integration.soc import SoCRegion
from litex.soc.integration.soc_core import SoCMini
from litex.soc.interconnect import wishbone
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourceLevel
from migen import ClockSignal, Constant, Instance, ResetSignal, Signal
from migen.genlib.io import CRG

AXES = 3
CLOCK_HZ = 100e6
BASE = 0x3000_0000
INPUTS = {"limit_low": AXES, "limit_high": AXES, "estop_n": 1}
OUTPUTS = {"step": AXES, "dir": AXES, "enable": AXES}


def bus_interface() -> wishbone.Interface:
    """32 bits, byte addresses."""
    return wishbone.Interface(data_width=32, adr_width=32, addressing="byte")


class Passo(LiteXModule):
    """The core: `bus` is its slave, the other signals are pins.

    In a SoC of yours:

        self.passo = Passo()
        self.bus.add_slave("passo", self.passo.bus, SoCRegion(origin=BASE, size=4096, cached=False))
        self.irq.add("passo")
    """

    def __init__(self) -> None:
        self.bus = bus = bus_interface()
        self.limit_low, self.limit_high = Signal(AXES), Signal(AXES)
        self.estop_n = Signal()
        self.step, self.dir, self.enable = Signal(AXES), Signal(AXES), Signal(AXES)
        self.ev = EventManager()
        self.ev.stopped = EventSourceLevel()
        self.ev.finalize()
        none = Constant(0, AXES)
        self.specials += Instance(
            "passo_wishbone",
            p_AXES=AXES,
            p_INPUTS=1,
            p_CLOCK_HZ=int(CLOCK_HZ),
            p_ENABLE_RESET=Constant(0b111, AXES),  # drives with an active-low enable: off at first
            i_clk=ClockSignal(),
            i_rst=ResetSignal(),
            i_wb_cyc_i=bus.cyc,
            i_wb_stb_i=bus.stb,
            i_wb_we_i=bus.we,
            i_wb_adr_i=bus.adr[:3],
            i_wb_sel_i=bus.sel,
            i_wb_dat_i=bus.dat_w,
            o_wb_dat_o=bus.dat_r,
            o_wb_ack_o=bus.ack,
            o_wb_err_o=bus.err,
            i_sync=0,
            i_limit_low=self.limit_low,
            i_limit_high=self.limit_high,
            i_home=none,
            i_alarm=none,
            i_probe=0,
            i_estop_n=self.estop_n,
            i_encoder_a=none,
            i_encoder_b=none,
            i_encoder_index=none,
            o_step=self.step,
            o_dir=self.dir,
            o_enable=self.enable,
            o_irq=self.ev.stopped.trigger,
        )


class Soc(SoCMini):
    """A SoC whose only master is at the pins."""

    def __init__(self, platform: GenericPlatform) -> None:
        self.crg = CRG(platform.request("clk"), platform.request("rst"))
        SoCMini.__init__(self, platform, CLOCK_HZ)
        self.passo = Passo()
        self.bus.add_slave("passo", self.passo.bus, SoCRegion(origin=BASE, size=4096, cached=False))
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
