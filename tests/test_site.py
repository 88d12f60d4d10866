# SPDX-License-Identifier: MIT
"""The site of `make site`, without the page of moves, which tests/test_web.py has."""

import json
import re
import sys
from pathlib import Path

import pytest
from passo.failure import Failure
from passo.toolchain import paths

from tools import c_api, make_site
from tools.c_api import Interface

REFUSED = {
    "a page": "[lost](docs/lost.md)",
    "a heading": "[lost](#lost)",
    "a picture": "![lost](docs/images/lost.png)",
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the site is made."""
    monkeypatch.setattr(make_site, "PAGES", tmp_path / "site" / "pages")
    monkeypatch.setattr(make_site, "HTML", tmp_path / "site" / "html")
    # the configuration names the package as seen from build/site/
    monkeypatch.setattr(make_site, "CONFIGURATION", tmp_path / "mkdocs.yml")
    text = (paths.tools / "mkdocs.yml").read_text().replace("../../sim", str(paths.sim))
    (tmp_path / "mkdocs.yml").write_text(text)
    return tmp_path / "site"


def test_the_site(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It has all documents, the API with its docstrings, a search, and nothing from other servers."""
    monkeypatch.setattr(sys, "argv", ["make_site", "--no-web"])
    assert make_site.main() == 0
    html = folder / "html"
    pages = [page for page in paths.docs.rglob("*.md") if page.name != "README.md"]
    assert all((html / page.relative_to(paths.root).with_suffix(".html")).exists() for page in pages)
    found = json.loads((html / "search" / "search_index.json").read_text())["docs"]
    assert any("ENABLE_RESET" in page["text"] for page in found)
    assert "Queue a move, as" in (html / "api" / "passo.driver.html").read_text()
    machine = (html / "api" / "passo.host_machine.html").read_text()
    assert "as fast as the axes can" in machine and "Raises BadInputError" in machine
    index = (html / "api" / "index.html").read_text()
    assert all(f'href="passo.{module}.html"' in index for module in make_site.FOR_PROGRAMS.values())
    assert "passo_home" in (html / "stm32_bridge" / "driver" / "passo.h.html").read_text()
    assert 'id="passo_resume"' in (html / "api" / "c" / "passo.h.html").read_text()
    assert any("Takes over from rest, clears a stopped channel" in page["text"] for page in found)
    tutorial = (html / "examples" / "python" / "tutorial.ipynb.html").read_text()
    assert "off the plan by at most" in tutorial and tutorial.count("<img") == 3
    for page in html.rglob("*.html"):
        assert not re.findall(
            r'<(?:script|img)[^>]* src="https?:|<link[^>]*stylesheet[^>]*https?:', page.read_text()
        )


@pytest.mark.parametrize("what", REFUSED)
def test_a_link_that_leads_nowhere_is_an_error(folder: Path, what: str, capfd: pytest.CaptureFixture) -> None:
    (folder / "pages").mkdir(parents=True)
    (folder / "pages" / "README.md").write_text(f"# Passo\n\n{REFUSED[what]}\n")
    assert make_site.build_html() != 0
    assert "lost" in capfd.readouterr().err


def test_the_interface_in_c(tmp_path: Path) -> None:
    """Each function, type and macro has a description; no page shows what is private."""
    interface = Interface(tmp_path)
    names = {file.name for file in interface.files}
    assert {"passo.h", "passo_linux.h", "passo_servo.h", "passo_path.h", "passo_plan.h"} <= names
    assert not {"passo_driver.h", "passo_linux_private.h", "passo_path_private.h"} & names
    assert interface.undescribed() == []
    for file in interface.files:
        declared = re.findall(r"^(?:[\w ]+[ *])?(passo_\w+)\(", file.read_text(), re.M)
        assert set(declared) <= set(interface.places), file
    pages = {file.name: interface.page(file, "source.md", "../..") for file in interface.files}
    assert "## passo_hold, passo_resume { #passo_hold }" in pages["passo.h"]
    assert "[passo_open](passo.h.md#passo_open)() does" in pages["passo_linux.h"]
    assert "| `uint32_t period_ns` | of the calls, [PASSO_SERVO_PERIOD_MIN](#" in pages["passo_servo.h"]
    assert "[NOT_PREPARED](passo_error.h.md#passo_error)" in pages["passo_servo.h"]
    assert "`struct passo *passo`" not in pages["passo_servo.h"]


def test_a_function_without_a_description(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is found; so is a comment that Doxygen does not understand."""
    header = tmp_path / "passo_one.h"
    monkeypatch.setattr(c_api, "headers", lambda: [header])
    header.write_text(
        "/* SPDX-License-Identifier: MIT\n * One. */\n\n/* Two. */\nint two(void);\n\nint one(void);\n"
    )
    assert Interface(tmp_path / "xml").undescribed() == ["one"]
    header.write_text("/* SPDX-License-Identifier: MIT\n * One. */\n\n/* @param lost */\nint one(void);\n")
    with pytest.raises(Failure, match="Doxygen: "):
        Interface(tmp_path / "xml")
