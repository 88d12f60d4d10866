// SPDX-License-Identifier: MIT
// Line queue: lines as they are pushed, one block RAM column for each of their words, so that a whole line is
// read at once.
//
// Promise: lines come out whole and in order. The next line's control and length are always at the output
// (`next_valid`); `take` makes it the current line, whose step counts are at the output two clocks later and
// stay there. An ENDLESS line stays the next line when it is taken. A place is free again when the line after
// it is taken, or on `release_line`. `flush` drops everything that is written; it stays while the channel is
// stopped, for a push that was checked before.
//
// A push is checked word by word (`bus_check`): room for it after all lines of this frame before it, M not 0,
// N_i <= M, no reserved bits. `refusal` answers one clock later. The M column holds -M, as the line counter
// and the DDA want it.
`resetall
`default_nettype none

module passo_line_queue #(
  parameter AXES       = 4,
  parameter DEPTH_LOG2 = 8
) (
  input  wire                clk,
  input  wire                rst,
  // bus; `select`: a push to this queue
  input  wire                bus_frame,
  input  wire                bus_check,
  input  wire                bus_write,
  input  wire                select,
  input  wire [        31:0] bus_data,
  input  wire                blocked,              // the channel is stopped
  output reg  [         3:0] refusal,
  output wire                incomplete,           // the frame so far ends within a line
  output reg  [DEPTH_LOG2:0] room,                 // in lines
  // to the line counter
  input  wire                take,
  input  wire                release_line,
  input  wire                flush,
  output reg                 next_valid,
  output wire                next_last,
  output wire                next_endless,
  output wire [    AXES-1:0] next_directions,
  output wire [        31:0] next_minus_substeps,  // -M
  output wire [ AXES*32-1:0] steps                 // N_i of the current line
);

  `include "passo_registers.vh"

  localparam CONTROL_BITS = 2 + AXES;
  localparam [31:0] CONTROL_DEFINED = (((1 << AXES) - 1) << 8) | 3;
  localparam [3:0] INDEX_CONTROL = 4'd0;
  localparam [3:0] INDEX_SUBSTEPS = 4'd1;
  localparam [3:0] INDEX_STEPS = 4'd2;
  localparam [3:0] INDEX_LAST = INDEX_STEPS + AXES[3:0] - 4'd1;

  // Writing: one word of a line after the other
  reg [         3:0] index;
  reg [DEPTH_LOG2:0] write_line;
  reg [DEPTH_LOG2:0] checked;  // lines of this frame
  reg [        31:0] checked_substeps;

  wire strobe = select & (bus_check | bus_write);
  wire write = select & bus_write;
  wire line_complete = index == INDEX_LAST;

  assign incomplete = index != INDEX_CONTROL;

  always @(posedge clk) begin
    if (strobe) begin
      index <= line_complete ? INDEX_CONTROL : index + 4'd1;
      if (index == INDEX_SUBSTEPS) checked_substeps <= bus_data;
      if (line_complete && bus_check) checked <= checked + 1'b1;
      if (line_complete && bus_write) write_line <= write_line + 1'b1;
    end
    if (rst || bus_frame) begin
      index   <= INDEX_CONTROL;
      checked <= {(DEPTH_LOG2 + 1) {1'b0}};
    end
    if (rst) write_line <= {(DEPTH_LOG2 + 1) {1'b0}};
  end

  // what is to be said of the word, a clock before it is asked
  reg  full;
  reg  bad_control;
  reg  bad_substeps;
  reg  bad_steps;
  wire bad_value = index == INDEX_CONTROL ? bad_control : index == INDEX_SUBSTEPS ? bad_substeps : bad_steps;

  always @(posedge clk) begin
    full <= room == checked;
    bad_control <= (bus_data & ~CONTROL_DEFINED) != 32'd0;
    bad_substeps <= bus_data == 32'd0;
    bad_steps <= bus_data > checked_substeps;
    refusal      <= !(select && bus_check) ? VERDICT_OK :
                    blocked                ? VERDICT_BUSY :
                    full                   ? VERDICT_QUEUE_FULL :
                    bad_value              ? VERDICT_BAD_VALUE : VERDICT_OK;
  end

  // Reading
  reg  [DEPTH_LOG2:0] next_line;
  reg  [DEPTH_LOG2:0] current_line;  // = next_line when there is none
  wire [DEPTH_LOG2:0] line_after_next = next_line + 1'b1;

  always @(posedge clk) begin
    if (take) begin
      current_line <= next_line;
      if (!next_endless) next_line <= line_after_next;
    end
    if (release_line) begin
      // an ENDLESS line is both current and next
      if (next_valid && next_endless) next_line <= line_after_next;
      current_line <= next_valid && next_endless ? line_after_next : next_line;
    end
    next_valid <= ~take & ~release_line & ~flush & next_line != write_line;
    room       <= {1'b1, {DEPTH_LOG2{1'b0}}} - (write_line - current_line);
    if (flush) begin
      next_line    <= write_line;
      current_line <= write_line;
    end
    if (rst) begin
      next_line    <= {(DEPTH_LOG2 + 1) {1'b0}};
      current_line <= {(DEPTH_LOG2 + 1) {1'b0}};
      next_valid   <= 1'b0;
    end
  end

  passo_memory #(
    .WIDTH     (CONTROL_BITS),
    .DEPTH_LOG2(DEPTH_LOG2)
  ) u_control (
    .clk          (clk),
    .write        (write && index == INDEX_CONTROL),
    .write_address(write_line[DEPTH_LOG2-1:0]),
    .write_data   ({bus_data[8+:AXES], bus_data[1:0]}),
    .read_address (next_line[DEPTH_LOG2-1:0]),
    .read_data    ({next_directions, next_endless, next_last})
  );

  passo_memory #(
    .WIDTH     (32),
    .DEPTH_LOG2(DEPTH_LOG2)
  ) u_substeps (
    .clk          (clk),
    .write        (write && index == INDEX_SUBSTEPS),
    .write_address(write_line[DEPTH_LOG2-1:0]),
    .write_data   (-bus_data),
    .read_address (next_line[DEPTH_LOG2-1:0]),
    .read_data    (next_minus_substeps)
  );

  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      passo_memory #(
        .WIDTH     (32),
        .DEPTH_LOG2(DEPTH_LOG2)
      ) u_steps (
        .clk          (clk),
        .write        (write && index == INDEX_STEPS + axis),
        .write_address(write_line[DEPTH_LOG2-1:0]),
        .write_data   (bus_data),
        .read_address (current_line[DEPTH_LOG2-1:0]),
        .read_data    (steps[axis*32+:32])
      );
    end
  endgenerate

endmodule
`resetall
