# SPDX-License-Identifier: MIT
"""A disk that is full, an incomplete cache: each is reported in a sentence, and harms no later command."""

import ctypes
import errno
import io
import json
import os
import re
import resource
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from passo import cache, output
from passo.build import model_library, planner_library
from passo.cli import main
from passo.compiler import call, library
from passo.failure import BadInputError, BuildError, Failure
from passo.native import ffi
from passo.toolchain import paths

from tests.helpers.commands import MACHINE, MOVES, PART, WRITERS, smaller

NO_LIMIT = 1 << 40
LIMITS = (0, 100, 3000, 30_000, 300_000)  # bytes that a file may have


# ---------------------------------------------------------------------------------------- the cache ----


@pytest.fixture
def small(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[], Path]:
    """Builds a library of one function in a cache of its own; returns its path."""
    (tmp_path / "small.c").write_text("int small(void);\nint small(void) { return 42; }\n")
    monkeypatch.setattr(paths, "build", tmp_path / "build")
    return lambda: library("small", (), [tmp_path / "small.c"], "-O0")


def put(path: Path, data: bytes) -> None:
    """In place of a file that this process may have mapped."""
    path.with_suffix(".new").write_bytes(data)
    path.with_suffix(".new").replace(path)


def of_another_machine(made: Path) -> None:
    """All is whole, but the machine of the ELF header is another one."""
    data = bytearray(made.read_bytes())
    data[18:20] = (8).to_bytes(2, "little")  # MIPS
    put(made, data)
    (made.parent / cache.WHOLE).write_text(json.dumps(cache._digests(made.parent)))


def a_file(made: Path) -> None:
    shutil.rmtree(made.parent)
    made.parent.write_text("something else")


