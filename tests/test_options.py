# SPDX-License-Identifier: MIT
"""The options of all commands that take numbers: each value out of their range is refused by their name."""

import argparse
import sys
from io import StringIO
from pathlib import Path

import pytest
from passo import cli
from passo.toolchain import paths

MACHINE = str(paths.examples / "gcode" / "machine.toml")
PART = str(paths.examples / "gcode" / "part.nc")
# Arguments with which a command is good but for the option.
COMMANDS: dict[str, list[str]] = {
    "run": [PART, "--machine", MACHINE],
    "preview": [PART, "--machine", MACHINE],
    "expand": [PART],
    "heightmap": ["--probe", "0,0,20,10"],
    "console": ["--inputs", "--encoders", "--trackers"],
    "serve": ["socket"],
    "firmware": ["--table", "--grbl"],
    "campaign": ["--moves", "1", "--seed", "1", "--jobs", "1"],
}
LONG, LONGER = 30 * "9", 5000 * "9"
VALUES = ("nan", "inf", "-inf", "1e400", "-1e400", "-5", "0", "1e-6", "0x10", "1,5", "", "x", LONG, LONGER)
GOOD = {  # of these options some of them are
    "--seed": ("-5", "0", LONG),
    "--first": ("0",),
    "--to": (LONG,),
    "--depth": ("0", "1e-6"),
    "--tracked": ("0",),
    "--inputs": ("0", "1,5", ""),
}
# A number within a text, in its place; what is good there. Others are words, files and formulas.
TEXTS: dict[tuple[str, str], dict[str, tuple[str, ...]]] = {
    ("heightmap", "--probe"): {"{},0,500,10": ("0", "-5", "1e-6"), "0,-20,20,{}": ("0", "-5", "1e-6")},
    ("console", "--switch"): {"home:{}:..5": ("0",), "home:0:{}..": ("0", "-5")},
    ("console", "--encoder"): {"{}:4": ("0",), "0:{}": ()},
    ("console", "--spindle"): {"{}:600:4000": ("0",), "0:{}:4000": (), "0:600:{}": ()},
    ("run", "--waves"): {"{}": ("1e-6",), "{}..{}": (), "1ms..{}": ()},
}
TEXTS |= {
    (command, "--inputs"): {"{}": GOOD["--inputs"], "1,{}": (*GOOD["--inputs"], "0")}
    for command in ("run", "preview", "expand", "heightmap")
}
WORDS = {"--formula", "--engine", "--scheduler", "--origin"}


def subcommands() -> dict[str, argparse.ArgumentParser]:
    (found,) = (action for action in cli._parser()._actions if isinstance(action, argparse._SubParsersAction))
    return found.choices


def options() -> list[tuple[str, argparse.Action]]:
    return [
        (command, action)
        for command, parser in subcommands().items()
        for action in parser._actions
        if action.option_strings and action.nargs != 0 and action.type is not Path
    ]


def cases() -> list[tuple[str, str, str]]:
    """Command, option, value."""
    found = []
    for command, action in options():
        option = action.option_strings[-1]
        if forms := TEXTS.get((command, option)):
            for form, good in forms.items():
                found += [(command, option, form.replace("{}", bad)) for bad in VALUES if bad not in good]
        elif action.type:
            found += [(command, option, bad) for bad in VALUES if bad not in GOOD.get(option, ())]
    return found


def test_all_options_are_known() -> None:
    """A new one with a text says what numbers are in it, if any."""
    bare = {
        (command, option)
        for command, action in options()
        if not action.type and (option := action.option_strings[-1]) not in WORDS
    }
    assert bare <= set(TEXTS)


@pytest.mark.parametrize(("command", "option", "value"), cases())
def test_a_number_out_of_range(
    command: str,
    option: str,
    value: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The last line has its name; nothing is built, played or written."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "stdin", StringIO())
    try:
        status: object = cli.main([command, *COMMANDS[command], f"{option}={value}"])
    except SystemExit as ended:  # of argparse
        status = ended.code
    said = capsys.readouterr()
    last = said.err.splitlines()[-1]
    assert status == 2 and not said.out
    assert option in last or (option == "--from" and f"there is no line {value}" in last)
    assert not list(tmp_path.iterdir())
