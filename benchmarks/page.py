# SPDX-License-Identifier: MIT
"""How long the page of `make web` takes for a part, and for how long it is blocked.

    python -m benchmarks.page [LINES]

The part is that of benchmarks/play.py: lines of half a millimeter. Needs tools/setup.sh web browser.
"""

import json
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from passo.console import console, table
from passo.web import build

from benchmarks.play_case import rosette
from tests.helpers.browser import Browser

LINES = 20_000
SECONDS_MOST, BLOCKED_MOST = 30, 0.1
PATIENCE = 300  # seconds
FRAMES = """(() => {
    window.gap = 0;
    let last = performance.now();
    const frame = now => {
        gap = Math.max(gap, now - last);
        last = now;
        requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
})()"""


@dataclass(frozen=True)
class Measured:
    """Of a part; times in seconds."""

    steps: int
    motion: float  # time of the machine
    seconds: float  # from the click until all is drawn
    longest_task: float  # of the main thread, time of the processor
    longest_gap: float  # between two frames, with what else the computer does


def measure(lines: int) -> Measured:
    """Play lines of half a millimeter."""
    with (
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name,
        Browser(Path(name) / "browser") as browser,
    ):
        page = build(Path(name) / "web")
        browser.open(page.as_uri(), "web && web.done && passo.view.isDrawn")
        browser.value(FRAMES)
        with browser.tasks() as tasks:
            began = time.monotonic()
            browser.value(f"(web.put({json.dumps(rosette(lines))}, 'G-code'), web.run(), 1)")
            browser.wait("web.done > 1 && passo && passo.view.isDrawn", PATIENCE)
            seconds = time.monotonic() - began
        steps, motion, gap = browser.value(
            "[passo.motion.axes.reduce((sum, axis) => sum + axis.rises.length, 0),"
            "passo.motion.clocks / passo.motion.hz, gap]"
        )
    return Measured(int(steps), motion, seconds, max(tasks), gap / 1000)


def main() -> int:
    """Of the command."""
    lines = int(sys.argv[1]) if len(sys.argv) > 1 else LINES
    found = measure(lines)
    rows = table(f"The page: {lines:,} lines, {found.steps:,} steps, {found.motion:.0f} s of motion", "what")
    for column in ("measured [s]", "at most [s]"):
        rows.add_column(column, justify="right")
    rows.add_row("until all is drawn", f"{found.seconds:.1f}", f"{SECONDS_MOST}")
    rows.add_row("longest task of the page, processor", f"{found.longest_task:.3f}", f"{BLOCKED_MOST}")
    rows.add_row("longest time between two frames", f"{found.longest_gap:.3f}", "")
    console.print(rows)
    return int(found.seconds > SECONDS_MOST or found.longest_task > BLOCKED_MOST)


if __name__ == "__main__":
    sys.exit(main())
