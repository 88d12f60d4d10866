# SPDX-License-Identifier: MIT
"""The file list and the FuseSoC core name the sources of the tree, and work; there is one version."""

import os
import re
import shutil
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import passo
import pytest
import yaml
from passo.toolchain import environment, paths
from passo_fpga.design import Design
from passo_fpga.devices import DEVICES

sys.path.insert(0, str(paths.tools))
sys.path.insert(0, str(paths.spec))
import generate_package
import lint_rtl

GENERATOR = "spec/generate_package.py"
BENCH = Path(generate_package.BENCH)
CORE = "passo.core"
MADE = ["rtl/passo.f", CORE, "c_model/protocol/passo_release.h"]
RELEASE = (paths.root / "VERSION").read_text().strip()
COPIED = ["rtl", CORE, BENCH]


def call(*command: str | Path, cwd: Path, home: Path | None = None) -> subprocess.CompletedProcess:
    """Run it; without a network, if a home is given, as far as its own settings go."""
    env = environment()
    if home:
        dead = dict.fromkeys(("http_proxy", "https_proxy", "all_proxy"), "http://127.0.0.1:9")
        env |= {"HOME": str(home), "XDG_CONFIG_HOME": str(home), "XDG_DATA_HOME": str(home), **dead}
        env["XDG_CACHE_HOME"] = str(home)
    return subprocess.run(
        list(map(str, command)), cwd=cwd, env=env, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )


def test_generated_files_are_fresh() -> None:
    done = call(sys.executable, GENERATOR, "--check", cwd=paths.root)
    assert (done.returncode, done.stdout) == (0, "")


@pytest.mark.parametrize("name", ["passo_one_more.v", "passo_one_more.vh"])
def test_a_source_more_or_less_is_noticed(tmp_path: Path, name: str) -> None:
    """By the check of the generated files."""
    for file in ["VERSION", GENERATOR, "spec/generated.py", *MADE]:
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(paths.root / file, tmp_path / file)
    shutil.copytree(paths.rtl, tmp_path / "rtl", dirs_exist_ok=True)
    check = (sys.executable, GENERATOR, "--check")
    assert call(*check, cwd=tmp_path).returncode == 0
    (tmp_path / "rtl" / name).touch()
    assert CORE in call(*check, cwd=tmp_path).stdout
    (tmp_path / "rtl" / name).unlink()
    (tmp_path / "rtl" / "passo_crc.v").unlink()
    assert CORE in call(*check, cwd=tmp_path).stdout


def test_all_that_read_the_core_read_the_files_of_the_list() -> None:
    """`make lint`, the flows of the FPGAs, the list, the FuseSoC core."""
    listed = (paths.root / MADE[0]).read_text().splitlines()
    assert "+incdir+rtl" in listed
    modules = [paths.root / line for line in listed if line.endswith(".v")]
    assert modules == sorted(paths.rtl.glob("*.v"))
    assert modules == lint_rtl._sources(paths.rtl) == Design("x", DEVICES["hx8k"]).sources
    of_core = re.findall(r"^ +- (rtl/[\w.]+)", (paths.root / CORE).read_text(), re.M)
    assert sorted(paths.root / name for name in of_core) == sorted((*modules, *paths.rtl.glob("*.vh")))


@pytest.mark.parametrize("top", lint_rtl.TOPS)
@pytest.mark.parametrize(
    "command",
    [
        "verilator --lint-only --quiet -Wall --top-module {top} -f rtl/passo.f",
        "iverilog -g2005 -Wall -t null -s {top} -c rtl/passo.f",
        "iverilog -g2005 -Wall -t null -s {top} -f rtl/passo.f",
    ],
    ids=["verilator", "icarus-c", "icarus-f"],
)
def test_the_list_is_accepted(command: str, top: str) -> None:
    done = call(*command.format(top=top).split(), cwd=paths.root)
    assert (done.returncode, done.stdout) == (0, "")


@pytest.fixture
def library(tmp_path: Path) -> Path:
    """A folder with the files of the FuseSoC core and nothing else."""
    folder = tmp_path / "library"
    for name in COPIED:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        copy = shutil.copytree if (paths.root / name).is_dir() else shutil.copy
        copy(paths.root / name, folder / name)
    return folder


def run_target(library: Path, work: Path, target: str, *options: str) -> subprocess.CompletedProcess:
    """Nothing may change in the folder."""
    before = sorted((path, path.stat().st_mtime_ns) for path in library.rglob("*"))
    fusesoc = (Path(sys.executable).parent / "fusesoc", "--cores-root", library)
    chosen = ("--work-root", work / "work", "--target", target, f"::passo:{RELEASE}", *options)
    work.joinpath("home").mkdir()
    done = call(*fusesoc, "run", *chosen, cwd=work, home=work / "home")
    assert sorted((path, path.stat().st_mtime_ns) for path in library.rglob("*")) == before
    return done


