# SPDX-License-Identifier: MIT
"""All commands of `passo` that write results, small; what takes minutes is left out of them."""

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import matplotlib.pyplot as plt
import passo_stm32.demo as firmware_demo
import pytest
from passo import bench, campaign_command, demo, part_plot, plot
from passo.campaign import Campaign, Result
from passo.campaign_moves import draw
from passo.pulse_judge import Fault
from passo.run import open_engine
from passo.toolchain import paths

MOVES = """
clock_hz = 1_000_000
[[move]]
steps = [200, -100]
profile = "cosine"
total_time = 0.05
ramp_time = 0.02
"""
SCENE = """
[machine]
start = [5, 6]
[[event]]
do = "abort"
time = "10ms"
"""
PART = paths.examples / "gcode"
MACHINE = ("--machine", str(PART / "machine.toml"))
CONSOLE = ("console", "--grbl", "--engine", "model", *MACHINE)

# OUT is an existing folder.
WRITERS: dict[str, list[str]] = {
    "run": ["run", "moves.toml", "--engine", "model", "--plot", "--report", "--out", "OUT"],
    "scene": ["run", "scene.toml", "--engine", "model", "--plot", "--report", "--out", "OUT"],
    "waves": ["run", "moves.toml", "--engine", "rtl", "--waves", "--out", "OUT"],
    "part": ["run", "part.nc", *MACHINE, "--plot", "--out", "OUT"],
    "shape": ["shape", "--formula", "u", "--out", "OUT/shape.csv", "--plot", "OUT/shape.png"],
    "shape.toml": ["shape", "--formula", "u", "--out", "OUT/shape.toml"],
    "settings": [*CONSOLE, "--settings", "OUT/settings"],
    "campaign": [
        "campaign",
        "--moves",
        "1",
        "--seed",
        "1",
        "--jobs",
        "1",
        "--json",
        "OUT/all/made.json",
        "--out",
        "OUT",
    ],
    "demo": ["demo"],
    "bench": ["bench"],
    "firmware": ["firmware", str(paths.examples / "cosine.toml"), "--engine", "model"],
}
# Those that only print.
TALKERS: dict[str, list[str]] = {
    "rtl": ["rtl"],
    "help": ["--help"],
    "version": ["--version"],
    "console": ["console", "--engine", "model"],
    "grbl": [*CONSOLE],
}


def smaller(patch: pytest.MonkeyPatch, out: Path) -> None:
    """Leave out what takes long; results of commands that choose their folder go to `out`."""
    for name in ("moves.toml", "scene.toml"):
        Path(name).write_text(MOVES + (SCENE if name == "scene.toml" else ""))
    Path("part.nc").write_text("G1 X1 Y2 F6000\nX0\n")
    for module in (plot, part_plot):  # pictures are as complete, but not as fine
        patch.setattr(module, "save", _coarse(plot.save), raising=False)
    patch.setattr(bench, "REPORT", out / "bench.json")
    patch.setattr(bench, "measure_all", lambda: [])
    patch.setattr(bench.Measurement, "clocks_per_second", lambda _: 1e6)
    patch.setattr(demo, "FOLDER", out / "demo")
    patch.setattr(demo, "ALL", ("cosine",))
    patch.setattr(demo, "_build_all", lambda _: None)
    patch.setattr(demo, "open_engine", lambda _, *rest: open_engine("model", *rest))
    patch.setattr(demo, "_run", _example)
    patch.setattr(demo, "plot_overview", lambda _, path: _picture(path))
    patch.setattr(campaign_command, "local_cluster", _no_cluster)
    patch.setattr(campaign_command, "prepare", lambda _: None)
    patch.setattr(campaign_command, "check_workers", lambda *_: None)
    patch.setattr(campaign_command, "carry_out", _carried_out)
    patch.setattr(campaign_command, "shrink_all", lambda *_: [(draw(1, 0), Fault("count", "lost"))])
    patch.setattr(firmware_demo, "FOLDER", out / "firmware_demo")
    patch.setattr(firmware_demo, "run_file", _typed)
    patch.setattr(firmware_demo, "firmware_elf", lambda: None)
    patch.setattr(firmware_demo, "draw", lambda _, path: _picture(path))


def _coarse(save: Any) -> Any:
    return lambda figure, path, _: save(figure, path, 30)


def _picture(path: Path) -> None:
    plot.save(plt.figure(figsize=(1, 1)), path, 30)


def _example(name: str) -> tuple[list[Any], dict[str, Any]]:
    """Found by name in the processes of a pool."""
    runs, summary = demo.run_example(name)
    return runs, summary | {"matched_edges": 0}


def _typed(path: Path, engine: str) -> Any:
    facts = {"ok": True, "lines": [], "steps": [1], "edges": 1, "clocks": [1], "frames": 1, "awake": 0.5}
    return firmware_demo.Shown(path.stem, [], facts, 0.0)


@contextmanager
def _no_cluster(_: int) -> Iterator[Any]:
    yield SimpleNamespace()


def _carried_out(campaign: Campaign, _: Any, tell: Any) -> Result:
    result = Result(
        campaign, 1, Counter(moves=1), faults={0: Fault("count", "lost")}, seconds=1, cpu_seconds=1
    )
    tell(result)
    return result
