// SPDX-License-Identifier: MIT
// Line queue: lines as pushed, one block RAM column per word, so that a whole line is read in one clock.
//
// Promise: lines come out whole and in order. While `next_valid` is high there is a next line; `take` makes it the
// current line: its length and flags are valid one clock later, its steps and directions two clocks later, until the
// next one is taken. An entry is free again when the line after it is taken, or on `release_line`. `room` excludes all
// lines of a frame from one clock after its commit begins to write, and is otherwise one clock late. `flush`
// drops everything written; it stays high while the channel is stopped, for a push that was checked before.
//
// A push is checked word by word (`bus_check`; the word is stable from two clocks before): room for the line after
// all lines of this frame before it, M not 0 and below 2^30, N_i <= M, no reserved bits. `refusal` answers one clock
// later. With OUTPUTS the output word follows the steps: no reserved bits; with RASTER a raster line, power 0.
// One subtractor serves the checks and computes the stored M - 1, the number of the last substep. The flags are
// stored with it, each direction with its N_i.
//
// With STEPS_REGISTER the steps are registered behind their block RAMs, else the address is before them.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_line_queue #(
  parameter AXES           = 4,
  parameter DEPTH_LOG2     = 8,
  parameter STEPS_REGISTER = 0,  // 1: block RAMs have an output register
  parameter OUTPUTS        = 0,  // 1: a line has an output word
  parameter RASTER         = 0,  // 1: it may be a raster line
  parameter TRACKERS       = 0   // 1: `moves` is wanted
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
  input  wire [         4:0] bus_msb,
  input  wire                blocked,       // the channel is stopped
  output reg  [         3:0] refusal,
  output wire                incomplete,    // the frame so far ends mid-line
  output reg  [DEPTH_LOG2:0] room,          // in lines
  // to the line counter
  input  wire                take,
  input  wire                release_line,
  input  wire                flush,
  output reg                 next_valid,
  output wire                last,          // of the current line
  output wire                endless,
  output wire [        29:0] last_substep,  // its M - 1
  output wire [    AXES-1:0] directions,
  output wire [ AXES*30-1:0] steps,         // its N_i
  output wire [    AXES-1:0] moves,         // N_i is not 0; 0 without TRACKERS
  output wire [        25:0] output_word    // 0 without OUTPUTS
);

  `include "passo_registers.vh"

  localparam [4:0] CONTROL_MSB = 5'd7 + AXES[4:0];
  localparam INDEX_CONTROL = 0;
  localparam INDEX_SUBSTEPS = 1;
  localparam INDEX_STEPS = 2;
  localparam INDEX_OUTPUT = INDEX_STEPS + AXES;
  localparam INDEX_LAST = INDEX_OUTPUT - 1 + OUTPUTS;
  localparam [4:0] COUNT_MSB = 5'd29;
  localparam [4:0] OUTPUT_MSB = RASTER != 0 ? LINE_OUTPUT_RASTER_LSB : LINE_OUTPUT_PROPORTIONAL_LSB;
  localparam [DEPTH_LOG2:0] DEPTH = 1 << DEPTH_LOG2;

  // Writing, word by word
  reg [INDEX_LAST:0] index;  // word of the line, one-hot
  reg [DEPTH_LOG2:0] write_line;
  reg [DEPTH_LOG2:0] write_end;  // write_line after this frame
  reg [DEPTH_LOG2:0] checked;  // lines of this frame

  wire strobe = select & (bus_check | bus_write);
  wire write = select & bus_write;
  wire line_complete = index[INDEX_LAST];
  wire line_written = write & line_complete;

  assign incomplete = ~index[INDEX_CONTROL];

  // Control word of the line in progress
  reg            write_last;
  reg            write_endless;
  reg [AXES-1:0] write_directions;

  always @(posedge clk)
    if (strobe && index[INDEX_CONTROL]) begin
      write_endless    <= bus_data[LINE_CONTROL_ENDLESS_LSB];
      write_last       <= bus_data[LINE_CONTROL_LAST_LSB];
      write_directions <= bus_data[LINE_CONTROL_DIRECTIONS_LSB+:AXES];
    end

  // bus_data - 1 - M, but for M itself bus_data - 1. A carry means not negative: right for M, wrong for N_i. The
  // upper half is one clock behind the lower: M - 1 is ready one clock after its strobe.
  reg  [29:0] not_substeps;  // ~M; ~0 before M
  reg  [29:0] difference;
  reg         carry;
  reg         wrong;
  reg         load_substeps;
  reg         write_substeps;
  wire [ 1:0] unused_bits = bus_data[31:30];  // bus_msb refuses the word if they are not 0

  always @(posedge clk) begin
    if (strobe) begin
      index <= {index[INDEX_LAST-1:0], index[INDEX_LAST]};
      if (line_complete && bus_check) checked <= checked + 1'b1;
    end
    load_substeps  <= strobe & index[INDEX_SUBSTEPS];
    write_substeps <= write & index[INDEX_SUBSTEPS];
    if (load_substeps) not_substeps <= ~bus_data[29:0];
    if (index[INDEX_CONTROL]) not_substeps <= ~30'd0;
    {carry, difference[15:0]} <= {1'b0, bus_data[15:0]} + {1'b0, not_substeps[15:0]};
    {wrong, difference[29:16]} <=
        {1'b0, bus_data[29:16]} + {index[INDEX_SUBSTEPS], not_substeps[29:16]} + {14'd0, carry};
    if (line_written) write_line <= write_line + 1'b1;
    if (bus_frame && bus_commit) write_end <= write_line + checked;
    if (rst || bus_frame) begin
      index   <= {{INDEX_LAST{1'b0}}, 1'b1};
      checked <= {(DEPTH_LOG2 + 1) {1'b0}};
    end
    if (rst || flush) begin
      write_line <= {(DEPTH_LOG2 + 1) {1'b0}};
      write_end  <= {(DEPTH_LOG2 + 1) {1'b0}};
    end
  end

  // Refusal, one clock ahead of the check
  reg  full;
  reg  bad_bits;
  wire is_output = OUTPUTS != 0 && index[INDEX_LAST];

  always @(posedge clk) begin
    full <= room == checked;
    bad_bits <= index[INDEX_CONTROL] ? bus_msb > CONTROL_MSB || bus_data[7:2] != 6'd0 :
                is_output            ? bus_msb > OUTPUT_MSB
                                       || (bus_data[LINE_OUTPUT_RASTER_LSB] && bus_data[15:0] != 16'd0) :
                                       bus_msb > COUNT_MSB;
    refusal  <= !(select && bus_check)                         ? VERDICT_OK :
                blocked                                        ? VERDICT_BUSY :
                full                                           ? VERDICT_QUEUE_FULL :
                bad_bits || (wrong && !index[INDEX_CONTROL] && !is_output) ? VERDICT_BAD_VALUE : VERDICT_OK;
  end

  // Reading
  reg [  DEPTH_LOG2:0] next_line;
  reg [DEPTH_LOG2-1:0] current_line;
  reg                  has_place;  // the current line occupies a place
  reg                  taken;

  always @(posedge clk) begin
    taken <= take;
    if (take) begin
      current_line <= next_line[DEPTH_LOG2-1:0];
      next_line    <= next_line + 1'b1;
      has_place    <= 1'b1;
    end
    if (release_line) has_place <= 1'b0;
    next_valid <= ~take & ~flush & next_line != write_line;
    room       <= (next_line ^ DEPTH) + ~write_end + {{DEPTH_LOG2{1'b0}}, ~has_place};
    if (rst || flush) begin
      next_line <= {(DEPTH_LOG2 + 1) {1'b0}};
      has_place <= 1'b0;
    end
    if (rst) next_valid <= 1'b0;
  end

  passo_memory #(
    .WIDTH     (32),
    .DEPTH_LOG2(DEPTH_LOG2)
  ) u_substeps (
    .clk          (clk),
    .write        (write_substeps),
    .write_address(write_line[DEPTH_LOG2-1:0]),
    .write_data   ({write_last, write_endless, difference}),
    .read_address (next_line[DEPTH_LOG2-1:0]),
    .load         (take),
    .read_data    ({last, endless, last_substep})
  );

  // Data stand in the clock before the strobe, too.
  reg some_steps;
  always @(posedge clk) some_steps <= bus_data[29:0] != 30'd0;

  genvar axis;
  generate
    if (OUTPUTS != 0) begin : g_output
      passo_memory #(
        .WIDTH        (26),
        .DEPTH_LOG2   (DEPTH_LOG2),
        .DATA_REGISTER(STEPS_REGISTER)
      ) u_output (
        .clk          (clk),
        .write        (write & index[INDEX_OUTPUT]),
        .write_address(write_line[DEPTH_LOG2-1:0]),
        .write_data   (bus_data[25:0]),
        .read_address (STEPS_REGISTER != 0 ? next_line[DEPTH_LOG2-1:0] : current_line),
        .load         (taken),
        .read_data    (output_word)
      );
    end else begin : g_no_output
      assign output_word = 26'd0;
    end
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      /* verilator lint_off UNUSEDSIGNAL */
      wire [31:0] written = {some_steps, write_directions[axis], bus_data[29:0]};
      /* verilator lint_on UNUSEDSIGNAL */
      wire [31:0] read;
      passo_memory #(
        .WIDTH        (31 + TRACKERS),
        .DEPTH_LOG2   (DEPTH_LOG2),
        .DATA_REGISTER(STEPS_REGISTER)
      ) u_steps (
        .clk          (clk),
        .write        (write & index[INDEX_STEPS+axis]),
        .write_address(write_line[DEPTH_LOG2-1:0]),
        .write_data   (written[30+TRACKERS:0]),
        .read_address (STEPS_REGISTER != 0 ? next_line[DEPTH_LOG2-1:0] : current_line),
        .load         (taken),
        .read_data    (read[30+TRACKERS:0])
      );
      if (TRACKERS == 0) begin : g_no_moves
        assign read[31] = 1'b0;
      end
      assign {moves[axis], directions[axis], steps[axis*30+:30]} = read;
    end
  endgenerate

`ifdef FORMAL
  `include "passo_line_queue_formal.vh"
`endif

endmodule
`resetall
