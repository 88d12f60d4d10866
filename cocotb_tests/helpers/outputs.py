# SPDX-License-Identifier: MIT
"""The outputs of a channel under test, beside those of the C model: every clock is compared."""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Self

from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, read
from passo.compiler import library
from passo.toolchain import paths

from cocotb_tests.helpers.bench import begin

INPUTS = (
    *("rst", "bus_frame", "bus_commit", "bus_check", "bus_write", "select", "bus_data"),
    *("lag", "pwm_step", "power_reference", "pitch", "compare_axis", "compare_width", "compare_interval"),
    *("write_pulse", "write_distance", "write_levels", "write_power"),
    *("line_begins", "substep", "word", "stopped", "clear"),
    *("running", "running_next", "velocity", "rate", "waits", "step_made", "step_direction"),
)
OUTPUTS = ("outputs", "power", "compare", "raster_room", "raster_empty", "overflow", "quiet", "refusal")
MODEL = ("core_outputs", "pwm", "power", "changes", "raster", "compare")  # sources, passo_*.c
PERIOD = 1 << 24  # of the PWM, in units of pwm_step
RATE_ONE = 1 << 16
HALF = 1 << 31  # a velocity
PIN = 5  # clocks from a substep to its STEP pin


def word(levels: int = 0, power: int = 0, *, proportional: bool = False, raster: bool = False) -> int:
    """The output word of a line."""
    return power | levels << 16 | proportional << 24 | raster << 25


@dataclass
class Seen:
    """Levels of the pins after each clock; the index is the number of the clock in the test."""

    outputs: list[int] = field(default_factory=list)
    power: list[int] = field(default_factory=list)
    compare: list[int] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.power)


class Outputs:
    """The module under test, its model, and what was seen."""

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        self.dut, self.clocks = dut, clocks
        self._pins = {name: getattr(dut, name) for name in (*INPUTS, *OUTPUTS)}
        self.inputs = dict.fromkeys(INPUTS, 0)
        self._scaled = False  # step or reference are new
        self.seen = Seen()
        self.now: dict[str, int] = dict.fromkeys(OUTPUTS, 0)
        folders = (paths.core, paths.protocol)
        shim = paths.cocotb_tests / "helpers" / "outputs_model.c"
        model = [paths.core / f"passo_{name}.c" for name in MODEL]
        self._model = ctypes.CDLL(str(library("outputs_model", folders, [*model, shim], "-O2")))
        self._model.outputs_model_size.restype = ctypes.c_uint64
        self._state = ctypes.create_string_buffer(self._model.outputs_model_size())
        self._in = (ctypes.c_uint32 * len(INPUTS))()
        self._out = (ctypes.c_uint32 * len(OUTPUTS))()

    @classmethod
    async def begin(cls, dut: HierarchyObject, **inputs: int) -> Self:
        """Reset, with settings that do something."""
        outputs = cls(dut, await begin(dut, *(name for name in INPUTS if name != "rst")))
        outputs.set(pwm_step=PERIOD // 64, power_reference=HALF, pitch=1, compare_interval=1)
        outputs.set(velocity=HALF, rate=RATE_ONE, **inputs)
        await outputs.clock(rst=1)
        return outputs

    def set(self, **inputs: int) -> None:
        """Change inputs for good."""
        for name, value in inputs.items():
            if self.inputs[name] != value:
                self.inputs[name] = value
                self._scaled |= name in {"pwm_step", "power_reference"}
                self._pins[name].value = value

    async def clock(self, **strobes: int) -> None:
        """One rising edge, with these inputs for this clock only."""
        self.set(**strobes)
        self.set(write_power=int(self._scaled))
        self._scaled = False
        self._in[:] = [*self.inputs.values()]
        self._model.outputs_model_clock(self._state, self._in, self._out)
        await self.clocks.fall
        for name, wanted in zip(OUTPUTS, self._out, strict=True):
            self.now[name] = value = read(self._pins[name])
            assert value == wanted, f"{name} after clock {len(self.seen)} of the test"
        self.seen.outputs.append(self.now["outputs"])
        self.seen.power.append(self.now["power"])
        self.seen.compare.append(self.now["compare"])
        self.set(**dict.fromkeys(strobes, 0))

    async def run(self, clocks: int) -> None:
        """Let clocks pass."""
        for _ in range(clocks):
            await self.clock()

    async def line(self, wanted: int) -> None:
        """A line begins with this word; its first substep may come now."""
        await self.clock(line_begins=1)
        await self.clock()
        self.set(word=wanted)

    async def motion(self, wanted: int) -> int:
        """A motion with a line with this word and its first substep; return the clock of the STEP pin."""
        self.set(running=1, running_next=1)
        await self.line(wanted)
        return await self.substep()

    async def substep(self, **strobes: int) -> int:
        """A substep; return the clock of its STEP pin."""
        await self.clock(substep=1, **strobes)
        return len(self.seen) - 2 + PIN

    async def rest(self) -> None:
        """The motion is over."""
        await self.clock(running_next=0)
        self.set(running=0, running_next=0)
        await self.clock()

    async def push(self, values: Sequence[int]) -> None:
        """Push raster values, four to a word."""
        words = [int.from_bytes(bytes(values[i : i + 4]), "little") for i in range(0, len(values), 4)]
        for strobe, commit in (("bus_check", 0), ("bus_write", 1)):
            await self.clock(bus_frame=1, bus_commit=commit)
            for data in words:
                self.set(bus_data=data)
                await self.run(2)
                await self.clock(**{strobe: 1, "select": 1})
                assert self.now["refusal"] == 0
                await self.clock()
