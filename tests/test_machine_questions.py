# SPDX-License-Identifier: MIT
"""`passo make` alone: questions, and a machine file that can be made."""

import io
import itertools
from collections.abc import Iterator
from pathlib import Path

import pytest
from passo.cli import main
from passo.machine_file import read_machine
from passo.machine_questions import TOOLS, ask_machine
from passo_fpga.boards import boards

ANSWERS = [
    answers
    for name, chosen in boards().items()
    for answers in itertools.product(
        [name],
        ["A4988", "TB6600"],
        TOOLS if "outputs" in chosen.parts else [None],
        ["yes", "no"] if "inputs" in chosen.parts else [None],
    )
]


def asked(answers: dict[str, str], questions: list[str]) -> Iterator[str]:
    """An answer to each question, by its name; Enter for others."""
    question = ""
    while True:
        question = yield answers.get(question.partition(" (")[0], "")
        questions.append(question)


@pytest.mark.parametrize("answers", ANSWERS, ids=lambda answers: "-".join(map(str, answers)))
def test_every_file_can_be_made(tmp_path: Path, answers: tuple[str, ...]) -> None:
    """With as many motors as the board has pins for, which are the proposal."""
    path, questions = tmp_path / "machine.toml", []
    given = {
        name: answer
        for name, answer in zip(("board", "drive", "tool", "home switches"), answers, strict=True)
        if answer
    }
    replies = asked(given, questions)
    next(replies)
    ask_machine(path, replies.send)
    assert [question.partition(" (")[0] for question in questions] == [*given, "motors"]
    assert main(["make", str(path), "--out", str(tmp_path / "out"), "--no-build"]) == 0
    machine = read_machine(path)
    assert (machine.board, machine.drive) == answers[:2]
    assert machine.has_inputs == (answers[3] == "yes") and machine.laser == (answers[2] == "laser")
    assert f"motors ({len(machine.ends)}" in questions[-1]


def test_answers_are_typed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A wrong one is asked again; an earlier file stays; without an answer nothing is written."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.stdin", io.StringIO("icebreker\nicebreaker\nDM542\nspindle\nyes\n7\n2\n"))
    assert main(["make"]) == 0
    told = capsys.readouterr().out
    assert (
        "not 'icebreker'; did you mean icebreaker?" in told
        and "motors must be one of 3, 2, 1, not '7'" in told
    )
    text = Path("machine.toml").read_text()
    assert len(read_machine(Path("machine.toml")).ends) == 2
    assert main(["make"]) == 2 and "machine.toml: exists already" in capsys.readouterr().err
    assert Path("machine.toml").read_text() == text
    Path("machine.toml").unlink()
    monkeypatch.setattr("sys.stdin", io.StringIO("hx8k\n"))
    assert main(["make"]) == 2 and not Path("machine.toml").exists()
    assert "no answer; nothing was written" in capsys.readouterr().err
