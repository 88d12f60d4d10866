# SPDX-License-Identifier: MIT
"""Every register of spec/passo.rdl answers, in model and RTL, as its fields say; nothing else does.

What is refused beside undefined bits is written here once more, by hand: RTL and model have one table.
"""

from collections.abc import Iterator
from dataclasses import replace

import pytest
from passo import registers as r
from passo.build import Parameters
from passo.engine import model_engine, rtl_engine
from passo.link import Link, RefusedError
from passo.pair_engine import PairEngine
from passo.register_table import Register
from passo.registers import State, Verdict

WORDS = 1 << r.HEADER_ADDRESS_BITS
PARTS = {"inputs": 1, "encoders": 1, "outputs": 1, "raster": 1, "compare": 1, "trackers": 1}
# Each part alone, as other tests have compiled it; what is there once per channel, in the core of two.
CORES = [
    Parameters(),
    Parameters(axes=3, inputs=1),
    Parameters(outputs=1),
    Parameters(outputs=1, raster=1),
    Parameters(outputs=1, compare=1),
    Parameters(encoders=1),
    Parameters(channels=2, axes=3, **PARTS),
]

# Greatest values where they are not all bits of the fields, and registers that do not take 0.
GREATEST = {
    **dict.fromkeys(("CHANNEL_RATE_TARGET", "CHANNEL_RATE_SLEW", "CHANNEL_STOP_SLEW"), 1 << 16),
    "CHANNEL_PWM_STEP": 1 << 23,
    **dict.fromkeys(("CHANNEL_DRAIN_VELOCITY", "CHANNEL_POWER_REFERENCE", "CHANNEL_FOLLOW_LIMIT"), 1 << 31),
}
NOT_0 = {
    *("CHANNEL_DRAIN_VELOCITY", "CHANNEL_PWM_STEP", "CHANNEL_POWER_REFERENCE", "CHANNEL_RASTER_PITCH"),
    *("CHANNEL_COMPARE_INTERVAL", "CHANNEL_FOLLOW_LIMIT", "ENCODER_RATIO", "ENCODER_LIMIT"),
}
# Registers that are not written while a motion runs, and bits of COMMAND; shape tables are not, either.
QUIET = {
    *("AXIS_PINS", "AXIS_INPUTS", "CHANNEL_FOLLOW", "CHANNEL_OUTPUT_LEVELS", "CHANNEL_OUTPUT_LAG"),
    *("CHANNEL_COMPARE_PULSE", "CHANNEL_COMPARE_DISTANCE", "COSINE", "SIGMOID", "EASE"),
    "AXIS_TRACKER_ACCELERATION",
}
QUIET_COMMANDS = 1 << r.CHANNEL_COMMAND_CLEAR_LSB, 1 << r.CHANNEL_COMMAND_ZERO_LSB


# Words of a block, first and last, that belong to a part.
PLACES = {
    "CORE": {(0x10, 0x1F): "inputs", (0x20, 0x2F): "encoders", (0x30, 0x3F): "outputs"},
    "CHANNEL": {
        **{(0x10, 0x1F): "inputs", (0x22, 0x22): "raster", (0x34, 0x34): "raster", (0x35, 0x37): "compare"},
        **{(0x30, 0x33): "outputs", (0x38, 0x3F): "outputs"},
        **{(0x48, 0x4F): "inputs", (0x50, 0x63): "encoders", (0x64, 0x7F): "trackers"},
    },
    "AXIS": {(5, 5): "inputs", (6, 7): "trackers"},
    "ENCODER": {(0, 7): "encoders"},
}


def part_of(register: Register) -> str:
    """The part to which a register belongs; "" if to none."""
    return next(
        (part for (first, last), part in PLACES[register.block].items() if first <= register.word <= last), ""
    )


