# SPDX-License-Identifier: MIT
"""Injected faults: edits to a copy of a source that a check must detect, to prove that it can fail."""

import re
from pathlib import Path


def plant(file: Path, old: str, new: str) -> None:
    """Replace a text in a copy of a source; whitespace is not significant.

    Raises:
        ValueError: The old text does not occur exactly once.
    """
    text = file.read_text(encoding="utf-8")
    pattern = re.compile(r"\s+".join(re.escape(word) for word in old.split()))
    found = len(pattern.findall(text))
    if found != 1:
        raise ValueError(f"{file.name}: expected once, found {found} times: {old!r}")
    file.write_text(pattern.sub(lambda _: new, text), encoding="utf-8")
