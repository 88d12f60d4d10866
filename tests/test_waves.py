# SPDX-License-Identifier: MIT
"""`passo run --waves`: the window is exact, and the save file shows existing signals."""

import re
from pathlib import Path

import pytest
from passo import cli
from passo.build import waves_possible
from passo.registers import State

from tests.helpers.fst import Fst, read_fst

CLOCK_HZ = 1_280_000
HALF_PS = 390_625
MOVES = f"""
clock_hz = {CLOCK_HZ}
[[move]]
steps = [200, -120, 0]
profile = "cosine"
total_time = 0.05
ramp_time = 0.02
"""


TWO_CHANNELS = (
    MOVES.replace("[200, -120, 0]", "[200]\nchannel = 0")
    + """
[[move]]
steps = [-30, 20]
channel = 1
profile = "linear"
total_time = 0.01
ramp_time = 0.001
"""
)


def run(folder: Path, *options: str, text: str = MOVES) -> tuple[int, Path]:
    moves, out = folder / "moves.toml", folder / "out"
    moves.write_text(text)
    return cli.main(["run", str(moves), "--out", str(out), *options]), out


def start_of(out: Path) -> int:
    """Where the marker is, in ps."""
    return int(re.search(r"^\*-\d+ (\d+) ", (out / "waves.gtkw").read_text(), re.M)[1])


def signals(view: str) -> list[str]:
    """Those that a save file shows."""
    return re.findall(r"^(?:\(\d+\))?(TOP\..*)$", view, re.M)


def waves(folder: Path, *options: str, text: str = MOVES) -> tuple[Path, Fst]:
    status, out = run(folder, "--engine", "rtl", "--waves", *options, text=text)
    assert status == 0
    return out, read_fst(out / "waves.fst")


needs_writer = pytest.mark.skipif(not waves_possible(), reason="liblz4-dev and zlib1g-dev are not installed")


@needs_writer
def test_by_default_the_start(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, fst = waves(tmp_path)
    start = start_of(out)
    assert (fst.begin, fst.exponent) == (0, -12)
    assert fst.end == start + 2 * 2560 * HALF_PS - HALF_PS
    said = capsys.readouterr().out
    assert f"gtkwave {out / 'waves.gtkw'}" in said and f"surfer {out / 'waves.fst'}" in said
    assert f"waves, {(out / 'waves.fst').stat().st_size / 1e6:.1f} MB" in said

    view = (out / "waves.gtkw").read_text()
    shown = signals(view)
    assert len(shown) > 30 and set(shown) <= fst.names
    groups = [re.findall(rf"^@{flag}\n-(.*)$", view, re.M) for flag in ("800200", "1000200")]
    assert groups[0] == groups[1] and groups[0][-3:] == ["axis 0", "axis 1", "axis 2"]
    for file in re.findall(r"^\^1 (.*)$", view, re.M):
        assert Path(file).read_text().startswith("0 ")
    assert f"{State.RUN:x} RUN\n" in (out / "waves_state.txt").read_text()


@needs_writer
def test_a_window(tmp_path: Path) -> None:
    out, fst = waves(tmp_path, "10ms..12.5ms")
    start = start_of(out)
    begin, end = (round(seconds * CLOCK_HZ) * 2 * HALF_PS for seconds in (0.010, 0.0125))
    assert (fst.begin, fst.end) == (start + begin, start + end - HALF_PS)
    assert (out / "waves.fst").stat().st_size < 300_000


@needs_writer
def test_several_channels(tmp_path: Path) -> None:
    """The signals of each, and the names of their axes."""
    out, fst = waves(tmp_path, text=TWO_CHANNELS)
    view = (out / "waves.gtkw").read_text()
    for channel in (0, 1):
        assert f"g_channel[{channel}].u_channel.u_path.state" in view
        assert f"-channel {channel}: axis 0" in view
    assert "-channel 1: axis 1" in view
    assert set(signals(view)) <= fst.names


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--waves", "moves.toml"], "'moves.toml' is not a window such as 2ms or 100ms..102ms"),
        (["--waves", "1ms..2parsec"], "is not a window"),
        (["--waves", "-1ms"], "is not a window"),
        (["--waves", "2ms..2ms"], "the window 2ms..2ms is empty"),
        (["--waves", "1s..2s"], "the motion takes only 0.05 s"),
        (["--waves", "--engine", "model"], "--waves needs the RTL"),
    ],
)
def test_bad_windows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], options: list[str], said: str
) -> None:
    if options[1] == "-1ms":  # a value that begins like an option
        options = ["--waves=-1ms"]
    status, out = run(tmp_path, *options)
    error = capsys.readouterr().err
    assert status == 2 and said in error and error.count("\n") == 1
    assert not out.exists()
