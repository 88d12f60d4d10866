// SPDX-License-Identifier: MIT
// Lines: where the axes go. Line queue, line counter and one DDA per axis. Wiring only.
//
// Promise: in the M substeps of each line, axis i gets exactly N_i step requests, evenly spread; lines follow in the
// order of their pushes, without a lost clock in between.
// Latency: substep to step_request 2 clocks.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_lines #(
  parameter AXES           = 4,
  parameter DEPTH_LOG2     = 8,
  parameter STEPS_REGISTER = 0,  // 1: block RAMs have an output register
  parameter OUTPUTS        = 0,  // 1: a line has an output word
  parameter RASTER         = 0,  // 1: it may be a raster line
  parameter TRACKERS       = 0   // 1: `moves` is wanted
) (
  input  wire                clk,
  input  wire                rst,
  // bus; `select`: a push to the line queue
  input  wire                bus_frame,
  input  wire                bus_commit,
  input  wire                bus_check,
  input  wire                bus_write,
  input  wire                select,
  input  wire [        31:0] bus_data,
  input  wire [         4:0] bus_msb,
  output wire [         3:0] refusal,
  output wire                incomplete,
  output wire [DEPTH_LOG2:0] room,
  // motion
  input  wire                start,         // take the first line
  input  wire                stopped,       // drop all lines
  input  wire                release_line,  // the motion is over
  input  wire                end_endless,   // strobe: the current line no longer repeats
  output wire                valid,         // a line is queued
  output wire                endless,       // the current line repeats
  output wire                ended,         // the LAST line has ended
  output wire                underrun,      // strobe: a line that is not LAST has no successor
  // profile
  input  wire                substep,
  // axes
  output wire [    AXES-1:0] step_request,
  output wire [    AXES-1:0] directions,    // of the line whose steps are being made
  output reg  [    AXES-1:0] moves,         // it has steps of the axis; 0 without TRACKERS
  // outputs
  output wire                line_begins,   // strobe: the next substep is the first of a line
  output wire                line_substep,  // a substep of a line
  output wire [        25:0] output_word    // of the current line, from two clocks after it began
);

  wire                      take;
  wire                      last;
  wire                      next_endless;
  reg                       no_repeat;
  wire        [   AXES-1:0] current_directions;
  wire        [   AXES-1:0] current_moves;
  wire        [       29:0] last_substep;
  wire        [AXES*30-1:0] steps;
  wire                      add_n;
  wire                      load_start;
  wire                      decide_step;
  wire                      load_start_q;
  wire signed [       30:0] line_addend;

  passo_line_queue #(
    .AXES          (AXES),
    .DEPTH_LOG2    (DEPTH_LOG2),
    .STEPS_REGISTER(STEPS_REGISTER),
    .OUTPUTS       (OUTPUTS),
    .RASTER        (RASTER),
    .TRACKERS      (TRACKERS)
  ) u_queue (
    .clk         (clk),
    .rst         (rst),
    .bus_frame   (bus_frame),
    .bus_commit  (bus_commit),
    .bus_check   (bus_check),
    .bus_write   (bus_write),
    .select      (select),
    .bus_data    (bus_data),
    .bus_msb     (bus_msb),
    .blocked     (stopped),
    .refusal     (refusal),
    .incomplete  (incomplete),
    .room        (room),
    .take        (take),
    .release_line(release_line),
    .flush       (stopped),
    .next_valid  (valid),
    .last        (last),
    .endless     (next_endless),
    .last_substep(last_substep),
    .directions  (current_directions),
    .steps       (steps),
    .moves       (current_moves),
    .output_word (output_word)
  );

  always @(posedge clk) begin
    no_repeat <= end_endless | (no_repeat & ~take);  // until the next line, if at rest the first one
    if (load_start_q) moves <= current_moves;
    if (rst || TRACKERS == 0) moves <= {AXES{1'b0}};
  end

  passo_line #(
    .AXES(AXES)
  ) u_line (
    .clk               (clk),
    .rst               (rst),
    .start             (start),
    .stop              (stopped),
    .substep           (substep),
    .next_valid        (valid),
    .take              (take),
    .last              (last),
    .endless           (next_endless & ~no_repeat),
    .last_substep      (last_substep),
    .current_directions(current_directions),
    .add_n             (add_n),
    .load_start        (load_start),
    .decide_step       (decide_step),
    .load_start_q      (load_start_q),
    .line_addend       (line_addend),
    .directions        (directions),
    .current_endless   (endless),
    .ended             (ended),
    .underrun          (underrun),
    .line_begins       (line_begins),
    .substep_taken     (line_substep)
  );

  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      passo_dda u_dda (
        .clk         (clk),
        .add_n       (add_n),
        .load_start  (load_start),
        .decide_step (decide_step),
        .load_start_q(load_start_q),
        .line_addend (line_addend),
        .steps       (steps[axis*30+:30]),
        .step_request(step_request[axis])
      );
    end
  endgenerate

endmodule
`resetall
