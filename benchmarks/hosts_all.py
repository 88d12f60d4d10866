# SPDX-License-Identifier: MIT
"""All that hosts on Linux promise: `make hosts`. Prints each figure and writes docs/reference/hosts.md.

    python -m benchmarks.hosts_all [--seed N] [--hours H] [--lines N] [--only PART ...] [--page]

--hours: of the thread with another clock than the core (1; 24 take four minutes of processor time);
--lines: of the long program in LinuxCNC (20,000). What is finished stands in build/hosts/, a file for each
part: --only runs parts again, --page writes the page of what is there.
"""

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

from passo.console import cancelable, stages
from passo.ending import ended
from passo.output import check_results, write_text
from passo.toolchain import paths, short

from benchmarks import hosts, linuxcnc, servo
from tests.helpers.linuxcnc import share_of_wire

RESULTS = paths.build / "hosts"
PAGE = paths.reference / "hosts.md"
TEMPLATE = Path(__file__).with_name("hosts_page.md")
LINES_MAX = 15  # of the first program
# What is wrong, and the tests that show one sentence about it, and that nothing moves.
WRONG = {
    "no device": ("linux", "test_what_is_wrong_without_a_device"),
    "no permission, another SPI mode, MISO stuck": ("linux", "test_what_is_wrong_at_spidev"),
    "another program holds it": ("linux", "test_another_program_holds_the_device"),
    "fewer axes than joints": ("linux", "test_a_core_with_too_few_axes"),
    "the same and a core without inputs, in LinuxCNC": ("linuxcnc", "test_what_cannot_be_loaded"),
    "a core without inputs, in Python": ("host_machine", "test_a_core_without_inputs"),
    "`maxaccel` 0, scale 0 or negative, a servo period that changes": (
        "linuxcnc",
        "test_settings_that_are_wrong",
    ),
    "points whose times do not increase, in C": ("follow", "test_what_cannot_be_made"),
    "the same, in Python": ("host_machine", "test_what_is_refused"),
}


@dataclass(frozen=True)
class Row:
    """A promise and its figure."""

    what: str
    figure: str
    bound: str
    kept: bool


@dataclass(frozen=True)
class Options:
    """Of the command."""

    seed: int
    hours: float
    lines: int


def timed_points(options: Options) -> Iterator[Row]:
    """Six axes at 1,000 points/s."""
    found = hosts.measure(options.seed)
    same = {True: "the same edges", False: "OTHER EDGES"}
    yield Row("axes off at the time of a point", f"{found.off} steps", "0", found.off == 0)
    yield Row("end late", f"{found.late} clocks", "128, a tick", 0 <= found.late <= 128)
    yield Row(
        "share of 4 MHz", f"{found.share:.1%}", f"{hosts.SHARE_MAX:.0%}", found.share <= hosts.SHARE_MAX
    )
    yield Row("bytes per axis and point", f"{found.bytes_per_point:.1f}", "", True)
    what = f"wakes late by up to 1 ms, {hosts.GAPS} gaps of 2 to 50 ms"
    yield Row(what, same[found.gaps_same], same[True], found.gaps_same)
    what = f"bit errors of {hosts.ERRORS:g}: {found.flips} bits"
    yield Row(what, same[found.noise_same], same[True], found.noise_same)
    causes = ", ".join(f"{count} {name}" for name, count in found.causes.items())
    what = f"{sum(found.causes.values())} deaths of the host"
    yield Row(what, f"{causes}; {found.lost} steps lost", "0 lost", found.lost == 0)
    figure = f"{found.hour_off} steps off, end late by {found.hour_late} clocks"
    yield Row("after an hour", figure, "0, 128", found.hour_off == 0 and 0 <= found.hour_late <= 128)


