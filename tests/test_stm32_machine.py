# SPDX-License-Identifier: MIT
"""The models of processor and peripherals, tested by small programs (tests/stm32/*.c)."""

import struct
from collections.abc import Callable
from pathlib import Path

import pytest
from passo.compiler import CORTEX_M3, headers, includes, kept
from passo.toolchain import paths
from passo_stm32 import Machine, MachineError
from passo_stm32.bus import TICKS_PER_SECOND

FOLDER = paths.tests / "stm32"
MEMORIES = FOLDER / "machine.ld"
FLAGS = ("-ffreestanding", "-nostdlib", "-Wall", "-Wextra", "-Werror")

Program = Callable[[str], Path]


def compile_program(source: Path) -> Path:
    """Compile once per version of the sources."""
    files = [FOLDER / "start.c", source]
    elf = paths.build / "tests" / "stm32" / f"{source.stem}.elf"
    inputs = [*files, *headers(FOLDER), MEMORIES]
    return kept(elf, inputs, FLAGS, f"-T{MEMORIES}", *includes(FOLDER), *files, compiler=CORTEX_M3)


def program(name: str) -> Path:
    """One of the programs of tests/stm32."""
    return compile_program(FOLDER / f"{name}.c")


def snippet(folder: Path, code: str) -> Path:
    """A program whose main() is `code`."""
    source = folder / "snippet.c"
    source.write_text(f'#include "machine.h"\nint main(void)\n{{\n{code}\nreturn 0;\n}}\n')
    return compile_program(source)


def words(machine: Machine, name: str, count: int = 1) -> list[int]:
    """Words of a variable."""
    return list(struct.unpack(f"<{count}I", machine.read_memory(machine.elf.symbols[name], 4 * count)))


def log(machine: Machine) -> list[int]:
    """The log of the program; empty before its startup code has cleared the memory."""
    (length,) = words(machine, "log_length")
    return words(machine, "log_entries", length) if length <= 256 else []


def finished(machine: Machine) -> bool:
    """The program's main() has returned."""
    return words(machine, "finished") == [1]


def test_interrupts_nest_and_follow_by_priority() -> None:
    """An interrupt of higher priority preempts, one of lower priority waits; masks block them; WFI wakes."""
    machine = Machine(program("interrupts"))
    machine.run_until(lambda: finished(machine), 0.1)
    assert log(machine) == [
        *(0x10, 0x20, 1),
        *(0x10, 0x11, 0x21, 0x20, 0x12, 0x22, 0x14, 2),
        *(3, 0x10, 0x20, 0x12, 0x22, 4),
        *(0x11, 0x21, 5, 0x12, 0x22, 0x14, 6),
        *(0x13, 7),
        *(8, 0x10, 0x20, 9),
    ]


def test_exceptions_leave_registers_and_conditions_as_they_were() -> None:
    """A loop of IT blocks gives the same sum under an interrupt every 67 clocks."""
    machine = Machine(program("interrupts"))
    machine.run_until(lambda: finished(machine), 0.1)
    assert words(machine, "sum_under_fire") == words(machine, "sum_in_peace")
    assert words(machine, "ticks")[0] > 100


@pytest.mark.parametrize(("crystal", "megahertz"), [(True, 72), (False, 64)])
def test_clock_falls_back_when_the_crystal_is_broken(crystal: bool, megahertz: int) -> None:
    """HSERDY never comes; 100 periods of SysTick last exactly 100 ms at either clock."""
    machine = Machine(program("clocks"), crystal=crystal)
    machine.run_until(lambda: log(machine) == [1], 0.1)
    began = machine.now
    machine.run_until(lambda: len(log(machine)) == 3, 0.2)
    assert words(machine, "megahertz") == [megahertz]
    clocks = (machine.now - began) * megahertz * 1_000_000 / TICKS_PER_SECOND
    assert 0 <= clocks - megahertz * 100_000 < 600  # the slice, and the way into the handler and out
    assert log(machine)[1] > megahertz * 1000 - 100  # SysTick has just begun again


def test_usart_echoes_at_its_baud_rate() -> None:
    """Each character takes 10 bits in both directions."""
    machine = Machine(program("usart"))
    machine.run(0.005)
    machine.type("Passo, 0123456789\r")
    machine.run(0.01)
    assert machine.output == "Passo, 0123456789\r"
    character = 10 * TICKS_PER_SECOND // 115_200
    steps = {b - a for a, b in zip(machine.output_ticks, machine.output_ticks[1:], strict=False)}
    assert all(abs(step - character) < 2000 for step in steps), steps


def test_usart_overrun_is_seen_and_cleared() -> None:
    """While the program does not read, all but one character are lost; reading SR and DR clears ORE."""
    machine = Machine(program("usart"))
    machine.run(0.005)
    machine.type("a!bcdefgh")
    machine.run(0.02)
    status, after = log(machine)
    assert status & 0x28 == 0x28 and after & 0x28 == 0
    assert machine.output == f"a!E{status & 0xFF:02X}"
    machine.type("z")
    machine.run(0.01)
    assert machine.output.endswith("z")


