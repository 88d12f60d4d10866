# SPDX-License-Identifier: MIT
"""Mutants of C sources that are no faults: the compiler makes the same object code of them."""

import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from passo.compiler import CC, call

from verify.mutants.c_mutate import DECLARED
from verify.mutants.c_source import FOLDER, FOLDERS, CMutant
from verify.mutants.fates import Fates

NAME = "object code"
CHOSEN = "static inline int passo_at(int number) {{ return number == {number}; }}\n"


def object_code(source: Path, number: int) -> bytes:
    """Of a copy with one of its mutants alone; 0: of the source as it is."""
    text = source.read_text(encoding="utf-8").removeprefix(DECLARED)
    with tempfile.TemporaryDirectory() as folder:
        alone = Path(folder) / source.name
        alone.write_text(CHOSEN.format(number=number) + text, encoding="utf-8")
        made = alone.with_suffix(".o")
        call([CC, "-std=c11", "-w", "-O2", "-c", alone, "-o", made])
        return made.read_bytes()


def judge(mutants: Sequence[CMutant], fates: Fates, show: Callable[[str], None], root: Path = FOLDER) -> None:
    """Compare the object code of each mutant with that of its source."""
    found = 0
    for file in dict.fromkeys(mutant.file for mutant in mutants):
        source = next(root / name / file for name in FOLDERS if (root / name / file).exists())
        own = None
        for mutant in (one for one in mutants if one.file == file):
            case = f"{NAME} {mutant.source}"
            fate = fates.get(mutant.name)
            if fate.equal != case:
                fate.equal = ""
            if not fate.waits(case):
                continue
            own = own or object_code(source, 0)
            fate.tried = [*(one for one in fate.tried or [] if not one.startswith(NAME)), case]
            if object_code(source, mutant.number) == own:
                fate.equal = case
                found += 1
        fates.save()
    show(f"C: {found} have the object code of their source")
