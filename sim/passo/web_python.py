# SPDX-License-Identifier: MIT
"""Python for the page of `make web`: what plain lines do not have is expanded by passo.expand, in Pyodide."""

import base64
import io
import json
import sys
import zipfile
import zlib
from pathlib import Path
from typing import Any

from passo.native import ffi, planner
from passo.output import write_text
from passo.report_page import FOLDER
from passo.toolchain import paths

NAME = "python.js"  # beside the page, which loads it when it needs it
PYODIDE = Path(sys.prefix) / "pyodide" / "node_modules" / "pyodide"
FILES = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")
MODULES = ("failure.py", "gcode.py")  # of sim/passo, with those of the package expand
OWN = ("native.py", "expanding.py")  # of sim/passo/page
FUNCTIONS = (
    "passo_gcode_error_text",
    "passo_gcode_execute",
    "passo_gcode_line_count",
    "passo_gcode_line_read",
    "passo_gcode_load",
    "passo_gcode_next",
    "passo_gcode_offset",
    "passo_gcode_open",
    "passo_gcode_set_position",
)
EXPORTS = ("malloc", "free", *FUNCTIONS)  # of the WebAssembly
CONSTANTS = ("enum passo_gcode_error", "enum passo_gcode_group")


def is_installed() -> bool:
    """Whether there is a Pyodide: npm brings it."""
    return all((PYODIDE / name).is_file() for name in FILES)


def layout() -> dict[str, Any]:
    """Types, functions and constants that passo.expand uses, for sim/passo/page/native.py."""
    types: dict[str, Any] = {}

    def described(of: Any) -> Any:
        if of.kind == "array":
            return [described(of.item), of.length]
        if of.kind == "enum":
            return "unsigned int"
        if of.kind == "struct" and of.cname not in types:
            fields = [(name, described(field.type), field.offset) for name, field in of.fields]
            types[of.cname] = fields, ffi().sizeof(of)  # behind those that it has
        return str(of.cname)

    def argument(of: Any) -> Any:
        return described(of.item) if of.kind == "pointer" else None

    functions = {
        name: [argument(of) for of in ffi().typeof(getattr(planner(), name)).args] for name in FUNCTIONS
    }
    described(ffi().typeof("struct passo_gcode_line"))
    constants = {name: value for of in CONSTANTS for name, value in ffi().typeof(of).relements.items()}
    return {"types": types, "functions": functions, "constants": constants}


def package() -> bytes:
    """The package passo as the page has it, as a zip file."""
    sources = [paths.sim / "passo" / name for name in MODULES] + sorted(
        (paths.sim / "passo" / "expand").glob("*.py")
    )
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:

        def add(name: str, data: str) -> None:
            archive.writestr(zipfile.ZipInfo(f"passo/{name}"), data)

        add("__init__.py", "")
        for name in OWN:
            add(name, (FOLDER / name).read_text(encoding="utf-8"))
        add("native.json", json.dumps(layout()))
        for source in sources:
            add(source.relative_to(paths.sim / "passo").as_posix(), source.read_text(encoding="utf-8"))
    return made.getvalue()


def write_python(folder: Path) -> Path | None:
    """Write it beside the page; None if there is no Pyodide."""
    made = folder / NAME
    if not is_installed():
        made.unlink(missing_ok=True)
        return None
    files = {name: (PYODIDE / name).read_bytes() for name in FILES} | {"passo.zip": package()}
    packed = {name: base64.b64encode(zlib.compress(data, 9)).decode() for name, data in files.items()}
    write_text(made, f"globalThis.passoPython = {json.dumps(packed, separators=(',', ':'))};\n")
    return made
