# SPDX-License-Identifier: MIT
"""Line and toggle coverage of the RTL by the cocotb tests: `make coverage`.

Runs the tests on Verilator with its line and toggle coverage, merges the results, prints a table and writes
docs/reference/coverage.md. A line is covered if each of its branches was taken in some instance of the
module, a bit if it rose and fell in some instance.

Fails if a test fails, if a line or a bit is not covered and not listed in coverage_exclusions.toml, or if an
entry of that list is wrong.
"""

import os
import subprocess
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from passo.console import console, stages, table
from passo.toolchain import paths
from rich.console import Console

from cocotb_tests.coverage_points import (
    Exclusion,
    Module,
    excluded,
    ranges,
    read,
    read_exclusions,
    wrong_exclusions,
)
from cocotb_tests.helpers.runner import COVERAGE_VARIABLE

PAGE = paths.reference / "coverage.md"
DATA = "coverage.dat"
SELECTION = "verilator and not netlist"
WIDTH = 118  # of the tables without a terminal

HEAD = """# Coverage

Written by `make coverage`: lines and bits of the RTL that the cocotb tests cover on Verilator. A line is
covered if each of its branches was taken in some instance of its module, a bit if it rose and fell in one.
Bits that are constant by construction are listed below with the reason. The list is checked: a listed bit
that does not exist or toggles is an error, and so is any other uncovered bit or line.

"""
HEADER = ("file", "lines", "covered", "bits", "constant", "covered")

Modules = Mapping[str, Module]
Exclusions = Sequence[Exclusion]


def run_tests() -> int:
    """Run the tests with coverage; return the exit status of pytest."""
    jobs = ["-n", str(os.cpu_count()), "--dist", "worksteal"]
    command = [sys.executable, "-m", "pytest", "cocotb_tests", "-k", SELECTION, "-q", *jobs]
    return subprocess.run(command, cwd=paths.root, env={**os.environ, COVERAGE_VARIABLE: "1"}).returncode


def data_files() -> list[Path]:
    """Coverage data files of the tests."""
    return sorted((paths.build / "cocotb").glob(f"*-coverage/*/{DATA}"))


def missed_lines(modules: Modules) -> list[tuple[str, int, str]]:
    """File, number and text of the uncovered lines."""
    found = []
    for name, module in sorted(modules.items()):
        text = (paths.rtl / name).read_text().splitlines()
        found += [(name, line, text[line - 1].strip()) for line in module.missed_lines()]
    return found


def missed_bits(modules: Modules, exclusions: Exclusions) -> dict[str, list[str]]:
    """By file: uncovered bits that are not on the list."""
    found = {}
    for name, module in sorted(modules.items()):
        constant = excluded(exclusions, name)
        if bits := [bit for bit in module.missed_bits() if bit not in constant]:
            found[name] = bits
    return found


def _share(missed: int, total: int) -> str:
    return f"{(total - missed) / total:.1%}" if total else "–"


def _rows(modules: Modules, exclusions: Exclusions) -> list[list[str]]:
    rows = []
    sums = Counter[str]()
    missed = missed_bits(modules, exclusions)
    for name, module in sorted(modules.items()):
        constant = excluded(exclusions, name)
        numbers = {
            "lines": len({line for line, _ in module.lines}),
            "missed_lines": len(module.missed_lines()),
            "bits": len(module.all_bits() - constant),
            "constant": len(constant),
            "missed_bits": len(missed.get(name, [])),
        }
        sums.update(numbers)
        rows.append(_row(f"`{name}`", numbers))
    rows.append(_row("all", sums))
    return rows


def _row(name: str, n: Mapping[str, int]) -> list[str]:
    return [
        name,
        str(n["lines"]),
        _share(n["missed_lines"], n["lines"]),
        f"{n['bits']:,}",
        str(n["constant"]),
        _share(n["missed_bits"], n["bits"]),
    ]


def show(modules: Modules, exclusions: Exclusions) -> None:
    """Print the table and everything that is not covered."""
    screen = console if console.is_terminal else Console(width=WIDTH)
    shown = table("coverage of rtl/", *HEADER)
    for row in _rows(modules, exclusions):
        shown.add_row(row[0].strip("`"), *row[1:])
    screen.print(shown)
    for name, line, text in missed_lines(modules):
        screen.print(f"rtl/{name}:{line}: {text}", markup=False, highlight=False)
    for name, bits in missed_bits(modules, exclusions).items():
        screen.print(f"rtl/{name}: {', '.join(ranges(bits))}", markup=False, highlight=False)


def page(modules: Modules, exclusions: Exclusions) -> str:
    """docs/reference/coverage.md."""
    rule = ["---", *["---:"] * (len(HEADER) - 1)]
    rows = [f"| {' | '.join(row)} |" for row in (HEADER, rule, *_rows(modules, exclusions))]
    lines = [f"* `{name}` {line}: `{text}`" for name, line, text in missed_lines(modules)]
    bits = [f"* `{name}`: {_names(bits)}" for name, bits in missed_bits(modules, exclusions).items()]
    constant = [f"* `{e.file}`: {_names(e.bits)}. {e.reason}" for e in exclusions]
    sections = {
        "Uncovered lines": lines,
        "Bits that never toggle": bits,
        "Constant bits": constant,
    }
    parts = [HEAD.rstrip(), "", *rows, ""]
    for title, items in sections.items():
        parts += [f"## {title}", "", *(items or ["None."]), ""]
    return "\n".join(parts)


def _names(bits: Sequence[str]) -> str:
    return ", ".join(f"`{words}`" for words in ranges(bits))


def main() -> int:
    """Run, add up, print, write."""
    exclusions = read_exclusions()
    for path in data_files():
        path.unlink()
    tell = stages()
    tell("coverage: tests")
    status = run_tests()
    tell("coverage: table")
    modules = read(data_files())
    if not modules:
        print("make coverage: the tests left no data", file=sys.stderr)
        return 1
    show(modules, exclusions)
    wrong = wrong_exclusions(modules, exclusions)
    for sentence in wrong:
        print(f"coverage_exclusions.toml: {sentence}", file=sys.stderr)
    if status == 0 and not wrong:
        PAGE.write_text(page(modules, exclusions), encoding="utf-8")
    holes = missed_lines(modules) or missed_bits(modules, exclusions)
    return status or int(bool(wrong or holes))


if __name__ == "__main__":
    sys.exit(main())
