# SPDX-License-Identifier: MIT
"""Invert every wire between the modules of a core, one after the other: a random history must see it.

    .venv/bin/python -m verify.equal.wiring [--seed N] [connection ...]

The proofs say of each module that it does what its function in the model does. That it is given the same
is seen here: in a copy of the RTL each connection to an input of a module can be inverted. Histories of make
soak are played on it, Verilated, with the pins of the model on every clock. With no wire inverted none fails;
with any one inverted, one must. build/wiring.json says which one, and in which clock.
"""

import argparse
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Collection, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, replace
from pathlib import Path

from passo.build import rtl_library
from passo.console import Estimate, console, table
from passo.failure import Failure
from passo.output import write_json
from passo.toolchain import environment, paths

from verify.equal.rtl import PORT
from verify.soak.parts import MACHINE, SETS, TRACKER_SETS
from verify.soak.program import build

BUILD = paths.build / "wiring"
# What these consist of is instances of other modules, and little else.
MODULES = (
    *("passo_spi_top", "passo_core", "passo_channels", "passo_channel", "passo_channel_path"),
    *("passo_channel_control", "passo_channel_lines", "passo_channel_drives"),
    *("passo_profile", "passo_lines", "passo_axes"),
    *("passo_encoders", "passo_trackers"),
)
JOBS = 2
SET = 2  # of two channels, without inputs, encoders and outputs
TRACKERS = 3  # set of trackers.py: five axes, of which three have a tracker alone, inputs and outputs
# Kind of history ("": of that set), and how many are played.
HISTORIES = (("", 20), ("machine", 20), ("trackers", 20), ("pokes", 300))
FEW = (("machine", 10), ("trackers", 10))  # for some connections
LONGEST = 1800  # seconds, of all histories of a kind
PATIENCE = 4  # times what they take without an inversion,
LEAST = 120  # seconds, or so long: a computer that is busy for a moment shows no inversion
# Which wire is inverted, as C++ in the Verilog of Verilator.
NUMBER = r'$c("(getenv(\"PASSO_CUT\") ? atoi(getenv(\"PASSO_CUT\")) : 0)")'


@dataclass(frozen=True)
class Wire:
    """A connection to an input of an instance; its number is that which inverts it."""

    number: int
    name: str


@dataclass(frozen=True)
class Player:
    """Plays histories on the RTL with switches."""

    kind: str
    command: tuple[str | Path, ...]
    seconds: float = LONGEST  # at most

    def first_seen(self, wire: int) -> str:
        """The history and the clock in which a cut wire is seen; empty: none."""
        variables = {**environment(), "PASSO_CUT": str(wire)}
        try:
            done = subprocess.run(
                self.command, env=variables, capture_output=True, text=True, timeout=self.seconds
            )
        except subprocess.TimeoutExpired:
            return f"{self.kind}: no end within {self.seconds:.0f} s"
        failed = re.search(r"^failed (\d+) (\d+) ", done.stdout, re.M)
        if (done.returncode == 0) != (failed is None):
            return f"{self.kind}: exit status {done.returncode}"
        return f"{self.kind} {failed[1]}, clock {failed[2]}" if failed else ""


def _close(text: str, begin: int) -> int:
    """The place behind the parenthesis that closes the one at begin."""
    depth = 0
    for place in range(begin, len(text)):
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        if depth == 0:
            return place + 1
    raise Failure("a parenthesis is not closed")


INSTANCE = re.compile(r"^ +(passo_\w+)\s*(?=#|\w)", re.M)
NAME = re.compile(r"\s*(\w+)\s*(?=\()")
CONNECTION = re.compile(r"\s*,?\s*\.(\w+)\s*(?=\()")


def _connections(text: str) -> Iterator[tuple[str, str, str, int, int]]:
    """Module, instance, port and place of the expression of each connection."""
    for instance in INSTANCE.finditer(text):
        place = instance.end()
        if text[place] == "#":
            place = _close(text, text.index("(", place))
        name = NAME.match(text, place)
        if name is None:
            raise Failure(f"{instance[1]} has an instance without a name")
        place = name.end() + 1
        while (connection := CONNECTION.match(text, place)) is not None:
            place = _close(text, connection.end())
            yield instance[1], name[1], connection[1], connection.end() + 1, place - 1


def _inputs(module: str) -> set[str]:
    text = (paths.rtl / f"{module}.v").read_text(encoding="utf-8")
    return {port for direction, port in PORT.findall(text) if direction == "input"} - {"clk"}


