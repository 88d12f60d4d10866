// SPDX-License-Identifier: MIT
// Promises of the registers of the outputs; included at the end of passo_output_registers.v.

reg f_started = 1'b0;
reg f_ran = 1'b0;  // no reset in the clock before
always @(posedge clk) begin
  f_started <= 1'b1;
  f_ran     <= f_started & ~rst;
  if (!f_started) output_registers_reset : assume (rst);
  if (bus_write || bus_read) registers_address_stands : assume (f_started && $stable(bus_address) && $stable(select));
end

wire f_write = bus_write & select;
wire f_at_pulse = select && bus_address == CHANNEL_COMPARE_PULSE;

always @(posedge clk) begin
  if (f_ran && $stable(bus_address) && $stable(select)) refuses_other_axes : assert (bad_value == (f_at_pulse && bus_data[18:16] >= AXES));
  if (f_started) raster_is_selected :
    assert (select_raster == $past(select && bus_push && bus_address == CHANNEL_RASTER));
  if (f_ran) begin
    levels_strobe : assert (write_levels == $past(f_write && bus_address == CHANNEL_OUTPUT_LEVELS));
    power_strobe :
    assert (write_power == $past(f_write && (bus_address == CHANNEL_PWM_STEP
                                             || bus_address == CHANNEL_POWER_REFERENCE)));
    pulse_strobe : assert (write_pulse == $past(f_write && bus_address == CHANNEL_COMPARE_PULSE));
    distance_strobe : assert (write_distance == $past(f_write && bus_address == CHANNEL_COMPARE_DISTANCE));
    lag_is_kept :
    assert (lag == ($past(f_write && bus_address == CHANNEL_OUTPUT_LAG) ? $past(bus_data[15:0]) : $past(lag)));
    pwm_is_kept :
    assert (pwm_step == ($past(f_write && bus_address == CHANNEL_PWM_STEP) ? $past(bus_data[23:0]) : $past(pwm_step)));
    reference_is_kept :
    assert (power_reference == ($past(f_write && bus_address == CHANNEL_POWER_REFERENCE)
                                ? $past(bus_data) : $past(power_reference)));
    pitch_is_kept :
    assert (pitch == ($past(f_write && bus_address == CHANNEL_RASTER_PITCH) ? $past(bus_data[29:0]) : $past(pitch)));
    pulse_is_kept :
    assert ({compare_axis, compare_width} == ($past(f_write && bus_address == CHANNEL_COMPARE_PULSE)
                                              ? $past(bus_data[18:0]) : $past({compare_axis, compare_width})));
    interval_is_kept :
    assert (compare_interval == ($past(f_write && bus_address == CHANNEL_COMPARE_INTERVAL)
                                 ? $past(bus_data) : $past(compare_interval)));
    state_is_read :
    assert (read_data == ($past(bus_read && select && bus_address == CHANNEL_OUTPUT_STATE)
                          ? {7'd0, raster_room, 6'd0, overflow, raster_empty, levels} : 32'd0));
  end else if (f_started) begin
    reset_strobes : assert (!write_levels && !write_power && !write_pulse && !write_distance && read_data == 32'd0);
    reset_settings :
    assert (lag == 16'd0 && pwm_step == CHANNEL_PWM_STEP_RESET && power_reference == CHANNEL_POWER_REFERENCE_RESET
            && pitch == CHANNEL_RASTER_PITCH_PITCH_RESET && {compare_axis, compare_width} == 19'd0
            && compare_interval == CHANNEL_COMPARE_INTERVAL_INTERVAL_RESET);
  end
end
