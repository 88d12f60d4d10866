# SPDX-License-Identifier: MIT
"""Generate the definitions of registers and words of RTL, C and Python and their documentation.

Their source is spec/passo.rdl.

Names are the same in all languages; C puts PASSO_ in front:

    ADDRESS_RUN             word address of a register of the core
    CHANNEL_ROOM            word offset of a register in its channel
    AXIS_PINS               word offset of a register in its axis
    ..._BASE, _COUNT        first word and length of an array; arrays of blocks also have a _STRIDE
    RUN_WAIT_SYNC_LSB       lowest bit of the field WAIT_SYNC of RUN; _BITS: width, _RESET: reset value
    CHANNEL_ROOM_..._LSB    the same for the field of a channel's register
    RUN_DEFINED             the bits of a register that may be written
    VERDICT_OK              an enumeration's value; Verdict.OK in Python
    HEADER_SEQUENCE_LSB     the field of a word that is no register

Each register of several fields, and each word, also has a struct passo_<name> with passo_pack_<name>() and
passo_unpack_<name>() in C, and a class with pack() and unpack() in Python. Python also has the TABLE of all
registers.

RTL and model also have the rule of each register (rdl/rules.py): which access it takes, and which values.

A field that is alone in its register and has its name does not repeat it: CHANNEL_RATE_TARGET_LSB.
"""

import sys
from pathlib import Path

from generated import is_check, keep
from rdl import c, docs, python, rules, verilog
from rdl.schema import SOURCE, read

ROOT = Path(__file__).resolve().parent.parent

OUTPUTS = {
    "rtl/passo_registers.vh": verilog.constants,
    "rtl/passo_register_rules.vh": rules.verilog,
    "c_model/protocol/passo_registers.h": c.constants,
    "c_model/protocol/passo_words.h": c.words,
    "c_model/core/passo_register_rules.h": rules.c,
    "sim/passo/registers.py": python.module,
    "docs/reference/registers.md": docs.page,
}


def main() -> int:
    check = is_check(f"Generate the register definitions from {SOURCE}.")
    source = read(ROOT)
    return keep(ROOT, {name: write(source) for name, write in OUTPUTS.items()}, check)


if __name__ == "__main__":
    sys.exit(main())
