// SPDX-License-Identifier: MIT
// Line queue: lines as they are pushed, one block RAM column for each of their words, so that a whole line is
// read at once.
//
// Promise: lines come out whole and in order. The next line's control is always at the output (`next_valid`);
// `take` makes it the current line, whose last_substep is at the output one clock later, whose step counts two
// clocks later; they stay there. An ENDLESS line stays the next line when it is taken. A place is free again
// when the line after it is taken, or on `release_line`. `flush` drops everything that is written; it stays
// while the channel is stopped, for a push that was checked before.
//
// A push is checked word by word (`bus_check`; the word stands two clocks before): room for it after all lines of
// this frame before it, M not 0, N_i <= M, no reserved bits. `refusal` answers one clock later. One subtraction
// serves the checks and makes what is stored of M, which is M - 1, the number of the last substep.
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
  input  wire [         4:0] bus_top_bit,
  input  wire                blocked,          // the channel is stopped
  output reg  [         3:0] refusal,
  output wire                incomplete,       // the frame so far ends within a line
  output reg  [DEPTH_LOG2:0] room,             // in lines
  // to the line counter
  input  wire                take,
  input  wire                release_line,
  input  wire                flush,
  output reg                 next_valid,
  output wire                next_last,
  output wire                next_endless,
  output wire [    AXES-1:0] next_directions,
  output reg  [        31:0] last_substep,     // M - 1 of the current line
  output wire [ AXES*32-1:0] steps             // N_i of the current line
);

  `include "passo_registers.vh"

  localparam CONTROL_BITS = 2 + AXES;
  localparam [4:0] CONTROL_TOP_BIT = 5'd7 + AXES[4:0];
  localparam INDEX_CONTROL = 0;
  localparam INDEX_SUBSTEPS = 1;
  localparam INDEX_STEPS = 2;
  localparam INDEX_LAST = INDEX_STEPS + AXES - 1;
  localparam [DEPTH_LOG2:0] DEPTH = 1 << DEPTH_LOG2;

  // Writing: one word of a line after the other
  reg [INDEX_LAST:0] index;  // one bit for each word
  reg [DEPTH_LOG2:0] write_line;
  reg [DEPTH_LOG2:0] checked;  // lines of this frame

  wire strobe = select & (bus_check | bus_write);
  wire write = select & bus_write;
  wire line_complete = index[INDEX_LAST];
  wire line_written = write & line_complete;

  assign incomplete = ~index[INDEX_CONTROL];

  // bus_data - 1 - M, but for M itself bus_data - 1. A carry comes out if that is not negative, which is right for
  // M and wrong for N_i. Upper half a clock behind the lower: M - 1 can be written a clock after its strobe.
  reg [31:0] not_substeps;  // ~M; ~0 until M has passed
  reg [31:0] difference;
  reg        carry;
  reg        wrong;
  reg        load_substeps;
  reg        write_substeps;

  always @(posedge clk) begin
    if (strobe) begin
      index <= {index[INDEX_LAST-1:0], index[INDEX_LAST]};
      if (line_complete && bus_check) checked <= checked + 1'b1;
    end
    load_substeps  <= strobe & index[INDEX_SUBSTEPS];
    write_substeps <= write & index[INDEX_SUBSTEPS];
    if (load_substeps) not_substeps <= ~bus_data;
    if (index[INDEX_CONTROL]) not_substeps <= ~32'd0;
    {carry, difference[15:0]} <= {1'b0, bus_data[15:0]} + {1'b0, not_substeps[15:0]};
    {wrong, difference[31:16]} <= {1'b0, bus_data[31:16]} + {index[INDEX_SUBSTEPS], not_substeps[31:16]} + {16'd0, carry};
    if (line_written) write_line <= write_line + 1'b1;
    if (rst || bus_frame) begin
      index   <= {{INDEX_LAST{1'b0}}, 1'b1};
      checked <= {(DEPTH_LOG2 + 1) {1'b0}};
    end
    if (rst || flush) write_line <= {(DEPTH_LOG2 + 1) {1'b0}};
  end

  // what is to be said of the word, a clock before it is asked
  reg  full;
  reg  bad_control;
  wire bad_value = index[INDEX_CONTROL] ? bad_control : wrong;

  always @(posedge clk) begin
    full <= room == checked;
    bad_control <= bus_top_bit > CONTROL_TOP_BIT || bus_data[7:2] != 6'd0;
    refusal     <= !(select && bus_check) ? VERDICT_OK :
                 blocked                ? VERDICT_BUSY :
                 full                   ? VERDICT_QUEUE_FULL :
                 bad_value              ? VERDICT_BAD_VALUE : VERDICT_OK;
  end

  // Reading
  wire [          31:0] next_last_substep;
  reg  [  DEPTH_LOG2:0] next_line;
  reg  [DEPTH_LOG2-1:0] current_line;
  reg                   has_place;  // the current line is not the next line
  wire                  freed = (take & has_place) | release_line;

  always @(posedge clk) begin
    if (take) begin
      current_line <= next_line[DEPTH_LOG2-1:0];
      last_substep <= next_last_substep;
      has_place    <= ~next_endless;
    end
    if (release_line) has_place <= 1'b0;
    if ((take && !next_endless) || (release_line && !has_place)) next_line <= next_line + 1'b1;
    next_valid <= ~take & ~release_line & ~flush & next_line != write_line;
    if (freed != line_written) room <= room + {{DEPTH_LOG2{line_written}}, 1'b1};
    if (rst || flush) begin
      next_line <= {(DEPTH_LOG2 + 1) {1'b0}};
      has_place <= 1'b0;
      room      <= DEPTH;
    end
    if (rst) next_valid <= 1'b0;
  end

  passo_memory #(
    .WIDTH     (CONTROL_BITS),
    .DEPTH_LOG2(DEPTH_LOG2)
  ) u_control (
    .clk          (clk),
    .write        (write & index[INDEX_CONTROL]),
    .write_address(write_line[DEPTH_LOG2-1:0]),
    .write_data   ({bus_data[8+:AXES], bus_data[1:0]}),
    .read_address (next_line[DEPTH_LOG2-1:0]),
    .read_data    ({next_directions, next_endless, next_last})
  );

  passo_memory #(
    .WIDTH     (32),
    .DEPTH_LOG2(DEPTH_LOG2)
  ) u_last_substep (
    .clk          (clk),
    .write        (write_substeps),
    .write_address(write_line[DEPTH_LOG2-1:0]),
    .write_data   (difference),
    .read_address (next_line[DEPTH_LOG2-1:0]),
    .read_data    (next_last_substep)
  );

  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      passo_memory #(
        .WIDTH     (32),
        .DEPTH_LOG2(DEPTH_LOG2)
      ) u_steps (
        .clk          (clk),
        .write        (write & index[INDEX_STEPS+axis]),
        .write_address(write_line[DEPTH_LOG2-1:0]),
        .write_data   (bus_data),
        .read_address (current_line),
        .read_data    (steps[axis*32+:32])
      );
    end
  endgenerate

`ifdef FORMAL
  `include "passo_line_queue_formal.vh"
`endif

endmodule
`resetall
