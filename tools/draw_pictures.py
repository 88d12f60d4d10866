# SPDX-License-Identifier: MIT
"""Draw docs/images: the idea of the core, and the wiring of each board (`make pictures`).

The wiring is that of syn/BOARD/board.toml and of the table in docs/firmware.md; the idea shows a move that
the C model has made. Each picture keeps a digest of what it shows, which a test compares with what there
is.
"""

import hashlib
import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch
from passo.engine import model_engine
from passo.move_file import parse_moves
from passo.plan import plan_file
from passo.plot_panels import COLORS, INK
from passo.run import Run, execute, parameters_for
from passo.toolchain import paths
from passo_fpga.boards import Board, boards

IMAGES = paths.docs / "images"
DIGEST = "Facts"  # key of the text in the PNG
GREY, PALE, LINE = "#57606a", "#f6f8fa", "#d0d7de"
DOES = "ramp: the speed in every tick\npath and DDA: the clock of every step"
MOVE = """clock_hz = 16_000_000
[[move]]
steps = [24, -15, 9]
profile = "cosine"
total_time = 0.0016
ramp_time = 0.0006
"""
AXIS_PINS = {"step": "STEP", "dir": "DIR", "enable": "EN"}
LINK = ("spi_cs_n", "spi_sclk", "spi_mosi", "spi_miso", "irq")


# ---------------------------------------------------------------------------------------- the idea


@dataclass(frozen=True)
class Idea:
    """A move: what was sent, and what left the pins."""

    frames: list[list[int]]  # words of the frames that queue it
    run: Run

    def facts(self) -> Any:
        """What the picture depends on."""
        return [self.frames, [self.run.steps(axis)[0].tolist() for axis in range(3)]]


def play() -> Idea:
    """Play the move on the C model."""
    file = parse_moves(MOVE, Path("move"))
    parameters = parameters_for(file.axes)
    frames: list[list[int]] = []
    with model_engine(parameters, file.clock_hz) as engine:
        transfer = engine.transfer

        def spied(mosi: list[int], gap: int) -> list[int]:
            frames.append(list(mosi))
            return transfer(mosi, gap)

        engine.transfer = spied
        run = execute(file, plan_file(file, parameters), engine)
    pushes = [words for words in frames if words[0] >> 28 == 3]  # PUSH
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


# ------------------------------------------------------------------------------------------ wiring


def host_pins() -> dict[str, str]:
    """Pins of the Blue Pill by the signal of the core, from the table in docs/firmware.md."""
    text = (paths.docs / "firmware.md").read_text(encoding="utf-8")
    found = {signal: pin for pin, signal in re.findall(r"^\| (P\w+) \| [^|]* \| `(\w+)`", text, re.M)}
    assert set(found) == set(LINK), found
    return found


def places(name: str) -> dict[str, str]:
    """Where a board has the pins of its signals, from the comments of its table: `J2 25`."""
    text = (paths.root / "syn" / name / "board.toml").read_text(encoding="utf-8")
    found = {
        signal: note.split(",")[0].strip()
        for signal, note in re.findall(r"^(spi_\w+|irq|sync) = .*?# (.*)$", text, re.M)
    }
    axes = re.findall(r"^  \{ step = .*?\}, *(?:# (.*))?$", text, re.M)
    for axis, note in enumerate(axes):
        connector = ""
        for signal, place in zip(AXIS_PINS, filter(None, note.split(",")), strict=False):
            *words, number = place.split()
            connector = " ".join(words) or connector
            found[f"{signal}{axis}"] = f"{connector} {number}"
    return found


def wiring(board: Board) -> Any:
    """What the picture shows: the wires to the host, and those of each axis, as [signal, pin, place]."""
    where = places(board.name)
    link = [[signal, host_pins()[signal], board.pins[signal].pin, where.get(signal, "")] for signal in LINK]
    axes = [
        [[label, pins[signal].pin, where.get(f"{signal}{axis}", "")] for signal, label in AXIS_PINS.items()]
        for axis, pins in enumerate(board.axis_pins)
    ]
    return [board.title, link, axes]


