# SPDX-License-Identifier: MIT
"""A host that is left out where it has nothing to say: the same edges as with each of its polls."""

import random
from dataclasses import replace

import numpy as np
import pytest
from passo.build import Parameters
from passo.driver import DriverError
from passo.engine import Engine, model_engine
from passo.machine_file import read_machine
from passo.part import Played, play_part, read_part
from passo.path import PathAxis, PathFeed, PathSettings
from passo.program import Program
from passo.toolchain import paths

from benchmarks.path_reference import Line
from tests.helpers.path_player import play

MACHINE = read_machine(paths.root / "examples" / "gcode" / "machine.toml")
PART = paths.root / "examples" / "gcode" / "part.nc"
SETTINGS = PathSettings((PathAxis(), PathAxis(), PathAxis(400, 12, 100)))


def a_path(rng: random.Random) -> list[Line]:
    """Lines of any length and direction at feeds of any size."""
    here, lines = [0.0, 0.0, 0.0], []
    for _ in range(rng.randint(20, 120)):
        size = rng.choice([0.02, 0.3, 0.3, 3.0])
        here = [mm + rng.uniform(-size, size) for mm in here[:2]] + [here[2] + rng.choice([0, 0, 0.01])]
        lines.append((tuple(here), rng.choice([5.0, 20.0, 60.0])))
    return lines


def all_of(lines: list[Line], settings: PathSettings, look_ahead: int) -> list[object]:
    """What left the pins, and when the motions began and ended; or the error."""
    try:
        played = play(lines, settings, look_ahead, settings.clock_hz // settings.polls)
    except DriverError as error:
        return [str(error)]
    arrays = [one.tolist() for one in (*played.clocks, *played.steps)]
    return [arrays, played.motions, played.positions, played.drained]


@pytest.mark.parametrize("number", range(12))
def test_polls_without_news_have_no_effect(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Paths, rates of polls, profiles and look-aheads of all kinds."""
    rng = random.Random(number)
    polls = rng.choice([500, 1000, 3000, 8000])
    settings = replace(SETTINGS, polls=polls, profile=rng.choice(["linear", "linear", "cosine"]))
    lines, look_ahead = a_path(rng), rng.choice([4, 48, 300])
    fewer = all_of(lines, settings, look_ahead)
    monkeypatch.setattr(PathFeed, "rests", property(lambda feed: False))
    assert fewer == all_of(lines, settings, look_ahead)


def played_part() -> Played:
    with model_engine(Parameters(axes=4), MACHINE.clock_hz) as engine:
        return play_part(read_part(PART, MACHINE), MACHINE, engine)


def test_a_part_has_the_same_edges_with_each_poll(monkeypatch: pytest.MonkeyPatch) -> None:
    """Arcs, rapids and dwells; and most polls are left out."""
    passed, pass_looks = [], Engine.pass_looks
    monkeypatch.setattr(Engine, "pass_looks", lambda *given: passed.append(pass_looks(*given)))
    fewer = played_part()
    assert sum(passed) > 0.9 * fewer.seconds * MACHINE.clock_hz
    monkeypatch.setattr(Program, "rests", property(lambda program: False))
    each = played_part()
    assert fewer.motions == each.motions
    for mine, other in zip(fewer.clocks + fewer.positions, each.clocks + each.positions, strict=True):
        assert np.array_equal(mine, other)
