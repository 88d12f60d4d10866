# SPDX-License-Identifier: MIT
"""The table of the registers as judge: each bit of a field is taken and read back, each other one is refused.

What the registers are is written in spec/passo.rdl.
"""

import random
from collections.abc import Callable

from passo.build import Parameters
from passo.engine import Engine
from passo.link import Link
from passo.register_table import Register
from passo.registers import Verdict

from tests.test_register_table import GREATEST, NOT_0, WORDS
from tests.test_register_table import Core as Table
from verify.mutants.engine_judge import Check

# What takes part in the answer to a frame.
MODULES = (
    *(
        "passo_rules",
        "passo_registers",
        "passo_channel_registers",
        "passo_axis_registers",
        "passo_axis_settings",
        "passo_axes",
    ),
    *("passo_output_registers", "passo_encoder_registers", "passo_inputs", "passo_machine", "passo_header"),
    *("passo_channel", "passo_channel_path", "passo_channel_control", "passo_channel_lines"),
    *("passo_channel_drives", "passo_channels", "passo_core", "passo_encoders", "passo_outputs"),
    *("passo_verdict", "passo_link_bus", "passo_link_frame"),
    *("passo_tables", "passo_encoder_axis", "passo_positions", "passo_admission"),
)
# Registers with a field that does not take each sum of its bits.
CHOICES = {"RUN", "CHANNEL_TRIGGER", "CHANNEL_COMPARE_PULSE", "CHANNEL_FOLLOW"}
PLACES = 2  # addresses of a register that are tried
BITS = 3  # of each word that are tried
HOLES = 12  # addresses without a register that are tried


def check(table: Table, rng: random.Random) -> None:
    """Read and write some addresses of each register, some bits of each, and push.

    Raises:
        AssertionError: One does not do as the table says.
    """
    addresses: dict[str, list[int]] = {}
    for address, register in table.table.items():
        addresses.setdefault(register.name, []).append(address)
    chosen = {address for of in addresses.values() for address in rng.sample(of, min(PLACES, len(of)))}
    whole = table.table
    table.table = {address: register for address, register in whole.items() if address in chosen}
    table.registers = [(address, register) for address, register in table.registers if address in chosen]
    table.check_reading()
    for address, register in table.registers:
        where = f"{register.name} at 0x{address:03X}"
        if "w" not in register.access:
            assert table.write(address, 0) == Verdict.READ_ONLY, where
            continue
        depends = table.taken(register) != register.defined  # on the parameters: each bit is tried
        for bit in rng.sample([1 << n for n in range(32)], 32 if depends else BITS):
            expected = Verdict.OK if bit & table.taken(register) else Verdict.BAD_VALUE
            assert table.write(address, bit) == expected, f"{where}, 0x{bit:X}"
            if "r" in register.access:
                shown = bit if expected == Verdict.OK else None
                verdict, word = table.read(address)
                assert verdict == Verdict.OK and shown in (None, word), f"{where}, 0x{bit:X}"
        assert table.write(address, register.reset) == Verdict.OK, where
    for address in rng.sample(sorted(set(range(WORDS)) - set(whole)), HOLES):
        answers = (table.read(address)[0], table.write(address, 0))
        assert answers == (Verdict.UNKNOWN_ADDRESS,) * 2, f"0x{address:03X}"
    table.check_pushing()


def some_value(table: Table, register: Register, rng: random.Random) -> int:
    """A value that a register takes: any bits, or up to its greatest value."""
    if register.name in GREATEST:
        return rng.randint(int(register.name in NOT_0), GREATEST[register.name])
    bits = [1 << n for n in range(32) if table.taken(register) >> n & 1]
    return rng.choice(bits) | (0 if register.name in CHOICES else rng.getrandbits(32) & sum(bits))


def check_keeping(table: Table, rng: random.Random) -> None:
    """A register shows what was written to it last, whatever is written to others.

    Raises:
        AssertionError: It does not.
    """
    kept = {address: register for address, register in table.registers if {"r", "w"} <= set(register.access)}
    shown = {}
    for address in rng.sample(sorted(kept), len(kept)):
        shown[address] = some_value(table, kept[address], rng)
        assert table.write(address, shown[address]) == Verdict.OK, f"0x{address:03X}"
    for address, register in table.registers:  # what is not shown changes nothing that is
        if "w" in register.access and address not in kept:
            assert table.write(address, register.reset) == Verdict.OK, f"0x{address:03X}"
    for address, word in shown.items():
        assert table.read(address) == (Verdict.OK, word), f"{kept[address].name} at 0x{address:03X} is kept"
    for address, register in kept.items():
        assert table.write(address, register.reset) == Verdict.OK, f"0x{address:03X}"


def _of_table(play: Callable[[Table, random.Random], None]) -> Callable[..., None]:
    """A check of a core, of one of its table."""

    def check_core(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
        play(Table(Link(engine), parameters), rng)

    return check_core


CHECKS = (
    Check("registers", "registers", _of_table(check), MODULES),
    Check("registers while busy", "registers", _of_table(lambda table, _: table.check_busy()), MODULES),
    Check(
        "registers at their limits", "registers", _of_table(lambda table, _: table.check_limits()), MODULES
    ),
    Check("registers kept", "registers", _of_table(check_keeping), MODULES),
)
