# SPDX-License-Identifier: MIT
"""In the page of `make web` this is passo.native: the C code is the WebAssembly that plays programs as well.

Its memory is another one than Python's: a function gets copies, and what it has made of them is copied back.
"""

import ctypes
import json
from collections.abc import Callable
from functools import cache
from importlib import import_module
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from typing import Any

INTEGERS = {
    **{f"{sign}int{bits}_t": f"c_{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)},
    "char": "c_char",
    "_Bool": "c_bool",
    "size_t": "c_size_t",
    "unsigned int": "c_uint",
}
ROOM = 1 << 16  # bytes for the arguments of a call
ALIGNMENT = 16
UNION = "_union"


class _Memory:
    """That of the WebAssembly."""

    def __init__(self) -> None:
        self.c = import_module("passo_wasm").c
        self._array = import_module("js").Uint8Array
        self._room = self.allocate(ROOM)
        self._used = self._text = 0

    def allocate(self, size: int) -> int:
        place = int(self.c.malloc(size))
        if not place:
            raise MemoryError
        return place

    def keep(self, data: bytes) -> int:
        """Copy a text; the one before is gone."""
        if self._text:
            self.c.free(self._text)
        self._text = self.allocate(len(data) + 1)
        self.write(self._text, data)
        return self._text

    def begin(self) -> None:
        self._used = 0

    def place(self, data: bytes) -> int:
        """Copy an argument of a call."""
        place = self._room + self._used
        self._used += -(-len(data) // ALIGNMENT) * ALIGNMENT
        if self._used > ROOM:
            raise MemoryError
        self.write(place, data)
        return place

    def write(self, place: int, data: bytes) -> None:
        self._bytes(place, len(data)).assign(data)

    def read(self, place: int, data: Any) -> None:
        size = ctypes.sizeof(data)
        ctypes.memmove(ctypes.addressof(data), self._bytes(place, size).to_bytes(), size)

    def text(self, place: int) -> bytes:
        """Up to its 0."""
        rest = self._array.new(self.c.memory.buffer, place)
        return bytes(rest.subarray(0, rest.indexOf(0)).to_bytes())

    def _bytes(self, place: int, size: int) -> Any:
        return self._array.new(self.c.memory.buffer, place, size)


class _Structure(ctypes.Structure):
    def __getitem__(self, index: int) -> Any:
        return self  # cffi's pointer to it

    def __setitem__(self, index: int, value: Any) -> None:
        ctypes.memmove(ctypes.addressof(self), ctypes.addressof(value), ctypes.sizeof(self))


class Library:
    """The types, functions and constants of `layout` (web_python.layout()), as cffi has them."""

    def __init__(self, layout: dict[str, Any], memory: Any):
        self._constants, self._functions = layout["constants"], layout["functions"]
        self._memory = memory
        self._types: dict[str, Any] = {}
        for name, (fields, size) in layout["types"].items():
            self._types[name] = self._structure(name, fields, size)

    def _structure(self, name: str, fields: list[Any], size: int) -> Any:
        """Those of its fields that have one place are a union."""
        members: list[tuple[str, Any]] = []
        for _, group in groupby(fields, itemgetter(2)):
            own = [(field, self._type(of)) for field, of, _ in group]
            if len(own) > 1:
                own = [(UNION, type(UNION, (ctypes.Union,), {"_fields_": own}))]
            members += own
        hidden = tuple(member for member, _ in members if member == UNION)
        made = type(name, (_Structure,), {"_anonymous_": hidden, "_fields_": members})
        places = [(field, getattr(made, field).offset) for field, _, _ in fields]
        if ctypes.sizeof(made) != size or places != [(field, place) for field, _, place in fields]:
            raise TypeError(f"{name} is laid out otherwise")
        return made

    def new(self, name: str, value: dict[str, Any] | None = None) -> Any:
        """A structure."""
        return self._types[name.removesuffix(" *")](**value or {})

    def at(self, name: str, place: int) -> Any:
        """A copy of the structure at a place."""
        made = self._types[name]()
        self._memory.read(place, made)
        return made

    def from_buffer(self, data: bytes) -> int:
        """A place of these bytes, up to the next call."""
        return int(self._memory.keep(data))

    def string(self, text: bytes | int) -> bytes:
        """An array of characters, or what is at a place."""
        return self._memory.text(text) if isinstance(text, int) else text

    def __getattr__(self, name: str) -> Any:
        if name in self._constants:
            value = self._constants[name]
        elif name in self._functions:
            value = self._function(name)
        else:
            raise AttributeError(name)
        setattr(self, name, value)
        return value

    def _type(self, of: Any) -> Any:
        if isinstance(of, list):
            item, count = of
            return self._type(item) * count
        return self._types[of] if of in self._types else getattr(ctypes, INTEGERS[of])

    def _function(self, name: str) -> Callable[..., Any]:
        memory, items = self._memory, [of and self._type(of) for of in self._functions[name]]

        def call(*arguments: Any) -> Any:
            memory.begin()
            values, back = [], []
            for argument, item in zip(arguments, items, strict=True):
                if isinstance(argument, int) or item is None:
                    values.append(argument)
                    continue
                data = argument
                if isinstance(data, bytes):
                    data += b"\0"
                elif isinstance(data, (list, tuple)):
                    data = (item * len(data))(*data)
                place = memory.place(bytes(data))
                values.append(place)
                if not isinstance(data, bytes):
                    back.append((place, data))
            result = getattr(memory.c, name)(*values)
            for place, data in back:
                memory.read(place, data)
            return result

        return call


@cache
def _library() -> Library:
    layout = json.loads(Path(__file__).with_name("native.json").read_text(encoding="utf-8"))
    return Library(layout, _Memory())


def ffi() -> Any:
    """The types of the C code."""
    return _library()


def planner() -> Any:
    """Its functions."""
    return _library()


def unopened(name: str) -> Any:
    """Memory for a structure that its open function is to fill: of no known content."""
    made = _library().new(f"struct {name}")
    ctypes.memset(ctypes.addressof(made), 0xA5, ctypes.sizeof(made))
    return made
