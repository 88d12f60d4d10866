# SPDX-License-Identifier: MIT
"""Random histories of a sender of grbl: made, and judged by what can be seen from outside.

A history is a list of commands of tests/grbl_play.c, and so is what plays it: the C model, or the firmware. The
judge knows no state of the controller; it has the log alone: what was sent, what was said, and the steps.
"""

import random
import re
from dataclasses import dataclass, field

STEPS_PER_MM = 20
STOPS = 200  # ms after which what stops must be at rest, and what was asked for be told
OVERRIDES = {"90": (0, 100), "91": (0, 10), "92": (0, -10), "93": (0, 1), "94": (0, -1),
             "95": (1, 100), "96": (1, 50), "97": (1, 25),
             "99": (2, 100), "9a": (2, 10), "9b": (2, -10), "9c": (2, 1), "9d": (2, -1)}  # fmt: skip
REAL_TIME = ("21", "21", "7e", "7e", "7e", "84", "85", "85", "18", *OVERRIDES)
OTHERS = ("$$", "$#", "$G", "$I", "$N", "$", "$X", "$X", "$C", "$C", "$H", "$SLP", "$RST=$", "$RST=#", "$RST=*",
          "$N0=G21", "$N0=G0X3", "$N1=", "$11=0.02", "$11=-1", "$12=0.004", "$20=1", "$20=0", "$26=2", "$110=900",
          "$120=0", "$121=300", "$10=3", "$10=255", "$30=1000", "$31=5", "$1=255", "$32=x", "$999=1", "$27=2")  # fmt: skip
CODES = ("G4 P0.02", "G4 P0", "M3 S500", "M5", "M8", "M9", "M0", "M2", "M30", "G92 X0", "G92.1", "G10 L2 P1 X1",
         "G28.1", "G20", "G21", "G90", "", "(a comment)", "; another", "%", "X1 X2", "G1 F", "G99", "Q", "(a(b")  # fmt: skip
RESETS = ("$RST=", "$C")
ANSWER = re.compile(r"ok|error:\d+")
LINE = re.compile(
    r"ok|error:\d+|ALARM:[1-9]|<[^<>]*>|\[[^\]]*\]|\$N?\d+=.*|>.*:(ok|error:\d+)|Grbl 1\.1h \['\$' for help\]|"
)

History = list[str]


class Finding(Exception):
    """What a log shows that a sender may not see."""


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


def make(seed: int, most: int = 24) -> History:
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
            if "\x18" in text or any(reset in text for reset in RESETS):
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


