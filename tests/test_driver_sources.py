# SPDX-License-Identifier: MIT
"""The driver's sources: sanitizers, the examples for other people's projects, sizes, headers for C++."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from passo.compiler import CORTEX_M3, call, compile_to, includes, sources
from passo.native import ffi, planner
from passo.toolchain import paths

from tests.helpers import sanitized

DRIVER = (paths.driver, paths.planner, paths.protocol)
EXAMPLES = paths.driver.parent / "examples"
STUBS = paths.tests / "stubs"
RAM_MAX = 1536  # bytes for one channel of 4 axes


def test_a_scenario_runs_clean_under_sanitizers(tmp_path: Path) -> None:
    """Moves, streams, stops, noise and resets, driver and model in one program: no fault, nothing lost."""
    folders = (*DRIVER, paths.core, paths.engine)
    program = sanitized.program(tmp_path / "scenario", paths.tests / "driver_scenario.c", folders)
    done = subprocess.run([program], capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stderr, done.stdout) == (0, "", "ok\n")


@pytest.mark.parametrize("name", ["hal.c", "libopencm3.c", "arduino.cpp", "soft_cpu.c"])
def test_an_example_compiles(name: str, tmp_path: Path) -> None:
    """Against stub headers."""
    standard = ["-std=c11", "-Wconversion"] if name.endswith(".c") else ["-x", "c++", "-std=c++17"]
    flags = (*standard, "-Wall", "-Wextra", "-Werror", "-c", *includes(*DRIVER, STUBS))
    compile_to(tmp_path / "example.o", *flags, EXAMPLES / name)


def test_examples_stand_in_the_documentation() -> None:
    """docs/driver.md shows the code that is compiled here."""
    text = (paths.root / "docs" / "driver.md").read_text()
    for name in ("hal.c", "libopencm3.c", "arduino.cpp", "soft_cpu.c"):
        code = (EXAMPLES / name).read_text()
        body = code[code.index("static bool transfer") :]
        assert body in text, f"{name} and docs/driver.md differ"


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
    """Its own Makefile builds it without a warning; it arrives; docs/driver.md shows the file as it is."""
    folder = paths.root / "examples" / "desktop"
    program = paths.build / "desktop"
    made = subprocess.run(
        ["make", "-C", folder, "CC=cc -Werror", f"OUT={program}"], capture_output=True, text=True
    )
    assert made.returncode == 0, made.stderr
    done = subprocess.run([program], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (0, "x = 120.500 mm\ny = -40.000 mm\nz = 2.250 mm\n")
    code, text = (folder / "main.c").read_text(), (paths.root / "docs" / "driver.md").read_text()
    assert f"```c\n{code}```" in text
    lines = [line for line in re.sub(r"/\*.*?\*/", "", code, flags=re.S).splitlines() if line.strip()]
    assert len(lines) < 60
