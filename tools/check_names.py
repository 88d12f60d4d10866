# SPDX-License-Identifier: MIT
"""Refuse names that a makefile would ignore: print a sentence about the first one, or nothing.

    tools/check_names.py variables MAKEFILE "GOALS" NAME...      the help of a goal names those that it takes
    tools/check_names.py value NAME VALUE KNOWN...               the value of a variable is one of them
    tools/check_names.py definitions HEADER "-DNAME=VALUE ..."   the header has `#ifndef NAME` for each

Variables PASSO_... are those of the environment of the tests.
"""

import re
import sys
from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path


def unknown(kind: str, name: str, known: Sequence[str]) -> str:
    """A sentence with the nearest known name, or with all of them."""
    near = get_close_matches(name.upper(), known, 1)
    hint = f"did you mean {near[0]}?" if near else f"must be one of {', '.join(known)}"
    return f"unknown {kind} {name}; {hint}" if known else f"unknown {kind} {name}: it takes none"


def of_goals(makefile: str, goals: Sequence[str]) -> list[str]:
    """The variables that the help of these goals names."""
    helps = dict(re.findall(r"^([a-z-]+):.*?## (.*)$", makefile, re.M))
    return sorted({name for goal in goals for name in re.findall(r"(?<!-)\b([A-Z]+)=", helps.get(goal, ""))})


def refused_variable(makefile: str, goals: Sequence[str], given: Sequence[str]) -> str:
    """About the first variable that the goals do not take."""
    known = of_goals(makefile, goals)
    wrong = [name for name in given if name not in known and not name.startswith("PASSO_")]
    return f"make {' '.join(goals)}: {unknown('variable', min(wrong), known)}" if wrong else ""


def refused_definition(header: str, definitions: str) -> str:
    """About the first definition that the header does not have."""
    known = sorted(name for name in re.findall(r"^#ifndef (\w+)$", header, re.M) if not name.endswith("_H"))
    for word in definitions.split():
        found = re.fullmatch(r"-D(\w+)(?:=\S*)?", word)
        if not found:
            return f"MACHINE has {word}, which is not of the form -DNAME=VALUE"
        if found[1] not in known:
            return f"MACHINE: {unknown('definition', found[1], known)}"
    return ""


def refused_value(variable: str, value: str, known: Sequence[str]) -> str:
    """About a value that is none of the known ones."""
    allowed = ", ".join(known)
    return "" if value in known else f"unknown value of {variable}: {value}; must be one of {allowed}"


def main(arguments: Sequence[str]) -> None:
    kind, place, first, *given = arguments
    if kind == "value":
        print(refused_value(place, first, given))
        return
    text = Path(place).read_text(encoding="utf-8")
    if kind == "variables":
        print(refused_variable(text, first.split(), given))
    else:
        print(refused_definition(text, first))


if __name__ == "__main__":
    main(sys.argv[1:])
