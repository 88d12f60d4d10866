# SPDX-License-Identifier: MIT
"""Which lines and bits of the RTL the cocotb tests reach: `make coverage`.

Runs the tests on Verilator with its line and toggle coverage, adds up what all of them reached, prints a
table and writes docs/coverage.md. A line is reached if each of its branches was taken in some instance of the
module, a bit if it rose and fell somewhere. That says what was exercised; what was right, the tests say.
"""

import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from passo.console import console, table
from passo.toolchain import paths
from rich.console import Console

from cocotb_tests.runner import COVERAGE_VARIABLE

PAGE = paths.docs / "coverage.md"
DATA = "coverage.dat"
SELECTION = "verilator and not netlist"
WIDTH = 118  # of the tables where there is no terminal

HEAD = """# Coverage

`make coverage` writes this page: lines and bits of the RTL that the cocotb tests reach on Verilator. A line
is reached if each of its branches was taken in some instance of its module, a bit if it rose and fell in one.

"""


@dataclass
class Module:
    """Counts of points: lines by (line, branch), bits by (signal with bit, direction)."""

    lines: Counter[tuple[int, str]] = field(default_factory=Counter)
    bits: Counter[tuple[str, str]] = field(default_factory=Counter)

    def missed_lines(self) -> list[int]:
        """Lines with a branch that was never taken."""
        return sorted({line for (line, _), count in self.lines.items() if not count})

    def missed_bits(self) -> list[str]:
        """Bits that never rose or never fell."""
        return sorted({bit for (bit, _), count in self.bits.items() if not count}, key=_natural)


def _natural(name: str) -> list[tuple[int, str]]:
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", name) if part]


def read(files: Iterable[Path]) -> dict[str, Module]:
    """Add up what Verilator wrote; files of rtl/ by name."""
    modules: dict[str, Module] = {}
    for path in files:
        for line in path.read_text().splitlines():
            found = re.fullmatch(r"C '(.*)' (\d+)", line)
            if not found:
                continue
            entries = (part.split("\2", 1) for part in found[1].split("\1") if part)
            facts = {key: value for key, value in entries}
            source = Path(facts["f"])
            if source.resolve().parent != paths.rtl:
                continue
            module = modules.setdefault(source.name, Module())
            count = int(found[2])
            if facts["page"].startswith("v_toggle"):
                bit, _, direction = facts["o"].partition(":")
                module.bits[bit, direction] += count
            else:
                branch = f"{facts['l']}.{facts['n']} {facts.get('o', '')}"
                for number in _lines(facts.get("S") or facts["l"]):
                    module.lines[number, branch] += count
    return modules


def _lines(spans: str) -> Iterable[int]:
    """The numbers in a list such as 12,14-16."""
    for span in spans.split(","):
        first, _, last = span.partition("-")
        yield from range(int(first), int(last or first) + 1)


def run_tests() -> int:
    """Run the tests with coverage; return pytest's status."""
    command = [sys.executable, "-m", "pytest", "cocotb_tests", "-k", SELECTION, "-q"]
    return subprocess.run(command, cwd=paths.root, env={**os.environ, COVERAGE_VARIABLE: "1"}).returncode


def data_files() -> list[Path]:
    """What the tests left."""
    return sorted((paths.build / "cocotb").glob(f"*-coverage/*/{DATA}"))


def _share(missed: int, total: int) -> str:
    return f"{(total - missed) / total:.1%}" if total else "–"


def _rows(modules: dict[str, Module]) -> list[list[str]]:
    rows = []
    sums = Counter[str]()
    for name, module in sorted(modules.items()):
        lines = {line for line, _ in module.lines}
        bits = {bit for bit, _ in module.bits}
        numbers = {
            "lines": len(lines),
            "missed_lines": len(module.missed_lines()),
            "bits": len(bits),
            "missed_bits": len(module.missed_bits()),
        }
        sums.update(numbers)
        rows.append(_row(f"`{name}`", numbers))
    rows.append(_row("all", sums))
    return rows


def _row(name: str, n: dict[str, int]) -> list[str]:
    return [
        name,
        str(n["lines"]),
        _share(n["missed_lines"], n["lines"]),
        f"{n['bits']:,}",
        _share(n["missed_bits"], n["bits"]),
    ]


HEADER = ("file", "lines", "reached", "bits", "reached")


def show(modules: dict[str, Module]) -> None:
    """Print the table and the lines that no test reached."""
    screen = console if console.is_terminal else Console(width=WIDTH)
    shown = table("coverage of rtl/", *HEADER)
    for row in _rows(modules):
        shown.add_row(row[0].strip("`"), *row[1:])
    screen.print(shown)
    for name, line, text in _missed(modules):
        screen.print(f"rtl/{name}:{line}: {text}", markup=False, highlight=False)


def _missed(modules: dict[str, Module]) -> list[tuple[str, int, str]]:
    found = []
    for name, module in sorted(modules.items()):
        text = (paths.rtl / name).read_text().splitlines()
        found += [(name, line, text[line - 1].strip()) for line in module.missed_lines()]
    return found


def _ranges(bits: list[str]) -> str:
    """Bits of the same signal together: `word[31]`, `word[30]` become `word[31:30]`."""
    signals: dict[str, list[int]] = {}
    for bit in bits:
        name, index = re.fullmatch(r"(.*?)(?:\[(\d+)\])?", bit).groups()
        signals.setdefault(name, []).extend([] if index is None else [int(index)])
    words = []
    for name, numbers in signals.items():
        spans: list[list[int]] = []
        for number in sorted(set(numbers)):
            if spans and spans[-1][1] == number - 1:
                spans[-1][1] = number
            else:
                spans.append([number, number])
        parts = [f"{high}:{low}" if high != low else str(low) for low, high in reversed(spans)]
        words.append(f"`{name}[{','.join(parts)}]`" if parts else f"`{name}`")
    return ", ".join(words)


def page(modules: dict[str, Module]) -> str:
    """docs/coverage.md."""
    rule = ["---", *["---:"] * (len(HEADER) - 1)]
    lines = [f"| {' | '.join(row)} |" for row in (HEADER, rule, *_rows(modules))]
    missed = [f"* `{name}` {line}: `{text}`" for name, line, text in _missed(modules)] or ["None."]
    bits = [
        f"* `{name}`: {_ranges(module.missed_bits())}"
        for name, module in sorted(modules.items())
        if module.missed_bits()
    ] or ["None."]
    parts = [
        HEAD.rstrip(),
        "",
        *lines,
        "",
        "## Lines that no test reaches",
        "",
        *missed,
        "",
        "## Bits that never rose and fell",
        "",
        *bits,
        "",
    ]
    return "\n".join(parts)


def main() -> int:
    """Run, add up, print, write."""
    for path in data_files():
        path.unlink()
    status = run_tests()
    modules = read(data_files())
    if not modules:
        print("make coverage: the tests left no data", file=sys.stderr)
        return 1
    show(modules)
    if status == 0:
        PAGE.write_text(page(modules), encoding="utf-8")
    return status


if __name__ == "__main__":
    sys.exit(main())