def every_register(parameters: Parameters) -> Iterator[tuple[int, Register]]:
    """Address and register of all words of a core. An array in a channel has a word for each axis."""
    channels = [r.ADDRESS_CHANNEL_BASE + n * r.ADDRESS_CHANNEL_STRIDE for n in range(parameters.channels)]
    places = [r.CHANNEL_AXIS_BASE + n * r.CHANNEL_AXIS_STRIDE for n in range(parameters.axes)]
    axes = [channel + place for channel in channels for place in places]
    encoders = [base - r.CHANNEL_AXIS_BASE + r.CHANNEL_ENCODER_BASE for base in axes]
    bases = {"CORE": [0], "CHANNEL": channels, "AXIS": axes, "ENCODER": encoders}
    for register in r.TABLE:
        part = part_of(register)
        if part and not getattr(parameters, part):
            continue
        per_axis = register.block == "CHANNEL" and register.count > 1
        for base in bases[register.block]:
            for n in range(parameters.axes if per_axis else register.count):
                yield base + register.word + n, register


class Core:
    """A core of which every access has a verdict."""

    def __init__(self, link: Link, parameters: Parameters) -> None:
        self.link, self.parameters = link, parameters
        self.table = dict(every_register(parameters))
        # what is pushed: a line, a ramp, values
        self.items = {
            "CHANNEL_LINE": [1, 9, *[9] * parameters.axes, *[0] * parameters.outputs],
            "CHANNEL_RAMP": [1, 0, 1, 0, 1],
            "CHANNEL_RASTER": [0x12345678],
        }
        directions = (1 << parameters.axes) - 1 << r.LINE_CONTROL_DIRECTIONS_LSB
        raster = (1 - parameters.raster) << r.LINE_OUTPUT_RASTER_LSB
        # the bits of their words, where not all are
        self.bits = {
            "CHANNEL_LINE": [
                directions | (1 << r.LINE_CONTROL_DIRECTIONS_LSB) - 1 & r.LINE_CONTROL_DEFINED,
                *[(1 << 30) - 1] * (1 + parameters.axes),
                *[r.LINE_OUTPUT_DEFINED & ~raster] * parameters.outputs,
            ],
            "CHANNEL_RAMP": [r.RAMP_CONTROL_DEFINED, *[0xFFFFFFFF] * 2, 0xFFFF, 0xFFFFFFFF],
        }
        self.registers = [
            (address, register) for address, register in self.table.items() if register.name not in self.items
        ]

    def read(self, address: int) -> tuple[Verdict, int]:
        """Verdict and word."""
        try:
            return Verdict.OK, self.link.read(address, 1)[0]
        except RefusedError as error:
            return error.verdict, 0

    def write(self, address: int, word: int) -> Verdict:
        """The verdict."""
        try:
            self.link.write(address, word)
        except RefusedError as error:
            return error.verdict
        return Verdict.OK

    def push(self, address: int, *words: int) -> Verdict:
        """The verdict."""
        try:
            self.link.push(address, words)
        except RefusedError as error:
            return error.verdict
        return Verdict.OK

    def taken(self, register: Register) -> int:
        """The bits that may be 1 alone: only those of existing channels and axes.

        A trigger cannot be armed without a source.
        """
        if register.name == "CHANNEL_TRIGGER":
            return register.defined & ~(1 << r.CHANNEL_TRIGGER_ARM_LSB)
        if register.name == "CHANNEL_COMPARE_PULSE":
            axes = sum(bit for bit in (1, 2, 4) if bit < self.parameters.axes)
            return 0xFFFF | axes << r.CHANNEL_COMPARE_PULSE_AXIS_LSB
        if register.name != "RUN":
            return register.defined
        channels = self.parameters.channels
        of_channels = (1 << channels) - 1
        status = sum(bit for bit in (1, 2, 4) if bit < channels)
        return (
            of_channels << r.RUN_RUN_LSB
            | of_channels << r.RUN_WAIT_SYNC_LSB
            | status << r.RUN_STATUS_CHANNEL_LSB
        )

    def check_reading(self) -> None:
        """What can be read has its reset value; what cannot is refused."""
        for address, register in self.table.items():
            verdict, word = self.read(address)
            if "r" in register.access:
                seen = (verdict, word & register.known)
                reset = register.reset
                if register.name == "CHANNEL_OUTPUT_STATE" and not self.parameters.raster:
                    reset = 0  # no raster queue, so no room in it
                assert seen == (Verdict.OK, reset), f"{register.name} at 0x{address:03X}"
            else:
                assert verdict == Verdict.BAD_OPERATION, f"{register.name} at 0x{address:03X}"

    def check_writing(self) -> None:
        """Each bit of a field is taken, and shown where it can be read; each other bit is refused.

        At the last address of a register, and in cores of one channel at the first.
        """
        first = self.parameters.channels == 1
        ends = {
            register: {max(of), min(of) if first else max(of)} for register, of in self._addresses().items()
        }
        for address, register in self.registers:
            where = f"{register.name} at 0x{address:03X}"
            if "w" not in register.access:
                assert self.write(address, 0) == Verdict.READ_ONLY, where
                continue
            assert self.write(address, register.reset) == Verdict.OK, where
            if address not in ends[register]:
                continue
            for bit in (1 << n for n in range(32)):
                expected = Verdict.OK if bit & self.taken(register) else Verdict.BAD_VALUE
                assert self.write(address, bit) == expected, f"{where}, 0x{bit:X}"
                if "r" in register.access:
                    shown = bit if expected == Verdict.OK else register.reset
                    assert self.read(address) == (Verdict.OK, shown), f"{where}, 0x{bit:X}"
                assert self.write(address, register.reset) == Verdict.OK, where

    def check_limits(self) -> None:
        """The greatest value is taken, what is above is refused, and 0 where it would make no sense."""
        for register, addresses in self._addresses().items():
            address, where = max(addresses), register.name
            if "w" not in register.access or register.name in ("RUN", "CHANNEL_TRIGGER", "CHANNEL_COMMAND"):
                continue
            greatest = GREATEST.get(register.name, self.taken(register))
            if register.name == "CHANNEL_COMPARE_PULSE":
                greatest = 0xFFFF | self.parameters.axes - 1 << r.CHANNEL_COMPARE_PULSE_AXIS_LSB
            assert self.write(address, greatest) == Verdict.OK, where
            if greatest < 0xFFFFFFFF:
                assert self.write(address, greatest + 1) == Verdict.BAD_VALUE, where
                assert self.write(address, greatest | 1 << 31 | 1) == Verdict.BAD_VALUE, where
            expected = Verdict.BAD_VALUE if register.name in NOT_0 else Verdict.OK
            assert self.write(address, 0) == expected, where
            assert self.write(address, register.reset) == Verdict.OK, where

    def check_busy(self) -> None:
        """While the last channel has a motion, what needs a quiet one is refused, and nothing else."""
        channel = self.parameters.channels - 1
        base = r.ADDRESS_CHANNEL_BASE + channel * r.ADDRESS_CHANNEL_STRIDE
        command = base + r.CHANNEL_COMMAND
        endless = [2, 9, *[9] * self.parameters.axes, *[0] * self.parameters.outputs]
        assert self.push(base + r.CHANNEL_LINE, *endless) == Verdict.OK
        assert self.push(base + r.CHANNEL_RAMP, 0, 0, 0xFFFFFFFF, 0, 0) == Verdict.OK
        assert self.write(r.ADDRESS_RUN, 1 << channel) == Verdict.OK
        assert self.read(base + r.CHANNEL_STATE)[0] == Verdict.OK
        assert self.read(base + r.CHANNEL_STATE)[1] & 7 == State.RUN
        for register, addresses in self._addresses().items():
            if "w" not in register.access or register.name == "RUN":
                continue
            for address in (min(addresses), max(addresses)):
                of_other = r.ADDRESS_CHANNEL_BASE <= address < base
                busy = register.name in QUIET and not of_other
                expected = Verdict.BUSY if busy else Verdict.OK
                assert self.write(address, register.reset) == expected, f"{register.name} at 0x{address:03X}"
        for word in QUIET_COMMANDS:
            assert self.write(command, word) == Verdict.BUSY
        assert self.write(command, 1 << r.CHANNEL_COMMAND_ABORT_LSB | sum(QUIET_COMMANDS)) == Verdict.OK
        assert self.write(r.ADDRESS_RUN, 0) == Verdict.OK
        for word in QUIET_COMMANDS:
            assert self.write(command, word) == Verdict.OK

    def check_pushing(self) -> None:
        """Only the queues take it, and nothing else."""
        for address, register in self.registers:
            assert self.push(address, 0) == Verdict.BAD_OPERATION, f"{register.name} at 0x{address:03X}"
        for address, register in self.table.items():
            if register.name == "CHANNEL_COMMAND":  # the polarity of an alarm may have stopped it
                assert self.write(address, 1 << r.CHANNEL_COMMAND_CLEAR_LSB) == Verdict.OK
        for address, register in self.table.items():
            if register.name in self.items:
                where = f"{register.name} at 0x{address:03X}"
                assert self.write(address, 1) == Verdict.BAD_OPERATION, where
                assert self.push(address, *self.items[register.name]) == Verdict.OK, where
                self.check_bits(address, register.name)

    def check_bits(self, address: int, name: str) -> None:
        """Each bit that a word of a line or a ramp does not have is refused."""
        item = self.items[name]
        for place, known in enumerate(self.bits.get(name, ())):
            for bit in (1 << n for n in range(32)):
                if not known & bit:
                    words = [*item[:place], item[place] | bit, *item[place + 1 :]]
                    assert self.push(address, *words) == Verdict.BAD_VALUE, f"{name}: 0x{bit:X} of {place}"

    def check_holes(self) -> None:
        """Where there is no register there is no answer; writes and pushes are tried beside registers.

        Cores with some of the parts are asked for the registers of all, and beside them: those with all parts
        and with none are asked for what no core has.
        """
        parts = sum(getattr(self.parameters, part) for part in PARTS)
        asked = set(range(WORDS))
        if 0 < parts < len(PARTS):
            others = dict(every_register(replace(self.parameters, **PARTS)))
            asked &= {address + n for address in others for n in (-1, 0, 1)}
        for address in sorted(asked - set(self.table)):
            assert self.read(address)[0] == Verdict.UNKNOWN_ADDRESS, f"0x{address:03X}"
            if address - 1 in self.table or address + 1 in self.table:
                answers = (self.write(address, 0), self.push(address, 0))
                assert answers == (Verdict.UNKNOWN_ADDRESS,) * 2, f"0x{address:03X}"

    def _addresses(self) -> dict[Register, list[int]]:
        found: dict[Register, list[int]] = {}
        for address, register in self.registers:
            found.setdefault(register, []).append(address)
        return found


