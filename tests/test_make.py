# SPDX-License-Identifier: MIT
"""`passo make`: a machine file becomes settings, wires and commands, or one sentence and nothing."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from passo import make_command
from passo.cli import main
from passo.engine import model_engine
from passo.grbl import Grbl
from passo.grbl_setup import core_for, machine_at
from passo.machine_file import read_machine
from passo.make_command import settings_lines
from passo.toolchain import paths
from passo_fpga.boards import board
from passo_fpga.flow import Placed
from passo_fpga.synth import Bitstream
from passo_stm32.grbl_board import GrblBoard, grbl_elf

ROUTER = paths.examples / "machines" / "router.toml"
TEXT = ROUTER.read_text(encoding="utf-8")
HZ = 96_000_000  # of the board with parts


def made(path: Path, folder: Path) -> dict[str, list[str]]:
    """The lines of all results."""
    assert main(["make", str(path), "--out", str(folder), "--no-build"]) == 0
    return {file.name: file.read_text().splitlines() for file in folder.iterdir()}


def test_results(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Every port has a wire, to a pin of its own; the commands are those that make takes."""
    results = made(ROUTER, tmp_path / "router")
    texts = {"settings.txt", "wiring.txt", "wiring.svg", "wiring.html", "summary.txt", "flash.sh"}
    assert set(results) == texts
    _, *rows = (re.split(r" {2,}", line) for line in results["wiring.txt"])
    wires = {row[0]: row[1:] for row in rows}
    ports = board("hx8k").ports(3, ["inputs", "outputs"])
    assert {port: wire[0] for port, wire in wires.items()} == {
        port: pin.pin for port, pin in ports.items() if port != "oscillator"
    }
    assert wires["step[1]"] == ["N16", "J2 9", "drive Y: STEP (PUL)"]
    assert wires["home[2]"] == ["T10", "J3 17", "Z: home switch"]
    assert wires["limit_low[0]"][-1] == wires["alarm[2]"][-1] == wires["sync"][-1] == "ground"
    assert wires["spi_sclk"][-1] == "Blue Pill PA5" and "compare" not in wires
    assert results["flash.sh"][-2:] == [
        "iceprog -S ./router.bin",
        "st-flash --reset write firmware/passo.bin 0x08000000",
    ]
    told = capsys.readouterr().out
    assert "12,000 steps/s of at most 200,000" in told and "EN is high from power-up on" in told


@pytest.mark.parametrize(
    "path", sorted((paths.examples / "machines").glob("*.toml")), ids=lambda path: path.stem
)
def test_examples(tmp_path: Path, path: Path) -> None:
    """Each is a machine of its board."""
    assert made(path, tmp_path)["flash.sh"]


def test_an_earlier_result_does_not_stay(tmp_path: Path) -> None:
    """If the file has become wrong, it is as it was; if it is right, all is new."""
    path, folder = tmp_path / "one.toml", tmp_path / "one"
    path.write_text(TEXT)
    before = made(path, folder)
    path.write_text(TEXT.replace("speed = 150", "speed = 15000", 1))
    assert main(["make", str(path), "--out", str(folder)]) == 2
    assert {file.name: file.read_text().splitlines() for file in folder.iterdir()} == before
    path.write_text(TEXT.replace("speed = 150", "speed = 100", 1))
    assert "$110=6000" in made(path, folder)["settings.txt"]


def test_settings_are_taken_one_by_one() -> None:
    """In that order, from any settings before; then they are those of the file."""
    machine = read_machine(ROUTER)
    said: list[str] = []
    with machine_at("model", machine) as engine:
        grbl = Grbl(engine, machine, said.append)
        grbl.line(b"$$")
        expected = "".join(said).partition("$0")[2]
        # a machine that is as different as can be
        for line in ("$0=31", "$29=31", "$100=1", "$101=1", "$102=1", "$22=0", "$110=500000", "$3=7", "$4=1"):
            said.clear()
            grbl.line(line.encode())
            assert "".join(said) == "ok\r\n", line
        for line in settings_lines(machine):
            said.clear()
            grbl.line(line.encode())
            assert "".join(said) == "ok\r\n", line
        said.clear()
        grbl.line(b"$$")
        assert "".join(said).partition("$0")[2] == expected


