# SPDX-License-Identifier: MIT
"""The wiring sheet of a machine: an SVG, and a page to print with a table to tick off."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from itertools import groupby
from typing import NamedTuple

UNUSED = ("ground", "not connected", "on the board")
ROW, GAP, TOP = 19, 30, 64  # heights in SVG units
WIDTH = 1120
HOST_X, HOST_W, CHIP_X, CHIP_W, BUFFER_X, BUFFER_W, END_X, END_W = 10, 110, 240, 290, 600, 120, 800, 310
PIN_X, SIGNAL_X = CHIP_X + 75, CHIP_X + 130
BUFFER = "74HCT245"
CHANNELS = 8
NOTES = {
    "logic": "Direct, with 33 to 100 ohm in series at the FPGA. VIO of a TMC driver: 3.3 V.",
    "opto-5V": f"{BUFFER} at 5 V takes 3.3 V and drives the 10 mA of an opto input; an FPGA pin cannot. "
    "PUL-, DIR- and ENA- to its ground. DIR of the buffer to 5 V, OE to ground, 100 nF at each.",
    "24V": "A push-pull driver for 24 V at each input.",
    "RS-422": "A line driver (AM26LV31) for each pair, 120 ohm at the drive.",
}
SPINDLE = (
    f"Spindle and coolant: 5 V from the {BUFFER} to an optocoupler or relay module. An inverter with an "
    "analog input takes the PWM through a 0 to 10 V module, a laser its TTL input directly."
)
SWITCHES = (
    "A normally closed contact (NC) shows a broken wire as active. RC: 1 kohm to the pin, 100 nF there. "
    "Sensors of 24 V need an optocoupler instead, its transistor to ground."
)
ESTOP = (
    "E-stop: a normally closed contact of the button from 3.3 V to estop_n, 10 kohm from there to ground. "
    "A second contact must cut the power of drives and spindle without any electronics."
)
ENCODERS = (
    "Encoders: the pins take 3.3 V. Pairs of RS-422 go through a receiver at 3.3 V (AM26LV32), outputs of "
    "5 V through a 74LVC245 at 3.3 V, open collectors get 1 kohm to 3.3 V. Ground the shield at one end."
)
GROUNDS = (
    "Grounds: FPGA board, {host}, buffers and logic inputs have one, joined at one point; another wire "
    "of ground is beside the SPI wires, {wires}. The supply of the motors reaches it nowhere else."
)
VIA = {"logic": "33 to 100 ohm", "opto-5V": BUFFER, "24V": "24 V driver", "RS-422": "AM26LV31", "": ""}


class Wire(NamedTuple):
    """A pin of the FPGA and where it leads."""

    signal: str
    pin: str  # of the package
    place: str  # on the board's print; empty: the pin itself
    end: str

    @property
    def at(self) -> str:
        """What the board's print says."""
        return self.place or self.pin


class Host(NamedTuple):
    """The computer at the SPI wires."""

    name: str
    ground: str  # its pin
    wires: str  # what they must be


BLUE_PILL = Host("Blue Pill", "GND", "at most 10 cm long")


@dataclass(frozen=True)
class Sheet:
    """What a sheet tells. `drive_input` is a key of NOTES; `inverted`: switches are active low."""

    title: str
    board: str
    drive: str
    drive_input: str
    inverted: bool
    wires: Sequence[Wire]
    summary: Sequence[str]
    host: Host = BLUE_PILL

    @property
    def buffered(self) -> list[Wire]:
        """Wires that need 5 V: those of drives with opto inputs, and the outputs."""
        drives = (
            [wire for wire in self.wires if wire.end.startswith("drive ")]
            if self.drive_input == "opto-5V"
            else []
        )
        return [*drives, *(wire for wire in self.wires if _is_output(wire))]

    @property
    def channels(self) -> dict[str, str]:
        """Input and output of the buffers for each signal: `U1 A1, B1`."""
        return {
            wire.signal: f"U{number // CHANNELS + 1} A{number % CHANNELS + 1}, B{number % CHANNELS + 1}"
            for number, wire in enumerate(self.buffered)
        }

    def via(self, wire: Wire) -> str:
        """What is in the wire."""
        if wire.signal in self.channels:
            return f"{BUFFER} {self.channels[wire.signal]}"
        if wire.end.startswith("drive "):
            return VIA[self.drive_input]
        return self.contact if _is_switch(wire) else _CONTACTS.get(_kind(wire), "")

    @property
    def contact(self) -> str:
        """How a switch is connected."""
        closed, pull = ("3.3 V", "ground") if self.inverted else ("ground", "3.3 V")
        return f"NC to {closed}, 10 kohm to {pull}, RC"

    def notes(self) -> Iterator[str]:
        """What the table does not say."""
        if self.drive:
            yield f"Drives {self.drive}. {NOTES[self.drive_input]}"
        if any(_is_output(wire) for wire in self.wires):
            yield SPINDLE
        if any(_is_switch(wire) for wire in self.wires):
            yield f"Switches: {self.contact}. {SWITCHES}"
        if any(wire.signal == "estop_n" for wire in self.wires):
            yield ESTOP
        if any(_is_encoder(wire) for wire in self.wires):
            yield ENCODERS
        yield GROUNDS.format(host=self.host.name, wires=self.host.wires)


