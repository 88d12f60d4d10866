# SPDX-License-Identifier: MIT
"""How long `passo preview` takes, and how near its time is to that of `passo run`.

    python -m benchmarks.preview [LINES]

Times are of the processor. An error if 100,000 lines take more than 5 s, or if a preview is off by more than
0.1 %.
"""

import json
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from passo.console import console, stages, table
from passo.ending import ended
from passo.toolchain import paths

from benchmarks.play_case import circles, rosette, zigzag

LINES, SECONDS, SHARE = 100_000, 5, 1e-3
PLAYED = (("rosette", rosette, 2000), ("circles", circles, 100), ("zigzag", zigzag, 200))
GCODE = paths.examples / "gcode"


def command(name: str, part: Path, machine: Path, folder: Path) -> tuple[float, float]:
    """Seconds of the processor that `passo NAME` takes, and the seconds of the path that it says."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    words = [sys.executable, "-m", "passo.cli", name, part, "--machine", machine, "--out", folder]
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stderr)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    summary = json.loads(
        (folder / ("summary.json" if name == "run" else "preview.json")).read_text(encoding="utf-8")
    )
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return seconds, summary["path_seconds"]


def planned(lines: int, folder: Path) -> tuple[float, float]:
    """The same of `passo preview` for a rosette of `lines` lines."""
    (folder / "long.nc").write_text(rosette(lines))
    return command("preview", folder / "long.nc", GCODE / "machine.toml", folder / "out")


def off(part: Path, machine: Path, folder: Path) -> tuple[float, float, float, float]:
    """Seconds of preview and run, those of the path in the run, and by which share the preview is off."""
    short, said = command("preview", part, machine, folder / "out")
    long, played = command("run", part, machine, folder / "out")
    return short, long, played, abs(said / played - 1)


def main() -> None:
    """Of the command."""
    lines, tell = int(sys.argv[1]) if len(sys.argv) > 1 else LINES, stages()
    rows = table("Preview and run", "part", "lines", "preview [s]", "run [s]", "path [s]", "off")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = [(GCODE / "part.nc", GCODE / "machine.toml"), (GCODE / "engraving.nc", GCODE / "corexy.toml")]
        for case, text, count in PLAYED:
            (folder / f"{case}.nc").write_text(text(count))
            files.append((folder / f"{case}.nc", GCODE / "machine.toml"))
        command("preview", *files[0], folder / "out")  # builds
        for part, machine in files:
            short, long, played, share = off(part, machine, folder)
            tell(f"{part.name}: {long / short:.1f} times as fast as the run, off by {share:.2g}")
            if share > SHARE:
                raise SystemExit(f"{part.name}: the preview is off by {share:.2%}")
            count = str(len(part.read_text(encoding="utf-8").splitlines()))
            rows.add_row(part.name, count, f"{short:.2f}", f"{long:.2f}", f"{played:.6g}", f"{share:.2g}")
        seconds, said = planned(lines, folder)
        rows.add_row("rosette.nc", str(lines), f"{seconds:.2f}", "", f"{said:.6g}", "")
    console.print(rows)
    if lines <= LINES and seconds > SECONDS:
        raise SystemExit(f"{lines} lines took {seconds:.2f} s")


if __name__ == "__main__":
    sys.exit(ended(main))
