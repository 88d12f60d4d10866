# SPDX-License-Identifier: MIT
"""Move files: valid ones are read exactly, errors are reported in one clear line."""

import re
from fractions import Fraction
from pathlib import Path

import pytest
from passo.build import Parameters
from passo.cli import main
from passo.move_file import read_channels, read_moves
from passo.moves import MoveBySpeed, MoveFileError, MoveInTime, PinTiming
from passo.plan import plan_channels
from passo.toolchain import paths
from passo.values import UNITS

CLOCK = "clock_hz = 16_000_000\n"
BY_TIME = '[[move]]\nsteps = [100, -50]\nprofile = "cosine"\ntotal_time = 0.4\nramp_time = 0.1\n'
BY_SPEED = '[[move]]\nsteps = [100, -50]\nprofile = "linear"\nspeed = 2000\nacceleration = 40000\n'
GOOD = CLOCK + BY_TIME
SHAPER = '{ name = "zv", frequency = 40 }'
SHAPED = GOOD.replace("cosine", "shaped") + f"shaper = {SHAPER}\n"
MOST = 2**30 - 1  # steps of an axis


def write(folder: Path, text: str) -> Path:
    path = folder / "bad.toml"
    path.write_text(text)
    return path


def test_both_forms(tmp_path: Path) -> None:
    file = read_moves(
        write(tmp_path, CLOCK + "[pins]\nstep_high = 1.01e-6\nstep_low = 1e-9\n" + BY_TIME + BY_SPEED)
    )
    assert file.clock_hz == 16_000_000
    assert file.pins == PinTiming(step_high=17, step_low=1, dir_setup=16, dir_hold=16)
    assert file.moves == (
        MoveInTime((100, -50), "cosine", Fraction(2, 5), Fraction(1, 10)),
        MoveBySpeed(
            (100, -50),
            "linear",
            Fraction(0),
            Fraction(2000),
            Fraction(0),
            Fraction(40000),
            Fraction(0),
            Fraction(0),
        ),
    )
    assert file.axes == 2
    assert file.name == "bad"


def test_the_most_steps(tmp_path: Path) -> None:
    (move,) = read_moves(write(tmp_path, GOOD.replace("[100, -50]", f"[{MOST}, -{MOST}]"))).moves
    assert move.steps == (MOST, -MOST)


def test_decimals_are_exact(tmp_path: Path) -> None:
    text = GOOD.replace("0.4", "0.1234567890123456789").replace("ramp_time = 0.1", "ramp_time = 1e-3")
    (move,) = read_moves(write(tmp_path, text)).moves
    assert isinstance(move, MoveInTime)
    assert move.total_time == Fraction(1234567890123456789, 10**19)
    assert move.ramp_time == Fraction(1, 1000)


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("400ms", Fraction(2, 5)),
        ("400_000us", Fraction(2, 5)),
        ("0.4s", Fraction(2, 5)),
        ("+4e-1", Fraction(2, 5)),
        (".4", Fraction(2, 5)),
        ("4e8ns", Fraction(2, 5)),
        ("4e+00000002ms", Fraction(2, 5)),
        ("0.1234567890123456789012345678901ms", None),
        ("6_400_001clocks", Fraction(6_400_001, 16_000_000)),
        ("400 ms", Fraction(2, 5)),
        (" 400000 \N{MICRO SIGN}s", Fraction(2, 5)),
        ("400000\N{GREEK SMALL LETTER MU}s", Fraction(2, 5)),
        ("400 m s", None),
        ("4 00ms", None),
        ("ms", None),
        ("", None),
        ("4__0ms", None),
        ("_4ms", None),
        ("1.2.3s", None),
        ("1e", None),
        ("inf", None),
        ("nans", None),
        ("-1ms", None),
        ("1e99999999999999999999s", None),
        ("4294967296s", None),
        ("400MS", None),
    ],
)
def test_times_with_units(tmp_path: Path, text: str, seconds: Fraction | None) -> None:
    """In a move and in the pins; what is refused is refused with one line."""
    path = write(tmp_path, GOOD.replace("0.4", f'"{text}"'))
    if seconds is None:
        with pytest.raises(MoveFileError, match="move 1: total_time"):
            read_moves(path)
    else:
        (move,) = read_moves(path).moves
        assert isinstance(move, MoveInTime)
        assert move.total_time == seconds


