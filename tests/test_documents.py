# SPDX-License-Identifier: MIT
"""What the documents say that can be checked: worked frames, names of errors and calls, links."""

import re
import sys
from pathlib import Path

import pytest
from passo.build import Parameters
from passo.drives import drives
from passo.engine import model_engine
from passo.frame import crc
from passo.link import GAP, error_name
from passo.moves import PIN_CLOCKS_MAX
from passo.native import planner
from passo.toolchain import paths
from passo.values import parse_time

sys.path.insert(0, str(paths.tools))
import count_words

PAGES = sorted((*paths.docs.rglob("*.md"), *paths.root.glob("*.md")))
TROUBLE = paths.docs / "trouble.md"
CALLED = (paths.driver, paths.console, paths.planner, paths.protocol, paths.gcode, paths.grbl, paths.linux)
HEADERS = "".join(path.read_text() for folder in CALLED for path in sorted(folder.glob("*.h")))
FRAMES = 9
AFTER_THE_MOTION = 8  # the frame before which the motion ends
MOTION_CLOCKS = 1_100_000


def frames() -> list[tuple[list[int], list[int]]]:
    """The worked frames of link.md: the words of MOSI and MISO."""
    text = (paths.docs / "link.md").read_text()
    (block,) = re.findall(r"^## Worked frames.*?^```text\n(.*?)^```", text, re.M | re.S)
    words = r"((?: +[0-9a-f]{8}|\n     )+)\n"
    return [
        ([int(word, 16) for word in mosi.split()], [int(word, 16) for word in miso.split()])
        for mosi, miso in re.findall(rf"^    MOSI {words}    MISO {words}", block, re.M)
    ]


def test_worked_frames() -> None:
    """A core that is just reset answers them word by word; each CRC is that of header and payload."""
    made = frames()
    assert len(made) == FRAMES
    with model_engine(Parameters(axes=1), 100_000_000) as engine:
        for number, (mosi, miso) in enumerate(made):
            assert len(mosi) == len(miso)
            reads = mosi[0] >> 28 == 1
            covered = 1 if reads else 1 + (mosi[0] >> 12 & 0xFF)
            assert mosi[covered] == crc(mosi[:covered]) and not any(mosi[covered + 1 :])
            if number == AFTER_THE_MOTION:
                engine.run(MOTION_CLOCKS)
            assert list(engine.transfer(mosi, GAP)) == miso, number


def test_every_error_of_driver_and_planner_is_in_the_trouble_page() -> None:
    """And no other."""
    c = planner()
    codes = {name for name in dir(c) if name.startswith(("PASSO_ERROR_", "PASSO_OK", "PASSO_PENDING"))}
    names = {error_name(getattr(c, name)) for name in codes if getattr(c, name) < c.PASSO_ERROR_COUNT}
    names |= {error_name(c.PASSO_ERROR_PLAN + error) for error in range(1, c.PASSO_PLAN_TOO_NEAR + 1)}
    names |= {error_name(c.PASSO_ERROR_ABSURD + c.PASSO_PLAN_NO_STEPS)}
    told = set(re.findall(r"`([A-Z][A-Z_]+)`", TROUBLE.read_text()))
    words = {"STOPPED", "REFUSED", "LOST_STEPS", "LAST", "ARGUMENT", "RAMP_TOO_SHORT"}
    assert names - told == set()
    assert told - names - words == set()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_calls_exist(page: Path) -> None:
    """Functions of the driver and the planner that a page names."""
    named = set(re.findall(r"`(passo_[a-z_0-9]+)\(", page.read_text()))
    assert {name for name in named if not re.search(rf"\b{name}\b", HEADERS)} == set()


def test_settings_of_drives() -> None:
    """The table of wiring.md: times that a core at 100 MHz can make; its settings are those of the driver."""
    text = (paths.docs / "wiring.md").read_text()
    rows = re.findall(r"^\| ([^|]+) \| (\d+) \| (\d+) \| (\d+) \| (\d+) \|", text, re.M)
    assert len(rows) >= 7
    named = {word: times for name, *times in rows for word in re.findall(r"[\w-]+", name)}
    for drive in drives().values():
        times = (parse_time(key, time, 10**9) * 10**9 for key, time in drive.pins.items())
        assert named[drive.name] == [f"{time}" for time in times], drive.name
    for name, *times in rows:
        assert all(0 < int(time) * 100_000_000 // 10**9 <= PIN_CLOCKS_MAX for time in times), name
    settings = set(re.findall(r"`(\w+)`", text)) - {"PINS_TOO_SLOW", "dedge", "step_high"}
    assert settings and all(re.search(rf"\b{name}\b", HEADERS) for name in settings), settings


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    """To a file, and to a heading of it."""
    for target, anchor in re.findall(r"\]\((?!https?:)([^)#\s]*)(?:#([^)\s]+))?\)", page.read_text()):
        file = (page.parent / target).resolve() if target else page
        assert file.exists(), target
        if anchor and file.suffix == ".md":
            heads = re.findall(r"^#+ +(.+)$", file.read_text(), re.M)
            made = {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}
            assert anchor in made, f"{target}#{anchor}"


# What a newcomer asks, and words of the answer: within two clicks from the README, over docs/README.md.
QUESTIONS = {
    "What is a tick": "2\\^TICK_LOG2 clocks",
    "How exact is a move": "exact on every axis",
    "Where do I wire the e-stop": "estop_n",
    "Which timings does my drive need": "DM542",
    "How do I connect the STM32 to the FPGA": "PA[0-9]",
    "How do I flash the firmware": "flash",
    "Which sender can I use": "sender",
    "Which G-code words are supported": "G38",
    "How do I home an axis": "passo_home",
    "How do I probe": "passo_probe",
    "Why did it stop with RAMP_UNDERRUN": "RAMP_UNDERRUN",
    "The motor hums but does not turn": "hum|whistle|stall",
    "Why is a corner slow": "junction deviation",
    "What happens when the host fails": "watchdog",
    "How do I drive a laser": "power",
    "How do I cut a thread": "passo_thread|thread",
    "Does it fit on my FPGA": "HX8K",
    "How do I add a board": "board.toml",
    "How do I put the core into my own design": "passo_spi_top",
    "How do I simulate my machine without hardware": "passo run",
    "How do I know that it is correct": "make verify",
}


@pytest.mark.parametrize("question", QUESTIONS)
def test_a_question_is_answered_within_two_clicks(question: str) -> None:
    index = paths.docs / "README.md"
    assert "(docs/README.md)" in (paths.root / "README.md").read_text()
    (row,) = re.findall(rf"^\| {question}.*", index.read_text(), re.M)
    pages = [(index.parent / target).read_text() for target in re.findall(r"\]\(([^)#]+)", row)]
    assert any(re.search(QUESTIONS[question], text) for text in pages)


def test_documents_are_short() -> None:
    """Pages written by hand, counted by `make words`."""
    assert count_words.words(paths.root / "README.md") <= count_words.README_MAX == 1_500
    assert sum(count_words.hand_written().values()) <= count_words.DOCS_MAX == 43_850
