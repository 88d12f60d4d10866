# SPDX-License-Identifier: MIT
"""Pins in Verilog: their recorder and player, and the core with a clock."""

from collections.abc import Sequence

from pins.schema import GENERATED, Pin, Source

NEXT = "\n  "
WORD = 32  # bits of a parameter that is not an integer


def concatenated(pins: Sequence[str]) -> str:
    """The pins as one vector of 64 bits each, the first in the lowest bits."""
    return ",\n".join(f"  64'd0 | {name}" for name in reversed(pins))


def probe(source: Source) -> str:
    """The recorder of the pins, at the end of passo_spi_top."""
    names = [pin.name for pin in source.inputs] + ["spi_miso"] + [pin.name for pin in source.outputs]
    widths = [pin.width for pin in (*source.inputs, *source.outputs)]
    return f"""\
// SPDX-License-Identifier: MIT
// Recorder of the pins of the core. {GENERATED}
//
// Clock 1 is the first rising edge ever without rst. Whenever a pin is not as it was a clock before, a row
// goes to pins.log: the clock; the inputs and MISO as they stand at its rising edge; the other outputs as the
// rising edge before left them. The numbers are decimal; one with an X in it is not a number.

localparam PINS = 1 + {" + ".join(widths)};

wire [PINS-1:0] pins = {{{", ".join(names)}}};
reg  [PINS-1:0] pins_before;
reg             begun = 1'b0;
reg  [    31:0] clock = 0;
integer         file;

initial file = $fopen("pins.log", "w");

always @(posedge clk) begin
  pins_before <= pins;
  if (begun || rst === 1'b0) begin
    begun <= 1'b1;
    clock <= clock + 1;
    if (!begun || pins !== pins_before) begin
      $fwrite(file, "%0d{" %0d" * len(names)}\\n", clock + 1, {", ".join(names)});
      $fflush(file);
    end
  end
end
"""


def engine(source: Source) -> str:
    """The core with a clock of its own."""
    inputs, outputs = source.inputs, source.outputs
    names = [parameter.name.upper() for parameter in source.parameters]
    levels = [level.upper() for level in source.levels]
    parameters = [
        *(
            f"parameter integer {parameter.name.upper()} = {parameter.default}"
            if parameter.bits < WORD
            else f"parameter [{parameter.bits - 1}:0] {parameter.name.upper()} = {parameter.default}"
            for parameter in source.parameters
        ),
        *(f"parameter [CHANNELS*AXES-1:0] {level} = 0" for level in levels),
    ]
    ports = [
        *(f"input wire {pin.verilog}" for pin in inputs),
        *(f"output wire {pin.verilog}" for pin in (*outputs, Pin("spi_miso"))),
        "input wire go",
        "input wire [15:0] limit",
        "output reg [15:0] clocks",
    ]
    pins = ["clk", *(pin.name for pin in inputs), *(pin.name for pin in outputs), "spi_miso"]
    return f"""\
// SPDX-License-Identifier: MIT
// The core with a clock of its own. {GENERATED}
//
// A change of `go` runs clocks: up to `limit`, at least 1, ending with the first on which an output other
// than MISO is not as it was after the clock before. Then `clocks` is their number, and clk is low. They are
// one evaluation of a simulator: each evaluation costs time of its own.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_engine #(
  {f",{NEXT}".join(parameters)}
) (
  {f",{NEXT}".join(ports)}
);

  localparam PINS = {" + ".join(pin.width for pin in outputs)};

  reg             clk = 1'b0;
  reg             went = 1'b0;
  reg  [PINS-1:0] pins_before = {{PINS{{1'b0}}}};
  wire [PINS-1:0] pins = {{{", ".join(pin.name for pin in outputs)}}};

  always @(posedge go or negedge go or posedge clk or negedge clk) begin
    if (clk) begin
      clk    <= 1'b0;
      clocks <= clocks + 16'd1;
    end else if (went != go) begin
      clk    <= 1'b1;
      went   <= go;
      clocks <= 16'd0;
    end else begin
      clk         <= clocks != limit && pins == pins_before;
      pins_before <= pins;
    end
  end

`ifdef PASSO_NETLIST
  passo_spi_top u_core (
`else
  passo_spi_top #(
    {f",{NEXT}  ".join(f".{name}({name})" for name in (*names, *levels))}
  ) u_core (
`endif
    .spi_miso_enable(),
    {f",{NEXT}  ".join(f".{name}({name})" for name in pins)}
  );

endmodule
`resetall
"""


def player(source: Source) -> str:
    """Pins of the soak's player, as variables and as vectors of 64 bits each."""
    inputs, outputs = source.inputs, [*source.outputs, Pin("spi_miso")]
    form = " ".join(f"{pin.name} %h %h" for pin in outputs)
    shown = ", ".join(f"{pin.name}, wanted[{64 * i}+:64]" for i, pin in enumerate(outputs))
    return "\n".join(
        [
            "// SPDX-License-Identifier: MIT",
            f"// Pins of the core as 64 bits each, the first in the lowest bits. {GENERATED}",
            "",
            f"localparam INPUT_COUNT = {len(inputs)};",
            f"localparam OUTPUT_COUNT = {len(outputs)};",
            "",
            *(f"reg {pin.verilog} = {pin.idle_level};" for pin in inputs),
            *(f"wire {pin.verilog};" for pin in outputs),
            "",
            "reg  [64*OUTPUT_COUNT-1:0] wanted;",
            "wire [64*OUTPUT_COUNT-1:0] seen = {",
            concatenated([pin.name for pin in outputs]),
            "};",
            "",
            "task set_inputs(input [64*INPUT_COUNT-1:0] levels);",
            "  begin",
            *(f"    {pin.name} = levels[{64 * i}+:64];" for i, pin in enumerate(inputs)),
            "  end",
            "endtask",
            "",
            "task tell_difference(input [31:0] clock);",
            f'  $display("clock %0d: {form}", clock, {shown});',
            "endtask",
            "",
        ]
    )
