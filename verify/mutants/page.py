# SPDX-License-Identifier: MIT
"""The score of every module and file; docs/reference/mutants.md, and modules.md, which quotes it."""

import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from passo.console import console, table
from passo.output import write_text
from passo.toolchain import paths

from verify import page as modules_page
from verify.mutants.c_equal import NAME as OBJECT_CODE
from verify.mutants.c_judge import RECORD
from verify.mutants.c_source import FOLDERS, CMutant
from verify.mutants.fates import Fates
from verify.mutants.netlist import Mutant

PAGE = paths.reference / "mutants.md"
REASONS = Path(__file__).parent / "reasons.toml"
NO_REASON = "no property covers it yet"
JUDGES = ("pins", "motions", "frames", "registers", "proofs")  # of the RTL
C_JUDGES = ("tests", "record")  # of C: the record only sees that a plan has changed


@dataclass
class Score:
    """Of a module or a file."""

    module: str
    made: int = 0
    killed: dict[str, int] = field(default_factory=dict)  # by judge
    equal: int = 0
    waiting: int = 0  # not played yet
    living: list[tuple[str, str]] = field(default_factory=list)  # the mutant, and the reason, where known

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

    @property
    def live(self) -> int:
        """Of the faults."""
        return self.faults - self.dead


def _judge_of(killed: str) -> str:
    if killed in JUDGES:
        return killed
    if killed.startswith("proof"):
        return "proofs"
    if RECORD in killed:
        return "record"
    return "tests" if ".py" in killed or "ends with" in killed else "pins"


def _reasons() -> list[tuple[re.Pattern[str], str, bool]]:
    """Why mutants live, by pattern; and whether that makes them no fault."""
    found = tomllib.loads(REASONS.read_text(encoding="utf-8")).get("reason", [])
    return [(re.compile(one["mutant"]), one["says"], one.get("equal", False)) for one in found]


def _shown(mutant: Mutant | CMutant) -> str:
    if isinstance(mutant, CMutant):
        return f"{mutant.name}: {mutant.says}"
    return f"`{mutant.name}`, {mutant.source.split(', ')[-1]}"


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
        elif all(case.startswith(OBJECT_CODE) for case in fate.tried or []):
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
            counts = (score.made, score.dead, score.equal, score.live)
            made.add_row(score.module, *map(str, counts), score.shown)
        console.print(made)


ENDS = ("no fault", "not played", "live", "score")


def _table(head: str, judges: Sequence[str], all_scores: Sequence[Score]) -> str:
    """The scores by judge."""
    lines = [f"| {' | '.join((head, 'mutants', *judges, *ENDS))} |"]
    lines.append("|---|" + "---:|" * (1 + len(judges) + len(ENDS)))
    for score in all_scores:
        by = (score.killed.get(judge, 0) for judge in judges)
        numbers = (score.made, *by, score.equal, score.waiting, score.live)
        lines.append(f"| `{score.module}` | {' | '.join(map(str, numbers))} | {score.shown} |")
    return "\n".join(lines)


def _read(text: str, judges: Sequence[str]) -> dict[str, Score]:
    """The rows of such a table and the survivors with their reasons, from a part of the page."""
    found: dict[str, Score] = {}
    for name, numbers in re.findall(r"^\| `(\w+(?:\.c)?)` \| (.*) \|", text, re.M):
        made, *by, equal, waiting, _ = (int(number) for number in numbers.split(" | ")[:-1])
        found[name] = Score(name, made, dict(zip(judges, by, strict=True)), equal, waiting)
    reason = ""
    for line in text.splitlines():
        if heading := re.fullmatch(r"(.*) \(\d+\):", line):
            reason = heading[1][0].lower() + heading[1][1:]
        elif (item := re.match(r"\* `?(\w+(?:\.c)?)\b", line)) and item[1] in found:
            found[item[1]].living.append((line[2:].replace("&lt;", "<").replace("\\|", "|"), reason))
    return found


def _kept(new: Sequence[Score], old: dict[str, Score]) -> list[Score]:
    """The rows, with those of the page where more mutants have been played, or no others are known."""
    known = {score.module: score for score in new}
    for name, row in old.items():
        if name in known and row.waiting >= known[name].waiting:
            continue
        if name in known or _exists(name):
            known[name] = row
    return sorted(known.values(), key=lambda score: score.module)


def _exists(module: str) -> bool:
    """Whether there still is such a source."""
    places = [folder / module for folder in FOLDERS.values()] + [paths.rtl / f"{module}.v"]
    return any(place.exists() for place in places)


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


BEGIN, END = "<!-- figures: written by make verify -->\n", "<!-- end of figures -->\n"


def write(rtl: Sequence[Score], c: Sequence[Score], seed: int) -> None:
    """Put the figures between the marks of the page; rows of what has not been played stay.

    The page of modules quotes the scores, so it is written too.
    """
    head, rest = PAGE.read_text(encoding="utf-8").split(BEGIN)
    old, tail = rest.split(END)
    rows, _, survivors = old.partition("## Survivors")
    of_rtl, _, of_c = rows.partition("### C\n")
    living_rtl, _, living_c = survivors.partition("### Of C\n")
    rtl = _kept(_merged(rtl), _read(of_rtl + living_rtl, JUDGES))
    c = _kept(_merged(c), _read(of_c + living_c, C_JUDGES))
    write_text(PAGE, head + BEGIN + _figures(rtl, c, seed) + END + tail)
    modules_page.write()


def _figures(rtl: Sequence[Score], c: Sequence[Score], seed: int) -> str:
    def of(score: Score) -> str:
        waits = f", {score.waiting} not played yet" if score.waiting else ""
        equal = f"{score.equal} more are equivalent"
        return f"{score.dead:,} of {score.faults:,} ({score.share:.1%}; {equal}{waits})"

    by_record = sum(score.killed.get("record", 0) for score in c)
    unlisted = sum(score.live - len(score.living) for score in (*rtl, *c))
    note = f"\n{unlisted} older survivors are not listed.\n" if unlisted else ""
    return f"""
Seed {seed}. Mutants killed in the RTL: {of(total(rtl))}; in the C sources:
{of(total(c))}, {by_record} of them only by the record of plans.

### RTL

{_table("module", JUDGES, rtl)}

### C

{_table("file", C_JUDGES, c)}

## Survivors
{note}
### Of the RTL
{_living(rtl)}

### Of C
{_living(c)}
"""