def test_the_firmware_takes_them(tmp_path: Path) -> None:
    """The image of the commands, at the core of the board, on the emulated chip; settings outlast a reset."""
    results = made(ROUTER, tmp_path)
    definitions = make_command.definitions(read_machine(ROUTER)).items()
    assert dict(definitions) == {
        "AXES": 3,
        "HOMES": 7,
        "LIMITS_LOW": 0,
        "LIMITS_HIGH": 0,
        "HOMED": 7,
        "PROBE": 1,
        "OUTPUTS": 1,
    }
    elf = grbl_elf(
        paths.build / "tests" / "firmware_router", *(f"{name}={value}" for name, value in definitions)
    )
    with model_engine(replace(core_for(read_machine(ROUTER)), axes=3), HZ) as engine:
        assert engine.parameters.clock_hz == HZ
        board = GrblBoard(engine, elf)
        first, *answers = (board.line(line) for line in results["settings.txt"])
        assert first == "[MSG:'$H'|'$X' to unlock]\nok" and set(answers) == {"ok"}
        board.restart()
        settings = board.line("$$").splitlines()
        assert {"$0=2.500", "$29=5.000", "$5=0", "$23=3", "$110=9000.000", "$112=1200.000"} < set(settings)
        assert f":{HZ}:0]" in board.line("$I")


