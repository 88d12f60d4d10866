# SPDX-License-Identifier: MIT
"""The uses of trackers in examples/python/trackers.py reach their figures."""

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from passo.toolchain import paths


@pytest.fixture(scope="module")
def uses() -> Any:
    """The example as a module."""
    spec = importlib.util.spec_from_file_location("trackers", paths.examples / "python" / "trackers.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_torch_follows_a_sheet(uses: Any) -> None:
    """Within a quarter of a millimeter, and the path has the same pulses to the clock."""
    follows, rests = uses.torch(), uses.torch(follows=False)
    off = np.abs(follows.of("height") - uses.HEIGHT)
    assert off.max() < 0.3 and np.sqrt((off**2).mean()) < 0.12
    assert np.abs(rests.of("height") - uses.HEIGHT).max() > 1.2
    for mine, alone in zip(uses.steps_of(follows, 0), uses.steps_of(rests, 0), strict=True):
        assert np.array_equal(mine, alone)
    assert not len(uses.steps_of(rests, 1)[0]) and len(uses.steps_of(follows, 1)[0]) > 500


def test_a_gantry_is_squared(uses: Any) -> None:
    """To a step, off the switches; no path has run, and its positions are those of before."""
    result = uses.gantry()
    skew = result.of("skew")
    assert skew[0] == pytest.approx(uses.SKEW) and abs(skew[-1]) <= 1 / uses.SCALE
    assert round((result.of("y0")[-1] - uses.PULL_OFF) * uses.SCALE) in range(4)  # steps
    assert result.path == [0, 0] and not (result.events["running"] & np.uint64(1)).any()


def test_a_leadscrew_is_straightened(uses: Any) -> None:
    """To hardly more than a step, at 150 mm/s."""
    plain, corrected = uses.leadscrew(corrected=False), uses.leadscrew()
    _, _, before = uses.nut_errors(plain, plain)
    _, _, after = uses.nut_errors(corrected, plain)
    assert np.abs(before).max() == pytest.approx(0.07, abs=0.001)
    assert np.abs(after).max() < 1.5 / uses.SCALE


def test_pictures(uses: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The command draws one."""
    picture = tmp_path / "gantry.png"
    monkeypatch.setattr("sys.argv", ["trackers.py", "gantry", "--picture", str(picture)])
    uses.main()
    assert picture.read_bytes().startswith(b"\x89PNG")
