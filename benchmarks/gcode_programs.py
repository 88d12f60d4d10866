# SPDX-License-Identifier: MIT
"""Random programs of G-code: most lines make sense, some are refused."""

import math
import random
import re
from collections.abc import Callable
from typing import Any

from passo.gcode import NANOMETERS, GcodeError
from passo.native import planner

from benchmarks.gcode_passo import Passo
from benchmarks.gcode_rs274 import LOWEST

LINES = 40
# What changes the meaning of the words that a cycle in force has kept, or where its row began.
SHIFTS = {"G7", "G8", "G10", "G17", "G18", "G19", "G20", "G21", "G28", "G30", "G43.1", "G49", "G54", "G55",
          "G59", "G61", "G61.1", "G64", "G90", "G91", "G92", "G92.1"}  # fmt: skip
PLANES = {"G17": "XYZ", "G18": "ZXY", "G19": "YZX"}
NORMAL = {"G17": {"K"}, "G18": {"J"}, "G19": {"I"}}  # the offset that arcs of a plane do not have
# enum passo_gcode_group
MOTION, PLANE, UNITS, DISTANCE, FEED_MODE, PATH, DIAMETER = 0, 2, 3, 4, 5, 6, 12


def number(rng: random.Random, low: float, high: float) -> str:
    """A number as people and programs write them."""
    value = rng.uniform(low, high)
    text = f"{value:.{rng.choice((0, 1, 3, 3, 4))}f}"
    if rng.random() < 0.1 and text.startswith(("0.", "-0.")):
        text = text.replace("0.", ".", 1)
    if rng.random() < 0.1 and "." not in text:
        text += "."
    return "+" + text if rng.random() < 0.05 and not text.startswith("-") else text


def positive(rng: random.Random, high: float) -> str:
    """A number that is not 0."""
    return f"{rng.uniform(0.05, high):.{rng.choice((2, 3))}f}"


def axes(rng: random.Random, letters: str = "XYZ", least: int = 0) -> str:
    """Some axis words."""
    chosen = rng.sample(letters, rng.randint(least, len(letters)))
    return " ".join(f"{letter}{number(rng, -30, 30)}" for letter in chosen)


