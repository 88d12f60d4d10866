# SPDX-License-Identifier: MIT
"""The driver's sources: sanitizers, the examples for other people's projects, sizes, headers for C++."""

import re
import shutil
import subprocess
import textwrap
from pathlib import Path

import pytest
from passo.compiler import CORTEX_M3, call, compile_to, includes, sources
from passo.native import ffi, planner
from passo.toolchain import paths

from tests.helpers import sanitized

DRIVER = (paths.driver, paths.planner, paths.protocol)
EXAMPLES = paths.driver.parent / "examples"
EXAMPLE_FILES = ("hal.c", "libopencm3.c", "arduino.cpp", "soft_cpu.c")
DRIVER_PAGE = paths.docs / "driver.md"
STUBS = paths.tests / "stubs"
RAM_MAX = 1536  # bytes for one channel of 4 axes


def test_a_scenario_runs_clean_under_sanitizers(tmp_path: Path) -> None:
    """Moves, streams, stops, noise and resets, driver and model in one program: no fault, nothing lost."""
    folders = (*DRIVER, paths.core, paths.engine)
    program = sanitized.program(tmp_path / "scenario", paths.tests / "driver_scenario.c", folders)
    done = subprocess.run([program], capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stderr, done.stdout) == (0, "", "ok\n")


@pytest.mark.parametrize("name", EXAMPLE_FILES)
def test_an_example_compiles(name: str, tmp_path: Path) -> None:
    """Against stub headers."""
    standard = ["-std=c11", "-Wconversion"] if name.endswith(".c") else ["-x", "c++", "-std=c++17"]
    flags = (*standard, "-Wall", "-Wextra", "-Werror", "-c", *includes(*DRIVER, STUBS))
    compile_to(tmp_path / "example.o", *flags, EXAMPLES / name)


def test_the_documentation_leads_to_every_example() -> None:
    """docs/driver.md links to each file that is compiled here, and to no other."""
    linked = re.findall(r"\]\(\.\./stm32_bridge/examples/([^)]+)\)", DRIVER_PAGE.read_text())
    assert sorted(linked) == sorted(path.name for path in EXAMPLES.iterdir()) == sorted(EXAMPLE_FILES)


def test_every_function_of_the_headers_exists() -> None:
    """All functions declared in the public headers can be called."""
    for header in (
        "passo.h",
        "passo_host.h",
        "passo_motor.h",
        "passo_inputs.h",
        "passo_home.h",
        "passo_goto.h",
        "passo_outputs.h",
        "passo_encoder.h",
        "passo_error.h",
    ):
        text = re.sub(r"/\*.*?\*/", "", (paths.driver / header).read_text(), flags=re.S)
        names = set(re.findall(r"\b(passo_\w+)\(", text))
        assert names or header == "passo_error.h"
        for name in names:
            assert callable(getattr(planner(), name))


@pytest.mark.skipif(not shutil.which("arm-none-eabi-gcc"), reason="gcc-arm-none-eabi is not installed")
def test_it_is_small(tmp_path: Path) -> None:
    """RAM of one channel, with the link; the deepest frame of the stack; printed with -s."""
    source = tmp_path / "sizes.c"
    source.write_text(
        '#include "passo.h"\n'
        "const unsigned host_bytes = sizeof(struct passo_host), passo_bytes = sizeof(struct passo);\n"
        f'_Static_assert(sizeof(struct passo_host) + sizeof(struct passo) <= {RAM_MAX}u, "RAM");\n'
    )
    stack = {}
    for path in [source, *sources(paths.driver)]:
        made = tmp_path / f"{path.stem}.o"
        call([*CORTEX_M3, *includes(*DRIVER), "-fstack-usage", "-c", path, "-o", made])
        for line in made.with_suffix(".su").read_text().splitlines():
            name, size, kind = line.split("\t")
            assert kind == "static"
            stack[name.split(":")[-1]] = int(size)
    deepest = max(stack, key=lambda name: stack[name])
    print(f"on this machine: {ffi().sizeof('struct passo_host')} + {ffi().sizeof('struct passo')} bytes")
    print(f"largest stack frame: {deepest}, {stack[deepest]} bytes")
    assert stack[deepest] <= 768


def test_the_desktop_example() -> None:
    """Its own Makefile builds it without a warning; it arrives; docs/driver.md shows the middle of it."""
    folder = paths.root / "examples" / "desktop"
    program = paths.build / "desktop"
    made = subprocess.run(
        ["make", "-C", folder, "CC=cc -Werror", f"OUT={program}"], capture_output=True, text=True
    )
    assert made.returncode == 0, made.stderr
    done = subprocess.run([program], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (0, "x = 120.500 mm\ny = -40.000 mm\nz = 2.250 mm\n")
    code = (folder / "main.c").read_text()
    shown = re.findall(r"^```c\n(.*?)^```", DRIVER_PAGE.read_text(), re.M | re.S)[0]
    declarations, calls = shown.split("\n\n")
    assert "passo_move_straight home =" in declarations and "passo_open(" in calls and "passo_wait(" in calls
    for part in (declarations, calls):
        assert textwrap.indent(f"{part.rstrip()}\n", "\t") in code
    lines = [line for line in re.sub(r"/\*.*?\*/", "", code, flags=re.S).splitlines() if line.strip()]
    assert len(lines) < 60
