# SPDX-License-Identifier: MIT
"""The plots show what happened and nothing else, and nothing is printed over something else."""

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from passo import plot, plot_panels
from passo.engine import model_engine
from passo.move_file import read_moves
from passo.plan import plan_file
from passo.plot import plot_motion
from passo.run import Run, execute, parameters_for
from passo.toolchain import paths

CLOCK_HZ = 4_000_000
PINS = '[pins]\nstep_high = "2us"\ndir_setup = "5us"\ndir_hold = "3us"\n'
THERE_AND_BACK = ([300, 0, 1], [0, 200, 0], [-300, 0, 0], [0, -200, 0])


def run_moves(folder: Path, *moves: list[int]) -> Run:
    tables = (
        f'[[move]]\nsteps = {steps}\nprofile = "cosine"\ntotal_time = "300ms"\nramp_time = "100ms"\n'
        for steps in moves
    )
    path = folder / "moves.toml"
    path.write_text(f"clock_hz = {CLOCK_HZ}\n{PINS}" + "".join(tables))
    return run_file(path)


def run_file(path: Path) -> Run:
    file = read_moves(path)
    parameters = parameters_for(file.axes)
    with model_engine(parameters, file.clock_hz) as engine:
        return execute(file, plan_file(file, parameters), engine)


def test_no_speed_while_an_axis_rests(tmp_path: Path) -> None:
    """x stands while y moves: the line of x is broken there."""
    run = run_moves(tmp_path, *THERE_AND_BACK)
    clocks, speeds, _ = plot_panels.measured_speeds(run, 0)
    gaps = np.flatnonzero(np.isnan(speeds))
    assert [round(clocks[gap] / CLOCK_HZ, 2) for gap in gaps] == [0.45]
    # The same direction before and after the rest.
    run = run_moves(tmp_path, [300, 0, 1], [0, 200, 0], [300, 0, 0])
    clocks, speeds, _ = plot_panels.measured_speeds(run, 0)
    assert [round(clocks[gap] / CLOCK_HZ, 2) for gap in np.flatnonzero(np.isnan(speeds))] == [0.45]
    # Without a rest there is no gap.
    run = run_moves(tmp_path, [300, 1, 1], [300, 1, 1])
    assert not np.isnan(plot_panels.measured_speeds(run, 0)[1]).any()


def test_many_steps_are_shown_as_their_mean_speed() -> None:
    """Steps that come unevenly make a line and no band; where they are few, each of them is seen."""
    clocks = np.concatenate([np.cumsum([80.0, 120.0] * 50), [20_000.0, 30_000.0]])
    speeds = np.concatenate([1 / np.diff(clocks, prepend=0)[:-2], [np.nan, 1 / 10_000]])
    times, means = plot_panels.evened(clocks, speeds, 2000)
    assert means[:5] == pytest.approx(0.01, rel=0.02) and len(means) == 8
    assert np.isnan(means[6]) and (times[-1], means[-1]) == (30_000, 1 / 10_000)
    assert len(plot_panels.evened(clocks, speeds, 200)[0]) == len(clocks)


def test_a_single_step_has_a_line(tmp_path: Path) -> None:
    run = run_moves(tmp_path, *THERE_AND_BACK)
    for axis, count in enumerate([0, 0, 1]):
        assert len(plot_panels.measured_speeds(run, axis)[2]) == count
    figure = Figure()
    ax = figure.subplots()
    plot_panels.plot_speed(ax, run)
    lines = [collection.get_segments() for collection in ax.collections]
    assert [len(segments) for segments in lines] == [0, 0, 1]
    assert lines[2][0][1][1] > 0


def test_the_pulse_follows_a_change_of_direction(tmp_path: Path) -> None:
    run = run_moves(tmp_path, *THERE_AND_BACK)
    axis, clock = plot_panels.shown_pulse(run)
    assert axis in (0, 1)
    assert clock in run.steps(axis)[0]


def test_units() -> None:
    assert plot_panels.units_of(run_file(paths.examples / "straight.toml")).name == "mm"
    units = plot_panels.units_of(run_file(paths.examples / "triangle.toml"))
    assert (units.name, units.speed) == ("steps", "kHz")


@pytest.mark.parametrize("axes", [1, 3, 8])
def test_nothing_is_printed_over_something_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, axes: int
) -> None:
    """The titles and the legend; and the rows of both rows of signals are at the same heights."""
    figures = []
    monkeypatch.setattr(plot, "save", lambda figure, path, dpi: figures.append(figure))
    run = run_moves(tmp_path, *([*steps, 0, 0, 0, 0, 0][:axes] for steps in ([300, 9, 1], [-300, 1, 0])))
    plot_motion(run, tmp_path / "motion.png")
    (figure,) = figures
    figure.draw_without_rendering()
    boxes = [figure._suptitle.get_window_extent(), *(legend.get_window_extent() for legend in figure.legends)]
    boxes += [ax._left_title.get_window_extent() for ax in figure.axes]
    assert len(boxes) == 1 + (axes > 1) + 7
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    rows = [ax.get_ylim() for ax in figure.axes if ax.get_title("left").endswith("milliseconds")]
    assert len(rows) == 2 and rows[0] == rows[1]