def test_usart_at_another_baud_rate_does_not_understand() -> None:
    """What the terminal types too fast arrives damaged."""
    machine = Machine(program("usart"), baud=230_400)
    machine.run(0.005)
    machine.type("Passo")
    machine.run(0.01)
    assert machine.output and "P" not in machine.output


class Inverter:
    """SPI slave: replies to each byte with the previous one, inverted."""

    irq = 0

    def __init__(self) -> None:
        self.last = 0xFF
        self.frames: list[bytes] = []
        self.half_periods: set[int] = set()
        self.tick = 0
        self.selected = False

    def follow(self, tick: int) -> int:
        """Time passes."""
        self.tick = max(self.tick, tick)
        return self.tick

    def select(self, selected: bool) -> None:
        """A frame begins."""
        self.selected = selected
        if selected:
            self.frames.append(b"")
            self.last = 0xFF

    def exchange(self, mosi: bytes, half_period: int) -> bytes:
        """Some bytes of it."""
        assert self.selected
        self.frames[-1] += mosi
        self.half_periods.add(half_period)
        self.tick += 16 * half_period * len(mosi)
        miso = bytes(byte ^ 0xFF for byte in bytes([self.last]) + mosi)
        self.last = mosi[-1]
        return miso[:-1]


def test_spi_by_program_and_by_dma() -> None:
    """Bytes and halfwords go out and come in, most significant bit first."""
    other = Inverter()
    machine = Machine(program("spi"), other)
    machine.run_until(lambda: finished(machine), 0.1)
    assert other.frames == [
        bytes([0x10, 0x11, 0x12, 0x13]),
        bytes([0x01, 0x02, 0x03, 0x80, 0xFF, 0x00, 0x55, 0xAA]),
        bytes([0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC, 0xDE, 0xF0]),
    ]
    assert other.half_periods == {32, 16}  # 9 and 18 MHz
    assert words(machine, "polled") == [0x00EFEEED]
    assert machine.read_memory(machine.elf.symbols["bytes_received"], 8).hex() == "00fefdfc7f00ffaa"
    received = struct.unpack("<4H", machine.read_memory(machine.elf.symbols["halves_received"], 8))
    assert received == (0x00ED, 0xCBA9, 0x8765, 0x4321)
    assert words(machine, "dma_flags")[0] & 0xFF0 == 0x770 and words(machine, "dma_left") == [0]
    assert log(machine) == [0, 2]  # all flags of DMA cleared; TXE alone


def test_crc_unit_and_edges() -> None:
    """CRC-32/MPEG-2; only the selected edges cause interrupts."""
    from passo.frame import crc

    machine = Machine(program("edges"), irq="PB1")
    machine.run(0.001)
    for level in (1, 0, 1, 0, 1):
        machine.ports["B"].drive(0, level)
        machine.run(0.001)
    assert log(machine)[:3] == [crc([0x12345678]), crc([0x12345678, 0x9ABCDEF0]), 0xFFFFFFFF]
    assert log(machine)[3:] == [0x101, 0x101, 0x100, 0x101]
    assert finished(machine)


def test_resets_and_their_causes() -> None:
    """Software, watchdog and a fault reset the chip; RAM is kept, and the watchdog period is exact."""
    machine = Machine(program("resets"))
    machine.run(0.2)
    assert [cause for _, cause in machine.resets] == ["power", "software", "watchdog", "software"]
    power, pin, software, watchdog = 8, 4, 16, 32
    kept = words(machine, "kept", 8)
    assert kept[:5] == [4, power | pin, pin | software, pin | watchdog, pin | software]
    assert kept[7] == 0xFA17
    (fault,) = machine.faults
    assert "write to 0x30000000" in fault and "main" in fault
    fed = (machine.resets[2][0] - machine.resets[1][0]) / TICKS_PER_SECOND
    assert 0.059 < fed < 0.062


