# SPDX-License-Identifier: MIT
"""Read spec/moves.toml and check its consistency."""

import re
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from passo.form_table import Rule
from passo.registers import CHANNEL_AXIS_COUNT, Shape

SOURCE = "spec/moves.toml"
GENERATED = f"Generated from {SOURCE} by spec/generate_moves.py."

CLOCK = "clock_hz"  # the only factor that is not a constant
OTHERS = ("task", "event", "machine")  # forms that are only in move files


class SchemaError(ValueError):
    """The schema contradicts itself."""


@dataclass(frozen=True)
class Constant:
    """A limit or unit of values; `shown` is its notation in texts, such as 2^30 - 1."""

    name: str
    value: int
    shown: str
    text: str
    words: bool = False
    c_only: bool = False


@dataclass(frozen=True)
class Kind:
    """Type of a value; see [kinds] in the schema."""

    name: str
    python: str
    c: str | None = None
    list: bool = False
    factor: str | None = None
    stands_for: str = ""
    units: tuple[str, ...] = ()
    range: tuple[int | str, int | str] | None = None


@dataclass(frozen=True)
class Key:
    """A key of a form. A default is a literal, or the name of an earlier key."""

    name: str
    kind: Kind
    text: str
    member: str
    unit: str = ""
    range: tuple[int | str, int | str] | None = None
    default: str | None = None
    default_says: str = ""
    optional: bool = False
    optional_says: str = ""
    console_default: str | None = None
    console_default_says: str = ""
    choices: tuple[str, ...] = ()
    file_only: bool = False
    every: bool = False  # of every move

    @property
    def trails(self) -> bool:
        """In the class of a form it comes last, with its default."""
        return self.file_only or self.every

    @property
    def shared(self) -> bool:
        """The key is in struct passo_axis_limits."""
        return self.kind.name == "per_axis"

    @property
    def otherwise(self) -> str | None:
        """Default on the console; empty: supplied by the kind; None: the key is required."""
        if self.console_default is not None:
            return self.console_default
        return "" if self.optional else self.default


@dataclass(frozen=True)
class Form:
    """A move form."""

    name: str
    title: str
    section: str
    given: str
    text: str
    keys: tuple[Key, ...]
    rules: tuple[Rule, ...] = ()
    told_by: str | None = None
    profile: str | None = None

    def has(self, kind: str) -> bool:
        """Whether the form has a key of this kind."""
        return any(key.kind.name == kind for key in self.keys)

    @property
    def summary(self) -> str:
        """The first sentence."""
        return re.split(r"(?<=\.) ", self.text)[0]

    @property
    def console_keys(self) -> tuple[Key, ...]:
        """The keys that the console also accepts."""
        return tuple(key for key in self.keys if not key.file_only)


@dataclass(frozen=True)
class Schema:
    """Contents of spec/moves.toml."""

    constants: dict[str, Constant]
    profiles: dict[str, str]  # by name: the shape of the core
    user_name: str
    user_bank: str
    shaped_name: str
    kinds: dict[str, Kind]
    forms: tuple[Form, ...]  # of moves that are planned
    others: dict[str, tuple[Form, ...]]  # task, event, machine: only in move files

    def shown(self, end: int | str) -> str:
        """One end of a range for the documentation: a number, a constant, or words."""
        sign, name = ("-", end[1:]) if str(end).startswith("-") else ("", end)
        if name == "axes_max":
            return str(CHANNEL_AXIS_COUNT)
        text = self.constants[name].shown if name in self.constants else str(name)
        return f"{sign}({text})" if sign and " " in text else f"{sign}{text}"


def read(root: Path) -> Schema:
    """Read the schema of a source tree; raises SchemaError."""
    data = tomllib.loads((root / SOURCE).read_text(encoding="utf-8"))
    _known(data, {"constants", "profiles", "user", "kinds", "keys", "form", *OTHERS}, SOURCE)
    constants = {name: _constant(name, table) for name, table in data["constants"].items()}
    for name, shape in (*data["profiles"].items(), ("user", data["user"]["bank"])):
        _want(shape.upper() in Shape.__members__, f"{name}: the core has no shape {shape}")
    kinds = {name: _record(Kind, f"kind {name}", {"name": name, **t}) for name, t in data["kinds"].items()}
    for kind in kinds.values():
        _want(kind.factor in (None, CLOCK, *constants), f"kind {kind.name}: no such factor")
    made = {
        group: tuple(_form(group, table, data["keys"], kinds, constants) for table in data.get(group, ()))
        for group in ("form", *OTHERS)
    }
    forms = made.pop("form")
    for form in forms:
        by_key = form.has("profile") or form.has("shape") or form.has("per_axis")
        _want(by_key or form.profile in data["profiles"], f"form {form.name}: which profile has it?")
    _want(sum(form.told_by is not None for form in forms) == 2, "two forms are recognized by their keys")
    user = data["user"]
    return Schema(constants, data["profiles"], user["name"], user["bank"], user["shaped"], kinds, forms, made)


