// SPDX-License-Identifier: MIT
// Line counter: counts the substeps of the current line, takes the next line, and drives the DDAs of all axes.
//
//   substep_number = substeps of this line so far;  the substep with the number M - 1 (`last_substep`) is its last
//
// A substep takes two clocks in the DDAs, A (add_n) and B (decide_step). The last substep of a line and the start of
// a motion load the start value of the next line: load_start in A, load_start_q in B. In A `line_addend` is -M, which
// is ~(M - 1), or with load_start floor(-M / 2) of the new line.
//
// Promise: the next line follows without a lost clock, even with M = 1 and a substep every second clock. After the
// last substep of a LAST line `ended` rises and further substeps are ignored; an ENDLESS line that is not LAST
// repeats. When any other line ends and none follows, `underrun` is high for one clock and further substeps are
// ignored.
// Latency: substep to add_n 1 clock, to decide_step 2 clocks.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_line #(
  parameter AXES = 4
) (
  input  wire                   clk,
  input  wire                   rst,
  input  wire                   start,               // take the first line of a motion
  input  wire                   stop,                // drop the current line
  input  wire                   substep,
  // line queue
  input  wire                   next_valid,
  output wire                   take,
  input  wire                   last,                // of the current line, from one clock after take
  input  wire                   endless,
  input  wire        [    29:0] last_substep,        // its M - 1
  input  wire        [AXES-1:0] current_directions,  // from two clocks after take
  // DDAs
  output reg                    add_n,               // A: e += N
  output reg                    load_start,          // A: a line begins, clear
  output reg                    decide_step,         // B: a step if e >= M
  output reg                    load_start_q,        // B: e = start value
  output wire signed [    30:0] line_addend,
  output reg         [AXES-1:0] directions,          // of the line whose steps are being made
  // motion
  output reg                    current_endless,     // two clocks after take
  output reg                    ended,
  output reg                    underrun,
  // outputs
  output wire                   line_begins,         // strobe: the next substep is the first of a line
  output wire                   substep_taken        // a substep of a line
);

  reg         active;
  reg  [29:0] substep_number;
  reg         repeats;  // when the line ends, it repeats
  reg         goes_on;  // when the line ends, another one must follow
  // The next substep is the last: compared in parts, valid two clocks after a substep.
  // Kept: two bits of the comparison fit one LUT.
  (* keep *)
  wire [14:0] pair_equal;
  reg  [ 3:0] equal;
  // Kept: two LUTs to `take`, which many registers wait for.
  (* keep *)
  wire on_last, may_take, takes;
  assign on_last  = &equal;
  assign may_take = goes_on & next_valid;

  genvar i;
  generate
    for (i = 0; i < 15; i = i + 1) begin : g_pair
      assign pair_equal[i] = substep_number[2*i+:2] == last_substep[2*i+:2];
    end
  endgenerate

  assign substep_taken = substep & active;
  wire line_done = substep_taken & on_last;

  assign takes       = start | (substep & on_last & may_take);
  assign take        = takes;
  assign line_begins = take | (substep & on_last & repeats);

  assign line_addend = load_start ? {2'b11, ~last_substep[29:1]} : {1'b1, ~last_substep};

  always @(posedge clk) begin
    add_n        <= substep_taken;
    load_start   <= line_begins;
    decide_step  <= add_n;
    load_start_q <= load_start;

    equal           <= {&pair_equal[14:12], &pair_equal[11:8], &pair_equal[7:4], &pair_equal[3:0]};
    current_endless <= endless;
    repeats         <= active & endless & ~last;
    goes_on         <= active & ~endless & ~last;
    if (start || substep) substep_number <= start || on_last ? 30'd0 : substep_number + 30'd1;

    // B still outputs the last step of the old line
    if (load_start_q) directions <= current_directions;

    underrun <= substep & on_last & goes_on & ~next_valid;
    if (line_done && !repeats && !may_take) active <= 1'b0;
    if (line_done && last) ended <= 1'b1;
    if (start) begin
      active <= 1'b1;
      ended  <= 1'b0;
    end
    if (rst || stop) begin
      active       <= 1'b0;
      repeats      <= 1'b0;
      goes_on      <= 1'b0;
      ended        <= 1'b0;
      underrun     <= 1'b0;
      add_n        <= 1'b0;
      load_start   <= 1'b0;
      decide_step  <= 1'b0;
      load_start_q <= 1'b0;
    end
    if (rst) directions <= {AXES{1'b0}};
  end

`ifdef FORMAL
  `include "passo_line_formal.vh"
`endif

endmodule
`resetall
