# SPDX-License-Identifier: MIT
"""Units of the driver: the macros, without floating point at run time, and the hint when one is missing."""

import shutil
from pathlib import Path

import pytest
from passo.compiler import CORTEX_M3, STRICT, call, compile_to, includes
from passo.driver import Driver
from passo.toolchain import paths

from tests.helpers.driver_wire import CLOCK_HZ, Q32, Wire, by_speed, error_of, open_driver, struct
from tests.test_driver import straight

FOLDERS = (paths.driver, paths.planner, paths.protocol)
HEAD = '#define PASSO_CLOCK_HZ 72000000\n#include "passo.h"\n'
VALUES = {
    "PASSO_MM(1.5)": Q32 * 3 // 2,
    "PASSO_MM(-120.25)": -Q32 * 481 // 4,
    "PASSO_DEGREES(-1.0 / 3)": -round(Q32 / 3),
    "PASSO_THOUSANDTHS(-1500)": -Q32 * 3 // 2,
    "PASSO_STEPS_PER_S(20000)": 20000 * Q32,
    "PASSO_STEPS_PER_S2(0.1)": round(Q32 / 10),
    "PASSO_STEPS_PER_S3(4000000000.0)": 4_000_000_000 * Q32,
    "PASSO_MM_PER_S(250)": 250 * Q32,
    "PASSO_MM_PER_S2(2)": 2 * Q32,
    "PASSO_MM_PER_S3(2)": 2 * Q32,
    "PASSO_RPM(7.5)": Q32 * 15 // 2,
    "PASSO_RPM_PER_S(1)": Q32,
    "PASSO_STEPS_PER_MM(80)": 80 * Q32,
    "PASSO_STEPS_PER_DEGREE(0.5)": Q32 // 2,
    "PASSO_ALPHA(4.5)": 18432,
    "PASSO_S(2)": 144_000_000,
    "PASSO_MS(400)": 28_800_000,
    "PASSO_US(0.5)": 36,
}


def test_values() -> None:
    """Each is a constant of that value, of C and of C++."""
    text = HEAD + "".join(f"static const uint64_t v{i} = (uint64_t){m};\n" for i, m in enumerate(VALUES))
    header = (paths.driver / "passo_units.h").read_text()
    for macro in VALUES:
        assert f"#define {macro.split('(')[0]}(" in header
    words = [n % 2**64 for n in VALUES.values()]
    checks = "".join(f"\tif (v{i} != UINT64_C({n})) return {i + 1};\n" for i, n in enumerate(words))
    build = paths.build / "units"
    build.mkdir(parents=True, exist_ok=True)
    for name, flags in {
        "units.c": STRICT,
        "units.cpp": ("-std=c++17", "-Wall", "-Wextra", "-Werror"),
    }.items():
        (build / name).write_text(f"{text}int main(void)\n{{\n{checks}\treturn 0;\n}}\n")
        program = compile_to(build / f"{name}.out", "-O0", *flags, *includes(*FOLDERS), build / name)
        call([program])


@pytest.mark.skipif(not shutil.which("arm-none-eabi-gcc"), reason="gcc-arm-none-eabi is not installed")
@pytest.mark.parametrize("level", ["-O0", "-Os"])
def test_no_floating_point_is_linked(tmp_path: Path, level: str) -> None:
    """Constants leave no call of the compiler's library; a variable names the mistake."""
    source = tmp_path / "units.c"

    def undefined(body: str) -> str:
        source.write_text(f"{HEAD}void f(int n, int64_t *v)\n{{\n{body}}}\n")
        call([*CORTEX_M3, level, *includes(*FOLDERS), "-c", source, "-o", tmp_path / "units.o"])
        return call(["arm-none-eabi-nm", "-u", tmp_path / "units.o"])

    body = "".join(f"\tv[{i}] = (int64_t){macro};\n" for i, macro in enumerate(VALUES))
    assert undefined(f"{body}\t(void)n;\n").strip() == ""
    assert undefined("\tv[0] = PASSO_MM(n);\n").split() == ["U", "passo_unit_is_not_a_constant"]
    assert undefined("\tv[0] = PASSO_THOUSANDTHS(n);\n").split() == ["U", "__aeabi_ldivmod"]


@pytest.fixture
def driver() -> Driver:
    return open_driver(Wire())


def test_a_missing_unit_is_suspected(driver: Driver) -> None:
    """A speed, an acceleration or a time as a bare number; and not where the number is what it says."""
    raw = struct("move_by_speed", steps=[3200], speed=10_000, acceleration=50_000 * Q32)
    assert error_of(driver, "move_by_speed", raw) == "ABSURD"
    assert error_of(driver, "move_to_by_speed", 1, raw) == "ABSURD"
    raw.speed, raw.acceleration = 10_000 * Q32, 50_000
    assert error_of(driver, "move_by_speed", raw) == "ABSURD"
    time = struct("move_in_time", steps=[3200], total_clocks=400)
    assert error_of(driver, "move_in_time", time) == "ABSURD"
    time.total_clocks = 1
    assert error_of(driver, "move_in_time", time) == "ABSURD"
    time.total_clocks = 0
    assert error_of(driver, "move_in_time", time) == "NO_TIME"
    time.total_clocks, time.steps = CLOCK_HZ // 5000, [9000]
    assert error_of(driver, "move_in_time", time) == "TOO_FAST"
    below = struct("move_below_speed", steps=[3200], total_clocks=CLOCK_HZ, speed=10_000)
    assert error_of(driver, "move_below_speed", below) == "ABSURD"
    below.speed = 1000 * Q32
    assert error_of(driver, "move_below_speed", below) == "SPEED_TOO_LOW"
    turn = struct("move_turn", steps_per_turn=3200, angle=360 * Q32, rpm=60, acceleration=Q32 * 10_000)
    assert error_of(driver, "move_turn", turn) == "ABSURD"
    move = straight()
    move.feed = 150
    assert error_of(driver, "move_straight", move) == "ABSURD"
    move = straight()
    move.limits[1].speed = 200
    assert error_of(driver, "move_straight", move) == "ABSURD"
    move = straight()
    move.distance = [10, -20]
    assert error_of(driver, "move_straight", move) == "ABSURD"
    move.distance = [0, 0]
    assert error_of(driver, "move_straight", move) == "NO_STEPS"
    turn = struct("move_turn", steps_per_turn=3200, angle=-360, rpm=60 * Q32, acceleration=Q32 * 10_000)
    assert error_of(driver, "move_turn", turn) == "ABSURD"
    turn.angle = 0
    assert error_of(driver, "move_turn", turn) == "NO_STEPS"
    slow = by_speed([2**30 - 1], 1, 1)
    assert error_of(driver, "move_by_speed", slow) == "TOO_LONG"
