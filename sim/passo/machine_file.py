# SPDX-License-Identifier: MIT
"""Machine files: axes and limits of a machine, as TOML. An error is reported in one line."""

import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np

from passo.drives import drives
from passo.failure import BadInputError
from passo.gcode import AXIS_LETTERS, GcodeSettings
from passo.move_file import read_pins
from passo.moves import PinTiming
from passo.path import Motors, PathAxis, PathSettings
from passo.registers import CHANNEL_ENCODER_FILTER_FILTER_RESET as ENCODER_FILTER
from passo.run import parameters_for
from passo.setup_tracks import BACKLASH_MAX, check_limits
from passo.table_values import (
    Table,
    check_known,
    read_clock_hz,
    read_flag,
    read_integer,
    read_number,
    read_positive,
    read_signed,
    read_subtable,
    read_tables,
    read_word,
    toml_error,
    within,
)
from passo.toolchain import need_repository
from passo.values import BadValueError, Written, shown

FILE_KEYS = (
    *("board", "clock_hz", "junction_deviation", "arc_tolerance", "profile", "spindle_maximum", "laser"),
    *("soft_limits", "probe", "drive", "chip", "kinematics", "pins", "switches", "home", "motors", "axis"),
    *("spindle", "spindle_wait", "spindle_at_speed", "host"),
)
AXIS_KEYS = (
    *("name", "steps_per_mm", "speed", "acceleration", "jerk", "jump", "travel", "home", "switches"),
    *("motors", "offsets", "encoders", "following", "backlash", "take_up"),
)
BACKLASH_KEYS = ("backlash", "take_up")
COUNTS, WANDER_MAX = range(64, 65536), 90
SPINDLE_KEYS = ("counts", "start_up", "wander")
MOTOR_KEYS = ("speed", "acceleration", "jerk")
KINEMATICS = {"cartesian": (), "corexy": (0, 1), "corexz": (0, 2)}  # the two axes that share two motors
MOTORS_MOST = 3  # of an axis
ENABLE_INVERTED = "enable_inverted"
SWITCH_KEYS = ("inverted", "debounce", "stop")
HOME_KEYS = ("seek", "speed", "pull_off")
HOME_ENDS = ("low", "high")
SWITCHES = ("home", "limit_low", "limit_high")
CHIPS = ("STM32F103C8", "STM32F103CB")
HOSTS = ("stm32", "linuxcnc")
PROFILES = ("linear", "cosine", "sigmoid", "jerk")
TRAVEL = 200  # mm
RATIO_ONE = 1 << 16  # counts per step
MILLION = 1_000_000
FOLLOWING_COUNTS = 65535  # of a following error, at most
COUNT_CLOCKS = ENCODER_FILTER + 2  # from a count of an encoder to the next
WAITING_STEPS = 2
SPINDLE_WAIT_MAX = 60  # s
JUNCTION_DEVIATION, ARC_TOLERANCE = 0.01, 0.002  # mm


@dataclass(frozen=True)
class AxisEnds:
    """The ends of an axis."""

    travel: float = TRAVEL  # mm
    home: str | None = None  # the end with its home
    switches: tuple[str, ...] = ()
    motors: int = 1
    offsets: tuple[float, ...] = ()  # mm, of each motor: its edge from that of the axis; none: 0
    encoders: tuple[float, ...] = ()  # counts per mm of that of each motor; 0, none: it has none
    following: float = 0  # mm that a motor may be from its encoder
    backlash: float = 0  # mm that a tracker takes up where the axis turns
    take_up: float = 0  # mm/s^2 of the tracker; 0: the acceleration of the axis

    @property
    def homing_switch(self) -> str | None:
        """The switch that its home is found by."""
        if self.home is None:
            return None
        return "home" if "home" in self.switches else f"limit_{self.home}"


@dataclass(frozen=True)
class Switches:
    """What all switches and homes of a machine share."""

    inverted: bool = False  # active low
    debounce: float = 0.00002  # s
    stop: bool = True  # a limit stops the machine
    probe: bool = False
    soft_limits: bool = False
    seek: float = 20  # mm/s
    speed: float = 2  # mm/s
    pull_off: float = 1  # mm
    racking: float = 0  # mm that motors of an axis may be apart when they square; 0: they do not


