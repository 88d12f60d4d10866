# SPDX-License-Identifier: MIT
"""Faults in a module, to show that a check can fail: the solver picks any one of them.

yosys draws the faults (``mutate``) among the cells of the RTL and puts all of them into one netlist. The
number of a fault is a constant that the solver chooses; number 0 is the module as it is.
"""

SELECT = "passo_fault"
WIDTH = 11  # of SELECT
CELLS = 400  # faults among the combinational cells
PORTS = (  # (registers and memories, the port that a fault is at, how many faults)
    ("t:*dff*", "D", 80),
    ("t:*dff*", "ARST", 20),
    ("t:$mem*", "RD_ADDR", 20),
    ("t:$mem*", "WR_ADDR", 20),
    ("t:$mem*", "WR_DATA", 20),
    ("t:$mem*", "WR_EN", 20),
)
LISTS = SELECT + "_{}.ys"  # what draw() writes
# Cells of the RTL: not of properties (*.vh), even if shared, of wrappers, nor of abstract memories.
OF_RTL = "a:src=*.v:* a:src=*.vh:* %d a:src=*_proof.v:* %d a:src=*memory/*.v:* %d"


def draw(cells: int = CELLS) -> list[str]:
    """Commands for yosys that put faults into the RTL, up to `cells` of them into combinational cells.

    The modules must be prepared (``proc``, ``memory``). SELECT becomes an input of the top.
    """
    drawn = [(f"{OF_RTL} t:*dff* t:$mem* %u %d", "", cells)]
    drawn += [(f"{OF_RTL} {kind} %i", f"-port {port} ", count) for kind, port, count in PORTS]
    commands, number = [], 1
    for i, (chosen, port, count) in enumerate(drawn):
        control = f"-ctrl {SELECT} {WIDTH} {number}"
        commands.append(f"mutate -list {count} {port}-seed 1 {control} -o {LISTS.format(i)} {chosen}")
        number += count
    assert number <= 1 << WIDTH
    return [*commands, *(f"script {LISTS.format(i)}" for i in range(len(drawn)))]
