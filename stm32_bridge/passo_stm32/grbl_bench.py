# SPDX-License-Identifier: MIT
"""Cost of the grbl image: instructions per line, lines per second, a long file of short lines."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from passo.build import Parameters
from passo.console import stages
from passo.engine import model_engine
from passo.output import check_results, write_text
from passo.toolchain import paths

from passo_stm32.board import make_firmware
from passo_stm32.bus import TICKS_PER_SECOND
from passo_stm32.grbl_board import FOLDER, GrblBoard, grbl_elf

REPORT = paths.reference / "firmware_gcode_report.md"
PAGE = paths.root / "benchmarks" / "firmware_gcode_page.md"
HZ = 72_000_000  # of processor and core
PARAMETERS = Parameters(axes=4, clock_hz=HZ)
BAUDS = (115_200, 1_000_000)
LINES = 2000  # of the long file
COUNTED, CALLED = 600, 200  # for the rates, and for each of the calls
RADIUS, SEGMENT = 50, 0.1  # mm, of a circle and its lines
LONG_FEED = 6000  # mm/min
READ, ADD = "a line is read and checked", "adding it to the look-ahead"
CALLS = {
    READ: "passo_gcode_execute",
    ADD: "passo_path_add",
    "a ramp of the path": "passo_path_next_ramp",
    "a line of the path for the core": "passo_path_next_line",
    "interrupt of a character": "usart1_handler",
}


@dataclass(frozen=True)
class Rate:
    """What a stream of lines came to."""

    lines: int
    seconds: float
    instructions: int  # awake or not

    @property
    def per_second(self) -> float:
        """Lines per second."""
        return self.lines / self.seconds

    @property
    def per_line(self) -> int:
        """Instructions per line."""
        return self.instructions // self.lines


def segments(count: int) -> list[str]:
    """Lines on a circle."""
    angles = [SEGMENT / RADIUS * i for i in range(1, count + 1)]
    return [f"G1X{RADIUS * math.sin(a):.3f}Y{RADIUS - RADIUS * math.cos(a):.3f}" for a in angles]


def open_board(baud: int) -> GrblBoard:
    """A board at a core of 72 MHz, with axes that do not hold up the lines."""
    elf = grbl_elf(paths.build / f"firmware_grbl_{baud}", "AXES=3", f"BAUD={baud}")
    board = GrblBoard(model_engine(PARAMETERS, HZ), elf, baud=baud)
    for axis in "01":
        for setting in ("11", "12"):
            assert board.line(f"${setting}{axis}=60000") == "ok"
    return board


def costs() -> dict[str, int]:
    """Instructions of calls in a stream of lines: the mean, with their interrupts."""
    return {name: round(_cost(function)) for name, function in CALLS.items()}


def _cost(function: str) -> float:
    board, found = open_board(BAUDS[1]), []

    def lines() -> Iterator[str]:
        for line in segments(CALLED):
            if (cost := board.measured()) is not None:
                found.append(cost)
            if not found or cost is not None:
                board.measure(function)
            yield line

    board.line("F60000")
    board.stream(lines(), 10)
    return float(np.mean(found))


def stream(baud: int, lines: list[str], before: str) -> tuple[GrblBoard, Rate]:
    """Lines by counting characters, after one that says how; until the last answer has been received."""
    board = open_board(baud)
    board.line(before)
    board.events()
    board.run(0.05)
    began, executed = board.seconds, board.instructions
    board.stream(lines, 3600)
    ended = board.output_ticks[-1] / TICKS_PER_SECOND
    rate = Rate(len(lines), ended - began, board.instructions - executed)
    return board, rate


def moving(baud: int, feed: int, count: int) -> tuple[Rate, list[float], bool]:
    """A circle at a feed in mm/min: the rate, the seconds of each motion, and whether it ended well."""
    board, rate = stream(baud, segments(count), f"F{feed}")
    board.rest(60)
    events = board.events()
    running = np.flatnonzero(np.diff(np.concatenate([[0], events["running"] & 1, [0]]).astype(int)))
    clocks = events["clock"][np.minimum(running, len(events) - 1)].astype(np.int64)
    return rate, [(end - begin) / HZ for begin, end in clocks.reshape(-1, 2)], "ALARM" not in board.output


def memory() -> str:
    """Flash, RAM and stack, as the build prints them."""
    said = make_firmware("GRBL=1", f"OUT={FOLDER}").splitlines()
    return "\n".join(line for line in said if line and not line.startswith("make"))


def bench(count: int = LINES, report: Path = REPORT) -> None:
    """Measure, write docs/reference/firmware_gcode_report.md and show it."""
    check_results(report)
    tell = stages()
    tell("firmware: calls")
    calls = costs()
    tell("firmware: lines per second")
    checked = {baud: stream(baud, segments(COUNTED), "$C")[1] for baud in BAUDS}
    moved = {baud: moving(baud, 60_000, COUNTED) for baud in BAUDS}
    tell(f"firmware: {count} lines")
    rate, motions, good = moving(BAUDS[1], LONG_FEED, count)
    tell.end()
    text = PAGE.read_text(encoding="utf-8").format(
        calls="\n".join(f"| {name} | {cost:,} |" for name, cost in sorted(calls.items())),
        line=f"{calls[READ] + calls[ADD]:,}",
        per_line=f"{checked[BAUDS[1]].per_line:,}",
        rates="\n".join(
            f"| {baud:,} | {checked[baud].per_second:,.0f} | {moved[baud][0].per_second:,.0f} |"
            for baud in BAUDS
        ),
        count=f"{count:,}",
        feed=f"{LONG_FEED:,}",
        wanted=f"{LONG_FEED / 60 / SEGMENT:,.0f}",
        motions=len(motions),
        seconds=f"{sum(motions):.3f}",
        ideal=f"{count * SEGMENT / (LONG_FEED / 60):.3f}",
        verdict="no alarm" if good else "AN ALARM",
        streamed=f"{rate.seconds:.3f}",
        memory=memory(),
    )
    write_text(report, text)
    print(text)
