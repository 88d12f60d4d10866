# SPDX-License-Identifier: MIT
"""The score of every module and file, and docs/reference/mutants.md."""

import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from passo.console import console, table
from passo.output import write_text
from passo.toolchain import paths

from verify.mutants.c_source import CMutant
from verify.mutants.fates import Fates
from verify.mutants.netlist import Mutant

PAGE = paths.reference / "mutants.md"
REASONS = Path(__file__).parent / "reasons.toml"
NO_REASON = "no property covers it yet"
JUDGES = ("pins", "motions", "frames", "registers", "proofs")  # of the RTL


@dataclass
class Score:
    """Of a module or a file."""

    module: str
    made: int = 0
    killed: dict[str, int] = field(default_factory=dict)  # by judge
    equal: int = 0
    waiting: int = 0  # not played yet
    living: list[tuple[str, str]] = field(default_factory=list)  # the mutant, and the reason

    @property
    def dead(self) -> int:
        """Killed by any judge."""
        return sum(self.killed.values())

    @property
    def share(self) -> float:
        """Of the faults that have been played."""
        return self.dead / max(1, self.faults)

    @property
    def shown(self) -> str:
        """The share as text."""
        return f"{self.share:.0%}" if self.faults else ""

    @property
    def faults(self) -> int:
        """Those that have been played, and are not equal."""
        return self.made - self.equal - self.waiting


def _judge_of(killed: str) -> str:
    if killed in JUDGES:
        return killed
    if killed.startswith("proof"):
        return "proofs"
    return "tests" if ".py" in killed or "ends with" in killed else "pins"


def _reasons() -> list[tuple[re.Pattern[str], str, bool]]:
    """Why mutants live, by pattern; and whether that makes them no fault."""
    found = tomllib.loads(REASONS.read_text(encoding="utf-8")).get("reason", [])
    return [(re.compile(one["mutant"]), one["says"], one.get("equal", False)) for one in found]


def _shown(mutant: Mutant | CMutant) -> str:
    if isinstance(mutant, CMutant):
        return f"{mutant.name}: {mutant.says}"
    return f"{mutant.name}, {mutant.source.split(', ')[-1]}"


def scores(mutants: Sequence[Mutant | CMutant], fates: Fates) -> list[Score]:
    """The scores of all modules."""
    reasons = _reasons()
    found: dict[str, Score] = {}
    for mutant in mutants:
        score = found.setdefault(mutant.module, Score(mutant.module))
        fate = fates.get(mutant.name)
        score.made += 1
        why = next(((says, equal) for name, says, equal in reasons if name.search(mutant.name)), ("", False))
        if fate.killed:
            judge = _judge_of(fate.killed)
            score.killed[judge] = score.killed.get(judge, 0) + 1
        elif fate.equal or why[1]:
            score.equal += 1
        elif not fate.tried:
            score.waiting += 1
        else:
            score.living.append((_shown(mutant), why[0] or NO_REASON))
    return list(found.values())


def _merged(all_scores: Sequence[Score]) -> list[Score]:
    """A module that is in two cores has one score."""
    found: dict[str, Score] = {}
    for one in all_scores:
        score = found.setdefault(one.module, Score(one.module))
        score.made += one.made
        score.equal += one.equal
        score.waiting += one.waiting
        score.living += one.living
        for judge, count in one.killed.items():
            score.killed[judge] = score.killed.get(judge, 0) + count
    return sorted(found.values(), key=lambda score: score.module)


def total(all_scores: Sequence[Score]) -> Score:
    """All together."""
    return Score(
        "all",
        sum(score.made for score in all_scores),
        {"all": sum(score.dead for score in all_scores)},
        sum(score.equal for score in all_scores),
        sum(score.waiting for score in all_scores),
    )


def show_table(rtl: Sequence[Score], c: Sequence[Score]) -> None:
    """Print the scores."""
    for title, all_scores in (("Mutants of the RTL", _merged(rtl)), ("Mutants of C", _merged(c))):
        if not all_scores:
            continue
        made = table(title, "module", "mutants", "killed", "no faults", "live", "score")
        for score in [*all_scores, total(all_scores)]:
            live = score.faults - score.dead
            made.add_row(
                *(score.module, str(score.made), str(score.dead), str(score.equal)),
                *(str(live), score.shown),
            )
        console.print(made)


def _rtl_table(all_scores: Sequence[Score]) -> str:
    lines = [f"| module | mutants | {' | '.join(JUDGES)} | no fault | not played | live | score |"]
    lines.append("|---|" + "---:|" * (len(JUDGES) + 5))
    for score in all_scores:
        by = " | ".join(str(score.killed.get(judge, 0)) for judge in JUDGES)
        ends = f"{score.equal} | {score.waiting} | {len(score.living)} | {score.shown}"
        lines.append(f"| `{score.module}` | {score.made} | {by} | {ends} |")
    return "\n".join(lines)


def _c_table(all_scores: Sequence[Score]) -> str:
    lines = ["| file | mutants | killed | no fault | not played | live | score |", "|---|" + "---:|" * 6]
    for score in all_scores:
        counts = f"{score.made} | {score.dead} | {score.equal} | {score.waiting} | {len(score.living)}"
        lines.append(f"| `{score.module}` | {counts} | {score.shown} |")
    return "\n".join(lines)


def _living(all_scores: Sequence[Score]) -> str:
    """The survivors by reason."""
    by_reason: dict[str, list[str]] = {}
    for score in all_scores:
        for mutant, reason in score.living:
            by_reason.setdefault(reason, []).append(mutant)
    parts = []
    for reason, mutants in sorted(by_reason.items()):
        parts.append(f"\n{reason[0].upper()}{reason[1:]} ({len(mutants)}):\n")
        parts += [f"* {mutant.replace('|', chr(92) + '|').replace('<', '&lt;')}" for mutant in mutants]
    return "\n".join(parts)


NOT_ENDED = """
This run has not finished: not every checker has tried every mutant, so a mutant that is alive here may still
be killed."""


def write(rtl: Sequence[Score], c: Sequence[Score], seed: int, ended: bool = True) -> None:
    """Put the figures between the marks of the page; survivors are listed when all judges have played."""
    rtl, c = _merged(rtl), _merged(c)
    all_rtl, all_c = total(rtl), total(c)
    text = PAGE.read_text(encoding="utf-8")
    begin, end = "<!-- figures: written by make verify -->\n", "<!-- end of figures -->\n"
    head, rest = text.split(begin)
    tail = rest.split(end)[1]

    def of(score: Score) -> str:
        waits = f", {score.waiting} not played yet" if score.waiting else ""
        equal = f"{score.equal} more are equivalent"
        return f"{score.dead:,} of {score.faults:,} ({score.share:.1%}; {equal}{waits})"

    survivors = f"""
## Survivors

### Of the RTL
{_living(rtl)}

### Of C
{_living(c)}
"""

    figures = f"""
Seed {seed}. Mutants killed in the RTL: {of(all_rtl)}; in the C sources:
{of(all_c)}.

### RTL

{_rtl_table(rtl)}

### C

{_c_table(c)}

"""
    figures += survivors if ended else NOT_ENDED + "\n"
    write_text(PAGE, head + begin + figures + end + tail)
