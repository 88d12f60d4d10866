# SPDX-License-Identifier: MIT
"""`passo make`: from a machine file to what a board, its firmware and a sender need.

Everything is checked before anything is written. Images that are up to date are not built again.
"""

import re
import shlex
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from passo_fpga import synth
from passo_fpga.boards import OSCILLATOR, Board, board, names
from passo_fpga.places import host_pins, places
from passo_fpga.table import BoardError
from passo_fpga.tools import ToolError
from passo_stm32.board import make_firmware
from passo_stm32.grbl_board import LARGE_IMAGE, SMALL_IMAGE

from passo.console import stages
from passo.drives import drives
from passo.failure import BadInputError, Failure
from passo.grbl_setup import MILLION, default_settings, encoders_of, setting_counts
from passo.linuxcnc_files import linuxcnc_files
from passo.machine_file import CHIPS, MOTOR_KEYS, MachineFile, read_machine
from passo.machine_sheet import BLUE_PILL, Host, Sheet, Wire, draw, page
from passo.native import ffi, planner
from passo.output import check_folder, empty_folder, write_text
from passo.path import Motors
from passo.pins import INPUTS
from passo.toolchain import need_repository, paths

SETTINGS, WIRING, SUMMARY, COMMANDS = "settings.txt", "wiring.txt", "summary.txt", "flash.sh"
DRAWING, PAGE = "wiring.svg", "wiring.html"
RASPBERRY_PI = "Raspberry Pi"
FIRMWARE = "firmware"  # folder of its images
SMALL, LARGE = CHIPS
CHIP_AXES = {SMALL: 3, LARGE: 6}  # of the G-code
CHIP_PROFILES = {SMALL: ("linear",), LARGE: ("linear", "jerk")}
IMAGE = {SMALL: SMALL_IMAGE, LARGE: LARGE_IMAGE}
NOT_BUILT = "  no images: --no-build"
FAILED_BITSTREAM = "  bitstream  NONE: see above"
SPI_MHZ = (18, 9)  # of the firmware: the fastest that a core can take, which is a quarter of its clock
SPEED_AT, OFFSET_AT = 110, 170  # first settings of the speeds and of the offsets
BACKLASH_AT = 160
LARGE_AT = 342  # first of those that only the large chip has; as are those of backlash
NO_SETTING = 0xFF
REVERSE = 1  # the output that a laser does not have
OUTPUTS = ("spindle on", "spindle reverse", "flood coolant", "mist coolant")  # bits 0 to 3
SWITCH_PORTS = {"limit_low": "limit, low end", "limit_high": "limit, high end", "home": "home switch"}
AXIS_PORTS = {"step": "STEP (PUL)", "dir": "DIR", "enable": "EN (ENA)"}
ENCODER_PORTS = {"encoder_a": "A", "encoder_b": "B", "encoder_index": "index, or ground"}
SPINDLE_PORTS = {**ENCODER_PORTS, "encoder_index": "index"}
INPUT_NAMES = {pin.name for pin in INPUTS}
OTHER_PORTS = {
    "power": "spindle PWM or laser",
    "led": "on the board",
    "estop_n": "e-stop, closed to 3.3 V; without one a wire to 3.3 V",
}


def make_machine(path: Path, out: Path | None = None, build: bool = True) -> bool:
    """Write the results of a machine file, build its images and print the summary.

    Returns whether there is a bitstream that meets its clocks. Raises BadInputError, or Failure for a tool.
    """
    need_repository("passo make")
    check_folder(out or paths.results, "--out")
    machine = read_machine(path, takes_up=True)
    if machine.host == "linuxcnc":
        return _make_linuxcnc(machine, out or _folder(path), build)
    if not machine.board:
        raise BadInputError(f"{path}: board is missing; must be one of {', '.join(names())}")
    _check_firmware(machine)
    chosen = board(machine.board)
    try:
        wires = list(_wires(machine, chosen, _to(BLUE_PILL, host_pins())))
    except BoardError as error:
        raise BadInputError(f"{path}: {error}") from None
    summary = list(_summary(machine, chosen))
    folder = out or _folder(path)
    results = {
        SETTINGS: settings_lines(machine),
        **_sheet(machine, chosen, BLUE_PILL, wires, summary),
        COMMANDS: list(_commands(chosen, path.stem)),
    }
    empty_folder(folder, (*results, SUMMARY))
    for name, lines in results.items():
        write_text(folder / name, "\n".join([*lines, ""]))
    images = list(_images(machine, chosen, folder / path.stem)) if build else [NOT_BUILT]
    write_text(folder / SUMMARY, "\n".join([*summary, *images, ""]))
    print("\n".join([*summary, *images, f"written to {folder}: {', '.join(results)}, {SUMMARY}"]))
    return FAILED_BITSTREAM not in images


