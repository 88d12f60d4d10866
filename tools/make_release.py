# SPDX-License-Identifier: MIT
"""Make the archive of a release: `make release`.

    python -m tools.make_release [--no-machines] [--out FOLDER]

Writes NAME.tar.gz and NAME.tar.gz.sha256 to build/release/. NAME is passo-VERSION if HEAD has the tag
vVERSION, else passo-VERSION-gCOMMIT. The same commit makes the same bytes with the same tools: times are
those of the commit. Uncommitted changes are an error.

    source/        the repository
    machines/      of each examples/machines/*.toml: bitstream, firmware, settings, wiring
    sbom.json      CycloneDX: version and license of each package of requirements*.txt and each Debian tool
    licenses/      of the Debian tools, and of packages that only have a file; the others are in sbom.json
    tested.md      each promise, the command, the result, the date (tools/release.toml)
    SHA256SUMS     of all files
"""

import argparse
import gzip
import hashlib
import io
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile
import tomllib
from importlib.metadata import distribution
from pathlib import Path

from passo.console import stages
from passo.failure import BadInputError, Failure
from passo.make_command import make_machine
from passo.output import write_bytes, write_text
from passo.toolchain import paths, short

PROMISES = paths.tools / "release.toml"
MACHINES = sorted((paths.examples / "machines").glob("*.toml"))
# What images are made with, and what every setup has.
DEBIAN = (
    *("gcc-arm-none-eabi", "libnewlib-arm-none-eabi", "binutils-arm-none-eabi"),
    *("python3", "iverilog", "g++", "make", "perl", "git", "liblz4-dev", "zlib1g-dev"),
)
# of a machine; the compiler also leaves files that contain paths
SHIPPED = (".bin", ".bit", ".fs", ".hex", ".html", ".sh", ".svg", ".txt")
COPYRIGHT = "/usr/share/doc/{}/copyright"


def call(*command: str | Path, **variables: str) -> bytes:
    """Standard output of a program. Raises Failure."""
    done = subprocess.run(
        list(map(str, command)), cwd=paths.root, env={**os.environ, **variables}, capture_output=True
    )
    if done.returncode:
        raise Failure(f"{command[0]}: {done.stderr.decode().strip() or done.stdout.decode().strip()}")
    return done.stdout


def git(*words: str) -> str:
    """What git says of the repository."""
    return call("git", *words).decode().strip()


def release_name() -> str:
    """Of HEAD. Raises BadInputError for a tag of another version."""
    version = git("show", "HEAD:VERSION")
    tags = [tag for tag in git("tag", "--points-at", "HEAD").split() if re.match(r"v\d", tag)]
    if not tags:
        return f"passo-{version}-g{git('rev-parse', '--short=10', 'HEAD')}"
    if f"v{version}" not in tags:
        raise BadInputError(f"the tag is {tags[0]}, but VERSION is {version}")
    return f"passo-{version}"


def tested() -> str:
    """The page of the promises; the date is that of the commit that changed the page of figures last."""
    rows = []
    for promise in tomllib.loads(PROMISES.read_text(encoding="utf-8"))["promise"]:
        page = promise["page"]
        found = list(re.finditer(promise["figure"], git("show", f"HEAD:{page}")))
        if not found:
            raise Failure(f"{page}: no figure of '{promise['text']}'; see {short(PROMISES)}")
        results = [promise["result"].format(*figure.groups(), count=len(found)) for figure in found]
        result = "; ".join(dict.fromkeys(results))
        date = git("log", "-1", "--format=%cs", "HEAD", "--", page)
        rows.append(
            f"| {promise['text']} | `{promise['command']}` | {result} | {date} | [{page}](source/{page}) |"
        )
    note = "The date is that of the commit that last changed the page of figures."
    head = "| promise | command | result | date | all figures |\n|---|---|---|---|---|"
    return "\n".join((f"# {release_name()}: what was tested", "", note, "", head, *rows, ""))


def debian_components() -> list[dict[str, object]]:
    """The Debian tools that are installed, as CycloneDX has them; the text is in licenses/."""
    made = []
    for name in DEBIAN:
        asked = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", name], capture_output=True, text=True)
        if asked.returncode == 0 and asked.stdout:
            made.append(
                {
                    "type": "application",
                    "bom-ref": name,
                    "name": name,
                    "version": asked.stdout,
                    "purl": f"pkg:deb/debian/{name}@{asked.stdout}",
                    "licenses": [{"license": {"name": f"see licenses/{name}.txt"}}],
                }
            )
    return made


def pinned() -> set[str]:
    """The names of all packages of requirements*.txt, in one spelling."""
    lines = "\n".join(path.read_text(encoding="utf-8") for path in paths.root.glob("requirements*.txt"))
    return {spelled(name) for name in re.findall(r"(?m)^([\w.-]+)==", lines)}


def spelled(name: str) -> str:
    """The name of a package, of which there are several spellings."""
    return re.sub(r"[-_.]+", "-", name).lower()


def license_files(name: str) -> dict[str, bytes]:
    """Those of an installed package, as members of the archive."""
    beside = [path for path in distribution(name).files or () if "licen" in path.name.lower()]
    text = b"\n".join(Path(str(path.locate())).read_bytes() for path in beside)
    return {f"licenses/{name}.txt": text} if text else {}


