# SPDX-License-Identifier: MIT
"""The command `passo run` from file to files, and the engines behind it."""

import csv
import dataclasses
import fcntl
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from passo import cli, frame, run_command
from passo import registers as r
from passo.build import Parameters
from passo.engine import EVENT, DifferenceError, model_engine, rtl_engine
from passo.link import Link, LinkError, RefusedError
from passo.move_file import read_channels, read_moves
from passo.pair_engine import PairEngine, first_difference
from passo.plan import plan_channels, plan_file
from passo.registers import Verdict
from passo.run import execute, execute_channels, open_engine, parameters_for, parameters_of
from passo.toolchain import paths

CLOCK_HZ = 1_280_000  # 10000 ticks per second
TWO_MOVES = f"""
clock_hz = {CLOCK_HZ}
[pins]
step_high = 3e-6
dir_setup = 5e-6
[[move]]
steps = [200, -120, 0]
profile = "cosine"
total_time = 0.05
ramp_time = 0.02
[[move]]
steps = [-150, -120, 77]
profile = "jerk"
start_speed = 300
speed = 20_000
acceleration = 200_000
stop_speed = 200
"""
MANY_MOVES = f"clock_hz = {CLOCK_HZ}\n" + "".join(
    f'[[move]]\nsteps = [{n}, {100 - 7 * n}]\nprofile = "linear"\nstart_speed = 500\nspeed = 5000\n'
    f"acceleration = 500_000\nstop_speed = 500\n"
    for n in range(30)
)


def write(folder: Path, text: str, name: str = "moves.toml") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def read_pulses(path: Path) -> list[tuple[int, int, int]]:
    with path.open() as file:
        assert file.readline() == "clock,axis,direction\n"
        return [(int(clock), int(axis), int(direction)) for clock, axis, direction in csv.reader(file)]


