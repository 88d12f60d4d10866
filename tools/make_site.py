# SPDX-License-Identifier: MIT
"""Make the static site of `make site`: documents, pictures, API and the page of `make web`, with a search.

    python -m tools.make_site [--no-web]

Pages go to build/site/pages/, in folders as in the repository, so that their links hold; a source that a page
links to becomes a page of its own. MkDocs makes build/site/html/ of them. A link or an anchor that leads
nowhere is an error. --no-web leaves out the page of moves, which has to be compiled.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from subprocess import PIPE, STDOUT

from passo.console import stages
from passo.toolchain import paths, short

from tools.c_api import Interface

PAGES = paths.results / "site" / "pages"
HTML = paths.results / "site" / "html"
CONFIGURATION = paths.tools / "mkdocs.yml"
TOP = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "LICENSE")
LINK = re.compile(r"(\]\()([^)#\s]+)")
LANGUAGES = {".v": "verilog", ".vhd": "vhdl", ".py": "python", ".c": "c", ".h": "c", ".cpp": "cpp"}
LANGUAGES |= {".toml": "toml", ".core": "yaml"}
WEB = "web/index.html"
FOR_PROGRAMS = {
    "Machine: plan, run, home": "host_machine",
    "motions and their results": "motion",
    "speeds and limits of a plan": "course",
    "errors": "failure",
}


def source_page(source: Path) -> str:
    """A source as a page, or a folder as a list of its files."""
    name = source.relative_to(paths.root).as_posix()
    if source.is_dir():
        files = sorted(file.name for file in source.iterdir() if file.is_file())
        return f"# {name}\n\n" + "".join(f"* [{file}]({file})\n" for file in files)
    text = source.read_text(encoding="utf-8")
    return f"# {name}\n\n````{LANGUAGES.get(source.suffix, 'text')}\n{text.rstrip()}\n````\n"


def place(file: Path) -> Path:
    """Where the page of a source, a folder or a document is."""
    name = file.relative_to(paths.root)
    if file.is_dir():
        return name / "files.md"
    return name if file.suffix in (".md", ".png") else name.with_name(f"{name.name}.md")


def relinked(file: Path, text: str) -> tuple[str, list[Path]]:
    """The text of a page with links to pages in place of those to files, and the files that it links to."""
    linked: list[Path] = []
    base = file if file.is_dir() else file.parent

    def to_page(found: re.Match[str]) -> str:
        target = (base / found[2]).resolve()
        if "://" in found[2] or not target.is_relative_to(paths.root) or not target.exists():
            return found[0]  # MkDocs tells of those that lead nowhere
        linked.append(target)
        return found[1] + os.path.relpath(place(target), place(file).parent)

    return LINK.sub(to_page, text), linked


def stage(file: Path) -> list[Path]:
    """Write the page of a file of the repository; return the files that it links to."""
    made = PAGES / place(file)
    made.parent.mkdir(parents=True, exist_ok=True)
    if file.suffix == ".png":
        shutil.copyfile(file, made)
        return []
    if file.suffix == ".ipynb":  # made by stage_notebooks()
        return relinked(file, file.read_text(encoding="utf-8"))[1]
    text = file.read_text(encoding="utf-8") if file.suffix == ".md" else source_page(file)
    linked: list[Path] = []
    if file.suffix == ".md" or file.is_dir():
        text, linked = relinked(file, text)
    made.write_text(text, encoding="utf-8")
    return linked


def stage_all() -> None:
    """All pages of the repository, and what they link to."""
    waiting = [paths.root / name for name in TOP] + sorted(paths.docs.rglob("*.md"))
    done: set[Path] = set()
    while waiting:
        file = waiting.pop()
        if file not in done:
            done.add(file)
            waiting += stage(file)


def stage_api() -> None:
    """The Python package, a page for each module, and the headers of the C interface (tools/c_api.py)."""
    folder = PAGES / "api"
    folder.mkdir(parents=True)
    index = ["# API", "", "## C: driver, planner, Linux", ""]
    interface = Interface(PAGES.parent / "headers")
    for header in interface.files:
        stage(header)
        made = folder / "c" / f"{header.name}.md"
        made.parent.mkdir(exist_ok=True)
        text = interface.page(header, f"../../{place(header).as_posix()}", "../..")
        made.write_text(text, encoding="utf-8")
        index.append(f"* [{header.name}](c/{made.name})")
    index += ["", "## Python: for programs", ""]
    index += [f"* [{name}](passo.{module}.md)" for name, module in FOR_PROGRAMS.items()]
    index += ["", "## Python: all modules", ""]
    package = paths.sim / "passo"
    for module in sorted(set(package.rglob("*.py")) - set((package / "page").iterdir())):
        name = ".".join(module.relative_to(package.parent).with_suffix("").parts).removesuffix(".__init__")
        (folder / f"{name}.md").write_text(f"# {name}\n\n::: {name}\n", encoding="utf-8")
        index.append(f"* [{name}]({name}.md)")
    (folder / "index.md").write_text("\n".join((*index, "")), encoding="utf-8")


def stage_notebooks() -> None:
    """The notebooks, executed, in the place of their source."""
    from tools.notebook import NOTEBOOKS, executed, page

    for notebook in NOTEBOOKS:
        made = PAGES / place(notebook)
        text, pictures = page(executed(notebook))
        for name, data in pictures.items():
            (made.parent / name).write_bytes(data)
        made.write_text(relinked(notebook, text)[0], encoding="utf-8")


def stage_web() -> None:
    """The page of `make web`."""
    from passo.web import build

    build(PAGES / "web")


def navigation() -> str:
    """The tabs; all other pages are found by links and by the search."""
    tabs = {
        "Passo": "README.md",
        "Documents": "docs/README.md",
        "API": "api/index.md",
        "Changes": "CHANGELOG.md",
        "Try it": WEB,
    }
    return "".join(f"  - {tab}: {page}\n" for tab, page in tabs.items() if (PAGES / page).exists())


def build_html() -> int:
    """Make HTML of the pages; the exit status of MkDocs, which is not 0 if a link leads nowhere."""
    configuration = PAGES.parent / "mkdocs.yml"
    text = CONFIGURATION.read_text(encoding="utf-8")
    configuration.write_text(f"{text}\nnav:\n{navigation()}", encoding="utf-8")
    # --quiet would drop the warnings before --strict counts them
    command = (sys.executable, "-m", "mkdocs", "build", "--strict", "--config-file", configuration)
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run(command, env=environment, stdout=PIPE, stderr=STDOUT, text=True)
    if done.returncode:
        told = [line for line in done.stdout.splitlines() if not line.startswith("INFO")]
        print("\n".join(told), file=sys.stderr)
    return done.returncode


def main() -> int:
    """Of the command."""
    parser = argparse.ArgumentParser(description="Make the site of Passo.")
    parser.add_argument("--no-web", action="store_true", help="without the page of moves")
    options = parser.parse_args()
    shutil.rmtree(PAGES.parent, ignore_errors=True)
    tell = stages()
    tell("site: pages")
    stage_all()
    tell("site: API")
    stage_api()
    tell("site: notebooks")
    stage_notebooks()
    if not options.no_web:
        tell("site: page of moves")
        stage_web()
    tell("site: HTML")
    status = build_html()
    tell.end()
    if status == 0:
        files = [file for file in HTML.rglob("*") if file.is_file()]
        size = sum(file.stat().st_size for file in files)
        print(f"serve: {short(HTML)} ({len(files)} files, {size / 1e6:.1f} MB)")
    return status


if __name__ == "__main__":
    sys.exit(main())
