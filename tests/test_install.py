# SPDX-License-Identifier: MIT
"""The installed package, from a wheel in an environment of its own, outside of the repository."""

import os
import re
import shutil
import subprocess
import sys
import venv
import zipfile
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path

import numpy
import pytest
from cocotb_tools.check_results import get_results
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from passo.build import Parameters, judge_library, planner_library, rtl_library
from passo.cache import cached
from passo.run import parameters_for
from passo.toolchain import paths

RELEASE = (paths.root / "VERSION").read_text().strip()
SOURCES = ("rtl", *(f"c_model/{folder}" for folder in ("core", "planner", "gcode", "protocol")), "sim/engine")
SOURCES = (*SOURCES, *(f"stm32_bridge/{folder}" for folder in ("driver", "console", "grbl")), "linux")
PACKAGES = ("sim/passo", "syn/passo_fpga", "stm32_bridge/passo_stm32")
MOVES = """
clock_hz = 16_000_000
[[move]]
steps = [640, -320, 64]
profile = "cosine"
total_time = 0.02
ramp_time = 0.01
"""


def wheel() -> Path:
    """The wheel, built without a network."""
    files = [
        path
        for folder in (*SOURCES, *PACKAGES, "examples")
        for path in sorted((paths.root / folder).rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts
    ]
    top = [paths.root / name for name in ("pyproject.toml", "VERSION", "LICENSE")]

    def make(folder: Path) -> None:
        shutil.rmtree(paths.root / "build" / "package", ignore_errors=True)  # setuptools keeps old names
        offline = ("--no-deps", "--no-index", "--no-build-isolation", "-q")
        pip = (sys.executable, "-m", "pip", "wheel", *offline, "-w", str(folder), str(paths.root))
        subprocess.run(pip, check=True)

    (made,) = cached("wheel", [*top, *files], [version("setuptools")], make).glob("*.whl")
    return made


def named(file: Path) -> set[str]:
    """The packages of a file of requirements and of those that it includes."""
    text = file.read_text(encoding="utf-8")
    included = [named(file.with_name(other)) for other in re.findall(r"(?m)^-r (\S+)", text)]
    return {canonicalize_name(name) for name in re.findall(r"(?m)^([\w.-]+)==", text)}.union(*included)


@pytest.mark.parametrize("file", sorted(paths.root.glob("requirements*.txt")), ids=lambda path: path.stem)
def test_each_set_names_all_that_its_packages_need(file: Path) -> None:
    """As tools/setup.sh has pip resolve nothing; beside a set are only the packages of requirements.txt."""
    there = named(file) | named(paths.root / "requirements.txt")
    for name in sorted(named(file)):
        try:
            needed = [Requirement(text) for text in requires(name) or ()]
        except PackageNotFoundError:
            continue  # a set that is not installed
        for one in needed:
            if one.marker is None or one.marker.evaluate({"extra": ""}):
                assert canonicalize_name(one.name) in there, f"{file.name}: {name} needs {one}"


@dataclass(frozen=True)
class Installed:
    """An environment with the wheel, and a folder of its own as home and place of work."""

    environment: Path
    home: Path

    def run(self, program: str, *arguments: str | Path, **env: str) -> subprocess.CompletedProcess[str]:
        own = {name: value for name, value in os.environ.items() if not name.startswith(("XDG_", "PYTHON"))}
        own |= {"HOME": str(self.home), "PATH": f"{self.environment / 'bin'}:{os.environ['PATH']}"} | env
        command = [shutil.which(program, path=own["PATH"]) or program, *map(str, arguments)]
        return subprocess.run(command, cwd=self.home, env=own, capture_output=True, text=True)


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Installed:
    made = Installed(tmp_path_factory.mktemp("environment"), tmp_path_factory.mktemp("home"))
    venv.create(made.environment, symlinks=True)
    (site,) = made.environment.glob("lib/python3*/site-packages")
    # The packages that it needs, but not the editable installation: .pth files there are not read.
    (site / "others.pth").write_text(str(Path(numpy.__file__).parents[1]))
    offline = ("--no-deps", "--no-index", "--no-compile", "-q")
    pip = (sys.executable, "-m", "pip", "--python", str(made.environment / "bin" / "python"))
    subprocess.run((*pip, "install", *offline, str(wheel())), check=True)
    return made


def lend(installed: Installed, *built: Path) -> Path:
    """Put libraries of the repository into the cache; return the folder."""
    library = installed.home / ".cache" / "passo" / "lib"
    for path in built:
        shutil.copytree(path.parent, library / path.parent.name, dirs_exist_ok=True)
    return library


def test_the_wheel_has_all_sources_and_type_hints() -> None:
    with zipfile.ZipFile(wheel()) as archive:
        packed = set(archive.namelist())
    for folder in SOURCES:
        files = {
            f"passo/tree/{folder}/{path.name}" for path in (paths.root / folder).iterdir() if path.is_file()
        }
        assert files <= packed
    for folder in ("passo", "passo_fpga", "passo_stm32"):
        assert f"{folder}/py.typed" in packed
    examples = [path.relative_to(paths.root) for path in paths.examples.glob("**/*.toml")]
    assert examples and {f"passo/tree/{path}" for path in examples} <= packed
    tops = {name.split("/")[0] for name in packed}
    assert tops == {"passo", "passo_fpga", "passo_stm32", f"passo-{RELEASE}.dist-info"}


def test_version(installed: Installed) -> None:
    """Of the command and of the module, which is not the one of the repository."""
    done = installed.run("passo", "--version")
    assert (done.returncode, done.stdout) == (0, f"passo {RELEASE}\n")
    done = installed.run("python", "-c", "import passo; print(passo.__version__, passo.__file__)")
    told, file = done.stdout.split()
    assert told == RELEASE and Path(file).is_relative_to(installed.environment)


def test_moves_run_outside_of_the_repository(installed: Installed) -> None:
    """On both engines: what is built goes to the cache, results to the present folder.

    Only the C model is compiled, beside declarations: the name of a library has the hash of its sources, so
    that those of the repository, put into the cache, are found if the package carries the same ones.
    """
    rtl = rtl_library(parameters_for(3))
    (verilated,) = (paths.build / "lib").glob(f"verilated_{Parameters().name}-*/Vpasso_spi_top.mk")
    (runtime,) = (paths.build / "lib").glob("verilator_runtime-*/libverilated.a")
    library = lend(installed, planner_library(), rtl, verilated, runtime)
    (installed.home / "moves.toml").write_text(MOVES)
    done = installed.run("passo", "run", "moves.toml", "--report")
    assert done.returncode == 0, done.stderr
    built = [line.split()[1] for line in done.stdout.splitlines() if line.startswith("Building")]
    assert built == ["declarations", "model"]
    assert "moves: 1024 steps in 320000 clocks" in done.stdout and "edges agree" in done.stdout
    results = installed.home / "build" / "run" / "moves"
    assert sorted(path.name for path in results.iterdir()) == ["pulses.csv", "report.html", "summary.json"]
    assert sorted(path.name for path in library.glob("model-*/*")) == ["library.so", "whole.json"]
    left = {".cache", ".config", "build", "moves.toml", "machine"}
    assert {path.name for path in installed.home.iterdir()} <= left


def test_what_needs_the_repository_says_so(installed: Installed) -> None:
    done = installed.run("passo", "firmware")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("the firmware needs the repository") and done.stderr.count("\n") == 1


@pytest.mark.parametrize("folder", ["a file/below", "with a space"])
def test_a_bad_build_folder_is_told_in_one_line(installed: Installed, tmp_path: Path, folder: str) -> None:
    (tmp_path / "a file").touch()
    planner = planner_library()
    if folder == "with a space":  # takes C, but not Verilator
        shutil.copytree(planner.parent, tmp_path / folder / "lib" / planner.parent.name)
    moves = installed.home / "few.toml"
    moves.write_text(MOVES)
    done = installed.run("passo", "run", moves, "--engine", "rtl", PASSO_BUILD=str(tmp_path / folder))
    assert done.returncode == 1 and str(tmp_path / folder) in done.stderr and done.stderr.count("\n") == 1
    assert (
        "PASSO_BUILD names another folder" in done.stderr
        or "do not support a path with a space" in done.stderr
    )
    moves.unlink()


def test_the_example_of_the_kit(installed: Installed) -> None:
    """examples/cocotb, outside of the repository."""
    lend(installed, judge_library(), planner_library())
    machine = shutil.copytree(paths.examples / "cocotb", installed.home / "machine")
    config = installed.environment / "bin" / "cocotb-config"  # as pip installs it with cocotb
    config.write_text(f"#!{config.with_name('python')}\nfrom cocotb_tools.config import main\nmain()\n")
    config.chmod(0o755)
    done = installed.run("make", "-C", machine)
    assert done.returncode == 0, done.stdout + done.stderr
    assert get_results(machine / "results.xml") == (2, 0)
    assert f"{installed.environment}/lib" in done.stdout and str(paths.rtl) not in done.stdout
    assert "axis 0: 40 up 0 down" in done.stdout and "edges that agree: step 140," in done.stdout