def threads(options: Options) -> Iterator[Row]:
    """Three axes at 1 kHz."""
    found = servo.measure(options.seed)
    clocks = f"clocks {servo.PPM} ppm apart, wakes late by up to 1 ms, bit errors of {servo.ERRORS:g}"
    figure = f"each place within a step after at most {found.late:.1f} periods"
    kept = found.late <= found.lag + servo.LATE
    yield Row(clocks, figure, f"lag {found.lag} + {servo.LATE}", kept)
    figure = f"{found.lags[0]:.1f} to {found.lags[1]:.1f} periods"
    bound = f"{found.lag} ± {servo.CONSTANT:g}"
    yield Row("lag there, at half the speed or more", figure, bound, servo.is_constant(found))
    most = servo.ACCELERATION * servo.ROUNDING
    yield Row("acceleration there", f"{found.hardest:.0f} mm/s²", f"{most:.0f}", found.hardest <= most)
    figure = f"{found.trim_step:.1f} ppm"
    rounding = servo.ROUNDING_PPM
    yield Row(
        "change of a line by the loop", figure, f"{rounding:g}, its rounding", found.trim_step < rounding
    )
    yield Row("steps lost, in all of these", str(found.lost), "0", found.lost == 0)
    most = servo.HARDEST * servo.ROUNDING
    figure = f"slow the path {found.gaps_slowed} times, {found.gaps_hardest:.0f} mm/s²"
    kept = found.gaps_hardest <= most and not found.gaps_off
    yield Row(f"{found.gaps} gaps of 2 to 50 ms", figure, f"{most:.0f}", kept)
    causes = ", ".join(f"{count} {name}" for name, count in found.causes.items())
    kept = found.deaths_hardest <= most and set(found.causes) == {"WATCHDOG"}
    figure = f"{causes}, {found.deaths_hardest:.0f} mm/s²"
    yield Row(f"{sum(found.causes.values())} deaths of the host", figure, f"WATCHDOG, {most:.0f}", kept)
    yield Row("a call of six axes, without the kernel", f"{found.instructions:,.0f} instructions", "", True)
    yield Row("its bytes per axis", f"{found.bytes_per_call:.1f}", "", True)
    for one in found.designs:
        figure = (
            f"following error {one.following:.2f} mm, {one.hardest:,.0f} mm/s², off the path {one.off:.3f} mm"
        )
        yield Row(f"{one.name}: lag {one.lag:g} ms", figure, "", True)


def hours(options: Options) -> Iterator[Row]:
    """Two axes at 20 Hz; the thread's clock is 200 ppm fast."""
    found = servo.long(options.hours)
    figure = f"{found.lost} steps lost, queue {found.off} lines off the lag, trim {found.trim:.0f} ppm"
    kept = found.lost == 0 and found.off <= servo.OFF_MAX
    yield Row(f"after {found.hours:g} h", figure, f"0, {servo.OFF_MAX}", kept)


def wire(options: Options) -> Iterator[Row]:
    """Six axes with inputs at 1 kHz."""
    share = share_of_wire()
    yield Row("share of 4 MHz", f"{share:.1%}", f"{servo.SHARE_MAX:.0%}", share <= servo.SHARE_MAX)


def program(part: str) -> Callable[[Options], Iterator[Row]]:
    """A program in LinuxCNC."""

    def measure(options: Options) -> Iterator[Row]:
        found = linuxcnc.measure(linuxcnc.programs(options.lines)[part])
        on = "model" if found.program.engine == "model" else "model and Verilated core"
        bound = f"end exact, no fault; lag {found.lag} + {servo.LATE}"
        yield Row(f"{found.program.name}, {on}", linuxcnc.figure(found), bound, found.is_good)

    return measure


def first_program(options: Options) -> Iterator[Row]:
    """Of a first-time user."""
    example = paths.examples / "python" / "first_move.py"
    code = example.read_text(encoding="utf-8").split('"""')[2]
    lines = sum(bool(line.strip()) for line in code.splitlines())
    done = subprocess.run([sys.executable, example], cwd=paths.root, capture_output=True, text=True)
    said = done.stdout.strip().splitlines()
    figure = f"{lines} lines: {said[-1] if said else done.stderr}"
    kept = done.returncode == 0 and lines <= LINES_MAX
    yield Row("plan, see and run a move in Python", figure, f"{LINES_MAX} lines", kept)