def _sheet(
    machine: MachineFile, chosen: Board, host: Host, wires: list[Wire], summary: list[str]
) -> dict[str, list[str]]:
    """The wires: as a table, drawn, and as a page to print."""
    kind = drives()[machine.drive].input if machine.drive else ""
    title = f"{machine.path.stem}: wiring"
    facts = title, chosen.title, machine.drive, kind, machine.switches.inverted, wires, summary
    sheet = Sheet(*facts, host)
    return {
        WIRING: _aligned([("signal", "FPGA pin", "on the board", "to"), *wires]),
        DRAWING: [draw(sheet)],
        PAGE: [page(sheet)],
    }


def _to(host: Host, pins: dict[str, str]) -> dict[str, str]:
    """Where the wires of these signals lead."""
    return {name: f"{host.name} {pin}" for name, pin in pins.items()}


def _folder(path: Path) -> Path:
    return Path(paths.results) / "machines" / path.stem


def _make_linuxcnc(machine: MachineFile, folder: Path, build: bool) -> bool:
    """The configuration; of a board also its wires to a Raspberry Pi and its bitstream."""
    chosen = board(machine.board) if machine.board else None
    results, summary = linuxcnc_files(machine), [f"{machine.path.name}: LinuxCNC"]
    if chosen:
        pins = raspberry_pins()
        host = Host(RASPBERRY_PI, pins["ground"], "below 20 cm, with 33 ohm in series at the source of SCLK")
        try:
            wires = list(_wires(machine, chosen, _to(host, pins)))
        except BoardError as error:
            raise BadInputError(f"{machine.path}: {error}") from None
        summary = [*_summary(machine, chosen, "LinuxCNC")]
        results |= _sheet(machine, chosen, host, wires, summary)
    empty_folder(folder, (*results, SUMMARY))
    for name, lines in results.items():
        write_text(folder / name, "\n".join([*lines, ""]))
    made = _bitstream(machine, chosen, folder / machine.path.stem, stages()) if build and chosen else ()
    images = list(made)
    write_text(folder / SUMMARY, "\n".join([*summary, *images, ""]))
    print("\n".join([*summary, *images, f"written to {folder}: {', '.join(results)}, {SUMMARY}"]))
    return FAILED_BITSTREAM not in images


def raspberry_pins() -> dict[str, str]:
    """Pins of its header by the signal of the core, and `ground`: the table in docs/hosts.md."""
    text = (paths.docs / "hosts.md").read_text(encoding="utf-8")
    names = {"SCLK": "spi_sclk", "MOSI": "spi_mosi", "MISO": "spi_miso", "CS": "spi_cs_n"}
    rows = re.findall(r"^\| (\w+)(?: \([^|]*\))? \| (\d+)(?: or \d+)? \|", text, re.M)
    return {names.get(name, name): pin for name, pin in rows}