@pytest.mark.parametrize("target", generate_package.TOPS)
def test_fusesoc_reads_each_top(library: Path, tmp_path: Path, target: str) -> None:
    """Without a warning, also with other parameters."""
    done = run_target(library, tmp_path, target, "--AXES", "2", "--CHANNELS", "3")
    assert done.returncode == 0, done.stdout
    assert "%Warning" not in done.stdout and "%Error" not in done.stdout
    made = (tmp_path / "work").rglob("*.vc")
    assert any("-GAXES=2" in file.read_text() for file in made)


def test_fusesoc_reads_with_all_warnings(library: Path, tmp_path: Path) -> None:
    """A fault that only a warning tells of is one."""
    source = library / "rtl" / "passo_crc.v"
    source.write_text(source.read_text().replace("output wire top", "output wire [1:0] top"))
    assert run_target(library, tmp_path, "lint").returncode != 0


def test_fusesoc_simulates_a_move(library: Path, tmp_path: Path) -> None:
    done = run_target(library, tmp_path, "sim")
    assert done.returncode == 0, done.stdout
    assert "passed: 40 and 10 steps in 2560 clocks" in done.stdout and "FAILED" not in done.stdout


FAULTS = {
    "count": ("words[2] = STEPS_0", "words[2] = 41", "counted 41, not 40"),
    "direction": ("LINE_LAST | LINE_NEGATIVE_1", "LINE_LAST", "counted 10, not 0"),
    "refused": ("words[1] = SUBSTEPS", "words[1] = 0", "the reply to a frame for 0x120"),
    "read": ("OPERATION_READ, address", "OPERATION_READ, 12'd1", "0x000 holds"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_the_bench_sees_faults(tmp_path: Path, fault: str) -> None:
    """What it expects is compared."""
    old, new, said = FAULTS[fault]
    bench = (paths.root / BENCH).read_text()
    assert bench.count(old) == 1
    (tmp_path / "bench.v").write_text(bench.replace(old, new))
    built = ("-g2005", "-s", generate_package.BENCH_TOP, "-o", tmp_path / "bench", tmp_path / "bench.v")
    assert call("iverilog", *built, "-c", "rtl/passo.f", cwd=paths.root).returncode == 0
    output = call("vvp", tmp_path / "bench", cwd=tmp_path).stdout
    assert f"FAILED: {said}" in output and "passed" not in output


def test_the_workflow_calls_what_is_there() -> None:
    """By fixed versions of what others wrote."""
    job = yaml.safe_load((paths.root / ".github/workflows/ci.yml").read_text())["jobs"]["test"]
    assert all(re.search("@[0-9a-f]{40}$", step["uses"]) for step in job["steps"] if "uses" in step)
    assert [step["run"] for step in job["steps"] if "run" in step] == ["${{ matrix.command }}"]
    short, whole = job["strategy"]["matrix"]["command"]
    assert os.access(paths.root / short, os.X_OK)
    assert whole == "make test-all"


KINDS = ["Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"]  # of Keep a Changelog 1.1.0


def test_the_changelog_keeps_its_form() -> None:
    """Releases with dates, the newest first; in each the kinds of changes in their order, each once."""
    text = (paths.root / "CHANGELOG.md").read_text()
    title, *releases = re.split(r"^## ", text, flags=re.M)
    assert title.startswith("# Changelog\n") and "https://keepachangelog.com/en/1.1.0/" in title
    heads = [
        re.fullmatch(r"\[(\d+\.\d+\.\d+)\] - (\d{4}-\d\d-\d\d)", one.splitlines()[0]) for one in releases
    ]
    numbers = [(tuple(map(int, head[1].split("."))), head[2]) for head in heads if head]
    assert len(numbers) == len(releases) and numbers == sorted(set(numbers), reverse=True)
    for release in releases:
        kinds = re.findall(r"^### (.*)$", release, re.M)
        assert kinds == sorted(set(kinds), key=KINDS.index)
        assert not re.search(r"\n\n\*.*(?:\n  .*)*\n\n\*", release)  # a list without gaps


def test_the_release_is_the_same_everywhere() -> None:
    """Package, command, FuseSoC, console, change log and what the pages show of the console."""
    assert re.fullmatch(r"\d+\.\d+\.\d+", RELEASE)
    assert passo.__version__ == version("passo") == RELEASE
    done = call(Path(sys.executable).parent / "passo", "--version", cwd=paths.root)
    assert (done.returncode, done.stdout) == (0, f"passo {RELEASE}\n")
    assert f"\nname: ::passo:{RELEASE}\n" in (paths.root / CORE).read_text()
    (first, *_) = re.findall(
        r"^## \[(\S+)\] - \d{4}-\d\d-\d\d$", (paths.root / "CHANGELOG.md").read_text(), re.M
    )
    assert first == RELEASE
    pages = "".join(page.read_text() for page in paths.docs.glob("*.md"))
    shown = re.findall(r"note: Passo console ([\d.]+)|\bok console=([\d.]+)", pages)
    assert shown and {one or other for one, other in shown} == {RELEASE}