def cut_wires(folder: Path) -> list[Wire]:
    """Copy the RTL to a folder, with a switch in each connection; return the connections."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(paths.rtl, folder)
    wires: list[Wire] = []
    for module in MODULES:
        file = folder / f"{module}.v"
        text = re.sub(r"//.*", "", file.read_text(encoding="utf-8"))
        made, copied = [], 0
        for inner, instance, port, begin, end in _connections(text):
            if port not in _inputs(inner):
                continue
            wires.append(Wire(len(wires) + 1, f"{module}.{instance}.{port}"))
            made += [text[copied:begin], f"cut == {len(wires)} ? ~({text[begin:end]}) : ({text[begin:end]})"]
            copied = end
        text = "".join([*made, text[copied:]])
        switch = f"\n);\n  integer cut;\n  initial cut = {NUMBER};\n"
        quiet = "".join(f"// verilator lint_off {rule}\n" for rule in ("WIDTHEXPAND", "WIDTHTRUNC"))
        file.write_text(quiet + text.replace("\n);\n", switch, 1), encoding="utf-8")
    return wires


def check(seed: int, names: Collection[str] = ()) -> dict[str, str]:
    """Cut all wires, or some; returns where each is first seen.

    Raises:
        Failure: The uncut RTL differs from the model, or there is no such wire.
    """
    BUILD.mkdir(parents=True, exist_ok=True)
    wires = cut_wires(BUILD / "cut")
    for name in names:
        if not any(_is_of(wire, name) for wire in wires):
            raise Failure(f"there is no connection {name}")
    players = [
        _player(seed, kind, count)
        for kind, count in (HISTORIES if not names or set(names) <= set(MODULES) else FEW)
    ]
    chosen = [wire for wire in wires if not names or any(_is_of(wire, name) for name in names)]
    seen: dict[str, str] = {}
    with ThreadPoolExecutor(JOBS) as pool:
        players = list(pool.map(_uncut, players))
        running = {pool.submit(_first_seen, wire.number, players): wire for wire in chosen}
        estimate = Estimate(len(chosen))
        for count, done in enumerate(as_completed(running), 1):
            name = running[done].name
            seen[name] = done.result()
            if not seen[name]:
                console.print(f"not detected: {name}", style="red", highlight=False)
            if count % 20 == 0 or count == len(chosen):
                none = sum(not at for at in seen.values())
                console.print(
                    f"connections inverted: {estimate.counted(count)}; {none} not detected", highlight=False
                )
    return {wire.name: seen[wire.name] for wire in chosen}


def _is_of(wire: Wire, name: str) -> bool:
    """Whether a name is that of a wire, or of the module that it is in."""
    return wire.name == name or wire.name.startswith(f"{name}.")


def _player(seed: int, kind: str, count: int) -> Player:
    if kind == "trackers":
        rtl_library(TRACKER_SETS[TRACKERS], rtl=BUILD / "cut")
        own = ("--rtl", BUILD / "cut", "--set", str(TRACKERS), "--fast")
        return Player(kind, (sys.executable, "-m", "verify.soak.trackers", str(seed), "0", str(count), *own))
    library = rtl_library(MACHINE if kind else SETS[SET], rtl=BUILD / "cut")
    more = [f"--{kind}"] if kind else ["--set", str(SET)]
    return Player(kind or "plain", (build(), str(seed), "0", str(count), *more, "--rtl", library))


def _uncut(player: Player) -> Player:
    """The player, with the patience that it needs. Raises Failure if the RTL differs from the model."""
    began = time.monotonic()
    if at := player.first_seen(0):
        raise Failure(f"RTL and model differ without an inversion: {at}")
    return replace(player, seconds=max(LEAST, PATIENCE * (time.monotonic() - began)))


def _first_seen(wire: int, players: list[Player]) -> str:
    return next((at for player in players if (at := player.first_seen(wire))), "")


def main() -> None:
    """Cut all wires, print what was seen, and exit with 1 if a cut is not."""
    parser = argparse.ArgumentParser(prog="python -m verify.equal.wiring", description=__doc__.split("\n")[0])
    parser.add_argument("--seed", type=int, default=1, help="seed of the scenarios (default: %(default)s)")
    parser.add_argument("connection", nargs="*", help="module or module.instance.port (default: all)")
    arguments = parser.parse_args()
    began = time.monotonic()
    seen = check(arguments.seed, arguments.connection)
    made = table("Connections", "module", "cut", "seen")
    for module in MODULES:
        mine = [at for name, at in seen.items() if name.startswith(f"{module}.")]
        made.add_row(module, str(len(mine)), str(sum(bool(at) for at in mine)))
    console.print(made)
    found = sum(bool(at) for at in seen.values())
    console.print(
        f"{found} of {len(seen)} inverted connections are detected; {time.monotonic() - began:.0f} s.",
        highlight=False,
    )
    write_json(seen, paths.build / "wiring.json")
    sys.exit(found != len(seen))


if __name__ == "__main__":
    main()
