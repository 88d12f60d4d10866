# SPDX-License-Identifier: MIT
"""The further methods as forms of a move file: read exactly, rejected in one line, and run."""

import json
from fractions import Fraction
from pathlib import Path

import pytest
from passo import cli, move_file
from passo.build import Parameters
from passo.host import load_table
from passo.move_file import read_moves
from passo.moves import MoveFileError, MoveTurn
from passo.plan import plan_file, table_of
from passo.shape import check, sample, write_table
from passo.toolchain import paths

CLOCK = "clock_hz = 1_280_000\n[pins]\n" + "".join(
    f'{key} = "1clocks"\n' for key in ("step_high", "step_low", "dir_setup", "dir_hold")
)
FORMS = {
    "in_time": 'steps = [9, -4]\nprofile = "jerk"\ntotal_time = 0.05\nramp_time = 0.01\n',
    "by_speed": 'steps = [9, -4]\nprofile = "jerk"\nspeed = 900\nacceleration = 5000\n',
    "below_speed": 'steps = [90, -4]\nprofile = "cosine"\ntotal_time = 0.05\nspeed = 2000\n',
    "at_speed": 'steps = [90, -4]\nprofile = "linear"\nspeed = 2000\nramp_time = 0.01\n',
    "axes": "steps = [90, -4]\nstart_speed = 100\nspeed = 2000\nramp_time = 0.01\n",
    "turn": "axes = 2\naxis = 1\nsteps_per_turn = 200\nangle = -90.5\nrpm = 120\nacceleration = 9000\n",
    "sigmoid": "steps = [90, -4]\nspeed = 2000\naccelerate_time = 0.01\nalpha = 3.25\n",
    "jerk": "steps = [90, -4]\nspeed = 2000\nacceleration = 50_000\njerk = 5_000_000\n",
    "straight": "distance = [9, -0.4]\nfeed = 99\nsteps_per_mm = [10, 25]\nspeed = 90\nacceleration = 5000\n",
}
NEW_EXAMPLES = ("turn", "exact_time", "sigmoid_alpha", "seven_phases", "straight", "user_shape")


def write(folder: Path, text: str) -> Path:
    path = folder / "moves.toml"
    path.write_text(text)
    return path


def move_of(form: str, more: str = "") -> str:
    return f'[[move]]\nmethod = "{form}"\n{FORMS[form]}{more}'


def test_all_forms_are_tried() -> None:
    assert list(FORMS) == list(move_file.FORMS)


@pytest.mark.parametrize("form", FORMS)
def test_every_form_is_planned_and_run(tmp_path: Path, form: str) -> None:
    """File, plan and model have the same steps."""
    path = write(tmp_path, CLOCK + move_of(form))
    (move,) = read_moves(path).moves
    (plan,) = plan_file(read_moves(path), Parameters())
    assert [abs(n) for n in move.steps] == list(plan.line.steps)[:2]
    assert plan.line.directions == sum(1 << axis for axis, n in enumerate(move.steps) if n < 0)
    assert cli.main(["run", str(path), "--engine", "model", "--out", str(tmp_path / "out")]) == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["ok"] and all(axis["largest_error_steps"] < 0.05 for axis in summary["axes"])


def test_forms_are_read_exactly(tmp_path: Path) -> None:
    text = CLOCK + move_of("turn") + move_of("sigmoid") + move_of("straight", "jerk = [1, 0.1]\n")
    turn, sigmoid, straight = read_moves(write(tmp_path, text)).moves
    assert turn == MoveTurn(
        axis=1,
        axes=2,
        steps_per_turn=200,
        angle=Fraction(-181, 2),
        rpm=Fraction(120),
        minimum_rpm=Fraction(0),
        acceleration=Fraction(9000),
    )
    assert turn.steps == (0, -50) and turn.profile == "linear"
    assert sigmoid.alpha == Fraction(13, 4)
    assert sigmoid.decelerate_time == sigmoid.accelerate_time == Fraction(1, 100)
    assert straight.speed == (90, 90) and straight.steps == (90, -10)
    assert straight.jerk == (1, Fraction(1, 10)) and straight.profile == "jerk"


