# SPDX-License-Identifier: MIT
"""The wiring of a board: of syn/BOARD/board.toml and of the table in docs/firmware.md."""

from typing import Any

import matplotlib.pyplot as plt
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch
from passo.plot_panels import COLORS, INK
from passo_fpga.boards import Board
from passo_fpga.places import LINK, host_pins, places

from tools.pictures.style import GREY, PALE

AXIS_PINS = {"step": "STEP", "dir": "DIR", "enable": "EN"}


def wiring(board: Board) -> Any:
    """What the picture shows: the wires to the host, and those of each axis, as [signal, pin, place]."""
    where = places(board.name)
    link = [[signal, host_pins()[signal], board.pins[signal].pin, where.get(signal, "")] for signal in LINK]
    axes = [
        [[label, pins[signal].pin, where.get(f"{signal}[{axis}]", "")] for signal, label in AXIS_PINS.items()]
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
