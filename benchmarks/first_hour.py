# SPDX-License-Identifier: MIT
"""The numbers of a first hour with Passo, each with its goal; and that hour itself.

    python -m benchmarks.first_hour [--short] [--again] [--hour FILE] [PART...]

Writes the table of docs/first_hour.md. What was measured of a commit is kept, part by part, in
build/first_hour/figures.json: a run that was interrupted continues where it was. `--again` measures all of it
again; names of parts measure these alone, beside what is known of the others. `--short` prints a table of
small cases, without the hour in a fresh clone (tools/first_hour.sh); `--hour` takes it from an hour.json of
that script, as on a bare machine. Times are of the processor, but for `make demo`. Needs tools/setup.sh dev
firmware web browser, and the history of the repository for the times of an earlier commit.
"""

import argparse
import json
import re
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from passo.console import console, stages, table
from passo.ending import ended
from passo.output import check_results, make_folder, write_bytes, write_json, write_text
from passo.toolchain import paths

from benchmarks import page, play, preview

PAGE = paths.docs / "first_hour.md"
TABLE = re.compile(r"(<!-- report: make first-hour writes from here -->\n).*?(<!-- to here -->)", re.S)
SCRIPT = paths.tools / "first_hour.sh"
PLAY, RTL, CAMPAIGN = 8, 1.3, 3  # times as fast as in play.BEFORE, at least
DEMO_SECONDS, DEMO_MEGABYTES, FIRMWARE_SECONDS = 120, 400, 20
KEPT = paths.build / "first_hour" / "figures.json"
SHORT = 20  # by which lines are fewer
Tell = Callable[[str], None]
Part = Callable[[Tell], "Iterator[Figure]"]


@dataclass(frozen=True)
class Figure:
    """A number with its goal; texts of both with their units."""

    what: str
    goal: str
    measured: str
    met: bool
    command: str

    @property
    def row(self) -> tuple[str, ...]:
        """Of the table."""
        return self.what, self.goal, self.measured, "yes" if self.met else "**no**", f"`{self.command}`"


COLUMNS = ("what", "goal", "measured", "met", "by")


def most(what: str, goal: float, measured: float, unit: str, command: str) -> Figure:
    """A figure that is at most its goal."""
    shown = f"{measured:.3g}" if measured < 1000 else f"{measured:,.0f}"
    return Figure(what, f"at most {goal:g} {unit}", f"{shown} {unit}", measured <= goal, command)


def plays(tell: Tell, name: str, goal: float) -> Iterator[Figure]:
    """A case against an earlier commit, in one run."""
    (case,) = (case for case in play.CASES if case.name == name)
    (found,) = play.compare([case], tell=tell)
    said = f"{found.ratio:.2f} times, {found.before:.1f} s and {found.now:.1f} s"
    what = f"{case.text}, against {play.BEFORE}"
    yield Figure(what, f"{goal:g} times as fast", said, found.ratio >= goal, "python -m benchmarks.play")


def previews(tell: Tell, short: bool) -> Iterator[Figure]:
    """Of a long program, and against runs."""
    command, lines = "python -m benchmarks.preview", preview.LINES // (SHORT if short else 1)
    gcode = preview.GCODE
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        preview.planned(10, folder)  # builds
        seconds, _ = preview.planned(lines, folder)
        tell(f"preview: {seconds:.2f} s")
        yield most(f"`passo preview`, {lines:,} lines", preview.SECONDS, seconds, "s", command)
        parts = [(gcode / "part.nc", "machine.toml"), (gcode / "engraving.nc", "corexy.toml")]
        for case, text, count in () if short else preview.PLAYED:
            (folder / f"{case}.nc").write_text(text(count))
            parts.append((folder / f"{case}.nc", "machine.toml"))
        share = max(preview.off(part, gcode / machine, folder)[3] for part, machine in parts)
        what = f"its time is that of the run, worst of {len(parts)} parts"
        yield most(what, 100 * preview.SHARE, 100 * share, "%", command)


def pages(tell: Tell, short: bool) -> Iterator[Figure]:
    """Of the page of `make web`."""
    command, lines = "python -m benchmarks.page", page.LINES // (SHORT if short else 1)
    found = page.measure(lines)
    tell(f"page: {found.processor:.1f} s, longest task {found.longest_task:.3f} s")
    what = f"the page, {lines:,} lines of G-code until all is drawn, processor"
    yield most(what, page.SECONDS_MOST, found.processor, "s", command)
    what = "longest task of the page, processor"
    yield most(what, 1000 * page.BLOCKED_MOST, 1000 * found.longest_task, "ms", command)


