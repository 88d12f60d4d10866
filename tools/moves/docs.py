# SPDX-License-Identifier: MIT
"""The move forms in the documentation: the text between markers.

A marker is <!-- moves: WHAT -->...<!-- /moves -->, where WHAT is one of

    forms               table of the forms
    keys FORM ...       table of the keys of one or several forms
    console             table of the forms on the console
    CONSTANT            a constant
    profiles            the names of the profiles
"""

import re

from moves.schema import Form, Key, Schema, SchemaError

MARKER = re.compile(r"(<!-- moves: ([\w ]+) -->)(.*?)(<!-- /moves -->)", re.DOTALL)


def fill(schema: Schema, page: str, text: str) -> str:
    """A page with the text between its markers regenerated; raises SchemaError."""
    try:
        return MARKER.sub(lambda found: found[1] + _between(schema, found[2]) + found[4], text)
    except KeyError as error:
        raise SchemaError(f"{page}: there is no {error.args[0]}") from None


def _between(schema: Schema, what: str) -> str:
    kind, *names = what.split()
    forms = {form.name: form for form in schema.forms}
    if kind == "forms":
        return _forms(schema)
    if kind == "keys":
        return _keys(schema, [forms[name] for name in names])
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
    return _table(["form", "given", "function", "`method` in a move file"], rows)


def _range(schema: Schema, key: Key) -> str:
    if key.kind.name in ("profile", "shape"):
        user = [schema.user_name] if key.kind.name == "shape" else []
        return ", ".join(f"`{name}`" for name in [*schema.profiles, *user])
    return " .. ".join(map(schema.shown, key.range)) if key.range else ""


def _default(schema: Schema, key: Key) -> str:
    """Default of a key in words; empty: the key is required."""
    if key.console_default is not None:
        return f"on the console: {key.console_default_says}"
    if key.kind.name == "table":
        return f"only with profile `{schema.user_name}`"
    if key.default in schema.constants or key.default is None:
        return key.optional_says
    if key.default_says:
        return key.default_says
    return key.default if key.default.isdigit() else f"`{key.default}`"


RULES = {
    "excludes": "`{key}` and `{other}` exclude each other",
    "needs": "`{key}` needs `{other}`",
    "above_zero": "`{key}` must be above 0 if given",
}


def _rules(form: Form) -> str:
    """The rules between keys, checked after all of them are read."""
    said = [RULES[rule.kind].format(key=rule.key, other=rule.other) for rule in form.rules]
    return f"{'; '.join(said)}.\n\n" if said else ""


def _in_c(key: Key) -> str:
    """Member and format of a key in the struct of its form."""
    if not key.kind.c:
        return ""
    member = f"limits[].{key.member}" if key.shared else key.member + ("[]" if key.kind.list else "")
    return ", ".join(filter(None, (f"`{member}`", key.kind.stands_for)))


def _keys(schema: Schema, forms: list[Form]) -> str:
    """One row per key; for several forms, with the name of the form."""
    rows = []
    for form in forms:
        for key in form.keys:
            row = [
                f"`{key.name}`",
                key.text,
                key.unit,
                _range(schema, key),
                _default(schema, key),
                _in_c(key),
            ]
            rows.append([f"`{form.name}`", *row] if len(forms) > 1 else row)
    columns = ["key", "is", "unit", "range", "default", "in C"]
    table = _table(["form", *columns] if len(forms) > 1 else columns, rows)
    return table + "".join(map(_rules, forms))


def _console(schema: Schema) -> str:
    rows = []
    for form in schema.forms:
        keys = (f"`[{k.name}]`" if k.otherwise is not None else f"`{k.name}`" for k in form.console_keys)
        rows.append([f"`{'' if form.told_by else 'method='}{form.name}`", " ".join(keys)])
    return _table(["form", "keys"], rows)
