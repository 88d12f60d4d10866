# SPDX-License-Identifier: MIT
"""Every register of spec/passo.rdl answers, in model and RTL, as its fields say; nothing else does."""

from collections.abc import Iterator
from dataclasses import replace

import pytest
from passo import registers as r
from passo.build import Parameters
from passo.engine import model_engine, rtl_engine
from passo.link import Link, RefusedError
from passo.pair_engine import PairEngine
from passo.register_table import Register
from passo.registers import Verdict

WORDS = 1 << r.HEADER_ADDRESS_BITS
PARTS = {"inputs": 1, "encoders": 1, "outputs": 1}
# Each part alone, as other tests have compiled it; what is there once per channel, in the core of two.
CORES = [
    Parameters(),
    Parameters(axes=3, inputs=1),
    Parameters(outputs=1),
    Parameters(encoders=1),
    Parameters(channels=2, axes=3, **PARTS),
]


def every_register(parameters: Parameters) -> Iterator[tuple[int, Register]]:
    """Address and register of all words of a core. An array in a channel has a word for each axis."""
    channels = [r.ADDRESS_CHANNEL_BASE + n * r.ADDRESS_CHANNEL_STRIDE for n in range(parameters.channels)]
    places = [r.CHANNEL_AXIS_BASE + n * r.CHANNEL_AXIS_STRIDE for n in range(parameters.axes)]
    axes = [channel + place for channel in channels for place in places]
    encoders = [base - r.CHANNEL_AXIS_BASE + r.CHANNEL_ENCODER_BASE for base in axes]
    bases = {"CORE": [0], "CHANNEL": channels, "AXIS": axes, "ENCODER": encoders}
    for register in r.TABLE:
        if register.part and not getattr(parameters, register.part):
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
        """The bits that may be 1 alone: only those of channels and axes that are there.

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
                assert seen == (Verdict.OK, register.reset), f"{register.name} at 0x{address:03X}"
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
    core.check_writing()
    core.check_holes()
    core.check_pushing()


def test_every_register_of_the_model_answers() -> None:
    """Of the largest core, of which RUN has all bits."""
    parameters = Parameters(channels=8, axes=8, **PARTS)
    with model_engine(parameters) as engine:
        check_all(Core(Link(engine), parameters))


@pytest.mark.parametrize("parameters", CORES, ids=lambda p: p.name)
def test_every_register_of_the_rtl_answers_as_in_the_model(parameters: Parameters) -> None:
    """PairEngine compares each word of each reply."""
    with PairEngine(rtl_engine(parameters), model_engine(parameters)) as engine:
        check_all(Core(Link(engine), parameters))


def test_arrays_of_a_channel_have_a_word_for_each_axis() -> None:
    """This is how their number is known here."""
    arrays = [register.name for register in r.TABLE if register.block == "CHANNEL" and register.count > 1]
    assert arrays == ["CHANNEL_POSITION", "CHANNEL_TRIGGER_POSITION", "CHANNEL_ENCODER_POSITION"]
    assert all(register.count == 1 for register in r.TABLE if register.block in ("AXIS", "ENCODER"))
