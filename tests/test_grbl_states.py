# SPDX-License-Identifier: MIT
"""The states of the controller: the table of docs/gcode.md is that of the code."""

import re
from typing import Any

from passo.native import ffi, planner
from passo.toolchain import paths

TOUCH = "Tool, `0xA3`"
STATES = ("Home", "Sleep", "Alarm", "Door", "Hold", "Tool", TOUCH, "Check", "Jog", "Run", "Idle")
ACTS = {
    "": "NOTHING", "reset": "RESETS", "alarm 6, reset": "FAILS", "hold": "HOLDS", "door": "OPENS",
    "known": "ADMITS", "cancel": "CANCELS", "cancel, door": "CLOSES", "alarm 7": "STOPS", "resume": "GOES_ON",
}  # fmt: skip
RESULTS = {"taken": 0, "waits": 0xFF, "8": 8, "9": 9}


def table(first: str) -> dict[str, list[str]]:
    """The rows of a table of the page, by their state."""
    page = (paths.docs / "gcode.md").read_text(encoding="utf-8")
    (found,) = re.findall(rf"^\| {first} \|.*\n\|---.*\n((?:\|.*\n)+)", page, re.M)
    rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in found.splitlines()]
    return {state: cells for state, *cells in rows}


def states() -> list[tuple[str, Any]]:
    """Names and numbers, in the order in which they apply."""
    c = planner()
    assert len(STATES) == c.PASSO_GRBL_STATES
    names = ["TOUCH" if name == TOUCH else name.upper() for name in STATES]
    numbers = [getattr(c, f"PASSO_GRBL_STATE_{name}") for name in names]
    named = list(zip(STATES, numbers, strict=True))
    told = [ffi().string(c.passo_grbl_state_name(number)).decode() for _, number in named]
    assert told == ["Tool" if name == TOUCH else name for name in STATES]
    return named


def test_lines() -> None:
    rows = table("line")
    assert tuple(rows) == STATES
    for name, number in states():
        found = [planner().passo_grbl_line_rule(number, kind) for kind in range(planner().PASSO_GRBL_KINDS)]
        assert found == [RESULTS[cell] for cell in rows[name]], name


def test_requests() -> None:
    c, rows = planner(), table("request")
    assert tuple(rows) == STATES
    for name, number in states():
        found = [c.passo_grbl_request_rule(number, ask) for ask in range(c.PASSO_GRBL_ASK_REPORT)]
        assert found == [getattr(c, f"PASSO_GRBL_ACT_{ACTS[cell]}") for cell in rows[name]], name
        assert c.passo_grbl_request_rule(number, c.PASSO_GRBL_ASK_REPORT) == c.PASSO_GRBL_ACT_REPORTS