def _check_firmware(machine: MachineFile) -> None:
    """Refuse what the image cannot do."""
    slow, clock_hz = min(SPI_MHZ), machine.clock_hz
    if clock_hz < 4e6 * slow:
        needed = f"the link of {slow} MHz needs {4e6 * slow:.0f}"
        raise BadInputError(f"{machine.path}: clock_hz is {clock_hz}; {needed}")
    chip, profile, axes = machine.chip, machine.settings.profile, len(machine.settings.axes)
    if profile not in CHIP_PROFILES[chip]:
        allowed = " or ".join(CHIP_PROFILES[chip])
        raise BadInputError(
            f'{machine.path}: profile is "{profile}"; the ramps of the firmware for {chip} are {allowed}'
        )
    if machine.settings.motors.rows and chip != LARGE:
        raise BadInputError(
            f"{machine.path}: the motors are {', '.join(machine.motors)}; "
            f'the firmware for {chip} has one for each axis, chip = "{LARGE}" has others'
        )
    if machine.trackers and chip != LARGE:
        raise BadInputError(
            f'{machine.path}: backlash: the firmware for {chip} has no trackers, chip = "{LARGE}" has'
        )
    if machine.encoders and chip != LARGE:
        raise BadInputError(f'{machine.path}: the firmware for {chip} has no encoders, chip = "{LARGE}" has')
    if machine.spindle and chip != LARGE:
        raise BadInputError(
            f'{machine.path}: spindle: the firmware for {chip} has no threads, chip = "{LARGE}" has'
        )
    if machine.spindle_wait and chip != LARGE:
        raise BadInputError(
            f"{machine.path}: spindle_wait: the firmware for {chip} waits for no spindle, "
            f'chip = "{LARGE}" does'
        )
    if machine.gcode.left_out and chip != LARGE:
        raise BadInputError(
            f"{machine.path}: the axes are {' '.join(machine.letters)}; "
            f'the firmware for {chip} leaves out none before the last one, chip = "{LARGE}" does'
        )
    if any(float(getattr(machine.settings.motors.mixed, key)) % 1 for key in MOTOR_KEYS):
        raise BadInputError(f"{machine.path}: motors: the firmware takes whole numbers")
    if axes > CHIP_AXES[chip]:
        most = f'the firmware for {chip} has {CHIP_AXES[chip]}, chip = "{LARGE}" {CHIP_AXES[LARGE]}'
        raise BadInputError(f"{machine.path}: there are {axes} axes; {most}")
    if len(machine.limited) > CHIP_AXES[chip]:
        raise BadInputError(
            f"{machine.path}: there are limits of {', '.join(machine.limited)}; "
            f"the firmware has room for {CHIP_AXES[chip]}"
        )
    for letter, axis in zip(machine.letters, machine.settings.axes, strict=True):
        for key in ("jump", "jerk"):
            if getattr(axis, key) and key != profile:
                raise BadInputError(f"{machine.path}: axis {letter}: {key} is no setting of the firmware")


def _images(machine: MachineFile, chosen: Board, path: Path) -> Iterator[str]:
    """Build firmware and bitstream, what is up to date excepted; a line about each."""
    tell = stages()
    tell("firmware")
    given = " ".join(f"-D{name}={value}" for name, value in definitions(machine).items())
    to = f"OUT={(path.parent / FIRMWARE).resolve()}"
    said = make_firmware(*IMAGE[machine.chip], to, f"MACHINE={given}")
    flash = next(line.split(maxsplit=1)[1] for line in said.splitlines() if line.startswith("flash"))
    yield f"  {FIRMWARE}  {flash}"
    yield from _bitstream(machine, chosen, path, tell)


def _bitstream(machine: MachineFile, chosen: Board, path: Path, tell: Callable[[str], None]) -> Iterator[str]:
    bitstream = path.with_suffix(f".{chosen.device.family.suffix}")
    try:
        made = synth.make(chosen, *core_of(machine), bitstream.resolve(), tell, wired(machine, chosen))
    except ToolError as error:
        raise Failure(str(error)) from None
    if not made:
        yield FAILED_BITSTREAM
        return
    yield f"  bitstream  {made.size}; build {made.build}"
    yield f"  clock      {made.clock}"


def _text(millionths: int) -> str:
    whole, rest = divmod(abs(millionths), MILLION)
    return "-" * (millionths < 0) + f"{whole}.{rest:06}".rstrip("0").rstrip(".")