def check_all(core: Core) -> None:
    """In an order in which nothing of what was done before is in the way."""
    core.check_reading()
    core.check_busy()
    core.check_limits()
    core.check_writing()
    core.check_holes()
    core.check_pushing()


@pytest.mark.sample(1)
def test_every_register_of_the_model_answers() -> None:
    """Of the largest core, of which RUN has all bits."""
    parameters = Parameters(channels=8, axes=8, **PARTS)
    with model_engine(parameters) as engine:
        check_all(Core(Link(engine), parameters))


@pytest.mark.sample(1)
@pytest.mark.parametrize("parameters", CORES, ids=lambda p: p.name)
def test_every_register_of_the_rtl_answers_as_in_the_model(parameters: Parameters) -> None:
    """PairEngine compares each word of each reply."""
    with PairEngine(rtl_engine(parameters), model_engine(parameters)) as engine:
        check_all(Core(Link(engine), parameters))


def test_arrays_of_a_channel_have_a_word_for_each_axis() -> None:
    """This is how their number is known here."""
    arrays = [register.name for register in r.TABLE if register.block == "CHANNEL" and register.count > 1]
    names = "POSITION", "TRIGGER_POSITION", "ENCODER_POSITION"
    trackers = "TRACKER_POSITION", "TRACKER_TARGET", "TRACKER_TARGET_DOWN"
    assert arrays == [f"CHANNEL_{name}" for name in (*names, *trackers)]
    assert all(register.count == 1 for register in r.TABLE if register.block in ("AXIS", "ENCODER"))