@dataclass(frozen=True)
class Spindle:
    """The encoder of a spindle, and how `passo run` simulates that spindle."""

    counts: int  # per turn
    start_up: float = 0.3  # s from rest to full speed
    wander: float = 0  # % by which its speed wanders either way


@dataclass(frozen=True)
class MachineFile:
    """A machine for G-code."""

    path: Path
    settings: PathSettings
    gcode: GcodeSettings
    pins: PinTiming
    ends: tuple[AxisEnds, ...]
    switches: Switches
    laser: bool = False
    enable_inverted: bool = False
    board: str = ""  # a folder of syn/, or none
    drive: str = ""  # a name of drives.toml, or none
    chip: str = CHIPS[0]  # of the firmware
    kinematics: str = "cartesian"
    spindle: Spindle | None = None
    host: str = HOSTS[0]
    spindle_wait: float = 0  # s that motions wait for the spindle
    spindle_at_speed: int = 0  # P of M66: the input that ends it, or it is an error; 0: the time alone

    @property
    def letters(self) -> str:
        """Of the axes."""
        return self.gcode.axis_letters

    @property
    def motors(self) -> list[str]:
        """Names of the motors, in the order of the core: X, Y, Z, Y2, or X+Y, X-Y, Z."""
        rows, names, count = self.settings.motors.map(len(self.ends)), [], dict.fromkeys(AXIS_LETTERS, 0)
        for row in rows:
            moved = [(self.letters[axis], "-" if part < 0 else "+") for axis, part in enumerate(row) if part]
            name = "".join(sign + letter for letter, sign in moved).removeprefix("+")
            if len(moved) == 1:
                count[name] += 1
                name += str(count[name]) if count[name] > 1 else ""
            names.append(name)
        return names

    @property
    def limited(self) -> list[str]:
        """Names of what has limits: the axes, and the motors that move two of them."""
        axes = len(self.ends)
        return [*self.letters, *np.array(self.motors)[self.settings.motors.mixed_of(axes)].tolist()]

    @property
    def squared(self) -> list[int]:
        """Axes whose motors have a limit switch each, by which they home."""
        return [axis for axis, end in enumerate(self.ends) if self.switches.racking and _squares(end)]

    @property
    def offsets(self) -> list[int]:
        """Of each motor: its edge from that of its axis, nm."""
        found = [0] * len(self.motors)
        for axis in self.squared:
            for motor, offset in zip(self.motors_of(axis), self.ends[axis].offsets, strict=False):
                found[motor] = round(offset * 1_000_000)
        return found

    @property
    def encoders(self) -> dict[int, tuple[float, int]]:
        """Motors with an encoder: its counts per mm, and those of following error that stop the machine."""
        return {
            motor: (counts, round(counts * end.following))
            for axis, end in enumerate(self.ends)
            for motor, counts in zip(self.motors_of(axis), end.encoders, strict=False)
            if counts
        }

    @property
    def encoder_ratios(self) -> dict[int, int]:
        """Counts per step of the same motors, UQ16.16."""
        scales = self.settings.scales
        return {motor: _ratio(counts / scales[motor]) for motor, (counts, _) in self.encoders.items()}

    @property
    def trackers(self) -> dict[int, tuple[int, Fraction, Fraction]]:
        """Motors whose trackers take up backlash: its steps, steps/s, steps/s^2."""
        return {
            motor: _take_up(axis, end)
            for number, (axis, end) in enumerate(zip(self.settings.axes, self.ends, strict=True))
            if end.backlash
            for motor in self.motors_of(number)
        }

    def backlash(self, motor: int) -> int:
        """Steps that the tracker of a motor takes up; 0: none."""
        return self.trackers[motor][0] if motor in self.trackers else 0

    def motors_of(self, axis: int) -> list[int]:
        """The motors that an axis is named after: its own, and those behind the axes."""
        rows = self.settings.motors.map(len(self.ends))
        return [axis, *(motor for motor in range(len(self.ends), len(rows)) if rows[motor][axis])]

    def bits(self, switch: str, axis: int) -> int:
        """The inputs of the core that a switch of an axis is at: a limit is at all of its motors."""
        return sum(1 << motor for motor in (self.motors_of(axis) if switch != "home" else [axis]))

    def mask(self, switch: str) -> int:
        """The inputs of the core with a switch, a bit per motor."""
        return sum(self.bits(switch, axis) for axis, end in enumerate(self.ends) if switch in end.switches)

    @property
    def has_inputs(self) -> bool:
        """Whether there is a switch or a probe."""
        return "inputs" in self.parts

    @property
    def turns(self) -> bool:
        """Whether its spindle is simulated: something tells how fast that is."""
        return self.spindle is not None or self.spindle_at_speed > 0

    @property
    def parts(self) -> tuple[str, ...]:
        """The optional parts of the core that it needs."""
        maximum = self.gcode.spindle_maximum
        return _parts(self.ends, self.switches, maximum, self.spindle is not None, self.spindle_at_speed)

    @property
    def core_axes(self) -> int:
        """Axes of the core: one for each motor, and one whose inputs are the encoder of the spindle."""
        return len(self.motors) + (self.spindle is not None)

    @property
    def clock_hz(self) -> int:
        """Clock of the core."""
        return self.settings.clock_hz


