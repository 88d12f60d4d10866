# SPDX-License-Identifier: MIT
"""Mutants that are no faults: yosys proves the module equal to the one it comes from.

Registers of the same name are taken to be equal before a clock, and proved to be so after it: all outputs
are equal for any inputs. So a mutant that only the neighbors of the module make harmless is not equal here.
"""

import contextlib
from collections.abc import Callable, Sequence

from passo.failure import Failure

from verify.mutants.fates import Fates
from verify.mutants.netlist import Core, Mutant, read, yosys

NAME = "equal"
CHUNK = 5  # mutants of one process
LIMIT = 60  # seconds for them


def equal(core: Core, module: str, mutants: Sequence[Mutant]) -> set[int]:
    """The numbers of the mutants with which a module of yosys is proved equal."""
    folder = core.folder / "equal"
    script = [
        *(read(core, folder), f"hierarchy -top {module}", "design -save core"),
        *("flatten", "memory_map", "rename -top gold", "design -stash gold"),
    ]
    for mutant in mutants:
        (folder / f"{mutant.number}.txt").unlink(missing_ok=True)
        script += [
            *("design -load core", mutant.command, f"hierarchy -top {module}"),
            *("flatten", "memory_map", "rename -top gate", "design -stash gate", "design -reset"),
            *("design -copy-from gold -as gold gold", "design -copy-from gate -as gate gate"),
            *("equiv_make gold gate both", "hierarchy -top both", "opt_clean"),
            *("equiv_simple -undef -seq 1", "equiv_induct -undef -seq 2"),
            f"tee -q -o {mutant.number}.txt equiv_status",
        ]
    with contextlib.suppress(Failure):  # those that it has come to are known
        yosys(folder, "\n".join(script) + "\n", LIMIT)
    files = {mutant.number: folder / f"{mutant.number}.txt" for mutant in mutants}
    return {
        number
        for number, file in files.items()
        if file.exists() and "successfully proven" in file.read_text(encoding="utf-8")
    }


def judge(core: Core, mutants: Sequence[Mutant], fates: Fates, show: Callable[[str], None]) -> None:
    """Prove what can be proved of the mutants that live."""
    by_module: dict[str, list[Mutant]] = {}
    for mutant in mutants:
        if fates.get(mutant.name).waits(NAME):
            by_module.setdefault(mutant.netlist_module, []).append(mutant)
    for module, waiting in by_module.items():
        for begin in range(0, len(waiting), CHUNK):
            chunk = waiting[begin : begin + CHUNK]
            proved = equal(core, module, chunk)
            for mutant in chunk:
                fate = fates.get(mutant.name)
                fate.tried = [*(fate.tried or []), NAME]
                if mutant.number in proved:
                    fate.equal = "the module is proved equal"
            fates.save()
            show(f"{core.name}: {chunk[0].module}: {len(proved)} of {len(chunk)} are proved equal")
