# SPDX-License-Identifier: MIT
"""The functions that the sources of the path planner share, each for itself.

Squares of velocities are UQ0.64 (substeps per clock)^2, velocities UQ0.48, lengths UQ32.32 substeps.
"""

from functools import cache
from typing import Any

from cffi import FFI
from passo import native
from passo.build import Parameters
from passo.compiler import declarations
from passo.path import Path, PathSettings
from passo.toolchain import paths

from tests.helpers.plans import checked_library

PRIVATE = ("passo_math.h", "passo_path_private.h", "passo_path_jerk.h")
SQUARE_MAX = 1 << 62
NEVER = (1 << 64) - 1
ONE = 1 << 30  # of a unit vector
CAPACITY = 64


@cache
def ffi() -> FFI:
    """All types, also those that only the sources have."""
    made = FFI()
    made.cdef(declarations((*native.HEADERS, *(paths.planner / name for name in PRIVATE))))
    return made


@cache
def parts() -> Any:
    """The functions, built such that undefined behavior is fatal."""
    return ffi().dlopen(str(checked_library()))


@cache
def checked() -> Any:
    """The public functions, built the same."""
    return native.load(checked_library())


def lone_item(**members: Any) -> Any:
    """A pointer to an item of no planner."""
    return ffi().new("struct passo_path_item *", members)


class Planner:
    """A `struct passo_path_planner` with items, all of them zero but what is given."""

    def __init__(self, tick_log2: int = 7, **members: Any) -> None:
        self.items = ffi().new("struct passo_path_item[]", CAPACITY)
        self.c = ffi().new(
            "struct passo_path_planner *", {"items": self.items, "capacity": CAPACITY, **members}
        )
        self.c.machine.tick_log2 = tick_log2

    def item(self, index: int, **members: Any) -> Any:
        """Set one; a pointer to it."""
        self.items[index % CAPACITY] = lone_item(**members)[0]
        return ffi().addressof(self.items, index % CAPACITY)


class CheckedPath(Path):
    """A path whose undefined behavior is fatal. Its items stay readable: `item(i)`."""

    def __init__(self, settings: PathSettings, tick_log2: int = 7, look_ahead: int = CAPACITY) -> None:
        super().__init__(settings, Parameters(tick_log2=tick_log2), look_ahead)
        self._c = checked()

    def item(self, index: int) -> Any:
        """Of a line, with the types of `ffi()`."""
        known = native.ffi()
        place = known.addressof(self._items, index % self.c.capacity)
        return ffi().cast("struct passo_path_item *", int(known.cast("uintptr_t", place)))[0]
