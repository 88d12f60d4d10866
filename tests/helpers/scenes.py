# SPDX-License-Identifier: MIT
"""Move files with a machine, written and run by tests."""

from pathlib import Path

from passo.move_file import read_channels
from passo.run import open_engine
from passo.scene import Scene
from passo.scene_plan import scene_parameters
from passo.scene_run import SceneRun

CLOCK_HZ = 1_000_000
SPEED = 10_000  # steps/s of the cruise
HEAD = f"clock_hz = {CLOCK_HZ}\n"
MOVE = f"""
[[move]]
steps = [2000, -1000]
profile = "linear"
speed = {SPEED}
acceleration = 400_000
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "scene.toml"
    path.write_text(HEAD + text)
    return path


def play(folder: Path, text: str, engine: str = "model") -> SceneRun:
    file = read_channels(write(folder, text))
    with open_engine(engine, scene_parameters(file), file.clock_hz) as core:
        return Scene(file, core).run()


def machine(settings: str = "", *inputs: str, encoder: str = "") -> str:
    parts = [f"[machine]\n{settings}\n", *(f"[[machine.input]]\n{one}\n" for one in inputs)]
    return "".join(parts) + (f"[[machine.encoder]]\n{encoder}\n" if encoder else "")


def event(text: str) -> str:
    return "[[event]]\n" + text + "\n"
