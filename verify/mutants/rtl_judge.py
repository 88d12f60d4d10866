# SPDX-License-Identifier: MIT
"""The judge at the pins: histories of the soak on a core with mutants, without the model beside it."""

import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from passo.failure import Failure
from passo.toolchain import environment

from verify.mutants.fates import Fates
from verify.mutants.netlist import SET, Core, Mutant
from verify.soak.parts import SETS
from verify.soak.program import KINDS


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


# Most mutants die in the first history; before the second the proofs judge, before the third the registers.
ROUNDS = {
    "plain": ((Round("", 0, 1),), (Round("", 1, 3),), (Round("", 4, 12),)),
    "machine": (
        (Round("machine", 0, 1),),
        (Round("machine", 1, 3), Round("pokes", 0, 1)),
        (Round("machine", 4, 20), Round("tries", 0, 3), Round("pokes", 1, 3)),
    ),
}
NONE: tuple[tuple[Round, ...], ...] = ((), (), ())  # of a core that the soak does not have
CHUNK = 30  # mutants of one process


# Histories in which the judge finds fault with the core itself: no mutant plays them; the run is not good.
unfair: list[str] = []


@dataclass(frozen=True)
class Pins:
    """The program of the soak, with the mutants of a core."""

    core: Core
    mutants: Sequence[Mutant]
    fates: Fates
    program: Path
    library: Path
    seed: int
    show: Callable[[str], None]

    def judge(self, rounds: Sequence[Round]) -> None:
        """Let the mutants that live play some rounds."""
        if self.fates.other:
            self._again()
        for played in rounds:
            waiting = [mutant for mutant in self.mutants if self.fates.get(mutant.name).waits(played.name)]
            for begin in range(0, len(waiting), CHUNK):
                chunk = waiting[begin : begin + CHUNK]
                killed = self._play(chunk, played)
                for mutant in chunk:
                    fate = self.fates.get(mutant.name)
                    fate.tried = [*(fate.tried or []), played.name]
                    if mutant.number in killed:
                        history, says = killed[mutant.number]
                        fate.killed, fate.says = f"{played.kind or 'plain'} {history}", says
                self.fates.save()
            if waiting:
                living = sum(self.fates.get(mutant.name).lives for mutant in self.mutants)
                self.show(f"{self.core.name}: {played.name}: {living} of {len(self.mutants)} live")

    def _again(self) -> None:
        """Other judges: what was killed must be killed in the same history once more."""
        by_case: dict[str, list[Mutant]] = {}
        for mutant in self.mutants:
            case = self.fates.get(mutant.name).killed
            if case.partition(" ")[0] in ("plain", *KINDS):
                by_case.setdefault(case, []).append(mutant)
        for case, killed in by_case.items():
            kind, _, history = case.partition(" ")
            plain = kind == "plain"
            found = self._play(
                killed, Round("" if plain else kind, int(history) // (len(SETS) if plain else 1), 1)
            )
            for mutant in killed:
                fate = self.fates.get(mutant.name)
                if mutant.number in found:
                    fate.says = found[mutant.number][1]
                else:
                    fate.killed = fate.says = ""
        self.fates.other = False
        self.fates.save()
        self.show(f"{self.core.name}: {sum(map(len, by_case.values()))} kills played again")

    def _play(self, mutants: Sequence[Mutant], rounds: Round) -> dict[int, tuple[int, str]]:
        """Play histories with mutants; the history that kills one, and what it breaks.

        Raises:
            Failure: The program fails.
        """
        kind = [f"--{rounds.kind}"] if rounds.kind else ["--set", str(SET)]
        first = rounds.first if rounds.kind else rounds.first * len(SETS)
        histories = [str(self.seed), str(first), str(rounds.count), *kind]
        command = [self.program, *histories, "--rtl", self.library, "--mutants"]
        done = subprocess.run(
            [*map(str, command)],
            input=" ".join(["0", *(str(mutant.number) for mutant in mutants)]),
            env=environment(),
            capture_output=True,
            text=True,
        )
        if done.returncode not in (0, 1):
            said = f"exit status {done.returncode}: {done.stderr[-500:]}"
            raise Failure(f"{' '.join(map(str, command))}: {said}")
        killed = {}
        for line in done.stdout.splitlines():
            if line.startswith("killed "):
                _, number, history, _, says = line.split(" ", 4)
                killed[int(number)] = (int(history), says)
        if 0 in killed:
            unfair.append(f"{rounds.kind or 'plain'} {killed[0][0]}: {killed.pop(0)[1]}")
        return killed
