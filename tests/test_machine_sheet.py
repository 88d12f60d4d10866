# SPDX-License-Identifier: MIT
"""The wiring sheet of a machine."""

import re
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest
from passo.cli import main
from passo.drives import drives
from passo.machine_sheet import NOTES
from passo.toolchain import paths

ROUTER = (paths.examples / "machines" / "router.toml").read_text()
LINUX = 'host = "linuxcnc"\n'
SVG = "{http://www.w3.org/2000/svg}"
LETTER = 6.4  # width of a letter at most, on average of a word, in units of the drawing
BOARDS = ("hx8k", "icebreaker", "tangnano9k")
HOSTS = pytest.mark.parametrize(
    ("board", "head", "host"),
    [*((board, "", "Blue Pill") for board in BOARDS), ("hx8k", LINUX, "Raspberry Pi")],
)


def sheet(folder: Path, text: str) -> tuple[list[list[str]], ElementTree.Element, str]:
    """The rows of wiring.txt, the drawing, the page."""
    (folder / "machine.toml").write_text(text)
    out = folder / "out"
    assert main(["make", str(folder / "machine.toml"), "--out", str(out), "--no-build"]) == 0
    rows = [re.split(r" {2,}", line) for line in (out / "wiring.txt").read_text().splitlines()[1:]]
    drawing = ElementTree.parse(out / "wiring.svg").getroot()
    return rows, drawing, (out / "wiring.html").read_text()


@HOSTS
def test_every_wire_is_drawn_and_in_the_table(tmp_path: Path, board: str, head: str, host: str) -> None:
    """A line for each that leads somewhere, with its place and its end; a row for each."""
    rows, drawing, page = sheet(tmp_path, head + ROUTER.replace("hx8k", board))
    texts = [text.text or "" for text in drawing.iter(f"{SVG}text")]
    used = [row for row in rows if row[-1] not in ("not connected", "on the board")]
    assert len(list(drawing.iter(f"{SVG}path"))) == len(used) + 1  # and that of ground
    assert host in texts and f"FPGA board, {host}, buffers" in page
    assert sum(row[-1].startswith(f"{host} ") for row in rows) == 5  # SPI and irq
    for signal, pin, *place, end in used:
        assert signal in texts and (place or [pin])[0] in texts
        label = end.removeprefix(f"{host} ").partition(", ")[0]
        assert re.sub("^drive .: ", "", label) in texts
    cells = [re.findall("<td[^>]*>(.*?)</td>", row) for row in re.findall(r"<tr>(<td.*?)</tr>", page)]
    assert [[cell[3], cell[2], cell[4]] for cell in cells] == [[row[0], row[1], row[-1]] for row in rows]


@HOSTS
def test_no_words_run_into_others(tmp_path: Path, board: str, head: str, host: str) -> None:
    """Nor out of the drawing."""
    _, drawing, _ = sheet(tmp_path, head + ROUTER.replace("hx8k", board))
    lines: dict[float, list[tuple[float, float, str]]] = {}
    for text in drawing.iter(f"{SVG}text"):
        words = text.text or ""
        width = LETTER * len(words) * (0.88 if "small" in text.get("class", "") else 1)
        x = (
            float(text.get("x", 0))
            - width * {"start": 0, "middle": 0.5, "end": 1}[text.get("text-anchor", "")]
        )
        lines.setdefault(float(text.get("y", 0)), []).append((x, x + width, words))
    for line in lines.values():
        line.sort()
        assert line[0][0] >= 0 and line[-1][1] <= float(drawing.get("width", 0))
        for left, right in pairwise(line):
            assert left[1] <= right[0], (left, right)


@pytest.mark.parametrize("name", ["A4988", "DM542", "servo-24V", "servo-RS422"])
def test_what_a_drive_needs(tmp_path: Path, name: str) -> None:
    """Buffers where 3.3 V are too little, no channel of them twice; the note of its kind of inputs."""
    _, _, page = sheet(tmp_path, ROUTER.replace("DM542", name))
    channels = re.findall(r"74HCT245 (U\d A\d), B\d", page)
    of_drives = 9 * (drives()[name].input == "opto-5V")
    assert len(channels) == len(set(channels)) == of_drives + 5  # and spindle and coolant
    assert NOTES[drives()[name].input].replace("&", "&amp;") in page


def test_every_drive_has_a_kind_of_inputs() -> None:
    """One that the sheet knows."""
    assert {drive.input for drive in drives().values()} == set(NOTES)


@pytest.mark.parametrize(
    ("inverted", "closed"),
    [("false", "NC to ground, 10 kohm to 3.3 V"), ("true", "NC to 3.3 V, 10 kohm to ground")],
)
def test_switches_are_closed_until_they_are_active(tmp_path: Path, inverted: str, closed: str) -> None:
    """Low if high is active, high if low is."""
    _, drawing, page = sheet(tmp_path, ROUTER.replace("inverted = false", f"inverted = {inverted}"))
    assert page.count(f"<td>{closed}, RC</td>") == 3
    assert sum((text.text or "").startswith(closed) for text in drawing.iter(f"{SVG}text")) >= 3
