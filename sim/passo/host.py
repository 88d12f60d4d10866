# SPDX-License-Identifier: MIT
"""One channel of the core at register level. Programs normally use passo.driver."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from passo import frame
from passo import registers as r
from passo.build import Parameters
from passo.link import Link
from passo.moves import PinTiming
from passo.registers import Cause, State

RATE_ONE = 1 << 16


class HostError(Exception):
    """The core is not the expected one."""


def load_table(link: Link, bank: int, points: Sequence[int]) -> None:
    """Load a table into a bank (from 1); no motion may be prepared or running."""
    address = getattr(r, f"ADDRESS_{r.Shape(bank).name}_BASE")
    for k in range(0, len(points), frame.PAYLOAD_MAX):
        link.write(address + k, *points[k : k + frame.PAYLOAD_MAX])


def read_parameters(link: Link) -> Parameters:
    """What a core says of itself. Raises HostError if it is none of Passo's, LinkError."""
    identification, _, word = link.read(r.ADDRESS_IDENTIFICATION, 3)
    if identification != r.IDENTIFICATION_RESET:
        raise HostError(f"no Passo core: it identifies itself as 0x{identification:08X}")
    clock_hz, build = link.read(r.ADDRESS_CLOCK, 2)
    built = {name: int(value) for name, value in asdict(r.ParametersWord.unpack(word)).items()}
    return Parameters(**built, clock_hz=clock_hz, build=build)


@dataclass(frozen=True)
class ChannelState:
    """The STATE register."""

    state: State
    cause: Cause
    quiet: bool
    stopping: bool
    overrun: int
    drained: int


class Channel:
    """One channel with its coordinated axes. Methods raise LinkError."""

    def __init__(self, link: Link, parameters: Parameters, number: int = 0):
        self.link, self.parameters, self.number = link, parameters, number
        self.base = r.ADDRESS_CHANNEL_BASE + number * r.ADDRESS_CHANNEL_STRIDE
        actual = read_parameters(link)
        if actual != parameters:
            raise HostError(f"the core has {actual}; expected {parameters}")

    def axis_base(self, axis: int) -> int:
        """Word address of the registers of an axis."""
        return self.base + r.CHANNEL_AXIS_BASE + axis * r.CHANNEL_AXIS_STRIDE

    def configure_axis(self, axis: int, pins: PinTiming, flags: int = 0) -> None:
        """Set the pins of an axis and enable its drive; `flags` is the value of its PINS register."""
        address = self.axis_base(axis)
        self.link.write(
            address, flags, pins.step_high << 16 | pins.step_low, pins.dir_setup << 16 | pins.dir_hold
        )
        self.link.write(address + r.AXIS_ENABLE, 1)

    def configure_motion(self, rate_slew: int, stop_slew: int, drain_velocity: int) -> None:
        """Set the slew rates of hold and stop (UQ1.16 per tick) and the drain velocity (UQ0.32)."""
        self.link.write(self.base + r.CHANNEL_RATE_SLEW, rate_slew, stop_slew, drain_velocity)

    def room(self) -> tuple[int, int]:
        """Free queue entries: lines, ramps."""
        (word,) = self.link.read(self.base + r.CHANNEL_ROOM, 1)
        return word >> r.CHANNEL_ROOM_LINE_ROOM_LSB, word & 0xFFFF

    def push_lines(self, lines: Sequence[Any], outputs: Sequence[r.LineOutputWord] = ()) -> None:
        """Queue lines (`struct passo_line`), with OUTPUTS each with its output; there must be room."""
        axes = self.parameters.lined
        self.push_line_words([frame.line_words(line, axes) for line in lines], outputs)

    def push_line_words(
        self, lines: Sequence[Sequence[int]], outputs: Sequence[r.LineOutputWord] = ()
    ) -> None:
        """Queue lines as words; outputs that are not given are 0."""
        words = [[output.pack()] for output in outputs]
        words += [[0] * self.parameters.outputs] * (len(lines) - len(words))
        self._push(r.CHANNEL_LINE, [[*line, *output] for line, output in zip(lines, words, strict=True)])

    def push_ramps(self, ramps: Sequence[Any]) -> None:
        """Queue ramps (`struct passo_ramp`); there must be room for them."""
        self._push(r.CHANNEL_RAMP, [frame.ramp_words(ramp) for ramp in ramps])

    def start(self) -> None:
        """Let the channel start motions."""
        self.link.write(r.ADDRESS_RUN, 1 << self.number)

    def set_rate(self, rate: int) -> None:
        """Set the target of the time scale: 0 is a feed hold, RATE_ONE full speed."""
        self.link.write(self.base + r.CHANNEL_RATE_TARGET, rate)

    def stop(self) -> None:
        """Soft stop."""
        self.link.write(self.base + r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_STOP_LSB)

    def abort(self) -> None:
        """Hard stop."""
        self.link.write(self.base + r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_ABORT_LSB)

    def clear(self) -> None:
        """Leave the stopped state."""
        self.link.write(self.base + r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_CLEAR_LSB)

    def positions(self) -> list[int]:
        """Steps made by each axis, all sampled at the same time."""
        words = self.link.read(self.base + r.CHANNEL_POSITION_BASE, self.parameters.axes)
        return [word - (word >> 31 << 32) for word in words]

    def state(self) -> ChannelState:
        """Read the STATE register."""
        (word,) = self.link.read(self.base + r.CHANNEL_STATE, 1)
        return ChannelState(**asdict(r.ChannelStateWord.unpack(word)))

    def _push(self, register: int, items: list[list[int]]) -> None:
        """Send complete items, as many per frame as fit."""
        per_frame = frame.PAYLOAD_MAX // len(items[0]) if items else 1
        for i in range(0, len(items), per_frame):
            words = [word for item in items[i : i + per_frame] for word in item]
            self.link.push(self.base + register, words)