def draw_wiring(facts: Any) -> Figure:
    """The Blue Pill on the left, the board in the middle, the drives on the right."""
    title, link, axes = facts
    rows = max(len(link) + 2, 3 * len(axes) + len(axes) - 1)
    figure, ax = plt.subplots(figsize=(11, 1.3 + 0.235 * rows))
    figure.subplots_adjust(left=0.01, right=0.99, top=0.99, bottom=0.01)
    ax.axis("off")
    ax.set_xlim(0, 11)
    ax.set_ylim(-rows - 0.4, 2.2)
    middle = -(rows - 1) / 2

    def block(x: float, width: float, high: float, low: float, name: str, color: str) -> None:
        ax.add_patch(
            FancyBboxPatch(
                (x, low),
                width,
                high - low,
                boxstyle="round,pad=0,rounding_size=0.12",
                facecolor=PALE,
                edgecolor=color,
                linewidth=1.6,
                mutation_aspect=1,
            )
        )
        ax.text(
            x + width / 2,
            high + 0.35,
            name,
            ha="center",
            va="bottom",
            fontsize=11,
            fontweight="bold",
            color=INK,
        )

    def label(x: float, y: float, text: str, align: str, **style: Any) -> None:
        ax.text(x, y, text, ha=align, va="center", **({"color": INK, "fontsize": 9} | style))

    wires = [*link, ["ground", "GND", "GND", ""]]
    first = middle + (len(wires) - 1) / 2 * 1.35
    block(0.15, 1.5, first + 0.9, first - (len(wires) - 1) * 1.35 - 0.9, "Blue Pill", COLORS[0])
    block(4.3, 3.0, 0.8, -rows + 0.2, title, COLORS[1])
    for i, (signal, host, pin, place) in enumerate(wires):
        y = first - 1.35 * i
        color = GREY if signal == "ground" else COLORS[0]
        ax.plot([1.65, 4.3], [y, y], color=color, linewidth=1.5)
        label(1.55, y, host, "right", fontweight="bold")
        label(2.97, y + 0.36, signal, "center", color=color, fontsize=8.5)
        label(4.4, y, f"{pin}", "left", fontweight="bold")
        label(5.05, y, place, "left", color=GREY, fontsize=8)
    for axis, pins in enumerate(axes):
        top = -4.0 * axis
        color = COLORS[axis % len(COLORS)]
        block_top, block_low = top + 0.55, top - 2.55
        ax.add_patch(
            FancyBboxPatch(
                (9.5, block_low),
                1.35,
                block_top - block_low,
                facecolor=PALE,
                edgecolor=color,
                boxstyle="round,pad=0,rounding_size=0.1",
                linewidth=1.6,
            )
        )
        label(10.175, top - 1.0, f"drive {axis}", "center", fontweight="bold")
        for i, (name, pin, place) in enumerate(pins):
            y = top - i
            ax.plot([7.3, 9.5], [y, y], color=color, linewidth=1.5)
            label(7.2, y, f"{pin}", "right", fontweight="bold")
            label(6.6, y, place, "right", color=GREY, fontsize=8)
            label(8.4, y + 0.33, name, "center", color=color, fontsize=8)
    ax.text(8.4, -rows + 0.3, "and GND of each drive", ha="center", va="center", fontsize=8.5, color=GREY)
    return figure


# ----------------------------------------------------------------------------------------- pictures


def digest(facts: Any) -> str:
    """Of what a picture shows."""
    return hashlib.sha256(json.dumps(facts).encode()).hexdigest()[:16]


def pictures() -> Iterator[tuple[str, Any, Callable[[], Figure]]]:
    """Name, facts and drawer of each."""
    idea = play()
    yield "idea.png", idea.facts(), lambda: draw_idea(idea)
    for name, board in boards().items():
        facts = wiring(board)
        yield f"wiring-{name}.png", facts, lambda facts=facts: draw_wiring(facts)


def main() -> None:
    """Draw all of them."""
    IMAGES.mkdir(exist_ok=True)
    for name, facts, draw in pictures():
        figure = draw()
        figure.savefig(IMAGES / name, dpi=110, facecolor="white", metadata={DIGEST: digest(facts)})
        plt.close(figure)
        print(f"drawn: docs/images/{name}")


if __name__ == "__main__":
    main()
