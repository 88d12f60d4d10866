// SPDX-License-Identifier: MIT
// Raster: a queue of 8-bit values, four per word, and the substeps that take them.
//
// Promise: in a raster line the first substep takes a value and every `pitch` substeps after it the next, lowest byte
// of a word first; a line begins with a whole word; the rest of its predecessor's last word is dropped. `take` is high
// in the clock of such a substep, `value` is what it takes: 0 from an empty queue, and then `missed` is high one clock
// later. `first` is high for the first substep of any line. A change of `pitch` counts from the next value on. `room`
// excludes all words of a frame from one clock after its commit begins to write. `flush` drops everything written.
// Substeps are at least 2 clocks apart.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_raster #(
  parameter DEPTH_LOG2 = 8
) (
  input  wire                clk,
  input  wire                rst,
  // bus; `select`: a push to this queue
  input  wire                bus_frame,
  input  wire                bus_commit,
  input  wire                bus_check,
  input  wire                bus_write,
  input  wire                select,
  input  wire [        31:0] bus_data,
  input  wire                flush,        // the channel is stopped
  output reg  [         3:0] refusal,
  output reg  [DEPTH_LOG2:0] room,         // in words
  // line
  input  wire                line_begins,
  input  wire                substep,      // of a line
  input  wire                raster,       // the line is one, from two clocks after it began
  input  wire [        29:0] pitch,        // above 0
  output reg                 first,
  output wire                take,
  output wire [         7:0] value,
  output reg                 missed
);

  `include "passo_registers.vh"

  localparam [DEPTH_LOG2:0] DEPTH = 1 << DEPTH_LOG2;

  // Writing
  reg  [DEPTH_LOG2:0] write_word;
  reg  [DEPTH_LOG2:0] write_end;  // write_word after this frame
  reg  [DEPTH_LOG2:0] checked;  // words of this frame
  reg                 full;
  wire                write = select & bus_write;

  // Reading
  reg  [DEPTH_LOG2:0] read_word;
  reg  [         1:0] index;  // of the next value in its word
  reg                 available;
  reg  [        29:0] left;  // substeps to the next value
  reg                 due;
  wire [        31:0] word;

  assign take  = substep & raster & (first | due);
  assign value = word[index*8+:8] & {8{available}};

  wire used = take & available;
  wire word_used = line_begins ? used || index != 2'd0 : used && index == 2'd3;

  passo_memory #(
    .WIDTH        (32),
    .DEPTH_LOG2   (DEPTH_LOG2),
    .DATA_REGISTER(0)
  ) u_memory (
    .clk          (clk),
    .write        (write),
    .write_address(write_word[DEPTH_LOG2-1:0]),
    .write_data   (bus_data),
    .read_address (read_word[DEPTH_LOG2-1:0]),
    .load         (1'b1),
    .read_data    (word)
  );

  always @(posedge clk) begin
    if (write) write_word <= write_word + 1'b1;
    if (select && bus_check) checked <= checked + 1'b1;
    if (rst || bus_frame) checked <= {(DEPTH_LOG2 + 1) {1'b0}};
    if (bus_frame && bus_commit) write_end <= write_word + checked;
    full <= room == checked;
    refusal <= !(select && bus_check) ? VERDICT_OK :
               flush                  ? VERDICT_BUSY :
               full                   ? VERDICT_QUEUE_FULL : VERDICT_OK;
    room <= (read_word ^ DEPTH) - write_end;

    available <= read_word != write_word;
    if (word_used) read_word <= read_word + 1'b1;
    index <= line_begins ? 2'd0 : index + {1'b0, used};
    first <= line_begins | (first & ~substep);
    due   <= left == 30'd1;
    if (take) left <= pitch;
    else if (substep) left <= left - 30'd1;
    missed <= take & ~available;
    if (rst || flush) begin
      write_word <= {(DEPTH_LOG2 + 1) {1'b0}};
      write_end  <= {(DEPTH_LOG2 + 1) {1'b0}};
      read_word  <= {(DEPTH_LOG2 + 1) {1'b0}};
      available  <= 1'b0;
      index      <= 2'd0;
      first      <= 1'b0;
      missed     <= 1'b0;
    end
    if (rst) room <= DEPTH;
  end

`ifdef FORMAL
  `include "passo_raster_formal.vh"
`endif

endmodule
`resetall
