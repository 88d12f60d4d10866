# SPDX-License-Identifier: MIT
"""Files of LinuxCNC for a machine with `host = "linuxcnc"`: INI, and HAL of linux/linuxcnc/."""

import math
from collections.abc import Iterator

from passo.failure import BadInputError
from passo.machine_file import MachineFile

INI, HAL, TOOLS = "machine.ini", "machine.hal", "tool.tbl"
NANOSECONDS = 1e9
PERIOD_NS = 1_000_000
HEADROOM = 1.25  # of the commands over the limits of LinuxCNC
STOP = 4  # times the acceleration that an axis bears when the computer is late, unless the user knows better
LAG = 10  # periods, beside those in which an axis stops; FERROR is above
FERROR_LEAST = 1.0  # mm
BEYOND = 1.0  # mm that a soft limit is behind the travel
INPUTS = ("limit_low", "limit_high", "home", "alarm")  # of an axis, in the order of the component
LEVELS = {
    "spindle-on": ("spindle.0.on", 0),
    "spindle-reverse": ("spindle.0.reverse", 1),
    "flood": ("iocontrol.0.coolant-flood", 2),
    "mist": ("iocontrol.0.coolant-mist", 3),
}
ROTARY = "ABC"
AT_SPEED = 1.05  # of the wanted speed, either way


def linuxcnc_files(machine: MachineFile) -> dict[str, list[str]]:
    """The lines of each file. Raises BadInputError for a machine that the component does not drive."""
    if machine.trackers:
        raise BadInputError(f"{machine.path}: backlash: LinuxCNC has its own, BACKLASH in {INI}")
    if machine.settings.motors.rows:
        raise BadInputError(
            f"{machine.path}: the motors are {', '.join(machine.motors)}; "
            "LinuxCNC drives one for each axis: leave kinematics and motors out"
        )
    return {
        INI: list(_ini(machine)),
        HAL: list(_hal(machine)),
        TOOLS: [f"; tools of {machine.path.stem}"],
    }


def _number(value: float) -> str:
    return f"{value:.10g}"


def _ini(machine: MachineFile) -> Iterator[str]:
    fastest = max(float(axis.speed) for axis in machine.settings.axes)
    yield f"# {machine.path.name} behind LinuxCNC; docs/hosts.md"
    yield from ("[EMC]", f"MACHINE = {machine.path.stem}", "VERSION = 1.1", "[DISPLAY]", "DISPLAY = axis")
    if machine.letters == "XZ":
        yield "LATHE = 1"
    yield from ("[TASK]", "TASK = milltask", "CYCLE_TIME = 0.005")
    yield from ("[RS274NGC]", "PARAMETER_FILE = machine.var")
    yield from ("[EMCMOT]", "EMCMOT = motmod", "COMM_TIMEOUT = 4.0", f"SERVO_PERIOD = {PERIOD_NS}")
    yield from ("[EMCIO]", "EMCIO = io", "CYCLE_TIME = 0.1", f"TOOL_TABLE = {TOOLS}")
    yield from ("[HAL]", f"HALFILE = {HAL}", "[PASSO]", "DEVICE = /dev/spidev0.0")
    yield from ("[TRAJ]", f"COORDINATES = {machine.letters}", "LINEAR_UNITS = mm", "ANGULAR_UNITS = degree")
    yield f"MAX_LINEAR_VELOCITY = {_number(fastest)}"
    yield f"DEFAULT_LINEAR_VELOCITY = {_number(fastest / 3)}"
    yield from ("[KINS]", f"KINEMATICS = trivkins coordinates={machine.letters}")
    yield f"JOINTS = {len(machine.ends)}"
    for joint in range(len(machine.ends)):
        yield from _joint(machine, joint)


def _stop(machine: MachineFile) -> float:
    """Seconds in which the axis that needs the longest stops."""
    return max(float(axis.speed / axis.acceleration) / STOP for axis in machine.settings.axes)