BAD = {
    "method": ('[[move]]\nmethod = "fast"\n', "move 1: method must be one of in_time, by_speed, below_speed"),
    "method number": ("[[move]]\nmethod = 3\n", "method must be one of"),
    "foreign key": (
        move_of("jerk", "ramp_time = 1\n"),
        "unknown key 'ramp_time'; must be one of method, steps",
    ),
    "missing": (move_of("jerk").replace("jerk = 5_000_000", ""), "move 1: jerk is missing"),
    "no time": (move_of("sigmoid").replace("accelerate_time = 0.01", ""), "accelerate_time is missing"),
    "axis": (move_of("turn").replace("axis = 1", "axis = 2"), "move 1: axes must be 3 to 8"),
    "ninth axis": (move_of("turn").replace("axis = 1", "axis = 8"), "move 1: axis must be 0 to 7"),
    "no turn": (move_of("turn").replace("= 200", "= 0"), "steps_per_turn must be 1 to"),
    "angle": (move_of("turn").replace("-90.5", "-3e9"), "angle must be at least -2147483647"),
    "angle text": (move_of("turn").replace("-90.5", '"90"'), "angle must be a number, not '90'"),
    "distance": (move_of("straight").replace("[9, -0.4]", "9"), "distance must be a list of 1 to 8 numbers"),
    "scales": (
        move_of("straight").replace("[10, 25]", "[10]"),
        "steps_per_mm has 1 axes, but distance has 2",
    ),
    "negative": (move_of("straight").replace("90", "[1, -1]"), "speed must not be negative"),
    "table": (move_of("by_speed", 'table = "x.csv"\n'), 'table needs profile = "user"'),
    "no table": (move_of("by_speed").replace("jerk", "user"), "table is missing"),
    "table number": (
        move_of("by_speed", "table = 1\n").replace("jerk", "user"),
        "table must be the name of a",
    ),
    "no file": (move_of("by_speed", 'table = "x.csv"\n').replace("jerk", "user"), "x.csv: No such file"),
    "user elsewhere": (
        move_of("at_speed").replace("linear", "user"),
        "profile must be one of linear, cosine",
    ),
}
UNPLANNABLE = {
    "slow": (move_of("below_speed").replace("2000", "100"), "move 1: SPEED_TOO_LOW: The steps take"),
    "alpha": (move_of("sigmoid").replace("3.25", "5.001"), "move 1: BAD_ALPHA: Alpha must be 3 to 5."),
    "jerk": (move_of("jerk").replace("5_000_000", "0"), "move 1: NO_JERK: "),
    "minimum": (move_of("turn", "minimum_rpm = 200\n"), "move 1: MINIMUM_ABOVE_SPEED: "),
    "feed": (move_of("straight").replace("feed = 99", "feed = 0"), "move 1: NO_FEED: "),
    "scale": (move_of("straight").replace("25", "0"), "move 1: NO_SCALE: "),
    "far": (move_of("turn").replace("-90.5", "2e9").replace("200", "20000"), "move 1: TOO_MANY_STEPS: "),
    "two tables": (
        move_of("sigmoid") + move_of("sigmoid").replace("3.25", "4"),
        "move 2: it needs a different table than move 1",
    ),
}


@pytest.mark.parametrize("name", [*BAD, *UNPLANNABLE])
def test_bad_moves(tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    text, reason = (BAD | UNPLANNABLE)[name]
    path = write(tmp_path, CLOCK + text)
    if name in BAD:
        with pytest.raises(MoveFileError) as caught:
            read_moves(path)
        assert reason in str(caught.value)
    assert cli.main(["run", str(path), "--engine", "model", "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert reason in error and error.count("\n") == 1 and not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", NEW_EXAMPLES)
def test_examples_run(tmp_path: Path, name: str) -> None:
    """Exact counts, exact times, and every step within a hundredth of its ideal position."""
    path = paths.examples / f"{name}.toml"
    assert cli.main(["run", str(path), "--engine", "model", "--out", str(tmp_path)]) == 0
    summary = json.loads((tmp_path / "summary.json").read_text())
    worst = max(axis["largest_error_steps"] for axis in summary["axes"])
    print(f"{name}: {worst:.5f} steps from the curve")
    assert summary["ok"] and summary["drained"] == 0 and worst < 0.01


def test_a_table_is_loaded_into_both_engines(tmp_path: Path) -> None:
    """Over SPI: the RTL and the model follow the user's shape, and the ideal curve of that shape."""
    write_table(sample(lambda u: u**3), tmp_path / "cubic.csv")
    move = FORMS["by_speed"].replace("jerk", "user").replace("[9, -4]", "[300, -40]").replace("900", "9000")
    path = write(tmp_path, f'{CLOCK}[[move]]\ntable = "cubic.csv"\n{move.replace("5000", "200_000")}')
    plans = plan_file(read_moves(path), Parameters())
    assert check(table_of(plans)).mean < Fraction(26, 100)
    assert cli.main(["run", str(path), "--engine", "both", "--out", str(tmp_path / "out")]) == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["matched_edges"] > 600
    assert all(axis["largest_error_steps"] < 0.02 for axis in summary["axes"])


def test_a_table_fits_into_whole_frames() -> None:
    class Recorder:
        writes: list[tuple[int, int]] = []  # noqa: RUF012

        def write(self, address: int, *words: int) -> None:
            self.writes += enumerate(words, address)

    load_table(Recorder(), 2, range(256))
    assert Recorder.writes == [(0xE00 + k, k) for k in range(256)]
