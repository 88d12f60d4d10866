# SPDX-License-Identifier: MIT
"""Random histories of a sender of grbl: lists of commands of tests/grbl_play.c."""

import random
from collections.abc import Callable

from tests.helpers.grbl_judge import OVERRIDES

REAL_TIME = ("21", "21", "7e", "7e", "7e", "84", "85", "85", "18", *OVERRIDES)
OTHERS = (
    *("$$", "$#", "$G", "$I", "$N", "$", "$X", "$X", "$C", "$C", "$H", "$SLP", "$RST=$", "$RST=#", "$RST=*"),
    *(
        "$N0=G21",
        "$N0=G0X3",
        "$N1=",
        "$11=0.02",
        "$11=-1",
        "$12=0.004",
        "$20=1",
        "$20=0",
        "$26=2",
        "$110=900",
    ),
    *("$120=0", "$121=300", "$10=3", "$10=255", "$30=1000", "$31=5", "$1=255", "$32=x", "$999=1", "$27=2"),
)
CODES = (
    *("G4 P0.02", "G4 P0", "M3 S500", "M5", "M8", "M9", "M0", "M2", "M30", "G92 X0", "G92.1", "G10 L2 P1 X1"),
    *("G28.1", "G20", "G21", "G90", "", "(a comment)", "; another", "%", "X1 X2", "G1 F", "G5", "Q", "(a(b"),
)
History = list[str]


def _line(chance: random.Random, number: int) -> str:
    kind = chance.random()
    axis, feed = chance.choice("XYZ"), chance.choice((600, 900, 2400, 100000))
    place = chance.choice((-1, 1)) * chance.choice((0.3, 1, 4))
    if kind < 0.3:
        return f"N{number} {chance.choice(('G1', 'G1', 'G0', 'G91 G1'))} {axis}{place} F{feed}"
    if kind < 0.35:
        return f"N{number} G2 X{place} Y{-place} R9 F{feed}"
    if kind < 0.4:
        return f"N{number} G38.{chance.randrange(2, 6)} Z{-abs(place)} F{feed}"
    if kind < 0.55:
        return f"$J={chance.choice(('G91 ', '', 'G21 G91 '))}{axis}{place} F{feed}"
    return chance.choice(OTHERS if kind < 0.75 else CODES)


def made_of(seed: int, most: int = 24) -> History:
    """A history of a number: lines, whole or in parts, and real-time bytes at any moment."""
    chance = random.Random(seed)
    made = [f"begin {chance.randrange(2)}"]
    if chance.random() < 0.8:
        made.append(f"send {b'$X'.hex()}0a")
    for number in range(1, chance.randrange(4, most)):
        data = _line(chance, number).encode().hex() + "0a"
        while chance.random() < 0.25:
            at = 2 * chance.randrange(len(data) // 2 + 1)
            data = data[:at] + chance.choice(REAL_TIME) + data[at:]
        if chance.random() < 0.15:
            at = 2 * chance.randrange(len(data) // 2 + 1)
            made += [f"send {data[:at]}", f"wait {chance.choice((1, 5, 60))}"]
            data = data[at:]
        if chance.random() < 0.1:
            data *= chance.randrange(2, 12)
        made.append(f"send {data}")
        if chance.random() < 0.6:
            made.append(f"wait {chance.choice((1, 2, 10, 40, 250))}")
        if chance.random() < 0.1:
            made.append(f"pins {chance.randrange(2)}")
        if chance.random() < 0.06:
            made.append(f"worn {chance.randrange(2)}")
    return made


def played(history: History) -> History:
    """With what a sender does of its own: it asks for the state, waits for greetings, and lets all end."""
    made = []
    for command in history:
        made.append(command)
        if command.startswith("send"):
            text = bytes.fromhex(command[5:]).decode("latin-1")
            if "\x18" in text or any(reset in text for reset in ("$RST=", "$C")):
                made.append("wait 300")
            made += ["send 3f", "wait 1"]
    made += ["pins 0", "worn 0", "send 0a", "settle", "send 3f", "wait 1", "send 18", "wait 150"]
    return [*made, *_asked("$X", "$$", "$N", "?"), "end"]


def _asked(*lines: str) -> History:
    return [
        word
        for line in lines
        for word in (f"send {(line + chr(10) * (line != '?')).encode().hex()}", "wait 5")
    ]


def shrink(history: History, fails: Callable[[History], bool]) -> History:
    """The shortest history found that still fails when commands are left out."""
    size = max(1, len(history) // 2)
    while size:
        at = 1
        while at < len(history):
            shorter = history[:at] + history[at + size :]
            if fails(shorter):
                history = shorter
            else:
                at += size
        size //= 2
    return history
