# SPDX-License-Identifier: MIT
"""The C model of one module of the encoders beside the RTL, compared on every clock."""

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from cffi import FFI
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, read
from passo.compiler import declarations, library
from passo.toolchain import paths

from cocotb_tests.helpers.bench import begin

HEADER = paths.core / "passo_core_encoder.h"
SOURCES = [paths.core / f"passo_{name}.c" for name in ("core_encoder", "following", "follower")]


@cache
def load() -> tuple[FFI, Any]:
    """The C functions and structs of c_model/core/passo_core_encoder.h."""
    ffi = FFI()
    ffi.cdef(declarations([HEADER]).replace("_Bool", "bool"))
    return ffi, ffi.dlopen(str(library("encoder", [paths.core], SOURCES, "-O2")))


def _inputs(name: str) -> list[str]:
    """The fields of `struct passo_NAME_wires`."""
    ffi, _ = load()
    return [field for field, _ in ffi.typeof(f"struct passo_{name}_wires").fields]


class Pair:
    """A module under test and its model, with the same inputs.

    The inputs are the fields of `struct passo_NAME_wires`; `outputs` says how an output of the module is
    computed from the model.
    """

    def __init__(
        self,
        dut: HierarchyObject,
        clocks: Clocks,
        name: str,
        outputs: Mapping[str, Callable[[Any, Any], int]],
    ) -> None:
        self.dut, self.clocks, self.outputs = dut, clocks, outputs
        ffi, self.c = load()
        self.model = ffi.new(f"struct passo_{name} *")
        self.before = ffi.new(f"struct passo_{name} *")
        self.wires = ffi.new(f"struct passo_{name}_wires *")
        self._clock = getattr(self.c, f"passo_{name}_clock")
        self._inputs = dict.fromkeys(_inputs(name), 0)
        self._pins = {name: getattr(dut, name) for name in (*self._inputs, *outputs)}
        self.compared = 0

    @classmethod
    async def begin(
        cls, dut: HierarchyObject, name: str, outputs: Mapping[str, Callable[[Any, Any], int]]
    ) -> "Pair":
        """Reset, all inputs 0."""
        return cls(dut, await begin(dut, *_inputs(name)), name, outputs)

    def set(self, **inputs: int) -> None:
        """Change inputs of both."""
        for name, value in inputs.items():
            if self._inputs[name] != value:
                self._inputs[name] = value
                self._pins[name].value = value
                setattr(self.wires, name, value)

    async def clock(self, **inputs: int) -> dict[str, int]:
        """One clock with these changes of the inputs; return the outputs, which are those of the model."""
        self.set(**inputs)
        self.before[0] = self.model[0]
        self._clock(self.model, self.wires)
        await self.clocks.fall
        return self.compare()

    def compare(self) -> dict[str, int]:
        """The outputs, after a comparison."""
        expected = {name: int(of(self.model, self.wires)) for name, of in self.outputs.items()}
        actual = {name: read(self._pins[name]) for name in self.outputs}
        assert actual == expected, f"clock {self.clocks.now}"
        self.compared += 1
        return actual
