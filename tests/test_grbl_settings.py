# SPDX-License-Identifier: MIT
"""Settings of the grbl console: ranges, errors, what outlasts a loss of power at any write."""

import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from passo.grbl_setup import PAGE, SettingsFile
from passo.machine_file import read_machine
from passo.native import ffi, planner
from passo.run import open_engine, parameters_for
from passo.toolchain import paths

from tests.helpers.grbl_console import GrblConsole

MACHINE = read_machine(paths.examples / "gcode" / "machine.toml")
WORDS = 40
ERASED = 0xFFFFFFFF


class Session(GrblConsole):
    """A console with a file of settings; a new one is a new power-up."""

    def __init__(self, file: Path):
        engine = open_engine("model", parameters_for(3), MACHINE.clock_hz)
        super().__init__(engine, MACHINE, SettingsFile(file))
        self.greeting = self.take()

    def rest(self) -> None:
        super().rest()
        self.grbl.poll()

    def off(self) -> None:
        self.engine.close()


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "settings"


@pytest.fixture
def session(file: Path) -> Iterator[Session]:
    made = Session(file)
    assert made.greeting == "Grbl 1.1h ['$' for help]"
    yield made
    made.off()


def test_values_and_their_errors(session: Session) -> None:
    """Each answer of grbl, and nothing has changed after an error."""
    before = session.line("$$")
    for text, said in (
        ("$100=-1", "error:4"), ("$100=x", "error:2"), ("$100=", "error:2"), ("$100=1 2x", "error:2"),
        ("$103=1", "error:3"), ("$140=1", "error:3"), ("$7=1", "error:3"), ("$20=1", "error:10"),
        ("$3=1.5", "error:2"), ("$3=64", "error:3"), ("$0=0", "error:6"), ("$0=0.000001", "error:6"),
        ("$12=0", "error:3"), ("$110=9999999", "error:12"), ("$1000=1", "error:3"), ("$N2=G21", "error:3"),
        ("$N0=G21X", "error:2"), ("$N0=" + "G4P0" * 30, "error:14"), ("$RST=x", "error:3"),
        ("$0=1000.1", "error:3"), ("$29=-1", "error:4"), ("$29=1001", "error:3"), ("$28=1", "error:3"),
        # X makes 16,000 steps/s: 62.5 us from one to the next; and turns at corners of 9 mm/s
        ("$0=31.26", "error:12"), ("$29=1000", "error:12"),
    ):  # fmt: skip
        assert (text, session.line(text)) == (text, said)
    assert session.line("$$") == before


def test_pins_have_the_times_of_the_settings(session: Session) -> None:
    """`$0` is that of STEP, active and inactive, `$29` that of DIR: up to what the axes allow."""
    assert session.line("$0=31.25") == "ok" and session.line("$29=5") == "ok"
    settings = session.line("$$").splitlines()
    assert {"$0=31.250", "$29=5.000"} < set(settings)
    assert session.line("$110=12001") == "error:12" and session.line("$100=80.1") == "error:12"
    assert session.line("$110=6000") == "ok" and session.line("$0=60") == "error:12"  # Y
    assert session.line("$111=6000") == "ok" and session.line("$0=60") == "ok"


def test_a_setting_changes_the_machine(session: Session) -> None:
    """Steps per mm, inches in reports, work coordinates."""
    assert session.line("$100=160") == "ok"
    session.line("G0 X2")
    assert session.line("$101=1") == "error:8"
    session.rest()
    assert "MPos:2.000,0.000,0.000" in session.line("?")
    assert session.engine is not None and session.grbl.player.feed.driver.positions()[0] == 320
    session.line("G10 L2 P1 X1")
    assert session.line("$10=0") == session.line("$13=1") == "ok"
    assert "<Idle|WPos:0.0394,0.0000,0.0000|FS" in session.line("?")


def test_what_outlasts_a_loss_of_power(session: Session, file: Path) -> None:
    session.line("$110=6000.5")
    session.line("G10 L2 P3 X1.5")
    session.line("G0 Y2")
    session.line("G28.1")
    assert session.line("$N0=G20 (inches)") == "error:8"
    session.rest()
    assert session.line("$N0=G20 (inches)") == "ok"
    again = Session(file)
    again.grbl.poll()
    assert again.take() == ">G20:ok" and "G20" in again.line("$G")
    assert "$110=6000.500" in again.line("$$")
    offsets = again.line("$#")
    assert "[G56:1.500," in offsets and "[G28:0.000,2.000," in offsets
    assert again.line("$N") == "$N0=G20\n$N1=\nok"
    assert "ok" in again.line("$RST=*")
    again.rest()
    assert "$110=12000.000" in again.line("$$") and "[G56:0.000," in again.line("$#")
    assert again.line("$N") == "$N0=\n$N1=\nok"
    again.off()


def test_every_setting_outlasts_a_loss_of_power(session: Session, file: Path) -> None:
    """Also one that another one must permit: soft limits need homing, which the defaults do not have."""
    assert "$22=0" in session.line("$$") and session.line("$22=1") == session.line("$20=1") == "ok"
    changed = 0
    for line in session.line("$$").splitlines()[:-1]:
        name, _, value = line.partition("=")
        other = f"{float(value) * 0.9:.3f}" if "." in value else str(1 - int(value)) if value in "01" else ""
        changed += bool(other) and name not in ("$20", "$22") and session.line(f"{name}={other}") == "ok"
    shown = session.line("$$")
    assert changed > 25 and {"$20=1", "$22=1"} < set(shown.splitlines())
    again = Session(file)
    assert "error" not in again.greeting and again.line("$$") == shown
    again.off()


