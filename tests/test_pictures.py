# SPDX-License-Identifier: MIT
"""The pictures of the documents show what there is (`make pictures`)."""

from typing import Any

import pytest
from passo_fpga.boards import boards
from PIL import Image

from tools import draw_pictures
from tools.pictures.wiring import AXIS_PINS, places

PICTURES = {name: facts for name, facts, _ in draw_pictures.pictures()}


def drawn(name: str) -> Any:
    """The digest that a picture keeps."""
    with Image.open(draw_pictures.IMAGES / name) as image:
        return image.text[draw_pictures.DIGEST]  # type: ignore[attr-defined]


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_shows_what_there_is(name: str) -> None:
    assert drawn(name) == draw_pictures.digest(PICTURES[name]), "run 'make pictures'"


def test_each_board_has_one() -> None:
    assert set(PICTURES) == {"idea.png", *(f"wiring-{name}.png" for name in boards())}


def test_the_wiring_has_every_pin() -> None:
    for name, board in boards().items():
        _, link, axes = PICTURES[f"wiring-{name}.png"]
        assert {signal: pin for signal, _, pin, _ in link}.items() <= {
            signal: pin.pin for signal, pin in board.pins.items()
        }.items()
        assert [[pin for _, pin, _ in axis] for axis in axes] == [
            [pins[signal].pin for signal in AXIS_PINS] for pins in board.axis_pins
        ]


def test_comments_give_the_places_on_the_connectors() -> None:
    assert places("icebreaker")["enable4"] == "PMOD1A 4"
    assert places("hx8k")["dir0"] == "J2 6"
    assert places("colorlight")["spi_sclk"] == "J5 7"
