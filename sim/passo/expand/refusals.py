# SPDX-License-Identifier: MIT
"""What to say of a word that Passo does not take: the norm it is from, and what to write instead."""

from collections.abc import Sequence

from passo.expand.block import Word, unread_of, words_of
from passo.gcode import AXIS_LETTERS, Gcode, GcodeError, GcodeSettings

NOT_TAKEN = frozenset((3, 20, 23))  # errors of a command that Passo does not have
UNUSED, NO_PORT = 36, 39
UNREAD = frozenset((1, 2))  # those of a text that is no word
AT_WORD = frozenset((2, 4, 21, 24, 25, 27))  # errors that the first word which is wrong makes
# What to write instead, by the error.
INSTEAD = {
    1: "begin each word with a letter: X1.5",
    2: "write digits, a point and a sign: X-1.5",
    4: "write it without its sign",
    11: "split it into shorter lines",
    21: "split it into two lines",
    22: "write F with the first motion, such as G1 X1 F600, in G93 with each",
    24: "split it into two lines",
    25: "leave one out",
    26: "add the axes, such as X1",
    27: "number fewer lines, or none",
    28: "add what it needs: P to G4, L and P to G10, K to G33, R and Z to a cycle, S to G96",
    29: "P1 to P6 are G54 to G59, P0 is the one in force",
    30: "write G53 G0 or G53 G1",
    31: "write G0 or G1 before the axes",
    32: "add the end of the arc: X or Y in G17, X or Z in G18, Y or Z in G19",
    33: "an arc ends as far from its center as it begins, a hole below its R, a probe moves",
    34: "write a longer R, or the center as I and J",
    35: "add the center as I and J, or R",
    36: "leave it out, or add its command",
    37: "write Z and no other axis",
    38: "write a tool of the table, T1 to T255",
    42: "write M3 S1000 before it",
    47: "measure the tool first, with $TPW, or write its length with G43.1",
}
# By the command in tenths, or a range of them: error of a firmware, of the first one that it has not, norm,
# and what to do.
ADVICE: tuple[tuple[str, range, int, str, str], ...] = (
    ("G", range(50, 54), 20, "LinuxCNC", "a spline: let the CAM program write G1, G2 and G3"),
    ("G", range(101, 102), 23, "LinuxCNC", "edit the tool table instead"),
    ("G", range(171, 192), 23, "LinuxCNC", "there are no axes U V W"),
    ("G", range(330, 332), 20, "LinuxCNC", "the spindle needs an encoder: [spindle] of the machine file"),
    ("G", range(370, 371), 20, "Fanuc", "type $TPW in the pause of M6, which measures the tool"),
    ("G", range(410, 423), 20, "NIST", "expand the file: passo expand"),
    ("G", range(500, 515), 20, "NIST, FIDIA", "scale in the CAM program"),
    ("G", range(520, 521), 20, "LinuxCNC, Fanuc", "write G92, or G10 L2"),
    ("G", range(591, 594), 23, "LinuxCNC", "Passo has the systems G54 to G59"),
    ("G", range(740, 900), 20, "NIST, LinuxCNC", "let the CAM program write out the cycle, or passo expand"),
    ("G", range(901, 902), 20, "LinuxCNC", "write I J K as increments"),
    ("G", range(920, 924), 20, "NIST", "G92 and G92.1 are taken"),
    ("M", range(190, 200), 20, "LinuxCNC", "the spindle cannot be oriented"),
    ("M", range(480, 540), 20, "NIST, LinuxCNC", "overrides are the sender's: leave it out"),
    ("M", range(600, 610), 20, "NIST", "pause with M0"),
    ("M", range(700, 740), 20, "LinuxCNC", "write the modes that are to be restored"),
    ("M", range(820, 1100), 20, "RepRap", "this is for 3D printers: leave it out"),
    (
        "M",
        range(1000, 2000),
        20,
        "LinuxCNC, RepRap",
        "a user's program, or for 3D printers: leave it out",
    ),
)
LETTER_ERRORS = {"D": 36, "E": 36, "U": 20, "V": 20, "W": 20}
OTHERWISE = "of no norm that Passo follows", "leave it out, or write what it means"
TOGETHER = "each word is taken, but not beside the others"
LETTERS = {
    "D": "NIST: a tool's diameter, with G41 or G42",
    "E": "RepRap: for 3D printers",
    "U": "LinuxCNC: an axis beside X",
    "V": "LinuxCNC: an axis beside Y",
    "W": "LinuxCNC: an axis beside Z",
}


def explain(error: GcodeError, words: Sequence[Word], settings: GcodeSettings, unread: str = "") -> str:
    """The error of a line with the word that it is about, where that is known, and what to write instead.

    `unread`: what follows the words and is none.
    """
    axes = settings.axis_letters
    if error.number == NO_PORT:
        return f"{error}: {_ports(settings)}"
    if error.number == UNUSED and (word := next((word for word in words if word.letter == "E"), None)):
        return f"{error}: {word} ({LETTERS['E']})"
    if error.number in INSTEAD:
        return f"{error}: {_place(error, words, settings, unread)}{INSTEAD[error.number]}"
    if error.number not in NOT_TAKEN:
        return str(error)
    for word in words:
        if word.letter in AXIS_LETTERS and word.letter not in axes:
            return f"{error}: {word}: the machine has the axes {' '.join(axes)}"
        if word.letter in LETTERS and not _is_taken(word, settings):
            return f"{error}: {word} ({LETTERS[word.letter]})"
        if word.letter in "GM" and not _is_taken(word, settings):
            norm, advice = _advice(word)
            return f"{error}: {word} ({norm}): {advice}"
    return f"{error}: {TOGETHER}"


def explain_text(error: GcodeError, text: str, settings: GcodeSettings) -> str:
    """The same for a line as text."""
    return explain(error, words_of(text), settings, unread_of(text))


def _place(error: GcodeError, words: Sequence[Word], settings: GcodeSettings, unread: str) -> str:
    """The word that makes the error, if one does."""
    wrong = _wrong_word(error, words, settings) if error.number in AT_WORD else None
    place = wrong or (unread if error.number in UNREAD else "")
    return f"{place}: " if place else ""


def _wrong_word(error: GcodeError, words: Sequence[Word], settings: GcodeSettings) -> Word | None:
    """The last of the first words that have the same error without the others."""
    for count, word in enumerate(words, 1):
        if _error_of("".join(map(str, words[:count])), settings) == error.number:
            return word
    return None


def _ports(settings: GcodeSettings) -> str:
    """Those of M62 to M68 that there are."""
    count = settings.inputs
    inputs = f"the inputs P0 to P{count - 1}" if count else "no inputs (no switch, no probe)"
    power = "the analog output E0" if settings.power else "no analog output (no spindle_maximum)"
    return f"there are the outputs P0 to P3, {inputs}, {power}"


def _is_taken(word: Word, settings: GcodeSettings) -> bool:
    return _error_of(str(word), settings) not in NOT_TAKEN


def _error_of(line: str, settings: GcodeSettings) -> int:
    """Of a line alone; 0: none."""
    try:
        Gcode(settings).execute(line)
    except GcodeError as error:
        return error.number
    return 0


def _advice(word: Word) -> tuple[str, str]:
    for letter, codes, _, norm, advice in ADVICE:
        if letter == word.letter and word.code in codes:
            return norm, advice
    return OTHERWISE