def _joint(machine: MachineFile, joint: int) -> Iterator[str]:
    axis, end, shared = machine.settings.axes[joint], machine.ends[joint], machine.switches
    letter, speed, acceleration = machine.letters[joint], float(axis.speed), float(axis.acceleration)
    limits = (
        f"MIN_LIMIT = {_number(-BEYOND)}",
        f"MAX_LIMIT = {_number(end.travel + BEYOND)}",
        f"MAX_VELOCITY = {_number(speed)}",
        f"MAX_ACCELERATION = {_number(acceleration)}",
    )
    yield from (f"[AXIS_{letter}]", *limits, f"[JOINT_{joint}]")
    yield f"TYPE = {'ANGULAR' if letter in ROTARY else 'LINEAR'}"
    yield from limits
    yield f"SCALE = {_number(float(axis.steps_per_mm))}"
    yield f"STEPGEN_MAXVEL = {_number(speed)}"
    yield f"STEPGEN_MAXACCEL = {_number(HEADROOM * acceleration)}"
    yield "# what the axis bears beyond that when the computer is late; more shortens the lag"
    yield f"STEPGEN_STOPACCEL = {_number(STOP * acceleration)}"
    lag = PERIOD_NS / NANOSECONDS * LAG + _stop(machine) / 2
    ferror = max(FERROR_LEAST, math.ceil(HEADROOM * lag * speed))
    yield "# above the lag times the highest speed"
    yield from (f"FERROR = {_number(ferror)}", f"MIN_FERROR = {_number(ferror)}")
    if end.home is None:
        yield from ("HOME = 0", "HOME_OFFSET = 0", "HOME_SEQUENCE = 0")
        return
    sign, at = (1, end.travel) if end.home == "high" else (-1, 0.0)
    yield f"HOME = {_number(at - sign * shared.pull_off)}"
    yield f"HOME_OFFSET = {_number(at)}"
    yield f"HOME_SEARCH_VEL = {_number(sign * min(shared.seek, speed))}"
    yield f"HOME_LATCH_VEL = {_number(sign * min(shared.speed, speed))}"
    if end.homing_switch != "home":
        yield "HOME_IGNORE_LIMITS = YES"
    yield "HOME_SEQUENCE = 0"


def _hal(machine: MachineFile) -> Iterator[str]:
    joints, motors = range(len(machine.ends)), len(machine.motors)
    has_spindle = machine.gcode.spindle_maximum > 0
    encoders = sorted({*machine.encoders, *([motors] if machine.spindle else [])})
    given = f" encoders={','.join(map(str, encoders))}" if encoders else ""
    given += "" if machine.has_inputs else " watchdog_ms=0"
    yield f"# {machine.path.name} behind LinuxCNC; docs/hosts.md"
    yield "loadrt [KINS]KINEMATICS"
    yield "loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS"
    yield f"loadrt passo device=[PASSO]DEVICE axes=[KINS]JOINTS{given}"
    if has_spindle:
        yield "loadrt scale names=power"
    compares = machine.spindle is not None and not machine.spindle_at_speed
    if compares:
        yield "loadrt near names=at-speed"
    functions = ["passo.0.read", "motion-command-handler", "motion-controller"]
    functions += ["power"] * has_spindle + ["at-speed"] * compares
    yield from ("", *(f"addf {name} servo-thread" for name in (*functions, "passo.0.write")), "")
    for joint in joints:
        yield from _stepgen(machine, joint)
    yield "net fault passo.0.fault => " + " ".join(f"joint.{joint}.amp-fault-in" for joint in joints)
    yield from _inputs(machine)
    if has_spindle:
        yield from _spindle(machine)
    for motor, (counts, _) in machine.encoders.items():
        yield f"setp passo.0.encoder.{motor:02}.scale {_number(counts)}"
    yield ""
    yield "net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in"
    yield "net tool-prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared"
    yield "net tool-change iocontrol.0.tool-change => iocontrol.0.tool-changed"


