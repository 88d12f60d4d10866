# SPDX-License-Identifier: MIT
"""What a newcomer does after `make demo`: all else in README and tutorial, then a part in the browser.

    python -m benchmarks.hour SECONDS PROCESSOR MEGABYTES

The arguments are what `make demo` took, by the clock and of the processor; tools/first_hour.sh calls this in
a fresh clone. Writes build/first_hour/hour.json and page.png.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from passo.cli import main as passo
from passo.console import stages
from passo.ending import ended
from passo.failure import Failure
from passo.output import check_results, make_folder, write_json
from passo.toolchain import paths

from tests.helpers.browser import Browser
from tests.helpers.shown_commands import TUTORIAL, run, shown

OUT = paths.build / "first_hour"
PAGE = paths.build / "web" / "index.html"
GCODE = paths.examples / "gcode"
README = paths.root / "README.md"


def commands() -> list[str]:
    """Run what README and tutorial show, but for `make demo`. Raises Failure."""
    done = ["make demo"]
    for one in shown((README, TUTORIAL)):
        if one.command in done:
            continue
        with tempfile.TemporaryDirectory() as folder:
            if one.words[0] == "make":
                ended = subprocess.run(one.words, cwd=paths.root, capture_output=True, text=True)
            else:
                ended = run(one, Path(folder))
        if ended.returncode:
            raise Failure(f"{one}: {ended.stdout}{ended.stderr}")
        done.append(one.command)
    return done


def steps_of_command(folder: Path) -> list[int]:
    """Steps of each motor in the example part, as `passo run` writes them."""
    words = ["run", GCODE / "part.nc", "--machine", GCODE / "machine.toml", "--out", folder]
    if passo([str(word) for word in words]):
        raise Failure("the example part is not played")
    axes = np.loadtxt(folder / "pulses.csv", delimiter=",", skiprows=1, usecols=1, dtype=int)
    return [int(count) for count in np.bincount(axes)]


def look(page: Path, picture: Path) -> list[int]:
    """Play the example part on the page, as a person does; steps of each motor. Raises Failure."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder, Browser(Path(folder)) as browser:
        browser.open(page.as_uri(), "web && web.done")
        browser.value(
            "(select => { select.value = 'a part in G-code'; select.dispatchEvent(new Event('change')); })"
            "(document.getElementById('example'))"
        )
        browser.wait("web.done > 1 && passo && passo.view.isDrawn", 300)
        verdict = browser.value("document.getElementById('verdict').textContent")
        if verdict != "done":
            raise Failure(f"the page says: {verdict}")
        browser.value("document.getElementById('charts').scrollIntoView()")
        make_folder(picture.parent)
        browser.picture(picture)
        return list(browser.value("passo.motion.axes.map(axis => axis.rises.length)"))


def hour(seconds: int, processor: int, megabytes: int) -> dict[str, Any]:
    """All of it; what was done. Raises Failure."""
    tell = stages()
    done = commands()
    tell(f"{len(done)} commands of README and tutorial")
    subprocess.run(["tools/setup.sh", "web", "browser"], cwd=paths.root, check=True)
    seen = look(PAGE, OUT / "page.png")
    with tempfile.TemporaryDirectory() as folder:
        made = steps_of_command(Path(folder))
    if seen != made:
        raise Failure(f"the page shows {seen} steps, the command makes {made}")
    tell(f"the part in the browser: {sum(seen):,} steps, those of the command")
    return {
        "seconds": seconds,
        "processor": processor,
        "megabytes": megabytes,
        "commands": len(done),
        "steps": sum(seen),
    }


def main() -> int:
    """Of the command."""
    check_results(OUT / "hour.json")
    found = hour(*map(int, sys.argv[1:4]))
    make_folder(OUT)
    write_json(found, OUT / "hour.json")
    print(json.dumps(found))
    return 0


if __name__ == "__main__":
    sys.exit(ended(main))
