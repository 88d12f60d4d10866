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
from passo.ending import ended
from passo.web import build

from benchmarks.play_case import rosette
from tests.helpers.browser import Browser
from tests.helpers.firefox import Firefox

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


DROP = """(text => {
    const data = new DataTransfer();
    data.items.add(new File([text], 'long.nc'));
    dispatchEvent(new DragEvent('drop', {dataTransfer: data}));
})"""
BUSY = 4  # seconds in which a worker is busy and the page is not, for what else the computer does
COUNT = """new Promise(done => {
    const source = "const end = Date.now() + %d; while (Date.now() < end); postMessage(0);";
    const worker = new Worker(URL.createObjectURL(new Blob([source])));
    gap = 0;
    worker.onmessage = () => done([gap, gap = 0][0]);
})"""


@dataclass(frozen=True)
class Played:
    """A part in any browser; times in seconds, by the clock."""

    steps: int
    motion: float  # time of the machine
    seconds: float  # from the drop of the file until all is drawn
    longest_gap: float  # between two frames, with what else the computer does
    busy_gap: float  # the same while only a worker has work


@dataclass(frozen=True)
class Measured(Played):
    """The same with times of the processor."""

    processor: float  # of all threads of the page
    longest_task: float  # of the main thread


def play(browser: Browser | Firefox, lines: int) -> Played:
    """Drop a file with lines of half a millimeter on the page that is open, and wait for all charts."""
    browser.value(FRAMES)
    busy = browser.value(COUNT % (1000 * BUSY))
    done, began = browser.value("web.done"), time.monotonic()
    browser.value(f"({DROP}({json.dumps(rosette(lines))}), 1)")
    browser.wait(f"web.done > {done} && passo && passo.view.isDrawn", PATIENCE)
    seconds = time.monotonic() - began
    steps, motion, gap = browser.value(
        "[passo.motion.axes.reduce((sum, axis) => sum + axis.rises.length, 0),"
        "passo.motion.clocks / passo.motion.hz, gap]"
    )
    return Played(int(steps), motion, seconds, gap / 1000, busy / 1000)


def measure(lines: int) -> Measured:
    """Play it in Chromium."""
    with (
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name,
        Browser(Path(name) / "browser") as browser,
    ):
        page = build(Path(name) / "web")
        browser.open(page.as_uri(), "web && web.done && passo.view.isDrawn")
        with browser.tasks() as tasks:
            played = play(browser, lines)
    return Measured(**vars(played), processor=tasks.seconds, longest_task=max(tasks.main))


def main() -> int:
    """Of the command."""
    lines = int(sys.argv[1]) if len(sys.argv) > 1 else LINES
    found = measure(lines)
    rows = table(f"The page: {lines:,} lines, {found.steps:,} steps, {found.motion:.0f} s of motion", "what")
    for column in ("measured [s]", "at most [s]"):
        rows.add_column(column, justify="right")
    rows.add_row("until all is drawn, processor", f"{found.processor:.1f}", f"{SECONDS_MOST}")
    rows.add_row("the same by the clock", f"{found.seconds:.1f}", "")
    rows.add_row("longest task of the page, processor", f"{found.longest_task:.3f}", f"{BLOCKED_MOST}")
    rows.add_row("longest time between two frames", f"{found.longest_gap:.3f}", "")
    rows.add_row("the same while only a worker has work", f"{found.busy_gap:.3f}", "")
    console.print(rows)
    return int(found.processor > SECONDS_MOST or found.longest_task > BLOCKED_MOST)


if __name__ == "__main__":
    sys.exit(ended(main))
