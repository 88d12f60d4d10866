# SPDX-License-Identifier: MIT
"""Draw docs/images: the idea of the core, and the wiring of each board (`make pictures`).

The wiring is that of syn/BOARD/board.toml and of the table in docs/firmware.md; the idea shows a move that
the C model has made. Each picture keeps a digest of what it shows, which a test compares with what there
is.
"""

import hashlib
import json
from collections.abc import Callable, Iterator
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.figure import Figure
from passo.console import each
from passo.output import complete
from passo.toolchain import paths
from passo_fpga.boards import boards

from tools.pictures.idea import draw_idea, play
from tools.pictures.wiring import draw_wiring, wiring

IMAGES = paths.docs / "images"
DIGEST = "Facts"  # key of the text in the PNG


def digest(facts: Any) -> str:
    """Of what a picture shows."""
    return hashlib.sha256(json.dumps(facts).encode()).hexdigest()[:16]


def pictures() -> Iterator[tuple[str, Any, Callable[[], Figure]]]:
    """Name, facts and drawer of each."""
    shown = play()
    yield "idea.png", shown.facts(), lambda: draw_idea(shown)
    for name, board in boards().items():
        if name != board.folder:
            continue
        facts = wiring(board)
        yield f"wiring-{name}.png", facts, lambda facts=facts: draw_wiring(facts)


def main() -> None:
    """Draw all of them."""
    IMAGES.mkdir(exist_ok=True)
    for name, facts, draw in each("pictures", list(pictures())):
        figure = draw()
        with complete(IMAGES / name) as part:
            figure.savefig(part, dpi=110, facecolor="white", metadata={DIGEST: digest(facts)})
        plt.close(figure)
        print(f"drawn: docs/images/{name}")


if __name__ == "__main__":
    main()
