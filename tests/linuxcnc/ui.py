#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The user of a headless LinuxCNC: switches on, homes, runs program.ngc, writes result.json."""

import importlib
import json
import os
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

LIMIT = float(os.environ["SECONDS_MAX"])  # of homing, and of the program
ARRIVED = 1e-6  # mm; programs end where all axes have a whole step
LOOK = 0.01
SETTLED = 20  # looks at rest

linuxcnc: Any = importlib.import_module("linuxcnc")


class User:
    """Commands, and what LinuxCNC says to them."""

    def __init__(self) -> None:
        """Connect."""
        self.command, self.stat, self.errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
        self.said: list[str] = []
        self.joints = 0

    def look(self) -> None:
        """Read state and messages."""
        self.stat.poll()
        message = self.errors.poll()
        while message:
            self.said.append(str(message[1]))
            message = self.errors.poll()

    def wait(self, condition: Callable[[], bool]) -> bool:
        """Until a condition holds, or something is said."""
        end = time.monotonic() + LIMIT
        while time.monotonic() < end and not self.said:
            self.look()
            if condition():
                return True
            time.sleep(LOOK)
        return False

    def do(self, call: str, *arguments: Any) -> None:
        """A command, to its end."""
        getattr(self.command, call)(*arguments)
        self.command.wait_complete(LIMIT)

    def at_rest(self) -> bool:
        """The program has ended, and all joints are where they are commanded, for some looks."""
        for _ in range(SETTLED):
            self.look()
            joints = self.stat.joint[: self.stat.joints]
            if self.stat.interp_state != linuxcnc.INTERP_IDLE or any(abs(j["velocity"]) > 0 for j in joints):
                return False
            if any(abs(j["ferror_current"]) > ARRIVED for j in joints):
                return False
            time.sleep(LOOK)
        return True


def pins() -> dict[str, str]:
    """All pins of the component and their values."""
    shown = subprocess.run(["halcmd", "-s", "show", "pin", "passo"], capture_output=True, text=True)
    rows = [line.split() for line in shown.stdout.splitlines() if line.strip()]
    return {row[4]: row[3] for row in rows}


def run() -> dict[str, Any]:
    """What became of it."""
    user = User()
    user.do("state", linuxcnc.STATE_ESTOP_RESET)
    user.do("state", linuxcnc.STATE_ON)
    user.do("mode", linuxcnc.MODE_MANUAL)
    user.do("teleop_enable", 0)
    user.command.home(-1)
    homed = user.wait(lambda: all(user.stat.homed[: user.stat.joints]))
    ended = False
    if homed:
        user.do("mode", linuxcnc.MODE_AUTO)
        user.command.program_open(str(Path("program.ngc").resolve()))
        user.do("auto", linuxcnc.AUTO_RUN, 0)
        ended = user.wait(user.at_rest)
    user.look()
    joints = user.stat.joint[: user.stat.joints]
    return {
        "homed": homed,
        "ended": ended,
        "said": user.said,
        "positions": user.stat.joint_actual_position[: user.stat.joints],
        "ferror": [joint["ferror_highmark"] for joint in joints],
        "pins": pins(),
    }


if __name__ == "__main__":
    Path("result.json").write_text(json.dumps(run()))
