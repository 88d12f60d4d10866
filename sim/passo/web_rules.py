# SPDX-License-Identifier: MIT
"""What the page of `make web` checks machine files and G-code by: keys, ranges, drives, boards, advice."""

from itertools import chain, combinations
from typing import Any

from passo_fpga.boards import Board, boards
from passo_fpga.parts import WITH_PINS
from passo_fpga.pll import PllError, possible
from passo_fpga.table import BoardError

from passo import machine_file
from passo.drives import drives
from passo.expand import refusals
from passo.expand.expander import NEEDS
from passo.expand.flow import FLOW
from passo.expand.place import MOST
from passo.gcode import AXIS_LETTERS
from passo.grbl_setup import SPINDLE_TICKS, TICKS_PER_COUNT
from passo.machine_file import AxisEnds, Spindle, Switches
from passo.move_file import PIN_KEYS, PIN_SECONDS
from passo.move_forms import DECIMALS_MAX, NUMBER_MAX, SIGNED_MAX, WHOLE_MAX
from passo.moves import PIN_CLOCKS_MAX
from passo.run import AXES_OF_CORES
from passo.table_values import CLOCK_HZ_MIN
from passo.values import UNITS

MOTORS_MOST = 8
LIMITS = ("steps_per_mm", "speed", "acceleration", "jump", "jerk")  # of struct limits (passo_web_program.c)


def rules() -> dict[str, Any]:
    """The object RULES of sim/passo/page/machine_file.js."""
    own = machine_file
    defaults = {
        "junction_deviation": own.JUNCTION_DEVIATION,
        "arc_tolerance": own.ARC_TOLERANCE,
        "travel": AxisEnds.travel,
        "start_up": Spindle.start_up,
        **{key: getattr(Switches, key) for key in own.HOME_KEYS},
    }
    return {
        "keys": {
            "file": own.FILE_KEYS,
            "axis": own.AXIS_KEYS,
            "motors": own.MOTOR_KEYS,
            "switches": own.SWITCH_KEYS,
            "home": own.HOME_KEYS,
            "spindle": own.SPINDLE_KEYS,
            "pins": PIN_KEYS,
        },
        "number_max": NUMBER_MAX,
        "signed_max": SIGNED_MAX,
        "whole_max": WHOLE_MAX,
        "decimals_max": DECIMALS_MAX,
        "clock_hz_min": CLOCK_HZ_MIN,
        "units": UNITS,
        "letters": AXIS_LETTERS,
        "profiles": own.PROFILES,
        "kinematics": own.KINEMATICS,
        "chips": own.CHIPS,
        "hosts": own.HOSTS,
        "home_ends": own.HOME_ENDS,
        "switches": own.SWITCHES,
        "enable_inverted": own.ENABLE_INVERTED,
        "motors_most": own.MOTORS_MOST,
        "motors": MOTORS_MOST,
        "limits": LIMITS,
        "backlash": own.BACKLASH_KEYS,
        "following_counts": own.FOLLOWING_COUNTS,
        "count_clocks": own.COUNT_CLOCKS,
        "ratio_one": own.RATIO_ONE,
        "waiting_steps": own.WAITING_STEPS,
        "counts": [own.COUNTS.start, own.COUNTS.stop - 1],
        "wander_max": own.WANDER_MAX,
        "spindle_wait_max": own.SPINDLE_WAIT_MAX,
        "ticks_per_count": TICKS_PER_COUNT,
        "spindle_ticks": SPINDLE_TICKS,
        "pin_clocks_max": PIN_CLOCKS_MAX,
        "pin_default": str(PIN_SECONDS),
        "cores": AXES_OF_CORES,
        "defaults": defaults,
        "parts": WITH_PINS,
        "drives": {name: drive.pins for name, drive in drives().items()},
        "boards": {name: _board(board) for name, board in boards().items()},
        "gcode": _gcode(),
    }


def _gcode() -> dict[str, Any]:
    """For sim/passo/page/advice.js; codes in tenths."""
    return {
        "axes": AXIS_LETTERS,
        "not_taken": sorted(refusals.NOT_TAKEN),
        "unused": refusals.UNUSED,
        "no_port": refusals.NO_PORT,
        "slow": refusals.SLOW,
        "letters": refusals.LETTERS,
        "advice": [(letter, codes.start, codes.stop, *told) for letter, codes, _, *told in refusals.ADVICE],
        "otherwise": refusals.OTHERWISE,
        "norms": refusals.NORMS,
        "nist": refusals.NIST,
        "said": refusals.SAID,
        "needed": refusals.NEEDED,
        "unread": sorted(refusals.UNREAD),
        "no_probe": refusals.NO_PROBE,
        "good": refusals.GOOD,
        "most": MOST,
        "expanded": (f"^{FLOW.pattern}", NEEDS.pattern),
    }


def _board(board: Board) -> dict[str, Any]:
    """Its clocks without parts and with them, those that its PLL makes, and which cores it refuses."""
    kinds = chain.from_iterable(combinations(WITH_PINS, count) for count in range(len(WITH_PINS) + 1))
    refused = {}
    for parts in kinds:
        for axes in range(1, len(AXIS_LETTERS) + 2):  # with that of a spindle
            try:
                board.parameters(axes, None, parts)
            except PllError as error:
                refused[f"{axes} {','.join(parts)}"] = f"clock_hz: {error}"
            except BoardError as error:
                refused[f"{axes} {','.join(parts)}"] = str(error)
    made = (round(pll.mhz * 1e6) for pll in possible(board.device.family, board.oscillator_mhz))
    return {
        "hz": [round(board.pll(None, parts).mhz * 1e6) for parts in ((), WITH_PINS)],
        "clocks": list(dict.fromkeys(made)),
        "oscillator_mhz": board.oscillator_mhz,
        "refused": refused,
        "shared": board.shared,
    }
