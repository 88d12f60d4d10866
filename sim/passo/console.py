# SPDX-License-Identifier: MIT
"""Terminal output of the commands: progress bars, stages and tables."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from passo.output import BROKEN_PIPE, drop_output


class _Console(Console):
    def on_broken_pipe(self) -> None:
        """End as all commands do whose output nobody reads."""
        drop_output()
        raise SystemExit(BROKEN_PIPE)


console = _Console()


@contextmanager
def progress(name: str, clocks: int) -> Iterator[Callable[[int], None]]:
    """A progress bar if the output is a terminal; yields a function that sets the clocks done so far."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(name, total=clocks)
        yield lambda done: bar.update(task, completed=min(done, clocks))


@contextmanager
def passing(name: str, seconds: float | None = None) -> Iterator[Callable[[float], None]]:
    """The same for simulated seconds, of which the total may be unknown."""
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed:.3f} s simulated"))
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(name, total=seconds)
        yield lambda done: bar.update(task, completed=done)


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
