# SPDX-License-Identifier: MIT
"""Random histories of a sender of grbl, judged from outside; `make grbl-histories` plays thousands."""

import pytest
from passo import random_cases

from tests.helpers.grbl_histories import made_of, shrink
from tests.helpers.grbl_judge import FindingError, judge
from tests.helpers.grbl_play import board_elf, finding, play_on_board, play_on_model, program

HISTORIES, ON_BOARD = 25, 2
IDLE = "<Idle|MPos:0.000,0.000,0.000|FS:0,0>"


def test_on_the_model() -> None:
    made, first = program(), 1000 * random_cases.seed()
    histories = [made_of(seed) for seed in range(first, first + HISTORIES)]
    for seed, log in enumerate(play_on_model(made, histories), first):
        assert not finding(log), seed


def test_on_the_firmware() -> None:
    elf, first = board_elf(), 1000 * random_cases.seed()
    for seed in range(first, first + ON_BOARD):
        assert not finding(play_on_board(elf, made_of(seed)), serial=True), seed


LINE, JOG, CHECK = b"X1 X2\n".hex(), b"$J=G91X1F9\n".hex(), b"$C\n".hex()


@pytest.mark.parametrize(
    ("log", "what"),
    [
        ([f"> 1 {LINE}"], "no answer"),
        (["< 1 ok"], "answers no line"),
        ([f"> 1 {LINE}", "< 2 ok"], "ok to 'X1 X2'"),
        ([f"> 1 {LINE}", "< 2 oops"], "it says 'oops'"),
        (["< 1 <Check|FS:0,0>", "p 9 1 0 0"], "it moves in Check"),
        (["< 1 <Check|FS:0,0>", f"> 2 {JOG}", "< 3 ok"], "in Check"),
        (["< 1 <Alarm|FS:0,0>", "< 9 <Alarm|FS:0,0>", "p 900 1 0 0"], "it moves in Alarm"),
        (["< 1 <Hold:0|FS:0,0>", "p 9 1 0 0"], "it moves in Hold"),
        ([f"< 1 {IDLE}", "> 2 217e", "< 300 <Run|FS:0,0>"], "a hold was lost"),
        (["p 1 7 0 0", f"< 90 {IDLE}"], "the steps are (7, 0, 0)"),
        (["< 1 <Idle|FS:5,0>"], "at rest"),
        (["> 1 929292", "< 9 <Idle|FS:0,0|Ov:80,100,100>"], "overrides are 80,100,100"),
        (["> 1 92", "< 2 [MSG:Pgm End]", "< 9 <Idle|FS:0,0|Ov:90,100,100>"], "overrides are 90,100,100"),
        (["< 9 <Run|Ln:7|FS:0,0>"], "line 7 moves"),
        (["< 1 $11=0.01", f"> 2 {b'$11=-1'.hex()}0a", "< 3 error:4", "< 4 $11=-1"], "$11 is -1"),
    ],
)
def test_what_the_judge_finds(log: list[str], what: str) -> None:
    """Each promise is broken once."""
    with pytest.raises(FindingError) as found:
        judge([*log, "> 1000 18"])
    assert what in str(found.value)


def test_a_serial_line_has_no_batches() -> None:
    """There a resume may be served after the hold before it; a hold after a resume holds."""
    after = ["< 300 <Run|FS:0,0>", "> 1000 18"]
    judge([f"< 1 {IDLE}", "> 2 217e", *after], serial=True)
    with pytest.raises(FindingError):
        judge([f"< 1 {IDLE}", "> 2 7e21", *after], serial=True)


def test_an_override_on_the_line_at_the_end_of_the_program() -> None:
    """It may come behind it, if it was sent just before; the first report tells, and the next ones agree."""
    sent, end, report = "> 1 92", "< 3 [MSG:Pgm End]", "< 9 <Idle|FS:0,0|Ov:{},100,100>"
    for percent in (90, 100):
        judge([sent, end, report.format(percent), "> 1000 18"], serial=True)
        for log in (
            [sent, end, report.format(percent), report.format(190 - percent)],
            [sent, end.replace("3", "999"), report.format(90)],
        ):
            with pytest.raises(FindingError):
                judge([*log, "> 1000 18"], serial=True)


@pytest.mark.parametrize("order", [("> 2 21", "< 3 ALARM:3"), ("< 2 ALARM:3", "> 3 21")])
def test_an_alarm_is_not_held(order: tuple[str, ...]) -> None:
    """Whether the hold came before it or after; the last report said Idle."""
    judge([f"< 1 {IDLE}", *order, f"> 250 {b'$X'.hex()}0a", "< 251 ok", f"< 300 {IDLE}", "> 1000 18"])


def test_histories_shrink() -> None:
    """To what is needed for the failure."""
    short = shrink(["begin", *"abcdefgh"], lambda tried: "c" in tried and "g" in tried)
    assert short == ["begin", "c", "g"]
