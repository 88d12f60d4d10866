# SPDX-License-Identifier: MIT
"""Histories on the model, through the driver, on Verilator and on Icarus Verilog."""

import re
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

from passo.build import Parameters, model_library, rtl_library
from passo.cache import hash_of
from passo.compiler import call, includes
from passo.console import Estimate
from passo.console import console as terminal
from passo.toolchain import paths
from rich.console import Console

from verify.soak.program import BUILD, HERE, KINDS, Failure, play_kept, play_program, say

# Must match scenario_parameters() in scenario.c.
SETS = (
    Parameters(1, 1, 7, 5, 3),
    Parameters(1, 3, 7, 2, 2, step_reset=5, dir_reset=3, enable_reset=6),
    Parameters(2, 2, 7, 3, 4, step_reset=1, dir_reset=4, enable_reset=15),
)
DRIVER_SET = 2  # must match BRIDGE_SET in bridge.h
# Must match scenario_machine_parameters() in scenario_machine.c.
MACHINE = Parameters(1, 3, 7, 5, 5, inputs=1, encoders=1, outputs=1, raster=1, compare=1)
# With trackers, a tick of 4 axes or of 8; played by trackers.py.
TRACKER_SETS = (
    Parameters(1, 4, 7, 5, 5, inputs=1, trackers=1),
    Parameters(1, 5, 7, 5, 5, inputs=1, trackers=1),
    Parameters(1, 1, 7, 5, 5, trackers=1),
    Parameters(1, 5, 7, 5, 5, inputs=1, outputs=1, trackers=1, tracked=3),
)
CHUNK = 50  # histories per process


console = terminal if terminal.is_terminal else Console(width=118)


@dataclass
class Part:
    """Result of a part."""

    name: str
    seconds: float = 0
    counts: Counter[str] = field(default_factory=Counter)
    failures: list[Failure] = field(default_factory=list)


Work = Callable[[], tuple[Counter[str], list[Failure]]]


def _all(part: Part, wanted: int, work: Iterable[Work], jobs: int) -> Part:
    """Run the work on `jobs` processor cores and print the progress."""
    began = last = time.monotonic()
    estimate = Estimate(wanted)
    waiting: Iterator[Work] = iter(work)
    with ThreadPoolExecutor(jobs) as pool:
        running = {pool.submit(task) for _, task in zip(range(2 * jobs), waiting, strict=False)}
        while running:
            done, running = wait(running, return_when=FIRST_COMPLETED)
            for future in done:
                counts, failures = future.result()
                part.counts += counts
                part.failures += failures
                if (task := next(waiting, None)) is not None:
                    running.add(pool.submit(task))
            now = time.monotonic()
            if now - last > 10 or not running:
                last = now
                console.print(
                    f"{part.name}: histories: {estimate.counted(part.counts['histories'])}, "
                    f"{len(part.failures)} failed, {now - began:.0f} s",
                    highlight=False,
                )
    part.seconds = time.monotonic() - began
    for failure in part.failures[:10]:
        console.print(
            f"  FAIL {failure.again}: clock {failure.clock}: {failure.text}", style="red", highlight=False
        )
    return part


def chunks(histories: int) -> Iterator[tuple[int, int]]:
    """First history and number of each chunk."""
    return ((first, min(CHUNK, histories - first)) for first in range(0, histories, CHUNK))


def play_model(program: Path, seed: int, histories: int, jobs: int, name: str = "model") -> Part:
    """Histories at register level, on the C model; `name` is one of KINDS, too."""
    kind = [f"--{name}"] if name in KINDS else []

    def task(first: int, count: int) -> Work:
        command = [program, str(seed), str(first), str(count), "--keep-on", *kind]
        return lambda: play_kept(command, name, seed)

    return _all(Part(name), histories, (task(*chunk) for chunk in chunks(histories)), jobs)


def play_driver(program: Path, seed: int, histories: int, jobs: int, library: Path | None = None) -> Part:
    """Histories through the driver over a bad link, on the C model or also on a Verilated core."""
    name = "driver on verilator" if library else "driver"
    more = ["--rtl", library] if library else []
    play = play_program if library else play_kept

    def task(first: int, count: int) -> Work:
        command = [program, str(seed), str(first), str(count), "--driver", "--keep-on", *more]
        return lambda: play(command, name, seed)

    return _all(Part(name), histories, (task(*chunk) for chunk in chunks(histories)), jobs)


