# SPDX-License-Identifier: MIT
"""Terminal output of the commands: progress bars, stages and tables."""

import json
import signal
import sys
import threading
import time
import weakref
from collections.abc import Callable, Collection, Iterable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TypeVar

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    ProgressColumn,
    TaskID,
    TextColumn,
    TimeRemainingColumn,
)
from rich.table import Table

from passo.failure import BadInputError, Failure
from passo.output import BROKEN_PIPE, drop_output, write_json
from passo.toolchain import paths

EVERY = 10  # seconds between two lines of progress
LASTED = "durations.json"  # in the build folder: seconds of each stage, the last time
S = TypeVar("S")
T = TypeVar("T")


class _Console(Console):
    def on_broken_pipe(self) -> None:
        """End as all commands do whose output nobody reads."""
        drop_output()
        raise SystemExit(BROKEN_PIPE)


console = _Console()


class Estimate:
    """How long a work still takes, by what was done of it; and when it is time to say so again."""

    def __init__(self, total: float):
        self.total, self.began = total, time.monotonic()
        self._said = self.began

    def left(self, done: float) -> str:
        """Such as `2:05 left`; empty before anything is done."""
        if not 0 < done <= self.total:
            return ""
        minutes, seconds = divmod(round((time.monotonic() - self.began) * (self.total / done - 1)), 60)
        return f"{minutes}:{seconds:02} left"

    def counted(self, done: int) -> str:
        """Such as `3 of 10, 2:05 left`."""
        left = self.left(done) if done < self.total else ""
        return f"{done:,} of {self.total:,}{left and ', '}{left}"

    def is_due(self) -> bool:
        """Whether nothing was said for `EVERY` seconds; if so, it counts as said."""
        due = time.monotonic() - self._said >= EVERY
        if due:
            self._said = time.monotonic()
        return due


@contextmanager
def progress(name: str, total: float) -> Iterator[Callable[[float], None]]:
    """Yield a function that is called with what is done so far.

    On a terminal it draws a bar with an estimate of what is left, else a line every `EVERY` seconds, on
    standard error.
    """
    columns = (BarColumn(), TextColumn("{task.percentage:>3.0f} %"), TimeRemainingColumn())
    with _bar(name, total, *columns) as (bar, task):
        estimate = Estimate(total)

        def report(done: float) -> None:
            bar.update(task, completed=min(done, total))
            if bar.disable and estimate.is_due() and done < total:
                left = estimate.left(done)
                print(f"{name}: {done / total:.0%}{left and ', '}{left}", file=sys.stderr, flush=True)

        yield report


def each(name: str, items: Collection[T]) -> Iterator[T]:
    """The items, with the progress of the work between them."""
    with progress(name, len(items)) as report:
        for count, item in enumerate(items, 1):
            yield item
            report(count)


@dataclass
class Work:
    """Whether Ctrl-C has ended it."""

    canceled: bool = False


@contextmanager
def cancelable() -> Iterator[Work]:
    """A work that Ctrl-C ends; what follows shows what is done so far."""
    work = Work()
    try:
        yield work
    except KeyboardInterrupt:
        work.canceled = True
        print("canceled: what follows is what was done until then", file=sys.stderr, flush=True)


def leave_interrupts() -> None:
    """In a worker of a pool: Ctrl-C is for the process that waits."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def in_turn(pool: Executor, work: Callable[[S], T], items: Iterable[S]) -> Iterator[T]:
    """The results of a pool in the order of the items; what has not begun is dropped where this is left."""
    waiting = [pool.submit(work, item) for item in items]
    try:
        for one in waiting:
            yield one.result()
    finally:
        for one in waiting:
            one.cancel()


@contextmanager
def passing(name: str, seconds: float | None = None) -> Iterator[Callable[[float], None]]:
    """The same for simulated seconds, of which the total may be unknown."""
    columns = (BarColumn(), TextColumn("{task.completed:.3f} s simulated"))
    with _bar(name, seconds, *columns) as (bar, task):
        estimate = Estimate(seconds or 0)

        def report(done: float) -> None:
            bar.update(task, completed=done)
            if bar.disable and estimate.is_due():
                left = estimate.left(done)
                text = f"{name}: {done:.3f} s simulated{left and ', '}{left}"
                print(text, file=sys.stderr, flush=True)

        yield report


@contextmanager
def _bar(name: str, total: float | None, *columns: ProgressColumn) -> Iterator[tuple[Progress, TaskID]]:
    """On standard error, so that results can be redirected beside it."""
    status = _Console(stderr=True)
    with Progress(
        TextColumn("{task.description}"),
        *columns,
        console=status,
        transient=True,
        disable=not status.is_terminal,
        redirect_stdout=console.is_terminal,
    ) as bar:
        yield bar, bar.add_task(name, total=total)


class Stages:
    """Prints a line for each stage of a work, with the time elapsed since its begin.

    While a stage lasts, every `EVERY` seconds a line on standard error, with what is left if it takes as long
    as the last time.
    """

    def __init__(self) -> None:
        self.began = self.since = time.monotonic()
        self.stage = ""
        self._ended = threading.Event()
        weakref.finalize(self, self._ended.set)

    def __call__(self, words: str) -> None:
        """A stage begins."""
        now = time.monotonic()
        if self.stage:
            _remember(self.stage, now - self.since)
        else:
            threading.Thread(target=_beat, args=(weakref.ref(self), self._ended), daemon=True).start()
        self.stage, self.since = words, now
        print(f"[{_minutes(now - self.began).rjust(6)}] {words}", flush=True)

    def end(self) -> None:
        """The last stage has ended, as one that fails has not: the next run knows how long it lasted."""
        if self.stage:
            _remember(self.stage, time.monotonic() - self.since)
        self._ended.set()

    def lasts(self) -> str:
        """Such as `synthesis: 0:20, 1:05 left`, or `synthesis: 0:20` when nothing is known of it."""
        passed = time.monotonic() - self.since
        left = _durations().get(self.stage, 0) - passed
        return f"{self.stage}: {_minutes(passed)}" + (f", {_minutes(left)} left" if left > 0 else "")


def stages() -> Stages:
    """Return a function that prints a line for each stage; see Stages."""
    return Stages()


def _beat(of: "weakref.ref[Stages]", ended: threading.Event) -> None:
    while not ended.wait(EVERY):
        if stage := of():
            print(stage.lasts(), file=sys.stderr, flush=True)
        del stage


def _minutes(seconds: float) -> str:
    minutes, rest = divmod(int(seconds), 60)
    return f"{minutes}:{rest:02}"


def _durations() -> dict[str, float]:
    with suppress(OSError, ValueError):
        return dict(json.loads((paths.build / LASTED).read_text(encoding="utf-8")))
    return {}


def _remember(stage: str, seconds: float) -> None:
    """Keep how long a stage lasted, if it was long enough to ask."""
    if seconds < EVERY:
        return
    with suppress(BadInputError, Failure):
        write_json(_durations() | {stage: round(seconds, 1)}, paths.build / LASTED)


def table(title: str, first: str, *columns: str) -> Table:
    """An empty table; all columns except the first are right-aligned."""
    made = Table(title=title, title_justify="left", box=SIMPLE_HEAD, show_edge=False, pad_edge=False)
    made.add_column(first, no_wrap=True)
    for column in columns:
        made.add_column(column, justify="right", no_wrap=True)
    return made
