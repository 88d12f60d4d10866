# SPDX-License-Identifier: MIT
"""Motions of a machine: planned first, looked at, then run. Made by passo.host_machine.Machine."""

import asyncio
import time
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from passo.course import Course
from passo.failure import Failure
from passo.host_loop import Steps

if TYPE_CHECKING:
    from passo.host_machine import Machine

Array = np.ndarray[Any, np.dtype[Any]]


@dataclass(frozen=True)
class Done:
    """A motion that has ended."""

    machine: "Machine"
    begin: Array  # positions of the motors before it, in steps
    end: dict[str, float]  # positions of the axes after it, mm
    matched_edges: int | None  # edges on which RTL and model agree so far; None: nothing was compared
    _steps: Steps | None

    @property
    def seconds(self) -> dict[str, Array]:
        """By motor: when each of its steps left its pin, in s from the start. Raises Failure on a device."""
        return {name: self._pins.clocks[i] / self.machine.clock_hz for i, name in self._motors}

    @property
    def steps(self) -> dict[str, Array]:
        """By motor: its position after each of these steps. Raises Failure on a device."""
        return {name: self.begin[i] + self._pins.positions[i] for i, name in self._motors}

    @property
    def duration(self) -> float:
        """From the start of the first motion to the end of the last one, in s. Raises Failure on a device."""
        return self._pins.ends[-1] / self.machine.clock_hz if self._pins.ends else 0.0

    def positions_at(self, times: Array) -> Array:
        """Where the axes were at these times, in s from the start: time x axis, in mm, by the pins.

        Raises Failure on a device.
        """
        found = []
        for i, _ in self._motors:
            clocks = np.asarray(times) * self.machine.clock_hz
            places = np.concatenate([[0], self._pins.positions[i]])
            found.append(self.begin[i] + places[np.searchsorted(self._pins.clocks[i], clocks, "right")])
        return self.machine.axes_of(np.stack(found, axis=1))

    @property
    def _motors(self) -> list[tuple[int, str]]:
        return list(enumerate(self.machine.motors))

    @property
    def _pins(self) -> Steps:
        if self._steps is None:
            raise Failure('only a simulation sees the pins: Machine.from_file(..., on="model")')
        return self._steps


class Motion:
    """A motion that has not been run yet: `run` it, or `await` it, once.

    While it is awaited, other tasks may call `hold`, `resume`, `override` and `stop` of the machine. If the
    task is canceled, or `run` is interrupted, the axes come to rest with a soft stop first.
    """

    def __init__(self, machine: "Machine", start: Callable[[], None], begin: Array):
        self.machine, self.begin, self._start = machine, begin, start

    def run(self) -> Done:
        """Run it and wait for its end. Raises DriverError, and Failure if the axes are elsewhere by now."""
        turns = self._turns()
        try:
            while True:
                if pause := next(turns):
                    time.sleep(pause)
        except StopIteration as end:
            return end.value  # type: ignore[no-any-return]
        finally:
            turns.close()

    def __await__(self) -> Generator[Any, None, Done]:
        """Run it while other tasks run."""
        return self._run_with_others().__await__()

    async def _run_with_others(self) -> Done:
        turns = self._turns()
        try:
            while True:
                await asyncio.sleep(next(turns))
        except StopIteration as end:
            return end.value  # type: ignore[no-any-return]
        finally:
            turns.close()

    def _turns(self) -> Generator[float, None, Done]:
        """Each turn is a poll; yields the seconds until the next one."""
        machine = self.machine
        machine.require(self.begin)
        core = machine.core
        core.begin()
        try:
            self._start()
            while core.is_moving:
                yield core.turn()
                if machine.is_closed:
                    raise Failure("the machine was closed during the motion")
        except BaseException:
            machine.halt()
            raise
        steps = core.steps(len(machine.motors))
        return Done(machine, self.begin, machine.position, core.matched_edges, steps)


class PlannedMotion(Motion):
    """A motion whose course is known before it is run."""

    def __init__(
        self,
        machine: "Machine",
        start: Callable[[], None],
        begin: Array,
        seconds: float,
        positions_at: Callable[[Array], Array],
        course: Course | None = None,
    ):
        super().__init__(machine, start, begin)
        self.seconds = seconds
        self.course = course  # of a path: its speeds, and the limits that bind it
        self._positions_at = positions_at

    def positions_at(self, times: Array) -> Array:
        """Where the axes will be at these times, in s from the start: time x axis, in mm."""
        return self._positions_at(np.asarray(times, float))
