# SPDX-License-Identifier: MIT
"""A machine as `passo make` wires it: firmware, board top, switches and drives, joined by the wiring sheet.

Inside the FPGA the ports of syn/passo_board.v are at the pins of the file that the placer reads; outside, the
pins lead where wiring.txt says. Only the PLL and the cells of the vendor are stubs.
"""

import re
import shutil
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from passo.build import Parameters, rtl_library
from passo.cli import main as passo
from passo.drives import Drive, drives
from passo.engine import Engine, model_engine
from passo.gcode import AXIS_LETTERS, NANOMETERS
from passo.grbl_setup import attach, core_for
from passo.machine_file import MachineFile, read_machine
from passo.make_command import AXIS_PORTS, IMAGE, OUTPUTS, SWITCH_PORTS, core_of, definitions, wired
from passo.part import read_part
from passo.pins import INPUTS, Pin
from passo.pins import OUTPUTS as CORE_OUTPUTS
from passo.toolchain import paths
from passo_fpga.boards import OSCILLATOR, Board, board
from passo_fpga.generate import TOP, generate
from passo_fpga.places import host_pins
from passo_stm32.grbl_board import GrblBoard, grbl_elf

from tests.helpers.grbl_terminals import served
from tests.helpers.sender import Sender

PIN = re.compile(
    r'^(?:set_io (?:-pull\w+ yes )?|LOCATE COMP "|IO_LOC ")([\w\[\]]+)"?\s+(?:SITE ")?(\w+)', re.M
)
PATIENCE = 3 * 3600.0  # seconds
HOMING = 120.0  # simulated seconds
REPORTED = 0.02  # until a report that has begun has ended

STUBS = """
module passo_board_pll (input wire oscillator, output wire clk, output wire locked);
  reg [2:0] count = 3'd0;
  assign clk = oscillator;
  assign locked = count == 3'd7;
  always @(posedge oscillator) if (!locked) count <= count + 3'd1;
endmodule
module passo_clock_pin (input wire pin, output wire clk);
  assign clk = pin;
endmodule
module passo_tristate_pin (input wire data, input wire enable, output wire pin);
  assign pin = enable & data;  // the host pulls it down
endmodule
"""

Bit = tuple[str, int]  # of a port


def _bit(port: str) -> Bit:
    name, _, index = port.rstrip("]").partition("[")
    return name, int(index or 0)


def outside(end: str) -> Bit | None:
    """The pin of the engine that a wire of the sheet leads to; None: to none."""
    ends = {f"Blue Pill {pin}": (signal, 0) for signal, pin in host_pins().items()}
    ends |= {name: ("outputs", bit) for bit, name in enumerate(OUTPUTS)}
    ends |= {"probe": ("probe", 0), "spindle PWM or laser": ("power", 0)}
    for axis, letter in enumerate(AXIS_LETTERS):
        ends |= {f"drive {letter}: {name}": (port, axis) for port, name in AXIS_PORTS.items()}
        ends |= {f"{letter}: {name}": (port, axis) for port, name in SWITCH_PORTS.items()}
    return ("estop_n", 0) if end.startswith("e-stop") else ends.get(end)


