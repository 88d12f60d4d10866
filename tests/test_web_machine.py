# SPDX-License-Identifier: MIT
"""The page of `make web` reads machine files as the command does: the same machines, the same messages."""

import json
import random
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from passo.failure import BadInputError
from passo.machine_file import read_machine
from passo.random_cases import seed
from passo.report_page import source_of
from passo.toolchain import paths
from passo.web import MACHINE
from passo.web_rules import rules

from tests.helpers.browser import Browser
from tests.helpers.web_machine import web_machine

FILES = sorted(path for folder in ("gcode", "machines") for path in (paths.examples / folder).glob("*.toml"))
# Of what the examples do not have, by kind; each is right.
KINDS = {
    "squaring": """
clock_hz = 100_000_000
junction_deviation = 1e-2
soft_limits = true
[home]
speed = 1.5
pull_off = 1
racking = 3
[[axis]]
steps_per_mm = 80
speed = 2e2
acceleration = 1000
home = "low"
switches = ["limit_low", "limit_high"]
motors = 2
offsets = [0, -0.25]
[[axis]]
name = "Y"
steps_per_mm = 80.5
speed = 200
acceleration = 1000
motors = 2
encoders = [40, 0]
following = 0.5
""",
    "corexz": """
clock_hz = 64_000_000
kinematics = "corexz"
profile = "jerk"
motors.speed = 300
motors.jerk = 20_000
pins = { step_high = "2us", step_low = 0.000002, dir_setup = "100 clocks", dir_hold = "1.5 µs" }
[[axis]]
steps_per_mm = 80
speed = 200
acceleration = 1000
jerk = 10000
jump = 2
[[axis]]
steps_per_mm = 400
speed = 20
acceleration = 100
jerk = 10000
[[axis]]
steps_per_mm = 80
speed = 200
acceleration = 1000
jerk = 10000
[[axis]]
name = "C"
steps_per_mm = 10
speed = 720
acceleration = 3600
jerk = 10000
""",
    "board": """
board = "icebreaker"
drive = "TMC2209"
clock_hz = 60_000_000
spindle_maximum = 24000
laser = true
[[axis]]
steps_per_mm = 80
speed = 200
acceleration = 1000
home = "high"
switches = ["home"]
""",
    "spindle": """
clock_hz = 64_000_000
spindle_maximum = 3000
[spindle]
counts = 4096
start_up = 0.5
wander = 2
[[axis]]
name = "X"
steps_per_mm = 200
speed = 50
acceleration = 500
[[axis]]
name = "Z"
steps_per_mm = 400
speed = 50
acceleration = 500
""",
}
KINDS["a spindle that is waited for"] = """
board = "icebreaker"
spindle_maximum = 3000
spindle_wait = 2.5
spindle_at_speed = 2
[[axis]]
name = "X"
steps_per_mm = 200
speed = 50
acceleration = 500
switches = ["home"]
[[axis]]
name = "Y"
steps_per_mm = 400
speed = 50
acceleration = 500
"""
KINDS["spindle on a board"] = KINDS["spindle"].replace("clock_hz = 64_000_000", 'board = "hx8k"')
# What is put in place of a value, and lines that are put between others; "⏎" is the end of a line.
VALUES = r"""
 | 1 | 0 | -1 | 1.0 | 0.5 | -0.0 | 1e9
1e-31 | 1e999999 | 4294967296 | 3.00 | 16 | inf | -nan | true | false
"x" | "X" | "Y" | "high" | "jerk" | "corexy"
"corexzz" | "hx8k" | "colorlight" | "DM542" | "cosin" | cosine
1us | 1 us | "1 parsec" | "2us" | " 2 µs " | "-1us"
"1e9 clocks" | "0.1ns" | "1_0us" | "⏎ | '⏎ | '''⏎'''
[] | [1] | [1, 2.5] | [-1]
["home"] | ["limit_low", "home"] | ["home", "home"] | {} | { a = 1, b = [true] }
2020-02-30 | '''x''y''' | QQQ⏎x \⏎  yQQQ | "\q" | "\u00b5"
0x10 | 1__0 | 01 | [1, [2] | { a = 1, a = 2 } | "open
64_000_000 | 66_000_000 | 66_666_667 | 12_000_001 | 250_000
999 | 65536 | 100000.5 | 1234565 | 0.00001234565
"""
LINES = r"""
speeed = 1 | acceleraton = 1 | [axis] | [[axis]] | [pins] | [spindle]
[home] | [home | [[axis] | = 1 | a | a.b = 1
[pins]⏎step_high = "1us" | [pins]⏎step_high = "7 s" | [[motors]]
pins.step_low = 1 | "quoted key" = 1 | key = 1 2
motors = 3 | encoders = [1]⏎following = 1 | jerk = 100 | backlash = 0.1 | take_up = 2
home = "low" | laser = 1 | probe = true | [switches]⏎stop = 0
board = "ulx3s" | board = "tangnano9k" | drive = "TB6600"
spindle_wait = 1 | spindle_wait = 61 | spindle_at_speed = 1 | spindle_at_speed = 9
spindle_wait = 1⏎spindle_at_speed = 1 | spindle_wait = 1⏎spindle_at_speed = 2⏎spindle_maximum = 9
[home]⏎racking = 5 | [home]⏎seek = 0 | travel = 0
[[x]]⏎y = 1⏎[x] | x.y = 1⏎[x] | x = [1]⏎[[x]] | x = {}⏎x.y = 1
[x.y]⏎[x]⏎[x] | switches = [] | 😀 = 1 | x = "😀" 1
chip = 1 | # ␁
"""
RANDOM = 1500
TRIED = """
const tried = text => { try { return MachineReader.read(text); } catch (error) { return error.message; } }
"""