def play_endings(program: Path, kind: str, seed: int, histories: int, jobs: int) -> Part:
    """Operations of the driver that end early, or hosts that die: `kind` is one of DRIVER_KINDS."""

    def task(first: int, count: int) -> Work:
        command = [program, kind, str(seed), str(first), str(count)]
        return lambda: play_kept(command, kind, seed)

    return _all(Part(kind), histories, (task(*chunk) for chunk in chunks(histories)), jobs)


def play_trackers(seed: int, histories: int, jobs: int, rtl: bool = False) -> Part:
    """Histories of paths and trackers, in Python, on the C model or also on Verilated cores."""
    name = "trackers on verilator" if rtl else "trackers"
    mutants = paths.root / "verify/mutants"
    judges = [*mutants.glob("motions_judge.py"), *sorted(mutants.glob("trackers_*.py"))]
    made = hash_of([model_library(), *judges, HERE / "trackers.py"], [])
    more = [made, *(["--rtl"] if rtl else [])]
    if rtl:
        for parameters in TRACKER_SETS:
            rtl_library(parameters)
    play = play_program if rtl else play_kept

    def task(first: int, count: int) -> Work:
        command = [sys.executable, "-m", "verify.soak.trackers", str(seed), str(first), str(count), *more]
        return lambda: play(command, name, seed)

    return _all(Part(name), histories, (task(*chunk) for chunk in chunks(histories)), jobs)


def play_machine_on_verilator(program: Path, seed: int, histories: int, jobs: int) -> Part:
    """The histories of a machine on the Verilated core, compared with the model on every clock."""
    name, library = "machine on verilator", rtl_library(MACHINE)

    def task(first: int, count: int) -> Work:
        command = [program, str(seed), str(first), str(count), "--machine", "--keep-on", "--rtl", library]
        return lambda: play_program(command, name, seed)

    return _all(Part(name), histories, (task(*chunk) for chunk in chunks(histories)), jobs)


def play_verilator(program: Path, seed: int, histories: int, jobs: int) -> Part:
    """The same histories on the Verilated core, compared with the model on every clock."""
    libraries = [rtl_library(parameters) for parameters in SETS]

    def task(number: int, first: int, count: int) -> Work:
        command = [program, str(seed), str(first), str(count), "--set", str(number), "--keep-on"]
        return lambda: play_program([*command, "--rtl", libraries[number]], "verilator", seed)

    share = -(-histories // len(SETS))
    work = (
        task(number, first * len(SETS) + number, count)
        for first, count in chunks(share)
        for number in range(len(SETS))
    )
    return _all(Part("verilator"), share * len(SETS), work, jobs)


def _bench(parameters: Parameters, folder: Path) -> Path:
    """Compile the player for these parameters with Icarus Verilog into a folder; return its path."""
    made = folder / f"player_{parameters.name}.vvp"
    given = [f"-Psoak_player.{name}={value}" for name, value in parameters.verilog().items()]
    sources = [HERE / "player.v", *sorted(paths.rtl.glob("*.v"))]
    folders = includes(paths.rtl, HERE)
    call(["iverilog", "-g2012", *folders, *given, "-s", "soak_player", "-o", made, *sources])
    return made


def play_icarus(program: Path, seed: int, histories: int, jobs: int, machine: bool = False) -> Part:
    """Histories recorded on the judged model and replayed to the core on Icarus Verilog."""
    name = "machine on icarus" if machine else "icarus"
    kind = ["--machine"] if machine else []
    BUILD.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(prefix="icarus.", dir=BUILD) as temporary:
        folder = Path(temporary)  # of this call alone: others may play other sources at the same time
        benches = [_bench(parameters, folder) for parameters in ((MACHINE,) if machine else SETS)]

        def play(history: int) -> tuple[Counter[str], list[Failure]]:
            record = folder / f"{history}.txt"
            command = [program, str(seed), str(history), "1", "--record", folder, "--short", *kind]
            counts, failures = play_program(command, name, seed)
            bench = ["vvp", str(benches[history % len(benches)]), f"+record={record}"]
            said = say(bench)[1].strip()
            record.unlink()
            if not re.fullmatch(r"same [1-9]\d*", said):
                clock = re.match(r"clock (\d+)", said)
                failures.append(Failure(name, seed, history, int(clock[1]) if clock else 0, said))
            return counts, failures

        return _all(
            Part(name),
            histories,
            ((lambda history=history: play(history)) for history in range(histories)),
            jobs,
        )