DAMAGES: dict[str, Callable[[Path], None]] = {
    "truncated": lambda made: put(made, made.read_bytes()[: made.stat().st_size // 2]),
    "empty": lambda made: put(made, b""),
    "garbage": lambda made: put(made, os.urandom(made.stat().st_size)),
    "missing": Path.unlink,
    "of another version": lambda made: (made.parent / cache.WHOLE).unlink(),
    "of another machine": of_another_machine,
    "a file": a_file,
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_library_that_cannot_be_loaded_is_built_again(
    small: Callable[[], Path], capsys: pytest.CaptureFixture[str], damage: str
) -> None:
    made = small()
    whole = made.read_bytes()
    assert capsys.readouterr().out.startswith("Building small ...\n")
    DAMAGES[damage](made)
    assert small() == made and made.read_bytes() == whole
    said = capsys.readouterr().out.splitlines()
    assert len(said) == 2 and re.fullmatch(r"Building small again, as .+ \.\.\.", said[0])
    assert small() == made and capsys.readouterr().out == ""
    assert ctypes.CDLL(str(made)).small() == 42


def test_what_another_version_has_left_is_deleted(small: Callable[[], Path], tmp_path: Path) -> None:
    """Its hash is another one; and a folder of a process that was killed in a build goes, too."""
    for left in ("small-0123456789ab", "small.work"):
        (tmp_path / "build" / "lib" / left).mkdir(parents=True)
        (tmp_path / "build" / "lib" / left / "library.so").touch()
    folder = small().parent
    assert sorted(folder.parent.iterdir()) == [folder, folder.parent / "small.lock"]


@pytest.mark.parametrize("told", [False, True], ids=["quiet", "told"])
def test_a_disk_that_fills_up_in_a_build(
    small: Callable[[], Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, told: bool
) -> None:
    """Whether the tool notices it or leaves half a file: nothing is in the cache, and the next one works."""
    with monkeypatch.context() as patch:
        patch.setattr(os, "posix_fallocate", full)
        if told:
            patch.setattr("passo.compiler.call", full_for_cc)
        with pytest.raises(BuildError, match=r"No space left on device; PASSO_BUILD names another folder$"):
            small()
    assert [path.name for path in (tmp_path / "build" / "lib").iterdir()] == ["small.lock"]
    assert ctypes.CDLL(str(small())).small() == 42


def full(*_: object) -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def full_for_cc(*_: object) -> None:
    raise BuildError("cc failed:\nld: a.o: not a file\nld: and more")


def test_a_tool_that_says_the_disk_is_full_is_quoted_in_a_line() -> None:
    said = "echo one >&2; echo 'x.o: No space left on device' >&2; echo three >&2; exit 1"
    with pytest.raises(BuildError, match=r"^sh failed: x\.o: No space left on device$"):
        call(["sh", "-c", said])


def mounted(size: str, folder: Path, command: list[str]) -> subprocess.CompletedProcess[str]:
    """Run a command in a name space of its own with a small disk."""
    script = f'mount -t tmpfs -o size={size} tmpfs "$0" && exec "$@"'
    own = ["unshare", "-m"] if os.geteuid() == 0 else ["unshare", "-Urm"]
    env = {**os.environ, "PASSO_BUILD": str(folder)}
    return subprocess.run(
        [*own, "sh", "-c", script, str(folder), *command], env=env, capture_output=True, text=True
    )


SMALL = """
import sys
from pathlib import Path
from passo.compiler import library
from passo.failure import BuildError
try:
    library("small", (), [Path(sys.argv[1])], "-O0")
except BuildError as error:
    sys.exit(str(error))
"""


@pytest.mark.parametrize(("size", "fits"), [("4k", False), ("16k", False), ("1m", False), ("1200k", True)])
def test_a_small_disk(tmp_path: Path, size: str, fits: bool) -> None:
    """No room for the library, for its list, for what must be left; and room for all of it."""
    (tmp_path / "small.c").write_text("int small(void);\nint small(void) { return 42; }\n")
    (tmp_path / "disk").mkdir()
    if mounted(size, tmp_path / "disk", ["true"]).returncode:
        pytest.skip("no file system may be mounted here")
    command = [sys.executable, "-c", SMALL, str(tmp_path / "small.c")]
    done = mounted(size, tmp_path / "disk", command)
    assert done.returncode == (0 if fits else 1)
    assert fits or ("No space left on device" in done.stderr and done.stderr.count("\n") == 1)


def test_the_command_mends_its_cache(tmp_path: Path) -> None:
    """A library that ends too early would kill the process that loads it."""
    (tmp_path / "moves.toml").write_text(MOVES)
    ffi()  # its declarations are in the cache as well
    declared = (paths.build / "lib").glob("declarations-*")
    for made in (planner_library().parent, model_library().parent, *filter(Path.is_dir, declared)):
        shutil.copytree(made, tmp_path / "lib" / made.name)
    (planner,) = (tmp_path / "lib").glob("planner-*/library.so")
    os.truncate(planner, planner.stat().st_size // 2)
    command = [sys.executable, "-m", "passo.cli", "run", "moves.toml", "--engine", "model", "--out", "out"]
    env = {**os.environ, "PASSO_BUILD": str(tmp_path)}
    done = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    said = "Building planner again, as the one in the cache is incomplete ..."
    assert [line for line in done.stdout.splitlines() if line.startswith("Building")] == [said]


# ------------------------------------------------------------------------------------------ results ----


@contextmanager
def limited(size: int) -> Iterator[None]:
    """No file of this process may become longer, as if the disk were full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


PLACES = ("standard output or a temporary file:",)  # of a pool of processes
ENDS = {".png": b"IEND\xaeB`\x82", ".html": b"</html>\n", ".csv": b"\n", ".gtkw": b"\n"}


def is_whole(waves: Path) -> bool:
    """Of an FST file: its blocks, each of which begins with kind and length, with header and geometry."""
    data, place, kinds = waves.read_bytes(), 0, set()
    while place < len(data):
        kinds.add(data[place])
        place += 1 + int.from_bytes(data[place + 1 : place + 9], "big")
    return place == len(data) and {0, 3} <= kinds


def is_complete(path: Path) -> bool:
    if path.suffix == ".json":
        return bool(json.loads(path.read_text()))
    if path.suffix == ".fst":
        return is_whole(path)
    return path.name == "settings" or path.read_bytes().endswith(ENDS.get(path.suffix, b"\n"))


def in_part(source: Any, made: Any) -> None:
    made.write(source.read(100))
    raise OSError(errno.EFBIG, os.strerror(errno.EFBIG))


def files(out: Path) -> list[Path]:
    return [path for path in out.rglob("*") if path.is_file()]


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_is_a_sentence(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """At any length of a file: files are complete, nothing else is left, and the next run is good."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    out, refused = tmp_path / "out", 0
    smaller(monkeypatch, out)
    command = [word.replace("OUT", str(out)) for word in WRITERS[name]]
    good = 1 if name == "campaign" else 0  # which has a failure to write down
    copy = shutil.copyfileobj
    out.mkdir()
    assert main(command) == good  # what it needs is built
    if name == "waves":  # which are recorded in memory, that is limited as well
        monkeypatch.setattr("passo.waves.shutil.copyfileobj", in_part)
    for limit in (NO_LIMIT,) if name == "waves" else LIMITS:
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir()
        capsys.readouterr()
        with limited(limit):
            status = main(command)
        said = capsys.readouterr().err
        assert status in (0, 1) and said.count("\n") == bool(said)
        if said:
            assert status == 1 and said.startswith((*PLACES, str(out))) and "File too large" in said
            refused += 1
        else:
            assert status == good
        left = files(out)
        assert all(path.stat().st_size <= limit and is_complete(path) for path in left), left
        assert not [path.name for path in left if path.name.startswith(".")]
    monkeypatch.setattr("passo.waves.shutil.copyfileobj", copy)
    assert refused and main(command) == good and all(map(is_complete, files(out)))


@pytest.mark.parametrize("where", ["", "/below"])
def test_a_place_that_cannot_be_written_is_bad_input(
    where: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").touch()
    out = f"{tmp_path}/file{where}"
    (tmp_path / "moves.toml").write_text(MOVES)
    for command in (
        ["run", str(tmp_path / "moves.toml"), "--engine", "model", "--out", out],
        ["run", str(PART / "part.nc"), "--machine", str(PART / "machine.toml"), "--out", out],
        ["shape", "--formula", "u", "--out", f"{out}/shape.csv"],
        ["shape", "--formula", "u", "--plot", f"{out}/shape.png"],
        ["campaign", "--moves", "1", "--seed", "1", "--json", f"{out}/campaign.json"],
    ):
        assert main(command) == 2
        said = capsys.readouterr().err
        assert out in said and said.count("\n") == 1


# Commands with an output, and what of the work comes first. BAD: a place that cannot be written.
EARLY = {
    "run": (["run", "moves.toml", "--out", "BAD"], "passo.run_command.read_channels"),
    "part": (["run", "part.nc", *MACHINE, "--out", "BAD"], "passo.part_command.read_part"),
    "preview": (["preview", "part.nc", *MACHINE, "--out", "BAD"], "passo.preview_command.read_part"),
    "make": (["make", MACHINE[1], "--out", "BAD"], "passo.make_command.read_machine"),
    "expand": (["expand", "part.nc", "--out", "BAD/"], "passo.expand.expand_command.expand_file"),
    "heightmap": (
        ["heightmap", "--probe", "0,0,9,9", "--out", "BAD/"],
        "passo.expand.expand_command.probing_program",
    ),
    "shape": (["shape", "--formula", "u", "--out", "BAD/"], "passo.shape.sample"),
    "plot": (["shape", "--formula", "u", "--plot", "BAD/"], "passo.shape.sample"),
    "serve": (["serve", "socket", "--edges", "BAD/"], "passo.serve_command._engine"),
    "json": (
        ["campaign", "--moves", "1", "--seed", "1", "--json", "BAD/"],
        "passo.campaign_command.prepare",
    ),
    "campaign": (
        ["campaign", "--moves", "1", "--seed", "1", "--out", "BAD"],
        "passo.campaign_command.prepare",
    ),
}


@pytest.mark.parametrize("name", EARLY)
def test_a_place_that_cannot_be_written_is_refused_before_the_work(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A folder where a file is wanted, a file where a folder is, or no folder; one without permission."""
    monkeypatch.chdir(tmp_path)
    words, work = EARLY[name]
    monkeypatch.setattr(work, lambda *_, **__: pytest.fail("begun"))
    (tmp_path / "file").touch()
    (tmp_path / "folder").mkdir()
    (tmp_path / "circle").symlink_to("circle")
    access = os.access
    monkeypatch.setattr(os, "access", lambda path, mode: path.name != "locked" and access(path, mode))
    (tmp_path / "locked").mkdir()
    wants_file = words[-1] == "BAD/"
    places = {"file/x": "Not a directory", "locked/x": "Permission denied", "n" * 999: "File name too long"}
    places |= {"folder": "Is a directory"} if wants_file else {"file": "Not a directory"}
    if wants_file and name != "json":  # which makes it
        places["none/x"] = "No such file or directory"
    before = sorted(tmp_path.rglob("*"))
    for place, reason in places.items():
        assert main([*words[:-1], place]) == 2
        said = capsys.readouterr()
        assert said.err == f"{words[-2]} {place}: {reason}\n" and not said.out
    assert main([*words[:-1], "circle"]) == 2
    assert sorted(tmp_path.rglob("*")) == before


def test_a_device_stays_one(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["shape", "--formula", "u", "--out", "/dev/full"]) == 1
    assert capsys.readouterr().err == "/dev/full: No space left on device\n"
    assert Path("/dev/full").is_char_device()


def test_a_file_is_old_or_new(tmp_path: Path) -> None:
    """Through a link as well; the error tells the name that the user knows."""
    (tmp_path / "real").write_text("old")
    (tmp_path / "link").symlink_to("real")
    with pytest.raises(Failure, match=f"^{tmp_path / 'link'}: File too large$"), limited(100):
        output.write_text(tmp_path / "link", "new" * 100)
    assert (tmp_path / "real").read_text() == "old"
    with pytest.raises(BadInputError, match="No such file"):
        output.write_text(tmp_path / "no folder" / "file", "new")
    output.write_text(tmp_path / "link", "new")
    assert (tmp_path / "real").read_text() == "new" and (tmp_path / "link").is_symlink()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link", "real"]


# What writes by itself, and why nobody else reads it if it is not complete.
DIRECT = {
    "sim/passo/output.py": "is the writer",
    "sim/passo/cache.py": "into a folder that is renamed",
    "sim/passo/build.py": "into a folder of the cache",
    "sim/passo/planted.py": "into a copy of the sources",
    "sim/passo/grbl_setup.py": "words of a flash that is simulated",
    "benchmarks/play_case.py": "into a temporary folder",
    "benchmarks/first_hour.py": "into a temporary folder",
    "benchmarks/height_map.py": "into a temporary folder",
    "benchmarks/rigid_tapping.py": "into a temporary folder",
    "sim/passo/page/expanding.py": "in a page, into its memory",
    "tools/make_site.py": "into a folder that is created each time",
    "tools/c_api.py": "into a folder that is created each time",
    "benchmarks/preview.py": "into a temporary folder",
    "stm32_bridge/passo_stm32/play.py": "into a temporary folder",
    "stm32_bridge/passo_stm32/board.py": "a lock",
    "verify/equal/wiring.py": "into a copy of the sources",
    "verify/formal/run.py": "into a folder of its own",
    "verify/mutants/c_equal.py": "into a folder that is created each time",
    "verify/mutants/equivalence.py": "into a folder of its own",
    "verify/mutants/c_judge.py": "a map that its own workers share",
    "verify/mutants/c_source.py": "into a folder that is created each time",
    "verify/mutants/c_worker.py": "into the map of its judge",
    "verify/mutants/formal_judge.py": "into a folder of its own",
    "verify/mutants/netlist.py": "into a folder that is created each time",
    "syn/passo_fpga/flow.py": "into a folder that is renamed",
    "syn/passo_fpga/netlist.py": "into a folder that is renamed",
    "syn/passo_fpga/block_ram.py": "into a folder that is renamed",
    "syn/passo_fpga/tools.py": "a log",
}
WRITES = re.compile(
    r"""(?<!\bwrite)(\.write_(text|bytes)\(|savefig\((?!part)|print_png\((?!part)|json\.dump\(|shutil\.copy\()"""
    r"""|(?<!part)\.open\(["'](w|r\+|a|x)|(?<![.\w])open\([^)]*["'][wax]b?["']"""
)


def test_everything_else_writes_complete_files() -> None:
    """All that leaves results, reports and generated files."""
    folders = (
        "sim/passo",
        "stm32_bridge/passo_stm32",
        "benchmarks",
        "spec",
        "syn/passo_fpga",
        "tools",
        "verify",
    )
    found = set()
    for folder in folders:
        for path in (paths.root / folder).rglob("*.py"):
            if WRITES.search(path.read_text()):
                found.add(str(path.relative_to(paths.root)))
    assert found == set(DIRECT)
