# SPDX-License-Identifier: MIT
"""Write docs/reference/modules.md: what verifies each module of rtl/.

.venv/bin/python -m verify.page
"""

import re

from passo.build import rtl_sources
from passo.output import write_text
from passo.toolchain import paths

from verify.equal.coupling import couplings
from verify.formal.run import Proof, proofs

PAGE = paths.reference / "modules.md"
MUTANTS = paths.reference / "mutants.md"
TEMPLATE = paths.root / "verify" / "page.md"


def _reads(proof: Proof, module: str) -> bool:
    """Whether the proof is about the module: it has promises in it, or the proof is a wrapper around it."""
    inside = f"verify/formal/{module}_formal.vh"
    if proof.module.endswith("_proof"):
        inside = f"rtl/{module}.v"
    return proof.module == module or inside in proof.sources


def _score(module: str) -> str:
    """From the page of mutants."""
    found = re.search(rf"^\| `{module}` \|.* (\d+%) \|$", MUTANTS.read_text(encoding="utf-8"), re.M)
    return found[1] if found else ""


def page() -> str:
    """The text of the page."""
    coupled = {coupling.top for coupling in couplings()}
    found = proofs()
    rows = ["| module | proofs | properties | equal | mutants |", "|---|---|---:|---|---:|"]
    for source in rtl_sources():
        module = source.stem
        mine = [proof for proof in found if _reads(proof, module)]
        names = ", ".join(f"`{proof.name}`" for proof in mine)
        promises = str(sum(len(proof.promises) for proof in mine) or "")
        equal = "yes" if module in coupled else ""
        rows.append(f"| `{module}` | {names} | {promises} | {equal} | {_score(module)} |")
    return TEMPLATE.read_text(encoding="utf-8").replace("<!-- modules -->", "\n".join(rows))


def write() -> None:
    """Write the page, whose scores are those of the page of mutants."""
    write_text(PAGE, page())


if __name__ == "__main__":
    write()
