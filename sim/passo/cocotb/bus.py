# SPDX-License-Identifier: MIT
"""A host on the bus of a design, for tests in synchronous code (see passo.cocotb.host).

    @bus_test(AxiLite, base=0x4000_0000)
    def it_moves(host: BusHost) -> None:
        driver = Driver(host)
        ...

The bus masters are those of cocotbext-axi and cocotbext-wishbone.
"""

import functools
from collections.abc import Callable, Sequence
from typing import Any, Protocol, Self

from cocotb.handle import HierarchyObject
from cocotbext.axi import AxiLiteBus, AxiLiteMaster, AxiResp
from cocotbext.wishbone.driver import WBOp, WishboneMaster

from passo.cocotb.clocks import Clocks
from passo.cocotb.host import DesignHost, plain_test, set_idle
from passo.cocotb.thread import Thread
from passo.link import GAP

SELECT, WORD = 0, 4  # addresses of the registers of the core
ALL_LANES = 0xF
PATIENCE = 1024  # clocks of a Wishbone access; then it is an AssertionError
RESET = 8  # clocks


class Bus(Protocol):
    """Accesses of 32 bits at a byte address. Both return None if an access is answered with an error."""

    async def read(self, address: int) -> int | None:
        """Read a register."""

    async def write(self, address: int, value: int, lanes: int = ALL_LANES) -> int | None:
        """Write the bytes of a register that `lanes` has, bit 0: bits 7 to 0."""


class Wishbone:
    """Master of classic cycles at the pins `wb_cyc_i` ... of passo_wishbone, or `wb_cyc` ... of LiteX.

    Another prefix: `functools.partial(Wishbone, prefix="cpu")`.
    """

    def __init__(self, dut: HierarchyObject, prefix: str = "wb") -> None:
        core = hasattr(dut, f"{prefix}_cyc_i")
        signals = {name: f"{name}_i" if core else name for name in ("cyc", "stb", "we", "adr", "sel")}
        signals |= {name: f"{name}_o" if core else name for name in ("ack", "err")}
        signals |= {"datwr": "dat_i", "datrd": "dat_o"} if core else {"datwr": "dat_w", "datrd": "dat_r"}
        signals |= {name: name for name in ("cti", "bte") if hasattr(dut, f"{prefix}_{name}")}
        self._master = WishboneMaster(dut, prefix, dut.clk, signals_dict=signals, timeout=PATIENCE)

    async def read(self, address: int) -> int | None:
        """See Bus."""
        return await self._access(WBOp(address))

    async def write(self, address: int, value: int, lanes: int = ALL_LANES) -> int | None:
        """See Bus."""
        return await self._access(WBOp(address, value, sel=lanes))

    async def _access(self, operation: WBOp) -> int | None:
        (result,) = await self._master.send_cycle([operation])
        if result.ack != 1:
            return None
        return result.datrd.to_unsigned() if operation.dat is None else operation.dat


class AxiLite:
    """Master at the pins `s_axil_awvalid` ...; address and data of a write come in any order.

    Another prefix: `functools.partial(AxiLite, prefix="cpu")`.
    """

    def __init__(self, dut: HierarchyObject, prefix: str = "s_axil") -> None:
        self._master = AxiLiteMaster(AxiLiteBus.from_prefix(dut, prefix), dut.clk, dut.rst)

    async def read(self, address: int) -> int | None:
        """See Bus."""
        answer = await self._master.read(address, 4)
        return int.from_bytes(answer.data, "little") if answer.resp == AxiResp.OKAY else None

    async def write(self, address: int, value: int, lanes: int = ALL_LANES) -> int | None:
        """See Bus; only lanes that follow each other, since the master has no other way to say which."""
        first = (lanes & -lanes).bit_length() - 1
        data = value.to_bytes(4, "little")[first : first + lanes.bit_count()]
        answer = await self._master.write(address + first, data)
        return value if answer.resp == AxiResp.OKAY else None


class BusHost(DesignHost):
    """A CPU on the bus of a design: `base` is the byte address of the core there."""

    def __init__(self, dut: HierarchyObject, thread: Thread, clocks: Clocks, bus: Bus, base: int = 0) -> None:
        super().__init__(dut, thread, clocks)
        self.bus, self.base = bus, base

    @classmethod
    async def begin(
        cls, dut: HierarchyObject, thread: Thread, bus: Callable[[HierarchyObject], Bus], base: int = 0
    ) -> Self:
        """Reset; return on the falling edge after its end. `bus` makes the master: Wishbone, AxiLite."""
        dut.rst.value = 1
        set_idle(dut)
        clocks = Clocks(dut.clk)
        clocks.start()
        await clocks.wait(1)  # Icarus Verilog loses what a master sets at time 0
        host = cls(dut, thread, clocks, bus(dut), base)
        await clocks.wait(RESET)
        dut.rst.value = 0
        await clocks.wait(1)
        return host

    def read(self, register: int) -> int | None:
        """Read a register of the core, SELECT or WORD; None: error."""
        return self._access(self.bus.read(self.base + register))

    def write(self, register: int, value: int, lanes: int = ALL_LANES) -> int | None:
        """Write bytes of a register of the core; return the value, or None: error."""
        return self._access(self.bus.write(self.base + register, value, lanes))

    def transfer(self, mosi: Sequence[int], gap: int = GAP) -> list[int]:
        """One frame, as stm32_bridge/examples/soft_cpu.c exchanges it; then `gap` clocks."""
        miso: list[int] = []
        self._accepted(self.write(SELECT, 1))
        for word in mosi:
            miso.append(self._accepted(self.read(WORD)))
            self._accepted(self.write(WORD, word))
        self._accepted(self.write(SELECT, 0))
        self.run(gap)
        return miso

    def _access(self, access: Any) -> int | None:
        async def to_falling_edge() -> int | None:
            answer = await access
            await self.clocks.fall
            return answer

        return self._thread.wait(to_falling_edge())

    def _accepted(self, answer: int | None) -> int:
        assert answer is not None, f"clock {self.clock}: the bus answered with an error"
        return answer


def bus_test(
    bus: Callable[[HierarchyObject], Bus], base: int = 0
) -> Callable[[Callable[[BusHost], None]], Any]:
    """Make cocotb tests from plain code on a BusHost; arguments as those of `BusHost.begin`."""

    def decorate(body: Callable[[BusHost], None]) -> Any:
        def whole(host: BusHost) -> None:
            body(host)
            host.end()

        return plain_test(functools.partial(BusHost.begin, bus=bus, base=base), body, whole)

    return decorate
