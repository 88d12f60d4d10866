# SPDX-License-Identifier: MIT
"""The state of the machine while lines are expanded: Passo's own interpreter, and what of it is known.

Offsets and position of the real machine are not known before the program has set them: work coordinates of an
axis are known from its first absolute motion on, an offset from the line on that sets it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from passo.expand.block import Word
from passo.expand.height_map import HeightMap
from passo.expand.place import LineError, StateError
from passo.expand.surface import share_of_probe
from passo.expand.tools import Tool, lengths
from passo.gcode import LINEAR, NANOMETERS, Gcode, GcodeSettings, set_tool_lengths
from passo.native import planner

INCH = 25.4
RELEASE = 2.9  # of LinuxCNC, whose language this is
# Modal groups of enum passo_gcode_group.
MOTION, SYSTEM, PLANE, UNITS = "MOTION", "SYSTEM", "PLANE", "UNITS"
DISTANCE, FEED_MODE, SPINDLE, RETRACT = "DISTANCE", "FEED_MODE", "SPINDLE", "RETRACT"
SURFACE = "SURFACE"
LINES_AND_ARCS = (0, 10, 20, 30)
CYCLES = (730, 760, *range(810, 900, 10))
RAPID = (1 << 64) - 1
SYSTEMS = {code: code // 10 - 54 for code in range(540, 591, 10)}
PLANES = {170: (0, 1), 180: (2, 0), 190: (1, 2)}
PROBED, HOMES = range(5061, 5071), (*range(5161, 5170), *range(5181, 5190))
SHIFT, SYSTEM_NUMBER, SYSTEM_OFFSETS = range(5210, 5220), 5220, range(5221, 5391)
INPUT, TOOL, POSITIONS = 5399, range(5400, 5414), range(5420, 5429)
XYZABCUVW = "XYZABCUVW"
HIGH, LOW = 3, 4  # L of M66
# Names whose values a machine has, but nobody knows here.
UNKNOWN_NAMES = frozenset(
    ("_speed_override", "_feed_override", "_adaptive_feed", "_feed_hold", "_current_pocket")
)
AXIS_NAMES = {f"_{letter.lower()}": axis for axis, letter in enumerate(XYZABCUVW)}


@cache
def _group(name: str) -> int:
    return int(getattr(planner(), f"PASSO_GCODE_{name}"))


@dataclass(frozen=True)
class Motion:
    """A line or an arc that a line of text asks for, in mm and work coordinates."""

    start: tuple[float, ...]
    end: tuple[float, ...]
    rapid: bool
    center: complex | None  # of an arc, in its plane
    clockwise: bool
    plane: tuple[int, int]

    def flat(self, place: Sequence[float]) -> complex:
        """A place in the plane."""
        return complex(place[self.plane[0]], place[self.plane[1]])


class Machine:
    """Takes plain lines, and tells the values of the predefined parameters."""

    def __init__(self, settings: GcodeSettings, tools: dict[int, Tool], at_zero: bool, begin: Any = None):
        """With `at_zero` the machine is known: at 0, without offsets, or as a `struct passo_gcode`."""
        self.tools, self.at_zero = tools, at_zero
        self.gcode = Gcode(settings)
        if begin is not None:
            self.gcode.c[0] = begin[0]
        set_tool_lengths(self.gcode.c, lengths(tools))
        self.compensation: int = 400
        self.diameters = False  # G7
        self.tool: int | None = int(self.gcode.c.loaded) if at_zero else None
        self.probed: tuple[tuple[float, ...], bool] | None = None  # mm and work coordinates; touched
        self.input: float | None = 0.0 if at_zero else None
        axes = range(settings.axes)
        self._position = [at_zero for _ in axes]
        self._shift = [at_zero for _ in axes]
        self._shifted: bool | None = any(self.gcode.c.shift) if at_zero else None
        self._systems = [[at_zero for _ in axes] for _ in SYSTEMS]
        self._length = at_zero

    @property
    def axes(self) -> int:
        """How many there are."""
        return self.gcode.settings.axes

    @property
    def letters(self) -> str:
        """Of the axes."""
        return self.gcode.settings.axis_letters

    @property
    def inch(self) -> bool:
        """Whether G20 is in force."""
        return self.mode(UNITS) == 200

    @property
    def scale(self) -> float:
        """Millimeters of a unit of length."""
        return INCH if self.inch else 1.0

    @property
    def incremental(self) -> bool:
        """Whether G91 is in force."""
        return self.mode(DISTANCE) == 910

    @property
    def plane(self) -> tuple[int, int]:
        """First and second axis of the plane in force; one that there is not is behind the others."""
        first, second = PLANES[self.mode(PLANE)]
        return self._axis(first), self._axis(second)

    @property
    def work(self) -> tuple[float, ...]:
        """The programmed position in mm and work coordinates; of axes that are not known, from any origin."""
        c, offset = self.gcode.c, planner().passo_gcode_offset
        return tuple((c.position[axis] - offset(c, axis)) / NANOMETERS for axis in range(self.axes))

    def mode(self, group: str) -> int:
        """The command of a modal group in force, in tenths."""
        return int(self.gcode.c.mode[_group(group)])

    @property
    def knows_length(self) -> bool:
        """Whether the tool length in force is known."""
        return self._length

    @property
    def tool_length(self) -> float:
        """In the units in force."""
        return float(self.gcode.c.tool_length / NANOMETERS) / self.scale

    def knows(self, axis: int) -> bool:
        """Whether the work coordinate of an axis is known."""
        return self._position[axis]

    def advance(self, text: str, words: Sequence[Word]) -> None:
        """Execute a plain line, given with its words; raises GcodeError."""
        c, old_system = self.gcode.c, self.mode(SYSTEM)
        self.gcode.execute(text)
        planner().passo_gcode_set_position(c, c.position)  # drops what the line has left to do
        self._learn(words, old_system)

    def execute(self, text: str, words: Sequence[Word]) -> Motion | None:
        """The same; return its motion, if it is a line or an arc."""
        c, before, old_system = self.gcode.c, list(self.gcode.c.position), self.mode(SYSTEM)
        self.gcode.execute(text)
        job = c.job
        moved = job.motion and not job.via and not job.drills and job.probe < 0
        center = complex(job.arc.center.x, job.arc.center.y) if job.turns else None
        rapid, clockwise = job.feed == RAPID, bool(job.arc.clockwise)
        planner().passo_gcode_set_position(c, c.position)
        self._learn(words, old_system)
        if not moved:
            return None
        offsets = [planner().passo_gcode_offset(c, axis) for axis in range(self.axes)]
        start, end = (
            tuple((place[axis] - offsets[axis]) / NANOMETERS for axis in range(self.axes))
            for place in (before, c.position)
        )
        plane = self.plane
        if center is not None:
            center = (center - complex(offsets[plane[0]], offsets[plane[1]])) / NANOMETERS
        return Motion(start, end, rapid, center, clockwise, plane)

    def probe(self, surface: HeightMap, text: str, words: Sequence[Word]) -> tuple[float, ...]:
        """Execute a line with a probe; return where it ends, mm, machine coordinates. Raises LineError."""
        c, begin = self.gcode.c, self.gcode.position
        self.advance(text, words)
        end, command = self.gcode.position, self.mode(MOTION)
        tip = (0, 0, c.tool_length)
        ends = (
            [(at - of_tip) / NANOMETERS for at, of_tip in zip(place, tip, strict=False)]
            for place in (begin, end)
        )
        share = share_of_probe(surface, command, *ends)
        done = 1.0 if share is None else share
        place = [round(a + (b - a) * done) for a, b in zip(begin, end, strict=True)]
        planner().passo_gcode_set_position(c, place)
        self._set(self._position, range(self.axes), True)
        self.probed = self.work, share is not None
        return tuple(at / NANOMETERS for at in place)

    def number(self, index: int) -> float:
        """A numbered parameter beyond the program's own; raises LineError."""
        c = self.gcode.c
        if index in POSITIONS:
            return self._coordinate(self._axis(index - POSITIONS[0]), f"#{index}")
        if index == SYSTEM_NUMBER:
            return float(SYSTEMS[self.mode(SYSTEM)] + 1)
        if index in SYSTEM_OFFSETS:
            system, axis = divmod(index - SYSTEM_OFFSETS[0], 20)
            axis = self._axis(axis)
            if system < len(SYSTEMS) and axis < self.axes and self._systems[system][axis]:
                return float(c.offsets.system[system][axis] / NANOMETERS)
            raise StateError(f"#{index} cannot be known: no G10 L2 before has set this offset")
        if index == SHIFT[0] and self._shifted is not None:
            return float(self._shifted)
        if index in SHIFT:
            axis = self._axis(index - SHIFT[0] - 1)
            if axis < self.axes and self._shift[axis]:
                return float(c.shift[axis] / NANOMETERS)
            raise StateError(f"#{index} cannot be known: no G92.1 is before, or no G92 at a known position")
        if index in TOOL:
            return self._of_tool(index)
        if index in HOMES and self.at_zero:
            home, axis = (0, index - 5161) if index < 5181 else (1, index - 5181)
            axis = self._axis(axis)
            return float(c.offsets.home[home][axis] / NANOMETERS) if axis < self.axes else 0.0
        what = "it is in machine coordinates" if index in HOMES else "only the machine has it"
        if index in PROBED and self.probed:
            place, touched = self.probed
            axis = self._axis(index - PROBED[0])
            scale = self.scale if XYZABCUVW[index - PROBED[0] :][:1] in LINEAR else 1.0
            return float(touched) if index == PROBED[-1] else place[axis] / scale if axis < self.axes else 0.0
        if index in PROBED:
            what = "it is the result of a probe (passo run --surface)"
        elif index == INPUT and self.input is not None:
            return self.input
        elif index == INPUT:
            what = "it is the result of M66 (--inputs)"
        raise LineError(f"#{index} cannot be known while expanding: {what}")

    def name(self, name: str) -> float | None:
        """A predefined named parameter; None: there is none. Raises LineError if it cannot be known."""
        if name in AXIS_NAMES:
            return self._coordinate(self._axis(AXIS_NAMES[name]), f"#<{name}>")
        if name == "_current_tool":
            return self._of_tool(TOOL[0], f"#<{name}>")
        if name in UNKNOWN_NAMES or name.startswith(("_ini[", "_hal[", "_abs_")):
            raise LineError(f"#<{name}> cannot be known while expanding: only the machine has it")
        state = self._state()
        return float(state[name]) if name in state else None

    @staticmethod
    def has_name(name: str) -> bool:
        """Whether a machine has such a parameter that is not known here."""
        return name in AXIS_NAMES or name in UNKNOWN_NAMES or name == "_current_tool"

    def _state(self) -> dict[str, float]:
        c = self.gcode.c
        spindle, system = self.mode(SPINDLE), self.mode(SYSTEM)
        return {
            "_vmajor": RELEASE, "_vminor": 0, "_task": 0,
            "_motion_mode": self.mode(MOTION), "_plane": self.mode(PLANE), "_ccomp": self.compensation,
            "_metric": not self.inch, "_imperial": self.inch,
            "_absolute": not self.incremental, "_incremental": self.incremental,
            "_inverse_time": self.mode(FEED_MODE) == 930,
            "_units_per_minute": self.mode(FEED_MODE) == 940, "_units_per_rev": self.mode(FEED_MODE) == 950,
            "_coord_system": system, "_tool_offset": c.tool_length != 0, "_ijk_absolute_mode": 0,
            "_lathe_diameter_mode": self.diameters, "_lathe_radius_mode": not self.diameters,
            "_spindle_rpm_mode": self.mode(SURFACE) == 970, "_spindle_css_mode": self.mode(SURFACE) == 960,
            "_spindle_on": spindle in (30, 40), "_spindle_cw": spindle == 30,
            "_mist": c.mist, "_flood": c.flood,
            "_feed": c.feed / NANOMETERS / (self.scale if self.mode(FEED_MODE) != 930 else 1.0),
            "_retract_old_z": self.mode(RETRACT) == 980, "_retract_r_plane": self.mode(RETRACT) == 990,
            "_rpm": c.spindle / 1e6, "_selected_tool": c.tool, "_selected_pocket": c.tool, "_remap_level": 0,
        }  # fmt: skip

    def _coordinate(self, axis: int, name: str) -> float:
        if self.compensation != 400:
            raise LineError(f"{name} cannot be read while G41 or G42 is in force: write G40 before")
        if axis >= self.axes:
            return 0.0
        if not self._position[axis]:
            raise StateError(f"{name} cannot be known: no absolute motion of {self.letters[axis]} is before")
        return self.work[axis] / (self.scale if self.letters[axis] in LINEAR else 1.0)

    def _axis(self, letter: int) -> int:
        """The axis of a place in LinuxCNC's order, XYZABCUVW; as many as there are: none."""
        name = XYZABCUVW[letter : letter + 1]
        return self.letters.index(name) if name and name in self.letters else self.axes

    def _read(self, values: dict[str, float]) -> float | None:
        """What M66 finds; an input of a simulation never changes."""
        levels = self.gcode.settings.levels
        if levels is None and not self.at_zero:
            return None
        level, wanted = (levels or 0) >> int(values["P"]) & 1, int(values.get("L", 0))
        return float(level) if wanted in (0, HIGH if level else LOW) else -1.0

    def _of_tool(self, index: int, name: str = "") -> float:
        name = name or f"#{index}"
        if index == 5403 and self._length:
            return self.tool_length
        if 5401 <= index <= 5409 and index != 5403:
            return 0.0
        if self.tool is None or index == 5403:
            what = "G43.1 or G49" if index == 5403 else "M6 or M61"
            raise StateError(f"{name} cannot be known: no {what} is before")
        if index == TOOL[0]:
            return float(self.tool)
        if self.tool == 0:
            return 0.0
        if self.tool not in self.tools:
            raise LineError(f"{name} cannot be known: no tool table has T{self.tool} (--tools)")
        return self.tools[self.tool].diameter / self.scale if index == 5410 else 0.0

    def _learn(self, words: Sequence[Word], old_system: int) -> None:
        """What is known after a line. A probe ends anywhere, so it is not known even if all else is."""
        codes = {word.code for word in words if word.letter == "G"}
        commands = {word.code // 10: word.value for word in words if word.letter == "M"}
        values = {word.letter: word.value for word in words}
        given = [axis for axis in range(self.axes) if self.letters[axis] in values]
        if 6 in commands or 61 in commands:
            self.tool = round(values["Q"]) if 61 in commands and "Q" in values else int(self.gcode.c.tool)
            planner().passo_gcode_load(self.gcode.c, self.tool)
        if 66 in commands:
            self.input = self._read(values)
        if any(380 <= code < 390 for code in codes) or (380 <= self.mode(MOTION) < 390 and given):
            self._set(self._position, given, False)
        knew_length = self._length
        if codes & {431, 430, 432, 490}:
            tool = round(values["H"]) if "H" in values else self.tool
            known = not codes & {430, 432} or tool in self.tools or tool == 0
            self._length = known and (self._length or 432 not in codes)
        if self.at_zero:
            self._shifted = self._shifted or 920 in codes
            return
        system = SYSTEMS[self.mode(SYSTEM)]
        if self.mode(SYSTEM) != old_system:
            old = self._systems[SYSTEMS[old_system]]
            for axis in range(self.axes):
                self._position[axis] &= old[axis] and self._systems[system][axis]
        if codes & {431, 430, 432, 490} and "Z" in self.letters:
            self._position[self.letters.index("Z")] &= knew_length
        if 100 in codes:
            self._learn_offsets(values, given, system)
        elif 920 in codes:
            for axis in given:
                self._shift[axis], self._position[axis] = self._position[axis] and self._shift[axis], True
            self._shifted = True
        elif 921 in codes:
            self._position = [a and b for a, b in zip(self._position, self._shift, strict=True)]
            self._shift, self._shifted = [True] * self.axes, False
        elif codes & {280, 300}:
            self._set(self._position, given or range(self.axes), False)
        elif 530 in codes:
            self._set(self._position, given, False)
        elif not codes & {281, 301} and not self.incremental and self.mode(MOTION) in LINES_AND_ARCS:
            self._set(self._position, given, True)
        elif self.mode(MOTION) in CYCLES and not self.incremental:
            self._set(self._position, [axis for axis in given if axis in self.plane], True)

    def _learn_offsets(self, values: dict[str, float], given: list[int], active: int) -> None:
        number = round(values.get("P", 0))
        system = number - 1 if number else active
        for axis in given:
            known = self._systems[system][axis]
            if values.get("L") == 20:
                self._systems[system][axis] = False
                if system == active:
                    self._position[axis] = True
            else:
                self._systems[system][axis] = True
                if system == active:
                    self._position[axis] &= known

    @staticmethod
    def _set(flags: list[bool], axes: Sequence[int], known: bool) -> None:
        for axis in axes:
            flags[axis] = known