def wrapper(machine: MachineFile, chosen: Board, sheet: str, pins: str, top: dict[str, int]) -> str:
    """Verilog of the FPGA in its package and the wires around it; its ports are those of the engine."""

    def width(pin: Pin) -> int:
        return {"1": 1, "CHANNELS": 1, "CHANNELS*8": 8}.get(pin.width, len(machine.ends))

    inside = {_bit(port): pin for port, pin in PIN.findall(pins)}
    assert len(inside) == len(chosen.ports(len(machine.ends), machine.parts))
    into, out = {pin.name for pin in INPUTS}, {pin.name: width(pin) for pin in CORE_OUTPUTS}
    out |= {"spi_miso": 1}
    lines = [f"  wire pin_{pin};" for pin in inside.values()]
    lines.append(f"  assign pin_{inside[OSCILLATOR, 0]} = clk;")
    driven: dict[Bit, str] = {("running", 0): "u_board.core_running"}
    for _, pin, *_, end in (re.split(r" {2,}", line) for line in sheet.splitlines()[1:]):
        bit = outside(end)
        if end == "ground":
            lines.append(f"  assign pin_{pin} = 1'b0;")
        elif bit and bit[0] in into:
            lines.append(f"  assign pin_{pin} = {bit[0]}[{bit[1]}];")
        elif bit:
            assert bit not in driven, f"two wires lead to {end}"
            driven[bit] = f"pin_{pin}"
    for name, count in out.items():
        bits = ", ".join(driven.get((name, bit), "1'b0") for bit in reversed(range(count)))
        lines.append(f"  assign {name} = {{{bits}}};")
    ports: dict[str, dict[int, str]] = defaultdict(dict)
    for (name, index), pin in inside.items():
        ports[name][index] = f"pin_{pin}"
    for pin in INPUTS:
        if pin.name not in ports and pin.name != "rst":
            ports[pin.name] = dict.fromkeys(range(width(pin)), f"1'b{pin.idle}")
    joined = [
        f"    .{name}({{{', '.join(bits[index] for index in sorted(bits, reverse=True))}}})"
        for name, bits in ports.items()
    ]
    joined += [f"    .{name}()" for name in sorted({*out, "led"} - ports.keys())]
    heads = [f"input wire [{width(pin) - 1}:0] {pin.name}" for pin in INPUTS]
    heads += ["input wire clk", *(f"output wire [{count - 1}:0] {name}" for name, count in out.items())]
    heads.append("output wire spi_miso_enable")  # of the core alone
    declared = ", ".join(f"parameter {name} = 0" for name in Parameters().verilog())
    given = ", ".join(f".{name}({value})" for name, value in top.items())
    lines.append("  assign spi_miso_enable = 1'b1;")
    lines += [f"  passo_board #({given}) u_board (", ",\n".join(joined), "  );"]
    head = f"module passo_spi_top #({declared}) (\n  {', '.join(heads)}\n);"
    return "\n".join([head, *lines, "endmodule", STUBS])


@dataclass
class WholeMachine:
    """A machine file, made; results in `folder`."""

    path: Path
    folder: Path

    def __post_init__(self) -> None:
        assert passo(["make", str(self.path), "--out", str(self.folder), "--no-build"]) == 0

    @cached_property
    def machine(self) -> MachineFile:
        """The file."""
        return read_machine(self.path)

    @cached_property
    def parameters(self) -> Parameters:
        """Of the core."""
        return replace(core_for(self.machine), axes=len(self.machine.ends))

    @cached_property
    def elf(self) -> Path:
        """The image of this machine."""
        facts = (f"{name}={value}" for name, value in definitions(self.machine).items())
        folder = paths.build / "tests" / f"firmware_{self.path.stem}"
        return grbl_elf(folder, *facts, image=IMAGE[self.machine.chip])

    def engine(self) -> Engine:
        """The Verilated board in the machine, as the sheet wires it."""
        machine, chosen = self.machine, board(self.machine.board)
        made = *core_of(machine), "", wired(machine, chosen)
        design, pins = generate(chosen, self.folder / "fpga", *made)
        rtl = self.folder / f"{machine.board}_{self.path.stem}"
        shutil.copytree(paths.rtl, rtl, dirs_exist_ok=True)
        for source in (rtl / "passo_spi_top.v", TOP):  # the package has the name that the engine knows
            text = re.sub(r"\bpasso_spi_top\b", "passo_spi_inner", source.read_text())
            (rtl / source.name.replace("spi_top", "spi_inner")).write_text(text)
        sheet = (self.folder / "wiring.txt").read_text()
        (rtl / "passo_spi_top.v").write_text(
            wrapper(machine, chosen, sheet, pins.read_text(), dict(design.parameters))
        )
        parameters = replace(self.parameters, build=int(design.parameters["BUILD"]))
        engine = Engine(rtl_library(parameters, rtl=rtl), parameters, machine.clock_hz)
        attach(engine, machine)
        return engine

    def settings(self) -> bytes:
        """The flash of a board that has taken the settings, line by line."""
        with model_engine(self.parameters, self.machine.clock_hz) as engine:
            told = GrblBoard(engine, self.elf)
            for line in (self.folder / "settings.txt").read_text().splitlines():
                assert told.line(line).endswith("ok"), line
            return told.settings


