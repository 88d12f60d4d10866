# SPDX-License-Identifier: MIT
"""The report page: a run as one self-contained HTML file."""

import html
import json
from pathlib import Path
from typing import Any

from passo.moves import Channels
from passo.output import write_text
from passo.report_data import page_data
from passo.run import Run
from passo.scene_page import scene_data
from passo.scene_run import SceneRun

FOLDER = Path(__file__).parent / "page"
SHELL = FOLDER / "page.html"
UPLOT = ("uplot/LICENSE", "uplot/uPlot.min.css", "uplot/uPlot.iife.min.js")
SCRIPTS = (
    "bytes.js",
    "curve.js",
    "motion.js",
    "trace.js",
    "time.js",
    "course.js",
    "charts.js",
    "pins.js",
    "machine.js",
    "histogram.js",
    "path.js",
    "player.js",
    "tables.js",
    "page.js",
)


def write_page(channels: Channels, runs: list[Run], engine: str, path: Path) -> None:
    """Write the report of a run."""
    write_data(channels.name, page_data(channels, runs, engine), path)


def write_scene_page(channels: Channels, run: SceneRun, engine: str, path: Path) -> None:
    """The same of a move file with a machine."""
    write_data(channels.name, scene_data(channels, run, engine), path)


def write_data(name: str, data: tuple[dict[str, Any], str], path: Path) -> None:
    """Write a page of facts and edges."""
    facts, edges = data
    # `</` would end the element that holds it.
    text = json.dumps(facts, allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
    body = (
        f'<script type="application/json" id="facts">{text}</script>\n'
        f'<script type="text/plain" id="edges">{edges}</script>\n'
        "<script>openReport();</script>"
    )
    write_text(path, page(name, body))


def source_of(scripts: tuple[str, ...]) -> str:
    """The text of scripts."""
    return "\n".join((FOLDER / name).read_text(encoding="utf-8") for name in scripts)


def page(title: str, body: str) -> str:
    """A page with the styles and scripts in it; `body` comes last."""
    notice, styles, library = ((FOLDER / name).read_text(encoding="utf-8") for name in UPLOT)
    return (
        SHELL.read_text(encoding="utf-8")
        .replace("<!-- title -->", html.escape(title))
        .replace("/* styles */", styles + (FOLDER / "page.css").read_text(encoding="utf-8"))
        .replace("/* scripts */", f"/*\nuPlot: {notice}*/\n{library}\n{source_of(SCRIPTS)}")
        .replace("<!-- body -->", body)
    )
