# SPDX-License-Identifier: MIT
"""Judges the log of a history of a sender of grbl (grbl_histories.py).

The judge knows no state of the controller; it has the log alone: what was sent, what was said, and the steps.
"""

import re
from dataclasses import dataclass, field

STEPS_PER_MM = 20
STOPS = 200  # ms after which what stops must be at rest, and what was requested be reported
OVERRIDES = {"90": (0, 100), "91": (0, 10), "92": (0, -10), "93": (0, 1), "94": (0, -1),
             "95": (1, 100), "96": (1, 50), "97": (1, 25),
             "99": (2, 100), "9a": (2, 10), "9b": (2, -10), "9c": (2, 1), "9d": (2, -1)}  # fmt: skip
ANSWER = re.compile(r"ok|error:\d+")
LINE = re.compile(
    r"|ok|error:\d+|ALARM:[1-9]|<[^<>]*>|\[[^\]]*\]|\$N?\d+=.*|>.*:(ok|error:\d+)"
    r"|Grbl 1\.1h \['\$' for help\]"
)


class FindingError(Exception):
    """What a log shows that a sender may not see."""


@dataclass
class Judge:
    """Reads a log from its beginning; raises FindingError."""

    serial: bool = (
        False  # bytes come one by one: a resume may be served after the hold before it, in a poll of its own
    )
    pending: list[str] = field(default_factory=list)  # lines without an answer
    late: list[str] = field(default_factory=list)  # sent with a reset, after it: it drops them or not
    part: str = ""
    steps: tuple[int, ...] = (0, 0, 0)
    base: tuple[int, ...] = (0, 0, 0)  # position less steps, since the last home
    percent: list[int] = field(default_factory=lambda: [100, 100, 100])
    overridden: int = -STOPS  # ms of the last override that was sent
    unsure: bool = False  # whether it came before the end of the program or after
    settings: dict[str, str] = field(default_factory=dict)
    state: str = ""
    moved: int = 0  # ms of the last step
    rests: int = -1  # since when nothing may move; -1: it may
    holds: int = -1  # until when a hold must be reported; -1: none is due
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
                raise FindingError(f"{ms} ms: it moves in {self.state}")

    # ---------------------------------------------------------------------------------- what was sent

    def _sent(self, ms: int, data: str) -> None:
        batch = [data[i : i + 2] for i in range(0, len(data), 2)]
        resets = False
        for code in batch:
            if code in OVERRIDES:
                index, change = OVERRIDES[code]
                now = self.percent[index] + change if change in (-10, -1, 1, 10) else change
                self.percent[index] = min(200, max(10, now))
                self.overridden = ms
            elif code == "18":
                self.percent = [100, 100, 100]
                self.late, resets = [], True
            elif int(code, 16) < 0x80 and code not in ("21", "7e", "3f"):
                self._byte(chr(int(code, 16)))
                if resets and self.serial and code == "0a":
                    self.late.append(self.pending[-1])
        holding = "21" in batch or "84" in batch
        if self.serial and "7e" in batch and holding:
            holding = batch[::-1].index("7e") > min(
                batch[::-1].index(hold) for hold in ("21", "84") if hold in batch
            )
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
            raise FindingError(f"{ms} ms: it says {text!r}")
        if text.startswith("Grbl"):
            self.pending, self.part, self.last, self.holds = [], "", 0, -1
            self.state, self.rests = "", -1
        elif text.startswith("ALARM"):  # nothing is held from here on, whatever was reported before
            self.state, self.rests, self.holds = "", -1, -1
        elif ANSWER.fullmatch(text):
            self._answer(ms, text)
        elif text.startswith("<"):
            self._report(ms, text[1:-1])
        elif found := re.fullmatch(r"\$(N?\d+)=(.*)", text):
            known = self.settings.setdefault(found[1], found[2])
            if known != found[2]:
                raise FindingError(f"{ms} ms: ${found[1]} is {found[2]} and not {known}")
        elif text.startswith("[MSG:Restoring"):
            self.settings.clear()
            self.percent = [100, 100, 100]
        elif text.startswith("[MSG:Disabled"):
            self.percent = [100, 100, 100]
        elif text.startswith("[MSG:Pgm End"):
            self.percent = [100, 100, 100]
            self.unsure = self.serial and ms - self.overridden < STOPS

    def _answer(self, ms: int, text: str) -> None:
        if not self.pending and not self.late:
            raise FindingError(f"{ms} ms: {text} answers no line")
        line = (self.pending or self.late).pop(0)
        plain = re.sub(r"[ \t]|\(.*?\)|\(.*|;.*", "", line).upper()
        if plain in ("", "%") and text not in ("ok", "error:11", "error:9"):
            raise FindingError(f"{ms} ms: {text} to {line!r}")
        if plain in ("X1X2", "G5", "Q", "$999=1", "$32=X", "$120=0", "$11=-1", "G1F") and text == "ok":
            raise FindingError(f"{ms} ms: ok to {line!r}")
        if plain.startswith(("$J", "$N0=G0")) and text == "ok" and self.state == "Check":
            raise FindingError(f"{ms} ms: ok to {line!r} in Check")
        if plain.startswith("$J") and text == "ok" and self.state in ("Idle", "Run"):  # Run has ended before
            self.state = "Jog"
        if plain in ("$X", "$H") and text == "ok":  # no Alarm from here on, whatever was reported before
            self.state, self.rests = "", -1
            self.homes = self.homes or plain == "$H"
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
                raise FindingError(f"{ms} ms: a hold was lost")
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
            raise FindingError(f"{ms} ms: {text} at rest")
        if "Ov" in values and self.unsure:
            self.percent, self.unsure = [int(part) for part in values["Ov"].split(",")], False
        if "Ov" in values and [int(part) for part in values["Ov"].split(",")] != self.percent:
            raise FindingError(f"{ms} ms: overrides are {values['Ov']} and not {self.percent}")
        if "Ln" in values:
            number = int(values["Ln"])
            if number not in self.numbers or number < self.last:
                raise FindingError(f"{ms} ms: line {number} moves after {self.last}")
            self.last = number
        if at_rest and ms - self.moved > 5 and "MPos" in values:
            self._position(ms, values["MPos"])

    def _position(self, ms: int, text: str) -> None:
        told = tuple(round(float(part) * STEPS_PER_MM) for part in text.split(","))
        if self.homes:
            self.base = tuple(a - b for a, b in zip(told, self.steps, strict=True))
            self.homes = False
        if told != tuple(a + b for a, b in zip(self.base, self.steps, strict=True)):
            raise FindingError(
                f"{ms} ms: it is said to be at {told}, the steps are {self.steps} from {self.base}"
            )

    def end(self) -> None:
        """All is answered, as nothing holds the machine."""
        if self.pending:
            raise FindingError(f"no answer to {self.pending}")


def judge(log: list[str], serial: bool = False) -> None:
    """Judge a log, of a serial line or of batches of bytes; raises FindingError.

    Before the last reset all must have been answered.
    """
    made, reset = (
        Judge(serial=serial),
        max(i for i, line in enumerate(log) if re.fullmatch(r"> \d+ 18", line)),
    )
    for i, line in enumerate(log):
        if i == reset and made.state != "Sleep":
            made.end()
        made.read(line)
    made.end()