@pytest.mark.parametrize(
    ("code", "words_of_error"),
    [
        ("REGISTER(0x40012C00) = 1;", "nothing is modeled at 0x40012C00"),
        ("SPI(0) = 4;", "SPI1 (0x40013000) has no clock"),
        ("RCC_APB2ENR = 1u << 12; SPI(0x10) = 1;", "SPI1 + 0x10"),
        ("RCC_APB2ENR = 1u << 12; SPI(0) = 1u << 15;", "SPI1.CR1: bits 0x8000"),
        ("RCC_APB2ENR = 1u << 12; SPI(0x0C) = 1;", "SPI1.DR is written while SPI1 is disabled"),
        ("RCC_CFGR = 2;", "not ready"),
        ("use_crystal(); FLASH_ACR = 0; RCC_CFGR = RCC_CFGR;", "too few wait states"),
        ("IWDG(4) = 1;", "IWDG.PR is written without its key"),
        ("SCB_AIRCR = 4;", "without its key"),
        (
            "RCC_APB2ENR = 1u << 12 | 4; SPI(0) = 0x344; SPI(12) = 1; while (!(SPI(8) & 1));",
            "PA5 is not its push-pull output",
        ),
    ],
)
def test_what_is_not_modelled_is_an_error(tmp_path: Path, code: str, words_of_error: str) -> None:
    """The message names the register and the function that touches it."""
    machine = Machine(snippet(tmp_path, code))
    with pytest.raises(MachineError, match=r"pc 0x0800.*\(main\)") as caught:
        machine.run(0.01)
    assert words_of_error in str(caught.value)


def test_fault_in_the_fault_handler_waits_for_the_watchdog(tmp_path: Path) -> None:
    """The processor locks up; the watchdog, once started, resets the chip."""
    code = """
        IWDG(0) = 0xCCCC;
        *(volatile uint32_t *)0xE000ED08 = 0x20004000;
        ((volatile uint32_t *)0x20004000)[3] = 0x30000001;
        *(volatile uint32_t *)0x30000000 = 1;"""
    machine = Machine(snippet(tmp_path, code))
    machine.run(0.5)
    assert [cause for _, cause in machine.resets] == ["power", "watchdog"]
    assert len(machine.faults) == 4  # two in each life


PAGE = 0x0800F800
FLASH_CODE = """
#define FLASH(offset) REGISTER(0x40022000 + (offset))
#define HALF(address) (*(volatile uint16_t *)(address))
RCC_CR |= 1u;
"""
UNLOCK = "FLASH(4) = 0x45670123; FLASH(4) = 0xCDEF89AB;\n"
LOCKED, PROGRAM_ERROR, END = 0x80, 0x04, 0x20


def flash_program(folder: Path, code: str) -> Machine:
    """A machine that has executed code; HALF(PAGE) is erased at first."""
    machine = Machine(snippet(folder, FLASH_CODE + code.replace("PAGE", hex(PAGE))))
    machine.run_until(lambda: words(machine, "finished")[0] in (1, 2), 0.1)
    return machine


def test_flash_is_erased_and_programmed(tmp_path: Path) -> None:
    """A half-word at a time, and only an erased one; 0 goes over anything. The processor waits."""
    machine = flash_program(
        tmp_path,
        UNLOCK
        + """FLASH(16) = 1; HALF(PAGE) = 0x1234; note(FLASH(12)); FLASH(12) = 0x34;
        HALF(PAGE) = 0x1204; note(FLASH(12)); note(HALF(PAGE)); FLASH(12) = 0x34;
        HALF(PAGE) = 0; note(FLASH(12)); note(HALF(PAGE)); FLASH(12) = 0x34;
        FLASH(16) = 2; FLASH(20) = PAGE + 6; FLASH(16) = 0x42; note(FLASH(12)); note(HALF(PAGE));
        FLASH(16) = 0x80; note(FLASH(16));""",
    )
    assert log(machine) == [END, PROGRAM_ERROR, 0x1234, END, 0, END, 0xFFFF, LOCKED]
    assert machine.seconds > 0.02


@pytest.mark.parametrize(
    "keys",
    [
        "",
        "FLASH(4) = 0x45670123;",
        "FLASH(4) = 0xCDEF89AB; FLASH(4) = 0x45670123; " + UNLOCK,
        "FLASH(4) = 1; " + UNLOCK,
        UNLOCK + UNLOCK,
    ],
)
def test_flash_stays_locked_without_its_keys(tmp_path: Path, keys: str) -> None:
    """Nothing takes effect; the store is a fault."""
    machine = flash_program(
        tmp_path,
        keys
        + """FLASH(16) = 2; FLASH(20) = PAGE; FLASH(16) = 0x42; note(FLASH(16));
        FLASH(16) = 1; HALF(PAGE) = 1;""",
    )
    assert log(machine) == [LOCKED, 0xDEAD0003]
    assert machine.faults and machine.read_memory(PAGE, 2) == b"\xff\xff"


def test_flash_takes_half_words_only(tmp_path: Path) -> None:
    """A word or a byte is a fault."""
    for kind in ("uint32_t", "uint8_t"):
        machine = flash_program(tmp_path, UNLOCK + f"FLASH(16) = 1; *(volatile {kind} *)PAGE = 1;")
        assert log(machine) == [0xDEAD0003]


def test_program_cannot_change_itself(tmp_path: Path) -> None:
    """Erasing the page of the vectors."""
    with pytest.raises(MachineError, match="changes itself"):
        flash_program(tmp_path, UNLOCK + "FLASH(16) = 2; FLASH(20) = 0x08000000; FLASH(16) = 0x42;")
