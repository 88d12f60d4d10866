#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Worst-case stack, flash and RAM of a Thumb-2 program, computed from its ELF file.

Every function is disassembled for its stack frame and its calls. Indirect calls are listed in a file
("caller: target target ..."); the caller is the function of the source, also where the linker has made it a
part of another one. An indirect call that is not listed, recursion, and an unknown change of the stack
pointer are errors. All nesting interrupts are added to the deepest path, each with the 36 bytes that
the processor stacks. The exit status is 1 if the program does not fit.
"""

import argparse
import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

FLASH_SECTIONS, RAM_SECTIONS = {".vectors", ".text", ".data"}, {".data", ".bss", ".noinit"}
ALTERNATIVE = ".only_"  # sections that are in the same place
ROW = "{:30}  {:>18}  {:>18}  {:>16}"
EXCEPTION_BYTES = 36  # 8 words, and one for alignment
INSTRUCTION = re.compile(r"^ *([0-9a-f]+):\t([^\t]+)\t?(.*)$")
FUNCTION = re.compile(r"^([0-9a-f]+) <(.+)>:$")
TARGET = re.compile(r"([0-9a-f]+) <([^>+]+)>")
CLONE = re.compile(r"\.(isra|part|constprop|cold|lto_priv)\b.*")
CONDITIONAL = re.compile(r"b(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)")


class StackError(Exception):
    """The stack usage cannot be determined; the message says why."""


@dataclass
class Function:
    """A function: its stack frame in bytes and the addresses of its callees."""

    name: str  # without the compiler's suffixes for parts and clones
    frame: int = 0
    calls: set[int] = field(default_factory=set)
    pointers: dict[int, list[str]] = field(
        default_factory=dict
    )  # indirect calls by address: who may be listed


def disassemble(elf: Path, cross: str) -> dict[int, Function]:
    """All functions by their address."""
    text = _run(f"{cross}objdump", "-d", "--no-show-raw-insn", "-j", ".text", str(elf))
    functions: dict[int, Function] = {}
    current, start = None, 0
    for line in text.splitlines():
        if match := FUNCTION.match(line):
            start = int(match[1], 16)
            current = functions.setdefault(start, Function(CLONE.sub("", match[2])))
        elif current and (match := INSTRUCTION.match(line)):
            operands = match[3].split(";")[0].split("@")[0]
            _instruction(current, start, int(match[1], 16), match[2].strip(), operands)
    return functions


def _instruction(function: Function, start: int, at: int, operation: str, operands: str) -> None:
    """Account for one instruction: stack frame and calls."""
    name = operation.removesuffix(".n").removesuffix(".w")
    operands = operands.strip()
    if name == "push" or (name == "stmdb" and operands.startswith("sp!")):
        function.frame += 4 * _registers(operands)
    elif name in ("str", "strd") and (match := re.search(r"\[sp, #-(\d+)\]!", operands)):
        function.frame += int(match[1])
    elif name in ("sub", "subw") and re.match(r"sp\b", operands):
        match = re.search(r"#(\d+)", operands)
        if not match:
            raise StackError(f"{function.name} uses an unknown amount of stack: {operation} {operands}")
        function.frame += int(match[1])
    elif name in ("add", "addw", "mov", "ldr") and re.match(r"sp, (?!.*#\d)", operands + " "):
        # A frame too large for an immediate operand, or a restored stack pointer.
        if not re.match(r"sp, r7", operands):
            raise StackError(f"{function.name} changes the stack pointer: {operation} {operands}")
    elif name in ("bl", "b", "cbz", "cbnz") or CONDITIONAL.fullmatch(name):
        if (match := TARGET.search(operands)) and int(match[1], 16) != start:
            function.calls.add(int(match[1], 16))
    elif name == "blx" or (name == "bx" and operands != "lr"):
        function.pointers[at] = [function.name]


def _registers(operands: str) -> int:
    """Number of registers in a list such as {r4, r6-r8, lr}."""
    count = 0
    for item in re.search(r"\{(.*)\}", operands)[1].split(","):
        low, _, high = item.strip().partition("-")
        count += int(high[1:]) - int(low[1:]) + 1 if high else 1
    return count


def name_callers(functions: dict[int, Function], elf: Path, cross: str) -> None:
    """Add to each indirect call the functions of the source that it is in, innermost first."""
    sites = {site: names for function in functions.values() for site, names in function.pointers.items()}
    said = _run(f"{cross}addr2line", "-a", "-i", "-f", "-e", str(elf), *(f"{site:#x}" for site in sites))
    for part in re.split(r"^0x", said, flags=re.M)[1:]:
        site, *inlined = part.splitlines()
        sites[int(site, 16)][:0] = [CLONE.sub("", name) for name in inlined[::2]]


def read_calls(paths: Sequence[Path]) -> dict[str, list[str]]:
    """Read the targets of indirect calls: names, by the caller's name."""
    calls: dict[str, list[str]] = {}
    for line in "\n".join(path.read_text(encoding="utf-8") for path in paths).splitlines():
        line = line.partition("#")[0].strip()
        if line:
            caller, _, targets = line.partition(":")
            calls.setdefault(caller.strip(), []).extend(targets.split())
    return calls


