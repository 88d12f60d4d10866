# SPDX-License-Identifier: MIT
"""The core as a module of LiteX (pip install 'passo[litex]'). In a SoC:

    self.passo = Passo(platform, axes=3, inputs=1, clock_hz=int(sys_clk_freq))
    self.bus.add_slave("passo", self.passo.bus, Passo.region(0x3000_0000))
    self.irq.add("passo")
    self.comb += platform.request("step").eq(self.passo.step)
    self.comb += platform.request("dir").eq(self.passo.dir)

The C driver runs on the processor: its `transfer` is that of stm32_bridge/examples/soft_cpu.c.
"""

from dataclasses import asdict, fields
from math import prod

from litex.build.generic_platform import GenericPlatform
from litex.gen import LiteXModule
from litex.soc.integration.soc import SoCRegion
from litex.soc.interconnect import wishbone
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourceLevel
from migen import ClockSignal, Constant, Instance, ResetSignal, Signal

from passo.build import LEVELS, Parameters
from passo.failure import BadInputError
from passo.pins import INPUTS, OUTPUTS, Pin
from passo.toolchain import paths

BYTES = 4096  # of the address space, two registers of which answer
_LINK = ("rst", "spi_sclk", "spi_mosi", "spi_cs_n", "spi_miso")


def _bits(pin: Pin, core: Parameters) -> int:
    numbers = {"CHANNELS": core.channels, "AXES": core.axes}
    return prod(numbers.get(factor) or int(factor) for factor in pin.width.split("*"))


class Passo(LiteXModule):
    """passo_wishbone in the domain `sys`: `bus` is its slave, `ev.stopped` its interrupt.

    Each pin of the core is a Signal of its name (`step`, `limit_low`, ...), with a bit for each axis or
    channel; an input has its idle level unless something drives it. The pin `sync` is `sync_pin`, because
    LiteX needs that name.
    """

    def __init__(self, platform: GenericPlatform, steps_register: int = 0, **parameters: int) -> None:
        """Add the sources to the platform; `parameters` are those of passo.build.Parameters.

        `steps_register` is 1 on an FPGA whose block RAMs have output registers (docs/integration.md).
        Raises BadInputError for a name that is none of the parameters.
        """
        known = [field.name for field in fields(Parameters)]
        if unknown := set(parameters) - set(known):
            raise BadInputError(f"unknown parameter {min(unknown)}; must be one of {', '.join(known)}")
        core = Parameters(**parameters)
        self.bus = bus = wishbone.Interface(data_width=32, adr_width=32, addressing="byte")
        self.ev = EventManager()
        self.ev.stopped = EventSourceLevel()
        self.ev.finalize()
        ports: dict[str, object] = {}
        for way, pins in (("i", INPUTS), ("o", OUTPUTS)):
            for pin in pins:
                if pin.name in _LINK:
                    continue
                bits = _bits(pin, core)
                signal = Signal(bits, name=pin.name, reset=pin.idle * ((1 << bits) - 1) if way == "i" else 0)
                setattr(self, "sync_pin" if pin.name == "sync" else pin.name, signal)
                ports[f"{way}_{pin.name}"] = signal
        self.comb += self.ev.stopped.trigger.eq(self.irq)
        wide = core.channels * core.axes
        for name, value in asdict(core).items():
            ports[f"p_{name.upper()}"] = Constant(value, wide) if name in LEVELS else value
        self.specials += Instance(
            "passo_wishbone",
            p_STEPS_REGISTER=steps_register,
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
            **ports,
        )
        platform.add_verilog_include_path(str(paths.rtl))
        for source in sorted(paths.rtl.glob("*.v")):
            platform.add_source(str(source))

    @staticmethod
    def region(origin: int) -> SoCRegion:
        """Where the bus of a SoC has the core: a byte address, a multiple of BYTES."""
        return SoCRegion(origin=origin, size=BYTES, cached=False)
