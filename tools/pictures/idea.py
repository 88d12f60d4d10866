# SPDX-License-Identifier: MIT
"""The idea of the core: a move that the C model has made."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch
from passo.build import model_library
from passo.engine import Engine
from passo.link import GAP
from passo.move_file import parse_moves
from passo.plan import plan_file
from passo.plot_panels import COLORS, INK
from passo.run import Run, execute, parameters_for

from tools.pictures.style import GREY, PALE

DOES = "ramp: the speed in every tick\npath and DDA: the clock of every step"
MOVE = """clock_hz = 16_000_000
[[move]]
steps = [24, -15, 9]
profile = "cosine"
total_time = 0.0016
ramp_time = 0.0006
"""


@dataclass(frozen=True)
class Idea:
    """A move: what was sent, and what left the pins."""

    frames: list[list[int]]  # words of the frames that queue it
    run: Run

    def facts(self) -> Any:
        """What the picture depends on."""
        return [self.frames, [self.run.steps(axis)[0].tolist() for axis in range(3)]]


class Watched(Engine):
    """Keeps the words of all frames."""

    def __init__(self, *arguments: Any):
        super().__init__(*arguments)
        self.frames: list[list[int]] = []

    def transfer(self, mosi: Sequence[int], gap: int = GAP) -> list[int]:
        """As of an engine."""
        self.frames.append(list(mosi))
        return super().transfer(mosi, gap)


def play() -> Idea:
    """Play the move on the C model."""
    file = parse_moves(MOVE, Path("move"))
    with Watched(model_library(), parameters_for(file.axes), file.clock_hz) as engine:
        run = execute(file, plan_file(file, engine.parameters), engine)
    pushes = [words for words in engine.frames if words[0] >> 28 == 3]  # PUSH
    return Idea(pushes, run)


def _box(ax: Axes, x: float, width: float, title: str, lines: str, color: str) -> None:
    patch = FancyBboxPatch(
        (x, 0.12),
        width,
        0.76,
        boxstyle="round,pad=0.0,rounding_size=0.03",
        facecolor=PALE,
        edgecolor=color,
        linewidth=1.6,
        clip_on=False,
    )
    ax.add_patch(patch)
    ax.text(x + width / 2, 0.70, title, ha="center", va="center", fontsize=12, fontweight="bold", color=INK)
    ax.text(x + width / 2, 0.38, lines, ha="center", va="center", fontsize=9.5, color=GREY, linespacing=1.5)


def _arrow(ax: Axes, begin: float, end: float, text: str) -> None:
    ax.annotate(
        "", (end, 0.5), (begin, 0.5), arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 1.6}
    )
    ax.text((begin + end) / 2, 0.58, text, ha="center", va="bottom", fontsize=9.5, color=INK)


def draw_idea(idea: Idea) -> Figure:
    """Boxes above, and below each of them what it makes of one move."""
    figure = plt.figure(figsize=(11, 5.4))
    grid = figure.add_gridspec(
        2,
        3,
        height_ratios=[1, 2.1],
        width_ratios=[1, 1.15, 1.5],
        left=0.045,
        right=0.985,
        top=0.985,
        bottom=0.095,
        hspace=0.16,
        wspace=0.2,
    )
    top = figure.add_subplot(grid[0, :])
    top.set_xlim(0, 3)
    top.set_ylim(0, 1)
    top.axis("off")
    _box(top, 0.0, 0.78, "Host", "an STM32F103 or another CPU\nplans the move, in integers", COLORS[0])
    _arrow(top, 0.79, 1.08, "a few words")
    _box(
        top,
        1.09,
        1.02,
        "Passo, in the FPGA",
        DOES,
        COLORS[1],
    )
    _arrow(top, 2.12, 2.41, "STEP, DIR")
    _box(top, 2.42, 0.58, "Drives", "every edge exact\nto the clock", COLORS[2])
    _draw_words(figure.add_subplot(grid[1, 0]), idea)
    _draw_speed(figure.add_subplot(grid[1, 1]), idea.run)
    _draw_pins(figure.add_subplot(grid[1, 2]), idea.run)
    return figure


def _draw_words(ax: Axes, idea: Idea) -> None:
    ax.axis("off")
    words = [word for frame in idea.frames for word in frame]
    ax.set_title(f"The move, as it is sent: {len(words)} words", loc="left", fontsize=10, fontweight="bold")
    shown = [" ".join(f"{word:08x}" for word in words[i : i + 3]) for i in range(0, len(words), 3)]
    ax.text(
        0,
        0.99,
        "\n".join(shown),
        family="DejaVu Sans Mono",
        fontsize=8.2,
        color=GREY,
        va="top",
        linespacing=1.28,
        transform=ax.transAxes,
    )
    lines = -(-len(words) // 3)
    text = (
        "A frame with the ramps and one with\n"
        "the line, each with a CRC:\nexecuted once, or refused as a whole."
    )
    ax.text(
        0,
        0.94 - 0.05 * lines,
        text,
        fontsize=9,
        color=GREY,
        va="top",
        linespacing=1.4,
        transform=ax.transAxes,
    )


def _style(ax: Axes) -> None:
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    ax.tick_params(labelsize=8.5, colors=GREY)


def _draw_speed(ax: Axes, run: Run) -> None:
    """The velocity of the path in each tick, from the plan's own ramps."""
    (plan,) = run.plans
    clock_ms = run.file.clock_hz / 1000
    tick, velocity, clock = 1 << plan.tick_log2, 0.0, 0
    shapes = {0: lambda u: u, 1: lambda u: (1 - np.cos(np.pi * u)) / 2}
    times, speeds = [0.0], [0.0]
    longest = max(abs(n) for n in plan.move.steps) / plan.line.substeps
    for ramp in plan.ramps:
        for k in range(ramp.ticks):
            now = velocity + (ramp.velocity_end - velocity) * shapes[int(ramp.shape)]((k + 0.5) / ramp.ticks)
            times += [clock / clock_ms, (clock + tick) / clock_ms]
            speeds += [now, now]
            clock += tick
        velocity = ramp.velocity_end
    scale = longest / (1 << 48) * run.file.clock_hz / 1000
    ax.plot(times, np.array(speeds) * scale, color=COLORS[1], linewidth=1.4)
    ax.fill_between(times, np.array(speeds) * scale, color=COLORS[1], alpha=0.15, linewidth=0)
    ax.set_title("Speed: a value for each tick of 128 clocks", loc="left", fontsize=10, fontweight="bold")
    ax.set_xlabel("ms", fontsize=9, color=GREY)
    ax.set_ylabel("steps per ms, longest axis", fontsize=9, color=GREY)
    ax.set_xlim(0, times[-1])
    ax.set_ylim(0, None)
    _style(ax)


def _draw_pins(ax: Axes, run: Run) -> None:
    """All edges of STEP and DIR."""
    clock_ms = run.file.clock_hz / 1000
    end = run.total_clocks / clock_ms
    names = []
    for axis in range(run.file.axes):
        for name in ("step", "dir"):
            level = run.pins[name] >> axis & 1
            times = (run.pins["clock"].astype(np.int64) - run.start) / clock_ms
            base = -len(names) * 1.0
            x = np.concatenate([[0], np.clip(times, 0, end), [end]])
            y = np.concatenate([[0], level, level[-1:]])
            ax.step(x, base + 0.62 * y, where="post", color=COLORS[axis], linewidth=1.0)
            names.append(f"{name.upper()} {'XYZ'[axis]}")
    ax.set_yticks([-i + 0.3 for i in range(len(names))], names)
    ax.set_xlim(0, end)
    counts = ", ".join(f"{n:+d}" for n in run.plans[0].move.steps)
    ax.set_title(f"Pins of the C model: {counts} steps", loc="left", fontsize=10, fontweight="bold")
    ax.set_xlabel("ms", fontsize=9, color=GREY)
    _style(ax)
    ax.spines["left"].set_visible(False)
    ax.tick_params(axis="y", length=0)
