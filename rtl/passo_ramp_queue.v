// SPDX-License-Identifier: MIT
// Ramp queue: ramps in half-words, 10 in a slot of 16, so that a few ramps take one block RAM.
//
// Promise: ramps come out whole and in order. `half` is half-word `half_index` of the oldest ramp, three clocks after
// the index; `take` removes that ramp. A ramp with NOW raises `now_pending`; `take_now` drops all ramps before it, so
// that it is the oldest. `flush` drops everything written.
//
// A push is checked word by word (`bus_check`): room for the ramp after all ramps of this frame before it, a velocity
// of at most 1/2, no reserved bits. `refusal` answers one clock later. A word is written in two clocks, upper half
// first. `room` excludes all ramps of a frame from one clock after its commit begins to write.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_ramp_queue #(
  parameter DEPTH_LOG2 = 4
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
  output wire                incomplete,    // the frame so far ends mid-ramp
  output wire                needs_motion,  // strobe: a NOW ramp is being checked
  output reg  [DEPTH_LOG2:0] room,          // in ramps
  // to the ramp
  input  wire                take,
  input  wire                take_now,
  input  wire                flush,
  output reg                 valid,         // two clocks late
  output reg                 now_pending,
  input  wire [         3:0] half_index,
  output reg  [        15:0] half
);

  `include "passo_registers.vh"

  localparam [2:0] INDEX_CONTROL = 3'd0;  // v_end(47:32), control
  localparam [2:0] INDEX_VELOCITY_LOW = 3'd1;
  localparam [2:0] INDEX_TICKS = 3'd2;
  localparam [2:0] INDEX_STEP_HIGH = 3'd3;  // du(47:32)
  localparam [2:0] INDEX_LAST = 3'd4;
  localparam [15:0] VELOCITY_MAX_HIGH = 16'h8000;

  // Writing
  reg [         2:0] index;
  reg [DEPTH_LOG2:0] write_ramp;
  reg [DEPTH_LOG2:0] write_end;  // write_ramp after this frame
  reg [DEPTH_LOG2:0] now_ramp;
  reg [DEPTH_LOG2:0] checked;  // ramps of this frame
  reg                velocity_is_max;  // by its upper 16 bits
  reg                write_low;  // second clock of a write
  reg                is_now;
  reg                is_mirror;

  wire strobe = select & (bus_check | bus_write);
  wire write_high = select & bus_write;

  assign incomplete   = index != INDEX_CONTROL;
  assign needs_motion = select & bus_check & bus_data[RAMP_CONTROL_NOW_LSB] & ~incomplete;

  always @(posedge clk) begin
    write_low <= write_high;
    if (strobe && index == INDEX_CONTROL) begin
      velocity_is_max <= bus_data[31:16] == VELOCITY_MAX_HIGH;
      is_now          <= bus_data[RAMP_CONTROL_NOW_LSB];
      is_mirror       <= bus_data[RAMP_CONTROL_MIRROR_LSB];
    end
    if ((select && bus_check) || write_low) index <= index == INDEX_LAST ? INDEX_CONTROL : index + 3'd1;
    if (select && bus_check && index == INDEX_LAST) checked <= checked + 1'b1;
    if (take_now) now_pending <= 1'b0;
    if (write_low && index == INDEX_LAST) begin
      write_ramp <= write_ramp + 1'b1;
      if (is_now) begin
        now_ramp    <= write_ramp;
        now_pending <= 1'b1;
      end
    end
    if (bus_frame && bus_commit) write_end <= write_ramp + checked;
    if (rst || bus_frame) begin
      index   <= INDEX_CONTROL;
      checked <= {(DEPTH_LOG2 + 1) {1'b0}};
    end
    if (flush) begin
      now_pending <= 1'b0;
      write_end   <= write_ramp;
    end
    if (rst) begin
      write_ramp  <= {(DEPTH_LOG2 + 1) {1'b0}};
      write_end   <= {(DEPTH_LOG2 + 1) {1'b0}};
      write_low   <= 1'b0;
      now_pending <= 1'b0;
    end
  end

  // Refusal, one clock ahead of the check
  reg full;
  reg bad_control;
  reg bad_velocity_high;
  reg bad_velocity_low;
  reg bad_step_high;
  wire bad_value = (index == INDEX_CONTROL && (bad_control || bad_velocity_high))
                   || (index == INDEX_VELOCITY_LOW && bad_velocity_low) || (index == INDEX_STEP_HIGH && bad_step_high);

  always @(posedge clk) begin
    full <= room == checked;
    bad_control <= (bus_data & ~RAMP_CONTROL_DEFINED) != 32'd0;
    bad_velocity_high <= bus_data[31:16] > VELOCITY_MAX_HIGH;
    bad_velocity_low <= velocity_is_max && (bus_msb != 5'd0 || bus_data[0]);
    bad_step_high <= bus_msb > 5'd15;
    refusal          <= !(select && bus_check) ? VERDICT_OK :
                        blocked                ? VERDICT_BUSY :
                        full                   ? VERDICT_QUEUE_FULL :
                        bad_value              ? VERDICT_BAD_VALUE : VERDICT_OK;
  end

  // Reading
  reg [DEPTH_LOG2:0] read_ramp;

  always @(posedge clk) begin
    if (take) read_ramp <= read_ramp + 1'b1;
    if (take_now) read_ramp <= now_ramp;
    if (flush) read_ramp <= write_ramp;
    valid <= read_ramp != write_ramp;
    room  <= {1'b1, {DEPTH_LOG2{1'b0}}} - (write_end - read_ramp);
    if (rst) begin
      read_ramp <= {(DEPTH_LOG2 + 1) {1'b0}};
      valid     <= 1'b0;
    end
  end

  // Stored as the ramp needs it: T inverted, and du of mirrored ramps
  reg invert;

  always @(posedge clk)
    invert <= index == INDEX_TICKS || (is_mirror && (index == INDEX_STEP_HIGH || index == INDEX_LAST));

  wire [15:0] word;

  always @(posedge clk) half <= word;

  passo_memory #(
    .WIDTH     (16),
    .DEPTH_LOG2(DEPTH_LOG2 + 4)
  ) u_ramps (
    .clk          (clk),
    .write        (write_high | write_low),
    .write_address({write_ramp[DEPTH_LOG2-1:0], index, write_low}),
    .write_data   ((write_low ? bus_data[15:0] : bus_data[31:16]) ^ {16{invert}}),
    .read_address ({read_ramp[DEPTH_LOG2-1:0], half_index}),
    .load         (1'b1),
    .read_data    (word)
  );

`ifdef FORMAL
  `include "passo_ramp_queue_formal.vh"
`endif

endmodule
`resetall
