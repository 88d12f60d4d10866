# SPDX-License-Identifier: MIT
"""What to say of a word that Passo does not take: the norm it is from, and what to write instead."""

import re
from collections.abc import Sequence

from passo.expand.block import Word, split, words_of
from passo.gcode import AXIS_LETTERS, Gcode, GcodeError, GcodeSettings

NOT_TAKEN = frozenset((3, 20, 23))  # errors of a command that Passo does not have
UNREAD = frozenset((1, 2))  # of what is no word
UNUSED, NO_PORT, NO_PROBE = 36, 39, -1
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
LETTERS = {
    "D": "NIST: a tool's diameter, with G41 or G42",
    "E": "RepRap: for 3D printers",
    "U": "LinuxCNC: an axis beside X",
    "V": "LinuxCNC: an axis beside Y",
    "W": "LinuxCNC: an axis beside Z",
}


def _by_word(groups: dict[str, str]) -> dict[str, str]:
    """What is said of each word, from the words of which it is said."""
    return {word: said for said, words in groups.items() for word in words.split()}


# The same of words that it has, for those that are not of NIST alone; docs/gcode.md has the table.
NORMS = _by_word(
    {
        "LinuxCNC": "G7 G8 G33 G33.1 G43 G43.1 G43.2 G49 G61 G61.1 G64 G96 G97 M62 M63 M64 M65 M66 M67 M68",
        "NIST, LinuxCNC": "G73 G81 G82 G83 G85 G86 G89 M6 M61",
        "grbl, LinuxCNC": "G10 G28 G28.1 G30 G30.1 G38.2 G38.3 G38.4 G38.5 G91.1 G93 G94 G95",
        "grbl": "G20 G21 G53 G80 M0 M1 M2 M30 F S T N D E H I J K R L P Q",
    }
)
NIST = "NIST"  # of all others
# The letters that commands need.
NEEDED = _by_word(
    {
        "P": "G4 M62 M63 M64 M65",
        "L and P": "G10",
        "P, and Q if L is not 0": "M66",
        "E and Q": "M67 M68",
        "R, Q and the depth": "G73 G83",
        "R and the depth": "G81 G82 G85 G86 G89",
        "K": "G33 G33.1",
        "H": "G43.2",
        "Q": "M61",
        "S": "G96",
    }
)
# By error: kinds of words that it may be about, in this order, of which one is named without which the line
# is right, or has another error, or else the first; and what to do.
SAID = {
    1: ("", "a line has words, each of a letter and a number: passo expand takes parameters and O words"),
    2: ("", "write a number of at most nine digits before the point: passo expand takes expressions"),
    4: ("[A-Z]-.*", "write a number that is not negative"),
    11: ("", "write at most 127 characters, not counting blanks and comments"),
    20: ("[LR].*|O.*|G.*|M.*", "write another value, or another command"),
    21: ("[GM].*", "write one of the two, or two lines"),
    22: ("G.*|[XYZABC].*", "write F with the first motion, such as G1 X1 F600, and in G93 with each"),
    23: ("[GM].*", "write the number of a command that there is"),
    24: ("G.*", "write two lines"),
    25: ("[^GM].*", "write it once"),
    26: ("G.*", "add the axes: " + " ".join(AXIS_LETTERS)),
    27: ("N.*", "number lines up to 9999999, or not at all"),
    28: ("[GM].*", "add {}"),
    29: ("P.*", "write P1 to P6 for G54 to G59"),
    30: ("G53", "write G0 or G1 in this line"),
    31: ("[XYZABC].*", "write G0, G1 or another motion before"),
    32: ("G[23]", "write an end in the plane, or I and J of a full circle"),
    33: ("G[23]|[XYZABC].*|G.*|.*", "look at the end and the center, or at how far it is"),
    34: ("R.*", "write a larger R, or I and J"),
    35: ("G[23]|[XYZABC].*", "add I, J, K or R"),
    36: ("[DEHIJKLPQR].*", "leave it out, or write the command that takes it"),
    37: ("[XYABC].*|G.*", "write Z alone"),
    38: ("[THPQ].*", "write a tool up to 255; the table has T1 to T100"),
    39: ("M6[2-8]", ""),
    42: ("G33.*|G9[56]|G.*|[XYZABC].*", "write M3 or M4, and S, before"),
    NO_PROBE: (r"G38\..*", ""),
}  # fmt: skip
SLOW = (
    "spindle_at_speed: input P{input} has not said within {seconds} s that the spindle is at its speed "
    "(LinuxCNC, grblHAL): see to its drive, or make spindle_wait longer"
)
GOOD = r"[a-z][-+]?(?:[0-9]{1,9}(?![0-9])\.?[0-9]*|\.[0-9]+)"  # a word whose number can be read