def passo(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [str(Path(sys.executable).parent / "passo"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300)


def test_two_moves(tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = passo("run", write(tmp_path, TWO_MOVES), "--out", out, "--plot")
    assert (done.returncode, done.stderr) == (0, "")
    assert (out / "motion.png").read_bytes().startswith(b"\x89PNG")

    pulses = read_pulses(out / "pulses.csv")
    assert pulses == sorted(pulses, key=lambda row: row[:2])
    for axis, (forward, back) in enumerate([(200, 150), (0, 240), (77, 0)]):
        assert sum(row[1:] == (axis, 1) for row in pulses) == forward
        assert sum(row[1:] == (axis, -1) for row in pulses) == back
    # The cosine is symmetric in time: its middle step comes in the middle.
    first = [clock for clock, axis, _ in pulses if axis == 0][:200]
    assert abs((first[99] + first[100]) / 2 - 0.025 * CLOCK_HZ) < 1

    summary = json.loads((out / "summary.json").read_text())
    assert summary["clock_hz"] == CLOCK_HZ
    assert summary["drained"] == 0
    assert summary["engine"] == "both"
    assert summary["matched_edges"] > 2 * len(pulses)
    sums = [(axis["commanded"], axis["emitted"], axis["position"]) for axis in summary["axes"]]
    assert sums == [(50, 50, 50), (-240, -240, -240), (77, 77, 77)]
    assert all(axis["largest_error_steps"] < 0.51 for axis in summary["axes"])
    ticks = ("accelerate_ticks", "cruise_ticks", "decelerate_ticks")
    assert [summary["moves"][0][name] for name in ticks] == [200, 100, 200]
    total = sum(move[name] for move in summary["moves"] for name in ticks)
    assert summary["total_clocks"] == total * 128
    assert pulses[-1][0] <= summary["total_clocks"]


def test_engines_write_the_same(tmp_path: Path) -> None:
    file = write(tmp_path, TWO_MOVES)
    for engine in ("both", "rtl", "model"):
        assert cli.main(["run", str(file), "--engine", engine, "--out", str(tmp_path / engine)]) == 0
    texts = {(tmp_path / engine / "pulses.csv").read_text() for engine in ("both", "rtl", "model")}
    assert len(texts) == 1
    summaries = [json.loads((tmp_path / e / "summary.json").read_text()) for e in ("both", "rtl", "model")]
    assert len({summary["total_clocks"] for summary in summaries}) == 1
    assert summaries[1]["matched_edges"] is None


def test_bad_input(tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = passo("run", write(tmp_path, TWO_MOVES.replace("200,", "2.5,")), "--out", out)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1 and "move 1: steps must be" in done.stderr
    assert not out.exists()
    done = passo("run", write(tmp_path, TWO_MOVES), "--out", tmp_path / "moves.toml" / "out")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("axes", [1, 8])
def test_number_of_axes(tmp_path: Path, axes: int) -> None:
    text = TWO_MOVES.replace("[200, -120, 0]", str([200, -120, 0, 1, 2, 3, 4, -5][:axes]))
    text = text.replace("[-150, -120, 77]", str([-150, -120, 77, 1, 1, 1, 1, 1][:axes]))
    assert cli.main(["run", str(write(tmp_path, text)), "--out", str(tmp_path / "out")]) == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert [axis["position"] for axis in summary["axes"]] == [50, -240, 77, 2, 3, 4, 5, -4][:axes]


def test_two_runs_do_not_write_into_one_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The second one ends, and what the first one has written stays."""
    file, out = write(tmp_path, TWO_MOVES), tmp_path / "out"
    assert cli.main(["run", str(file), "--out", str(out)]) == 0
    other = os.open(out, os.O_RDONLY)
    fcntl.flock(other, fcntl.LOCK_EX)
    assert cli.main(["run", str(file), "--out", str(out)]) == 2
    os.close(other)
    assert "another run writes its results there" in capsys.readouterr().err
    assert read_pulses(out / "pulses.csv")
    assert cli.main(["run", str(file), "--out", str(out)]) == 0


def test_many_moves_are_streamed(tmp_path: Path) -> None:
    """There are far more ramps than places in the queue."""
    file = read_moves(write(tmp_path, MANY_MOVES))
    plans = plan_file(file, Parameters())
    assert sum(len(plan.ramps) for plan in plans) > 4 << Parameters().ramp_queue_log2
    with open_engine("both", Parameters(), file.clock_hz) as engine:
        run = execute(file, plans, engine)
    assert run.problems() == []


def test_ramps_come_before_a_short_one_ends(tmp_path: Path) -> None:
    """A long ramp, then short ones: half of what the queue holds lasts longer than what is left of it."""
    ends = "start_speed = {}\nstop_speed = {}\nspeed = {}\nacceleration = {}\n"
    moves = (
        "steps = [-13, 14]\nprofile = 'sigmoid'\n" + ends.format(17.7958, 279.755, 523.41, 94783),
        "steps = [5, 1]\nprofile = 'sigmoid'\n" + ends.format(0, 0, 44.8389, 841.359),
        "steps = [8, 8]\nmethod = 'jerk'\njerk = 32695400\n" + ends.format(0, 0, 310.56, 69411.1),
        "steps = [14, 14]\nmethod = 'axes'\nstart_speed = 338.189\nspeed = 395.315\nramp_time = 0.0337847\n",
    )
    text = "clock_hz = 64_000_000\n" + "".join(f"[[move]]\n{move}" for move in moves)
    arguments = ["run", str(write(tmp_path, text)), "--engine", "model", "--out", str(tmp_path / "out")]
    assert cli.main(arguments) == 0


@pytest.mark.parametrize("together", [True, False])
def test_four_motors(tmp_path: Path, together: bool) -> None:
    """Channels on their own, on both engines: started on one clock, as seen at the pins, or one by one."""
    text = (paths.examples / "four_motors.toml").read_text()
    text = text.replace("together = true", f"together = {str(together).lower()}")
    file = read_channels(write(tmp_path, text))
    parameters = parameters_of(file)
    assert (parameters.channels, parameters.axes) == (4, 1)
    plans = plan_channels(file, parameters)
    with open_engine("both", parameters, file.clock_hz) as engine:
        runs = execute_channels(file, plans, engine)
    assert runs[0].matched_edges > 2 * 17500
    assert len({run.start for run in runs}) == (1 if together else 4)
    for run, own in zip(runs, plans, strict=True):
        # The same steps on the same clocks as with a core of its own.
        alone = dataclasses.replace(run.file, channel=0)
        with open_engine("model", parameters_for(1), file.clock_hz) as engine:
            expected = execute(alone, own, engine)
        assert run.problems() == []
        for actual, wanted in zip(run.steps(0), expected.steps(0), strict=True):
            assert np.array_equal(actual, wanted)


def test_files_of_several_channels(tmp_path: Path) -> None:
    """What the command writes: a column for the channel, a page for each channel."""
    move = '[[move]]\nchannel = {}\nsteps = {}\nprofile = "cosine"\ntotal_time = 0.02\nramp_time = 0.01\n'
    text = f"clock_hz = {CLOCK_HZ}\n" + move.format(1, [60, -20]) + move.format(3, [50])
    out = tmp_path / "out"
    done = passo("run", write(tmp_path, text), "--engine", "model", "--out", out, "--plot")
    assert (done.returncode, done.stderr) == (0, "")
    assert "130 steps on 2 channels in " in done.stdout
    pictures = {"motion.png", "motion_channel_1.png", "motion_channel_3.png"}
    assert {path.name for path in out.glob("*.png")} == pictures
    head, *rows = (out / "pulses.csv").read_text().splitlines()
    assert head == "clock,channel,axis,direction"
    places = [tuple(map(int, row.split(",")))[1:] for row in rows]
    assert {place: places.count(place) for place in places} == {(1, 0, 1): 60, (1, 1, -1): 20, (3, 0, 1): 50}
    summary = json.loads((out / "summary.json").read_text())
    assert [(axis["channel"], axis["position"]) for axis in summary["axes"]] == [(1, 60), (1, -20), (3, 50)]
    first, second = summary["channels"]
    assert (first["channel"], first["start_clock"], second["channel"]) == (1, 0, 3)
    assert second["start_clock"] > 0
    assert summary["total_clocks"] == second["start_clock"] + second["total_clocks"]
    # An underrun of one channel is reported with its number; the other continues.
    short = move.format(1, [3]).replace("0.02", "0.0003").replace("0.01", "0.0001")
    text = text.replace("[60, -20]", "[60]") + 30 * short
    done = passo("run", write(tmp_path, text), "--engine", "model", "--out", out)
    assert done.returncode == 1
    assert "channel 1: the core stopped: RAMP_UNDERRUN" in done.stderr and "channel 3" not in done.stderr


def test_a_host_that_is_too_slow(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Moves of 0.3 ms, but it takes longer to send one."""
    move = '[[move]]\nsteps = [3]\nprofile = "cosine"\ntotal_time = 0.0003\nramp_time = 0.0001\n'
    file = write(tmp_path, f"clock_hz = {CLOCK_HZ}\n" + 30 * move)
    assert cli.main(["run", str(file), "--out", str(tmp_path / "out")]) == 1
    assert "RAMP_UNDERRUN" in capsys.readouterr().err
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert not summary["ok"]
    assert summary["axes"][0]["position"] == len(read_pulses(tmp_path / "out" / "pulses.csv"))


class Tampered:
    """An engine configured with another pin timing of axis 1 than the host wanted."""

    def __init__(self, engine: object):
        self.engine = engine

    def __getattr__(self, name: str) -> object:
        return getattr(self.engine, name)

    def transfer(self, mosi: Sequence[int], gap: int) -> list[int]:
        pins_of_axis_1 = r.ADDRESS_CHANNEL_BASE + r.CHANNEL_AXIS_BASE + r.CHANNEL_AXIS_STRIDE
        operation, length, address = mosi[0] >> 28, mosi[0] >> 12 & 0xFF, mosi[0] & 0xFFF
        if (operation, length, address) == (r.Operation.WRITE, 3, pins_of_axis_1):
            flags, step_timing, dir_timing = mosi[1:4]
            words = (flags, step_timing + (1 << r.AXIS_STEP_TIMING_STEP_HIGH_LSB), dir_timing)
            mosi = frame.write_frame(mosi[0] >> 20 & 0xFF, pins_of_axis_1, words)
        return self.engine.transfer(mosi, gap)


def test_a_difference_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def open_tampered(name: str, parameters: Parameters, clock_hz: int, waves: bool) -> PairEngine:
        return PairEngine(
            rtl_engine(parameters, clock_hz, waves), Tampered(model_engine(parameters, clock_hz))
        )

    monkeypatch.setattr(run_command, "open_engine", open_tampered)
    out = tmp_path / "out"
    assert cli.main(["run", str(write(tmp_path, TWO_MOVES)), "--out", str(out)]) == 1
    message = capsys.readouterr().err
    assert "step of axis 1 differs: expected (model) 1, actual (rtl) 0" in message
    assert message.count("\n") == 1
    found = json.loads((out / "summary.json").read_text())["difference"]
    assert {**found, "clock": 0} == {"clock": 0, "signal": "step", "index": 1, "expected": 1, "actual": 0}
    assert not (out / "pulses.csv").exists()


def events(*rows: tuple[int, int, int]) -> np.ndarray:
    made = np.zeros(len(rows), EVENT)
    for event, (clock, step, direction) in zip(made, rows, strict=True):
        event["clock"], event["step"], event["dir"] = clock, step, direction
    return made


@pytest.mark.parametrize(
    ("model", "rtl", "expected"),
    [
        ([(5, 1, 0), (9, 0, 0)], [(5, 1, 0), (8, 0, 0)], (8, "step", 0, 1, 0)),
        ([(5, 1, 0), (9, 0, 0)], [(5, 1, 0)], (9, "step", 0, 0, 1)),
        ([], [(7, 0, 4)], (7, "dir", 2, 0, 1)),
        ([(5, 2, 0)], [(5, 6, 0)], (5, "step", 2, 0, 1)),
        ([(5, 2, 1)], [(5, 2, 0)], (5, "dir", 0, 1, 0)),
    ],
)
def test_first_difference(model: list, rtl: list, expected: tuple) -> None:
    found = first_difference(events(*model), events(*rtl), events((0, 0, 0))[0])
    assert (found.clock, found.signal, found.index, found.expected, found.actual) == expected


def test_answers_are_compared() -> None:
    with model_engine(Parameters()) as one, model_engine(Parameters(ramp_queue_log2=5)) as other:
        pair = PairEngine(one, other)
        with pytest.raises(DifferenceError, match="miso of word 0"):  # the room in the status
            Link(pair)


class Noisy(Tampered):
    """A link on which some frames are damaged on MOSI or on MISO."""

    count = 0

    def transfer(self, mosi: Sequence[int], gap: int) -> list[int]:
        self.count += 1
        damaged = list(mosi)
        if self.count % 7 == 3:
            damaged[self.count % len(mosi)] ^= 1 << self.count % 32
        miso = self.engine.transfer(damaged, gap)
        if self.count % 5 == 2:
            miso[-1] ^= 1 << self.count % 32
        return miso


def test_noise_does_not_matter(tmp_path: Path) -> None:
    file = read_moves(write(tmp_path, TWO_MOVES))
    parameters = parameters_for(file.axes)
    with model_engine(parameters, file.clock_hz) as engine:
        noisy = Noisy(engine)
        assert execute(file, plan_file(file, parameters), noisy).problems() == []
    assert noisy.count > 15


def test_the_link_gives_up() -> None:
    class Dead:
        calls = 0

        def transfer(self, mosi: Sequence[int], gap: int) -> list[int]:
            self.calls += 1
            return [0] * len(mosi)

    dead = Dead()
    with pytest.raises(LinkError, match="failed 4 times: MISO stays low"):
        Link(dead)
    assert dead.calls == 4


def test_a_refusal_has_a_name() -> None:
    with model_engine(Parameters()) as engine:
        link = Link(engine)
        with pytest.raises(RefusedError, match="READ_ONLY") as caught:
            link.write(r.ADDRESS_IDENTIFICATION, 0)
        assert caught.value.verdict == Verdict.READ_ONLY
        with pytest.raises(RefusedError, match="UNKNOWN_ADDRESS"):
            link.read(0x0FF, 1)
        with pytest.raises(RefusedError, match="BAD_VALUE"):
            link.push(r.ADDRESS_CHANNEL_BASE + r.CHANNEL_LINE, [1, 0, 0, 0, 0, 0])


def test_a_terminal_that_lacks_letters(tmp_path: Path) -> None:
    """A name that it cannot show is shown otherwise."""
    path = write(tmp_path, TWO_MOVES, "\N{MICRO SIGN}.toml")
    command = [sys.executable, "-m", "passo.cli", "run", path, "--engine", "model", "--out", tmp_path / "out"]
    environment = {**os.environ, "PYTHONIOENCODING": "ascii:strict", "COLUMNS": "80"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.startswith("?: ")