def firmware(tell: Tell) -> Iterator[Figure]:
    """The demonstration of the firmware; builds do not count."""
    words = [sys.executable, "-m", "passo.cli", "firmware"]
    for _ in range(2):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(words, cwd=paths.root, check=True, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    tell(f"make firmware-demo: {seconds:.1f} s")
    yield most("`make firmware-demo`", FIRMWARE_SECONDS, seconds, "s", "make firmware-demo")


def hour(tell: Tell) -> Iterator[Figure]:
    """In a fresh clone."""
    with tempfile.TemporaryDirectory() as name:
        clone = Path(name) / "passo"
        subprocess.run(["sh", SCRIPT, paths.root, clone], check=True)
        made = clone / "build" / "first_hour"
        write_picture((made / "page.png").read_bytes())
        yield from hour_of(made / "hour.json", tell)


def hour_of(file: Path, tell: Tell) -> Iterator[Figure]:
    """As the script has written it."""
    found = json.loads(file.read_text(encoding="utf-8"))
    tell(f"make demo: {found['seconds']} s, {found['megabytes']} MB")
    command = "sh tools/first_hour.sh"
    yield most("`make demo` in a fresh clone, by the clock", DEMO_SECONDS, found["seconds"], "s", command)
    what = "the same, of the processor, on two cores"
    yield most(what, 2 * DEMO_SECONDS, found["processor"], "s", command)
    yield most("a fresh clone after `make demo`", DEMO_MEGABYTES, found["megabytes"], "MB", command)
    count = f"{found['commands']} of {found['commands']}"
    yield Figure("commands of README and tutorial that run there", "all", count, True, command)
    steps = f"{found['steps']:,} steps"
    yield Figure(
        "the example part on the page of that clone", "the steps of the command", steps, True, command
    )


def write_picture(png: bytes) -> None:
    """build/first_hour/page.png of the repository."""
    folder = paths.build / "first_hour"
    folder.mkdir(parents=True, exist_ok=True)
    write_bytes(folder / "page.png", png)


def written(figures: list[Figure], keep: bool = False) -> str:
    """The page with these figures; `keep`: beside its rows of others."""
    page = PAGE.read_text(encoding="utf-8")
    rows = [figure.row for figure in figures]
    if keep:  # each in its place, a new one behind the one before it
        there = [tuple(line.strip("| ").split(" | ")) for line in page.splitlines() if line.startswith("| ")][
            2:
        ]
        places, at = {row[0]: place for place, row in enumerate(there)}, len(there)
        behind: dict[int, list[tuple[str, ...]]] = {}
        for row in rows:
            at = places.get(row[0], at)
            if row[0] in places:
                there[at] = row
            else:
                behind.setdefault(at, []).append(row)
        kept = [[row, *behind.pop(place, [])] for place, row in enumerate(there)]
        rows = [row for some in (*kept, *behind.values()) for row in some]
    text = "".join(f"| {' | '.join(row)} |\n" for row in (COLUMNS, ("---",) * len(COLUMNS), *rows))
    return TABLE.sub(lambda found: found[1] + text + found[2], page)


# In the order of the page.
PARTS: dict[str, Part] = {
    "preview": lambda tell: previews(tell, False),
    "page": lambda tell: pages(tell, False),
    "play": lambda tell: plays(tell, "rosette", PLAY),
    "rtl": lambda tell: plays(tell, "rtl", RTL),
    "campaign": lambda tell: plays(tell, "campaign", CAMPAIGN),
    "firmware": firmware,
    "hour": hour,
}


def commit() -> str:
    """That of HEAD."""
    asked = subprocess.run(["git", "rev-parse", "HEAD"], cwd=paths.root, capture_output=True, text=True)
    return asked.stdout.strip()


def measure(
    tell: Tell, chosen: Sequence[str] = (), again: bool = False, parts: Mapping[str, Part] | None = None
) -> list[Figure]:
    """All figures: of the chosen parts now, of the others as they were; see above."""
    head, parts = commit(), parts or PARTS
    kept = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {}
    for name, part in parts.items():
        known = name in kept and kept[name]["commit"] == head
        if name in chosen or not (chosen or (known and not again)):
            kept[name] = {"commit": head, "figures": [asdict(figure) for figure in part(tell)]}
            make_folder(KEPT.parent)
            write_json(kept, KEPT)
    return [Figure(**figure) for name in parts if name in kept for figure in kept[name]["figures"]]


def known_all() -> bool:
    """Whether the figures of all parts are kept."""
    return KEPT.exists() and set(PARTS) <= set(json.loads(KEPT.read_text(encoding="utf-8")))


def measure_short(tell: Tell) -> list[Figure]:
    """Preview and page with fewer lines."""
    return [*previews(tell, True), *pages(tell, True)]


def main() -> int:
    """Of the command."""
    options = argparse.ArgumentParser(prog="first_hour", description="Measure a first hour with Passo.")
    options.add_argument("--short", action="store_true", help="small cases, no fresh clone, no page")
    options.add_argument("--again", action="store_true", help="forget what was measured")
    options.add_argument("--hour", type=Path, metavar="FILE", help="hour.json of tools/first_hour.sh")
    options.add_argument("parts", nargs="*", metavar="PART", help="measure only these")
    chosen = options.parse_args()
    if unknown := set(chosen.parts) - set(PARTS):
        options.error(f"no such part: {', '.join(sorted(unknown))}; there are {', '.join(PARTS)}")
    if chosen.short:
        figures = measure_short(stages())
    else:
        check_results(KEPT, PAGE)
        parts = PARTS | ({"hour": lambda tell: hour_of(chosen.hour, tell)} if chosen.hour else {})
        wanted = ["hour"] if chosen.hour and not chosen.parts else chosen.parts
        figures = measure(stages(), wanted, chosen.again, parts)
        write_text(PAGE, written(figures, keep=not known_all()))
    rows = table("A first hour", *COLUMNS)
    for figure in figures:
        rows.add_row(*figure.row)
    console.print(rows)
    return int(not all(figure.met for figure in figures))


if __name__ == "__main__":
    sys.exit(ended(main))
