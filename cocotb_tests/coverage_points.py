# SPDX-License-Identifier: MIT
"""Coverage points of the RTL as counted by Verilator, and the bits that are constant by construction.

The constant bits are listed with reasons in coverage_exclusions.toml. A listed bit that does not exist, or
that toggles, is an error.
"""

import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from passo.toolchain import paths

EXCLUSIONS = paths.cocotb_tests / "coverage_exclusions.toml"


@dataclass
class Module:
    """Counts of points: lines by (line, branch), bits by (signal with bit, direction)."""

    lines: Counter[tuple[int, str]] = field(default_factory=Counter)
    bits: Counter[tuple[str, str]] = field(default_factory=Counter)

    def missed_lines(self) -> list[int]:
        """Lines with a branch that was never taken."""
        return sorted({line for (line, _), count in self.lines.items() if not count})

    def all_bits(self) -> set[str]:
        """Names of all bits."""
        return {bit for bit, _ in self.bits}

    def missed_bits(self) -> list[str]:
        """Bits that never rose or never fell."""
        return sorted({bit for (bit, _), count in self.bits.items() if not count}, key=_natural)


@dataclass(frozen=True)
class Exclusion:
    """Bits of a file of rtl/ that cannot rise and fall, and why."""

    file: str
    bits: tuple[str, ...]
    reason: str


def _natural(name: str) -> list[tuple[int, str]]:
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", name) if part]


def read(files: Iterable[Path]) -> dict[str, Module]:
    """Merge Verilator's data files; modules of rtl/ by file name."""
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


def bits_of(words: str) -> list[str]:
    """Each bit by itself: `word[31:30,2]` is `word[31]`, `word[30]`, `word[2]`."""
    name, spans = re.fullmatch(r"(.*?)(?:\[([\d:,]+)\])?", words).groups()
    if spans is None:
        return [name]
    bits = []
    for span in spans.split(","):
        high, _, low = span.partition(":")
        bits += [f"{name}[{number}]" for number in range(int(high), int(low or high) - 1, -1)]
    return bits


def ranges(bits: Iterable[str]) -> list[str]:
    """Bits of the same signal together, the inverse of `bits_of`."""
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
        words.append(f"{name}[{','.join(parts)}]" if parts else name)
    return words


def read_exclusions(path: Path = EXCLUSIONS) -> list[Exclusion]:
    """Read the list; raises ValueError if an entry has no reason."""
    found = []
    for entry in tomllib.loads(path.read_text())["bits"]:
        if not entry["reason"].strip():
            raise ValueError(f"{path.name}: {entry['file']} {entry['names']} without a reason")
        bits = tuple(bit for words in entry["names"] for bit in bits_of(words))
        found.append(Exclusion(entry["file"], bits, entry["reason"]))
    return found


def excluded(exclusions: Iterable[Exclusion], file: str) -> set[str]:
    """Bits of a file that are on the list."""
    return {bit for exclusion in exclusions if exclusion.file == file for bit in exclusion.bits}


def wrong_exclusions(modules: Mapping[str, Module], exclusions: Sequence[Exclusion]) -> list[str]:
    """Errors in the list, one sentence each."""
    wrong = []
    seen: set[tuple[str, str]] = set()
    for exclusion in exclusions:
        module = modules.get(exclusion.file, Module())
        there, missed = module.all_bits(), set(module.missed_bits())
        for bit in exclusion.bits:
            place = f"{exclusion.file}: {bit}"
            if bit not in there:
                wrong.append(f"{place} is excluded and does not exist")
            elif bit not in missed:
                wrong.append(f"{place} is excluded and rises and falls")
            if (exclusion.file, bit) in seen:
                wrong.append(f"{place} is excluded twice")
            seen.add((exclusion.file, bit))
    return wrong