def test_pins_with_units(tmp_path: Path) -> None:
    pins = '[pins]\nstep_high = "2us"\nstep_low = "33clocks"\ndir_setup = "62.6ns"\ndir_hold = "1ns"\n'
    file = read_moves(write(tmp_path, CLOCK + pins + BY_TIME))
    assert file.pins == PinTiming(step_high=32, step_low=33, dir_setup=2, dir_hold=1)


def test_the_units_are_those_of_the_console() -> None:
    source = (paths.console / "passo_number.c").read_text()
    (table,) = re.findall(r"UNITS\[\] = \{(.*)\};", source)
    assert dict((name, int(power)) for name, power in re.findall(r'\{"(\w+)", (-?\d+)\}', table)) == UNITS


def test_a_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "notepad.toml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert read_moves(path).clock_hz == 16_000_000


BAD = {
    "clock missing": (BY_TIME, "clock_hz is missing"),
    "shaper of another profile": (
        GOOD + 'shaper = { name = "zv", frequency = 40 }\n',
        'shaper needs profile = "shaped"',
    ),
    "no shaper": (SHAPED.replace("shaper = ", "# "), "shaper is missing"),
    "shaper by name": (SHAPED.replace(SHAPER, '"zv"'), "shaper must be a table such as"),
    "unknown shaper": (SHAPED.replace('"zv"', '"zvd"'), "shaper: name must be one of zv, mzv, ei"),
    "shaper key": (SHAPED.replace("frequency", "frequenzy"), "shaper: unknown key 'frequenzy'; did you mean"),
    "frequency zero": (SHAPED.replace("= 40", "= 0"), "shaper: frequency must be greater than 0"),
    "damping": (SHAPED.replace("= 40", "= 40, damping = 0.6"), "shaper: damping must be 0 to 0.5"),
    "shaped by speed": (CLOCK + BY_SPEED.replace("linear", "shaped"), "profile must be one of linear"),
    "clock zero": (GOOD.replace("16_000_000", "0"), "clock_hz must be 1 to 4294967295"),
    "clock float": (GOOD.replace("16_000_000", "16e6"), "clock_hz must be a whole number"),
    "clock in MHz": (
        GOOD.replace("16_000_000", "12"),
        "clock_hz = 12 is in Hz: write 12_000_000 for 12 MHz",
    ),
    "clock 12e6": (
        GOOD.replace("16_000_000", "12e6"),
        "clock_hz must be a whole number, not 12e6; write 12_000_000",
    ),
    "clock true": (GOOD.replace("16_000_000", "true"), "clock_hz must be a whole number, not true"),
    "syntax": (CLOCK + "[[move\n", "at line 2"),
    "twice": (CLOCK + GOOD, "Cannot overwrite"),
    "empty": ("", "clock_hz is missing"),
    "no moves": (CLOCK, "no moves"),
    "empty list": (CLOCK + "move = []\n", "no moves"),
    "a table": (GOOD.replace("[[move]]", "[move]"), "move must be an array of tables"),
    "a number": (CLOCK + "move = 3\n", "move must be an array of tables"),
    "a list of numbers": (CLOCK + "move = [3]\n", "move must be an array of tables"),
    "wrong key": (CLOCK.replace("hz", "khz") + BY_TIME, "unknown key 'clock_khz'; did you mean clock_hz?"),
    "wrong key of a move": (GOOD + "sped = 3\n", "unknown key 'sped'; did you mean speed?"),
    "wrong profile": (GOOD.replace("cosine", "cosin"), "not 'cosin'; did you mean cosine?"),
    "wrong method": (GOOD + 'method = "in_tim"\n', "not 'in_tim'; did you mean in_time?"),
    "G-code": ("G21\nG0 X10 Y20\n", "this is G-code; move files are TOML"),
    "G-code with a comment": ("; a part\nN10 G0 X10 Y20\n", "this is G-code"),
    "G-code with percent": ("%\nG90\n", "this is G-code"),
    "unknown key": (CLOCK + "color = 1\n" + BY_TIME, "unknown key 'color'"),
    "unknown key of a move": (GOOD + "sped = 3\n", "move 1: unknown key 'sped'"),
    "unknown key of the pins": (CLOCK + "[pins]\nstep = 1\n" + BY_TIME, "pins: unknown key 'step'"),
    "pins no table": (CLOCK + "pins = 1\n" + BY_TIME, "pins must be a table"),
    "pin too long": (CLOCK + "[pins]\ndir_hold = 0.005\n" + BY_TIME, "pins: dir_hold is 80000 clocks"),
    "pin zero": (
        CLOCK + "[pins]\nstep_low = 0\n" + BY_TIME,
        "pins: step_low is 0 clocks; must be 1 to 65535",
    ),
    "pin zero with a unit": (CLOCK + '[pins]\ndir_hold = "0us"\n' + BY_TIME, "pins: dir_hold is 0 clocks"),
    "channel above": (GOOD + "channel = 8\n", "move 1: channel must be 0 to 7"),
    "channel negative": (GOOD + "channel = -1\n", "move 1: channel must be 0 to 7"),
    "channel text": (GOOD + 'channel = "x"\n', "move 1: channel must be a whole number"),
    "together alone": (
        "together = true\n" + GOOD,
        "together needs several channels: all moves use channel 0",
    ),
    "together a number": ("together = 1\n" + GOOD, "together must be true or false, not 1"),
    "pins of no channel": (
        CLOCK + '[pins.1]\nstep_low = "1us"\n' + BY_TIME,
        "pins.1: no move uses channel 1",
    ),
    "pins of channel 8": (CLOCK + '[pins.8]\nstep_low = "1us"\n' + BY_TIME, "pins: unknown key '8'"),
    "pins of a channel, a number": (CLOCK + "[pins]\n0 = 3\n" + BY_TIME, "pins.0: it must be a table"),
    "unknown key of a channel's pins": (
        CLOCK + "[pins.0]\nlow = 3\n" + BY_TIME,
        "pins.0: unknown key 'low'",
    ),
    "axes of a channel": (
        GOOD + "channel = 1\n" + BY_SPEED + BY_TIME.replace("-50", "-50, 1") + "channel = 1\n",
        "move 3: steps has 3 axes, but move 1 has 2",
    ),
    "pin negative": (CLOCK + "[pins]\ndir_hold = -1e-6\n" + BY_TIME, "pins: dir_hold must not be negative"),
    "pin text": (
        CLOCK + '[pins]\nstep_low = "1 parsec"\n' + BY_TIME,
        "pins: step_low must be a number or a text such as \"400ms\", not '1 parsec'",
    ),
    "pin in microseconds": (
        CLOCK + "[pins]\nstep_high = 2\n" + BY_TIME,
        "pins: step_high is 32000000 clocks; must be at most 65535; a number is in seconds, "
        'a text may have a unit: "2us"',
    ),
    "steps missing": (GOOD.replace("steps = [100, -50]", ""), "move 1: steps is missing"),
    "steps a number": (GOOD.replace("[100, -50]", "100"), "move 1: steps must be a list"),
    "steps floats": (GOOD.replace("-50", "-50.0"), "move 1: steps must be a list of whole numbers"),
    "steps true": (GOOD.replace("-50", "true"), "move 1: steps must be a list of whole numbers"),
    "steps nested": (GOOD.replace("-50", "[50]"), "move 1: steps must be a list of whole numbers"),
    "steps empty": (GOOD.replace("[100, -50]", "[]"), "move 1: steps has 0 axes"),
    "nine axes": (GOOD.replace("-50", "1, 2, 3, 4, 5, 6, 7, 8"), "move 1: steps has 9 axes"),
    "2^30 steps": (GOOD.replace("-50", f"{MOST + 1}"), f"axis 1 has too many steps; must be at most {MOST}"),
    "-2^30 steps": (GOOD.replace("-50", f"-{MOST + 1}"), "move 1: axis 1 has too many steps"),
    "-2^31 steps": (GOOD.replace("-50", "-2147483648"), "move 1: axis 1 has too many steps"),
    "other length": (GOOD + BY_SPEED.replace("-50", "-50, 1"), "move 2: steps has 3 axes, but move 1 has 2"),
    "profile missing": (GOOD.replace('profile = "cosine"', ""), "move 1: profile is missing"),
    "profile without quotes": (
        GOOD.replace('"cosine"', "cosine # smooth"),
        ': profile = "cosine" needs quotes',
    ),
    "time without quotes": (
        GOOD.replace("total_time = 0.4", "total_time = 400 ms"),
        ': total_time = "400 ms" needs quotes',
    ),
    "profile unknown": (GOOD.replace("cosine", "cosinus"), "move 1: profile must be one of linear, cosine"),
    "profile number": (GOOD.replace('"cosine"', "1"), "move 1: profile must be one of"),
    "profile list": (GOOD.replace('"cosine"', "[]"), "move 1: profile must be one of"),
    "no ramp time": (GOOD.replace("ramp_time = 0.1", ""), "move 1: ramp_time is missing"),
    "negative time": (GOOD.replace("0.4", "-0.4"), "move 1: total_time must not be negative"),
    "infinite time": (GOOD.replace("0.4", "inf"), "move 1: total_time must be finite"),
    "no number": (GOOD.replace("0.4", "nan"), "move 1: total_time must be finite"),
    "huge": (GOOD.replace("0.4", "1e999999999"), "move 1: total_time must be at most"),
    "out of range": (GOOD.replace("0.4", "1e9999999999999999999999"), "out of range"),
    "tiny": (GOOD.replace("0.4", "1e-999999999"), "move 1: total_time must have at most 30 decimals"),
    "a date": (GOOD.replace("0.4", "2024-01-01"), "move 1: total_time must be a number"),
    "very many digits": (GOOD.replace("100", "9" * 5000), "bad.toml: "),
    "very long number": (GOOD.replace('"cosine"', "0x" + "f" * 9000), "not a very long number"),
    "deep": (CLOCK + "move = " + "[" * 9000 + "]" * 9000, "bad.toml: "),
    "both forms": (GOOD + "speed = 3\n", "move 1: total_time and speed are mutually exclusive"),
    "neither form": (GOOD.replace("total_time = 0.4", ""), "move 1: total_time or speed is missing"),
    "acceleration and ramp": (
        CLOCK + BY_SPEED + "ramp_time = 1\n",
        "acceleration and ramp_time are mutually exclusive",
    ),
    "zero acceleration": (CLOCK + BY_SPEED.replace("40000", "0"), "acceleration must be greater than 0"),
    "zero deceleration": (CLOCK + BY_SPEED + "deceleration = 0\n", "deceleration must be greater than 0"),
    "only deceleration": (
        CLOCK + BY_SPEED.replace("acceleration", "deceleration"),
        "deceleration needs acceleration",
    ),
    "negative speed": (CLOCK + BY_SPEED.replace("2000", "-2000"), "move 1: speed must not be negative"),
    "negative start": (CLOCK + BY_SPEED + "start_speed = -1\n", "move 1: start_speed must not be negative"),
}