@dataclass(frozen=True)
class Driven:
    """What a drive saw: when its position changed, to what; and each violation of its data sheet."""

    seconds: np.ndarray
    positions: np.ndarray
    turns: int  # changes of DIR
    faults: list[str]


def _seconds(text: str) -> float:
    return float(text[:-2]) * {"us": 1e-6, "ns": 1e-9}[text[-2:]]


def drive(events: np.ndarray, axis: int, kind: Drive, clock_hz: int) -> Driven:
    """The inputs of a drive over all pin events: it counts rising edges of STEP while it is enabled."""

    def level(pin: str, before: int) -> np.ndarray:
        return np.concatenate([[before], (events[pin] >> np.uint64(axis)).astype(np.int64) & 1])

    time = events["clock"] / clock_hz
    step, back, enable = level("step", 0), level("dir", 0), level("enable", 1)
    rises, falls = np.diff(step) > 0, np.diff(step) < 0
    rise, fall, turn = time[rises], time[falls], time[np.diff(back) != 0]
    off = enable[1:][rises] == int(kind.enable_inverted)
    before_rise = np.concatenate([[-np.inf], turn])[np.searchsorted(turn, rise, "right")]
    before_turn = np.concatenate([[-np.inf], fall])[np.searchsorted(fall, turn, "right")]
    shortest = {
        "step_high": fall - rise[: len(fall)],
        "step_low": rise[1:] - fall[: len(rise) - 1],
        "dir_setup": rise - before_rise,
        "dir_hold": turn - before_turn,
    }
    faults = ["steps while it is off"] if off.any() else []
    for name, times in shortest.items():
        if times.min(initial=np.inf) < _seconds(getattr(kind, name)) - 1e-12:
            faults.append(f"{name} of {times.min() * 1e6:.4g} us, not {getattr(kind, name)}")
    return Driven(rise, np.cumsum(1 - 2 * back[1:][rises]), len(turn), faults)


def run(whole: WholeMachine, part: Sequence[str], patience: float = PATIENCE) -> list[Driven]:
    """Home, take the place for zero, stream a part; returns what the drives saw, the homing included.

    Raises AssertionError for an alarm, a drive whose timings are violated, an end more than half a step off.
    """
    machine, link = whole.machine, whole.folder / "serial"
    letters = machine.letters
    with whole.engine() as engine:
        plugged = GrblBoard(engine, whole.elf, whole.settings())
        if any(end.home for end in machine.ends):
            assert plugged.line("$H", HOMING).endswith("ok"), plugged.output[-200:]
        for line in ("G10 L20 P1 " + " ".join(f"{letter}0" for letter in letters), "G28.1"):
            assert plugged.line(line) == "ok"
        began = plugged.seconds
        with served(link, plugged):
            sender = Sender(link, patience)
            try:
                sender.boot()
                sender.start(list(part), incremental=True)
                # a slow board may still look idle, as before the job
                sender.until(lambda: sender.events["on_processed_command"] >= len(sender.grbl.buffer) > 0)
                sender.finish()
                assert sender.events["on_error"] == sender.events["on_alarm"] == 0, sender.last
            finally:
                sender.grbl.disconnect()
        plugged.run(REPORTED)
        plugged.rest(HOMING)
        events = plugged.events()
    kind = drives()[machine.drive]
    seen = [drive(events, axis, kind, machine.clock_hz) for axis in range(len(machine.ends))]
    file = whole.folder / "part.nc"
    file.write_text("\n".join(part) + "\n")
    end = read_part(file, machine).end
    for axis, (driven, limits) in enumerate(zip(seen, machine.settings.axes, strict=True)):
        assert not driven.faults, f"drive {machine.letters[axis]}: {driven.faults}"
        before = int(np.searchsorted(driven.seconds, began))
        placed = driven.positions[before - 1] if before else 0
        wanted = end[axis] / NANOMETERS * float(limits.steps_per_mm)
        assert abs(driven.positions[-1] - placed - wanted) <= 0.5, (
            axis,
            driven.positions[-1],
            placed,
            wanted,
        )
    return seen
