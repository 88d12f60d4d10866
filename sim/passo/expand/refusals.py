# SPDX-License-Identifier: MIT
"""What to say of a word that Passo does not take: the norm it is from, and what to write instead."""

from collections.abc import Sequence

from passo.expand.block import Word, words_of
from passo.gcode import AXIS_LETTERS, Gcode, GcodeError, GcodeSettings

NOT_TAKEN = frozenset((3, 20, 23))  # errors of a command that Passo does not have
UNUSED, NO_PORT = 36, 39
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

SLOW = (
    "spindle_at_speed: input P{input} has not said within {seconds} s that the spindle is at its speed "
    "(LinuxCNC, grblHAL): see to its drive, or make spindle_wait longer"
)


def explain(error: GcodeError, words: Sequence[Word], settings: GcodeSettings) -> str:
    """The error of a line with the word that it is about, where that is known."""
    axes = settings.axis_letters
    if error.number == NO_PORT:
        return f"{error}: {_ports(settings)}"
    if error.number == UNUSED and (word := next((word for word in words if word.letter == "E"), None)):
        return f"{error}: {word} ({LETTERS['E']})"
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
    return str(error)


def explain_text(error: GcodeError, text: str, settings: GcodeSettings) -> str:
    """The same for a line as text."""
    return explain(error, words_of(text), settings)


def _ports(settings: GcodeSettings) -> str:
    """Those of M62 to M68 that there are."""
    count = settings.inputs
    inputs = f"the inputs P0 to P{count - 1}" if count else "no inputs (no switch, no probe)"
    power = "the analog output E0" if settings.power else "no analog output (no spindle_maximum)"
    return f"there are the outputs P0 to P3, {inputs}, {power}"


def _is_taken(word: Word, settings: GcodeSettings) -> bool:
    try:
        Gcode(settings).execute(str(word))
    except GcodeError as error:
        return error.number not in NOT_TAKEN
    return True


def _advice(word: Word) -> tuple[str, str]:
    for letter, codes, _, norm, advice in ADVICE:
        if letter == word.letter and word.code in codes:
            return norm, advice
    return OTHERWISE
