# SPDX-License-Identifier: MIT
"""Python binding of the player of whole programs (stm32_bridge/grbl/passo_program.h)."""

from collections.abc import Sequence
from typing import Any

from passo.driver import Driver, DriverError
from passo.gcode import GcodeError, GcodeSettings
from passo.native import ffi, planner, unopened
from passo.path import LOOK_AHEAD, PathSettings

MICROSECONDS = 1_000_000


class Program:
    """A `struct passo_program` on a channel, whose axes are configured. Methods raise DriverError."""

    def __init__(
        self, driver: Driver, path: PathSettings, gcode: GcodeSettings, look_ahead: int = LOOK_AHEAD
    ):
        self.driver = driver
        self._c = planner()
        self.c = unopened("passo_program")
        self._items = ffi().new("struct passo_path_item[]", look_ahead)
        settings = ffi().new("struct passo_program_settings *")
        settings.path = path.struct(driver.engine.parameters)[0]
        settings.gcode = gcode.struct()[0]
        self._inputs = settings.inputs = gcode.simulated_inputs()
        self._check("open", self._c.passo_program_open(self.c, driver.c, settings, self._items, look_ahead))

    def begin(self, gcode: Any, steps: Sequence[int]) -> None:
        """Begin with the modes of a `struct passo_gcode`, at these positions of the motors."""
        self.c.gcode = gcode[0]
        self._c.passo_path_restart(ffi().addressof(self.c, "path"), ffi().new("int32_t[8]", list(steps)))

    @property
    def is_ready(self) -> bool:
        """Whether another line can be taken."""
        return self._c.passo_program_is_ready(self.c)

    @property
    def is_done(self) -> bool:
        """Whether the program has ended, and all its motions with it."""
        return self._c.passo_program_is_done(self.c)

    @property
    def chords(self) -> int:
        """Lines and chords taken so far."""
        return self.c.player.chords

    @property
    def follows(self) -> bool:
        """Whether a motion is in step with the spindle."""
        return self.c.player.thread.step != self._c.PASSO_PLAYER_FREE

    @property
    def threads(self) -> int:
        """Passes in step with the spindle so far."""
        return self.c.player.threads

    @property
    def pass_lines(self) -> int:
        """Lines of the program in the last one."""
        thread = self.c.player.thread
        return 1 if thread.rigid else getattr(thread, "pass").lines

    @property
    def power(self) -> int:
        """Of the spindle, as commanded: up to 65535. Lines behind a thread do not change its speed."""
        if self.follows:
            return self.c.player.thread.output & 0xFFFF
        return self._c.passo_gcode_output(ffi().addressof(self.c, "gcode")) & 0xFFFF

    def wait(self, seconds: float, at_speed: int) -> None:
        """Motions wait for the spindle: a time, or until an input of M66 says that it is at its speed."""
        self.c.machine.spin_up, self.c.machine.at_speed = round(seconds * MICROSECONDS), at_speed

    def say_at_speed(self, level: bool) -> None:
        """The level of that input."""
        if at_speed := self.c.machine.at_speed:
            self._inputs[0] = self._inputs[0] & ~(1 << at_speed) | level << at_speed

    @property
    def is_slow(self) -> bool:
        """Whether it has not said so in time."""
        return self.c.slow

    def line(self, line: bytes) -> None:
        """Execute a line, when ready; raises GcodeError."""
        if number := self._c.passo_program_line(self.c, line, len(line)):
            raise GcodeError(number)

    def end(self) -> None:
        """No line follows."""
        self._c.passo_program_end(self.c)

    def poll(self) -> None:
        """Take what there is room for, and poll the driver."""
        self._check("poll", self._c.passo_program_poll(self.c))

    @property
    def rests(self) -> bool:
        """Whether polls would only read the state until that has changed."""
        return not self.follows and self._c.passo_program_rests(self.c)

    def _check(self, call: str, error: int) -> None:
        self.driver.hardware.check()
        if error != self._c.PASSO_OK:
            raise DriverError(f"program_{call}", error)
