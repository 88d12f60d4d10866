# SPDX-License-Identifier: MIT
"""Programs with parameters, O words and cutter compensation: expanded, then on Passo's interpreter."""

import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from passo.expand.expander import Options, expand_file
from passo.expand.place import ExpandError
from passo.expand.tools import Tool
from passo.gcode import GcodeSettings
from passo.output import write_text

from benchmarks.gcode_contours import contour_program
from benchmarks.gcode_corpus import contours, corpus
from benchmarks.gcode_language import language_program
from benchmarks.gcode_motion import Played, verdict
from benchmarks.gcode_passo import SPEEDS, Passo
from benchmarks.gcode_rs274 import INCH, TOOLS, play_rs274

OPTIONS = Options(
    GcodeSettings(axes=6, spindle_maximum=SPEEDS, turn_counts=1000),
    {tool: Tool(tool, tool / 100 * INCH) for tool in range(1, TOOLS)},
    at_zero=True,
    limit=20_000,
)
# What rs274 refuses in some cases only: before an arc it may go back and cut the contour, and it bends an arc
# that cannot touch the tool at its beginning the other way.
STRICTER = ("would cut the contour", "has no center with this tool")


def play_expanded(program: Sequence[str], options: Options = OPTIONS) -> Played:
    """The motions of a program, labelled with its lines, and the line at which it is refused."""
    passo = Passo(options.gcode.axes)
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "part.ngc"
        write_text(path, "\n".join([*program, ""]))
        try:
            lines = expand_file(path, options)
        except ExpandError as error:
            return Played([], error.place.line, error.reason)
    for line in lines:
        made = len(passo.motions)
        passo.execute(line.text)
        passo.motions[made:] = [replace(motion, label=line.place.line) for motion in passo.motions[made:]]
    return Played(passo.motions)


def _judge_expanded(program: Sequence[str], ours: Played) -> str:
    if ours.why.startswith("endless"):
        return ""  # rs274 would go on
    theirs = play_rs274(program)
    if ours.refused and theirs.refused:  # ours was not played
        return "" if ours.refused == theirs.refused else f"refused: {ours} {theirs}"
    return verdict(ours, theirs)


def _judge_contour(program: Sequence[str], ours: Played) -> str:
    theirs = play_rs274(program)
    if ours.refused and (theirs.refused or any(reason in ours.why for reason in STRICTER)):
        return ""
    return verdict(
        *(Played([replace(m, label=1) for m in p.motions], min(p.refused, 2), p.why) for p in (ours, theirs))
    )


def compare_expanded(program: Sequence[str]) -> str:
    """What an expanded program and rs274 do that is not the same."""
    return _judge_expanded(program, play_expanded(program))


def compare_contour(program: Sequence[str]) -> str:
    """The same with cutter compensation, where rs274 names a motion, and what it refuses, by a later line."""
    return _judge_contour(program, play_expanded(program))


# Name, generator and judge of programs with parameters and O words, and with cutter compensation.
KINDS = (
    ("programs", language_program, _judge_expanded),
    ("contours", contour_program, _judge_contour),
)
CORPORA = (("programs", corpus, _judge_expanded), ("contours", contours, _judge_contour))