_CONTACTS = {
    "probe": "NO to 3.3 V, 10 kohm to ground",
    "estop_n": "NC to 3.3 V, 10 kohm to ground",
}


def _kind(wire: Wire) -> str:
    return wire.signal.partition("[")[0]


def _is_switch(wire: Wire) -> bool:
    return _kind(wire) in ("limit_low", "limit_high", "home") and wire.end not in UNUSED


def _is_output(wire: Wire) -> bool:
    return _kind(wire) in ("outputs", "power") and wire.end not in UNUSED


def _is_encoder(wire: Wire) -> bool:
    return _kind(wire).startswith("encoder_") and wire.end not in UNUSED


def _group(wire: Wire) -> str:
    """The block at the end of a wire."""
    if _is_encoder(wire):
        return wire.end.partition(":")[0]
    if wire.end.startswith("drive "):
        return wire.end.partition(":")[0]
    if _is_output(wire):
        return "spindle and coolant"
    return "switches, probe, e-stop" if wire.end not in UNUSED else "ground"


def _text(x: float, y: float, words: str, kind: str = "", anchor: str = "start") -> str:
    return f'<text x="{x}" y="{y}" class="{kind}" text-anchor="{anchor}">{escape(words)}</text>'


def _box(x: float, y: float, width: float, height: float, name: str, kind: str) -> str:
    return (
        f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="6" class="{kind}"/>'
        f"{_text(x + width / 2, y - 6, name, 'name', 'middle')}"
    )


def _line(x: float, to: float, y: float, kind: str) -> str:
    return f'<path d="M{x} {y}H{to}" class="wire {kind}"/>'


STYLE = """
text { font: 12px sans-serif; fill: #1b1f24 }
.name { font-weight: bold; font-size: 13px } .title { font-weight: bold; font-size: 17px }
.small { font-size: 10.5px; fill: #57606a }
rect { fill: #f6f8fa; stroke-width: 1.5; stroke: #57606a } .fpga { stroke: #0b6e4f } .host { stroke: #0a5ea8 }
.buffer { fill: #fff8e5; stroke: #a66a00 } .wire { fill: none; stroke: #57606a; stroke-width: 1.4 }
.link { stroke: #0a5ea8 } .five { stroke: #a66a00 }
"""


def draw(sheet: Sheet) -> str:
    """The SVG: host, FPGA board, buffers, and what the machine has, with a line for each wire."""
    link = [wire for wire in sheet.wires if wire.end.startswith(sheet.host.name)]
    used = [
        wire for wire in sheet.wires if wire not in link and wire.end not in ("not connected", "on the board")
    ]
    groups = [(name, list(wires)) for name, wires in groupby(sorted(used, key=_order), key=_group)]
    parts, y = [], TOP + ROW
    for name, wires in groups:
        height = ROW * len(wires) + 8
        shown = f"{name} ({sheet.drive})" if name.startswith("drive ") and sheet.drive else name
        parts.append(_box(END_X, y - ROW + 4, END_W, height, shown, "end"))
        for wire in wires:
            parts += _wire(sheet, wire, y)
            y += ROW
        y += GAP
    low = max(y - GAP, TOP + ROW * 2 * (len(link) + 1)) + 4
    parts += _host(sheet.host, link)
    boxes = [
        _box(HOST_X, TOP, HOST_W, ROW * 2 * (len(link) + 1), sheet.host.name, "host"),
        _box(CHIP_X, TOP, CHIP_W, low - TOP, sheet.board, "fpga"),
    ]
    under = "on the FPGA board, from the right: its print, the signal, the pin of the package"
    title = _text(10, 24, sheet.title, "title") + _text(10, 42, under, "small")
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {low + 12}" width="{WIDTH}">'
        f"<style>{STYLE}</style>{title}{''.join(boxes)}{''.join(parts)}</svg>\n"
    )


