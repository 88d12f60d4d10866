# SPDX-License-Identifier: MIT
"""The console on cores with several channels."""

from collections.abc import Iterator

import numpy as np
import pytest
from passo.terminal import Terminal

from tests.test_console import Bench

CHANNELS, AXES = 3, 2
MOVE = "move steps=200,-120 profile=cosine total_time=0.05 ramp_time=0.02"
LONG = "move steps=100 profile=linear total_time=1 ramp_time=0.2"
SIGMOID = "move method=sigmoid steps=20 speed=900 accelerate_time=0.01 alpha={}"


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench(axes=AXES, channels=CHANNELS)
    yield made
    made.close()


def at(bench: Bench) -> list[str]:
    """The positions of all channels."""
    return [bench.tell(f"position channel={channel}")["position"] for channel in range(CHANNELS)]


def states(bench: Bench) -> list[str]:
    """The states of all channels."""
    return [bench.tell(f"status channel={channel}")["state"] for channel in range(CHANNELS)]


def starts(bench: Bench) -> list[int | None]:
    """Clock at which each channel started first."""
    events = bench.terminal.pulses()
    found: list[int | None] = []
    for channel in range(CHANNELS):
        clocks = events["clock"][events["running"] >> channel & 1 != 0]
        found.append(int(clocks[0]) if len(clocks) else None)
    return found


def test_a_move_is_that_of_its_channel(bench: Bench) -> None:
    """Channel 0 unless the line says another."""
    assert bench.tell("version")["channels"] == str(CHANNELS)
    assert bench.ask(MOVE) == "ok"
    assert bench.ask(f"{MOVE} channel=2") == "ok"
    assert bench.ask(f"{MOVE} channel=2") == "ok"
    assert bench.ask("wait") == "ok"
    assert at(bench) == ["200,-120", "0,0", "400,-240"]
    assert bench.ask("zero channel=2") == "ok"
    assert at(bench) == ["200,-120", "0,0", "0,0"]


def test_hold_and_stop_leave_other_channels_alone(bench: Bench) -> None:
    """So do resume, override, abort and clear."""
    for channel in range(CHANNELS):
        assert bench.ask(f"{LONG} channel={channel}") == "ok"
    assert bench.ask("run 0.3") == "ok"
    assert bench.ask("hold channel=1") == "ok"
    assert bench.ask("override 50 channel=2") == "ok"
    assert bench.ask("run 0.1") == "ok"
    rates = [bench.tell(f"status channel={channel}")["rate"] for channel in range(CHANNELS)]
    assert rates == ["100.000", "0.000", "50.000"]
    assert bench.ask("stop channel=2") == "ok"
    assert bench.ask("run 0.2") == "ok"
    assert states(bench) == ["RUN", "RUN", "STOPPED"]
    assert bench.ask("clear") == "error: MOVING: only possible at rest"
    assert bench.ask(f"{MOVE} channel=2").startswith("error: STOPPED: ")
    assert bench.ask("clear channel=2") == "ok"
    assert bench.ask(f"{MOVE} channel=2") == "ok"
    assert bench.ask("resume channel=1") == "ok"
    assert bench.ask("abort") == "ok"
    assert bench.ask("wait") == "ok"
    assert states(bench) == ["STOPPED", "IDLE", "IDLE"]
    assert at(bench)[1] == "100,0"


def test_drives_pins_and_rotation_of_a_channel(bench: Bench) -> None:
    """Enable, disable, config axis, turn, rpm and angle."""
    assert bench.ask("enable 1 channel=1") == "ok"
    assert bench.ask("enable channel=2") == "ok"
    levels = bench.terminal.pulses()["enable"][-1]
    assert levels == 1 << AXES + 1 | 3 << 2 * AXES
    assert bench.ask("disable channel=2") == "ok"
    assert bench.terminal.pulses()["enable"][-1] == 1 << AXES + 1
    assert bench.ask("config need_enable=1") == "ok"
    assert bench.ask(f"{MOVE} channel=1") == "error: NOT_ENABLED: axis 0 is not enabled"
    assert bench.ask("config need_enable=0") == "ok"
    assert bench.ask("config axis=1 channel=1 step_high=9us") == "ok"
    assert bench.tell("config axis=1 channel=1")["step_high"] == "36clocks"
    assert bench.tell("config axis=1")["step_high"] == "4clocks"
    turn = "turn steps_per_turn=200 rpm=60 top_rpm=120 acceleration=9999 axis=1 channel=1"
    assert bench.ask(turn) == "ok"
    assert bench.ask("run 1") == "ok"
    assert bench.ask("rpm 120") == "error: NOT_TURNING: only possible in continuous rotation"
    assert bench.ask("rpm 120 channel=1") == "ok"
    assert bench.ask("run 1") == "ok"
    assert bench.tell("angle 200 axis=1 channel=1")["rpm"] == "120.000"
    assert bench.tell("angle 200 axis=1")["angle"] == "0.000"
    assert bench.ask("rpm 0 channel=1") == "ok"
    assert bench.ask("wait") == "ok"