def read_machine(path: Path, takes_up: bool = False) -> MachineFile:
    """Read and check a machine file; raises BadInputError, for backlash too unless the caller takes it up."""
    try:
        text = path.read_text(encoding="utf-8-sig")
        data = tomllib.loads(text, parse_float=Written)
    except OSError as error:
        raise BadInputError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise BadInputError(f"{path}: not a UTF-8 text file") from None
    except tomllib.TOMLDecodeError as error:
        raise BadInputError(f"{path}: {toml_error(text, error)}") from None
    except RecursionError:
        raise BadInputError(f"{path}: nested too deeply") from None
    except (ValueError, ArithmeticError) as error:
        raise BadInputError(f"{path}: {str(error).splitlines()[0]}") from None
    try:
        return _machine(path, data, takes_up)
    except BadValueError as error:
        raise BadInputError(f"{path}: {error}") from None


def _machine(path: Path, data: Table, takes_up: bool) -> MachineFile:
    check_known(data, FILE_KEYS)
    wanted_hz = read_clock_hz(data) if "clock_hz" in data or "board" not in data else None
    pins, enable_inverted = _pins(data)
    tables = read_tables(data, "axis")
    if not 1 <= len(tables) <= len(AXIS_LETTERS):
        raise BadValueError(f"there are {len(tables)} axes; must be 1 to {len(AXIS_LETTERS)}: [[axis]]")
    profile = read_word(data, "profile", PROFILES) if "profile" in data else "linear"
    axes = tuple(
        within(f"axis {number}", lambda table=table: _axis(table)) for number, table in enumerate(tables, 1)
    )
    letters = _letters(tables)
    for number, axis in enumerate(axes, 1):
        if profile == "jerk" and not axis.jerk:
            raise BadValueError(f'axis {number}: profile = "jerk" needs its jerk in mm/s^3')
    ends = tuple(
        within(f"axis {number}", lambda table=table: _ends(table, takes_up))
        for number, table in enumerate(tables, 1)
    )
    kinematics, motors = _motors(data, letters, axes, ends)
    switches = _switches(data)
    _check_squared(axes, ends, switches)
    spindle = read_positive(data, "spindle_maximum") if "spindle_maximum" in data else 0
    wait, at_speed = _waits(data, spindle, ends, len(motors.map(len(axes))))
    has_encoder = "spindle" in data
    parts = _parts(ends, switches, spindle, has_encoder, at_speed)
    count = len(motors.map(len(axes))) + has_encoder
    board, clock_hz = _board(data, wanted_hz, ends, count, parts, at_speed)
    timing = within("pins", lambda: read_pins(pins, clock_hz, (ENABLE_INVERTED,)))
    deviation = _number(data, "junction_deviation", JUNCTION_DEVIATION)
    settings = PathSettings(axes, clock_hz, junction_deviation=deviation, profile=profile, motors=motors)
    check_pins(settings, timing)
    tracking = _Tracking(clock_hz, parameters_for(count).axes, timing)
    for number, (axis, end) in enumerate(zip(axes, ends, strict=True), 1):
        within(f"axis {number}", lambda axis=axis, end=end: _check_encoders(axis, end, clock_hz))
        shared = number - 1 in KINEMATICS[kinematics]
        within(
            f"axis {number}",
            lambda axis=axis, end=end, shared=shared: _check_backlash(axis, end, shared, tracking),
        )
    if switches.soft_limits and not any(end.home for end in ends):
        raise BadValueError("soft_limits: no axis has a home")
    tolerance = _number(data, "arc_tolerance", ARC_TOLERANCE)
    if not tolerance:
        raise BadValueError("arc_tolerance must be greater than 0")
    encoder = within("spindle", lambda: _spindle(data, spindle))
    return MachineFile(
        path,
        settings,
        GcodeSettings(
            len(axes),
            tolerance,
            spindle,
            encoder.counts if encoder else 0,
            letters,
            inputs=1 + len(motors.map(len(axes))) if "inputs" in parts else 0,
            power="outputs" in parts,
        ),
        timing,
        ends,
        switches,
        _flag(data, "laser", False),
        enable_inverted,
        board,
        data.get("drive", ""),
        read_word(data, "chip", CHIPS) if "chip" in data else CHIPS[0],
        kinematics,
        encoder,
        read_word(data, "host", HOSTS) if "host" in data else HOSTS[0],
        wait,
        at_speed,
    )


