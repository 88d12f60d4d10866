# SPDX-License-Identifier: MIT
"""`passo preview PART.nc`: how long a part takes, where it goes, and what binds it, without its pulses."""

import base64
import html
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from passo.console import progress
from passo.course import Course
from passo.expand.tools import read_tools
from passo.output import check_folder, empty_folder, write_json, write_text
from passo.part import TIMEOUT, Lines, Part, plan_part, read_part
from passo.part_command import machine_of, say_unread, surface_of
from passo.path import LOOK_AHEAD
from passo.toolchain import paths

SUMMARY, PICTURE, PAGE = "preview.json", "preview.png", "preview.html"
SHOWN = 4  # of what binds a part
STYLE = (
    "body{font-family:sans-serif;margin:2em auto;max-width:75em}"
    "td,th{padding:.1em 1em .1em 0;text-align:left}img{max-width:100%}"
)


def run_preview(
    files: Sequence[Path],
    machine_path: Path | None,
    tools: Path | None = None,
    out: Path | None = None,
    look_ahead: int = LOOK_AHEAD,
    only: Lines | None = None,
    inputs: int | None = None,
    surface: Path | None = None,
) -> bool:
    """Plan a part and say what is found; return whether all of it can be played.

    Ctrl-C ends it: KeyboardInterrupt, once the results up to then are written.
    """
    check_folder(out or paths.results, "--out")
    machine = machine_of(files, machine_path, inputs)
    part = read_part(files, machine, read_tools(tools), only, surface_of(surface))
    with progress(part.path.name, len(part.lines)) as report:
        planned = plan_part(part, machine, look_ahead, report)
    course = Course(planned, part.begin.place)
    out = out or paths.results / "run" / part.name
    empty_folder(out, (SUMMARY, PICTURE, PAGE))
    facts = summary_of(part, course, look_ahead)
    write_json(facts, out / SUMMARY)
    from passo.part_plot import plot_course

    plot_course(part, course, out / PICTURE)
    write_text(out / PAGE, _page(facts, (out / PICTURE).read_bytes()))
    for problem in facts["problems"]:
        print(f"{part.path}: {problem}", file=sys.stderr)
    say_unread(part)
    if not course.motions and planned.ended:
        print(f"{part.path}: nothing moved", file=sys.stderr)
    print(f"{part.path.name}: {len(part.lines)} lines, {part.chords} chords in {course.seconds:.6g} s")
    for line in _said(facts):
        print(line)
    print(f"results: {', '.join(str(out / name) for name in (SUMMARY, PICTURE, PAGE))}")
    if planned.canceled:
        raise KeyboardInterrupt
    return not facts["problems"]


def summary_of(part: Part, course: Course, look_ahead: int) -> dict[str, Any]:
    """The contents of preview.json."""
    planned = course.planned
    limits = dict(zip(course.machine.limited, course.machine.settings.limits(), strict=True))
    return {
        "name": part.name,
        "ok": not (problems := _problems(part, course)),
        "problems": problems,
        "look_ahead": look_ahead,
        "path_seconds": course.seconds,
        "lines": len(part.lines),
        "unread_lines": part.unread,
        "chords": part.chords,
        "path_lines": len(planned.lines),
        "ramps": len(planned.ramps),
        "motions": course.motions,
        "extent": course.extent(),
        "speeds": {
            name: {"highest": speed, "limit": float(limits[name][1].speed) if name in limits else None}
            for name, speed in course.speeds().items()
        },
        "bound_seconds": course.bound(),
        "tools": course.tools(),
        "levels": course.levels(),
    }


def _problems(part: Part, course: Course) -> list[str]:
    """Why it cannot be played, or not all of it is planned."""
    planned = course.planned
    found = [
        f"{part.places[one.line]}: {one.why(part.lines[one.line], course.machine.gcode)}"
        for one in planned.refused
    ]
    if planned.dry:
        found.append("the core would run out of ramps")
    if not planned.ended:
        last = part.places[max(planned.taken, 1) - 1]
        found.append(f"{'canceled at' if planned.canceled else TIMEOUT} {last}")
    return found


def _said(facts: dict[str, Any]) -> list[str]:
    """What the command prints of it."""
    extent = ", ".join(f"{name} {low:.6g} to {high:.6g}" for name, (low, high) in facts["extent"].items())
    speeds = [f"{name} {_speed(own)}" for name, own in facts["speeds"].items()]
    bound = [
        f"{name} {seconds / facts['path_seconds']:.0%}" for name, seconds in facts["bound_seconds"].items()
    ]
    feed, rapid = (sum(tool[key] for tool in facts["tools"]) for key in ("feed_mm", "rapid_mm"))
    lines = [f"extent in mm: {extent}"]
    if bound:
        lines.append(f"highest speeds in mm/s: {', '.join(speeds)}")
        lines.append(f"bound by: {', '.join(bound[:SHOWN])}")
        lines.append(f"{feed:.6g} mm at a feed, {rapid:.6g} mm of rapids")
    if len(facts["tools"]) > 1:
        lines += [
            f"T{tool['tool']}: {tool['feed_seconds']:.6g} s at a feed, "
            f"{tool['rapid_seconds']:.6g} s of rapids"
            for tool in facts["tools"]
        ]
    return lines


def _speed(own: dict[str, float]) -> str:
    return f"{own['highest']:.4g}" + (f" of {own['limit']:.6g}" if own["limit"] else "")


def _page(facts: dict[str, Any], picture: bytes) -> str:
    """All of it as one file."""
    tables = [
        ("", ["", ""], [["seconds", f"{facts['path_seconds']:.6g}"], ["lines", facts["lines"]]]),
        ("Extent", ["axis", "from [mm]", "to [mm]"], [[k, *v] for k, v in facts["extent"].items()]),
        (
            "Speeds",
            ["", "highest [mm/s]", "limit"],
            [[k, v["highest"], v["limit"] or ""] for k, v in facts["speeds"].items()],
        ),
        ("Bound by", ["limit", "seconds"], [[k, v] for k, v in facts["bound_seconds"].items()]),
        *(
            (title, list(rows[0]), [list(row.values()) for row in rows])
            for title, rows in (("Tools", facts["tools"]), ("Levels of Z", facts["levels"]))
            if rows
        ),
        *((("Problems", [""], [[text] for text in facts["problems"]]),) if facts["problems"] else ()),
    ]
    title = html.escape(facts["name"])
    data = base64.b64encode(picture).decode()
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{title}</title><style>{STYLE}</style>'
        f"<h1>{title}</h1>{''.join(_table(*table) for table in tables)}"
        f'<img alt="tool path, speed, share of the limits" src="data:image/png;base64,{data}"></html>\n'
    )


def _table(title: str, head: list[str], rows: list[list[Any]]) -> str:
    def row(tag: str, cells: list[Any]) -> str:
        shown = (f"{cell:.6g}" if isinstance(cell, float) else str(cell) for cell in cells)
        return f"<tr>{''.join(f'<{tag}>{html.escape(cell)}</{tag}>' for cell in shown)}</tr>"

    body = row("th", head) + "".join(row("td", own) for own in rows)
    return f"<h2>{html.escape(title)}</h2><table>{body}</table>"
