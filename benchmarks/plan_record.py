# SPDX-License-Identifier: MIT
"""The record of plans: the duration of paths and moves, and a hash of all that the core is sent for them.

    .venv/bin/python -m benchmarks.plan_record

writes it again and shows what has changed. A change of the planner that should not alter a plan must not
alter the record; of any other change, it says which paths and moves became faster or slower. It is not a
judge: a wrong plan can be on record.
"""

import cmath
import json
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from hashlib import sha256
from pathlib import Path

from passo.campaign_moves import draw, to_toml
from passo.console import console
from passo.ending import ended
from passo.move_file import parse_channels
from passo.moves import MoveFileError
from passo.output import check_results, write_text
from passo.path import PathAxis, PathSettings
from passo.path_rounding import Line
from passo.plan import plan_channels
from passo.run import parameters_of
from passo.shape import parse_table, table_text

from benchmarks import path_adversary
from benchmarks.path_cases import circle, square, star, text, trochoid, wanderings
from benchmarks.path_paths import read_cases
from benchmarks.path_plan import plan

RECORD = Path(__file__).with_suffix(".json")
KNOWN = 1000  # lines: all of a path
LOOK_AHEAD = 48
MOVES = 240  # random move files
DIGITS = 12  # of a hash
SHOWN = 40  # changes
PACE = (16, 32, 8)  # ramps and lines that a core holds, and lines of a frame
LITTLE = (2, 4, 2)  # the same of a very small one
PROFILES = ("linear", "cosine", "sigmoid", "jerk")
SMOOTH = PathSettings((PathAxis(jerk=20_000), PathAxis(jerk=20_000), PathAxis(50, 100, 300, jerk=6000)))
PATHS: dict[str, Callable[[], Sequence[Line]]] = {
    "square of 20 mm": lambda: square(20),
    "star": lambda: star(10),
    "circle of 5 mm": lambda: circle(5, 90),
    "letters": lambda: text("PASSO"),
    "trochoid": lambda: trochoid(4, 2, chords=36),
}


def _behind(count: int, chord: float, bend: float) -> list[Line]:
    """Short lines behind a long one, each turned by an angle in radians."""
    place = complex(30)
    lines: list[Line] = [((place.real, 0.0, 0.0), 100.0)]
    for number in range(1, count + 1):
        place += cmath.rect(chord, number * bend)
        lines.append(((place.real, place.imag, 0.0), 100.0))
    return lines


@dataclass(frozen=True)
class Entry:
    """Of one plan."""

    clocks: int
    ramps: int
    sent: str  # hash

    def __str__(self) -> str:
        return f"{self.clocks:,} clocks, {self.ramps} ramps, {self.sent}"


def _hash(words: Sequence[object]) -> str:
    return sha256(repr(words).encode()).hexdigest()[:DIGITS]


def of_path(
    lines: Sequence[Line], settings: PathSettings, look_ahead: int, pace: tuple[int, int, int] | None = None
) -> Entry:
    """A path, fed as fast as it is planned, or for a feed with these arguments of passo_path_pace()."""
    made = plan(lines, settings, look_ahead, pace=pace)
    words = [(ramp.shape, ramp.mirror, ramp.progress_step, ramp.last) for ramp in made.ramps]
    return Entry(made.clocks, len(made.ramps), _hash([made.words, words]))


def of_moves(number: int) -> Entry:
    """The moves of a random file; a refusal has no ramps."""
    case = draw(1, number)
    table = table_text(case.table) if case.table else ""
    try:
        channels = parse_channels(
            to_toml(case.data), Path(f"{case.name}.toml"), lambda path: parse_table(table, path)
        )
        plans = [one for own in plan_channels(channels, parameters_of(channels)) for one in own]
    except MoveFileError as error:
        return Entry(0, 0, _hash([str(error)]))
    lines = [(one.line.substeps, one.line.directions, list(one.line.steps), one.table) for one in plans]
    ramps = [(r.ticks, r.shape, r.mirror, r.velocity_end, r.progress_step) for p in plans for r in p.ramps]
    return Entry(sum(one.clocks for one in plans), len(ramps), _hash([lines, ramps]))


def entries() -> dict[str, Callable[[], Entry]]:
    """What is recorded, by name."""
    found: dict[str, Callable[[], Entry]] = {}

    def add(
        name: str,
        lines: Callable[[], Sequence[Line]],
        settings: PathSettings,
        ahead: int,
        pace: tuple[int, int, int] | None = None,
    ) -> None:
        how = f"{settings.polls} polls" if pace else f"{ahead} ahead"
        found[f"{name}, {how}"] = lambda: of_path(lines(), settings, ahead, pace)

    for name, case in read_cases(path_adversary.WORST).items():
        add(name, partial(getattr, case, "lines"), case.settings, case.look_ahead)
    for name, lines in PATHS.items():
        for profile in PROFILES:
            settings = replace(SMOOTH, profile=profile)
            add(f"{name}, {profile}", lines, settings, LOOK_AHEAD)
            for polls in (100, 1000):
                add(f"{name}, {profile}", lines, replace(settings, polls=polls), LOOK_AHEAD, PACE)
    for chord, bend in ((0.02, 0.002), (0.05, 0.02), (0.005, 0.01), (0.2, 0.01)):
        for polls in (20, 50, 100):
            lines = partial(_behind, 300, chord, bend)
            name = f"chords of {chord} mm, turned by {bend}"
            add(name, lines, replace(SMOOTH, polls=polls), 8, LITTLE)
    for number, path in enumerate(wanderings(12, seed=3)):
        profile, tolerance = PROFILES[number % len(PROFILES)], Fraction(number % 3, 100)
        settings = replace(SMOOTH, profile=profile, tolerance=tolerance)
        add(f"wandering {number}", partial(tuple, path), settings, (LOOK_AHEAD, KNOWN)[number % 2])
    for number in range(MOVES):
        found[f"moves {number}"] = partial(of_moves, number)
    return found


def read() -> dict[str, Entry]:
    """The record as it was written."""
    return {name: Entry(*fields) for name, fields in json.loads(RECORD.read_text(encoding="utf-8")).items()}


def main() -> None:
    """Write it, and show what is not as before."""
    check_results(RECORD)
    before = read() if RECORD.exists() else {}
    now = {name: made() for name, made in entries().items()}
    rows = ",\n".join(
        f"  {json.dumps(name)}: {json.dumps([entry.clocks, entry.ramps, entry.sent])}"
        for name, entry in now.items()
    )
    write_text(RECORD, "{\n" + rows + "\n}\n")
    changed = [name for name in now if name in before and before[name] != now[name]]
    for name in changed[:SHOWN]:
        console.print(f"{name}: {before[name]} became {now[name]}", highlight=False, soft_wrap=True)
    new = len(now.keys() - before.keys())
    console.print(f"{len(now)} plans, {len(changed)} changed, {new} new", highlight=False)


if __name__ == "__main__":
    sys.exit(ended(main))