def _waits(data: Table, maximum: int, ends: Sequence[AxisEnds], motors: int) -> tuple[float, int]:
    """Seconds that motions wait for the spindle, and the input that says that it is at its speed."""
    wait = _number(data, "spindle_wait", 0)
    if wait and not maximum:
        raise BadValueError("spindle_wait: it needs spindle_maximum")
    if wait > SPINDLE_WAIT_MAX:
        raise BadValueError(f"spindle_wait must be at most {SPINDLE_WAIT_MAX} s")
    if "spindle_at_speed" not in data:
        return wait, 0
    at_speed = read_integer(data, "spindle_at_speed", 1, motors)
    if not wait:
        raise BadValueError("spindle_at_speed: it needs spindle_wait, the seconds after which it is an error")
    if at_speed <= len(ends) and "home" in ends[at_speed - 1].switches:
        raise BadValueError(f"spindle_at_speed: input P{at_speed} is the home switch of axis {at_speed}")
    return wait, at_speed


def _spindle(data: Table, maximum: int) -> Spindle | None:
    if "spindle" not in data:
        return None
    table = read_subtable(data, "spindle")
    check_known(table, SPINDLE_KEYS)
    if not maximum:
        raise BadValueError("it needs spindle_maximum")
    counts = read_integer(table, "counts", COUNTS.start, COUNTS.stop - 1)
    start_up, wander = _number(table, "start_up", Spindle.start_up), _number(table, "wander", Spindle.wander)
    if not start_up or wander > WANDER_MAX:
        raise BadValueError(f"start_up must be greater than 0, wander at most {WANDER_MAX} %")
    return Spindle(counts, start_up, wander)


def _squares(end: AxisEnds) -> bool:
    return end.motors > 1 and end.home is not None


def _check_squared(axes: Sequence[PathAxis], ends: Sequence[AxisEnds], switches: Switches) -> None:
    """Each motor of an axis that squares has its own limit switch, and moves off it in any case."""
    if switches.racking and not any(map(_squares, ends)):
        raise BadValueError("home: racking needs an axis with a home and several motors")
    if switches.racking and switches.racking < switches.pull_off:
        raise BadValueError(f"home: racking must be at least pull_off, {switches.pull_off:g} mm")
    for number, (axis, end) in enumerate(zip(axes, ends, strict=True), 1):
        squares = switches.racking and _squares(end)
        if end.offsets and not squares:
            raise BadValueError(f"axis {number}: offsets are of motors that square: home: racking is missing")
        if squares:
            within(f"axis {number}", lambda axis=axis, end=end: _check_gantry(axis, end, switches))


