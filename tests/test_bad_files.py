# SPDX-License-Identifier: MIT
"""What users may give to the command by mistake: one line with the file or option, and nothing is written."""

import os
import shlex
from pathlib import Path

import pytest
from passo.cli import main
from passo.toolchain import paths

PART = paths.examples / "gcode"
MACHINE = f"--machine {shlex.quote(str(PART / 'machine.toml'))}"
GRBL = f"console --grbl {MACHINE}"
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
TEXT, PLACE = "not a UTF-8 text file", "x,y,z must be within 100,000 mm"
PICTURE = "the name must end in .png, .svg or .pdf"
PROBE = "--probe takes 4 numbers of up to 100,000 mm with commas between them, not ''"
TOOL = "a tool needs a whole number (LinuxCNC)"
CASES = {
    "firmware binary --engine model": f"binary: {TEXT}",
    "firmware folder --engine model": "folder: Is a directory",
    "firmware empty --engine model": "empty: clock_hz is missing",
    "firmware none --engine model": "none: No such file or directory",
    "firmware --table moves.toml": "moves.toml: --table takes no move files",
    "shape --formula u --plot p.xyz": f"--plot p.xyz: {PICTURE}",
    "shape --formula u --plot plain": f"--plot plain: {PICTURE}",
    f"{GRBL} --settings folder": "folder: not a settings file: it must have 4096 bytes",
    f"{GRBL} --settings locked": "locked: Permission denied",
    "make deep": "deep: nested too deeply",
    "run deep": "deep: nested too deeply",
    "heightmap --probe ''": PROBE,
    "heightmap part.nc --map infinite": f"infinite:1: {PLACE}",
    "heightmap part.nc --map far": f"far:1: {PLACE}",
    "heightmap part.nc --map probed": f"probed:1: {PLACE}",
    f"preview part.nc {MACHINE} --surface infinite": f"infinite:1: {PLACE}",
    f"preview part.nc {MACHINE} --tools fraction": f"fraction:1: T1.5: {TOOL}",
    "expand part.nc --tools negative": f"negative:1: T-5: {TOOL}",
    "run moves.toml --from 0": "--from is for G-code: .nc, .ngc, .gcode, .tap",
}


@pytest.mark.parametrize("command", CASES, ids=lambda text: text.replace(MACHINE, "MACHINE"))
def test_a_mistake_is_a_line(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, data in FILES.items():
        (tmp_path / name).write_bytes(data)
    (tmp_path / "folder").mkdir()
    (tmp_path / "locked").write_bytes(4096 * b"\xff")
    access = os.access
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path).name != "locked" and access(path, mode))
    before = sorted(tmp_path.iterdir())
    assert main(shlex.split(command)) == 2
    said = capsys.readouterr()
    assert (said.err, said.out) == (f"{CASES[command]}\n", "")
    assert sorted(tmp_path.iterdir()) == before
