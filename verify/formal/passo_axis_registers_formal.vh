// SPDX-License-Identifier: MIT
// Promises of the registers of the axes; included at the end of passo_axis_registers.v.

// --- Assumptions: a reset at the beginning; at most one axis is selected
reg f_started = 1'b0;
reg f_ran = 1'b0;  // no reset in the clock before
always @(posedge clk) begin
  f_started <= 1'b1;
  f_ran     <= f_started & ~rst;
  if (!f_started) axis_registers_reset : assume (rst);
end
always @* axis_registers_one_axis : assume ((select_axis & (select_axis - 1'b1)) == {AXES{1'b0}});

// --- Any one axis, and what an access of the clock before asked of it
(* anyconst *) reg [2:0] f_axis;
always @* axis_registers_axis : assume (f_axis < AXES);
reg f_write, f_read, f_position;
reg [2:0] f_address;
reg [3:0] f_lost;
always @(posedge clk) begin
  f_write    <= bus_write & select_axis[f_axis];
  f_read     <= bus_read & select_axis[f_axis] & bus_address == AXIS_LOST_STEPS;
  f_position <= bus_read & select_position;
  f_address  <= bus_address;
  f_lost     <= lost[f_axis*4+:4];
end

always @(posedge clk)
  if (f_ran) begin
    pins_are_written : assert (write_pins[f_axis] == (f_write && f_address == AXIS_PINS));
    step_timing_is_written : assert (write_step_timing[f_axis] == (f_write && f_address == AXIS_STEP_TIMING));
    dir_timing_is_written : assert (write_dir_timing[f_axis] == (f_write && f_address == AXIS_DIR_TIMING));
    enable_is_written : assert (write_enable[f_axis] == (f_write && f_address == AXIS_ENABLE));
    inputs_are_written : assert (write_inputs[f_axis] == (f_write && f_address == AXIS_INPUTS && INPUTS != 0));
    if (f_read) lost_steps_are_read : assert (read_data == f_lost);
    if (!$past(bus_read && bus_address == AXIS_LOST_STEPS && select_axis != {AXES{1'b0}})) reads_nothing_else : assert (read_data == 4'd0);
    position_is_asked_for : assert (answers_position == f_position);
    half_of_the_word : assert (half == ($past(bus_write) ? $past(bus_data[31:16]) : $past(bus_data[15:0])));
  end else if (f_started) begin
    reset_strobes :
    assert (!write_pins && !write_step_timing && !write_dir_timing && !write_enable && !write_inputs
            && read_data == 4'd0 && !answers_position);
  end
