# SPDX-License-Identifier: MIT
"""Judges in Python, which access a core through its pins: each mutant in a process of its own."""

import os
import random
import resource
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from passo.build import Parameters
from passo.console import Estimate
from passo.engine import Engine
from passo.failure import Failure

from verify.mutants.fates import Fates, hash_of
from verify.mutants.netlist import Core, Mutant

HANGS = 60  # seconds of the processor


@dataclass(frozen=True)
class Check:
    """What is played, and who sees it."""

    name: str
    judge: str  # as the page calls it
    # raises AssertionError if something is not as it is known to be
    play: Callable[[Engine, Parameters, random.Random], None]
    modules: tuple[str, ...] = ()  # whose mutants it tries; empty: all

    @cached_property
    def case(self) -> str:
        """As the fates name it: what other checks have not seen, these may see."""
        return f"{self.name} {hash_of([Path(self.play.__code__.co_filename)])}"

    def tries(self, mutant: Mutant) -> bool:
        """Whether the module takes part."""
        return not self.modules or mutant.module in self.modules


def broken(core: Core, library: Path, number: int, seed: str, check: Check) -> str:
    """What a mutant breaks; empty: nothing."""
    read, write = os.pipe()
    process = os.fork()
    if process == 0:
        os.close(read)
        resource.setrlimit(resource.RLIMIT_CPU, (HANGS, HANGS))
        os.write(write, _says(core, library, number, seed, check).encode()[:500])
        os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb") as pipe:
        says = pipe.read().decode()
    _, status = os.waitpid(process, 0)
    return says or ("it does not end" if status else "")


def _says(core: Core, library: Path, number: int, seed: str, check: Check) -> str:
    os.environ["PASSO_MUTANT"] = str(number)
    try:
        with Engine(library, core.parameters) as engine:
            check.play(engine, core.parameters, random.Random(seed))
    except AssertionError as failed:
        return (str(failed).splitlines() or [""])[0] or "not as it is known to be"
    except Exception as failed:  # a link that is broken
        return f"{type(failed).__name__}: {failed}"
    return ""


def judge(
    core: Core,
    mutants: Sequence[Mutant],
    fates: Fates,
    library: Path,
    seed: int,
    show: Callable[[str], None],
    check: Check,
) -> None:
    """Let a check judge the mutants that live.

    Raises:
        Failure: It finds fault with the core itself.
    """
    waiting = [m for m in mutants if check.tries(m) and fates.get(m.name).waits(check.case)]
    # in this process: what is measured on the core itself is measured once
    if waiting and (says := _says(core, library, 0, str(seed), check)):
        raise Failure(f"{check.name}: fault with the core itself: {says}")
    estimate = Estimate(len(waiting))
    for number, mutant in enumerate(waiting, 1):
        fate = fates.get(mutant.name)
        says = broken(core, library, mutant.number, str(seed), check)
        fate.tried = [*(fate.tried or []), check.case]
        if says:
            fate.killed, fate.says = check.judge, says
        if number % 10 == 0 or number == len(waiting):
            fates.save()
            living = sum(fates.get(one.name).lives for one in waiting[:number])
            show(f"{core.name}: {check.name}: {estimate.counted(number)}; {living} live")
