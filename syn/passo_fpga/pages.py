# SPDX-License-Identifier: MIT
"""Output of the report: tables for the terminal, docs/reference/report.md, and the goals in README.md."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from passo.console import console, table
from passo.output import write_text
from passo.toolchain import paths
from rich.console import Console

from passo_fpga.devices import DEVICES

PAGE = paths.reference / "report.md"
TEMPLATE = Path(__file__).with_name("page.md")
README = paths.root / "README.md"
BEGIN, END = "<!-- report: make report writes from here -->", "<!-- to here -->"
BOARDS = "<!-- boards: make report BOARDS=1 writes from here -->", "<!-- to here: boards -->"
WIDTH = 118  # of the tables without a terminal
NONE = "–"

Row = dict[str, Any]


def write(report: dict[str, Any]) -> None:
    """Write the page, and the goals in README.md."""
    template = TEMPLATE.read_text(encoding="utf-8")
    parts = {
        "goals": markdown(*_goals(report)),
        "boards": block_of(PAGE, *BOARDS),
        "devices": "\n\n".join(_device(report, name) for name in DEVICES),
        "tops": markdown(*_tops(report)),
        "split": "\n\n".join(
            f"### {DEVICES[name].title}\n\n{_modules(rows)}" for name, rows in report["split"].items()
        ),
        "channel": _modules(report["channel"]),
        "channel_device": DEVICES[report["channel_device"]].title,
        "split_size": "{} channel, {} axes".format(*report["split_size"]),
        "by_seed": "\n".join(f"* {line}" for line in _by_seed(report)),
        "seeds": str(len(report["seeds"])),
        "goal_seeds": str(len(report["goal_seeds"])),
        "tools": ", ".join(
            dict.fromkeys(
                " ".join(pair)
                for words in (tools.split() for tools in report["tools"].values())
                for pair in zip(words[::2], words[1::2], strict=True)
            )
        ),
    }
    write_text(PAGE, template.format(**parts))
    write_goals(report)


def write_goals(report: dict[str, Any]) -> None:
    """Write the goals in README.md."""
    write_block(README, markdown(*_goals(report)))


def show(report: dict[str, Any]) -> None:
    """Print the tables."""
    screen = console if console.is_terminal else Console(width=WIDTH)
    header, rows = _goals(report)
    shown = table("goals", *header)
    for row in rows:
        shown.add_row(*row)
    screen.print(shown)
    for name in report["tools"]:
        header, rows = _sizes(report, name)
        shown = table(f"\n{DEVICES[name].title}", *header)
        for row in rows:
            shown.add_row(*row)
        screen.print(shown)


def block_of(page: Path, begin: str = BEGIN, end: str = END) -> str:
    """What a page has between the marks; nothing if it lacks them."""
    text = page.read_text(encoding="utf-8") if page.exists() else ""
    return text.partition(begin)[2].partition(end)[0].strip("\n")


def write_block(page: Path, block: str, begin: str = BEGIN, end: str = END) -> None:
    """Replace what a page has between the marks.

    Raises:
        ValueError: The page lacks them.
    """
    text = page.read_text(encoding="utf-8")
    before, _, rest = text.partition(begin)
    _, _, after = rest.partition(end)
    if not rest or end not in rest:
        raise ValueError(f"{page.name} lacks the marks '{begin}' and '{end}'")
    write_text(page, f"{before}{begin}\n{block}\n{end}{after}")


def markdown(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of Markdown, its numbers on the right."""
    rule = ["---", *["---:"] * (len(header) - 1)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (header, rule, *rows))


def _find(report: dict[str, Any], device: str, channels: int, axes: int, parts: Sequence[str] = ()) -> Row:
    wanted = (device, channels, axes, list(parts))
    (found,) = [
        row
        for row in report["designs"]
        if (row["device"], row["channels"], row["axes"], row["parts"]) == wanted
    ]
    return found


def _of_goal(report: dict[str, Any], goal: Row) -> Row:
    return _find(report, goal["device"], 1, goal["axes"], goal["parts"])


def mhz(value: float | None) -> str:
    """A clock, or a dash for none."""
    return NONE if value is None else f"{value:.1f}"


def _size(row: Row) -> str:
    return f"{row['size']:,} ({row['size'] / row['capacity']:.0%})"