def settings_lines(machine: MachineFile) -> list[str]:
    """`$n=` of all settings. No line needs a later one: speeds are low until the pins have their times,
    offsets are 0 until there is a pull-off, backlash until the axes have their limits."""
    c, axes, counts = planner(), len(machine.settings.axes), setting_counts(machine)
    made, whole = default_settings(machine), ffi().new("bool *")
    values = {}
    while (number := c.passo_grbl_setting_number(len(values), counts, whole)) != NO_SETTING:
        values[number] = c.passo_grbl_setting(made, number, counts)[0]
    speeds = range(SPEED_AT, SPEED_AT + axes)
    backlash = range(BACKLASH_AT, BACKLASH_AT + axes)
    if machine.chip == SMALL:
        values = {n: value for n, value in values.items() if n < LARGE_AT and n not in backlash}
    offsets = range(OFFSET_AT, OFFSET_AT + len(machine.motors))
    homing = 22  # before soft limits
    order = sorted(values, key=lambda n: (n in backlash, n in speeds, n != homing, n))
    return [
        *(f"${number}=0" for number in values if number in backlash),
        *(f"${number}=1" for number in speeds),
        *(f"${number}=0" for number in values if number in offsets),
        *(f"${number}={_text(values[number])}" for number in order),
    ]


def _wires(machine: MachineFile, chosen: Board, host: dict[str, str]) -> Iterator[Wire]:
    where = places(chosen.name)
    for port, pin in chosen.ports(machine.core_axes, machine.parts).items():
        if port != OSCILLATOR:
            name, index = re.fullmatch(r"(\w+?)(?:\[(\d+)\])?", port).groups()
            there = where.get(port if index else f"{name}[0]", where.get(port, ""))
            end = _end(machine, chosen, host, name, int(index or 0)) or _unused(name)
            yield Wire(port, pin.pin, there, end)


def _unused(name: str) -> str:
    """An input that floats keeps the inputs unknown: no motion begins. Encoders need no wire."""
    return "ground" if name in INPUT_NAMES and name not in ENCODER_PORTS else "not connected"


def _end(machine: MachineFile, chosen: Board, host: dict[str, str], name: str, index: int) -> str:
    """What a wire leads to; nothing if it is not used."""
    if name in host:
        return host[name]
    if index == len(machine.motors) and name in (*AXIS_PORTS, *SWITCH_PORTS, *ENCODER_PORTS):
        return f"encoder of the spindle: {SPINDLE_PORTS[name]}" if name in ENCODER_PORTS else ""
    if name in AXIS_PORTS:
        return f"drive {machine.motors[index]}: {AXIS_PORTS[name]}"
    if name == "home" and index + 1 == machine.spindle_at_speed:
        return "spindle: at its speed"
    if name in SWITCH_PORTS:
        served = [
            port
            for port in SWITCH_PORTS
            if machine.mask(port) >> index & 1 and (port == name or chosen.shared)
        ]
        axis = next(axis for axis in range(len(machine.ends)) if index in machine.motors_of(axis))
        return "".join(f"{machine.letters[axis]}: {SWITCH_PORTS[port]}" for port in served)
    if name in ENCODER_PORTS:
        return f"encoder {machine.motors[index]}: {ENCODER_PORTS[name]}" if index in machine.encoders else ""
    if name == "probe":
        return "probe" if machine.switches.probe else ""
    if name == "outputs":
        return OUTPUTS[index] if index < len(OUTPUTS) and not (machine.laser and index == REVERSE) else ""
    return OTHER_PORTS.get(name, "")