@dataclass
class Judge:
    """Reads a log from its beginning; raises Finding."""

    pending: list[str] = field(default_factory=list)  # lines without an answer
    part: str = ""
    steps: tuple[int, ...] = (0, 0, 0)
    base: tuple[int, ...] = (0, 0, 0)  # position less steps, since the last home
    percent: list[int] = field(default_factory=lambda: [100, 100, 100])
    settings: dict[str, str] = field(default_factory=dict)
    state: str = ""
    moved: int = 0  # ms of the last step
    rests: int = -1  # since when nothing may move; -1: it may
    holds: int = -1  # until when a hold must be told; -1: none is due
    numbers: set[int] = field(default_factory=set)
    last: int = 0  # line that moved last
    homes: bool = False  # the position has changed by a home

    def read(self, line: str) -> None:
        """A line of the log."""
        kind, _, rest = line.partition(" ")
        ms, _, text = rest.partition(" ")
        if kind == ">":
            self._sent(int(ms), text)
        elif kind == "<":
            self._said(int(ms), text)
        elif kind == "p":
            self.steps = tuple(int(number) for number in text.split())
            self.moved = int(ms)
            if 0 <= self.rests < int(ms):
                raise Finding(f"{ms} ms: it moves in {self.state}")

    # ---------------------------------------------------------------------------------- what was sent

    def _sent(self, ms: int, data: str) -> None:
        batch = [data[i : i + 2] for i in range(0, len(data), 2)]
        for code in batch:
            if code in OVERRIDES:
                index, change = OVERRIDES[code]
                now = self.percent[index] + change if change in (-10, -1, 1, 10) else change
                self.percent[index] = min(200, max(10, now))
            elif code == "18":
                self.percent = [100, 100, 100]
            elif int(code, 16) < 0x80 and code not in ("21", "7e", "3f"):
                self._byte(chr(int(code, 16)))
        holding = "21" in batch or "84" in batch
        if self.state == "Check" and "$C" in self._flight():
            self.rests = -1
        if self.state == "Alarm" and ("$X" in self._flight() or "$H" in self._flight()):
            self.rests = -1
        if "18" in batch or ("7e" in batch and not holding):
            self.holds = -1
            if self.state in ("Hold", "Door"):
                self.rests = -1
        elif holding and self.state in ("Idle", "Run") and not re.search(r"J|H|SLP|C", self._flight()):
            self.holds = ms + STOPS

    def _byte(self, byte: str) -> None:
        if byte != "\n":
            self.part += byte
            return
        self.pending.append(self.part)
        self.numbers.update(int(found) for found in re.findall(r"N(\d+) ", self.part))
        self.part = ""

    def _flight(self) -> str:
        return "\n".join([*self.pending, self.part])

    # ---------------------------------------------------------------------------------- what was said

    def _said(self, ms: int, text: str) -> None:
        if not LINE.fullmatch(text):
            raise Finding(f"{ms} ms: it says {text!r}")
        if text.startswith("Grbl"):
            if any(reset in line for line in self.pending for reset in RESETS):
                self.percent = [100, 100, 100]
            self.pending, self.part, self.last, self.holds = [], "", 0, -1
            self.state, self.rests = "", -1
        elif ANSWER.fullmatch(text):
            self._answer(ms, text)
        elif text.startswith("<"):
            self._report(ms, text[1:-1])
        elif found := re.fullmatch(r"\$(N?\d+)=(.*)", text):
            known = self.settings.setdefault(found[1], found[2])
            if known != found[2]:
                raise Finding(f"{ms} ms: ${found[1]} is {found[2]} and not {known}")
        elif text.startswith("[MSG:Restoring"):
            self.settings.clear()
            self.percent = [100, 100, 100]
        elif text.startswith("[MSG:Disabled"):
            self.percent = [100, 100, 100]

    def _answer(self, ms: int, text: str) -> None:
        if not self.pending:
            raise Finding(f"{ms} ms: {text} answers no line")
        line = self.pending.pop(0)
        plain = re.sub(r"[ \t]|\(.*?\)|\(.*|;.*", "", line).upper()
        if plain in ("", "%") and text not in ("ok", "error:11", "error:9"):
            raise Finding(f"{ms} ms: {text} to {line!r}")
        if plain in ("X1X2", "G99", "Q", "$999=1", "$32=X", "$120=0", "$11=-1", "G1F") and text == "ok":
            raise Finding(f"{ms} ms: ok to {line!r}")
        if plain.startswith(("$J", "$N0=G0")) and text == "ok" and self.state == "Check":
            raise Finding(f"{ms} ms: ok to {line!r} in Check")
        if plain == "$H" and text == "ok":
            self.homes = True
        if text == "ok" and (found := re.fullmatch(r"\$(N?\d+)=(.*)", plain)):
            self.settings.pop(found[1], None)
            if found[1] == "22":
                self.settings.pop("20", None)

    def _report(self, ms: int, text: str) -> None:
        state, *fields = text.split("|")
        values = dict(entry.split(":", 1) for entry in fields)
        state, _, sub = state.partition(":")
        if 0 <= self.holds <= ms:
            if state in ("Idle", "Run"):
                raise Finding(f"{ms} ms: a hold was lost")
            self.holds = -1
        at_rest = state in ("Idle", "Sleep") or (state in ("Hold", "Door") and sub == "0")
        if state == "Check":
            self.rests = ms
        elif state == "Alarm" and self.state == "Alarm":
            self.rests = self.rests if self.rests >= 0 else ms + STOPS
        elif state in ("Hold", "Door", "Sleep") and at_rest:
            self.rests = ms + 2
        elif state != "Alarm":
            self.rests = -1
        self.state = state
        feed = values["FS"].split(",")[0]
        if (at_rest and feed != "0") or (state in ("Idle", "Sleep", "Check") and "Ln" in values):
            raise Finding(f"{ms} ms: {text} at rest")
        if "Ov" in values and [int(part) for part in values["Ov"].split(",")] != self.percent:
            raise Finding(f"{ms} ms: overrides are {values['Ov']} and not {self.percent}")
        if "Ln" in values:
            number = int(values["Ln"])
            if number not in self.numbers or number < self.last:
                raise Finding(f"{ms} ms: line {number} moves after {self.last}")
            self.last = number
        if at_rest and ms - self.moved > 5 and "MPos" in values:
            self._position(ms, values["MPos"])

    def _position(self, ms: int, text: str) -> None:
        told = tuple(round(float(part) * STEPS_PER_MM) for part in text.split(","))
        if self.homes:
            self.base = tuple(a - b for a, b in zip(told, self.steps, strict=True))
            self.homes = False
        if told != tuple(a + b for a, b in zip(self.base, self.steps, strict=True)):
            raise Finding(f"{ms} ms: it is said to be at {told}, the steps are {self.steps} from {self.base}")

    def end(self) -> None:
        """All is answered, as nothing holds the machine."""
        if self.pending:
            raise Finding(f"no answer to {self.pending}")


def judge(log: list[str]) -> None:
    """Judge a log; raises Finding."""
    made = Judge()
    for line in log:
        made.read(line)
        if line.endswith(" 18") and line.startswith(">"):
            made.end() if made.state not in ("Sleep",) and line == log_end(log) else None
    made.end()


def log_end(log: list[str]) -> str:
    """The reset at the end: before it all must have been answered."""
    return [line for line in log if re.fullmatch(r"> \d+ 18", line)][-1]


def shrink(history: History, fails: "type[bool] | object") -> History:
    """The shortest history found that still fails: commands, then bytes of what is sent are left out."""
    size = max(1, len(history) // 2)
    while size:
        at = 1
        while at < len(history):
            shorter = history[:at] + history[at + size :]
            if fails(shorter):  # type: ignore[operator]
                history = shorter
            else:
                at += size
        size //= 2
    return history