class Programs:
    """Makes lines for the state that Passo is in."""

    def __init__(self, rng: random.Random):
        self.rng, self.passo = rng, Passo()
        self.makers: list[tuple[Callable[[], str], int]] = [
            (self.straight, 30), (self.arc, 14), (self.radius, 8), (self.modes, 14), (self.offsets, 10),
            (self.homes, 4), (self.others, 8), (self.cycle, 10), (self.nonsense, 3),
        ]  # fmt: skip

    def line(self) -> str:
        """A line of any kind."""
        rng = self.rng
        maker = rng.choices([maker for maker, _ in self.makers], [weight for _, weight in self.makers])[0]
        words = maker().split()
        if rng.random() < 0.1:
            rng.shuffle(words)
        text = rng.choice((" ", " ", "", "  ")).join(words)
        if rng.random() < 0.1:
            text = text.lower()
        if rng.random() < 0.1:
            text += rng.choice((" (a comment)", " ; X1 Y2", "(G0 X5)"))
        return text

    def feed(self) -> str:
        """An F word, where one is needed or wanted."""
        gcode = self.passo.gcode.c
        inverse = gcode.mode[FEED_MODE] == 930
        if inverse or gcode.feed == 0 or self.rng.random() < 0.2:
            return f" F{positive(self.rng, 20 if inverse else 3000)}"
        return ""

    def straight(self) -> str:
        """A line, with its command or without."""
        rng = self.rng
        command = rng.choice(("G0", "G1", "G1", "G01", "", "", "G53 G0", "G53 G1"))
        return f"{command} {axes(rng, least=1 if command == '' else 0)}{self.feed()}"

    def place(self, axis: int) -> float:
        """Where an axis is, in the coordinates and units in force."""
        gcode = self.passo.gcode
        offset = planner().passo_gcode_offset(gcode.c, axis)
        scale = 25.4 if gcode.c.mode[UNITS] == 200 else 1
        return (gcode.position[axis] - offset) / NANOMETERS / scale

    def turn(self) -> tuple[str, list[str], list[float]]:
        """A command for an arc, the letters of its plane, and where it begins; for absolute words."""
        plane = PLANES[f"G{self.passo.gcode.c.mode[PLANE] // 10}"]
        incremental = self.passo.gcode.c.mode[DISTANCE] == 910
        start = [0.0 if incremental else self.place("XYZ".index(letter)) for letter in plane]
        return self.rng.choice(("G2", "G3", "G02", "G03")), list(plane), start

    def word(self, letter: str, at: float, digits: int) -> str:
        """A word of an axis; of a diameter after G7."""
        twice = letter == "X" and self.passo.gcode.c.mode[DIAMETER] == 70
        return f"{letter}{2 * at if twice else at:.{digits}f}"

    def arc(self) -> str:
        """About a center: any sweep, sometimes a helix, a full circle, or one that does not close."""
        rng = self.rng
        command, letters, start = self.turn()
        radius, begin, sweep = rng.uniform(0.5, 20), rng.uniform(0, 7), rng.uniform(0.1, 6.2)
        offset = [round(-radius * math.cos(begin), 4), round(-radius * math.sin(begin), 4)]
        true = math.hypot(*offset)
        begin = math.atan2(-offset[1], -offset[0])
        place = [start[i] + offset[i] + true * (math.cos, math.sin)[i](begin + sweep) for i in range(2)]
        if (
            rng.random() < 0.1 and self.passo.gcode.c.mode[FEED_MODE] == 940
        ):  # rs274: G93 of a circle may be 0
            place = start[:2]
        if rng.random() < 0.05:  # of tolerances in between there is a row in the table
            apart = 1 + rng.choice((0.0001, 0.5, 2)) / true
            place = [start[i] + offset[i] + (place[i] - start[i] - offset[i]) * apart for i in range(2)]
        closed = place == start[:2] and rng.random() < 0.5
        words = [] if closed else [self.word(*at, 6) for at in zip(letters, place, strict=False)]
        words += [f"{'IJK'['XYZ'.index(letter)]}{o:.4f}" for letter, o in zip(letters, offset, strict=False)]
        if rng.random() < 0.3:
            words.append(f"{letters[2]}{start[2] + rng.uniform(-5, 5):.3f}")
        return f"{command} {' '.join(words)}{self.feed()}"

    def radius(self) -> str:
        """An arc by its radius, the shorter or the longer way."""
        rng = self.rng
        command, letters, start = self.turn()
        way = [rng.uniform(-20, 20), rng.uniform(-20, 20)]
        size = math.hypot(*way) / 2 * rng.choice((0.9, 1.001, 1.2, 3))
        words = [self.word(letter, start[i] + way[i], 4) for i, letter in enumerate(letters[:2])]
        if rng.random() < 0.2:
            words.append(self.word(letters[2], start[2] + rng.uniform(-5, 5), 3))
        return f"{command} {' '.join(words)} R{size * rng.choice((1, 1, -1)):.4f}{self.feed()}"

    def cycle(self) -> str:
        """Holes: one, a row, or one more of the cycle in force."""
        rng, gcode = self.rng, self.passo.gcode.c
        letters = PLANES[f"G{gcode.mode[PLANE] // 10}"]
        places = axes(rng, letters[:2], least=1)
        if is_cycle(gcode.mode[MOTION]):
            return places
        if gcode.mode[PATH] != 610:  # rs274 leaves the path mode of cycles alone only then
            return "G61"
        incremental, high = gcode.mode[DISTANCE] == 910, self.place("XYZ".index(letters[2]))
        level = rng.uniform(-9, 3) + (0 if incremental else high)
        bottom = (0 if incremental else level) - rng.uniform(0.5, 9)
        kind = rng.choice(("G73", "G81", "G82", "G83", "G85", "G89"))
        words = [kind, places, self.word(letters[2], bottom, 3), f"R{level:.3f}", f"F{positive(rng, 3000)}"]
        words += [f"Q{rng.uniform(0.3, 5):.3f}7"] if kind in ("G73", "G83") else []  # no whole pecks
        words += [f"P{positive(rng, 2)}"] if kind in ("G82", "G89") else []
        words += [f"L{rng.randint(1, 3)}"] if rng.random() < 0.3 else []
        return " ".join([*words, rng.choice(("G98", "G99"))])

    def modes(self) -> str:
        """One or two modes, sometimes with a motion."""
        rng = self.rng
        groups = (
            ("G17", "G18", "G19"), ("G20", "G21"), ("G90", "G91"), ("G93", "G94", "G94"),
            ("G54", "G55", "G59"),
            ("G61", "G61.1", "G64", "G64 P0.05", "G64 P0.1 Q0.02"), ("G40",), ("G91.1",), ("G80",),
            ("G7", "G8"), ("M3", "M4", "M5"), ("M7", "M8", "M9"), (f"S{positive(rng, 900)}",),
        )  # fmt: skip
        chosen = [rng.choice(group) for group in rng.sample(groups, rng.choice((1, 1, 2)))]
        moves = "G80" not in chosen and rng.random() < 0.2
        if moves:
            chosen.append(f"{rng.choice(('G0', 'G0', 'G1'))} {axes(rng, least=1)}{self.feed()}")
        return " ".join(chosen)

    def offsets(self) -> str:
        """Of coordinate systems and tools."""
        rng = self.rng
        return rng.choice((
            f"G10 L2 P{rng.randint(0, 6)} {axes(rng, least=1)}", f"G92 {axes(rng, least=1)}", "G92.1", "G49",
            f"G10 L20 P{rng.randint(0, 6)} {axes(rng, least=1)}", f"G43.1 Z{number(rng, -9, 9)}",
        ))  # fmt: skip

    def homes(self) -> str:
        """Of stored positions."""
        rng = self.rng
        return rng.choice(
            ("G28.1", "G30.1", "G28", "G30", f"G28 {axes(rng, least=1)}", f"G30 {axes(rng, least=1)}")
        )

    def others(self) -> str:
        """Dwells, tools, empty lines."""
        rng = self.rng
        return rng.choice((f"G4 P{positive(rng, 2)}", f"T{rng.randint(0, 99)}", "", "(only a comment)", "M1",
                           f"F{positive(rng, 2000)}", f"G4 P{positive(rng, 2)} {axes(rng)}"))  # fmt: skip

    def nonsense(self) -> str:
        """Words that do not go together, mostly."""
        rng = self.rng
        words = ("G0", "G1", "G2", "G3", "G4", "G10", "G28", "G53", "G80", "G92", "G93", "G17", "M3", "G81",
                 "G99", "X1", "Y2", "Z3", "I1", "J2", "K3", "R4", "P1", "L2", "F5", "S6", "Q1", "H1",
                 "X", "X1.2.3", "F-1", "G1.5", "G38", "E1")  # fmt: skip
        return " ".join(rng.sample(words, rng.randint(1, 4)))


