// SPDX-License-Identifier: MIT
// Promises of the settings of an axis; included at the end of passo_axis_settings.v.

// --- The timings, as their halves come
reg [15:0] f_high = AXIS_STEP_TIMING_STEP_HIGH_RESET;
reg [15:0] f_low = AXIS_STEP_TIMING_STEP_LOW_RESET;
reg [15:0] f_setup = AXIS_DIR_TIMING_DIR_SETUP_RESET;
reg [15:0] f_hold = AXIS_DIR_TIMING_DIR_HOLD_RESET;
reg [ 1:0] f_place;
reg        f_read = 1'b0;  // `timing` is that of f_place
wire [15:0] f_timing = f_place[1] ? (f_place[0] ? f_high : f_low) : (f_place[0] ? f_setup : f_hold);
always @(posedge clk) begin
  if (write_step_timing && !rst) f_high <= write_timing;
  if (write_dir_timing && !rst) f_setup <= write_timing;
  if (write_lower && write_place[1]) f_low <= write_timing;
  if (write_lower && !write_place[1]) f_hold <= write_timing;
  f_place <= timing_place;
  f_read  <= !timing_written;
  if (f_read) timing_as_written : assert (timing == f_timing);
  timings_not_0 : assert (f_high != 16'd0 && f_low != 16'd0 && f_setup != 16'd0 && f_hold != 16'd0);
  minimal_told :
  assert (high_is_minimal == (f_high == 16'd1) && low_is_minimal == (f_low == 16'd1)
          && setup_is_minimal == (f_setup == 16'd1) && hold_is_minimal == (f_hold == 16'd1));
  assert (timings[3] == f_high && timings[2] == f_low && timings[1] == f_setup && timings[0] == f_hold);
end
