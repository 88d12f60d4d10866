// SPDX-License-Identifier: MIT
// Line counter: counts the substeps of the current line, brings in the next one, and leads the DDAs of all
// axes.
//
//   substep_number = substeps of this line so far;  the substep with the number M - 1 (`last_substep`) is its last
//
// A substep takes two clocks in the DDAs, A (slot_add) and B; the last substep of a line and the start of a
// motion load the start value of the line that follows in B (slot_load). `broadcast` is -M in A, and floor(-M
// / 2) of the new line when slot_load is high; -M is ~(M - 1).
//
// Promise: the next line follows without a lost clock, even with M = 1 and a substep every second clock.
// After the last substep of a LAST line `ended` rises and further substeps are ignored. When a line that is
// not LAST ends and none follows, `underrun` is high for a clock and further substeps are ignored.
// Latency: substep to slot_add 1 clock, to slot_step 2 clocks.
`resetall
`default_nettype none

module passo_line #(
  parameter AXES = 4
) (
  input  wire                   clk,
  input  wire                   rst,
  input  wire                   start,            // take the first line of a motion
  input  wire                   stop,             // forget the current line
  input  wire                   substep,
  // line queue
  input  wire                   next_valid,
  input  wire                   next_last,
  input  wire                   next_endless,
  input  wire        [AXES-1:0] next_directions,
  input  wire        [    31:0] last_substep,     // M - 1 of the current line, from a clock after take
  output wire                   take,
  // DDAs
  output reg                    slot_add,         // A: e += N
  output reg                    slot_load,        // A: a new line begins
  output reg                    slot_step,        // B: a step if e >= 0
  output reg                    slot_load_q,      // B: e = start value
  output wire signed [    32:0] broadcast,
  output reg         [AXES-1:0] directions,       // of the line whose steps are being made
  // motion
  output reg                    endless,          // the current line is ENDLESS
  output reg                    ended,
  output reg                    underrun
);

  reg            active;
  reg            last;
  reg            goes_on;  // active, and not last
  reg [    31:0] substep_number;
  reg            on_last;  // the next substep is the last; known two clocks after a substep
  reg [AXES-1:0] directions_next;

  wire substep_taken = substep & active;
  wire line_done = substep_taken & on_last;

  assign take = start | (substep & on_last & goes_on & next_valid);

  assign broadcast = slot_load ? {2'b11, ~last_substep[31:1]} : {1'b1, ~last_substep};

  always @(posedge clk) begin
    slot_add    <= substep_taken;
    slot_load   <= take;
    slot_step   <= slot_add;
    slot_load_q <= slot_load;

    on_last <= substep_number == last_substep;
    if (substep_taken) substep_number <= substep_number + 32'd1;
    if (take) begin
      substep_number  <= 32'd0;
      last            <= next_last;
      endless         <= next_endless;
      directions_next <= next_directions;
    end

    // the last step of the old line is made in B
    if (slot_load_q) directions <= directions_next;

    underrun <= line_done & ~last & ~next_valid;
    if (line_done && !take) {active, goes_on} <= 2'b00;
    if (line_done && last) ended <= 1'b1;
    if (take) goes_on <= ~next_last;
    if (start) begin
      active <= 1'b1;
      ended  <= 1'b0;
    end
    if (rst || stop) begin
      active      <= 1'b0;
      goes_on     <= 1'b0;
      ended       <= 1'b0;
      endless     <= 1'b0;
      underrun    <= 1'b0;
      slot_add    <= 1'b0;
      slot_load   <= 1'b0;
      slot_step   <= 1'b0;
      slot_load_q <= 1'b0;
    end
    if (rst) directions <= {AXES{1'b0}};
  end

`ifdef FORMAL
  `include "passo_line_formal.vh"
`endif

endmodule
`resetall