def _aligned(rows: list[tuple[str, ...]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]


def _summary(machine: MachineFile, chosen: Board, host: str = "") -> Iterator[str]:
    axes, pins = machine.settings.axes, machine.pins
    yield f"{machine.path.name}: {chosen.title}, {host or machine.chip}"
    with_parts = ", ".join(machine.parts) or "no parts"
    spi = next(mhz for mhz in SPI_MHZ if 4e6 * mhz <= machine.clock_hz)
    clock = f"{machine.clock_hz / 1e6:g} MHz; SPI {spi} MHz"
    more = ", one for the encoder of the spindle" if machine.spindle else ""
    yield f"  core   {machine.core_axes} of {chosen.axes} axes{more}, {with_parts}, {clock}"
    longest = {"STEP": max(pins.step_high, pins.step_low), "DIR": max(pins.dir_setup, pins.dir_hold)}
    times = (f"{name} {clocks / machine.clock_hz * 1e6:.3g} us" for name, clocks in longest.items())
    yield f"  pins   {', '.join(times)}; EN active {'low' if machine.enable_inverted else 'high'}"
    if not machine.enable_inverted:
        yield "         EN is high from power-up on: the drives hold before the firmware starts"
    most = machine.clock_hz / (2 * longest["STEP"])
    for axis_number, (axis, end) in enumerate(zip(axes, machine.ends, strict=True)):
        letter = machine.letters[axis_number]
        steps = float(axis.speed * axis.steps_per_mm)
        fitted = ", ".join(end.switches) or "no switches"
        own = ", ".join(machine.motors[motor] for motor in machine.motors_of(axis_number))
        more = f"; motors {own}" if machine.settings.motors.rows else ""
        yield f"  {letter}      {steps:,.0f} steps/s of at most {most:,.0f}; {fitted}{more}"


def core_of(machine: MachineFile) -> tuple[int, float, tuple[str, ...]]:
    """Axes, MHz and parts of its core, as the board makes it."""
    return machine.core_axes, machine.clock_hz / 1e6, machine.parts


def wired(machine: MachineFile, chosen: Board) -> dict[str, int]:
    """Parameters of the board for limits that share a pin, and for the encoders that there are."""
    parameters = chosen.limits_at_home(machine.mask("limit_low"), machine.mask("limit_high"))
    if "encoders" in machine.parts:
        there = [*machine.encoders, *([len(machine.motors)] if machine.spindle else [])]
        parameters["ENCODER_WIRED"] = sum(1 << axis for axis in there)
    return parameters


def definitions(machine: MachineFile) -> dict[str, Any]:
    """Of the firmware, see grbl_machine.h."""
    homed = sum((end.home is not None) << axis for axis, end in enumerate(machine.ends))
    return {
        "AXES": len(machine.ends),
        **({"AXES_LEFT_OUT": machine.gcode.left_out} if machine.gcode.left_out else {}),
        "HOMES": machine.mask("home"),
        "LIMITS_LOW": machine.mask("limit_low"),
        "LIMITS_HIGH": machine.mask("limit_high"),
        "HOMED": homed,
        "PROBE": int(machine.switches.probe),
        "OUTPUTS": int("outputs" in machine.parts),
        **_motors(machine.settings.motors),
        **(_squares(machine) if machine.squared else {}),
        **({"TURN_COUNTS": machine.gcode.turn_counts} if machine.spindle else {}),
        **({"AT_SPEED": machine.spindle_at_speed} if machine.spindle_at_speed else {}),
        **({"ENCODERS": ",".join(map(str, encoders_of(machine)))} if machine.encoders else {}),
    }


def _squares(machine: MachineFile) -> dict[str, Any]:
    """Lengths in um."""
    return {
        "SQUARED": sum(1 << axis for axis in machine.squared),
        "RACKING": round(machine.switches.racking * 1000),
    }


def _motors(motors: Motors) -> dict[str, int]:
    if not motors.rows:
        return {}
    signs = {"MOTORS_PLUS": 1, "MOTORS_MINUS": -1}
    return {
        "MOTORS": len(motors.rows),
        **{name: int.from_bytes(bytes(motors.bits(sign)), "little") for name, sign in signs.items()},
        **{f"MOTORS_{key.upper()}": int(getattr(motors.mixed, key)) for key in MOTOR_KEYS},
    }


def _commands(chosen: Board, stem: str) -> Iterator[str]:
    yield "#!/bin/sh -e"
    yield "# Then send the lines of settings.txt with any sender."
    yield 'cd "$(dirname "$0")"'
    yield f"{chosen.load} {shlex.quote(f'./{stem}.{chosen.device.family.suffix}')}"
    yield f"st-flash --reset write {FIRMWARE}/passo.bin 0x08000000"