def test_images(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """What is built, for what; a second run builds no firmware again; a bitstream that fails is an error."""
    asked = []

    def synth(*arguments: object) -> Bitstream | None:
        asked.append(arguments[:5])
        placed = Placed(True, False, 4321, 20, {"clk": (103.0, 96.0), "sclk": (50.0, 25.0)}, tmp_path)
        return Bitstream(tmp_path, placed, 7680, "LC", 96.0, 2, 77) if len(asked) < 3 else None

    monkeypatch.setattr(make_command.synth, "make", synth)
    path, folder = tmp_path / "one.toml", tmp_path / "out"
    path.write_text(TEXT.replace("probe", "clock_hz = 84_000_000\nprobe", 1))
    arguments = ["make", str(path), "--out", str(folder)]
    assert main(arguments) == 0
    assert asked == [(board("hx8k"), 3, 84.0, ("inputs", "outputs"), folder / "one.bin")]
    told = capsys.readouterr().out
    assert (
        "4,321 of 7,680 LC (56%); build 77" in told and "103.0 MHz for a clock of 96 MHz, margin 7.3%" in told
    )
    assert re.search(r"firmware +\d+ of 63488 bytes", (folder / "summary.txt").read_text())
    image = folder / "firmware" / "passo.bin"
    built = image.stat().st_mtime_ns
    assert main(arguments) == 0 and image.stat().st_mtime_ns == built
    assert main(arguments) == 1 and "bitstream  NONE" in (folder / "summary.txt").read_text()


MORE = "".join(
    f'[[axis]]\nname = "{name}"\nsteps_per_mm = 80\nspeed = 10\nacceleration = 100\n' for name in "AB"
)
ONE = MORE[: MORE.index("[[axis]]", 1)]
SPINDLE = "[spindle]\ncounts = 4000\n[[axis]]"
WRONG = [
    ("board =", "bord =", "unknown key 'bord'; did you mean board?"),
    ('"hx8k"', '"hx8"', "board must be one of .*, not 'hx8'; did you mean hx8k?"),
    ('board = "hx8k"\n', "clock_hz = 108_000_000\n", "board is missing; must be one of "),
    (
        'board = "hx8k"\n',
        'board = "hx8k"\nclock_hz = 100_000_000\n',
        "clock_hz is 100000000, but the PLL of the board hx8k makes 100500000",
    ),
    (
        'board = "hx8k"',
        'board = "hx8k"\nclock_hz = 24_000_000',
        "clock_hz is 24000000; the link of 9 MHz needs 36000000",
    ),
    ('board = "hx8k"', 'board = "colorlight"', "the table has no pins for part 'inputs'; it has none"),
    (
        'board = "hx8k"',
        'board = "hx8k"\nclock_hz = 900_000_000',
        "clock_hz: the PLL cannot generate 900 MHz from 12 MHz",
    ),
    ('"DM542"', '"DM524"', "drive must be one of .*; did you mean DM542?"),
    ("speed = 150", "speed = 2501", "axis 1: speed is 2501; the pins allow at most 2500"),
    ("speed = 150", 'speed = "150mm"', "axis 1: speed must be a number, not '150mm'"),
    ("speed = 150", "speed = -1", "axis 1: speed must not be negative"),
    ("acceleration = 500", "aceleration = 500", "axis 1: unknown key .*; did you mean acceleration?"),
    ('switches = ["home"]', "switches = []", 'axis 1: home = "low" needs "home" or "limit_low" in switches'),
    (
        'switches = ["home"]',
        'switches = ["end"]',
        "axis 1: switches must be an array of home, limit_low, limit_high",
    ),
    ('home = "low"', 'home = "left"', 'axis 1: home must be "low" or "high", not'),
    ('name = "Y"', 'name = "Z"', 'axis 3: name must be "A", "B" or "C", not'),
    (
        'drive = "DM542"',
        'drive = "DM542"\nprofile = "cosine"',
        'profile is "cosine"; the ramps of the firmware for STM32F103C8 are linear',
    ),
    (
        'drive = "DM542"',
        'drive = "DM542"\nchip = "STM32F103CB"\nprofile = "sigmoid"',
        'profile is "sigmoid"; the ramps of the firmware for STM32F103CB are linear or jerk',
    ),
    (
        'drive = "DM542"',
        'drive = "DM542"\nchip = "STM32F103C9"',
        "chip must be one of STM32F103C8, STM32F103CB, not 'STM32F103C9'; did you mean",
    ),
    (TEXT, TEXT + ONE, 'there are 4 axes; the firmware for STM32F103C8 has 3, chip = "STM32F103CB" 6'),
    ("inverted = false", "inverted = 1", "switches: inverted must be true or false|inverted must be"),
    ('switches = ["home"]', 'switches = ["home", "home"]', "axis 1: switches has home twice"),
    ("travel = 600", "travel = 0", "axis 1: travel must be greater than 0"),
    ("probe = true", "probe = true\nsoft_limits = 3", "soft_limits must be true or false"),
    ("steps_per_mm = 80", "steps_per_mm = 0", "axis 1: steps_per_mm must be greater than 0"),
    ('name = "X"', 'name = "X"\njump = 2', "axis X: jump is no setting of the firmware"),
    ("[switches]", '[pins]\nstep_high = "2mm"\n[switches]', "pins: step_high"),
    (
        "[switches]",
        '[pins]\nstep_high = "1ms"\n[switches]',
        "pins: step_high is 96000 clocks; must be at most 65535",
    ),
    ("[[axis]]", "[[axs]]", "unknown key 'axs'; did you mean axis?"),
    ("spindle_maximum = 24000", "spindle_maximum = 0", "spindle_maximum must be 1 to"),
    ("[switches]", "[switches", "Expected"),
    ("[[axis]]", SPINDLE, 'spindle: the firmware for STM32F103C8 has no threads, chip = "STM32F103CB" has'),
    (TEXT, TEXT + MORE, "axes: 5 requested, but the table has pins for 4"),
]


def test_the_encoder_of_a_spindle(tmp_path: Path) -> None:
    """It has the pins of the axis behind the motors, whose others lead nowhere; firmware and core know it."""
    path = tmp_path / "mill.toml"
    path.write_text('chip = "STM32F103CB"\n' + TEXT.replace("[[axis]]", SPINDLE, 1))
    results = made(path, tmp_path / "out")
    rows = {line.split()[0]: re.split(r" {2,}", line)[1:] for line in results["wiring.txt"]}
    assert rows["encoder_a[3]"] == ["B7", "J1 21", "encoder of the spindle: A"]
    assert rows["encoder_b[3]"] == ["C7", "J1 22", "encoder of the spindle: B"]
    assert rows["encoder_index[3]"] == ["C6", "J1 26", "encoder of the spindle: index"]
    assert {rows[f"{name}[3]"][-1] for name in ("step", "dir", "enable")} == {"not connected"}
    assert {rows[f"{name}[3]"][-1] for name in ("home", "limit_low", "alarm")} == {"ground"}
    assert rows["encoder_a[0]"][-1] == "not connected" and rows["step[2]"][-1].startswith("drive Z")
    assert any("AM26LV32" in line for line in results["wiring.html"])
    assert not any("AM26LV32" in line for line in made(ROUTER, tmp_path / "router")["wiring.html"])
    machine = read_machine(path)
    assert make_command.core_of(machine) == (4, 96.0, ("inputs", "encoders", "outputs"))
    assert make_command.definitions(machine)["TURN_COUNTS"] == 4000
    assert make_command.wired(machine, board("hx8k")) == {"ENCODER_WIRED": 1 << 3}
    assert (core_for(machine).axes, core_for(machine).encoders) == (4, 1)


def test_boards_without_pins_for_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "mill.toml"
    for name, said in (
        ("ulx3s", "the table has no pins for part 'encoders'"),
        ("icebreaker", "inputs.home: 4 are needed for 4 axes, the table has 3"),
    ):
        path.write_text('chip = "STM32F103CB"\n' + TEXT.replace("[[axis]]", SPINDLE, 1).replace("hx8k", name))
        assert main(["make", str(path), "--no-build"]) == 2
        assert said in capsys.readouterr().err


SMALL = [  # machines that other boards cannot be
    (
        "icebreaker",
        'switches = ["home", "limit_low"]',
        "axis 1: switches: the board icebreaker has one pin for home and",
    ),
    ("tangnano9k", 'switches = ["home"]', "inputs.limit_low: 4 are needed for 4 axes, the table has 3"),
    ("tangnano20k", 'switches = ["home"]', "axes: 4 requested, but the table has pins for 3"),
]


@pytest.mark.parametrize(("name", "switches", "said"), SMALL)
def test_small_boards(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, switches: str, said: str
) -> None:
    """Pins that are shared, pins that are too few."""
    path = tmp_path / "small.toml"
    more = ONE if name.startswith("tangnano") else ""
    large = f'chip = "STM32F103CB"\n{TEXT}'
    path.write_text(large.replace("hx8k", name).replace('switches = ["home"]', switches, 1) + more)
    assert main(["make", str(path), "--out", str(tmp_path / "out")]) == 2
    assert said in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_one_pin_for_two(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Outputs on the pins of a fifth axis."""
    path = tmp_path / "five.toml"
    text = (paths.examples / "machines" / "motors.toml").read_text().replace("tangnano9k", "icebreaker")
    fifth = ONE.replace('"A"', '"B"')
    path.write_text(text.replace("drive =", "spindle_maximum = 1000\ndrive =") + fifth)
    assert main(["make", str(path), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"{path}: ") and told.count("\n") == 1
    assert "outputs.outputs[0]: pin 45 is already used by axes[4].enable" in told
    assert not (tmp_path / "out").exists()


def test_one_pin_of_a_switch_is_on_the_sheet(tmp_path: Path) -> None:
    """Of a board that shares them; which one it is."""
    path = tmp_path / "small.toml"
    text = TEXT.replace("hx8k", "icebreaker").replace('switches = ["home"]', 'switches = ["limit_low"]', 1)
    path.write_text(text)
    rows = dict(re.split(r" {2,}", line, maxsplit=1) for line in made(path, tmp_path / "out")["wiring.txt"])
    assert rows["home[0]"].endswith("X: limit, low end") and rows["home[1]"].endswith("Y: home switch")
    assert not {"limit_low[0]", "alarm[0]", "compare"} & set(rows) and "outputs[2]" in rows


@pytest.mark.parametrize(("old", "new", "said"), WRONG)
def test_wrong_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, said: str
) -> None:
    """One sentence with the file, the key and the reason; nothing is written."""
    path = tmp_path / "wrong.toml"
    assert old in TEXT
    path.write_text(TEXT.replace(old, new, 1))
    assert main(["make", str(path), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"{path}: ") and told.count("\n") == 1 and re.search(said, told)
    assert not (tmp_path / "out").exists()