def _stepgen(machine: MachineFile, joint: int) -> Iterator[str]:
    name, letter, pins = f"passo.0.stepgen.{joint:02}", machine.letters[joint].lower(), machine.pins
    for parameter, key in (
        ("position-scale", "SCALE"),
        ("maxvel", "STEPGEN_MAXVEL"),
        ("maxaccel", "STEPGEN_MAXACCEL"),
        ("stopaccel", "STEPGEN_STOPACCEL"),
    ):
        yield f"setp {name}.{parameter} [JOINT_{joint}]{key}"
    times = {
        "steplen": pins.step_high,
        "stepspace": pins.step_low,
        "dirsetup": pins.dir_setup,
        "dirhold": pins.dir_hold,
    }
    for parameter, clocks in times.items():
        yield f"setp {name}.{parameter} {math.floor(clocks * NANOSECONDS / machine.clock_hz)}"
    if machine.enable_inverted:
        yield f"setp {name}.enable-invert 1"
    if machine.switches.inverted:
        yield from (f"setp {name}.{switch}-invert 1" for switch in ("home", "limit"))
    yield f"net {letter}-cmd joint.{joint}.motor-pos-cmd => {name}.position-cmd"
    yield f"net {letter}-fb {name}.position-fb => joint.{joint}.motor-pos-fb"
    yield f"net {letter}-on joint.{joint}.amp-enable-out => {name}.enable"
    yield ""


def _inputs(machine: MachineFile) -> Iterator[str]:
    """Four of each axis, then the probe."""
    pins = {"home": "home-sw-in", "limit_low": "neg-lim-sw-in", "limit_high": "pos-lim-sw-in"}
    for joint, end in enumerate(machine.ends):
        for switch in end.switches:
            to = [f"joint.{joint}.{pins[switch]}"]
            if switch == end.homing_switch != "home":
                to.append(f"joint.{joint}.home-sw-in")
            number = joint * len(INPUTS) + INPUTS.index(switch)
            name = f"{machine.letters[joint].lower()}-{switch.replace('_', '-')}"
            yield f"net {name} passo.0.gpio.{number:03}.in => {' '.join(to)}"
    if machine.switches.probe:
        yield f"net probe passo.0.gpio.{len(machine.ends) * len(INPUTS):03}.in => motion.probe-input"


def _spindle(machine: MachineFile) -> Iterator[str]:
    yield ""
    for name, (pin, number) in LEVELS.items():
        if not (machine.laser and name == "spindle-reverse"):
            yield f"net {name} {pin} => passo.0.output.{number:02}"
    yield f"setp power.gain {_number(1 / machine.gcode.spindle_maximum)}"
    yield "net spindle-speed spindle.0.speed-out-abs => power.in"
    yield "net spindle-power power.out => passo.0.power"
    if machine.spindle_at_speed:
        number = (machine.spindle_at_speed - 1) * len(INPUTS) + INPUTS.index("home")
        yield f"net spindle-ready passo.0.gpio.{number:03}.in => spindle.0.at-speed"
    elif machine.spindle is None:
        yield "setp spindle.0.at-speed 1"
    if machine.spindle is None:
        return
    encoder = f"passo.0.encoder.{len(machine.motors):02}"
    yield f"setp {encoder}.scale {machine.spindle.counts}"
    yield f"net spindle-revs {encoder}.position => spindle.0.revs"
    yield f"net spindle-index spindle.0.index-enable <=> {encoder}.index-enable"
    if machine.spindle_at_speed:
        yield f"net spindle-turns {encoder}.velocity => spindle.0.speed-in"
        return
    yield f"net spindle-turns {encoder}.velocity => spindle.0.speed-in at-speed.in1"
    yield "net spindle-wanted spindle.0.speed-out-rps => at-speed.in2"
    yield f"setp at-speed.scale {_number(AT_SPEED)}"
    yield "net spindle-ready at-speed.out => spindle.0.at-speed"
