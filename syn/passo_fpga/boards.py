# SPDX-License-Identifier: MIT
"""The boards: each is a folder in syn/ with a table board.toml; see docs/fpga.md.

A board with FPGAs of several sizes has one name more for each: `ulx3s-25`.
"""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from passo.toolchain import paths
from passo.values import meant

from passo_fpga import parts as core_parts
from passo_fpga.devices import DEVICES, Device
from passo_fpga.families.family import Family, Pin
from passo_fpga.pll import Pll, PllError, dividers
from passo_fpga.table import BoardError, Table, TableError

FOLDER = paths.syn
PLACEABLE = tuple(name for name, device in DEVICES.items() if device.family.place)
TABLE = "board.toml"
SIZES = "sizes"  # key of the FPGAs that it is sold with, besides that of `device`

OSCILLATOR = "oscillator"
NEEDED = ("spi_sclk", "spi_mosi", "spi_cs_n", "spi_miso", "sync")
OPTIONAL = ("running", "irq", "led")  # outputs that a board may omit or invert
OF_AXIS = ("step", "dir", "enable")


@dataclass(frozen=True)
class Board:
    """Contents of a board.toml; `reset` has the pin levels per axis that differ from passo_board.v."""

    name: str
    title: str
    device: Device
    load: str  # command that loads a bitstream
    pack: tuple[str, ...]  # options of the packer
    oscillator_mhz: float
    clock_mhz: float
    parts_mhz: float  # the clock of a core with parts
    pll_kind: str
    pins: Mapping[str, Pin]  # except those of the axes
    axis_pins: tuple[Mapping[str, Pin], ...]
    reset: Mapping[str, tuple[int, ...]]
    parts: Mapping[str, core_parts.PartPins[Pin]]  # pins of each optional part of the core
    shared: bool  # the pin of a home switch may be that of a limit of its axis

    @property
    def folder(self) -> str:
        """Name of its folder, which boards of several sizes share."""
        return path_of(self.name).parent.name

    @property
    def axes(self) -> int:
        """Number of axes that it has pins for."""
        return len(self.axis_pins)

    def left_out(self, parts: Sequence[str] = ()) -> tuple[str, ...]:
        """Ports without a pin, of the core with these parts."""
        of_parts = (port for part in parts for port in core_parts.PORTS[part] if port not in self.parts[part])
        return (*(port for port in OPTIONAL if port not in self.pins), *of_parts)

    def ports(self, axes: int | None = None, parts: Sequence[str] = ()) -> dict[str, Pin]:
        """The pin of each port bit of a core with these parts. A port of one bit has no index.

        Raises BoardError for parts without pins, TableError for a pin that is used twice.
        """
        users: dict[str, str] = {}
        found = {}
        for key, port, pin in self._places(self._axes(axes), parts):
            if pin.pin in users:
                raise TableError(self.name, key, f"pin {pin.pin} is already used by {users[pin.pin]}")
            users[pin.pin] = key
            found[port] = pin
        return found

    def _places(self, axes: int, parts: Sequence[str]) -> Iterator[tuple[str, str, Pin]]:
        """Key of the table, port bit and pin."""
        for port, pin in self.pins.items():
            yield "clock.pin" if port == OSCILLATOR else f"pins.{port}", port, pin
        for axis, pins in enumerate(self.axis_pins[:axes]):
            for port, pin in pins.items():
                yield f"axes[{axis}].{port}", f"{port}[{axis}]" if axes > 1 else port, pin
        core_parts.check(self.name, self.parts, parts, axes)
        for part in parts:
            for port, of_bits in self.parts.get(part, {}).items():
                count = min(core_parts.bits(part, port, axes), len(of_bits))
                for bit, pin in enumerate(of_bits[:count]):
                    name = f"{port}[{bit}]"
                    yield f"{part}.{name}", name if count > 1 else port, pin

    def limits_at_home(self, low: int, high: int) -> dict[str, int]:
        """Parameters of the top for limits of these axes, bit by bit, if they share pins with homes."""
        return {"LOW_AT_HOME": low, "HIGH_AT_HOME": high} if self.shared else {}

    def pll(self, mhz: float | None = None, parts: Sequence[str] = ()) -> Pll:
        """PLL settings for the board's clock with these parts, or for `mhz`."""
        if mhz is not None:
            return dividers(self.device.family, self.oscillator_mhz, mhz)
        key, own = ("parts_mhz", self.parts_mhz) if parts else ("mhz", self.clock_mhz)
        try:
            return dividers(self.device.family, self.oscillator_mhz, own)
        except PllError as error:
            raise TableError(self.name, f"clock.{key}", str(error)) from None

    def parameters(
        self, axes: int | None = None, mhz: float | None = None, parts: Sequence[str] = ()
    ) -> dict[str, int]:
        """Parameters of the top module."""
        chosen = self._axes(axes)
        core_parts.check(self.name, self.parts, parts, chosen)
        inverted = [port for port in OPTIONAL if port in self.pins and self.pins[port].inverted]
        return {
            "AXES": chosen,
            "CLOCK_HZ": round(self.pll(mhz, parts).mhz * 1e6),
            **self.device.core,
            **{part.upper(): 1 for part in parts},
            **({"OUTPUT_PINS": len(self.parts["outputs"]["outputs"])} if "outputs" in parts else {}),
            **{f"{port.upper()}_INVERTED": 1 for port in inverted},
            **{
                f"{port.upper()}_RESET": sum(level << axis for axis, level in enumerate(levels[:chosen]))
                for port, levels in self.reset.items()
            },
        }

    def _axes(self, axes: int | None) -> int:
        chosen = self.axes if axes is None else axes
        if not 1 <= chosen <= self.axes:
            reason = f"{chosen} requested, but the table has pins for {self.axes}"
            raise TableError(self.name, "axes", reason)
        return chosen