def _check_gantry(axis: PathAxis, end: AxisEnds, switches: Switches) -> None:
    if end.homing_switch == "home":
        raise BadValueError(
            f'{end.motors} motors and one home switch: to square, each has switches = ["limit_{end.home}"]'
        )
    if any(abs(offset) > switches.pull_off for offset in end.offsets):
        raise BadValueError(f"offsets must be at most pull_off, {switches.pull_off:g} mm")
    apart = max(end.offsets, default=0) - min(end.offsets, default=0)
    if apart > switches.racking:
        raise BadValueError(f"offsets are {apart:g} mm apart; must be at most racking, {switches.racking:g}")
    stop = min(switches.speed, float(axis.speed)) ** 2 / 2 / float(axis.acceleration)
    if stop >= switches.racking / 2:
        raise BadValueError(f"home: speed needs {stop:g} mm to stop; must be less than half of racking")


def _motors(
    data: Table, letters: str, axes: Sequence[PathAxis], ends: Sequence[AxisEnds]
) -> tuple[str, Motors]:
    """The kinematics and the map: an axis and its motor in order, then the further motors of the axes."""
    kinematics = read_word(data, "kinematics", tuple(KINEMATICS)) if "kinematics" in data else "cartesian"
    shared, rows = KINEMATICS[kinematics], np.eye(len(axes), dtype=int)
    table = read_subtable(data, "motors")
    within("motors", lambda: check_known(table, MOTOR_KEYS))
    if shared:
        _check_shared(kinematics, shared, letters, axes, ends)
        one, other = shared
        rows[one, other], rows[other, one], rows[other, other] = 1, 1, -1
    elif table:
        raise BadValueError(
            'motors: its limits are those of motors that two axes share: kinematics = "corexy"'
        )
    more = [rows[axis] for axis, end in enumerate(ends) for _ in range(end.motors - 1)]
    if len(axes) + len(more) > len(AXIS_LETTERS):
        raise BadValueError(f"there are {len(axes) + len(more)} motors; must be at most {len(AXIS_LETTERS)}")
    limits = {key: read_number(table, key) if key in table else 0 for key in MOTOR_KEYS}
    for key, value in limits.items():
        if key in table and not value:
            raise BadValueError(f"motors: {key} must be greater than 0")
    if not shared and not more:
        return kinematics, Motors()
    made = tuple(tuple(int(part) for part in row) for row in [*rows, *more])
    return kinematics, Motors(made, PathAxis(0, **limits))


def _check_shared(
    kinematics: str,
    shared: Sequence[int],
    given: str,
    axes: Sequence[PathAxis],
    ends: Sequence[AxisEnds],
) -> None:
    """What contradicts two axes that share two motors."""
    if missing := next((letter for letter in AXIS_LETTERS[: max(shared) + 1] if letter not in given), ""):
        raise BadValueError(f'kinematics = "{kinematics}" needs an axis {missing}')
    one, other = (axes[axis].steps_per_mm for axis in shared)
    letters = " and ".join(AXIS_LETTERS[axis] for axis in shared)
    if one != other:
        raise BadValueError(
            f'kinematics = "{kinematics}": {letters} share their motors, '
            f"but steps_per_mm is {float(one):g} and {float(other):g}"
        )
    for axis in shared:
        if ends[axis].motors > 1:
            raise BadValueError(
                f'axis {axis + 1}: motors is {ends[axis].motors}, but with kinematics = "{kinematics}" '
                f"{letters} share two"
            )
        if limit := next((switch for switch in ends[axis].switches if switch != "home"), None):
            raise BadValueError(
                f"axis {axis + 1}: switches: {limit} would block a motor that also moves another axis: "
                'use "home"'
            )


