# SPDX-License-Identifier: MIT
"""The words of a lathe that plain lines do not have: diameters become radii."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from passo.expand.block import Word
from passo.expand.machine import Machine

DIAMETERS, RADII = 70, 80


class Said(NamedTuple):
    """A line: as text, its words, its comments."""

    text: str
    words: Sequence[Word]
    comments: Sequence[str]


def said(words: Sequence[Word], comments: Sequence[str] = ()) -> Said:
    """A line of these words."""
    return Said(" ".join([*map(str, words), *comments]), words, comments)


def plain(line: Said, machine: Machine) -> Iterator[Said]:
    """The lines that a line becomes: without G7 and G8, which `machine` keeps."""
    codes = {word.code for word in line.words if word.letter == "G"} & {DIAMETERS, RADII}
    if len(codes) == 1:
        machine.diameters = codes == {DIAMETERS}
        line = said([word for word in line.words if (word.letter, word.code) != ("G", *codes)], line.comments)
    if machine.diameters and any(word.letter == "X" for word in line.words):
        halved = [replace(word, value=word.value / 2) if word.letter == "X" else word for word in line.words]
        line = said(halved, line.comments)
    if line.text:
        yield line