def _want(condition: bool, complaint: str) -> None:
    if not condition:
        raise SchemaError(complaint)


def _known(table: dict[str, Any], known: set[str], place: str) -> None:
    for name in table:
        _want(name in known, f"{place}: unknown {name}")


def _record(make: type, place: str, table: dict[str, Any]) -> Any:
    """Turn a table into one of the classes above; lists become tuples."""
    _known(table, set(make.__dataclass_fields__), place)
    values = {name: tuple(v) if isinstance(v, list) else v for name, v in table.items()}
    try:
        return make(**values)
    except TypeError as error:
        raise SchemaError(f"{place}: {str(error).split('() ')[-1]}") from None


def _constant(name: str, table: dict[str, Any]) -> Constant:
    shown = str(table["value"])
    found = re.fullmatch(r"(\d+)(?:\^(\d+))?( - 1)?", shown)
    _want(found is not None, f"{name}: {shown} is not understood")
    value = int(found[1]) ** int(found[2] or 1) - bool(found[3])
    return _record(Constant, name, {**table, "name": name, "value": value, "shown": shown})


def _form(
    group: str,
    table: dict[str, Any],
    common: dict[str, dict[str, Any]],
    kinds: dict[str, Kind],
    constants: dict[str, Constant],
) -> Form:
    place = f"{group} {table.get('name')}"
    keys: dict[str, Key] = {}
    every = [name for name, key in common.items() if key.get("every") and group in ("form", "task")]
    for entry in (*table["keys"], *every):
        given = {"name": entry} if isinstance(entry, str) else entry
        key = _key(place, {**common.get(given["name"], {}), **given}, kinds, constants, keys)
        _want(key.name not in keys, f"{place}: {key.name} is defined twice")
        keys[key.name] = key
    rules = []
    for rule in table.get("rules", ()):
        (kind,) = set(rule) - {"key"}
        other = rule[kind] if isinstance(rule[kind], str) else rule["key"]
        _want(kind in ("excludes", "needs", "above_zero"), f"{place}: unknown rule {kind}")
        _want({rule["key"], other} <= set(keys), f"{place}: a rule for a key that does not exist")
        rules.append(Rule(kind, rule["key"], other))
    form = _record(Form, place, {**table, "keys": list(keys.values()), "rules": rules})
    _want(form.told_by in (None, *keys), f"{place}: no key {form.told_by}")
    return form


def _key(
    place: str,
    table: dict[str, Any],
    kinds: dict[str, Kind],
    constants: dict[str, Constant],
    before: dict[str, Key],
) -> Key:
    place = f"{place}: {table['name']}"
    _want(table.get("kind") in kinds, f"{place}: unknown kind {table.get('kind')}")
    kind = kinds[table["kind"]]
    default = table.get("default")
    if default in constants:
        default = constants[default].value
    is_key = isinstance(default, str) and kind.name != "word"
    _want(not is_key or default in before, f"{place}: {default} is no key before it")
    values = {**table, "kind": kind, "member": table.get("member", table["name"])}
    values |= {name: str(values[name]) for name in ("console_default",) if name in values}
    key = _record(Key, place, values)
    if default is not None:
        key = replace(key, default=str(default))
    _want(key.unit in (kind.units or ("",)), f"{place}: the unit of {kind.name} is not {key.unit!r}")
    _want(key.range is not None or kind.name != "whole", f"{place}: a whole number needs a range")
    _want(bool(key.choices) == (kind.name == "word"), f"{place}: a word needs choices, and only a word")
    _want(
        kind.name != "word" or default is None or default in key.choices, f"{place}: {default} is no choice"
    )
    return replace(key, range=key.range or kind.range)
