# SPDX-License-Identifier: MIT
"""In the page of `make web` this is passo.expanding: what the worker calls."""

import json
from pathlib import Path

from passo.expand.expander import Options, expand_file
from passo.expand.place import ExpandError
from passo.expand.tools import read_tools
from passo.failure import BadInputError
from passo.gcode import GcodeSettings

PROGRAM, TOOLS = Path("program"), Path("tool table")


def expand(text: str, settings: str, tools: str) -> str:
    """A program on a machine at 0: its plain lines, where each is from, and the texts of PRINT, as JSON.

    `settings`: those of GcodeSettings, as JSON; `tools`: a table. Of what cannot be expanded: what is wrong.
    """
    said: list[str] = []
    TOOLS.write_text(tools, encoding="utf-8")
    try:
        options = Options(GcodeSettings(**json.loads(settings)), read_tools(TOOLS), at_zero=True)
        lines = expand_file(PROGRAM, options, said.append, text.encode("utf-8", "replace"))
    except ExpandError as error:
        place = f"line {error.place.line}" if error.place.path == PROGRAM else error.place
        return json.dumps({"said": said, "wrong": f"{place}: {error.reason}"})
    except BadInputError as error:
        return json.dumps({"said": said, "wrong": str(error)})
    return json.dumps(
        {"said": said, "lines": [line.text for line in lines], "places": [line.place.line for line in lines]}
    )