# Errors that only the planner detects.
UNPLANNABLE = {
    "shaper longer than the ramp": (
        SHAPED.replace("= 40", "= 4"),
        "RAMP_TOO_SHORT: zv at 4 Hz takes 125.000 ms",
    ),
    "no steps": (GOOD.replace("[100, -50]", "[0, 0]"), "move 1: NO_STEPS: "),
    "no time": (GOOD.replace("0.4", "0").replace("0.1", "0"), "move 1: NO_TIME: "),
    "long ramp": (GOOD + BY_TIME.replace("0.1", "0.21"), "move 2: RAMP_TOO_LONG: "),
    "too fast": (GOOD.replace("100", "100_000_000"), "move 1: TOO_FAST: "),
    "zero speed": (CLOCK + BY_SPEED.replace("2000", "0"), "move 1: NO_SPEED: "),
    "no acceleration": (CLOCK + BY_SPEED.replace("acceleration = 40000", ""), "move 1: NO_ACCELERATION: "),
    "fast start": (CLOCK + BY_SPEED + "start_speed = 3000\n", "move 1: START_ABOVE_SPEED: "),
    "fast stop": (CLOCK + BY_SPEED + "stop_speed = 3000\n", "move 1: STOP_ABOVE_SPEED: "),
    "pins": (
        CLOCK + BY_SPEED.replace("100", "1_000_000").replace("2000", "600_000").replace("40000", "4_000_000"),
        "move 1: PINS_TOO_SLOW: axis 0 reaches 59",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input(tmp_path: Path, name: str) -> None:
    text, reason = BAD[name]
    with pytest.raises(MoveFileError) as caught:
        read_moves(write(tmp_path, text))
    message = str(caught.value)
    assert reason in message
    assert message.startswith(str(tmp_path / "bad.toml") + ": ")
    assert "\n" not in message and len(message) < len(str(tmp_path)) + 200


@pytest.mark.parametrize("name", ["syntax", "both forms", *UNPLANNABLE])
def test_exit_status_of_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    text, reason = (BAD | UNPLANNABLE)[name]
    out = tmp_path / "out"
    assert main(["run", str(write(tmp_path, text)), "--out", str(out)]) == 2
    captured = capsys.readouterr()
    assert reason in captured.err
    assert captured.err.count("\n") == 1
    assert not out.exists()


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(MoveFileError, match="No such file"):
        read_moves(tmp_path / "none.toml")
    with pytest.raises(MoveFileError, match="directory"):
        read_moves(tmp_path)
    path = tmp_path / "binary.toml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(MoveFileError, match="UTF-8"):
        read_moves(path)


@pytest.mark.parametrize("path", sorted(paths.examples.glob("*.toml")), ids=lambda path: path.stem)
def test_examples_are_good(path: Path) -> None:
    assert all(file.moves for file in read_channels(path).files)


def test_channels(tmp_path: Path) -> None:
    """Each channel has its own moves, axes and pins; moves without a channel are those of channel 0."""
    pins = '[pins]\nstep_high = "2us"\nstep_low = "3us"\n[pins.2]\nstep_low = "4us"\n'
    of_2 = BY_SPEED.replace("[100, -50]", "[7]") + "channel = 2\n"
    path = write(tmp_path, CLOCK + "together = true\n" + pins + of_2 + BY_TIME + of_2)
    file = read_channels(path)
    assert file.together and file.several and file.clock_hz == 16_000_000
    assert [(own.channel, own.axes, own.numbers) for own in file.files] == [(0, 2, (2,)), (2, 1, (1, 3))]
    assert [own.pins for own in file.files] == [PinTiming(32, 48, 16, 16), PinTiming(32, 64, 16, 16)]
    with pytest.raises(MoveFileError, match="it moves channel 2; only channel 0 is supported here"):
        read_moves(path)
    with pytest.raises(MoveFileError, match="move 3: TOO_FAST"):
        fast = write(tmp_path, CLOCK + of_2 + BY_TIME + of_2.replace("2000", "1e8"))
        plan_channels(read_channels(fast), Parameters())
    shapes = '[[move]]\nmethod = "sigmoid"\nsteps = [9]\nspeed = 100\naccelerate_time = 0.1\n'
    tables = write(tmp_path, CLOCK + shapes + shapes + "alpha = 3\nchannel = 1\n")
    with pytest.raises(MoveFileError, match="move 2: it needs a different table than move 1"):
        plan_channels(read_channels(tables), Parameters())