def explain(error: GcodeError, words: Sequence[Word], settings: GcodeSettings) -> str:
    """The error of a line with the word that it is about, the norm of that, and what to do."""
    axes, number = settings.axis_letters, error.number
    for word in words if number in NOT_TAKEN else ():
        if word.letter in AXIS_LETTERS and word.letter not in axes:
            return f"{error}: {word} ({NIST}): the machine has the axes {' '.join(axes)}"
        if word.letter in LETTERS and not _is_taken(word, settings):
            return f"{error}: {word} ({LETTERS[word.letter]})"
        if word.letter in "GM" and not _is_taken(word, settings):
            norm, advice = _advice(word)
            return f"{error}: {word} ({norm}): {advice}"
    patterns, advice = SAID.get(number, ("", "see docs/gcode.md"))
    about = _culprit(number, patterns.split("|"), words, settings)
    if number == UNUSED and about and about.letter in LETTERS:
        return f"{error}: {about} ({LETTERS[about.letter]})"
    named = f"{about} ({norm_of(about)})" if about else f"the line ({NIST})"
    needed = NEEDED.get(str(about), "what it needs")
    return f"{error}: {named}: {advice.format(needed) if number != NO_PORT else _ports(settings)}"


def explain_text(error: GcodeError, text: str, settings: GcodeSettings) -> str:
    """The same for a line as text."""
    if error.number in UNREAD and (bad := re.sub(GOOD, " ", split(text)[0]).split()):
        return f"{error}: {bad[0].upper()} ({NIST}): {SAID[error.number][1]}"
    return explain(error, words_of(text), settings)


def no_probe(text: str) -> str:
    """Of a line that probes, on a machine without a probe."""
    words = [word for word in words_of(text) if re.fullmatch(SAID[NO_PROBE][0], str(word))]
    word = words[0] if words else Word("G", 38)
    return f"no probe is fitted: {word} ({NORMS['G38.2']}): --surface MAP.csv simulates one"


def norm_of(word: Word) -> str:
    """The authority for a word that is taken."""
    return NORMS.get(str(word) if word.letter in "GM" else word.letter, NIST)


def _culprit(
    number: int, patterns: Sequence[str], words: Sequence[Word], settings: GcodeSettings
) -> Word | None:
    """The word that an error is about, if one is known."""
    found = [
        at for kind in patterns for at, word in enumerate(words) if kind and re.fullmatch(kind, str(word))
    ]
    left = {
        at: _number(" ".join(str(word) for n, word in enumerate(words) if n != at), settings) for at in found
    }
    right, other = [at for at in found if not left[at]], [at for at in found if left[at] != number]
    return words[(right + other + found)[0]] if found else None


def _ports(settings: GcodeSettings) -> str:
    """Those of M62 to M68 that there are."""
    count = settings.inputs
    inputs = f"the inputs P0 to P{count - 1}" if count else "no inputs (no switch, no probe)"
    power = "the analog output E0" if settings.power else "no analog output (no spindle_maximum)"
    return f"there are the outputs P0 to P3, {inputs}, {power}"


def _number(line: str, settings: GcodeSettings) -> int:
    """The error of a line alone."""
    try:
        Gcode(settings).execute(line)
    except GcodeError as error:
        return error.number
    return 0


def _is_taken(word: Word, settings: GcodeSettings) -> bool:
    return _number(str(word), settings) not in NOT_TAKEN


def _advice(word: Word) -> tuple[str, str]:
    for letter, codes, _, norm, advice in ADVICE:
        if letter == word.letter and word.code in codes:
            return norm, advice
    return OTHERWISE
