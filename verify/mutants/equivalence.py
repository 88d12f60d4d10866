# SPDX-License-Identifier: MIT
"""Mutants that are no faults: yosys proves the module equal to the one it comes from.

Registers of the same name are taken to be equal before a clock, and proved to be so after it: all outputs
are equal for any inputs. So a mutant that only the neighbours of the module make harmless is not equal here.
"""

from collections.abc import Callable, Sequence

from passo.build import TOP, rtl_sources
from passo.failure import Failure

from verify.mutants.fates import Fates
from verify.mutants.netlist import Core, Mutant, yosys


def equal(core: Core, mutant: Mutant) -> bool:
    """Whether the module with the mutant is proved equal."""
    words = mutant.command.split()
    module = words[words.index("-module") + 1]
    chosen = " ".join(f"-chparam {name} {value}" for name, value in core.parameters.verilog().items())
    read = (
        f"read_verilog -I. {' '.join(source.name for source in rtl_sources())}\n"
        f"hierarchy -top {TOP} {chosen}\nproc\nmemory_collect\nopt_clean\n"
    )
    script = (
        f"{read}design -save core\n"
        f"hierarchy -top {module}\nflatten\nmemory_map\nrename -top gold\ndesign -stash gold\n"
        f"design -load core\n{mutant.command}\n"
        f"hierarchy -top {module}\nflatten\nmemory_map\nrename -top gate\ndesign -stash gate\n"
        "design -copy-from gold -as gold gold\ndesign -copy-from gate -as gate gate\n"
        "equiv_make gold gate both\nhierarchy -top both\nopt_clean\n"
        "equiv_simple -undef -seq 1\nequiv_induct -undef -seq 2\nequiv_status -assert\n"
    )
    try:
        yosys(core.folder, script, LIMIT)
    except Failure:
        return False
    return True


LIMIT = 60  # seconds


def judge(core: Core, mutants: Sequence[Mutant], fates: Fates, show: Callable[[str], None]) -> None:
    """Prove what can be proved of the mutants that live."""
    for mutant in mutants:
        fate = fates.get(mutant.name)
        if not fate.lives or "equal" in (fate.tried or []):
            continue
        fate.tried = [*(fate.tried or []), "equal"]
        if equal(core, mutant):
            fate.equal = "the module is proved equal"
        show(f"{core.name}: {mutant.name}: {fate.equal or 'not proved equal'}")
        fates.save()