def _parts(
    ends: Sequence[AxisEnds], switches: Switches, spindle_maximum: int, has_spindle: bool, at_speed: int
) -> tuple[str, ...]:
    needs = {
        "inputs": switches.probe or any(end.switches for end in ends) or at_speed > 0,
        "encoders": has_spindle or any(end.encoders for end in ends),
        "outputs": spindle_maximum > 0,
        "trackers": any(end.backlash for end in ends),
    }
    return tuple(part for part, needed in needs.items() if needed)


def _board(
    data: Table,
    wanted: int | None,
    ends: Sequence[AxisEnds],
    axes: int,
    parts: Sequence[str],
    at_speed: int,
) -> tuple[str, int]:
    """The board, if there is one, and the clock that is wanted, or that of the board with these parts."""
    if "board" not in data:
        return "", wanted or read_clock_hz(data)
    from passo_fpga import boards
    from passo_fpga.pll import PllError
    from passo_fpga.table import BoardError

    need_repository("a board")
    name = read_word(data, "board", tuple(boards.names()))
    try:
        board = boards.board(name)
        parameters = board.parameters(axes, wanted and wanted / 1e6, parts)
    except PllError as error:
        raise BadValueError(f"clock_hz: {error}") from None
    except BoardError as error:
        raise BadValueError(str(error)) from None
    for number, end in enumerate(ends, 1):
        if board.shared and len(end.switches) > 1:
            both = " and ".join(end.switches)
            raise BadValueError(f"axis {number}: switches: the board {name} has one pin for {both}")
        if board.shared and number == at_speed and end.switches:
            both = f"{end.switches[0]} of axis {number}"
            raise BadValueError(f"spindle_at_speed: the board {name} has one pin for P{at_speed} and {both}")
    if wanted not in (None, parameters["CLOCK_HZ"]):
        raise BadValueError(
            f"clock_hz is {wanted}, but the PLL of the board {name} makes {parameters['CLOCK_HZ']}"
        )
    return name, parameters["CLOCK_HZ"]


def _pins(data: Table) -> tuple[Table, bool]:
    """The table [pins] with what the drive needs where it says nothing itself, and the polarity of EN."""
    own = read_subtable(data, "pins")
    if "drive" not in data:
        return own, within("pins", lambda: _flag(own, ENABLE_INVERTED, False))
    drive = drives()[read_word(data, "drive", tuple(drives()))]
    inverted = within("pins", lambda: _flag(own, ENABLE_INVERTED, drive.enable_inverted))
    return {**drive.pins, **own}, inverted


def check_pins(settings: PathSettings, pins: PinTiming) -> None:
    """Raises BadValueError for an axis or a motor that is too fast for the pins, with its highest speed."""
    clock_hz, deviation = settings.clock_hz, float(settings.junction_deviation)
    for number, (_, axis) in enumerate(settings.limits(), 1):
        name = f"axis {number}" if number <= len(settings.axes) else "motors"
        within(name, lambda axis=axis: _check_speed(axis, pins, clock_hz))
        within(name, lambda axis=axis: _check_reversal(axis, deviation, pins, clock_hz))


def _check_speed(axis: PathAxis, pins: PinTiming, clock_hz: int) -> None:
    """Whether the pins can make as many steps as the axis may ask for."""
    clocks = pins.step_high + pins.step_low
    highest = Fraction(clock_hz, clocks) / Fraction(axis.steps_per_mm)
    if axis.speed > highest:
        raise BadValueError(
            f"speed is {float(axis.speed):g}; the pins allow at most {_rounded_down(highest)}: "
            f"step_high and step_low are {clocks} clocks"
        )


def _check_reversal(axis: PathAxis, deviation: float, pins: PinTiming, clock_hz: int) -> None:
    """Whether the steps that come while DIR turns find room: the core has four places, two are for this."""
    seconds = sum(vars(pins).values()) / clock_hz
    scale, acceleration = float(axis.steps_per_mm), float(axis.acceleration)
    fastest = min(float(axis.speed), max(float(axis.jump), math.sqrt(8 * acceleration * deviation)))
    allowed = WAITING_STEPS / scale / seconds - acceleration * seconds / 2
    if fastest > allowed:
        raise BadValueError(
            f"it may reverse at {fastest:.6g} mm/s (jump, junction_deviation), "
            f"the pins allow at most {_rounded_down(Fraction(max(0.0, allowed)))}: "
            f"a step and a change of DIR take {seconds:g} s"
        )