def test_start_starts_together(bench: Bench) -> None:
    """What waits for sync, on one clock; a channel with nothing queued waits on."""
    for channel in range(CHANNELS):
        assert bench.ask(f"sync 1 channel={channel}") == "ok"
    assert bench.ask("start").startswith("error: NOT_PREPARED: ")
    assert bench.ask(f"{MOVE} channel=2") == "ok"
    assert bench.ask(MOVE) == "ok"
    assert bench.ask("wait").startswith("error: ")
    assert starts(bench) == [None] * CHANNELS
    assert bench.ask("start") == "ok"
    assert bench.ask("wait") == "ok"
    first, none, second = starts(bench)
    assert first == second is not None and none is None
    assert at(bench) == ["200,-120", "0,0", "200,-120"]
    assert bench.ask(MOVE) == "ok"
    assert bench.ask(f"{MOVE} channel=1") == "ok"
    assert bench.ask("run 0.1") == "ok"
    assert states(bench) == ["IDLE", "ARMED", "IDLE"]


@pytest.mark.parametrize(
    ("channels", "word", "problem"),
    [
        (1, "1", "channel must be 0, not 1"),
        (3, "3", "channel must be 0 to 2, not 3"),
        (3, "8", "channel must be 0 to 7"),
        (3, "x", "channel must be a whole number, not 'x'"),
    ],
)
def test_a_channel_that_does_not_exist(channels: int, word: str, problem: str) -> None:
    """Is refused by every line that means a channel."""
    bench = Bench(channels=channels)
    commands = ("hold", "resume", "stop", "abort", "clear", "status", "position", "zero", "enable", "disable")
    for line in (MOVE, "sync 1", "override 5", "rpm 5", "angle 200", "config axis=0", *commands):
        assert bench.ask(f"{line} channel={word}") == f"error: {problem}"
    bench.close()


@pytest.mark.parametrize("command", ["open", "version", "start", "help", "table"])
def test_commands_of_the_core_have_no_channel(bench: Bench, command: str) -> None:
    answer = bench.ask(f"{command} channel=1")
    assert answer.startswith("error: ") and "'channel'" in answer


def fill(bench: Bench, line: str) -> None:
    """Send moves until one waits, without letting time pass."""
    for _ in range(20):
        bench.terminal.type(f"{line}\n".encode())
        if not bench.take():
            return
    raise AssertionError("no move waits")


def test_a_move_waits_for_its_own_channel(bench: Bench) -> None:
    """What other channels do does not answer it; a stop of its own does."""
    assert bench.ask(f"{LONG} channel=2") == "ok"
    fill(bench, f"{LONG} channel=1")
    for line in ("abort channel=2", "hold", "resume"):
        bench.terminal.type(f"{line}\n".encode())
        assert bench.take() == "ok\n"
    bench.terminal.type(f"{MOVE}\n".encode())
    assert bench.take().startswith("error: WAITING: ")
    bench.terminal.type(b"stop channel=1\n")
    assert bench.take() == "ok\nerror: STOPPED: the channel is stopped: clear it first\n"


def test_a_table_waits_for_all_channels(bench: Bench) -> None:
    """They share it; a rotation, which has no end, is not waited for."""
    assert bench.ask(SIGMOID.format(3.25)) == "ok"
    assert bench.ask(f"{LONG} channel=1") == "ok"
    assert bench.ask(f"{SIGMOID.format(4.5)} channel=2") == "ok"
    ended = np.diff((bench.terminal.pulses()["running"] >> 1 & 1).astype(int)) < 0
    assert ended.any()
    assert bench.ask("wait") == "ok"
    assert at(bench) == ["20,0", "100,0", "20,0"]
    assert bench.ask("turn steps_per_turn=200 rpm=60 acceleration=9999") == "ok"
    assert bench.ask(f"{SIGMOID.format(3.25)} channel=2").startswith("error: TABLE: ")


def test_motions_outlive_the_console(bench: Bench) -> None:
    """Each channel is taken over when it is at rest; one at rest works immediately."""
    bench.ask("move steps=200,-120 profile=cosine total_time=0.3 ramp_time=0.1 channel=1")
    bench.ask(f"{LONG} channel=2")
    bench.terminal.close()
    bench.terminal = Terminal(bench.engine, bench.said.append, keep=True)
    assert "note: MOVING: " in bench.take()
    plain = "move steps=200,-120 profile=linear total_time=0.05 ramp_time=0.02"  # needs no table
    assert bench.ask(plain) == "ok"
    assert bench.ask(f"{plain} channel=1").startswith("error: ")
    bench.terminal.line("run 0.4")
    assert bench.take() == "note: channel 1 is at rest\nok\n"
    assert bench.ask(f"{plain} channel=1") == "ok"
    bench.terminal.line("run 1.5")
    assert bench.take() == "note: channel 2 is at rest\nok\n"
    assert at(bench) == ["200,-120", "400,-240", "100,0"]


def test_a_dead_wire_is_told_once(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """A stop that was lost belongs to its channel."""
    for channel in range(CHANNELS):
        bench.ask(f"{LONG} channel={channel}")
    bench.take()
    with monkeypatch.context() as patch:
        patch.setattr(bench.engine, "transfer", lambda mosi, gap: [0] * len(mosi))
        bench.terminal.run(50_000)
        assert bench.take().count("note: STUCK_LOW: ") == 1
        assert bench.ask("stop channel=1").startswith("error: STUCK_LOW: ")
        bench.terminal.run(50_000)
        assert bench.take() == "note: channel 1: NOT_STOPPED: stop not acknowledged yet; resent\n"
    bench.terminal.run(200_000)
    assert "note: the core answers\n" in bench.take()
    assert states(bench) == ["RUN", "STOPPED", "RUN"]