def wrong_input(options: Options) -> Iterator[Row]:
    """The tests of each."""
    for what, (file, test) in WRONG.items():
        node = f"tests/test_{file}.py::{test}"
        command = [sys.executable, "-m", "pytest", "-q", "-n", "0", node]
        done = subprocess.run(command, cwd=paths.root, capture_output=True, text=True)
        told = done.stdout.strip().splitlines()[-1].split(" in ")[0]
        kept = done.returncode == 0 and "skipped" not in told
        yield Row(what, f"`{test}`: {told}", "one sentence, nothing moves", kept)


PARTS: dict[str, tuple[str, Callable[[Options], Iterable[Row]]]] = {
    "points": ("Timed points", timed_points),
    "threads": ("Servo threads", threads),
    "hours": ("Servo threads: hours", hours),
    "wire": ("LinuxCNC: the wire", wire),
    "arcs": ("LinuxCNC: homing and arcs", program("arcs")),
    "g33": ("LinuxCNC: threads", program("g33")),
    "lines": ("LinuxCNC: many lines", program("lines")),
    "both": ("LinuxCNC: shorter lines", program("both")),
    "python": ("Python", first_program),
    "wrong": ("What is wrong", wrong_input),
}


def run(part: str, options: Options) -> None:
    """Measure, print, and keep the rows."""
    began, rows = time.process_time() + _children(), []
    for row in PARTS[part][1](options):
        rows.append(row)
        print(f"{'' if row.kept else 'NOT KEPT: '}{row.what}: {row.figure}", flush=True)
    seconds = time.process_time() + _children() - began
    found = {"options": asdict(options), "seconds": seconds, "rows": [asdict(row) for row in rows]}
    RESULTS.mkdir(parents=True, exist_ok=True)
    write_text(RESULTS / f"{part}.json", json.dumps(found, indent=1))


def _children() -> float:
    """Seconds of processor time of the programs that have ended."""
    import resource

    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def results() -> dict[str, tuple[dict[str, float], float, list[Row]]]:
    """Of the parts that have been run: options, seconds, rows."""
    found = {}
    for part in PARTS:
        if (file := RESULTS / f"{part}.json").exists():
            one = json.loads(file.read_text(encoding="utf-8"))
            found[part] = (one["options"], one["seconds"], [Row(**row) for row in one["rows"]])
    return found


def page() -> str:
    """The page of what is there."""
    text = []
    for part, (_, seconds, rows) in results().items():
        title, measure = PARTS[part]
        took = f"{seconds:,.0f} s of processor time." if seconds else ""
        about = f"{measure.__doc__ or ''} {took}".strip()
        text += [f"## {title}", "", *([about, ""] if about else [])]
        text += ["| | | at most |", "|---|---|---|"]
        text += [
            f"| {row.what} | {row.figure}{'' if row.kept else ' **not kept**'} | {row.bound} |"
            for row in rows
        ]
        text.append("")
    return TEMPLATE.read_text(encoding="utf-8").format(parts="\n".join(text).rstrip())


def main() -> int:
    """Run the parts; 1 if a promise is not kept."""
    parser = argparse.ArgumentParser(description="Measure what hosts on Linux promise.")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--hours", type=float, default=1)
    parser.add_argument("--lines", type=int, default=20_000)
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS))
    parser.add_argument("--page", action="store_true", help="only write the page")
    given = parser.parse_args()
    check_results(PAGE, RESULTS / f"{given.only[0]}.json")
    tell = stages()
    with cancelable() as work:
        for part in [] if given.page else given.only:
            tell(f"hosts: {part}")
            run(part, Options(given.seed, given.hours, given.lines))
        tell.end()
    if work.canceled:
        return 1  # what is finished stands in build/hosts/
    write_text(PAGE, page())
    print(f"written: {short(PAGE)}")
    return int(not all(row.kept for _, _, rows in results().values() for row in rows))


if __name__ == "__main__":
    sys.exit(ended(main))
