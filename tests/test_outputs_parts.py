# SPDX-License-Identifier: MIT
"""Cores with outputs, with and without RASTER and COMPARE: what they take, and what their pins do."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from passo import registers as r
from passo.build import Parameters
from passo.driver import DriverError, Source
from passo.engine import model_engine, rtl_engine
from passo.host import RATE_ONE, Channel
from passo.link import Link, RefusedError
from passo.native import ffi
from passo.pair_engine import PairEngine
from passo.registers import LineOutputWord, Verdict

from tests.helpers.closed_form import ONE, Line, Ramp
from tests.helpers.driver_wire import Wire, configure, error_of, finish, open_driver, path, struct
from tests.helpers.motions import to_line, to_ramp

CORES = [
    Parameters(outputs=1),
    Parameters(outputs=1, raster=1),
    Parameters(outputs=1, compare=1),
]
LAG = 7
RASTER = LineOutputWord(raster=True, proportional=False, levels=0, power=0)
SUBSTEPS = 40


class Both:
    """RTL and model, whose pins and replies are compared."""

    def __init__(self, parameters: Parameters) -> None:
        self.engine = PairEngine(rtl_engine(parameters), model_engine(parameters))
        self.channel = Channel(Link(self.engine), parameters)
        self.channel.configure_motion(RATE_ONE, RATE_ONE, 1 << 28)

    def write(self, name: str, value: int) -> None:
        """Write a register of the channel."""
        self.channel.link.write(self.channel.base + getattr(r, f"CHANNEL_{name}"), value)

    def move(self, *words: LineOutputWord) -> np.ndarray:
        """The pins while axis 0 makes a line of SUBSTEPS steps with each of these words."""
        self.engine.drain()
        lines = [Line(SUBSTEPS, (SUBSTEPS, 0, 0, 0), last=n == len(words)) for n in range(1, len(words) + 1)]
        self.channel.push_lines([to_line(line) for line in lines], words)
        ticks = len(words) * SUBSTEPS // 32
        self.channel.push_ramps(
            [to_ramp(Ramp(ONE // 4, 0)), to_ramp(Ramp(ONE // 4, ticks)), to_ramp(Ramp(0, 0, last=True))]
        )
        self.channel.start()
        self.engine.run(128 * (ticks + 20))
        return self.engine.drain()


@pytest.fixture(params=CORES, ids=lambda parameters: parameters.name)
def both(request: pytest.FixtureRequest) -> Iterator[Both]:
    """A core of each kind."""
    made = Both(request.param)
    yield made
    made.engine.close()


def rises(events: np.ndarray, signal: str, mask: int = 1) -> list[int]:
    """Clocks at which it rises."""
    levels = events[signal].astype(np.int64) & mask != 0
    before = np.concatenate([[False], levels[:-1]])
    return events["clock"][levels & ~before].tolist()


def test_levels_and_power_change_with_the_steps(both: Both) -> None:
    """LAG clocks after the first step of a line; also where there are neither raster nor compare."""
    both.write("OUTPUT_LAG", LAG)
    words = [
        LineOutputWord(raster=False, proportional=False, levels=1, power=0),
        LineOutputWord(raster=False, proportional=False, levels=2, power=65535),
        LineOutputWord(raster=False, proportional=False, levels=4, power=0),
    ]
    events = both.move(*words)
    steps = rises(events, "step")
    assert len(steps) == len(words) * SUBSTEPS
    firsts = steps[::SUBSTEPS]
    assert [rises(events, "outputs", 1 << bit) for bit in range(3)] == [[at + LAG] for at in firsts]
    lit = rises(events, "power")
    assert lit and firsts[1] < lit[0] < firsts[2]
    assert not rises(events, "compare")


def test_a_raster_line_needs_raster(both: Both) -> None:
    """Without it the line is refused, and nothing moves; OUTPUT_STATE has no room then."""
    with_raster = both.engine.parameters.raster
    state = both.channel.link.read(both.channel.base + r.CHANNEL_OUTPUT_STATE, 1)[0]
    assert state >> r.CHANNEL_OUTPUT_STATE_RASTER_ROOM_LSB == (256 if with_raster else 0)
    if with_raster:
        both.channel.link.push(both.channel.base + r.CHANNEL_RASTER, [0xFFFFFFFF] * (SUBSTEPS // 4))
        assert rises(both.move(RASTER), "power")
        return
    with pytest.raises(RefusedError) as refused:
        both.move(RASTER)
    assert refused.value.verdict == Verdict.BAD_VALUE
    both.engine.run(1000)
    assert not rises(both.engine.drain(), "step")


def test_a_pulse_needs_compare(both: Both) -> None:
    """At its position; without COMPARE there is no register for it."""
    writes = {"COMPARE_PULSE": 5, "COMPARE_DISTANCE": 3, "COMPARE_INTERVAL": 100}
    if both.engine.parameters.compare:
        for name, value in writes.items():
            both.write(name, value)
        events = both.move(LineOutputWord(raster=False, proportional=False, levels=0, power=0))
        assert rises(events, "compare") == [rises(events, "step")[2]]
        return
    for name, value in writes.items():
        with pytest.raises(RefusedError) as refused:
            both.write(name, value)
        assert refused.value.verdict == Verdict.UNKNOWN_ADDRESS, name


@pytest.mark.parametrize(("part", "lacks"), [("raster", "compare"), ("compare", "raster")])
def test_the_driver_says_what_the_core_has_not(part: str, lacks: str) -> None:
    """Each call that needs the part; those of the others do what they say, also a stream."""
    driver = open_driver(Wire(Parameters(axes=3, outputs=1, **{part: 1})))
    taken, values = ffi().new("size_t *"), ffi().new("uint8_t[4]")
    calls: dict[str, list[tuple[Any, ...]]] = {
        "raster": [
            ("set_output", struct("output", raster=True)),
            ("set_pitch", 1),
            ("push_raster", values, 4, taken),
        ],
        "compare": [("arm_compare", struct("compare_config", interval=1, width=1)), ("disarm_compare",)],
    }
    for call, *arguments in calls[lacks]:
        assert error_of(driver, call, *arguments) == "NO_OUTPUTS", call
    for call, *arguments in calls[part]:
        driver.call(call, *arguments)
    configure(driver)
    driver.call("set_levels", 5)
    lines, ramps = path(3)
    lines[0].output = RASTER.pack()
    driver.stream(Source(lines, ramps))
    if part == "raster":
        finish(driver)
        return
    with pytest.raises(DriverError, match="NO_OUTPUTS"):
        finish(driver)


def test_parts_of_parts() -> None:
    """RASTER and COMPARE need OUTPUTS."""
    for part in ("raster", "compare"):
        with pytest.raises(RuntimeError, match="does not support"):
            model_engine(Parameters(**{part: 1}))
