// SPDX-License-Identifier: MIT
// Parameters of a core: their ranges. No ports and no logic.
//
// Promise: a core with a parameter outside its range is not elaborated: the module that is missing names the range.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_parameters #(
  parameter integer CHANNELS        = 1,
  parameter integer AXES            = 4,
  parameter integer TICK_LOG2       = 7,
  parameter integer LINE_QUEUE_LOG2 = 8,
  parameter integer RAMP_QUEUE_LOG2 = 4,
  parameter integer INPUTS          = 0,
  parameter integer ENCODERS        = 0,
  parameter integer OUTPUTS         = 0,
  parameter integer RASTER          = 0,
  parameter integer COMPARE         = 0,
  parameter integer TRACKERS        = 0,
  parameter integer TRACKED         = 0
) ();

  generate
    if (CHANNELS < 1 || CHANNELS > 8) begin : g_bad_channels
      passo_parameter_CHANNELS_must_be_1_to_8 u_error ();
    end
    if (AXES < 1 || AXES > 8) begin : g_bad_axes
      passo_parameter_AXES_must_be_1_to_8 u_error ();
    end
    if (TICK_LOG2 < 7 || TICK_LOG2 > 16) begin : g_bad_tick
      passo_parameter_TICK_LOG2_must_be_7_to_16 u_error ();
    end
    if (LINE_QUEUE_LOG2 < 2 || LINE_QUEUE_LOG2 > 8) begin : g_bad_line_queue
      passo_parameter_LINE_QUEUE_LOG2_must_be_2_to_8 u_error ();
    end
    if (INPUTS < 0 || INPUTS > 1) begin : g_bad_inputs
      passo_parameter_INPUTS_must_be_0_or_1 u_error ();
    end
    if (ENCODERS < 0 || ENCODERS > 1) begin : g_bad_encoders
      passo_parameter_ENCODERS_must_be_0_or_1 u_error ();
    end
    if (OUTPUTS < 0 || OUTPUTS > 1) begin : g_bad_outputs
      passo_parameter_OUTPUTS_must_be_0_or_1 u_error ();
    end
    if (RASTER < 0 || RASTER > 1 || (RASTER != 0 && OUTPUTS == 0)) begin : g_bad_raster
      passo_parameter_RASTER_must_be_0_or_with_OUTPUTS_1 u_error ();
    end
    if (COMPARE < 0 || COMPARE > 1 || (COMPARE != 0 && OUTPUTS == 0)) begin : g_bad_compare
      passo_parameter_COMPARE_must_be_0_or_with_OUTPUTS_1 u_error ();
    end
    if (TRACKERS < 0 || TRACKERS > 1) begin : g_bad_trackers
      passo_parameter_TRACKERS_must_be_0_or_1 u_error ();
    end
    if (TRACKED < 0 || TRACKED >= AXES || (TRACKED != 0 && TRACKERS == 0)) begin : g_bad_tracked
      passo_parameter_TRACKED_must_be_below_AXES_with_TRACKERS u_error ();
    end
    if (RAMP_QUEUE_LOG2 < 2 || RAMP_QUEUE_LOG2 > 8) begin : g_bad_ramp_queue
      passo_parameter_RAMP_QUEUE_LOG2_must_be_2_to_8 u_error ();
    end
  endgenerate

endmodule
`resetall