def bill_of_materials(epoch: str, complete: bool) -> dict[str, bytes]:
    """The tools that the repository names, whatever else is installed, and licenses that are but files.

    Raises Failure if it must be complete and one is not installed.
    """
    program = Path(sys.executable).with_name("cyclonedx-py")
    options = (
        "--output-reproducible",
        "--no-validate",  # what is shipped is validated instead
        "--gather-license-texts",
        "--pyproject",
        paths.root / "pyproject.toml",
    )
    made = json.loads(call(program, "environment", *options, sys.executable, SOURCE_DATE_EPOCH=epoch))
    named = pinned()
    parts = [part for part in made["components"] if spelled(part["name"]) in named]
    if complete and (missing := named - {spelled(part["name"]) for part in parts}):
        raise Failure(f"not installed, but in requirements*.txt: {', '.join(sorted(missing))}")
    files: dict[str, bytes] = {}
    for part in parts:
        if not part.get("licenses"):
            files |= license_files(part["name"])
            part["licenses"] = [{"license": {"name": f"see licenses/{part['name']}.txt"}}]
    parts += debian_components()
    made["components"] = sorted(parts, key=lambda part: part["bom-ref"])
    there = {part["bom-ref"] for part in (*parts, made["metadata"]["component"])}
    made["dependencies"] = [
        one | {"dependsOn": [ref for ref in one.get("dependsOn", ()) if ref in there]}
        for one in made["dependencies"]
        if one["ref"] in there
    ]
    bill = json.dumps(made, indent=1, sort_keys=True)
    if complete:
        validate(bill)
    return {"sbom.json": bill.encode() + b"\n", **files}


def validate(bill: str) -> None:
    """Raises Failure if a bill of materials breaks the schema of CycloneDX; takes half a minute."""
    from cyclonedx.schema import SchemaVersion
    from cyclonedx.validation.json import JsonStrictValidator

    if problem := JsonStrictValidator(SchemaVersion.V1_6).validate_str(bill):
        raise Failure(f"sbom.json: {problem.data.json_path} breaks the schema of CycloneDX")


def source_files() -> dict[str, tuple[bytes, int]]:
    """Contents and modes of the files of HEAD."""
    made = {}
    with tarfile.open(fileobj=io.BytesIO(call("git", "archive", "HEAD"))) as archive:
        for member in archive:
            if member.isfile():
                made[f"source/{member.name}"] = (archive.extractfile(member).read(), member.mode)
    return made


def machine_files(folder: Path) -> dict[str, tuple[bytes, int]]:
    """Make the example machines in a folder; contents and modes of what they are made of."""
    for file in MACHINES:
        if not make_machine(file, folder / file.stem):
            raise Failure(f"{short(file)}: the bitstream misses its clock")
    files = sorted(path for path in folder.rglob("*") if path.suffix in SHIPPED)
    return {
        f"machines/{path.relative_to(folder)}": (path.read_bytes(), path.stat().st_mode) for path in files
    }


def pack(name: str, files: dict[str, tuple[bytes, int]], epoch: int, out: Path) -> Path:
    """Write the archive: sorted, without users, one time for all."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for path, (content, mode) in sorted(files.items()):
            member = tarfile.TarInfo(f"{name}/{path}")
            member.size, member.mtime, member.mode = len(content), epoch, 0o755 if mode & 0o100 else 0o644
            archive.addfile(member, io.BytesIO(content))
    out.mkdir(parents=True, exist_ok=True)
    made = out / f"{name}.tar.gz"
    write_bytes(made, gzip.compress(packed.getvalue(), 9, mtime=epoch))
    write_text(made.with_name(f"{made.name}.sha256"), f"{digest(made.read_bytes())}  {made.name}\n")
    return made


def digest(content: bytes) -> str:
    """SHA-256."""
    return hashlib.sha256(content).hexdigest()


def make_release(out: Path, machines: bool = True) -> Path:
    """Make the archive of HEAD; the machines are made of the sources as they are now."""
    epoch, name = git("log", "-1", "--format=%ct", "HEAD"), release_name()
    files = source_files()
    tell = stages()
    if machines:
        tell(f"release: {len(MACHINES)} machines")
        os.environ["SOURCE_DATE_EPOCH"] = epoch
        with tempfile.TemporaryDirectory() as folder:
            files |= machine_files(Path(folder))
    tell("release: bill of materials")
    files |= {path: (content, 0) for path, content in bill_of_materials(epoch, machines).items()}
    files["tested.md"] = (tested().encode(), 0)
    for part in debian_components():
        files[f"licenses/{part['name']}.txt"] = (Path(COPYRIGHT.format(part["name"])).read_bytes(), 0)
    sums = "".join(f"{digest(content)}  {path}\n" for path, (content, _) in sorted(files.items()))
    files["SHA256SUMS"] = (sums.encode(), 0)
    return pack(name, files, int(epoch), out)


def main() -> int:
    """Of the command."""
    parser = argparse.ArgumentParser(description="Make the archive of a release.")
    parser.add_argument("--no-machines", action="store_true", help="without bitstreams and firmware")
    parser.add_argument("--out", type=Path, default=paths.results / "release", metavar="FOLDER")
    options = parser.parse_args()
    try:
        if changed := git("status", "--porcelain", "--untracked-files=no"):
            raise BadInputError(f"there are uncommitted changes:\n{changed}")
        made = make_release(options.out, not options.no_machines)
    except Failure as error:
        print(error, file=sys.stderr)
        return 1
    print(f"{short(made)}: {made.stat().st_size / 1e6:.1f} MB, sha256 {digest(made.read_bytes())}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
