# SPDX-License-Identifier: MIT
"""In the page of `make web` this is passo.expanding: what the worker calls."""

import json
import os
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from passo.expand.expander import Options, expand_file
from passo.expand.follow import follow
from passo.expand.height_map import read_height_map
from passo.expand.output import PlainLine
from passo.expand.place import ExpandError, Place, listed
from passo.expand.tools import read_tools
from passo.failure import BadInputError
from passo.gcode import GcodeSettings
from passo.native import ffi

FOLDER, TOOLS, MAP = Path("/programs"), Path("tool table"), Path("height map")


def expand(
    name: str, files: str, settings: str, tools: str, begin: int, height_map: str = "", follows: bool = False
) -> str:
    """A program on a machine: its plain lines, where each is from, and the texts of PRINT, as JSON.

    `files`: name and text of it and of those beside it, as JSON; `settings`: those of GcodeSettings; `tools`:
    a table; `begin`: place of a `struct passo_gcode` behind another program, or 0: the machine is at 0;
    `height_map`: one that probes touch, or that Z follows, or nothing. Of what cannot be expanded: what is
    wrong, and the lines of the rest.
    """
    said: list[str] = []
    os.chdir("/")
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir()
    os.chdir(FOLDER)
    TOOLS.write_text(tools, encoding="utf-8")
    MAP.write_text(height_map, encoding="utf-8")
    found: dict[str, str] = json.loads(files)
    for other, text in found.items():
        Path(other).write_bytes(text.encode("utf-8", "replace"))

    def told(place: Place) -> str:
        return f"line {place.line}" if place.path == path and len(found) == 1 else str(place)

    path = Path(name)
    gcode: Any = ffi().at("struct passo_gcode", begin) if begin else None
    try:
        found_map = read_height_map(MAP) if height_map else None
        gcode_settings, surface = GcodeSettings(**json.loads(settings)), None if follows else found_map
        options = Options(gcode_settings, read_tools(TOOLS), at_zero=True, surface=surface, begin=gcode)
        lines = expand_file(path, options, said.append)
        if found_map and follows:
            lines = follow(lines, found_map, options)
    except ExpandError as error:
        wrong = "\n".join(listed([f"{told(one.place)}: {one.reason}" for one in error.each]))
        return json.dumps({"said": said, "wrong": wrong, **_plain(error.lines, told)})
    except BadInputError as error:
        return json.dumps({"said": said, "wrong": str(error)})
    return json.dumps({"said": said, **_plain(lines, told)})


def _plain(lines: Sequence[PlainLine], told: Callable[[Place], str]) -> dict[str, list[str]]:
    return {"lines": [line.text for line in lines], "places": [told(line.place) for line in lines]}
