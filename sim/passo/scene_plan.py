# SPDX-License-Identifier: MIT
"""Plan of a move file with a machine: its motions, and the outputs during them."""

from typing import Any

from passo.build import Parameters
from passo.move_forms import UNIT_Q32, MachineOutput
from passo.moves import Channels, MoveFile, MoveFileError, Task, q32
from passo.plan import Plan, check_tables, plan_moves
from passo.registers import LineOutputWord
from passo.scene_run import Section
from passo.setup import Setup

POWER_FULL = 65535  # on all the time
REFERENCE_ANY = 1 << 31  # 1/2 substep per clock, the fastest


def scene_parameters(channels: Channels) -> Parameters:
    """Parameters of the core used for a file with a machine."""
    setup = channels.setup
    assert setup
    return Parameters(
        axes=setup.core_axes,
        inputs=1,
        encoders=1,
        outputs=1,
        raster=1,
        compare=1,
        trackers=int(bool(setup.trackers or setup.settings.tracked)),
        tracked=setup.core_axes - setup.lined if setup.settings.tracked else 0,
    )


def plan_sections(file: MoveFile, setup: Setup, parameters: Parameters) -> list[Section]:
    """The moves of a file as sections; raises MoveFileError."""
    sections: list[Section] = []
    for index, move in enumerate(file.moves):
        if isinstance(move, Task) or not sections or sections[-1].kind != "moves":
            sections.append(Section([], [], []))
        sections[-1].numbers.append(file.number(index))
        sections[-1].moves.append(move)
    for section in sections:
        if section.kind == "moves":
            own = MoveFile(
                file.path,
                file.clock_hz,
                file.pins,
                tuple(section.moves),
                file.channel,
                tuple(section.numbers),
            )
            section.plans = plan_moves(own, parameters)
    numbered = [
        pair for section in sections if section.plans
        for pair in zip(section.numbers, section.plans, strict=True)
    ]  # fmt: skip
    check_tables(numbered, file.path)
    _Outputs(file, setup, sections)
    return sections


def reference_of(setup: Setup, sections: list[Section]) -> int:
    """The velocity, UQ0.32 substeps per clock, at which a power in proportion is that of its line."""
    peaks = [
        _peak(plan)
        for section in sections if section.plans
        for number, plan in zip(section.numbers, section.plans, strict=True)
        if (output := setup.outputs[number - 1]) and output.speed
    ]  # fmt: skip
    return max(peaks, default=REFERENCE_ANY)


def _peak(plan: Plan) -> int:
    """The greatest velocity of a plan, UQ0.32, rounded up."""
    return -(-plan.c.velocity_peak >> 16)


class _Outputs:
    """Gives the lines their output words, and the sections their raster."""

    def __init__(self, file: MoveFile, setup: Setup, sections: list[Section]):
        self.file, self.reference = file, reference_of(setup, sections)
        for section in sections:
            for number, plan in zip(section.numbers, section.plans, strict=False):
                if output := setup.outputs[number - 1]:
                    self.number = number
                    self._give(section, plan, output)

    def _error(self, text: str) -> MoveFileError:
        return MoveFileError(f"{self.file.path}: move {self.number}: output: {text}")

    def _give(self, section: Section, plan: Plan, output: MachineOutput) -> None:
        power = round(output.power * POWER_FULL / 100)
        if output.speed:
            power = self._scaled(plan, output, power)
        if output.raster is not None:
            self._raster(section, plan, output)
        word = LineOutputWord(
            power=power,
            levels=output.levels,
            proportional=output.speed is not None,
            raster=output.raster is not None,
        )
        plan.line.output = word.pack()

    def _scaled(self, plan: Plan, output: MachineOutput, power: int) -> int:
        """The power at the reference, which all moves share, while each has its own velocity at a speed."""
        assert output.speed
        wanted = -(-q32(output.speed) * plan.c.oversampling // self.file.clock_hz)
        if wanted < _peak(plan):
            reached = _peak(plan) * self.file.clock_hz / plan.c.oversampling / UNIT_Q32
            raise self._error(f"speed is below the {reached:.6g} steps/s that the move reaches")
        scaled = power * self.reference // wanted
        if scaled > POWER_FULL:
            raise self._error(
                f"power {float(output.power):g} at speed {float(output.speed):g} is out of reach "
                "beside a move whose own is much faster"
            )
        return scaled

    def _raster(self, section: Section, plan: Plan, output: MachineOutput) -> None:
        """Its values, each line with as many as it takes; a line begins with a whole word."""
        assert output.raster is not None
        pitch = output.pitch * plan.c.oversampling
        if section.pitch not in (0, pitch):
            raise self._error("pitch differs from the previous raster, in substeps")
        section.pitch = pitch
        taken = -(-plan.line.substeps // pitch)
        if len(output.raster) > taken:
            raise self._error(f"raster has {len(output.raster)} values; the move takes {taken}")
        section.raster.append(bytes(output.raster) + bytes(taken - len(output.raster)))


class Raster:
    """The values that a section has still to send."""

    def __init__(self, section: Section, driver: Any):
        self.lines, self.driver = [list(line) for line in section.raster], driver
        if section.pitch:
            driver.call("set_pitch", section.pitch)

    def feed(self) -> None:
        """Send as many as the core takes; after a stop none."""
        while self.lines:
            taken = self.driver.push_raster(self.lines[0])
            if not taken:
                return
            self.lines[0] = self.lines[0][taken:]
            if not self.lines[0]:
                self.lines.pop(0)