def _rounded_down(value: Fraction) -> str:
    down = Context(prec=6, rounding=ROUND_FLOOR).divide(Decimal(value.numerator), Decimal(value.denominator))
    return f"{down.normalize():f}"


def _flag(table: Table, key: str, default: bool) -> bool:
    return read_flag(table, key) if key in table else default


def _switches(data: Table) -> Switches:
    table, home, default = read_subtable(data, "switches"), read_subtable(data, "home"), Switches()
    within("switches", lambda: check_known(table, SWITCH_KEYS))
    within("home", lambda: check_known(home, (*HOME_KEYS, "racking")))
    speeds = {key: _number(home, key, getattr(default, key)) for key in HOME_KEYS}
    for key, value in speeds.items():
        if not value:
            raise BadValueError(f"home: {key} must be greater than 0")
    return Switches(
        inverted=_flag(table, "inverted", default.inverted),
        debounce=_number(table, "debounce", default.debounce),
        stop=_flag(table, "stop", default.stop),
        probe=_flag(data, "probe", default.probe),
        racking=_number(home, "racking", default.racking),
        soft_limits=_flag(data, "soft_limits", default.soft_limits),
        **speeds,
    )


def _ends(table: Table, takes_up: bool) -> AxisEnds:
    home, switches = table.get("home"), table.get("switches", [])
    if home is not None and home not in HOME_ENDS:
        raise BadValueError(f'home must be "low" or "high", not {shown(home)}')
    if not isinstance(switches, list) or not all(switch in SWITCHES for switch in switches):
        raise BadValueError(f"switches must be an array of {', '.join(SWITCHES)}")
    if twice := next((switch for switch in switches if switches.count(switch) > 1), None):
        raise BadValueError(f"switches has {twice} twice")
    travel = _number(table, "travel", TRAVEL)
    if not travel:
        raise BadValueError("travel must be greater than 0")
    motors = read_integer(table, "motors", 1, MOTORS_MOST) if "motors" in table else 1
    ends = AxisEnds(
        *(travel, home, tuple(switches), motors, _of_motors(table, "offsets", motors)),
        *(_of_motors(table, "encoders", motors), _number(table, "following", 0)),
        *(_number(table, key, 0) for key in BACKLASH_KEYS),
    )
    _check_following(ends)
    if ends.homing_switch not in (None, *switches):
        raise BadValueError(f'home = "{home}" needs "home" or "{ends.homing_switch}" in switches')
    if given := [key for key in BACKLASH_KEYS if key in table and not takes_up]:
        raise BadValueError(f"{given[0]}: only passo run, make and console --grbl take backlash up")
    if ends.take_up and not ends.backlash:
        raise BadValueError("take_up needs backlash")
    return ends


def _of_motors(table: Table, key: str, motors: int) -> tuple[float, ...]:
    given = table.get(key, [])
    if not isinstance(given, list) or len(given) not in (0, motors):
        raise BadValueError(f"{key} must be an array of {motors} numbers, one for each motor")
    return tuple(float(read_signed({key: value}, key)) for value in given)


def _check_following(ends: AxisEnds) -> None:
    """The encoders of its motors have a following error that they can count."""
    if any(counts < 0 for counts in ends.encoders):
        raise BadValueError("encoders must not be negative: swap A and B")
    if ends.encoders and not any(ends.encoders):
        raise BadValueError("encoders: no motor has one")
    if bool(ends.encoders) != bool(ends.following):
        raise BadValueError("encoders and following need each other: counts per mm, and mm")
    for counts in filter(None, ends.encoders):
        limit = counts * ends.following
        if not 1 <= round(limit) <= FOLLOWING_COUNTS:
            raise BadValueError(f"following is {limit:g} counts; must be 1 to {FOLLOWING_COUNTS}")


def _ratio(counts_per_step: float) -> int:
    return round(counts_per_step * RATIO_ONE)