def _goals(report: dict[str, Any]) -> tuple[Sequence[str], list[list[str]]]:
    header = ("FPGA", "axes", "blocks", "median MHz", "goal", "lowest MHz", "goal", "size", "goal", "BRAM")
    rows = []
    for goal in report["goals"]:
        device, row = DEVICES[goal["device"]], _of_goal(report, goal)
        unit = device.family.size_unit
        limits = [("f_max_median", "median_mhz"), ("f_max_minimum", "minimum_mhz")]
        met = row["fits"] and all(row[reached] >= goal[wanted] for reached, wanted in limits)
        rows.append(
            [
                device.title,
                str(goal["axes"]),
                ", ".join(goal["parts"]) or NONE,
                mhz(row["f_max_median"]) if row["fits"] else "does not fit",
                str(goal["median_mhz"] or NONE),
                mhz(row["f_max_minimum"]),
                str(goal["minimum_mhz"] or NONE),
                f"{row['size']:,} {unit}",
                f"{goal['size']:,} {unit}",
                str(row["bram"]),
                "yes" if met and row["size"] <= goal["size"] else "no",
            ]
        )
    return (*header, "all met"), rows


def _by_seed(report: dict[str, Any]) -> list[str]:
    """The speeds of the designs with goals, by seed."""
    found = []
    for goal in report["goals"]:
        what = ", ".join((f"{DEVICES[goal['device']].title}, {goal['axes']} axes", *goal["parts"]))
        found.append(f"{what}: {', '.join(map(mhz, _of_goal(report, goal)['f_max'])) or NONE}")
    return found


def _sizes(report: dict[str, Any], name: str) -> tuple[Sequence[str], list[list[str]]]:
    unit = DEVICES[name].family.size_unit
    placed = f"{unit} placed" if DEVICES[name].family.place else unit
    header = ("channels x axes", placed, "LUT", "FF", "BRAM", "DSP", "lowest MHz", "median MHz")
    rows = []
    for row in sorted(
        (row for row in report["designs"] if row["device"] == name and not row["parts"]),
        key=lambda row: (row["channels"], row["axes"]),
    ):
        speed = [mhz(row["f_max_minimum"]), mhz(row["f_max_median"])]
        rows.append(
            [
                f"{row['channels']} x {row['axes']}",
                _size(row),
                f"{row['lut']:,}",
                f"{row['ff']:,}",
                str(row["bram"]),
                str(row["dsp"]),
                *(speed if row["fits"] else ["does not fit", NONE]),
            ]
        )
    return header, rows


def _device(report: dict[str, Any], name: str) -> str:
    sizes = markdown(*_sizes(report, name))
    return f"### {DEVICES[name].title}\n\n{sizes}\n\nIncremental cost: {_costs(report, name)}."


def _costs(report: dict[str, Any], name: str) -> str:
    """Cost of a further axis and of a further channel."""
    unit = DEVICES[name].family.size_unit
    one, eight = (_find(report, name, 1, axes) for axes in (1, 8))
    four = _find(report, name, 4, 1)
    return f"axis {_cost(one, eight, 7, unit)}; channel of one axis {_cost(one, four, 3, unit)}"


def _cost(small: Row, large: Row, steps: int, unit: str) -> str:
    def of(column: str) -> float:
        return (large[column] - small[column]) / steps

    return f"{of('size'):.0f} {unit}, {of('ff'):.0f} FF, {of('bram'):.3g} BRAM"


def _tops(report: dict[str, Any]) -> tuple[Sequence[str], list[list[str]]]:
    header = ("FPGA", "top", "size", "lowest MHz", "median MHz")
    rows = [
        [
            DEVICES[row["device"]].title,
            f"`{row['top']}`",
            f"{row['size']:,} {DEVICES[row['device']].family.size_unit}",
            mhz(row["f_max_minimum"]),
            mhz(row["f_max_median"]),
        ]
        for row in sorted(report["tops"], key=lambda row: list(DEVICES).index(row["device"]))
    ]
    return header, rows


def _modules(modules: Sequence[Row]) -> str:
    columns = ("instances", "LUT", "FF", "carry", "BRAM")
    rows = [[f"`{row['module']}`", *(f"{row[column]:,}" for column in columns)] for row in modules]
    total = [f"{sum(row[column] for row in modules):,}" for column in columns[1:]]
    return markdown(("module", *columns), [*rows, ["all", "", *total]])
