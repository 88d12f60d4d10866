# SPDX-License-Identifier: MIT
"""What users may give to the command by mistake: one line with the file or option, and nothing is written."""

import os
from collections.abc import Sequence
from pathlib import Path

import pytest
from passo.cli import main
from passo.toolchain import paths

PART = paths.examples / "gcode"
MACHINE = ("--machine", str(PART / "machine.toml"))
GRBL = ("console", "--grbl", *MACHINE)
GRID = "{}\n10,0,1\n0,10,1\n10,10,1\n"
FILES = {
    "empty": b"",
    "binary": b"\xff\xfe\0\x81",
    "deep": b"a=" + 5000 * b"[" + 5000 * b"]",
    "part.nc": b"G0 X1\n",
    "moves.toml": (paths.examples / "cosine.toml").read_bytes(),
    "infinite": GRID.format("0,0,1e400").encode(),
    "far": GRID.format("0,0,1e300").encode(),
    "probed": b"[PRB:1e400,0,0:1]\n",
    "fraction": b"T1.5 Z3\n",
    "negative": b"T-5 Z3\n",
}
CASES: dict[Sequence[str], str] = {
    ("firmware", "binary", "--engine", "model"): "binary: not a UTF-8 text file",
    ("firmware", "folder", "--engine", "model"): "folder: Is a directory",
    ("firmware", "empty", "--engine", "model"): "empty: clock_hz is missing",
    ("firmware", "none", "--engine", "model"): "none: No such file or directory",
    ("firmware", "--table", "moves.toml"): "moves.toml: --table takes no move files",
    ("shape", "--formula", "u", "--plot", "p.xyz"): "--plot p.xyz: the name must end in .png, .svg or .pdf",
    ("shape", "--formula", "u", "--plot", "plain"): "--plot plain: the name must end in .png, .svg or .pdf",
    (*GRBL, "--settings", "folder"): "folder: not a settings file: it must have 4096 bytes",
    (*GRBL, "--settings", "locked"): "locked: Permission denied",
    ("make", "deep"): "deep: nested too deeply",
    ("run", "deep"): "deep: nested too deeply",
    (
        "heightmap",
        "--probe",
        "",
    ): "--probe takes 4 numbers of up to 100,000 mm with commas between them, not ''",
    ("heightmap", "part.nc", "--map", "infinite"): "infinite:1: x,y,z must be within 100,000 mm",
    ("heightmap", "part.nc", "--map", "far"): "far:1: x,y,z must be within 100,000 mm",
    ("heightmap", "part.nc", "--map", "probed"): "probed:1: x,y,z must be within 100,000 mm",
    ("preview", "part.nc", *MACHINE, "--surface", "infinite"): "infinite:1: x,y,z must be within 100,000 mm",
    (
        "preview",
        "part.nc",
        *MACHINE,
        "--tools",
        "fraction",
    ): "fraction:1: T1.5: a tool needs a whole number (LinuxCNC)",
    ("expand", "part.nc", "--tools", "negative"): "negative:1: T-5: a tool needs a whole number (LinuxCNC)",
    ("run", "moves.toml", "--from", "0"): "--from is for G-code: .nc, .ngc, .gcode, .tap",
}


@pytest.mark.parametrize("words", CASES, ids=lambda words: " ".join(words[:1] + words[-2:]))
def test_a_mistake_is_a_line(
    words: Sequence[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, data in FILES.items():
        (tmp_path / name).write_bytes(data)
    (tmp_path / "folder").mkdir()
    (tmp_path / "locked").write_bytes(4096 * b"\xff")
    access = os.access
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path).name != "locked" and access(path, mode))
    before = sorted(tmp_path.iterdir())
    assert main(words) == 2
    said = capsys.readouterr()
    assert (said.err, said.out) == (f"{CASES[words]}\n", "")
    assert sorted(tmp_path.iterdir()) == before
