# SPDX-License-Identifier: MIT
"""The notebooks of the examples: executed, and as pages of the site. In git they have no outputs."""

import re
from pathlib import Path
from typing import Any

from passo.toolchain import paths

NOTEBOOKS = tuple(sorted(paths.examples.rglob("*.ipynb")))
SECONDS_MAX = 300  # of a cell
PROGRESS = re.compile(r"^(Building|Built) .*\n", re.M)  # of the first use of a library


def executed(notebook: Path) -> Any:
    """A notebook with its outputs, executed in its folder. Raises CellExecutionError if a cell fails."""
    import nbformat  # takes seconds
    from nbclient import NotebookClient

    found: Any = nbformat.read(notebook, nbformat.NO_CONVERT)  # type: ignore[no-untyped-call]
    client = NotebookClient(
        found,
        timeout=SECONDS_MAX,
        resources={"metadata": {"path": str(notebook.parent)}},
    )
    return client.execute()


def page(notebook: Any) -> tuple[str, dict[str, bytes]]:
    """Markdown of an executed notebook, and its pictures by name."""
    from nbconvert import MarkdownExporter

    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            if "text" in output:
                output["text"] = PROGRESS.sub("", output["text"])
    exporter: Any = MarkdownExporter()  # type: ignore[no-untyped-call]
    text, resources = exporter.from_notebook_node(notebook)
    return text, resources["outputs"]
