# SPDX-License-Identifier: MIT
"""The forms of a move in the documentation: the text between markers.

A marker is <!-- moves: WHAT -->...<!-- /moves -->, where WHAT is one of

    forms               the table of the forms
    common              the table of the keys that mean the same in several forms
    keys FORM ...       the table of the keys of a form, or of some, that are not common; the names of those
    task FORM ...       the same for what is only in move files: task, event, machine
    events              the table of the events and their own keys
    console             the table of the forms on the console
    CONSTANT            a constant
    profiles            the names of the profiles
"""

import re
from collections import Counter

from moves.schema import Form, Key, Schema, SchemaError

MARKER = re.compile(r"(<!-- moves: ([\w ]+) -->)(.*?)(<!-- /moves -->)", re.DOTALL)


def fill(schema: Schema, page: str, text: str) -> str:
    """A page with everything between its markers regenerated; raise SchemaError."""
    try:
        return MARKER.sub(lambda found: found[1] + _between(schema, found[2]) + found[4], text)
    except KeyError as error:
        raise SchemaError(f"{page}: there is no {error.args[0]}") from None


def _between(schema: Schema, what: str) -> str:
    kind, *names = what.split()
    forms = {form.name: form for form in schema.forms}
    if kind == "forms":
        return _forms(schema)
    if kind == "common":
        return _table(COLUMNS, _common(schema))
    if kind == "keys":
        return _own_keys(schema, [forms[name] for name in names])
    if kind in schema.others:
        others = {form.name: form for form in schema.others[kind]}
        return _keys(schema, [others[name] for name in names])
    if kind == "events":
        return _events(schema)
    if kind == "console":
        return _console(schema)
    if kind == "profiles":
        return ", ".join(schema.profiles)
    return schema.constants[kind].shown


def _table(columns: list[str], rows: list[list[str]]) -> str:
    lines = [f"| {' | '.join(row)} |" for row in [columns, ["---"] * len(columns), *rows]]
    return "\n".join(["", "", *lines, "", ""]).replace("|  |", "| |").replace("|  |", "| |")


def _forms(schema: Schema) -> str:
    rows = []
    for form in schema.forms:
        anchor = form.section.lower().replace(" ", "-")
        method = f"none, or `{form.name}`" if form.told_by else f"`{form.name}`"
        rows.append([f"[{form.title}](#{anchor})", form.given, f"`passo_plan_{form.name}`", method])
    return _table(["method", "inputs", "function", "`method` in a move file"], rows)


NUMBERS = (0, "number_max")


def _range(schema: Schema, key: Key) -> str:
    if key.kind.name in ("profile", "shape"):
        user = [schema.user_name] if key.kind.name == "shape" else []
        return ", ".join(f"`{name}`" for name in [*schema.profiles, *user])
    if key.choices or key.kind.name == "flag":
        return ", ".join(f"`{word}`" for word in key.choices or ("true", "false"))
    return " .. ".join(map(schema.shown, key.range)) if key.range else ""


def _default(schema: Schema, key: Key) -> str:
    """What counts if it is not given; empty: it must be."""
    if key.console_default is not None:
        return f"on the console: {key.console_default_says}"
    if key.kind.name == "table":
        return f"only with profile `{schema.user_name}`"
    if key.kind.name == "shaper":
        return f"only with profile `{schema.shaped_name}`"
    if key.default in schema.constants or key.default is None:
        return key.optional_says
    if key.default_says:
        return key.default_says
    return key.default if key.default.isdigit() else f"`{key.default.lower()}`"


RULES = {
    "excludes": "`{key}` and `{other}` are mutually exclusive",
    "needs": "`{key}` requires `{other}`",
    "above_zero": "`{key}`, if given, must be above 0",
}


def _rules(form: Form) -> str:
    """What is checked when all keys are read."""
    said = [RULES[rule.kind].format(key=rule.key, other=rule.other) for rule in form.rules]
    return f"{'; '.join(said)}.\n\n" if said else ""


def _in_c(key: Key) -> str:
    """The member of the struct if it has another name; its unit if the page does not state it once."""
    if not key.kind.c:
        return "-"
    member = f"limits[].{key.member}" if key.shared else key.member + ("[]" if key.kind.list else "")
    unit = key.kind.stands_for if key.kind.factor not in ("clock_hz", "unit_q32") else ""
    return ", ".join(filter(None, (f"`{member}`" if member != key.name else "", unit)))


COLUMNS = ["key", "meaning", "unit", "range", "default", "in C"]


def _row(schema: Schema, key: Key) -> list[str]:
    """A key of the planner; the page states the range of a number once."""
    shown = "" if key.range == NUMBERS else _range(schema, key)
    return [f"`{key.name}`", key.text, key.unit, shown, _default(schema, key), _in_c(key)]


def _common(schema: Schema) -> list[list[str]]:
    """The rows that are the same in several forms, each once."""
    rows = Counter(tuple(_row(schema, key)) for form in schema.forms for key in form.keys)
    return [list(row) for row, forms in rows.items() if forms > 1]


def _own_keys(schema: Schema, forms: list[Form]) -> str:
    """The rows that only this form has, of several forms with its name; the common keys and the rules."""
    common, several = _common(schema), len(forms) > 1
    rows, names = [], []
    for form in forms:
        made = [_row(schema, key) for key in form.keys]
        rows += [[f"`{form.name}`", *row] if several else row for row in made if row not in common]
        shared = ", ".join(row[0] for row in made if row in common)
        names.append(f"[Common keys](#common-keys){f' of `{form.name}`' if several else ''}: {shared}.\n\n")
    return _table(["method", *COLUMNS] if several else COLUMNS, rows) + "".join([*names, *map(_rules, forms)])


def _keys(schema: Schema, forms: list[Form]) -> str:
    """What is only in move files: one row for each key; with several forms, the name of its form."""
    rows = []
    for form in forms:
        for key in form.keys:
            row = [f"`{key.name}`", key.text, key.unit, *_values(schema, key)]
            rows.append([f"`{form.name}`", *row] if len(forms) > 1 else row)
    table = _table(["method", *COLUMNS[:5]] if len(forms) > 1 else COLUMNS[:5], rows)
    return table + "".join(map(_rules, forms))


def _events(schema: Schema) -> str:
    """What every event has, then its own keys."""
    events = schema.others["event"]
    common = [key for key in events[0].keys if all(key in form.keys for form in events)]
    rows = [
        [
            "all" if form is None else f"`{form.name}`",
            f"`{key.name}`",
            key.text,
            key.unit,
            *_values(schema, key),
        ]
        for form, keys in [(None, common), *((form, form.keys) for form in events)]
        for key in keys
        if form is None or key not in common
    ]
    alone = [
        [f"`{form.name}`", "", form.text, "", "", ""] for form in events if len(form.keys) == len(common)
    ]
    return _table(["`do`", "key", "meaning", "unit", "range", "default"], [*rows, *alone])


def _values(schema: Schema, key: Key) -> tuple[str, str]:
    return _range(schema, key), _default(schema, key)


def _console(schema: Schema) -> str:
    rows = []
    for form in schema.forms:
        keys = (f"`[{k.name}]`" if k.otherwise is not None else f"`{k.name}`" for k in form.console_keys)
        rows.append([f"`{'' if form.told_by else 'method='}{form.name}`", " ".join(keys)])
    return _table(["method", "keys"], rows)
