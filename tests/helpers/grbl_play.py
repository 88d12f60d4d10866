# SPDX-License-Identifier: MIT
"""Plays random histories of a sender of grbl, and judges them: on the C model, or on the firmware.

python -m tests.helpers.grbl_play COUNT [--seed SEED] [--board]: a failure is printed, shrunk.
"""

import argparse
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from passo.build import WHOLE, Parameters, engine_sources
from passo.cache import cached
from passo.compiler import STRICT, compile_to, headers, includes, sources
from passo.console import cancelable, progress
from passo.engine import model_engine
from passo.toolchain import paths
from passo_stm32.grbl_board import GrblBoard, grbl_elf

from tests.helpers.grbl_histories import History, made_of, played, shrink
from tests.helpers.grbl_judge import STEPS_PER_MM, FindingError, judge

FOLDERS = (paths.grbl, paths.driver, paths.gcode, paths.planner, paths.protocol, paths.core)
BATCH = 20  # histories of a process
BOARD_HZ = 36_000_000
BAUD = 1_000_000
PATIENCE = 30  # seconds until all is answered
# While the flash is written the processor stalls and loses bytes; a sender waits for the answer.
STORES = re.compile(r"^(?!.*J).*=|RST|L2|\.1$|28", re.M)

Logs = list[list[str]]


def program() -> Path:
    """What plays histories on the C model: as one program, which takes two thirds of the time."""
    main, model = paths.tests / "grbl_play.c", paths.engine / "engine_model.c"
    files = [main, *sources(*FOLDERS), *engine_sources(), model]
    inputs = [*files, paths.tests / "grbl_bench.h", *headers(*FOLDERS, paths.engine)]
    flags = [*STRICT, *WHOLE, *includes(*FOLDERS, paths.engine)]

    def make(folder: Path) -> None:
        compile_to(folder / "grbl_play", *flags, *files)

    return cached("grbl_play", inputs, flags, make) / "grbl_play"


def play_on_model(made: Path, histories: list[History]) -> Logs:
    """The log of each history."""
    text = "\n".join(command for history in histories for command in played(history)) + "\n"
    done = subprocess.run([made], input=text, capture_output=True, text=True, check=True)
    return [log.splitlines() for log in done.stdout.split("end\n")[:-1]]


def board_elf() -> Path:
    """The firmware that plays histories."""
    folder = paths.build / "tests" / "grbl_histories"
    return grbl_elf(folder, "AXES=3", f"BAUD={BAUD}")


def play_on_board(elf: Path, history: History) -> list[str]:
    """The log of a history on the firmware; its machine has no inputs, and its flash does not wear."""
    with model_engine(Parameters(axes=4, clock_hz=BOARD_HZ), BOARD_HZ) as engine:
        board = GrblBoard(engine, elf, baud=BAUD)
        return _Board(board).play(history)


class _Board:
    def __init__(self, board: GrblBoard):
        self.board, self.log, self.told, self.steps = board, [], len(board.output), [0, 0, 0]
        self.levels = 0
        for axis in "012":  # the machine of tests/grbl_play.c
            for setting in (f"$10{axis}={STEPS_PER_MM}", f"$11{axis}=2400", f"$12{axis}=2000"):
                assert board.line(setting) == "ok"
        self._look()
        self.log.clear()

    @property
    def ms(self) -> int:
        return int(self.board.seconds * 1000)

    def play(self, history: History) -> list[str]:
        for command in played(history):
            word, _, text = command.partition(" ")
            if word == "send" and STORES.search(bytes.fromhex(text).decode("latin-1")):
                continue
            if word == "send":
                self._send(text)
            elif word == "wait":
                self._run(int(text))
            elif word == "settle":
                self._settle()
        return self.log

    def _send(self, text: str) -> None:
        self.log.append(f"> {self.ms} {text}")
        self.board.type(bytes.fromhex(text).decode("latin-1"))
        self._run(1 + len(text) // 150)

    def _run(self, ms: int) -> None:
        for _ in range(ms):
            self.board.run(0.001)
            self._look()

    def _settle(self) -> None:
        """Until two reports say that it rests, and nothing is said any more."""
        for _ in range(50 * PATIENCE):
            since = len(self.board.output)
            self._send("7e3f")
            self._run(20)
            if self.board.output[since:].count("\r\n") == 1 and re.match(
                "<(Idle|Sleep|Alarm|Check)", self.board.output[since:]
            ):
                return

    def _look(self) -> None:
        for event in self.board.events():
            rising = int(event["step"]) & ~self.levels
            for axis in range(3):
                if rising >> axis & 1:
                    self.steps[axis] += -1 if int(event["dir"]) >> axis & 1 else 1
            self.levels = int(event["step"])
        steps = " ".join(map(str, self.steps))
        last = next((line for line in reversed(self.log) if line.startswith("p ")), "p 0 0 0 0")
        if last.split(" ", 2)[2] != steps:
            self.log.append(f"p {self.ms} {steps}")
        output = self.board.output
        while (end := output.find("\r\n", self.told)) >= 0:
            self.log.append(f"< {self.ms} {output[self.told : end]}")
            self.told = end + 2


def finding(log: list[str], serial: bool = False) -> str:
    """What is found in a log, or nothing."""
    try:
        judge(log, serial)
    except FindingError as found:
        return str(found)
    return ""


def examine(play: Callable[[History], list[str]], history: History, serial: bool = False) -> str:
    """The report of a history that fails: shrunk, with its log."""
    short = shrink(history, lambda tried: bool(finding(play(tried), serial)))
    log = play(short)
    return "\n".join([finding(log, serial), *short, "--- its log:", *log])


def main() -> int:
    """Play `count` histories."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("count", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--board", action="store_true", help="on the firmware in the emulated STM32F103")
    options = parser.parse_args()
    seeds = range(options.seed, options.seed + options.count)
    if options.board:
        elf = board_elf()
        play = lambda history: play_on_board(elf, history)  # noqa: E731
        logs = (play(made_of(seed)) for seed in seeds)
    else:
        made = program()
        play = lambda history: play_on_model(made, [history])[0]  # noqa: E731
        batches = (seeds[at : at + BATCH] for at in range(0, len(seeds), BATCH))
        logs = (log for batch in batches for log in play_on_model(made, [made_of(seed) for seed in batch]))
    failed = done = 0
    with cancelable() as work, progress("histories", options.count) as report:
        for seed, log in zip(seeds, logs, strict=True):
            if finding(log, options.board):
                failed += 1
                print(f"history {seed}: {examine(play, made_of(seed), options.board)}", flush=True)
            done += 1
            report(done)
    print(f"{done - failed} of {done} histories from {options.seed} on without a finding")
    return int(failed > 0 or work.canceled)


if __name__ == "__main__":
    sys.exit(main())
