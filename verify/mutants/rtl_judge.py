# SPDX-License-Identifier: MIT
"""The judge at the pins: histories of the soak on a core with mutants, without the model beside it."""

import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from passo.failure import Failure
from passo.toolchain import environment

from verify.mutants.fates import Fate, Fates
from verify.mutants.netlist import PLAIN, SET, Core, Mutant
from verify.soak.parts import SETS


@dataclass(frozen=True)
class Round:
    """Histories that the living play, of the kinds of soak; empty: of the core of two channels."""

    kind: str
    first: int
    count: int

    @property
    def name(self) -> str:
        """With its numbers."""
        return f"{self.kind or 'plain'} {self.first}+{self.count}"


# Most mutants die in the first history.
ROUNDS = {
    "plain": (Round("", 0, 1), Round("", 1, 3), Round("", 4, 16), Round("", 20, 30)),
    "machine": (
        *(Round("machine", 0, 1), Round("machine", 1, 4), Round("tries", 0, 2), Round("pokes", 0, 2)),
        *(Round("machine", 5, 25), Round("tries", 2, 4), Round("machine", 30, 50), Round("tries", 6, 8)),
    ),
}


# Histories in which the judge finds fault with the core itself: no mutant plays them; the run is not good.
unfair: list[str] = []


def play(
    program: Path, library: Path, rounds: Round, numbers: Sequence[int], seed: int
) -> dict[int, tuple[int, str]]:
    """Play histories with mutants; the history that kills one, and what it breaks.

    Raises:
        Failure: The program fails.
    """
    kind = [f"--{rounds.kind}"] if rounds.kind else ["--set", str(SET)]
    first = rounds.first if rounds.kind else rounds.first * len(SETS)
    command = [program, str(seed), str(first), str(rounds.count), *kind, "--rtl", library, "--mutants"]
    done = subprocess.run(
        [*map(str, command)],
        input=" ".join(map(str, numbers)),
        env=environment(),
        capture_output=True,
        text=True,
    )
    if done.returncode not in (0, 1):
        raise Failure(f"{' '.join(map(str, command))}: exit status {done.returncode}: {done.stderr[-500:]}")
    killed = {}
    for line in done.stdout.splitlines():
        if line.startswith("killed "):
            _, number, history, _, says = line.split(" ", 4)
            killed[int(number)] = (int(history), says)
    if 0 in killed:
        unfair.append(f"{rounds.kind or 'plain'} {killed[0][0]}: {killed.pop(0)[1]}")
    return killed


def judge(
    core: Core,
    mutants: Sequence[Mutant],
    fates: Fates,
    program: Path,
    library: Path,
    seed: int,
    show: Callable[[str], None],
    rounds: Sequence[Round],
    chunk: int = 30,
) -> None:
    """Let the mutants that live play some rounds."""

    def record(name: str, numbers: Sequence[Mutant], rounds: Round) -> None:
        killed = play(program, library, rounds, [0, *(mutant.number for mutant in numbers)], seed)
        for mutant in numbers:
            fate = fates.get(mutant.name)
            fate.tried = [*(fate.tried or []), name]
            if mutant.number in killed:
                history, says = killed[mutant.number]
                fate.killed, fate.says = f"{rounds.kind or 'plain'} {history}", says
        fates.save()

    if fates.other:
        again(core, mutants, fates, program, library, seed, show)
    for played in rounds:
        waiting = [
            mutant
            for mutant in mutants
            if fates.get(mutant.name).lives and played.name not in (fates.get(mutant.name).tried or [])
        ]
        for begin in range(0, len(waiting), chunk):
            record(played.name, waiting[begin : begin + chunk], played)
            living = sum(fates.get(mutant.name).lives for mutant in mutants)
            show(f"{core.name}: {played.name}: {living} of {len(mutants)} live")


def again(
    core: Core,
    mutants: Sequence[Mutant],
    fates: Fates,
    program: Path,
    library: Path,
    seed: int,
    show: Callable[[str], None],
) -> None:
    """Other judges: what was killed must be killed in the same history once more."""
    by_case: dict[str, list[Mutant]] = {}
    for mutant in mutants:
        fate: Fate = fates.get(mutant.name)
        kind, _, history = fate.killed.partition(" ")
        if kind in ("plain", "machine", "tries", "pokes"):
            by_case.setdefault(f"{kind} {history}", []).append(mutant)
    for case, killed in by_case.items():
        kind, _, history = case.partition(" ")
        rounds = Round(
            "" if kind == "plain" else kind, int(history) // (len(SETS) if core is PLAIN else 1), 1
        )
        found = play(program, library, rounds, [0, *(mutant.number for mutant in killed)], seed)
        for mutant in killed:
            fate = fates.get(mutant.name)
            if mutant.number in found:
                fate.says = found[mutant.number][1]
            else:
                fate.killed = fate.says = ""
    fates.other = False
    fates.save()
    show(f"{core.name}: {sum(map(len, by_case.values()))} kills played again")
