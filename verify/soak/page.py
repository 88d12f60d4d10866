# SPDX-License-Identifier: MIT
"""docs/reference/soak.md: the figures of each group of parts that has been played in full."""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from passo.output import write_text
from passo.toolchain import paths

from verify.soak.defects import Catch
from verify.soak.parts import Part
from verify.soak.report import MACHINE_JUDGED

PAGE = paths.reference / "soak.md"
CORE = {
    "model": "model",
    "driver": "driver, model",
    "driver on verilator": "driver, Verilator",
    "verilator": "Verilator",
    "icarus": "Icarus",
}
ON_MODEL = ("machine", "tries", "starts", "pokes")
OTHERS = ("machine on verilator", "machine on icarus")
DRIVER = ("endings", "sessions")
TRACKERS = ("trackers", "trackers on verilator")
Played = dict[str, Part]


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [f"| {' | '.join(head)} |", "|---|" + "---:|" * (len(head) - 1)]
    return "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)]) + "\n"


def _number(value: int) -> str:
    return f"{value:,}" if value else ""


def _sum(played: Played, names: Iterable[str]) -> Counter[str]:
    return sum((played[name].counts for name in names), Counter())


def _core(played: Played) -> str:
    columns = ("frames", "aimed", "steps", "stops", "aborts", "quiets")
    head = ("part", "scenarios", "clocks", "frames", "targeted", "steps", "stops", "aborts", "quiet reports")
    rows = []
    for name, shown in CORE.items():
        counts = played[name].counts
        numbers = (_number(counts[column]) for column in columns)
        rows.append((shown, _number(counts["histories"]), f"{counts['clocks'] / 1e6:,.0f} M", *numbers))
    both = _sum(played, CORE)
    return f"""{_table(head, rows)}
{both["hit"] / both["aimed"]:.0%} of the targeted disturbances hit their exact clock. The driver's links had
{both["flips"]:,} wrong bits, {both["lost clocks"]:,} lost and {both["doubled clocks"]:,} doubled clocks,
{both["cuts"]:,} truncated frames and {both["deaths"]:,} failures; the driver repeated {both["retries"]:,}
frames.
"""


def _machine(played: Played) -> str:
    model = _sum(played, ON_MODEL)
    counts = (model, *(played[name].counts for name in OTHERS))
    shown = [f"{played[name].counts['histories']:,} of `{name}`" for name in ON_MODEL]
    judged = {"steps": "steps", **MACHINE_JUDGED}
    rows = [(text, *(_number(one[key]) for one in counts)) for key, text in judged.items()]
    return f"""Scenarios on the model: {", ".join(shown)}, of {model["clocks"] / 1e9:.1f} G clocks;
on Verilator and on Icarus {counts[1]["histories"]:,} of `machine` each.

{_table(("checked", "model", "Verilator", "Icarus"), rows)}"""


def _driver(played: Played) -> str:
    by: dict[str, Counter[str]] = {}
    for part in DRIVER:
        for name, count in played[part].counts.items():
            operation, colon, ending = name.partition(":")
            if colon:
                by.setdefault(operation, Counter())[ending] += count
    endings = sorted({ending for of in by.values() for ending in of} - {"death"})
    rows = [
        (operation, *(_number(of[ending]) for ending in (*endings, "death"))) for operation, of in by.items()
    ]
    ended, died = (played[part].counts["histories"] for part in DRIVER)
    return f"""Of operations of the driver {ended:,} end early, and {died:,} hosts fail, with filters, holds
and stops of milliseconds:

{_table(("operation", *endings, "host fails"), rows)}"""


def _trackers(played: Played) -> str:
    counts = [played[name].counts for name in TRACKERS]
    kinds = sorted({name for one in counts for name in one if name.startswith("both:")})
    rows = [(name.removeprefix("both:"), *(_number(one[name]) for one in counts)) for name in kinds]
    made = (("scenarios", "histories"), ("M clocks", "clocks"), ("steps", "steps"))
    whole = [
        (shown, *(_number(one[name] // (10**6 if name == "clocks" else 1)) for one in counts))
        for shown, name in made
    ]
    return _table(("trackers", "model", "Verilator"), [*whole, *rows])


def _sections() -> dict[str, tuple[Sequence[str], Callable[[Played], str]]]:
    """The parts that each needs."""
    return {
        "core": (tuple(CORE), _core),
        "machine": ((*ON_MODEL, *OTHERS), _machine),
        "driver": (DRIVER, _driver),
        "trackers": (TRACKERS, _trackers),
    }


def _numbers(numbers: dict[str, Any]) -> str:
    thread, laser, raster = numbers["thread"], numbers["laser"], numbers["raster"]
    rows = (
        (
            f"thread of {thread['turns']:,} turns, {thread['steps']:,} steps",
            "1 count from the exact pitch, the same phase in every pass",
            f"{thread['worst_counts']:.2f} counts, the same phase",
        ),
        ("energy per step, 5 % to 100 %, holds", "1 %", f"{laser['worst'] * 100:.2f} %"),
        (f"{raster['values']:,} raster values", "on their substep", "all of them"),
    )
    return _table(("figure", "bound", "measured"), rows)


def _defects(caught: Sequence[Catch]) -> str:
    rows = []
    for one in caught:
        kind = f" (kind `{one.defect.kind}`)" if one.defect.kind else ""
        rows.append((one.defect.name + kind, f"{one.history + 1:,}"))
    return _table(("defect", "scenarios"), rows)


def mark(section: str, figures: str) -> str:
    """Figures between the marks of a section."""
    return f"<!-- {section}: written by make verify -->\n{figures}<!-- end of {section} -->\n"


def _put(text: str, section: str, figures: str) -> str:
    """The page with other figures in a section."""
    begin, end = mark(section, "\0").split("\0")
    head, rest = text.split(begin)
    return head + mark(section, figures) + rest.split(end)[1]


def write(
    wanted: dict[str, int], parts: Sequence[Part], caught: Sequence[Catch], numbers: dict[str, Any]
) -> list[str]:
    """Write the sections whose parts have been played, `wanted` histories of each, none of which failed.

    The others stay. Returns the names of those that were written.
    """
    played = {
        part.name: part
        for part in parts
        if not part.failures and part.counts["histories"] >= wanted[part.name]
    }
    sections = _sections().items()
    made = {name: make(played) for name, (needs, make) in sections if set(needs) <= played.keys()}
    if numbers and all(one["ok"] for one in numbers.values()):
        made["numbers"] = _numbers(numbers)
    if caught and all(one.good for one in caught):
        made["defects"] = _defects(caught)
    text = PAGE.read_text(encoding="utf-8")
    for name, figures in made.items():
        text = _put(text, name, figures)
    if made:
        write_text(PAGE, text)
    return list(made)
