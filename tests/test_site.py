# SPDX-License-Identifier: MIT
"""The site of `make site`, without the page of moves, which tests/test_web.py has."""

import json
import re
import sys
from pathlib import Path

import pytest
from passo.toolchain import paths

from tools import make_site

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
    assert "passo_home" in (html / "stm32_bridge" / "driver" / "passo.h.html").read_text()
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
