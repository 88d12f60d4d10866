# SPDX-License-Identifier: MIT
"""Terminal output of the commands: progress bars, stages and tables."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

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

from passo.output import BROKEN_PIPE, drop_output

EVERY = 10  # seconds between two lines of progress


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


def stages() -> Callable[[str], None]:
    """Return a function that prints a line with the time elapsed since now."""
    began = time.monotonic()

    def tell(words: str) -> None:
        minutes, seconds = divmod(int(time.monotonic() - began), 60)
        print(f"[{minutes:3}:{seconds:02}] {words}", flush=True)

    return tell


def table(title: str, first: str, *columns: str) -> Table:
    """An empty table; all columns except the first are right-aligned."""
    made = Table(title=title, title_justify="left", box=SIMPLE_HEAD, show_edge=False, pad_edge=False)
    made.add_column(first, no_wrap=True)
    for column in columns:
        made.add_column(column, justify="right", no_wrap=True)
    return made
