# SPDX-License-Identifier: MIT
"""Timed points (c_model/planner/passo_timed.h, stm32_bridge/driver/passo_follow.h)."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from passo.driver import Driver
from passo.failure import BadInputError
from passo.machine_file import MachineFile
from passo.moves import AXES_MAX
from passo.native import ffi, planner, unopened

POINT = np.dtype([("clocks", "u8"), ("target", "i8", AXES_MAX)])  # struct passo_timed_point
UNIT = float(1 << 32)
SECONDS_MAX = 1e6
MM_MAX = 2.0**27


class TimedPoints:
    """Points that have been checked against the limits of a machine."""

    def __init__(
        self,
        file: MachineFile,
        settings: Any,
        begin: Sequence[int],
        times: np.ndarray,
        places: np.ndarray,
        numbers: Sequence[int],
    ):
        """Times in s from the start; places in mm, time x axis; `begin`: motors, in steps.

        Raises BadInputError with the first point that cannot be made, as `numbers` call it, and why.
        """
        self._c, self._settings = planner(), settings
        points = np.zeros(len(times), POINT)
        points["clocks"] = np.rint(times * file.clock_hz).astype(np.uint64)
        points["target"][:, : places.shape[1]] = np.rint(places * UNIT).astype(np.int64)
        self._count, self._buffer = len(points), points
        self._points = ffi().cast("struct passo_timed_point *", ffi().from_buffer(points))
        self._follow = ffi().new("struct passo_follow *")
        self._check(file, begin, numbers)

    def _check(self, file: MachineFile, begin: Sequence[int], numbers: Sequence[int]) -> None:
        c, names = self._c, [*file.letters, *(f"motor {name}" for name in file.motors)]
        timed, line = unopened("passo_timed"), ffi().new("struct passo_line *")
        error = c.passo_timed_open(timed, self._settings, ffi().new("int32_t[8]", list(begin)))
        number = 0
        while error == c.PASSO_TIMED_OK and number < self._count:
            error = c.passo_timed_add(timed, self._points + number, line)
            number += error == c.PASSO_TIMED_OK
        if error == c.PASSO_TIMED_OK:
            error = c.passo_timed_end(timed)
            number -= error != c.PASSO_TIMED_OK
        if error != c.PASSO_TIMED_OK:
            text = ffi().string(c.passo_timed_error_text(error)).decode()
            of_time = error in (c.PASSO_TIMED_ORDER, c.PASSO_TIMED_LONG)
            about = "" if of_time else f"{names[timed.axis]}: "
            raise BadInputError(f"point {numbers[number]}: {about}{text}")

    def start(self, driver: Driver) -> None:
        """Start the motion; raises DriverError."""
        driver.call("follow", self._follow, self._settings, self._points, self._count)


def spline(times: np.ndarray, places: np.ndarray, period: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points of the cubic spline through points, at rest at both ends, at most `period` s apart.

    `places` are time x axis. All points given are among those returned, except the first one; the third
    array has the number of the point that each leads to.
    """
    count, step = len(times), np.diff(times)
    rise = np.diff(places, axis=0) / step[:, None]
    # velocities at the points: a tridiagonal system; 0 at the first and the last
    velocity, upper = np.zeros_like(places), np.zeros(count)
    for i in range(1, count - 1):
        pivot = 2 * (step[i - 1] + step[i]) - step[i] * upper[i - 1]
        right = 3 * (step[i] * rise[i - 1] + step[i - 1] * rise[i])
        velocity[i] = (right - step[i] * velocity[i - 1]) / pivot
        upper[i] = step[i - 1] / pivot
    for i in range(count - 2, 0, -1):
        velocity[i] -= upper[i] * velocity[i + 1]
    pieces = np.maximum(1, np.ceil(step / period - 1e-9).astype(int))
    at = np.repeat(np.arange(count - 1), pieces)
    u = np.concatenate([np.arange(1, number + 1) / number for number in pieces])
    found_times, u, length = times[at] + u * step[at], u[:, None], step[at][:, None]
    found = (
        places[at] * (1 + 2 * u) * (1 - u) ** 2
        + places[at + 1] * (3 - 2 * u) * u**2
        + length * u * (1 - u) * (velocity[at] * (1 - u) - velocity[at + 1] * u)
    )
    return found_times, found, at + 1