def words_of(line: str) -> set[str]:
    """The words of a line, without comments."""
    return set(re.findall(r"[A-Z][-+.0-9]*", re.sub(r"\(.*?\)|;.*", "", line).upper().replace(" ", "")))


def is_cycle(motion: int) -> bool:
    """Whether a motion is a drilling cycle."""
    return motion == 730 or motion > 800


def known(line: str, passo: Passo) -> bool:
    """Whether spec/gcode_differences.toml has such lines."""
    words, gcode = words_of(line), passo.gcode.c
    letters = {word[0] for word in words}
    units, incremental = words & {"G20", "G21"}, gcode.mode[DISTANCE] == 910
    others = words & {"G10", "G28", "G30", "G92", "G43.1"} and letters & set("XYZ")
    return bool(
        ("G94" in words and "F" not in letters)
        or (units and ("F" in letters or gcode.tool_length != 0))
        or ("G53" in words and ("G91" in words or incremental or not letters & set("XYZ")))
        or (others and gcode.mode[MOTION] == 800)
        or (words & SHIFTS and is_cycle(gcode.mode[MOTION]))
        or (_is_arc(words, gcode) and letters & NORMAL[_plane(words, gcode)])
    )


def _is_arc(words: set[str], gcode: Any) -> bool:
    """Whether a line makes one, or one may be in force."""
    return bool(words & {"G2", "G3", "G02", "G03"}) or gcode.mode[MOTION] in (20, 30)


def _plane(words: set[str], gcode: Any) -> str:
    """That of a line."""
    return next(iter(words & NORMAL.keys()), f"G{gcode.mode[PLANE] // 10}")


def is_slow(passo: Passo) -> bool:
    """Whether the last motion has a feed that rs274 raises."""
    return bool(passo.motions) and 0 < passo.motions[-1].feed < LOWEST


def random_program(rng: random.Random, lines: int = LINES) -> list[str]:
    """Lines that Passo takes, and at the end perhaps one that it refuses."""
    programs, made = Programs(rng), ["G0"]
    programs.passo.execute("N1 G0")
    while len(made) < lines:
        line = programs.line()
        if known(line, programs.passo):
            continue
        try:
            programs.passo.execute(f"N{len(made) + 1} {line}")
        except GcodeError:
            if rng.random() < 0.05:
                return [*made, line]
        else:
            if is_slow(programs.passo):
                return made
            made.append(line)
    return made
