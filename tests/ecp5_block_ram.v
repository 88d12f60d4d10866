// SPDX-License-Identifier: MIT
// The block RAM of an ECP5 as far as tests need it: words of 9, 18 or 36 bits, synchronous resets, no chip
// selects. Its pins are gathered in vectors.
//
// Promise: as the vendor describes it. A port with CE reads on each clock, but not if it writes in the mode
// NORMAL; a word that is written on that clock is still the old one; RST makes it 0. With OUTREG it goes
// through a register, which begins as 0 and has an enable: OCE. With words of 36 bits port A writes and port B
// reads; all outputs and their registers are then of B, but REGMODE_A still says whether DOA is registered.
`resetall
`default_nettype none

module DP16KD #(
  parameter DATA_WIDTH_A        = 18,
  parameter DATA_WIDTH_B        = 18,
  parameter REGMODE_A           = "NOREG",
  parameter REGMODE_B           = "NOREG",
  parameter CLKAMUX             = "CLKA",
  parameter CLKBMUX             = "CLKB",
  parameter OCEAMUX             = "OCEA",
  parameter OCEBMUX             = "OCEB",
  parameter WRITEMODE_A         = "NORMAL",
  parameter WRITEMODE_B         = "NORMAL",
  parameter CSDECODE_A          = "0b000",
  parameter CSDECODE_B          = "0b000",
  parameter RESETMODE           = "SYNC",
  parameter ASYNC_RESET_RELEASE = "SYNC",
  parameter GSR                 = "ENABLED"
) (
  input  wire        CLKA,
  input  wire        CEA,
  input  wire        OCEA,
  input  wire        WEA,
  input  wire        RSTA,
  input  wire [13:0] ADA,
  input  wire [17:0] DIA,
  output wire [17:0] DOA,
  input  wire        CLKB,
  input  wire        CEB,
  input  wire        OCEB,
  input  wire        WEB,
  input  wire        RSTB,
  input  wire [13:0] ADB,
  input  wire [17:0] DIB,
  output wire [17:0] DOB
);

  localparam WIDE = DATA_WIDTH_A == 36;

  wire clk_a = CLKA ^ (CLKAMUX == "INV");
  wire clk_b = CLKB ^ (CLKBMUX == "INV");

  // Bytes of 9 bits. Of words with several bytes, the lowest bits of an address choose those to be written.
  reg [8:0] bytes[0:2047];
  wire [10:0] first_a = ADA[13:3] & ~(DATA_WIDTH_A / 9 - 1);
  wire [10:0] first_b = ADB[13:3] & ~(DATA_WIDTH_B / 9 - 1);
  wire [3:0] write_a = !(CEA && WEA) ? 4'd0 : DATA_WIDTH_A == 9 ? 4'd1 : ADA[3:0] & {{2{WIDE}}, 2'b11};
  wire [3:0] write_b = !(CEB && WEB) || WIDE ? 4'd0 : DATA_WIDTH_B == 9 ? 4'd1 : ADB[3:0] & 4'b0011;
  wire [35:0] to_write = {DIB, DIA};

  integer i;
  initial for (i = 0; i < 2048; i = i + 1) bytes[i] = 9'd0;

  always @(posedge clk_a) for (i = 0; i < 4; i = i + 1) if (write_a[i]) bytes[first_a+i] <= to_write[9*i+:9];
  always @(posedge clk_b) for (i = 0; i < 2; i = i + 1) if (write_b[i]) bytes[first_b+i] <= DIB[9*i+:9];

  reg [17:0] read_a = 18'd0;
  reg [17:0] read_b = 18'd0;
  reg [17:0] register_a = 18'd0;
  reg [17:0] register_b = 18'd0;

  // what belongs to the outputs of A
  wire        clk_of_a = WIDE ? clk_b : clk_a;
  wire        reset_of_a = WIDE ? RSTB : RSTA;
  wire        load_a = WIDE ? OCEB ^ (OCEBMUX == "INV") : OCEA ^ (OCEAMUX == "INV");
  wire        load_b = OCEB ^ (OCEBMUX == "INV");
  wire        reads_a = WIDE ? CEB : CEA && !(WEA && WRITEMODE_A == "NORMAL");
  wire        reads_b = CEB && (WIDE || !(WEB && WRITEMODE_B == "NORMAL"));
  wire [10:0] low_a = WIDE ? first_b : first_a;
  wire [10:0] low_b = WIDE ? first_b + 11'd2 : first_b;

  always @(posedge clk_of_a) begin
    if (reset_of_a) read_a <= 18'd0;
    else if (reads_a) read_a <= {bytes[low_a+11'd1], bytes[low_a]};
    if (load_a) register_a <= reset_of_a ? 18'd0 : read_a;
  end

  always @(posedge clk_b) begin
    if (RSTB) read_b <= 18'd0;
    else if (reads_b) read_b <= {bytes[low_b+11'd1], bytes[low_b]};
    if (load_b) register_b <= RSTB ? 18'd0 : read_b;
  end

  assign DOA = REGMODE_A == "OUTREG" ? register_a : read_a;
  assign DOB = REGMODE_B == "OUTREG" ? register_b : read_b;

endmodule
`resetall
