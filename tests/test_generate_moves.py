# SPDX-License-Identifier: MIT
"""The move forms: generated files are up to date and consistent; an invalid schema is rejected."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from passo import move_forms
from passo.move_file import read_moves
from passo.move_forms import FORMS, PROFILES
from passo.move_keys import READERS
from passo.moves import MOVES
from passo.native import ffi, planner
from passo.plan import struct_of
from passo.toolchain import environment, paths

SOURCE = "spec/moves.toml"
GENERATOR = "spec/generate_moves.py"
HELPER = "spec/generated.py"
LIMITS, STRUCTS = "c_model/protocol/passo_limits.h", "c_model/planner/passo_moves.h"
TABLES = "stm32_bridge/console/passo_form_tables.c"
PYTHON = "sim/passo/move_forms.py"
PLANNING, CONSOLE, SCENES = "docs/planning.md", "docs/console.md", "docs/scenes.md"
MADE = [LIMITS, STRUCTS, TABLES, PYTHON]
PAGES = [PLANNING, CONSOLE, SCENES]


def read(name: str, folder: Path = paths.root) -> str:
    return (folder / name).read_text(encoding="utf-8")


def generate(folder: Path, *options: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        [sys.executable, GENERATOR, *options],
        cwd=folder,
        env=environment(),
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """The generator with all its inputs."""
    for name in [SOURCE, GENERATOR, HELPER, *MADE, *PAGES]:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
    for name in [SOURCE, GENERATOR, HELPER, *PAGES]:
        shutil.copy(paths.root / name, tmp_path / name)
    shutil.copytree(paths.spec / "moves", tmp_path / "spec" / "moves")
    return tmp_path


def change(folder: Path, old: str, new: str) -> None:
    """Write the schema with something changed in it."""
    text = read(SOURCE, folder)
    assert old in text
    (folder / SOURCE).write_text(text.replace(old, new, 1), encoding="utf-8")


# ------------------------------------------------------------------------------------------------ fresh ----


def test_generated_files_are_fresh() -> None:
    result = generate(paths.root, "--check")
    assert (result.returncode, result.stdout) == (0, "")


@pytest.mark.parametrize("name", MADE)
def test_generated_files_say_so(name: str) -> None:
    assert f"Generated from {SOURCE} by {GENERATOR}." in "".join(read(name).splitlines(keepends=True)[:3])


def test_check_names_stale_files(tree: Path) -> None:
    """Each alone, without writing it; the generator mends them all."""
    assert generate(tree).returncode == 0
    end = "<!-- /moves -->"
    fresh = {name: read(name, tree) for name in (*MADE, *PAGES)}
    wrong = {
        name: text.replace(end, f"wrong{end}", 1) if name in PAGES else text + "\n"
        for name, text in fresh.items()
    }
    for stale, text in wrong.items():
        (tree / stale).write_text(text, encoding="utf-8")
        result = generate(tree, "--check")
        assert result.returncode == 1
        assert [name for name in fresh if name in result.stdout] == [stale]
        assert read(stale, tree) == text
        (tree / stale).write_text(fresh[stale], encoding="utf-8")
    for name, text in wrong.items():
        (tree / name).write_text(text, encoding="utf-8")
    assert generate(tree).returncode == 0
    assert {name: read(name, tree) for name in fresh} == fresh
    assert generate(tree, "--check").returncode == 0


# --------------------------------------------------------------------------------------------- the same ----


def macro(name: str) -> int:
    """A limit as C has it."""
    found = re.search(rf"^#define PASSO_{name} +(?:UINT64_C\()?(\d+)", read(LIMITS), re.M)
    assert found, name
    return int(found[1])


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("SUBSTEPS_MAX", 2**30 - 1),
        ("NUMBER_MAX", 2**32 - 1),
        ("SIGNED_MAX", 2**31 - 1),
        ("WHOLE_MAX", 2**32 - 1),
        ("DECIMALS_MAX", 30),
        ("UNIT_Q32", 2**32),
        ("ALPHA_ONE", 4096),
        ("ALPHA_MIN", 3),
        ("ALPHA_MAX", 5),
        ("ALPHA_RESET", 5),
    ],
)
def test_limits_by_hand(name: str, value: int) -> None:
    assert macro(name) == getattr(move_forms, name) == value


def test_profiles() -> None:
    values = [getattr(planner(), f"PASSO_PROFILE_{name.upper()}") for name in PROFILES]
    assert values == list(range(planner().PASSO_PROFILE_COUNT))


@pytest.mark.parametrize("form", FORMS.values(), ids=list(FORMS))
def test_each_form_is_complete(form: move_forms.Form) -> None:
    """It has its class, its functions and its struct, and a key fills each member."""
    assert MOVES[form.name].form is form
    assert set(MOVES[form.name].__dataclass_fields__) - {"form", "profile"} == {
        key.name for key in form.keys
    } - {"profile"}
    assert callable(getattr(planner(), f"passo_plan_{form.name}"))
    assert callable(getattr(planner(), f"passo_move_{form.name}"))
    struct = dict(ffi().typeof(f"struct passo_move_{form.name}").fields)
    own = {key.member for key in form.keys if key.member and key.kind != "per_axis"}
    shared = {key.member for key in form.keys if key.kind == "per_axis"}
    assert set(struct) == own | ({"limits"} if shared else set())
    if shared:
        assert {name for name, _ in struct["limits"].type.item.fields} == shared
    assert all(key.kind in READERS for key in form.keys)
    assert re.search(rf"<!-- moves: keys [\w ]*\b{form.name}\b", read(PLANNING)), "it has no table"


def unit(form: str, name: str) -> str:
    """The unit of a key, by what its name says."""
    way = "mm" if form == "straight" else "steps"
    for ending, wanted in {
        **{"_time": "s", "speed": f"{way}/s", "feed": f"{way}/s", "rpm": "rpm", "angle": "degrees"},
        **{"eleration": f"{way}/s^2", "jerk": f"{way}/s^3", "_per_mm": "steps/mm", "distance": "mm"},
        **{"steps": "steps", "_per_turn": "steps"},
    }.items():
        if name.endswith(ending):
            return wanted
    return ""


def tables() -> dict[str, tuple[list[list[str]], str]]:
    """By the forms of a marker (or `common`): the cells of its table, and what is below it."""
    found = re.findall(
        r"<!-- moves: (?:keys )?(common|(?<=keys )[\w ]+) -->\n\n(.*?)\n\n(.*?)<!-- /moves",
        read(PLANNING),
        re.S,
    )
    return {
        forms: (
            [[cell.strip(" `") for cell in row.split("|")[1:-1]] for row in table.splitlines()[2:]],
            below,
        )
        for forms, table, below in found
    }


def test_units_are_those_that_the_names_say() -> None:
    """In the documentation."""
    for forms, (rows, _) in tables().items():
        assert rows, forms
        for row in rows:
            form, name, _, shown = row[:4] if " " in forms else (forms, *row[:3])
            assert shown == unit(form, name), (form, name)


def test_each_key_is_in_the_table_of_its_form_or_a_common_one() -> None:
    made = tables()
    common = {row[0] for row in made.pop("common")[0]}
    told = {}
    for forms, (rows, below) in made.items():
        names = forms.split()
        lines = re.findall(r"^\[Common keys\].*: (.*)\.$", below, re.M)
        for form, line in zip(names, lines, strict=True):
            own = [row[-6] for row in rows if len(names) == 1 or row[0] == form]
            shared = re.findall(r"`(\w+)`", line)
            assert set(shared) <= common
            told[form] = sorted(own + shared)
    assert told == {name: sorted(key.name for key in form.keys) for name, form in FORMS.items()}


VALUES = {
    "by_speed": (
        'profile = "jerk"\nsteps = [7, -3]\nstart_speed = 2.5\nspeed = 9\nstop_speed = 1\nacceleration = 4\n',
        {"profile": 3, "start_speed": 5 << 31, "speed": 9 << 32, "stop_speed": 1 << 32}
        | {"acceleration": 4 << 32, "deceleration": 0, "ramp_clocks": 0},
    ),
    "at_speed": (
        'profile = "cosine"\nsteps = [1]\nspeed = 9\nramp_time = 0.25\n',
        {"profile": 1, "speed": 9 << 32, "ramp_clocks": 250},
    ),
    "turn": (
        "axis = 1\nsteps_per_turn = 200\nangle = -0.5\nrpm = 3\nacceleration = 4\n",
        {"axis": 1, "steps_per_turn": 200, "angle": -(1 << 31), "rpm": 3 << 32, "acceleration": 4 << 32},
    ),
    "sigmoid": (
        "steps = [1]\nspeed = 9\naccelerate_time = 0.5\n",
        {"start_speed": 0, "accelerate_clocks": 500, "decelerate_clocks": 500, "alpha": 5 * 4096},
    ),
    "jerk": (
        "steps = [1]\nspeed = 9\nacceleration = 4\njerk = 2\n",
        {"acceleration": 4 << 32, "jerk": 2 << 32},
    ),
}


@pytest.mark.parametrize("name", VALUES)
def test_values_in_the_struct_by_hand(tmp_path: Path, name: str) -> None:
    """Of a clock of 1 kHz: what a move file says in the units of the planner."""
    text, wanted = VALUES[name]
    path = tmp_path / "moves.toml"
    path.write_text(f'clock_hz = 1000\n[[move]]\nmethod = "{name}"\n{text}')
    made = struct_of(read_moves(path).moves[0], 1000)
    assert {key: getattr(made, key) for key in wanted} == wanted


def test_limits_of_axes_by_hand(tmp_path: Path) -> None:
    path = tmp_path / "moves.toml"
    path.write_text(
        'clock_hz = 1000\n[[move]]\nmethod = "straight"\ndistance = [1, -2.5]\nfeed = 3\n'
        "steps_per_mm = 80\nspeed = [4, 5]\nacceleration = 6\njerk = [0, 7]\n"
    )
    made = struct_of(read_moves(path).moves[0], 1000)
    assert (list(made.distance)[:3], made.feed) == ([1 << 32, -(5 << 31), 0], 3 << 32)
    limits = [(own.steps_per_mm, own.speed, own.acceleration, own.jerk) for own in made.limits]
    assert limits[:3] == [
        (80 << 32, 4 << 32, 6 << 32, 0),
        (80 << 32, 5 << 32, 6 << 32, 7 << 32),
        (0, 0, 0, 0),
    ]


# ---------------------------------------------------------------------------------------------- changes ----


def test_a_new_key_is_one_entry(tree: Path) -> None:
    """It appears in the struct, on the console and its page, in move files, and on the planner's page."""
    attributes = 'kind = "time", unit = "s", member = "dwell_clocks", default = 0, text = "at rest before it"'
    before, after = 'keys = ["steps", "profile", ', '"total_time", {'
    change(tree, before + after, f'{before}{{ name = "dwell_time", {attributes} }}, {after}')
    assert generate(tree).returncode == 0
    structs = read(STRUCTS, tree).split("struct passo_move_below_speed {")[1].split("}")[0]
    assert re.search(r"uint64_t +dwell_clocks; +/\* clocks: at rest before it \*/", structs)
    keys = read(TABLES, tree).split("BELOW_SPEED_KEYS[]")[1].split("};")[0]
    assert re.search(r'"dwell_time".*PASSO_READ_TIME.*"0".*below_speed, dwell_clocks\)', keys)
    forms = read(PYTHON, tree).split('"below_speed": Form(')[1].split('"at_speed": Form(')[0]
    assert 'Key("dwell_time", "time", "dwell_clocks", factor="clock_hz", default=0),' in forms
    assert "\n    dwell_time: Fraction\n" in read(PYTHON, tree).split("class MoveBelowSpeed")[1]
    assert "| `below_speed` | `dwell_time` | at rest before it | s |" in read(PLANNING, tree)
    assert "`steps` `profile` `[dwell_time]` `total_time` `speed`" in read(CONSOLE, tree)


