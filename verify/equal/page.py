# SPDX-License-Identifier: MIT
"""The table of docs/reference/equality.md: what is proved, how large it is, and how long it takes."""

from collections.abc import Iterable, Mapping
from typing import Any

from passo.toolchain import paths
from passo_fpga.pages import END, write_block

from verify.equal.coupling import Coupling

PAGE = paths.reference / "equality.md"
BEGIN = "<!-- equal: make verify writes from here -->"
HEADER = ("module", "RTL", "what it is", "goals", "bits", "seconds")
TEXTS = 3  # columns of them; the others are numbers


def write(chosen: Iterable[Coupling], report: Mapping[str, Any]) -> None:
    """Write the table into the page.

    Args:
        chosen: All couplings.
        report: As in build/equal.json.

    Raises:
        ValueError: The page lacks the marks.
    """
    write_block(PAGE, f"{_share(report)}\n\n{_table(chosen, report['results'])}", begin=BEGIN, end=END)


def _share(report: Mapping[str, Any]) -> str:
    proved, bits, seconds = report["proved_bits"], report["bits"], report["seconds"]
    modules = len({result["module"] for result in report["results"]})
    return (
        f"{modules} modules, with {proved:,} of the {bits:,} bits ({100 * proved / bits:.0f} %)"
        " of the registers of a core with 4 axes\nand all optional blocks (block RAMs are not counted)."
        f" All proofs, with and without faults, took {seconds / 60:.0f} minutes on two cores."
    )


def _table(chosen: Iterable[Coupling], results: Iterable[Mapping[str, Any]]) -> str:
    rows = []
    for coupling in chosen:
        mine = [result for result in results if result["module"] == coupling.name]
        proof = next(result for result in mine if result["what"] == "proof")
        rows.append(
            [
                coupling.name,
                f"`{coupling.top}`",
                coupling.says.rstrip("."),
                str(proof["goals"]),
                str(proof["bits"]),
                f"{proof['seconds']:.0f}",
            ]
        )
    rule = ["---"] * TEXTS + ["---:"] * (len(HEADER) - TEXTS)
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (HEADER, rule, *rows))