def test_two_bad_copies_are_error_7(session: Session, file: Path) -> None:
    """Defaults, and the settings are shown; one bad copy is no loss."""
    session.line("$110=6000")
    session.line("$111=6000")
    data = bytearray(file.read_bytes())
    data[100] ^= 1
    file.write_bytes(data)
    one = Session(file)
    assert "$110=6000.000" in one.line("$$") and "error" not in one.greeting
    one.off()
    data[PAGE + 100] ^= 1
    file.write_bytes(data)
    both = Session(file)
    assert both.greeting.startswith("error:7\n$0=") and "$110=12000.000" in both.greeting
    assert both.line("$110=6000") == "ok"
    both.off()


class Flash:
    """Two pages of flash whose power fails after a number of written words; the last one is torn."""

    def __init__(self) -> None:
        self.pages = [[ERASED] * (WORDS + 3) for _ in range(2)]
        self.left, self.erased, self.torn = 1 << 30, 0, random.Random(1)
        self._calls = (
            ffi().callback("bool(void *, unsigned, size_t, uint32_t *, size_t)", self._read),
            ffi().callback("bool(void *, unsigned)", self._erase),
            ffi().callback("bool(void *, unsigned, size_t, uint32_t *, size_t)", self._write),
        )
        self.c = ffi().new("struct passo_storage_pages *")
        self.c.read, self.c.erase, self.c.write = (ffi().cast("void *", call) for call in self._calls)

    def _read(self, _: Any, page: int, at: int, words: Any, count: int) -> bool:
        for i in range(count):
            words[i] = self.pages[page][at + i]
        return True

    def _put(self, page: int, at: int, word: int) -> bool:
        self.left -= 1
        if self.left >= 0:
            self.pages[page][at] = word
        elif self.left == -1:
            self.pages[page][at] = word ^ 0x00FF00FF
        return self.left >= 0

    def _erase(self, _: Any, page: int) -> bool:
        """If the power fails, some bits of what is left are set."""
        self.erased += 1
        for at, word in enumerate(self.pages[page]):
            self.left -= 1
            self.pages[page][at] = ERASED if self.left >= 0 else word | self.torn.getrandbits(32)
        return self.left >= 0

    def _write(self, _: Any, page: int, at: int, words: Any, count: int) -> bool:
        return all([self._put(page, at + i, words[i]) for i in range(count)])

    def open(self) -> Any:
        storage = ffi().new("struct passo_storage *")
        planner().passo_storage_open(storage, self.c, WORDS)
        return storage

    def load(self) -> tuple[int, list[int]]:
        record = ffi().new("uint32_t[]", WORDS)
        state = planner().passo_storage_load(self.open(), record)
        return state, list(record)

    def save(self, record: list[int]) -> bool:
        storage = self.open()
        planner().passo_storage_load(storage, ffi().new("uint32_t[]", WORDS))
        return planner().passo_storage_save(storage, ffi().new("uint32_t[]", record))


def test_power_that_fails_at_any_write() -> None:
    """The old record or the new one, never neither; and the next save succeeds."""
    c = planner()
    old, new, third = ([n * 1000 + i for i in range(WORDS)] for n in (1, 2, 3))
    for saves in (1, 2):
        for left in range(2 * (WORDS + 3) + 1):
            flash = Flash()
            assert flash.load()[0] == c.PASSO_STORAGE_EMPTY
            for _ in range(saves):
                assert flash.save(old)
            flash.left = left
            done = flash.save(new)
            flash.left = 1 << 30
            assert flash.load() == (c.PASSO_STORAGE_LOADED, new if done else old)
            assert flash.save(third) and flash.load() == (c.PASSO_STORAGE_LOADED, third)


def test_what_a_full_store_refuses_is_not_in_force(session: Session) -> None:
    """Settings, start lines, and all that `$RST` would restore: error 7, and everything is as before."""
    for line in ("$100=81", "$N0=G20", "G21", "G10 L2 P1 X1", "G91"):
        assert session.line(line) == "ok"
    session.rest()
    session.take()
    lines = "$$", "$N", "$#", "$G"
    before = [session.line(line) for line in lines]
    session.grbl._settings.c.write = ffi().cast("void *", WORN)
    for line in ("$100=90", "$N0=G18", "$N1=G0X10", "$RST=$", "$RST=#", "$RST=*"):
        assert session.line(line) == "error:7"
        session.rest()
        assert [session.line(line) for line in lines] == before
    session.line("G0 X1")
    session.rest()
    assert session.grbl.player.feed.driver.positions()[0] == 81


def test_the_flash_does_not_wear_by_what_it_has() -> None:
    """The same record again erases nothing; another one is written, also where a damaged copy had it."""
    flash, record = Flash(), [7 * i for i in range(WORDS)]
    assert all(flash.save(record) for _ in range(5)) and flash.erased == 1
    assert flash.save(record[::-1]) and flash.erased == 2
    flash.pages[0][9] ^= 1
    assert flash.save(record) and flash.erased == 2
    assert flash.save(record[::-1]) and flash.erased == 3 and flash.load()[1] == record[::-1]


@ffi().callback("bool(void *, unsigned, size_t, uint32_t *, size_t)")
def WORN(*_: Any) -> bool:  # noqa: N802
    return False