def names() -> list[str]:
    """Names of all boards, each followed by those of its sizes."""
    return [
        name
        for path in sorted(FOLDER.glob(f"*/{TABLE}"))
        for name in (path.parent.name, *(f"{path.parent.name}-{size}" for size in _sizes(path)))
    ]


def path_of(name: str) -> Path:
    """The table of a board."""
    path = FOLDER / name / TABLE
    return path if path.exists() else FOLDER / name.rpartition("-")[0] / TABLE


def _sizes(path: Path) -> list[str]:
    """The sizes that a table lists; none if it is wrong, which board() reports."""
    try:
        found = tomllib.loads(path.read_text(encoding="utf-8")).get(SIZES)
    except ValueError:
        return []
    return list(found) if isinstance(found, dict) else []


def boards() -> dict[str, Board]:
    """All boards by name; raises TableError."""
    return {name: board(name) for name in names()}


def board(name: str) -> Board:
    """A board by name; raises TableError, or BoardError if there is no such board."""
    if name not in names():
        hint = meant(name, tuple(names())) or f"; must be one of {', '.join(names())}"
        raise BoardError(f"unknown board '{name}'{hint}")
    path = path_of(name)
    table = Table.read(name, path)
    title = table.text("title")
    device = _device(table, title)
    sizes = table.table(SIZES, {})
    others = {f"{path.parent.name}-{size}": _size(sizes.table(size), device) for size in _sizes(path)}
    sizes.end()
    device = others.get(name, device)
    title = device.title if name in others else title
    family = device.family
    load, pack = table.text("load"), table.texts("pack", ())

    clock = table.table("clock")
    pll_kind = clock.choice("pll", family.plls) if family.plls else ""
    oscillator_mhz, clock_mhz = clock.number("oscillator_mhz"), clock.number("mhz")
    parts_mhz = clock.number("parts_mhz") if clock.has("parts_mhz") else clock_mhz
    oscillator = _pin(clock, "pin", family)
    clock.end()

    there = table.table("pins")
    pins = {OSCILLATOR: oscillator}
    pins |= {port: _pin(there, port, family) for port in NEEDED}
    pins |= {port: _pin(there, port, family, invertible=True) for port in OPTIONAL if there.has(port)}
    there.end()

    axis_pins = []
    for axis in table.tables("axes"):
        axis_pins.append({port: _pin(axis, port, family) for port in OF_AXIS})
        axis.end()

    reset = {}
    levels = table.table("reset", {})
    for port in OF_AXIS:
        if levels.has(port):
            reset[port] = levels.levels(port, len(axis_pins))
    levels.end()
    tables = {part: table.table(part) for part in core_parts.WITH_PINS if table.has(part)}
    shared = "inputs" in tables and tables["inputs"].flag(core_parts.SHARED)
    parts = {
        part: core_parts.read(of_part, part, len(axis_pins), lambda at, key: _pin(at, key, family))
        for part, of_part in tables.items()
    }
    table.end()

    of_axes = tuple(axis_pins)
    clocks = oscillator_mhz, clock_mhz, parts_mhz
    made = Board(name, title, device, load, pack, *clocks, pll_kind, pins, of_axes, reset, parts, shared)
    made.ports()  # refuses a pin that is used twice
    return made


def _device(table: Table, title: str) -> Device:
    """A device of devices.py, or a variant of one that the table describes."""
    if not table.is_table("device"):
        return DEVICES[table.choice("device", PLACEABLE)]
    facts = table.table("device")
    like = DEVICES[facts.choice("like", PLACEABLE)]
    if not like.family.variants:
        raise facts.error("like", f"the flow supports one {like.family.name.capitalize()} device only")
    capacity = facts.number("capacity")
    part, synthesis = facts.texts("part"), facts.text("synthesis", like.synthesis)
    facts.end()
    return Device(
        table.board, title, like.family, synthesis, part, int(capacity), like.target_mhz, core=like.core
    )


def _size(facts: Table, like: Device) -> Device:
    """The FPGA of another size of a board: its title, its part and its capacity."""
    title, part, capacity = facts.text("title"), facts.texts("part"), facts.number("capacity")
    facts.end()
    return replace(like, name=facts.board, title=title, part=part, capacity=int(capacity))


def _pin(table: Table, key: str, family: Family, invertible: bool = False) -> Pin:
    """Read a pin: its name or number, or a table with further properties."""
    if not table.is_table(key):
        return Pin(table.pin(key), io_type=family.io_type)
    facts = table.table(key)
    found = Pin(
        facts.pin("pin"),
        facts.choice("pull", family.pulls, ""),
        facts.flag("inverted") if invertible else False,
        facts.text("io_type", family.io_type) if family.io_type else "",
        facts.texts("options", ()) if family.io_type else (),
    )
    facts.end()
    return found
