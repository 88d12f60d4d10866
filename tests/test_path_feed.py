# SPDX-License-Identifier: MIT
"""What the feed of a path knows of the time that the core still has (passo_path_feed.h)."""

import pytest
from passo import registers as r
from passo.native import planner
from passo.path import Path, PathAxis, PathFeed, PathSettings
from passo.registers import Operation, State

from tests.helpers.driver_wire import CLOCK_HZ, Wire, open_driver

MS = CLOCK_HZ // 1000
RAMP = r.ADDRESS_CHANNEL_BASE + r.CHANNEL_RAMP
SETTINGS = PathSettings((PathAxis(), PathAxis()), clock_hz=CLOCK_HZ)
LONGEST = 8_000_000  # us
CLOSE = 6 * MS  # some polls


class Fed:
    """A path at a core behind a wire, polled once in a millisecond."""

    def __init__(self) -> None:
        self.wire = Wire()
        self.driver = open_driver(self.wire)
        self.driver.call("configure_motion", 2 * MS, 2 * MS, 0)
        self.path = Path(SETTINGS, self.wire.parameters, 48)
        self.feed = PathFeed(self.driver, self.path)
        self.began: int | None = None
        self._held, self._seen = 0, 0

    def poll(self) -> None:
        """Let a millisecond pass."""
        self.feed.poll()
        self.wire.run(MS)
        if self.began is None and any(self.wire.counted()[0]):
            self.began = self.wire.clock

    @property
    def held(self) -> int:
        """Clocks of all ramps that were sent."""
        for request in self.wire.requests[self._seen :]:
            if request[0] >> 28 == Operation.PUSH and request[0] & 0xFFF == RAMP:
                self._held += sum(request[3:-1:5]) << 7  # the third of five words are ticks
        self._seen = len(self.wire.requests)
        return self._held

    @property
    def left(self) -> int:
        """The time of which the feed is sure, by passo_path_feed_is_short(), in clocks."""
        low, high = 0, LONGEST
        while low + 1 < high:
            middle = (low + high) // 2
            if planner().passo_path_feed_is_short(self.feed.c, middle):
                high = middle
            else:
                low = middle
        return low * (CLOCK_HZ // 1_000_000)


@pytest.mark.sample(1)
@pytest.mark.parametrize("percent", [100, 40])
def test_the_time_that_the_core_has(percent: int) -> None:
    """Of its ramps, as long as more may come: known to some milliseconds, and never more than it has."""
    fed = Fed()
    fed.driver.call("override", percent)
    for n in range(1, 5):
        fed.path.add((10.0 * n, 5.0 * n), 20.0 * n)
    while fed.began is None:
        fed.poll()
    seen = 0
    while fed.driver.is_streaming and fed.wire.clock - fed.began < CLOCK_HZ:
        fed.poll()
        truth = fed.held - (fed.wire.clock - fed.began) * percent // 100
        if fed.driver.state == State.RUN and fed.driver.is_streaming:
            assert truth - CLOSE <= fed.left <= truth
            seen += 1
    assert seen > 300
