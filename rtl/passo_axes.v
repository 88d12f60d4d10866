// SPDX-License-Identifier: MIT
// Axes: pins, settings and positions of all axes of a channel. Wiring only.
//
// Promise: step requests become legal pin waveforms according to the settings of each axis; positions count active
// edges. `quiet`, one clock late: no step is queued or in progress on any axis.
// Latency: step_request to STEP 3 clocks, to step_overrun 1 clock.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_axes #(
  parameter            AXES         = 4,
  parameter            INPUTS       = 0,
  parameter            TRACKERS     = 0,
  parameter            BLOCK_RAM    = 1,  // for the timings
  parameter [AXES-1:0] STEP_RESET   = 0,
  parameter [AXES-1:0] DIR_RESET    = 0,
  parameter [AXES-1:0] ENABLE_RESET = 0
) (
  input  wire            clk,
  input  wire            rst,
  // bus
  input  wire            bus_write,
  input  wire            bus_read,
  input  wire [AXES-1:0] select_axis,
  input  wire            select_position,
  input  wire [     3:0] bus_address,      // within the block
  input  wire [    31:0] bus_data,
  output wire [    31:0] read_data,
  // positions of trackers
  input  wire            of_tracker,       // one is addressed
  input  wire            tracker_takes,
  input  wire [    15:0] tracker_half,
  output wire [    15:0] bus_half,         // one clock late the upper half of bus_data, then the lower one
  // lines
  input  wire [AXES-1:0] step_request,
  input  wire [AXES-1:0] directions,
  // motion
  input  wire            drop,             // drop the queued steps
  // inputs of the machine
  input  wire [AXES-1:0] closed_low,       // block steps
  input  wire [AXES-1:0] closed_high,
  input  wire [AXES-1:0] disable_axis,     // clear the drive enable
  input  wire            latch,            // keep the positions of this clock
  output wire [AXES-1:0] waits,            // the next queued step
  output wire [AXES-1:0] negative,
  output wire [AXES-1:0] write_inputs,     // strobes with bus_data
  output wire [AXES-1:0] enable_off,       // level of EN that disables
  input  wire            clear,            // clears lost_steps
  input  wire            zero,             // zeroes the positions
  input  wire            snapshot,         // copies the positions for the new frame
  output wire            quiet,
  output reg             step_overrun,     // strobe: a step was lost
  output wire [AXES-1:0] lost_steps,       // since `clear`, one bit per axis
  output wire [AXES-1:0] step_made,        // strobes: the active edge leaves the pin with the next clock
  output wire [AXES-1:0] step_direction,   // with step_made: 1 = negative
  // pins
  output wire [AXES-1:0] step,
  output wire [AXES-1:0] dir,
  output wire [AXES-1:0] enable
);

  `include "passo_registers.vh"

  wire [  AXES-1:0] full;
  wire [  AXES-1:0] axis_quiet;
  wire [AXES*4-1:0] lost;
  wire [  AXES-1:0] write_pins;
  wire [  AXES-1:0] write_step_timing;
  wire [  AXES-1:0] write_dir_timing;
  wire [  AXES-1:0] write_enable;
  wire [       1:0] write_place;
  wire [      15:0] write_timing;
  wire              write_is_minimal;
  wire [       3:0] lost_read;
  wire              answers_position;
  wire [      31:0] position;

  assign quiet     = axis_quiet == {AXES{1'b1}};
  assign read_data = {28'd0, lost_read} | (position & {32{answers_position}});

  always @(posedge clk) step_overrun <= ~rst & ((step_request & full) != {AXES{1'b0}});

  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      wire        timing_written;
      wire [ 1:0] timing_place;
      wire [15:0] timing;
      wire        high_is_minimal;
      wire        low_is_minimal;
      wire        setup_is_minimal;
      wire        hold_is_minimal;
      wire        both_edges;
      wire        step_inverted;
      wire        direction_inverted;
      wire        enable_wanted;
      wire        enable_inverted;

      assign lost_steps[axis] = lost[axis*4+:4] != 4'd0;
      assign enable_off[axis] = enable_inverted;

      passo_axis #(
        .STEP_RESET  (STEP_RESET[axis]),
        .DIR_RESET   (DIR_RESET[axis]),
        .ENABLE_RESET(ENABLE_RESET[axis])
      ) u_axis (
        .clk               (clk),
        .rst               (rst),
        .step_request      (step_request[axis]),
        .direction         (directions[axis]),
        .drop              (drop),
        .closed_low        (closed_low[axis]),
        .closed_high       (closed_high[axis]),
        .waits_next        (waits[axis]),
        .negative_next     (negative[axis]),
        .step_made         (step_made[axis]),
        .step_direction    (step_direction[axis]),
        .full              (full[axis]),
        .quiet             (axis_quiet[axis]),
        .clear             (clear),
        .lost              (lost[axis*4+:4]),
        .timing_place      (timing_place),
        .timing            (timing),
        .high_is_minimal   (high_is_minimal),
        .low_is_minimal    (low_is_minimal),
        .setup_is_minimal  (setup_is_minimal),
        .hold_is_minimal   (hold_is_minimal),
        .timing_written    (timing_written),
        .pins_written      (write_pins[axis]),
        .both_edges_next   (bus_data[AXIS_PINS_BOTH_EDGES_LSB]),
        .both_edges        (both_edges),
        .step_inverted     (step_inverted),
        .direction_inverted(direction_inverted),
        .enable            (enable_wanted),
        .enable_inverted   (enable_inverted),
        .step_pin          (step[axis]),
        .dir_pin           (dir[axis]),
        .enable_pin        (enable[axis])
      );

      passo_axis_settings #(
        .BLOCK_RAM   (BLOCK_RAM),
        .STEP_RESET  (STEP_RESET[axis]),
        .DIR_RESET   (DIR_RESET[axis]),
        .ENABLE_RESET(ENABLE_RESET[axis])
      ) u_settings (
        .clk               (clk),
        .rst               (rst),
        .write_pins        (write_pins[axis]),
        .write_step_timing (write_step_timing[axis]),
        .write_dir_timing  (write_dir_timing[axis]),
        .write_enable      (write_enable[axis]),
        .disable_axis      (disable_axis[axis]),
        .bus_data          (bus_data[4:0]),
        .write_place       (write_place),
        .write_timing      (write_timing),
        .write_is_minimal  (write_is_minimal),
        .timing_written    (timing_written),
        .timing_place      (timing_place),
        .timing            (timing),
        .high_is_minimal   (high_is_minimal),
        .low_is_minimal    (low_is_minimal),
        .setup_is_minimal  (setup_is_minimal),
        .hold_is_minimal   (hold_is_minimal),
        .both_edges        (both_edges),
        .step_inverted     (step_inverted),
        .direction_inverted(direction_inverted),
        .enable            (enable_wanted),
        .enable_inverted   (enable_inverted)
      );
    end
  endgenerate

  passo_axis_registers #(
    .AXES  (AXES),
    .INPUTS(INPUTS)
  ) u_registers (
    .clk              (clk),
    .rst              (rst),
    .bus_write        (bus_write),
    .bus_read         (bus_read),
    .select_axis      (select_axis),
    .select_position  (select_position | (TRACKERS != 0 && of_tracker)),
    .bus_address      (bus_address[2:0]),
    .bus_data         (bus_data),
    .read_data        (lost_read),
    .answers_position (answers_position),
    .write_pins       (write_pins),
    .write_step_timing(write_step_timing),
    .write_dir_timing (write_dir_timing),
    .write_enable     (write_enable),
    .write_inputs     (write_inputs),
    .timing_place     (write_place),
    .timing           (write_timing),
    .timing_is_minimal(write_is_minimal),
    .half             (bus_half),
    .lost             (lost)
  );

  passo_positions #(
    .AXES    (AXES),
    .LATCH   (INPUTS),
    .TRACKERS(TRACKERS)
  ) u_positions (
    .clk           (clk),
    .rst           (rst),
    .step_made     (step_made),
    .step_direction(step_direction),
    .zero          (zero),
    .snapshot      (snapshot),
    .latch         (latch),
    .address       (bus_address),
    .of_tracker    (of_tracker),
    .tracker_takes (tracker_takes),
    .tracker_half  (tracker_half),
    .position      (position)
  );

`ifdef FORMAL
  `include "passo_axes_formal.vh"
`endif

endmodule
`resetall
