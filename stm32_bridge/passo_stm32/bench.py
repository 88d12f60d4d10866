# SPDX-License-Identifier: MIT
"""Cost of the firmware: instructions per plan, frame and line, load during a motion, lines per second."""

from dataclasses import dataclass
from pathlib import Path

from passo.build import Parameters
from passo.console import console, stages
from passo.engine import model_engine
from passo.link import error_name
from passo.output import check_results, write_text
from passo.toolchain import paths

from passo_stm32.board import Board, make_firmware, program_elf
from passo_stm32.bus import TICKS_PER_SECOND
from passo_stm32.machine import Machine

REPORT = paths.reference / "firmware_report.md"
PAGE = paths.root / "benchmarks" / "firmware_page.md"
HZ = 72_000_000
PARAMETERS = Parameters(axes=4)
AIM = 20_000  # goal: instructions per plan
WORDS_PER_LINE = PARAMETERS.axes + 2
STREAM_SOURCE = paths.root / "benchmarks" / "stm32_stream.c"
FIRST_LINES, LINES = (280, 480), (400, 2400)  # the rate is measured between these two numbers of lines
FASTER = 1.02

STEPS = "steps=25600,15360,10240,-25599"
PLANS = {
    "in time, cosine": ("in_time", f"{STEPS} profile=cosine total_time=0.9 ramp_time=0.4"),
    "in time, jerk": ("in_time", f"{STEPS} profile=jerk total_time=0.9 ramp_time=0.4"),
    "by speed, linear": (
        "by_speed",
        f"{STEPS} profile=linear start_speed=500 speed=50000 acceleration=400000 deceleration=300000 "
        "stop_speed=300",
    ),
    "by speed, cosine, too short": (
        "by_speed",
        "steps=256,153,-102,255 profile=cosine start_speed=500 speed=50000 acceleration=400000",
    ),
    "by speed, jerk": ("by_speed", f"{STEPS} profile=jerk start_speed=500 speed=50000 acceleration=400000"),
    "below speed": ("below_speed", f"method=below_speed {STEPS} profile=cosine total_time=1 speed=50000"),
    "at speed": ("at_speed", f"method=at_speed {STEPS} profile=cosine speed=50000 ramp_time=0.2"),
    "axes": ("axes", f"method=axes {STEPS} start_speed=500 speed=50000 ramp_time=0.2"),
    "turn": (
        "turn",
        "method=turn axis=1 steps_per_turn=3200 angle=720 rpm=120 minimum_rpm=3 acceleration=50000",
    ),
    "sigmoid": (
        "sigmoid",
        f"method=sigmoid {STEPS} start_speed=500 speed=50000 stop_speed=300 accelerate_time=0.2 "
        "decelerate_time=0.3",
    ),
    "jerk": (
        "jerk",
        f"method=jerk {STEPS} start_speed=500 speed=50000 stop_speed=300 acceleration=400000 jerk=4000000",
    ),
    "jerk, too short": (
        "jerk",
        "method=jerk steps=2560,1536,1024,-2559 speed=50000 acceleration=400000 jerk=4000000",
    ),
    "straight": (
        "straight",
        "method=straight distance=100,-30,12 feed=200 steps_per_mm=80,80,400 speed=300,300,20 "
        "acceleration=3000,3000,100",
    ),
    "straight, jerk": (
        "straight",
        "method=straight distance=100,-30,12 feed=200 steps_per_mm=80,80,400 speed=300,300,20 "
        "acceleration=3000,3000,100 jerk=50000,50000,5000",
    ),
}
SLOWEST_SHOWN = 6


@dataclass(frozen=True)
class Cost:
    """Instructions of one move."""

    plan: int  # in the planner alone
    line: int  # from the end of the line to its answer, including frames and waiting for them
    first: int  # the same for the first move, which may have to load a shape table


def plan_costs() -> dict[str, Cost]:
    """Cost of each method, each measured on a separate board."""
    found = {}
    for name, (method, words) in PLANS.items():
        board = Board(model_engine(PARAMETERS, HZ))
        costs = []
        for function in ("passo_commands_execute", "passo_commands_execute", f"passo_plan_{method}"):
            board.measure(function)
            board.must(f"move {words}")
            costs.append(board.measured() or 0)
            board.must("abort")
            board.run(0.01)
            board.must("clear")
        found[name] = Cost(plan=costs[2], line=costs[1], first=costs[0])
    return found


def planner_functions(words: str, method: str) -> dict[str, int]:
    """Instructions of a plan, by function."""
    board = Board(model_engine(PARAMETERS, HZ))
    board.measure(f"passo_plan_{method}", profile=True)
    board.must(f"move {words}")
    return board.profiled()


def other_costs() -> dict[str, int]:
    """Cost of a frame, a short line, a character and the idle loop."""
    board = Board(model_engine(PARAMETERS, HZ))
    found = {}
    for name, function, line in (
        ("frame that reads the state (8 words), waiting included", "spi_transfer", ""),
        ("CRC of a frame by the CRC unit", "passo_crc", "position"),
        ("line `position`, its frame included", "passo_commands_execute", "position"),
        ("line that is refused", "passo_commands_execute", "mvoe"),
        ("a character of a line", "passo_console_receive", "position"),
        ("interrupt of a character", "usart1_handler", "position"),
        ("interrupt of SysTick", "systick_handler", ""),
    ):
        board.measure(function)
        if line:
            board.ask(line)
        board.run(0.01)
        found[name] = board.measured() or 0
    executed, began = board.instructions, board.now
    board.run(1.0)
    found["a second of waiting for something to do"] = board.instructions - executed
    assert board.now > began
    return found


