# SPDX-License-Identifier: MIT
"""The move forms for move files."""

from textwrap import wrap

from moves.schema import CLOCK, GENERATED, Form, Key, Schema

WIDTH = 110

HEAD = f'''\
# SPDX-License-Identifier: MIT
# {GENERATED}
"""Move forms: their keys, how values are converted, and the limits of values."""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from passo.form_table import Form, Key, Place, Points, Rule, Shaper
from passo.registers import Shape
'''


def _call(prefix: str, cells: list[str], indent: int, suffix: str = "") -> list[str]:
    """A call, wrapped the way the formatter does it."""
    blanks = " " * indent
    if len(line := f"{blanks}{prefix}({', '.join(cells)}){suffix}") <= WIDTH:
        return [line]
    if len(line := f"{blanks}    {', '.join(cells)}") <= WIDTH:
        return [f"{blanks}{prefix}(", line, f"{blanks}){suffix}"]
    return [f"{blanks}{prefix}(", *(f"{blanks}    {cell}," for cell in cells), f"{blanks}){suffix}"]


def _quoted(text: str) -> str:
    return f'"{text}"'


def _key(schema: Schema, key: Key) -> list[str]:
    member = _quoted(key.member) if key.kind.c else "None"
    cells = [_quoted(key.name), _quoted(key.kind.name), member]
    if key.kind.factor:
        factor = _quoted(CLOCK) if key.kind.factor == CLOCK else key.kind.factor.upper()
        cells.append(f"factor={factor}")
    if key.default is not None:
        literal = key.default.isdigit() or key.kind.name == "flag"
        cells.append(f"default={key.default if literal else _quoted(key.default)}")
    if key.kind.name == "whole":
        low, high = (end.upper() if isinstance(end, str) else str(end) for end in key.range)
        cells += [f"low={low}", f"high={high}"]
    if key.choices:
        cells.append(f"choices=({', '.join(map(_quoted, key.choices))})")
    if key.file_only:
        cells.append("file_only=True")
    if _may_miss(key):
        cells.append("optional=True")
    return _call("Key", cells, 12, ",")


def _may_miss(key: Key) -> bool:
    """Its value is None then; some kinds know what stands for it."""
    return key.optional and key.kind.name not in ("table", "shaper", "axes")


def _form(schema: Schema, form: Form) -> list[str]:
    lines = [f'    "{form.name}": Form(', f'        "{form.name}",', "        ("]
    for key in form.keys:
        lines += _key(schema, key)
    lines.append("        ),")
    rules = [[_quoted(rule.kind), _quoted(rule.key), _quoted(rule.other)] for rule in form.rules]
    if len(rules) == 1:
        lines += _call("(Rule", rules[0], 8, ",),")
    elif rules:
        lines.append("        (")
        for cells in rules:
            lines += _call("Rule", cells, 12, ",")
        lines.append("        ),")
    if form.told_by:
        lines.append(f'        told_by="{form.told_by}",')
    return [*lines, "    ),"]


PREFIXES = {"task": "Move", "event": "Event", "machine": "Machine"}


def _class(form: Form, prefix: str = "Move", table: str = "FORMS") -> list[str]:
    """The dataclass with the parameters of a form."""
    name = prefix + form.name.title().replace("_", "")
    lines = ["", "", "@dataclass(frozen=True)", f"class {name}:", f'    """{form.summary}"""', ""]
    for key in sorted(form.keys, key=lambda key: key.trails):
        missing = "()" if key.kind.name == "table" else "None"
        default = f" = {key.default or missing}" if key.trails else ""
        optional = " | None" if _may_miss(key) else ""
        lines.append(f"    {key.name}: {key.kind.python}{optional}{default}")
    lines += ["", f'    form: ClassVar[Form] = {table}["{form.name}"]']
    if form.profile:
        lines.append(f'    profile: ClassVar[str] = "{form.profile}"')
    return lines


def module(schema: Schema) -> str:
    """sim/passo/move_forms.py"""
    lines = [HEAD]
    for constant in schema.constants.values():
        if constant.c_only:
            continue
        lines += [f"# {line}" for line in wrap(constant.text, 105)]
        lines.append(f"{constant.name.upper()} = {constant.value}")
    names = ", ".join(map(_quoted, schema.profiles))
    lines += ["", f"PROFILES = ({names})", f'USER = "{schema.user_name}"  # the profile given by a table']
    lines.append(f'SHAPED = "{schema.shaped_name}"  # the profile given by an input shaper')
    lines += [f"USER_BANK = Shape.{schema.user_bank.upper()}  # the bank of that table", ""]
    lines.append("FORMS = {")
    for form in schema.forms:
        lines += _form(schema, form)
    lines.append("}")
    for group, forms in schema.others.items():
        lines += ["", f"{group.upper()}S = {{"]
        for form in forms:
            lines += _form(schema, form)
        lines.append("}")
    for form in schema.forms:
        lines += _class(form)
    for group, forms in schema.others.items():
        for form in forms:
            lines += _class(form, PREFIXES[group], f"{group.upper()}S")
    return "\n".join([*lines, ""])