def listed(text: str) -> list[str]:
    """What stands between bars."""
    marks = {"⏎": "\n", "QQQ": '"""', "␁": "\x01"}
    parts = (part.strip(" ") for line in text.strip("\n").splitlines() for part in line.split("|"))
    return [re.sub("|".join(marks), lambda found: marks[found[0]], part) for part in parts]


def changed(text: str, rng: random.Random) -> str:
    """One or two lines of it are others."""
    lines = text.splitlines()
    for _ in range(rng.choice((1, 1, 1, 2))):
        at = rng.randrange(len(lines))
        key, equals, value = lines[at].partition("=")
        kind = rng.randrange(8)
        if kind == 0:
            lines.insert(at, rng.choice(listed(LINES)))
        elif kind == 1:
            del lines[at]
        elif kind == 2:
            lines.insert(at, rng.choice(lines))
        elif kind == 3 and len(key) > 2:
            cut = rng.randrange(len(key) - 1)
            lines[at] = key[:cut] + key[cut + 1 :] + equals + value
        elif kind == 4:
            lines[at] = re.sub(r"\d", lambda _: str(rng.randrange(10)), lines[at])
        elif equals:
            lines[at] = f"{key}= {rng.choice(listed(VALUES))}"
    return "\n".join(lines) + "\n"


def texts() -> list[str]:
    """Files that are right, and wrong ones made of them."""
    rng, whole = random.Random(seed()), [path.read_text() for path in FILES] + list(KINDS.values())
    each = [f"{text}\n{line}\n" for text in whole[:1] for line in listed(LINES)]
    each += [f"{line}\n{text}" for text in whole[:1] for line in listed(LINES)]
    for text, key in (
        (KINDS["squaring"], "speed"),
        (KINDS["board"], "clock_hz"),
        (KINDS["corexz"], "profile"),
    ):
        before, after = re.split(rf"^{key} = .*$", text, maxsplit=1, flags=re.M)
        each += [f"{before}{key} = {value}{after}" for value in listed(VALUES)]
    return [*whole, "", *each, *(changed(rng.choice(whole), rng) for _ in range(RANDOM))]


def of_command(text: str, path: Path) -> Any:
    """The machine, or the message, without the path before it."""
    path.write_text(text, encoding="utf-8")
    try:
        return json.loads(json.dumps(web_machine(read_machine(path))))
    except BadInputError as error:
        return str(error).removeprefix(f"{path}: ")


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with Browser(tmp_path_factory.mktemp("browser")) as browser:
        browser.value(f"{source_of(MACHINE)}\nRULES = {json.dumps(rules())}; {TRIED}; 1")
        yield browser


@pytest.mark.sample(1)
def test_the_same_machines_and_messages(browser: Browser, tmp_path: Path) -> None:
    tried = texts()
    wanted = [of_command(text, tmp_path / "machine.toml") for text in tried]
    found = browser.value(f"{json.dumps(tried)}.map(tried)")
    differ = [
        (text, own, other) for text, own, other in zip(tried, wanted, found, strict=True) if own != other
    ]
    for text, own, other in differ[:20]:
        print(text, own, other, "", sep="\n")
    assert not differ
    said = [re.sub(r"\d+|'.*'|\".*\"", "", own) for own in wanted if isinstance(own, str)]
    assert len(set(said)) > 100 and len(wanted) - len(said) > 100
