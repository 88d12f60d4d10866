// SPDX-License-Identifier: MIT
// Line queue, line counter and DDAs of a channel, wired as in passo_channel; the bus and the substeps come from the test.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_line_top #(
  parameter AXES       = 3,
  parameter DEPTH_LOG2 = 2,
  parameter STEPS_REGISTER = 0
) (
  input  wire                clk,
  input  wire                rst,
  input  wire                bus_frame,
  input  wire                bus_commit,
  input  wire                bus_check,
  input  wire                bus_write,
  input  wire                select,
  input  wire [        31:0] bus_data,
  input  wire [         4:0] bus_top_bit,
  input  wire                blocked,
  output wire [         3:0] refusal,
  output wire                incomplete,
  output wire [DEPTH_LOG2:0] room,
  input  wire                start,
  input  wire                stop,
  input  wire                release_line,
  input  wire                substep,
  output wire [    AXES-1:0] step_request,
  output wire [    AXES-1:0] directions,
  output wire                line_valid,
  output wire                endless,
  output wire                ended,
  output wire                underrun
);

  wire                      last;
  wire        [   AXES-1:0] current_directions;
  wire        [       29:0] last_substep;
  wire        [AXES*30-1:0] steps;
  wire                      take;
  wire                      slot_add;
  wire                      slot_load;
  wire                      slot_step;
  wire                      slot_load_q;
  wire signed [       30:0] broadcast;

  passo_line_queue #(
    .AXES      (AXES),
    .DEPTH_LOG2(DEPTH_LOG2),
    .STEPS_REGISTER(STEPS_REGISTER)
  ) u_queue (
    .clk                (clk),
    .rst                (rst),
    .bus_frame          (bus_frame),
    .bus_commit         (bus_commit),
    .bus_check          (bus_check),
    .bus_write          (bus_write),
    .select             (select),
    .bus_data           (bus_data),
    .bus_top_bit        (bus_top_bit),
    .blocked            (blocked),
    .refusal            (refusal),
    .incomplete         (incomplete),
    .room               (room),
    .take               (take),
    .release_line       (release_line),
    .flush              (stop),
    .next_valid         (line_valid),
    .last               (last),
    .endless            (endless),
    .last_substep       (last_substep),
    .directions         (current_directions),
    .steps              (steps)
  );

  passo_line #(
    .AXES(AXES)
  ) u_line (
    .clk                (clk),
    .rst                (rst),
    .start              (start),
    .stop               (stop),
    .substep            (substep),
    .next_valid         (line_valid),
    .take               (take),
    .last               (last),
    .endless            (endless),
    .last_substep       (last_substep),
    .current_directions (current_directions),
    .slot_add           (slot_add),
    .slot_load          (slot_load),
    .slot_step          (slot_step),
    .slot_load_q        (slot_load_q),
    .broadcast          (broadcast),
    .directions         (directions),
    .current_endless    (),
    .ended              (ended),
    .underrun           (underrun)
  );

  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      passo_dda u_dda (
        .clk         (clk),
        .slot_add    (slot_add),
        .slot_load   (slot_load),
        .slot_step   (slot_step),
        .slot_load_q (slot_load_q),
        .broadcast   (broadcast),
        .steps       (steps[axis*30+:30]),
        .reached     (),
        .step_request(step_request[axis])
      );
    end
  endgenerate

endmodule
`resetall
