# SPDX-License-Identifier: MIT
"""Waveforms of a window of a motion, with a GTKWave save file (groups and names)."""

import os
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from passo.build import Parameters
from passo.engine import Engine
from passo.failure import BadInputError
from passo.output import complete, write_text
from passo.pair_engine import PairEngine
from passo.registers import CHANNEL_STATE_CAUSE_BITS, Cause, DescribedEnum, State, Verdict
from passo.values import BadValueError, parse_time

AROUND = Fraction(2, 1000)  # seconds recorded unless a window is given
NAMED: dict[str, type[DescribedEnum]] = {"state": State, "cause": Cause, "verdict": Verdict}
FILES = ("waves.fst", "waves.gtkw", *(f"waves_{name}.txt" for name in NAMED))
CORE = "TOP.passo_spi_top.u_core"

# Formats of GTKWave: flags of a trace in a save file.
BITS, DECIMAL, NAMES, CURVE = "28", "24", "2022", "8024"
MARGIN_PS = 20_000_000  # shown before the start


@dataclass(frozen=True)
class Window:
    """Seconds since the start of the motion; `begin` 0 is the reset."""

    begin: Fraction = Fraction(0)
    end: Fraction = AROUND

    def clocks(self, clock_hz: int) -> tuple[int, int]:
        """The same in clocks, at least one."""
        begin, end = (round(time * clock_hz) for time in (self.begin, self.end))
        return begin, max(end, begin + 1)


def wanted_window(waves: str | None, engine: str) -> Window | None:
    """The window that `--waves` asks for, if it does; raises BadInputError."""
    if waves is None:
        return None
    if engine == "model":
        raise BadInputError("--waves needs the RTL: --engine both or rtl")
    try:
        return read_window(waves)
    except ValueError as error:
        raise BadInputError(f"--waves: {error}") from None


def check_window(window: Window, clock_hz: int, clocks: int) -> None:
    """Raises BadInputError if it is behind the end of a motion."""
    if window.clocks(clock_hz)[0] >= clocks:
        raise BadInputError(f"--waves: the motion takes only {clocks / clock_hz:.6g} s")


def say_waves(folder: Path) -> None:
    """Say how to open them."""
    fst, view = (folder / name for name in FILES[:2])
    print(f"waves, {fst.stat().st_size / 1e6:.1f} MB; open: gtkwave {view}   or: surfer {fst}")


def read_window(text: str) -> Window:
    """`2ms`: from the reset until then; `100ms..102ms`: a part. Raises ValueError."""
    begin, dots, end = text.rpartition("..")
    try:
        window = Window(parse_time("begin", begin) if dots else Fraction(0), parse_time("end", end))
    except BadValueError:
        raise ValueError(f"{text!r} is not a window such as 2ms or 100ms..102ms") from None
    if window.begin >= window.end:
        raise ValueError(f"the window {text} is empty")
    return window


@contextmanager
def recorded(engine: Engine | PairEngine, window: Window, folder: Path) -> Iterator[None]:
    """Record a motion to waves.fst.

    Its writer takes the process with it if a disk is full, so it writes to memory.
    """
    with open(os.memfd_create(FILES[0]), "rb") as memory:
        engine.open_waves(Path(f"/proc/self/fd/{memory.fileno()}"), *window.clocks(engine.clock_hz))
        try:
            yield
        finally:
            engine.close_waves()
        with complete(folder / FILES[0]) as part, part.open("wb") as file:
            shutil.copyfileobj(memory, file)


def write_view(
    folder: Path, parameters: Parameters, clock_hz: int, axes: Mapping[int, int], start: int
) -> None:
    """Write the save file for GTKWave and its names; `start` is the clock at which the motion started.

    `axes`: of each channel that moves, by its number.
    """
    for name, values in NAMED.items():
        lines = (f"{value:x} {value.name}" for value in values)
        write_text(folder / f"waves_{name}.txt", "\n".join([*lines, ""]))
    edge_ps = (2 * start - 1) * (10**12 // (2 * clock_hz))
    zoom = -(10**12 // clock_hz * 2000).bit_length()
    files = zip(("dumpfile", "savefile"), FILES, strict=False)
    head = [f'[{kind}] "{folder.resolve() / name}"' for kind, name in files]
    head += [f"[timestart] {max(0, edge_ps - MARGIN_PS)}", f"*{zoom} {edge_ps}" + " -1" * 26]
    write_text(folder / FILES[1], "\n".join([*head, *_traces(folder, parameters, axes), ""]))


def _traces(folder: Path, parameters: Parameters, axes: Mapping[int, int]) -> Iterator[str]:
    lines, ramps = parameters.line_queue_log2, parameters.ramp_queue_log2
    running, pins = parameters.channels, parameters.channels * parameters.axes

    def names(signal: str, name: str) -> list[str]:
        return [f"@{NAMES}", f"^1 {folder.resolve() / f'waves_{name}.txt'}", signal]

    def group(title: str, *rows: str) -> list[str]:
        return ["@800200", f"-{title}", *rows, "@1000200", f"-{title}"]

    top = [f"TOP.{name}" for name in ("clk", "spi_cs_n", "spi_sclk", "spi_mosi", "spi_miso")]
    yield from group("host", f"@{BITS}", *top, *names(f"{CORE}.u_link.verdict[3:0]", "verdict"))
    for number, count in axes.items():
        title = f"channel {number}: " if set(axes) != {0} else ""
        channel = f"{CORE}.u_channels.g_channel[{number}].u_channel"
        path = f"{channel}.u_path"
        bit = "" if running == 1 else f"({running - 1 - number})"
        moving = f"{bit}TOP.running[{running - 1}:0]"
        yield from group(
            f"{title}motion", *names(f"{path}.state[2:0]", "state"),
            *names(f"{path}.cause[{CHANNEL_STATE_CAUSE_BITS - 1}:0]", "cause"),
            f"@{BITS}", moving, f"@{DECIMAL}", f"{path}.line_room[{lines}:0]",
            f"{path}.ramp_room[{ramps}:0]", f"{path}.rate[16:0]",
        )  # fmt: skip
        curve = [f"@{CURVE}", f"{path}.velocity[31:0]", "@20000", "-", "-", "-"]
        substep = [f"@{BITS}", f"{path}.substep"]
        yield from group(f"{title}velocity (2^-32 substeps per clock)", *curve, *substep)
        for axis in range(count):
            own = f"{channel}.u_drives.u_axes.g_axis[{axis}]"
            place = pins - 1 - (number * parameters.axes + axis)
            bits = [f"({place})TOP.{name}[{pins - 1}:0]" for name in ("step", "dir", "enable")]
            states = [f"{own}.u_axis.{name}" for name in ("setup", "high", "low", "hold", "idle")]
            yield from group(f"{title}axis {axis}", f"@{BITS}", *bits, *states)
