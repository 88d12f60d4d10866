# SPDX-License-Identifier: MIT
"""What is synthesized: a top module with parameters on a device."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from passo.pins import INPUTS, OUTPUTS, Pin
from passo.toolchain import paths

from passo_fpga.devices import Device

SPI = "passo_spi_top"
TOPS = (SPI, "passo_wishbone", "passo_axi_lite", "passo_board")  # with the ports of the core


@dataclass(frozen=True)
class Design:
    """A top module with parameters on a device, without the ports in `left_out`; inputs among them are idle.

    Unless `all_ports` are wanted, those of parts that the core does not have are left out as well.
    """

    name: str
    device: Device
    top: str = SPI
    parameters: Mapping[str, int | str] = field(default_factory=dict)
    flatten: bool = True
    left_out: tuple[str, ...] = ()
    all_ports: bool = False
    extra_sources: tuple[Path, ...] = ()

    @property
    def sources(self) -> list[Path]:
        """All Verilog files, including all modules of the core."""
        return [*sorted(paths.rtl.glob("*.v")), *self.extra_sources]

    @property
    def elaboration(self) -> list[str]:
        """Yosys commands that elaborate the design."""
        parameters = " ".join(f"-chparam {name} {value}" for name, value in self.parameters.items())
        others = [port for port in self.left_out if port not in {pin.name for pin in (*INPUTS, *OUTPUTS)}]
        left_out = [f"delete -output {self.top}/{port}" for port in others]
        return [f"hierarchy -top {self.top} {parameters}", *left_out, *self._without_ports()]

    def _without_ports(self) -> list[str]:
        """Yosys commands that leave out ports of the core."""
        if self.top not in TOPS or self.all_ports:
            return []
        channels, axes = self._parameter("CHANNELS", 1), self._parameter("AXES", 4)
        bits = {"1": 1, "CHANNELS": channels, "CHANNELS*AXES": channels * axes}
        inputs = [pin for pin in INPUTS if self._lacks(pin)]
        levels = {pin.name: f"{bits[pin.width]}'b{str(pin.idle) * bits[pin.width]}" for pin in inputs}
        idle = [f"connect -nounset -set {name} {level}" for name, level in levels.items()]
        return [
            *(f"delete -input {self.top}/{pin.name}" for pin in inputs),
            *(f"delete -output {self.top}/{pin.name}" for pin in OUTPUTS if self._lacks(pin)),
            *([f"cd {self.top}", "proc", *idle, "cd .."] if idle else []),
        ]

    def _lacks(self, pin: Pin) -> bool:
        absent = bool(pin.parameter) and not self._parameter(pin.parameter.upper(), 0)
        return absent or pin.name in self.left_out

    def _parameter(self, name: str, default: int) -> int:
        return int(self.parameters.get(name, default))


def core(
    device: Device,
    top: str = SPI,
    size: tuple[int, int] = (1, 4),
    parts: tuple[str, ...] = (),
    without: tuple[str, ...] = (),
) -> Design:
    """The core alone behind one of its host interfaces, with its ports as pins, but for those it is without.

    `size`: channels, axes.
    """
    channels, axes = size
    parameters = {"CHANNELS": channels, "AXES": axes, **device.core, **{part.upper(): 1 for part in parts}}
    name = "-".join([device.name, f"{channels}x{axes}", *parts])
    name = name if top == SPI else f"{name}-{top.removeprefix('passo_')}"
    return Design(name, device, top, parameters, left_out=without)
