# SPDX-License-Identifier: MIT
"""The move forms in C: limits, structs and the tables of the console."""

from collections.abc import Iterable
from textwrap import wrap

from generated import aligned

from moves.schema import CLOCK, GENERATED, Constant, Form, Key, Schema


def _comment(text: str) -> str:
    return "/* " + "\n * ".join(wrap(text, 105)) + " */"


def _head(*about: str) -> list[str]:
    return ["/* SPDX-License-Identifier: MIT", f" * {GENERATED}", " *", *(f" * {a}" for a in about), " */"]


def _guarded(name: str, about: str, lines: Iterable[str]) -> str:
    return "\n".join([*_head(about), f"#ifndef {name}", f"#define {name}", "", *lines, "", "#endif", ""])


def _literal(constant: Constant) -> str:
    return f"{constant.value}u" if constant.value < 1 << 32 else f"UINT64_C({constant.value})"


def limits(schema: Schema) -> str:
    """c_model/protocol/passo_limits.h"""
    lines = ["#include <stdint.h>"]
    for constant in schema.constants.values():
        rows = [(f"#define PASSO_{constant.name.upper()}", _literal(constant))]
        if constant.words:
            rows.append((f"#define PASSO_{constant.name.upper()}_WORDS", f'"{constant.shown}"'))
        lines += ["", _comment(constant.text), *aligned(rows)]
    return _guarded("PASSO_LIMITS_H", "Limits of moves and of their parameters.", lines)


def _list(name: str, about: str, rows: Iterable[str]) -> list[str]:
    """An X macro: it invokes its argument for each row."""
    return ["", _comment(about), f"#define {name}(EACH) \\", " \\\n".join(f"\tEACH({row})" for row in rows)]


def _remark(key: Key) -> str:
    """Comment of a member: unit and meaning."""
    unit = "" if key.kind.factor == CLOCK or not key.kind.factor else key.unit
    unit = " ".join(filter(None, (key.kind.stands_for, unit)))
    return f"{unit}: {key.text}" if unit else key.text


def _members(keys: Iterable[Key]) -> list[str]:
    rows = []
    for key in keys:
        array = "[PASSO_AXES_MAX]" if key.kind.list and not key.shared else ""
        rows.append((key.kind.c, f"{key.member}{array};", f"/* {_remark(key)} */"))
    return [f"\t{row}" for row in aligned(rows)]


def _structs(form: Form) -> list[str]:
    keys = [key for key in form.console_keys if key.kind.c]
    shared = [key for key in keys if key.shared]
    own = [key for key in keys if not key.shared]
    lines = []
    if shared:
        lines += ["", "struct passo_axis_limits {", *_members(shared), "};"]
    lines += ["", _comment(form.text), f"struct passo_move_{form.name} {{", *_members(own)]
    if shared:
        lines.append("\tstruct passo_axis_limits limits[PASSO_AXES_MAX];")
    return [*lines, "};"]


def moves(schema: Schema) -> str:
    """c_model/planner/passo_moves.h"""
    names = list(schema.profiles)
    several = ", ".join(names[:-1]) + f" or {names[-1]}"
    lines = ['#include "passo_command.h"']
    rows = [f'{name.upper()}, PASSO_SHAPE_{s.upper()}, "{name}"' for name, s in schema.profiles.items()]
    lines += _list("PASSO_PROFILES", "X macro of the profiles: EACH(NAME, shape of the core, name).", rows)
    lines += [
        "",
        "/* Shapes of the ramps of a move. */",
        "enum passo_profile {",
        *(f"\tPASSO_PROFILE_{name.upper()}," for name in names),
    ]
    lines += ["\tPASSO_PROFILE_COUNT", "};", "", "/* Their names, for messages. */"]
    lines.append(f'#define PASSO_PROFILES_WORDS "{several}"')
    lines.append(f'#define PASSO_PROFILES_CHOICE "{"|".join(names)}"')
    lines += [
        "",
        "/* User-defined shape: the name that replaces a profile, and the bank of its table. */",
    ]
    lines += aligned(
        [
            ("#define PASSO_USER_PROFILE", f'"{schema.user_name}"'),
            ("#define PASSO_USER_BANK", f"PASSO_SHAPE_{schema.user_bank.upper()}"),
        ]
    )
    for name, about, kind in (
        ("PASSO_MOVES", "X macros: EACH(name, NAME) for each form ...", None),
        ("PASSO_MOVES_BY_STEPS", "... for those with a member `steps` ...", "steps"),
        ("PASSO_MOVES_BY_SHAPE", "... and for those that accept a user-defined shape.", "shape"),
    ):
        forms = [form.name for form in schema.forms if kind is None or form.has(kind)]
        lines += _list(name, about, [f"{form}, {form.upper()}" for form in forms])
    for form in schema.forms:
        lines += _structs(form)
    about = "Parameters of moves: the profiles, and a struct for each form."
    return _guarded("PASSO_MOVES_H", about, lines)


METHOD = '{.name = "method", .reader = PASSO_READ_NOTHING, .otherwise = ""},'


def _row(form: Form, key: Key) -> str:
    struct = f"struct passo_move_{form.name}"
    cells = [f'.name = "{key.name}"', f".reader = PASSO_READ_{key.kind.name.upper()}"]
    if key.otherwise is not None:
        cells.append(f'.otherwise = "{key.otherwise}"')
    if key.kind.name == "whole":
        low, high = (f"PASSO_{end.upper()}" if isinstance(end, str) else f"{end}u" for end in key.range)
        cells.append(f".low = {low}, .high = {high}")
    if key.shared:
        cells.append(f".offset = offsetof({struct}, limits[0].{key.member})")
    elif key.kind.c:
        cells.append(f".offset = offsetof({struct}, {key.member})")
    return f"{{{', '.join(cells)}}},"


def tables(schema: Schema) -> str:
    """stm32_bridge/console/passo_form_tables.c"""
    lines = [*_head("Keys of the move forms."), '#include "passo_form_tables.h"']
    rows = []
    for form in schema.forms:
        name, keys = form.name.upper(), form.console_keys
        lines += ["", f"static const struct passo_key {name}_KEYS[] = {{", f"\t{METHOD}"]
        lines += [f"\t{_row(form, key)}" for key in keys] + ["};"]
        cells = [f'.name = "{form.name}"', f".keys = {name}_KEYS", f".count = {len(keys) + 1}u"]
        if form.rules:
            place = {key.name: i for i, key in enumerate(keys, 1)}
            lines += ["", f"static const struct passo_rule {name}_RULES[] = {{"]
            for rule in form.rules:
                numbers = f"{place[rule.key]}u, {place[rule.other]}u"
                lines.append(f"\t{{PASSO_RULE_{rule.kind.upper()}, {numbers}}}, /* {rule.key} */")
            lines.append("};")
            cells += [f".rules = {name}_RULES", f".rule_count = {len(form.rules)}u"]
        if form.told_by:
            cells.append(f'.told_by = "{form.told_by}"')
        rows.append(f"\t[PASSO_FORM_{name}] = {{{', '.join(cells)}}},")
    lines += ["", "const struct passo_form_table passo_form_tables[PASSO_FORM_COUNT] = {", *rows, "};"]
    told = {key.name: key for form in schema.forms if form.told_by for key in form.console_keys}
    lines += ["", "const struct passo_key passo_form_told_keys[] = {", f"\t{METHOD}"]
    lines += [f'\t{{.name = "{name}"}},' for name in told]
    lines += ["};", f"const unsigned passo_form_told_count = {len(told) + 1}u;"]
    return "\n".join([*lines, ""])
