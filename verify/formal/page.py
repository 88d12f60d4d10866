# SPDX-License-Identifier: MIT
"""Write docs/reference/promises.md from the template page.md and from promises.toml.

.venv/bin/python -m verify.formal.page
"""

import textwrap

from passo.output import write_text
from passo.toolchain import paths

from verify.formal.run import HERE, Proof, proofs

PAGE = paths.reference / "promises.md"
TEMPLATE = HERE / "page.md"
WIDTH = 120


def _section(proof: Proof) -> str:
    """The promises of a proof."""
    promises = "\n".join(
        textwrap.fill(
            promise.says, WIDTH, initial_indent="* ", subsequent_indent="  ", break_on_hyphens=False
        )
        for promise in proof.promises
    )
    parts = (f"## {proof.title} (`{proof.name}`)", proof.about.strip(), promises, proof.after.strip())
    return "\n\n".join(part for part in parts if part)


def page() -> str:
    """The text of the page."""
    found = proofs()
    rows = [f"| [`{proof.name}`](#{_anchor(proof)}) | {proof.purpose} |" for proof in found]
    text = TEMPLATE.read_text(encoding="utf-8")
    text = text.replace("<!-- proofs -->", "\n".join(("| proof | purpose |", "|---|---|", *rows)))
    return text.replace("<!-- promises -->", "\n\n".join(map(_section, found)))


def _anchor(proof: Proof) -> str:
    """As GitHub makes it of a heading."""
    kept = (c for c in f"{proof.title} {proof.name}".lower() if c.isalnum() or c in " -_")
    return "".join(kept).replace(" ", "-")


if __name__ == "__main__":
    write_text(PAGE, page())
