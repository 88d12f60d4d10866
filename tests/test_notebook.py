# SPDX-License-Identifier: MIT
"""The tutorial for Python: examples/python/tutorial.ipynb, executed, and its page (tools/notebook.py)."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from passo.toolchain import paths

from tools.notebook import NOTEBOOKS, executed, page

TUTORIAL = paths.examples / "python" / "tutorial.ipynb"


@pytest.fixture(scope="module")
def tutorial() -> Any:
    return executed(TUTORIAL)


def said(notebook: Any) -> str:
    outputs = [one for cell in notebook.cells for one in cell.get("outputs", [])]
    assert not [one for one in outputs if one.get("name") == "stderr"]
    return "".join(one.get("text", "") for one in outputs)


def test_it_runs(tutorial: Any) -> None:
    """Each cell, to the ends and figures that the text promises; the cells themselves assert more."""
    text = said(tutorial)
    assert "{'X': 40.0, 'Y': 20.0, 'Z': 0.0} {'X': 3200, 'Y': 1600, 'Z': 0}" in text
    assert "0.574072 s\n" in text and "2.000000 s, at the points off by" in text
    assert "point 1: Y: the speed changes by more than the acceleration allows" in text
    assert "{'X': 5.0, 'Y': 5.0, 'Z': 75.0}" in text


def test_its_page(tutorial: Any) -> None:
    """Has all cells and their figures, and nothing of what a first use builds."""
    text, pictures = page(tutorial)
    assert len(pictures) == 3 and all(data.startswith(b"\x89PNG") for data in pictures.values())
    assert all(f"]({name})" in text for name in pictures)
    assert "# A machine in Python" in text and "Built" not in text
    assert text.count("```python") == sum(cell.cell_type == "code" for cell in tutorial.cells)


def test_a_cell_that_fails(tmp_path: Path) -> None:
    """It is an error of the command, with its cause."""
    import nbformat  # takes seconds
    from nbclient.exceptions import CellExecutionError

    wrong = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("assert 1 == 2")])
    nbformat.write(wrong, tmp_path / "wrong.ipynb")
    with pytest.raises(CellExecutionError, match="1 == 2"):
        executed(tmp_path / "wrong.ipynb")


def test_outputs_are_not_in_git() -> None:
    assert TUTORIAL in NOTEBOOKS
    for notebook in NOTEBOOKS:
        for cell in json.loads(notebook.read_text())["cells"]:
            assert not cell.get("outputs") and cell.get("execution_count") is None


def test_it_has_types(tmp_path: Path) -> None:
    """As all examples: mypy --strict."""
    cells = json.loads(TUTORIAL.read_text())["cells"]
    code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    (tmp_path / "tutorial.py").write_text("\n".join(code) + "\n")
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent"]
    done = subprocess.run(
        [*command, "--cache-dir", str(paths.build / "mypy_cache"), str(tmp_path / "tutorial.py")],
        capture_output=True,
        text=True,
        cwd=paths.root,
        env=os.environ | {"MYPYPATH": str(paths.sim)},
    )
    assert done.returncode == 0, done.stdout