def _order(wire: Wire) -> tuple[int, str, int]:
    """Drives by axis, then outputs, inputs, ground."""
    group = _group(wire)
    names = ["spindle and coolant", "switches, probe, e-stop", "ground"]
    return (names.index(group) + 1, group, 0) if group in names else (0, group, 0)


def _wire(sheet: Sheet, wire: Wire, y: float) -> Iterator[str]:
    right = CHIP_X + CHIP_W
    channel = sheet.channels.get(wire.signal)
    yield _text(right - 6, y + 4, f"{wire.at}", anchor="end")
    yield _text(SIGNAL_X, y + 4, f"{wire.signal}", "small")
    if wire.place:
        yield _text(PIN_X, y + 4, f"pin {wire.pin}", "small")
    yield _line(right, END_X, y, "five" if channel else "")
    if channel:
        size = f'width="{BUFFER_W}" height="{ROW - 2}"'
        yield f'<rect x="{BUFFER_X}" y="{y - ROW / 2 + 1}" {size} class="buffer"/>'
        yield _text(BUFFER_X + BUFFER_W / 2, y + 4, channel.replace(", ", " > "), "small", "middle")
    else:
        yield _text((right + END_X) / 2, y - 3, sheet.via(wire), "small", "middle")
    label = wire.end.partition(": ")[2] if wire.end.startswith(("drive ", "encoder ")) else wire.end
    yield _text(END_X + 8, y + 4, label.partition(",")[0] if wire.signal == "estop_n" else label)


def _host(host: Host, link: Iterable[Wire]) -> Iterator[str]:
    wires = [
        *((wire.end.removeprefix(f"{host.name} "), wire.signal, wire.at) for wire in link),
        (host.ground, "ground", "GND"),
    ]
    for number, (pin, signal, at) in enumerate(wires):
        y = TOP + ROW * (2 * number + 1)
        yield _text(HOST_X + HOST_W - 6, y + 4, pin, anchor="end")
        yield _line(HOST_X + HOST_W, CHIP_X, y, "link")
        yield _text((HOST_X + HOST_W + CHIP_X) / 2, y - 4, signal, "small", "middle")
        yield _text(CHIP_X + 6, y + 4, at)


PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>
@page {{ size: A4; margin: 12mm }}
body {{ font: 13px/1.4 sans-serif; color: #1b1f24; max-width: 1120px; margin: 16px auto }}
svg {{ width: 100%; height: auto }} table {{ border-collapse: collapse; width: 100%; break-before: page }}
th, td {{ border: 1px solid #d0d7de; padding: 2px 6px; text-align: left }} th {{ background: #f6f8fa }}
tr {{ break-inside: avoid }} .box {{ width: 1.2em }}
pre {{ background: #f6f8fa; padding: 8px; white-space: pre-wrap }}
</style></head><body>
{drawing}<ul>{notes}</ul><pre>{summary}</pre>
<table><thead><tr><th class="box"></th><th>on the board</th><th>FPGA pin</th><th>signal</th><th>to</th>
<th>through</th></tr></thead><tbody>{rows}</tbody></table>
</body></html>
"""


def page(sheet: Sheet) -> str:
    """The page: drawing, notes, summary, and a row to tick off for each wire."""
    rows = "".join(
        f'<tr><td class="box">&#9744;</td>{"".join(f"<td>{escape(cell)}</td>" for cell in cells)}</tr>'
        for cells in ((wire.at, wire.pin, wire.signal, wire.end, sheet.via(wire)) for wire in sheet.wires)
    )
    notes = "".join(f"<li>{escape(note)}</li>" for note in sheet.notes())
    summary = escape("\n".join(sheet.summary))
    return PAGE.format(
        title=escape(sheet.title), drawing=draw(sheet), notes=notes, summary=summary, rows=rows
    )
