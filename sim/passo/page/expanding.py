# SPDX-License-Identifier: MIT
"""In the page of `make web` this is passo.expanding: what the worker calls."""

import json
from pathlib import Path

from passo.expand.expander import Options, expand_file
from passo.expand.place import ExpandError
from passo.failure import BadInputError
from passo.gcode import GcodeSettings

PROGRAM = Path("program")


def expand(text: str, settings: str) -> str:
    """A program on a machine at 0, without tools: its plain lines, where each is from, and the texts of PRINT, as JSON.

    `settings`: those of GcodeSettings, as JSON. Of a program that cannot be expanded: what is wrong.
    """
    said: list[str] = []
    options = Options(GcodeSettings(**json.loads(settings)), at_zero=True)
    try:
        lines = expand_file(PROGRAM, options, said.append, text.encode("utf-8", "replace"))
    except BadInputError as error:
        wrong = f"line {error.place.line}: {error.reason}" if isinstance(error, ExpandError) else str(error)
        return json.dumps({"said": said, "wrong": wrong})
    return json.dumps(
        {"said": said, "lines": [line.text for line in lines], "places": [line.place.line for line in lines]}
    )