def _check_encoders(axis: PathAxis, ends: AxisEnds, clock_hz: int) -> None:
    """They can be counted at the highest speed."""
    fastest = float(axis.speed) * max(ends.encoders, default=0)
    if fastest > clock_hz / COUNT_CLOCKS:
        raise BadValueError(
            f"encoders make {fastest:g} counts/s at speed; the core can take {clock_hz / COUNT_CLOCKS:g}"
        )
    for counts in filter(None, ends.encoders):
        ratio = counts / float(axis.steps_per_mm)
        if not 1 <= _ratio(ratio) < 1 << 32:
            raise BadValueError(f"encoders: {ratio:g} counts per step cannot be set")


def _take_up(axis: PathAxis, end: AxisEnds) -> tuple[int, Fraction, Fraction]:
    """Steps of the backlash; speed and acceleration of the tracker, steps/s, steps/s^2."""
    scale, speed = Fraction(axis.steps_per_mm), Fraction(axis.speed)
    acceleration = Fraction(end.take_up) if end.take_up else Fraction(axis.acceleration)
    width = Fraction(round(end.backlash * MILLION), MILLION)
    return int(width * scale + Fraction(1, 2)), speed * scale, acceleration * scale


@dataclass(frozen=True)
class _Tracking:
    """What limits trackers."""

    clock_hz: int
    axes: int  # of the core
    pins: PinTiming

    def check(self, steps: int, speed: Fraction, acceleration: Fraction) -> None:
        """As check_track() of passo_grbl_machine.c: both hands, and DIR, which turns meanwhile."""
        check_limits(speed, acceleration, self.axes, self.clock_hz)
        pins, hz = self.pins, self.clock_hz
        fastest = hz / (pins.step_high + pins.step_low)
        take_up = math.sqrt(acceleration * steps)
        if (most := max(fastest - take_up, fastest / 2)) < speed:
            raise BadValueError(f"speed must be at most {most:g} steps/s: the take-up adds to it")
        turn = sum(vars(pins).values())
        if (most := 2 * (hz / turn) ** 2) < acceleration:
            raise BadValueError(f"acceleration must be at most {most:g} steps/s^2: a step while DIR turns")


def _check_backlash(axis: PathAxis, end: AxisEnds, shared: bool, tracking: _Tracking) -> None:
    """The trackers of the core can take it up."""
    if not end.backlash:
        return
    if shared:
        raise BadValueError("backlash: the axis shares its motors with another one")
    steps, speed, acceleration = _take_up(axis, end)
    if not 1 <= steps <= BACKLASH_MAX:
        raise BadValueError(f"backlash is {steps} steps; must be 1 to {BACKLASH_MAX}")
    within("backlash", lambda: tracking.check(steps, speed, acceleration))


def _number(table: Table, key: str, default: float) -> float:
    return float(read_number(table, key)) if key in table else default


def _letters(tables: Sequence[Table]) -> str:
    """A letter for each axis; without a name it is the one that follows."""
    letters = ""
    for number, table in enumerate(tables, 1):
        left = AXIS_LETTERS[AXIS_LETTERS.index(letters[-1]) + 1 :] if letters else AXIS_LETTERS
        allowed = left if letters else left.replace("Y", "").replace("Z", "")
        name = table.get("name", left[:1])
        if not isinstance(name, str) or len(name) != 1 or name not in allowed:
            named = " or ".join(", ".join(f'"{letter}"' for letter in allowed).rsplit(", ", 1))
            raise BadValueError(
                f"axis {number}: name must be {named or 'left out, C is the last one'}, not {shown(name)}: "
                "axes are X, Y, Z, A, B, C in order; "
                "A, B, C may be left out, of X, Y, Z the last ones, or Y"
            )
        letters += name
    return letters


def _axis(table: Table) -> PathAxis:
    check_known(table, AXIS_KEYS)
    limits = {}
    for key in ("steps_per_mm", "speed", "acceleration"):
        limits[key] = read_number(table, key)
        if not limits[key]:
            raise BadValueError(f"{key} must be greater than 0")
    return PathAxis(**limits, **{key: read_number(table, key) for key in ("jerk", "jump") if key in table})
