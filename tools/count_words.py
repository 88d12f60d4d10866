# SPDX-License-Identifier: MIT
"""Count the words of README.md and of the pages in docs/ that are written by hand, against their limits."""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
README_MAX = 1_500
DOCS_MAX = 43_850
# docs/reference/ does not count, nor do the generated tables in other pages
GENERATED = re.compile(r"<!-- (moves|report)\b.*?<!-- (/moves|to here) -->", re.S)


def words(page: Path) -> int:
    """As `wc -w` counts them, without generated tables."""
    return len(GENERATED.sub("", page.read_text(encoding="utf-8")).split())


def hand_written() -> dict[Path, int]:
    """The words of each page in docs/, without docs/reference/."""
    return {page: words(page) for page in sorted((ROOT / "docs").glob("*.md"))}


def main() -> int:
    """Print the pages, the longest first, and the sums; 1 if a limit is exceeded."""
    pages = hand_written()
    for page, count in sorted(pages.items(), key=lambda item: -item[1]):
        print(f"{count:7,}  {page.relative_to(ROOT)}")
    sums = (
        (words(ROOT / "README.md"), README_MAX, "README.md"),
        (sum(pages.values()), DOCS_MAX, "docs/*.md"),
    )
    for count, limit, name in sums:
        print(f"{count:7,}  {name} (limit {limit:,})")
    return int(any(count > limit for count, limit, _ in sums))


if __name__ == "__main__":
    sys.exit(main())
