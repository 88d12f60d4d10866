# SPDX-License-Identifier: MIT
"""Python binding of the player of G-code (stm32_bridge/grbl/passo_player.h)."""

from passo.driver import DriverError
from passo.gcode import Gcode
from passo.native import ffi, planner, unopened
from passo.path import PathFeed


class Player:
    """A `struct passo_player` without limits of travel."""

    def __init__(self, gcode: Gcode, feed: PathFeed):
        self.gcode, self.feed = gcode, feed
        self._c = planner()
        self._settings = feed.path.settings.struct(feed.path.parameters)
        self._machine = ffi().new("struct passo_player_machine *", {"axis": self._settings.axis})
        self._event = ffi().new("enum passo_player_event *")
        self.c = unopened("passo_player")
        self._c.passo_player_open(self.c, gcode.c, feed.c, self._machine)

    @property
    def is_ready(self) -> bool:
        """Whether another line can be executed."""
        return self._c.passo_player_is_ready(self.c)

    @property
    def is_idle(self) -> bool:
        """Whether nothing moves and nothing is left to be done."""
        return self._c.passo_player_is_idle(self.c)

    @property
    def chords(self) -> int:
        """Lines and chords taken so far."""
        return self.c.chords

    @property
    def follows(self) -> bool:
        """Whether a motion is in step with the spindle."""
        return self.c.thread.step != self._c.PASSO_PLAYER_FREE

    @property
    def power(self) -> int:
        """Of the spindle, as commanded: up to 65535. Lines behind a thread do not change its speed."""
        output = self.c.thread.output if self.follows else self._c.passo_gcode_output(self.gcode.c)
        return output & 0xFFFF

    def poll(self) -> str:
        """Take what there is room for, and poll the driver; return the event, such as "PAUSED"."""
        error = self._c.passo_player_poll(self.c, self._event)
        self.feed.driver.hardware.check()
        if error != self._c.PASSO_OK:
            raise DriverError("player_poll", error)
        name = ffi().string(ffi().cast("enum passo_player_event", self._event[0]))
        return name.removeprefix("PASSO_PLAYER_")

    def go_on(self) -> None:
        """After a pause."""
        self._c.passo_player_go_on(self.c)
