# SPDX-License-Identifier: MIT
"""The core in an Amaranth design: three axes behind SPI, with limit switches and an e-stop. See motion_top.v.

python motion_amaranth.py > motion_top.v
"""

from amaranth import ClockSignal, Const, Elaboratable, Instance, Module, ResetSignal, Signal
from amaranth.back import verilog

AXES = 3


class Motion(Elaboratable):
    """The ports of motion_top.v; the domain `sync` is the clock, at least four times SCLK, and its reset."""

    def __init__(self) -> None:
        self.spi_sclk = Signal()
        self.spi_mosi = Signal()
        self.spi_cs_n = Signal()
        self.spi_miso = Signal()
        self.irq = Signal()
        self.estop_n = Signal()
        self.limit_low = Signal(AXES)
        self.limit_high = Signal(AXES)
        self.step = Signal(AXES)
        self.dir = Signal(AXES)
        self.enable = Signal(AXES)

    def elaborate(self, platform: object) -> Module:
        """On a platform, add the sources with `platform.add_file`, all of `passo rtl`."""
        none = Const(0, AXES)
        m = Module()
        m.submodules.core = Instance(
            "passo_spi_top",
            p_AXES=AXES,
            p_INPUTS=1,
            p_ENABLE_RESET=Const(0b111, AXES),  # drives with an active-low enable: off at first
            i_clk=ClockSignal(),
            i_rst=ResetSignal(),
            i_spi_sclk=self.spi_sclk,
            i_spi_mosi=self.spi_mosi,
            i_spi_cs_n=self.spi_cs_n,
            o_spi_miso=self.spi_miso,
            i_sync=Const(0),
            i_limit_low=self.limit_low,
            i_limit_high=self.limit_high,
            i_home=none,
            i_alarm=none,
            i_probe=Const(0),
            i_estop_n=self.estop_n,
            i_encoder_a=none,
            i_encoder_b=none,
            i_encoder_index=none,
            o_step=self.step,
            o_dir=self.dir,
            o_enable=self.enable,
            o_irq=self.irq,
        )
        return m


if __name__ == "__main__":
    motion = Motion()
    pins = [pin for pin in vars(motion).values() if isinstance(pin, Signal)]
    print(verilog.convert(motion, name="motion_top", ports=pins))
