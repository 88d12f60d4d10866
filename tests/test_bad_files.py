# SPDX-License-Identifier: MIT
"""What users may give to the command by mistake: one line with the file or option, and nothing is written."""

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from passo.cli import main
from passo.toolchain import environment, paths

PART = paths.examples / "gcode"
MACHINE = f"--machine {shlex.quote(str(PART / 'machine.toml'))}"
GRBL = f"console --grbl {MACHINE}"
GRID = "{}\n10,0,1\n0,10,1\n10,10,1\n"
FILES = {
    "empty": b"",
    "binary": b"\xff\xfe\0\x81",
    "deep": b"a=" + 5000 * b"[" + 5000 * b"]",
    "part.nc": b"G0 X1\n",
    "part.gc": b"G0 X1\n",
    "wide.nc": "G0 X1\n".encode("utf-16"),
    "controls.nc": b"#1=2\nG0 \xc2\x9b\n",
    "table.csv": b"k,point\n",
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
READS = "the command reads this file: choose another one"
CONTROLS = """controls.nc:2: '\ufffd' is no word: write a letter and a value (NIST)"""
ROUTER = shlex.quote(str(paths.examples / "machines" / "router.toml"))
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
    f"run moves.toml {MACHINE}": "--machine is for G-code: .nc, .ngc, .gcode, .tap",
    f"run part.gc {MACHINE} --from -1": "--from -1: lines count from 1, the first one first",
    f"preview part.nc {MACHINE} --from 5 --to 2": "--from 5 --to 2: lines count from 1, the first one first",
    f"run wide.nc {MACHINE}": "wide.nc: the file is UTF-16: save it as UTF-8",
    "expand wide.nc": "wide.nc: the file is UTF-16: save it as UTF-8",
    "expand controls.nc": CONTROLS,
    "expand part.nc --out part.nc": f"--out part.nc: {READS}",
    "heightmap part.nc --map infinite --out ./infinite": f"--out infinite: {READS}",
    "shape --csv table.csv --out table.csv": f"--out table.csv: {READS}",
    "shape --formula u --out p.png": "--out p.png: the name must end in .csv or .toml",
    f"check {ROUTER} --port part.nc": "part.nc: this is no serial port",
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


def test_names_in_any_code(tmp_path: Path) -> None:
    """In a locale of ASCII, in which files are read and written as in any other."""
    names = ["f\u00fcnf", os.fsdecode(b"f\xfcnf")]
    code = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    for name in names:
        moves, part = tmp_path / f"{name}.toml", tmp_path / f"{name}.nc"
        shutil.copy(paths.examples / "cosine.toml", moves)
        shutil.copy(PART / "part.nc", part)
        pages = ["--report", "--plot", "--out", str(tmp_path / name)]
        for words in (
            ["run", str(moves), "--engine", "model", *pages],
            ["run", str(part), *shlex.split(MACHINE), *pages],
            ["preview", str(part), *shlex.split(MACHINE), *pages[2:]],
        ):
            command = [sys.executable, "-m", "passo", *words]
            done = subprocess.run(command, env=environment() | code, capture_output=True)
            assert (done.returncode, done.stderr) == (0, b""), done.stderr.decode(errors="replace")
        assert len(list((tmp_path / name).iterdir())) >= 6
