# SPDX-License-Identifier: MIT
"""Programs of G-code on the interpreter of LinuxCNC, rs274 of Debian.

It prints four decimals of the units in force, so its figures are exact to a few of the last one.
"""

import math
import os
import re
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from passo.failure import Failure
from passo.output import write_text
from passo.toolchain import paths

from benchmarks.gcode_motion import AXES, PLANES, Motion, Outputs, Played, labelled

RS274 = paths.root / ".venv" / "rs274"  # by tools/setup.sh gcode
CALL = re.compile(r" *\d+ N(\S+) +(\w+)\((.*)\)")
INCH = 25.4
SECONDS = 20
TOOLS = 100  # with diameters of as many hundredths of an inch
LOWEST = 0.1 * INCH  # mm/min: it may raise lower feeds of G93
FULL = 1000  # rpm, as in gcode_passo.py
TURNS = {"START_SPINDLE_CLOCKWISE": 1, "START_SPINDLE_COUNTERCLOCKWISE": -1, "STOP_SPINDLE_TURNING": 0}


def play_rs274(program: Sequence[str]) -> Played:
    """The calls that rs274 makes, and the line at which it stops."""
    if not (RS274 / "rs274").exists():
        raise Failure("rs274 is missing: tools/setup.sh gcode")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_text(folder / "part.ngc", "\n".join([*labelled(program), "M2", ""]))
        (folder / "vars").touch()
        write_text(folder / "tools", "".join(f"T{tool} P{tool} D{tool / 100}\n" for tool in range(1, TOOLS)))
        command = [RS274 / "rs274", "-g", "-n", "2", "-v", "vars", "-t", "tools", "part.ngc", "calls"]
        done = subprocess.run(
            command,
            cwd=folder,
            env=os.environ | {"LD_LIBRARY_PATH": str(RS274), "HOME": name},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=SECONDS,
        )
        calls = (folder / "calls").read_text(encoding="utf-8").splitlines()
    said = [line for line in done.stderr.splitlines() if line and line != "executing"]
    if done.returncode == 0:
        return Played(list(_motions(calls)))
    if done.returncode != 1 or not said:
        raise Failure(f"rs274: {done.returncode} {done.stderr}")
    label = re.match(r"N *(\d+)", said[-1]) or re.search(r" line: (\d+)$", said[0])
    if not label:
        raise Failure(f"rs274: {done.stderr}")
    return Played(list(_motions(calls)), int(label[1]), said[0])


def _position(numbers: Sequence[float], scale: float) -> np.ndarray:
    """X Y Z in units, A B C in degrees."""
    return np.array(numbers[:AXES]) * ([scale] * 3 + [1.0] * (AXES - 3))


def _motions(calls: Sequence[str]) -> Iterator[Motion]:
    scale, unit, feed, outputs, plane, tolerance = 1.0, 1.0, 0.0, Outputs(), "XY", 0.0
    speed, highest, per_turn = 0.0, 0.0, False  # S; D of G96, 0 in G97; G95
    pitch, at = 0.0, (0.0,) * AXES  # of G33, 0: none
    offsets = {
        name: np.zeros(AXES) for name in ("SET_G5X_OFFSET", "SET_G92_OFFSET", "USE_TOOL_LENGTH_OFFSET")
    }
    for line in calls:
        if not (call := CALL.match(line)):
            continue
        label, name, text = int(call[1]) if call[1].isdigit() else 0, call[2], call[3]
        numbers = [float(n) for n in re.findall(r"-?\d+\.?\d*", text)] if name != "COMMENT" else []
        origin = np.sum(list(offsets.values()), axis=0)
        if highest and name.startswith("STRAIGHT"):
            around = 2 * math.pi * abs(numbers[0]) * scale
            surface = speed * (304.8 if scale == INCH else 1000)
            outputs = replace(outputs, rpm=min(FULL, highest, surface / around if around else FULL))
        made = Motion(label, outputs=outputs, tolerance=tolerance, unit=unit)
        minutely = pitch * outputs.rpm or (feed * outputs.rpm if per_turn else feed)
        match name:
            case "USE_LENGTH_UNITS":
                scale = INCH if "INCHES" in text else 1.0
                unit = max(unit, scale)
            case "SET_FEED_RATE":
                feed = numbers[0] * scale
            case "SET_NAIVECAM_TOLERANCE":
                tolerance = numbers[0] * scale
            case "SET_MOTION_CONTROL_MODE":  # G61: without the call above
                tolerance = 0.0
            case "SET_FEED_MODE":
                per_turn = numbers[1] > 0
            case "SET_SPINDLE_MODE":
                highest = numbers[1]
                outputs = replace(outputs, rpm=speed)
            case "SELECT_PLANE":
                plane = text[-2:]
            case "SET_G5X_OFFSET":
                offsets[name] = _position(numbers[1:], scale)
            case "SET_G92_OFFSET" | "USE_TOOL_LENGTH_OFFSET":
                offsets[name] = _position(numbers, scale)
            case "START_SPEED_FEED_SYNC":
                pitch = numbers[0] * scale
            case "STOP_SPEED_FEED_SYNCH":
                pitch = 0.0
            case "RIGID_TAP":
                depth = (*(np.array(numbers[:3]) * scale + origin[:3]).tolist(), *at[3:])
                yield from (replace(made, end=end, feed=minutely) for end in (depth, at))
            case "STRAIGHT_TRAVERSE" | "STRAIGHT_FEED" | "STRAIGHT_PROBE":
                at = tuple((_position(numbers, scale) + origin).tolist())
                probes = name == "STRAIGHT_PROBE"
                rapid = name == "STRAIGHT_TRAVERSE"
                yield replace(made, end=at, feed=0 if rapid else minutely, probes=probes)
            case "ARC_FEED":
                axes = PLANES[plane]
                end_of = dict(zip(axes, (numbers[0], numbers[1], numbers[5]), strict=True))
                linear = [end_of[axis] for axis in range(3)]
                at = end = tuple((_position(linear + numbers[6:], scale) + origin).tolist())
                center = tuple(numbers[2 + i] * scale + origin[axes[i]] for i in range(2))
                turns = {"plane": axes, "clockwise": numbers[4] < 0}
                yield replace(made, end=end, feed=minutely, center=center, **turns)
            case "DWELL":
                yield replace(made, dwell=numbers[0])
            case "SET_SPINDLE_SPEED":
                speed = numbers[1]
                outputs = replace(outputs, rpm=speed)
            case "START_SPINDLE_CLOCKWISE" | "START_SPINDLE_COUNTERCLOCKWISE" | "STOP_SPINDLE_TURNING":
                outputs = replace(outputs, turns=TURNS[name])
            case "FLOOD_ON" | "FLOOD_OFF":
                outputs = replace(outputs, flood=name == "FLOOD_ON")
            case "MIST_ON" | "MIST_OFF":
                outputs = replace(outputs, mist=name == "MIST_ON")
            case "SET_MOTION_OUTPUT_VALUE" | "SET_AUX_OUTPUT_VALUE":
                outputs = replace(outputs, analog=numbers[1])
            case "SET_MOTION_OUTPUT_BIT" | "SET_AUX_OUTPUT_BIT":
                outputs = replace(outputs, digital=outputs.digital | 1 << int(numbers[0]))
            case "CLEAR_MOTION_OUTPUT_BIT" | "CLEAR_AUX_OUTPUT_BIT":
                outputs = replace(outputs, digital=outputs.digital & ~(1 << int(numbers[0])))