def load() -> tuple[float, dict[str, int], int]:
    """Processor load while all axes make a million steps/s, instructions by function, and the stack used."""
    board = Board(model_engine(PARAMETERS, 200_000_000))
    for axis in range(PARAMETERS.axes):
        board.must(f"config axis={axis} step_high=50clocks step_low=50clocks")
    board.must("move steps=990000,990000,990000,990000 profile=linear total_time=1 ramp_time=0.01")
    board.run(0.02)
    board.profile()
    executed, began = board.instructions, board.now
    board.run(0.9)
    share = (board.instructions - executed) * board.cpu.step / (board.now - began)
    return share, board.profiled(), board.stack_used()


def stream_elf() -> Path:
    """Build a program that streams with the driver; return the path of its ELF file."""
    return program_elf("firmware_stream", STREAM_SOURCE)


def lines_per_second(sclk_hz: int) -> tuple[float, float]:
    """Lines of all axes per second that the driver achieves, and the limit of the link."""
    limit = sclk_hz / 32 / WORDS_PER_LINE
    rate = _stream(sclk_hz, limit, *FIRST_LINES)
    # the core consumes lines slightly faster than they arrive, so that its queue is never full
    return _stream(sclk_hz, FASTER * rate, *LINES), limit


def _stream(sclk_hz: int, taken: float, first: int, last: int) -> float:
    """Lines per second requested between two counts, while the core consumes `taken` per second."""
    machine = Machine(stream_elf(), model_engine(PARAMETERS, HZ))
    machine.run(0.01)
    values = {"substeps": int(HZ / 2 / taken), "fast": int(sclk_hz > 9_000_000), "go": 1}
    for name, value in values.items():
        machine.write_memory(machine.elf.symbols[f"stream_{name}"], value.to_bytes(4, "little"))

    def asked() -> int:
        return int.from_bytes(machine.read_memory(machine.elf.symbols["stream_asked"], 4), "little")

    def run_to(count: int) -> None:
        try:
            machine.run_until(lambda: asked() >= count, 1.0)
        except TimeoutError:
            error = int.from_bytes(machine.read_memory(machine.elf.symbols["stream_error"], 4), "little")
            raise RuntimeError(f"the stream has ended: {error_name(error)}") from None

    run_to(first)
    count, began = asked(), machine.now
    run_to(last)
    return (asked() - count) * TICKS_PER_SECOND / (machine.now - began)


def memory_report() -> str:
    """Flash, RAM and stack, as the build of the firmware prints them."""
    said = make_firmware().splitlines()
    return "\n".join(line for line in said if line and not line.startswith("make"))


def bench() -> None:
    """Measure, write docs/reference/firmware_report.md and show it."""
    check_results(REPORT)
    tell = stages()
    tell("firmware: planning")
    costs = plan_costs()
    tell("firmware: frames and lines")
    others = other_costs()
    tell("firmware: a second of motion")
    share, where, stack = load()
    tell("firmware: streams")
    rates = {hz: lines_per_second(hz) for hz in (9_000_000, 18_000_000)}
    tell.end()
    text = report(costs, others, (share, where, stack), rates, memory_report())
    write_text(REPORT, text)
    print(text)
    console.print(f"Report: {REPORT.relative_to(paths.root)}")


def report(
    costs: dict[str, Cost],
    others: dict[str, int],
    motion: tuple[float, dict[str, int], int],
    rates: dict[int, tuple[float, float]],
    memory: str,
) -> str:
    """Text of the report."""
    share, where, stack = motion
    worst = max(costs, key=lambda name: costs[name].plan)
    method, words = PLANS[worst]
    functions = list(planner_functions(words, method).items())[:SLOWEST_SHOWN]
    total = sum(where.values())
    return PAGE.read_text(encoding="utf-8").format(
        moves="\n".join(
            f"| {name} | {c.plan:,} | {c.line:,} | {HZ // c.line:,} | {c.first:,} |"
            for name, c in costs.items()
        ),
        worst=worst,
        worst_plan=f"{costs[worst].plan:,}",
        aim=_aim(costs[worst].plan),
        functions="\n".join(f"| `{name}` | {count:,} |" for name, count in functions),
        others="\n".join(f"| {name} | {count:,} |" for name, count in others.items()),
        share=f"{100 * share:.2f} %",
        where=", ".join(f"`{name}` {100 * n / total:.0f} %" for name, n in list(where.items())[:4]),
        rates="\n".join(
            f"| {hz // 1_000_000} MHz | {rate:,.0f} | {100 * rate / limit:.0f} % |"
            for hz, (rate, limit) in rates.items()
        ),
        memory=memory,
        stack=f"{stack:,}",
    )


def _aim(count: int) -> str:
    return f"below the aim of {AIM:,}" if count < AIM else f"above the aim of {AIM:,}"
