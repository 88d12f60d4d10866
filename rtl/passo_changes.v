// SPDX-License-Identifier: MIT
// Pending output changes: delays them by `lag` clocks in a block RAM queue of time-stamped changes.
//
// Promise: while `lag` is constant, a change comes out 3 + lag clocks after it went in (`hit`; `data` is valid one
// clock earlier), in order, none lost or duplicated. A change that finds 2^DEPTH_LOG2 others queued is lost:
// `overflow` is high for one clock. `flush` empties the queue. Changes are at least 2 clocks apart.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_changes #(
  parameter WIDTH      = 25,
  parameter DEPTH_LOG2 = 8
) (
  input  wire             clk,
  input  wire             rst,
  input  wire             flush,
  input  wire [     15:0] lag,
  input  wire             change,    // strobe, with data_in
  input  wire [WIDTH-1:0] data_in,
  output reg              hit,       // strobe, with data
  output wire [WIDTH-1:0] data,
  output reg              overflow,
  output reg              empty
);

  localparam [DEPTH_LOG2:0] DEPTH = 1 << DEPTH_LOG2;

  reg  [        15:0] now;
  reg  [        15:0] ahead;  // now + 3
  reg  [        15:0] due;  // of a change in this clock: now + lag + 2
  reg  [DEPTH_LOG2:0] write_place;
  reg  [DEPTH_LOG2:0] read_place;
  reg  [DEPTH_LOG2:0] read_next;  // read_place + 1
  reg                 full;
  reg                 valid;  // the memory shows the oldest change
  wire [        15:0] time_out;
  wire [DEPTH_LOG2:0] reads = hit ? read_next : read_place;
  wire                push = change & ~full;

  passo_memory #(
    .WIDTH        (16 + WIDTH),
    .DEPTH_LOG2   (DEPTH_LOG2),
    .DATA_REGISTER(0)
  ) u_memory (
    .clk          (clk),
    .write        (push),
    .write_address(write_place[DEPTH_LOG2-1:0]),
    .write_data   ({due, data_in}),
    .read_address (reads[DEPTH_LOG2-1:0]),
    .load         (1'b1),
    .read_data    ({time_out, data})
  );

  always @(posedge clk) begin
    now   <= now + 16'd1;
    ahead <= ahead + 16'd1;
    due   <= ahead + lag;
    hit   <= valid && time_out == now;
    valid <= reads != write_place;
    full  <= (write_place ^ read_place) == DEPTH;
    if (push) write_place <= write_place + 1'b1;
    read_place <= reads;
    read_next  <= reads + 1'b1;
    overflow   <= change & full;
    empty      <= reads == write_place && !change;
    if (rst) begin
      now   <= 16'd0;
      ahead <= 16'd3;
    end
    if (rst || flush) begin
      write_place <= {(DEPTH_LOG2 + 1) {1'b0}};
      read_place  <= {(DEPTH_LOG2 + 1) {1'b0}};
      read_next   <= {{DEPTH_LOG2{1'b0}}, 1'b1};
      hit         <= 1'b0;
      valid       <= 1'b0;
      full        <= 1'b0;
      overflow    <= 1'b0;
      empty       <= 1'b1;
    end
  end

`ifdef FORMAL
  `include "passo_changes_formal.vh"
`endif

endmodule
`resetall
