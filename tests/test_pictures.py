# SPDX-License-Identifier: MIT
"""The pictures of the documents show what there is (`make pictures`)."""

from typing import Any

import pytest
from passo_fpga.boards import boards
from passo_fpga.places import places
from PIL import Image

from tools import draw_pictures
from tools.pictures.wiring import AXIS_PINS

PICTURES = {name: facts for name, facts, _ in draw_pictures.pictures()}


def drawn(name: str) -> Any:
    """The digest that a picture keeps."""
    with Image.open(draw_pictures.IMAGES / name) as image:
        return image.text[draw_pictures.DIGEST]  # type: ignore[attr-defined]


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_shows_what_there_is(name: str) -> None:
    assert drawn(name) == draw_pictures.digest(PICTURES[name]), "run 'make pictures'"


def test_each_board_has_one() -> None:
    assert set(PICTURES) == {"idea.png", *(f"wiring-{board.folder}.png" for board in boards().values())}


def test_the_wiring_has_every_pin() -> None:
    for board in boards().values():
        _, link, axes = PICTURES[f"wiring-{board.folder}.png"]
        assert {signal: pin for signal, _, pin, _ in link}.items() <= {
            signal: pin.pin for signal, pin in board.pins.items()
        }.items()
        assert [[pin for _, pin, _ in axis] for axis in axes] == [
            [pins[signal].pin for signal in AXIS_PINS] for pins in board.axis_pins
        ]


def test_comments_give_the_places_on_the_connectors() -> None:
    assert places("icebreaker")["enable[4]"] == "PMOD1A 4"
    assert places("hx8k")["dir[0]"] == "J2 6"
    assert places("colorlight")["spi_sclk"] == "J5 7"
    outputs = [places("hx8k")[f"outputs[{bit}]"] for bit in range(8)]
    assert outputs == ["J2 33", "J2 34", "J2 35", "J2 36", "J2 37", "J2 38", "J2 21", "J2 4"]
    assert places("tangnano9k") == {}  # has the numbers of the pins printed


@pytest.mark.parametrize("name", ["hx8k", "icebreaker", "colorlight", "colorlighti5", "ulx3s-25"])
def test_every_pin_has_a_place_of_its_own(name: str) -> None:
    """But the LEDs and the oscillator; the same place means the same pin."""
    table, where = boards()[name], places(name)
    of_pins: dict[str, str] = {}
    for parts in ((), *((part,) for part in table.parts)):
        for port, pin in table.ports(2, parts).items():
            if port not in ("oscillator", "led") and where.get(port):
                assert of_pins.setdefault(where[port], pin.pin) == pin.pin
    assert len(of_pins) >= 12
