# SPDX-License-Identifier: MIT
"""The demonstration of the firmware: moves typed at its console, pulses of the core."""

import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np
from passo.console import console, progress, stages, table
from passo.output import make_folder, write_json
from passo.run import open_engine, parameters_for
from passo.toolchain import paths, short
from rich.table import Table

from passo_stm32.board import firmware_elf
from passo_stm32.play import Played, planned_clocks, play

FOLDER = paths.build / "firmware_demo"
CLOCK_HZ = 36_000_000  # of the core; SCLK is 9 MHz
EXAMPLES = (
    "three_axes",
    "cosine",
    "triangle",
)  # about a second of motion in total
PICTURED = 3
LINE_WIDTH = 90  # characters of what was typed
SHOWN = 0.0006  # seconds of pulses


@dataclass
class Shown:
    """What is shown of a file: its moves and its row of summary.json."""

    name: str
    played: list[Played]
    facts: dict[str, Any]
    took: float  # seconds of real time


def run_file(path: Path, engine: str) -> Shown:
    """Type the moves of a file at a board of its own."""
    played, board, took = play(path, CLOCK_HZ, engine)
    facts = {
        "ok": not any(move.difference for move in played),
        "lines": [move.line for move in played],
        "steps": [move.made.pulses() for move in played],
        "edges": sum(len(move.made.step) for move in played),
        "clocks": [move.made.clocks for move in played],
        "frames": board.wires.frames,
        "instructions": board.instructions,
        "awake": 1 - board.asleep_ticks / board.now,
    }
    return Shown(path.stem, played, facts, took)


def demo(files: list[Path] | None = None, engine: str = "rtl") -> bool:
    """Run the demonstration, a file per processor; return whether every edge matches the C model with the
    planner on the PC."""
    tell = stages()
    files = files or [paths.examples / f"{name}.toml" for name in EXAMPLES]
    clocks = [planned_clocks(path, CLOCK_HZ) for path in files]
    open_engine(engine, parameters_for(1), CLOCK_HZ).close()  # builds what all of them need
    firmware_elf()
    for path, length in zip(files, clocks, strict=True):
        tell(f"{path.stem}: {length / CLOCK_HZ:.3f} s of motion, {length:,} clocks")
    results: list[Shown] = []
    with ProcessPoolExecutor() as pool:
        coming = pool.map(run_file, files, [engine] * len(files))
        with progress("moves", sum(clocks)) as report:
            for result in coming:
                results.append(result)
                report(sum(clocks[: len(results)]))
                wrong = sum(bool(move.difference) for move in result.played)
                told = f"{wrong} moves differ" if wrong else "all as expected"
                tell(f"{result.name}: {result.facts['edges']:,} edges, {told}")
    for path, result in zip(files, results, strict=True):
        for move in result.played:
            if move.difference:
                print(f"{path}: {move.line}: {move.difference}", file=sys.stderr)
    good = all(result.facts["ok"] for result in results)
    make_folder(FOLDER)
    write_json({"ok": good, "runs": {r.name: r.facts for r in results}}, FOLDER / "summary.json")
    draw({result.name: result.played for result in results[:PICTURED]}, FOLDER / "firmware.png")
    tell("picture drawn")
    console.print(overview(results))
    console.print("awake: the processor, of all the time from its reset on")
    console.print(f"Picture and summary: {short(FOLDER)}/")
    return good


def overview(results: list[Shown]) -> Table:
    """A row per file."""
    shown = table(
        "Typed at the console of the firmware; compared edge for edge with the C model fed on the PC",
        *("moves", "steps", "time", "edges", "frames", "awake", "took"),
    )
    for result in results:
        steps = sum(result.facts["steps"])
        facts = result.facts
        shown.add_row(
            result.name,
            f"{steps:,}",
            f"{sum(move.seconds for move in result.played):.3f} s",
            f"{facts['edges']:,}",
            f"{facts['frames']:,}",
            f"{100 * facts['awake']:.1f} %",
            f"{result.took:.0f} s",
        )
    return shown


def draw(pictures: dict[str, list[Played]], path: Path) -> None:
    """Plot for each file the typed lines, the speeds at the pins, and the first pulses of its first move."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from passo.plot import COLORS, STYLE, save

    with plt.rc_context(STYLE):
        figure, rows = plt.subplots(
            len(pictures), 2, figsize=(12, 3.1 * len(pictures)), width_ratios=[1.3, 1], squeeze=False
        )
        figure.suptitle(
            "Typed at the console of the STM32 firmware, made by the simulated core", x=0.01, ha="left",
            fontsize=13, fontweight="bold",
        )  # fmt: skip
        for (speed, pulses), (name, played) in zip(rows, pictures.items(), strict=True):
            origin = 0.0
            for move in played:
                for axis in range(len(move.plan.move.steps)):
                    clocks, directions = move.made.steps(axis)
                    same = directions[1:] == directions[:-1]
                    times = origin + (clocks[1:] + clocks[:-1])[same] / 2 / CLOCK_HZ
                    values = (directions[1:] / np.maximum(np.diff(clocks), 1))[same] * CLOCK_HZ / 1e3
                    speed.plot(times, values, color=COLORS[axis], linewidth=1.1)
                origin += move.seconds
            typed = "\n".join(fill(f"> {move.line}", LINE_WIDTH) for move in played)
            speed.set_title(f"{name}\n" + typed, fontsize=7.5, family="DejaVu Sans Mono")
            speed.set_xlabel("s, pauses between the moves left out")
            speed.set_ylabel("kHz")
            speed.margins(x=0.01)
            _first_pulses(pulses, played[0])
        save(figure, path, 100)


def _first_pulses(ax: object, move: Played) -> None:
    """Plot STEP of each axis around the first pulses."""
    from passo.plot import COLORS

    axes = len(move.plan.move.steps)
    first = int(move.made.step[0, 0])
    some = np.sort(np.concatenate([move.made.steps(axis)[0] for axis in range(axes)]))
    end = max(first + SHOWN * CLOCK_HZ, int(some[min(len(some) - 1, 10 * axes)]))
    inside = move.made.step[move.made.step[:, 0] <= end]
    for axis in range(axes):
        clocks = np.concatenate([[0], inside[:, 0], [end]]) / CLOCK_HZ * 1e3
        levels = np.concatenate([[0], inside[:, 1] >> axis & 1])
        levels = np.concatenate([levels, levels[-1:]])
        ax.step(clocks, levels - 1.5 * axis, where="post", color=COLORS[axis], linewidth=1)
    ax.set_yticks([0.5 - 1.5 * axis for axis in range(axes)], [f"STEP {axis}" for axis in range(axes)])
    for axis, label in enumerate(ax.get_yticklabels()):
        label.set_color(COLORS[axis])  # also in the speeds
    ax.grid(visible=False, axis="y")
    ax.set_title("The first pulses of the first move")
    ax.set_xlabel("ms since the start of the motion")
    ax.margins(x=0)