def test_a_limit_is_one_entry(tree: Path) -> None:
    change(tree, 'substeps_max = { value = "2^30 - 1"', 'substeps_max = { value = "2^29 - 1"')
    assert generate(tree).returncode == 0
    assert "#define PASSO_SUBSTEPS_MAX       536870911u\n" in read(LIMITS, tree)
    assert '"2^29 - 1"' in read(LIMITS, tree)
    assert "\nSUBSTEPS_MAX = 536870911\n" in read(PYTHON, tree)
    assert all("2^29 - 1" in read(page, tree) for page in PAGES)
    assert not any("2^30" in read(page, tree) for page in PAGES)


WRONG = {
    "unit": ('unit = "degrees", text', 'unit = "s", text', "angle: the unit of signed is not 's'"),
    "no unit": ('"signed", unit = "degrees"', '"signed"', "the unit of signed is not ''"),
    "kind": ('kind = "signed", unit', 'kind = "sign", unit', "form turn: angle: unknown kind sign"),
    "attribute": ('"signed", unit', '"signed", units', "form turn: angle: unknown units"),
    "no text": (
        ', text = "to the nearest step" }',
        " }",
        "missing 1 required positional argument: 'text'",
    ),
    "default": ('default = "accelerate_time"', 'default = "jerk"', "jerk is no key before it"),
    "rule": ('excludes = "ramp_time"', 'excludes = "jerk"', "a rule for a key that does not exist"),
    "rule kind": ('needs = "acceleration"', 'has = "acceleration"', "unknown rule has"),
    "key twice": ('"start_speed",\n  "speed",', '"speed",\n  "speed",', "speed is defined twice"),
    "told by": ('told_by = "total_time"', 'told_by = "time"', "form in_time: no key time"),
    "profile": ('\nprofile = "jerk"', '\nprofile = "jerky"', "form jerk: which profile has it?"),
    "shape": ('jerk = "ease"', 'jerk = "eased"', "jerk: the core has no shape eased"),
    "factor": ('factor = "alpha_one"', 'factor = "alpha_two"', "kind alpha: no such factor"),
    "value": ('value = "2^30 - 1"', 'value = "2**30"', "substeps_max: 2**30 is not understood"),
    "range": ('range = [1, "whole_max"], ', "", "a whole number needs a range"),
}


def test_a_marker_for_nothing_is_refused(tree: Path) -> None:
    page = tree / PLANNING
    page.write_text(page.read_text().replace("moves: keys jerk", "moves: keys jolt"), encoding="utf-8")
    result = generate(tree)
    assert (result.returncode, result.stdout) == (2, f"{SOURCE}: {PLANNING}: there is no jolt\n")
    assert not (tree / LIMITS).exists()


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_schema_is_refused(tree: Path, name: str) -> None:
    """In one line, and nothing is written."""
    old, new, reason = WRONG[name]
    change(tree, old, new)
    result = generate(tree)
    assert result.returncode == 2 and reason in result.stdout and result.stdout.count("\n") == 1
    assert result.stdout.startswith(f"{SOURCE}: ")
    assert not (tree / LIMITS).exists()