def connect(functions: dict[int, Function], pointers: dict[str, list[str]]) -> dict[str, list[int]]:
    """Add the indirect calls; return the addresses by name."""
    by_name: dict[str, list[int]] = {}
    for address, function in functions.items():
        by_name.setdefault(function.name, []).append(address)
    used = set()
    for function in functions.values():
        for callers in function.pointers.values():
            caller = next((name for name in callers if name in pointers), None)
            if caller is None:
                raise StackError(f"{callers[0]} makes an indirect call but is not listed")
            used.add(caller)
            for target in pointers[caller]:
                if target not in by_name:
                    raise StackError(f"{caller} is listed as calling {target}, which does not exist")
                function.calls.update(by_name[target])
    unused = set(pointers) - used
    if unused:
        raise StackError(f"listed but without indirect calls: {', '.join(sorted(unused))}")
    return by_name


def deepest(functions: dict[int, Function], start: int) -> tuple[int, list[str]]:
    """Stack bytes of the deepest call path from a function, and the path."""
    known: dict[int, tuple[int, list[str]]] = {}

    def visit(address: int, above: tuple[int, ...]) -> tuple[int, list[str]]:
        if address in above:
            raise StackError(f"recursion: {' -> '.join(functions[a].name for a in (*above, address))}")
        if address not in known:
            function = functions[address]
            below = [visit(a, (*above, address)) for a in function.calls if a in functions]
            depth, path = max(below, default=(0, []), key=lambda item: item[0])
            known[address] = (function.frame + depth, [f"{function.name} {function.frame}", *path])
        return known[address]

    return visit(start, ())


def sizes(elf: Path, cross: str) -> tuple[int, int]:
    """Bytes of flash and of RAM; the stack excluded."""
    flash = ram = largest = 0
    for line in _run(f"{cross}size", "-A", str(elf)).splitlines():
        fields = line.split()
        if len(fields) == 3 and fields[0] in FLASH_SECTIONS | RAM_SECTIONS:
            flash += int(fields[1]) * (fields[0] in FLASH_SECTIONS)
            ram += int(fields[1]) * (fields[0] in RAM_SECTIONS)
        elif len(fields) == 3 and fields[0].startswith(ALTERNATIVE):
            largest = max(largest, int(fields[1]))
    return flash, ram + largest


def _run(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main() -> int:
    """Print the figures; return 1 if something does not fit or cannot be determined."""
    if sys.argv[1:] == ["--head"]:
        print(ROW.format("image", "flash, bytes", "RAM without stack", "stack at worst"))
        return 0
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("elf", type=Path)
    parser.add_argument("--cross", default="arm-none-eabi-")
    parser.add_argument("--calls", type=Path, action="append", required=True, help="indirect calls")
    parser.add_argument("--flash", type=int, required=True, help="bytes available")
    parser.add_argument("--ram", type=int, required=True, help="bytes available")
    parser.add_argument("--start", default="reset_handler")
    parser.add_argument("--interrupt", action="append", default=[], help="a handler that can nest on top")
    parser.add_argument("--row", help="print a row of a table instead, which begins with this")
    options = parser.parse_args()
    try:
        functions = disassemble(options.elf, options.cross)
        name_callers(functions, options.elf, options.cross)
        by_name = connect(functions, read_calls(options.calls))
        stack, path = deepest(functions, by_name[options.start][0])
        for handler in options.interrupt:
            stack += EXCEPTION_BYTES + deepest(functions, by_name[handler][0])[0]
    except (StackError, KeyError) as error:
        print(f"stack_usage: {error}", file=sys.stderr)
        return 1
    flash, ram = sizes(options.elf, options.cross)
    left = options.ram - ram
    if options.row:
        figures = (flash, options.flash), (ram, options.ram), (stack, left)
        print(ROW.format(options.row, *(f"{size:,} of {most:,}" for size, most in figures)))
    else:
        print(f"deepest path: {' > '.join(path)}")
        print(f"flash {flash} of {options.flash} bytes, {options.flash - flash} left")
        print(f"RAM   {ram} of {options.ram} bytes, {left} left for the stack")
        print(f"stack {stack} of {left} bytes at worst, {left - stack} left")
    if flash > options.flash or stack > left:
        print("stack_usage: does not fit", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
