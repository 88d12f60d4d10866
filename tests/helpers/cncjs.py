# SPDX-License-Identifier: MIT
"""The controller of cncjs for grbl, at a pseudo-terminal; `tools/setup.sh cncjs` installs it."""

import json
import os
import shutil
import subprocess
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from passo.toolchain import paths

SCRIPT = paths.tests / "cncjs" / "controller.js"
MODULES = paths.root / ".venv" / "cncjs" / "node_modules"
MISSING = "" if shutil.which("node") and (MODULES / "cncjs").is_dir() else "no Node.js with npm: no cncjs"
REPORTS = 1.0  # seconds: cncjs asks four times in each


class Cncjs:
    """The controller, and what it tells the web pages of cncjs."""

    def __init__(self, link: Path, patience: float) -> None:
        self.patience = patience
        self.lines: list[str] = []  # of its console: what the controller said, explained
        self.last: dict[str, list[Any]] = {}  # event: what came with it
        self._node = subprocess.Popen(
            ["node", SCRIPT, link],
            env={**os.environ, "NODE_PATH": str(MODULES), "NODE_ENV": "production"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        for line in self._node.stdout or ():
            if line.startswith("["):
                event, *data = json.loads(line)
                self.last[event] = data
                if event == "serialport:read":
                    self.lines.append(data[0])

    def close(self) -> None:
        """Close the port."""
        if self._node.stdin:
            self._node.stdin.close()
        self._node.wait(self.patience)
        self._reader.join()

    def command(self, *words: Any) -> None:
        """A command of its web pages."""
        assert self._node.stdin
        self._node.stdin.write(json.dumps(words) + "\n")
        self._node.stdin.flush()

    def send(self, *lines: str) -> None:
        """Lines of its console, one after the other; each waits for the answer to the one before."""
        self.command("gcode", lines)

    def until(self, condition: Callable[[], object]) -> None:
        """Wait for a condition."""
        end = time.monotonic() + self.patience
        while not condition():
            assert time.monotonic() < end, (self.last, self.lines[-20:])
            assert self._node.poll() is None, "cncjs has ended"
            time.sleep(0.02)

    def until_state(self, name: str) -> None:
        """Wait for a state of the machine, as last reported; cncjs tells only changes."""
        self.until(lambda: self.status.get("activeState") == name)

    def rest(self) -> list[float]:
        """Wait for the end of a motion, which no state tells; return the machine position."""
        before: list[float] = []
        while before != (before := self.position):
            time.sleep(REPORTS)
        return before

    def until_said(self, text: str, since: int = 0) -> str:
        """Wait for a line of its console that begins so, after the first `since` lines; return it."""
        found: list[str] = []
        self.until(
            lambda: found.extend(line for line in self.lines[since:] if line.startswith(text)) or found
        )
        return found[0]

    @property
    def status(self) -> dict[str, Any]:
        """The last status report: activeState, mpos, wpos, ov, ..."""
        return self._state.get("status", {})

    @property
    def parser(self) -> dict[str, Any]:
        """The last answer to $G."""
        return self._state.get("parserstate", {})

    @property
    def _state(self) -> dict[str, Any]:
        return self.last.get("controller:state", ["Grbl", {}])[1]

    @property
    def position(self) -> list[float]:
        """Machine position, mm."""
        return [float(self.status["mpos"][axis]) for axis in "xyz"]

    @property
    def job(self) -> dict[str, Any]:
        """The job: total, sent, received, hold, holdReason, ..."""
        return self.last.get("sender:status", [{}])[0]
