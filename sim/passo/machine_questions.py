# SPDX-License-Identifier: MIT
"""`passo make` without a file: a few questions, and a machine file with comments."""

from collections.abc import Callable, Sequence
from pathlib import Path

from passo_fpga.boards import Board, board, boards
from passo_fpga.table import BoardError

from passo.drives import drives
from passo.failure import BadInputError
from passo.gcode import AXIS_LETTERS
from passo.make_command import CHIP_AXES, LARGE, SMALL
from passo.output import check_file, write_text
from passo.values import meant

TOOLS = {
    "none": "",
    "spindle": "spindle_maximum = 24000 # rpm of full power\n",
    "laser": "laser = true\nspindle_maximum = 1000 # S of full power\n",
}
NO, YES = "no", "yes"

HEAD = """\
# Made by `passo make`. All keys: docs/gcode.md. Then: passo make {path}
board = "{board}"
drive = "{drive}" # its times of STEP and DIR: sim/passo/drives.toml
{chip}{tool}{switches}"""
SWITCHES = """
[switches]
inverted = false # normally closed to ground, with a pull-up: high is active
"""
AXIS = """
[[axis]]
name = "{name}"
steps_per_mm = {steps} # {unit}: steps per turn of the motor, with microsteps, / travel per turn
speed = {speed} # {unit}/s
acceleration = {acceleration} # {unit}/s^2
travel = {travel} # {unit}
{home}"""
HOME = 'home = "{end}" # the end with the switch\nswitches = ["home"]\n'
KINDS = {  # of axes by their letters
    "XY": {"steps": 80, "speed": 100, "acceleration": 500, "travel": 300, "unit": "mm"},
    "Z": {"steps": 400, "speed": 10, "acceleration": 100, "travel": 80, "unit": "mm"},
    "ABC": {"steps": 20, "speed": 90, "acceleration": 360, "travel": 360, "unit": "degrees"},
}


def ask_machine(path: Path, ask: Callable[[str], str] = input) -> None:
    """Ask for board, drive, switches, tool and number of motors; write the file. Raises BadInputError."""
    if path.exists():
        raise BadInputError(f"{path}: exists already; passo make {path} builds it")
    check_file(path, "passo make:")
    try:
        chosen = board(_choice(ask, "board", tuple(boards())))
        drive = _choice(ask, "drive", tuple(drives()))
        tool = _choice(ask, "tool", tuple(TOOLS)) if "outputs" in chosen.parts else "none"
        switches = "inputs" in chosen.parts and _choice(ask, "home switches", (YES, NO)) == YES
        parts = [part for part, used in (("inputs", switches), ("outputs", tool != "none")) if used]
        most = _most_axes(chosen, parts)
        motors = int(_choice(ask, "motors", tuple(str(count) for count in range(most, 0, -1))))
    except EOFError:
        raise BadInputError("passo make: no answer; nothing was written") from None
    tables = "".join(_axis(letter, switches) for letter in AXIS_LETTERS[:motors])
    head = HEAD.format(
        path=path,
        board=chosen.name,
        drive=drive,
        chip=f'chip = "{LARGE}" # {SMALL} has {CHIP_AXES[SMALL]} axes\n' if motors > CHIP_AXES[SMALL] else "",
        tool=TOOLS[tool],
        switches=SWITCHES if switches else "",
    )
    write_text(path, head + tables)
    print(f"written: {path}. Set steps_per_mm, speed, acceleration and travel there, then: passo make {path}")


def _axis(letter: str, switches: bool) -> str:
    kind = next(facts for letters, facts in KINDS.items() if letter in letters)
    home = HOME.format(end="high" if letter == "Z" else "low") if switches else ""
    return AXIS.format(name=letter, home=home, **kind)


def _most_axes(chosen: Board, parts: Sequence[str]) -> int:
    """Axes that the board has pins for, with these parts."""
    for axes in range(min(chosen.axes, len(AXIS_LETTERS)), 1, -1):
        try:
            chosen.ports(axes, parts)
            return axes
        except BoardError:
            continue
    return 1


def _choice(ask: Callable[[str], str], name: str, known: Sequence[str]) -> str:
    """Ask until the answer is a known one; Enter is the first."""
    while (answer := ask(f"{name} ({', '.join(known)}) [{known[0]}]: ").strip() or known[0]) not in known:
        print(f"{name} must be one of {', '.join(known)}, not {answer!r}{meant(answer, tuple(known))}")
    return answer
