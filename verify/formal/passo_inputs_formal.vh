// SPDX-License-Identifier: MIT
// Promises of the inputs of a channel; included at the end of passo_inputs.v. Filters, limits and trigger may do
// anything.

reg f_started = 1'b0;
reg f_ran = 1'b0;  // no reset in the clock before
always @(posedge clk) begin
  f_started <= 1'b1;
  f_ran     <= f_started & ~rst;
  if (!f_started) inputs_reset : assume (rst);
  if (bus_write || bus_read) registers_address_stands : assume (f_started && $stable(bus_address) && $stable(select));
end

// --- The causes, in the order in which they are reported
wire f_watchdog = watchdog_stop & moving;
always @* begin
  hard_for_a_reason : assert (hard_stop == (limit_hard || alarm_hard || trigger_hard));
  soft_for_a_reason : assert (soft_stop == (limit_softly || alarm_softly || trigger_soft || f_watchdog));
  if (limit_hard) limit_before_all : assert (hard_cause == CAUSE_LIMIT);
  if (alarm_hard && !limit_hard) alarm_before_trigger : assert (hard_cause == CAUSE_ALARM);
  if (trigger_hard && !limit_hard && !alarm_hard) trigger_is_told : assert (hard_cause == CAUSE_TRIGGER);
  if (limit_softly) soft_limit_before_all : assert (soft_cause == CAUSE_LIMIT);
  if (alarm_softly && !limit_softly) soft_alarm_before_trigger : assert (soft_cause == CAUSE_ALARM);
  if (trigger_soft && !limit_softly && !alarm_softly) soft_trigger_is_told : assert (soft_cause == CAUSE_TRIGGER);
  if (f_watchdog && !limit_softly && !alarm_softly && !trigger_soft)
    watchdog_is_told : assert (soft_cause == CAUSE_WATCHDOG);
  waits_for_the_unknown : assert (wait_known == (unknown || arming));
  alarm_disables_its_axis :
  assert (disable_axis == ({AXES{disable_drives}} | (level[3*AXES+:AXES] & alarm_disables)));
end

// --- The registers
localparam [7:0] F_LAST = CHANNEL_PROBE;
wire f_here = select && bus_address >= CHANNEL_INPUT_LEVELS && bus_address <= F_LAST;
wire [2:0] f_source = bus_data[CHANNEL_TRIGGER_SOURCE_LSB+:CHANNEL_TRIGGER_SOURCE_BITS];
wire f_bad = (bus_data[15:0] & ~CHANNEL_TRIGGER_DEFINED[15:0]) != 16'd0 || f_source > TRIGGER_SOURCE_INDEX
             || (bus_data[CHANNEL_TRIGGER_ARM_LSB] && f_source == TRIGGER_SOURCE_NONE)
             || (f_source != TRIGGER_SOURCE_NONE && f_source != TRIGGER_SOURCE_PROBE
                 && bus_data[CHANNEL_TRIGGER_AXIS_LSB+:CHANNEL_TRIGGER_AXIS_BITS] >= AXES);
reg [31:0] f_levels, f_flags, f_state;
integer f_n;
always @* begin
  {f_levels, f_flags, f_state} = 96'd0;
  for (f_n = 0; f_n < AXES; f_n = f_n + 1) begin
    {f_levels[f_n], f_levels[8+f_n]}     = {level[f_n], level[AXES+f_n]};
    {f_levels[16+f_n], f_levels[24+f_n]} = {level[2*AXES+f_n], level[3*AXES+f_n]};
    {f_flags[f_n], f_flags[8+f_n]}       = {was_active[f_n], was_active[AXES+f_n]};
    {f_flags[16+f_n], f_flags[24+f_n]}   = {was_active[2*AXES+f_n], was_active[3*AXES+f_n]};
    f_state[8+f_n]                       = named[f_n];
  end
  f_state[6:0] = {unknown, source_level & armed, arming, was_active[4*AXES], level[4*AXES], fired, armed};
end

reg [7*AXES:0] f_set;  // as the host wrote it, the settings of each axis together
wire [7*AXES:0] f_has = {
  probe_inverted, alarm_disables, alarm_soft, limit_soft, alarm_inverted, home_inverted, high_inverted, low_inverted
};
wire f_write = bus_write & select;
always @(posedge clk) begin
  f_set <= f_has;
  for (f_n = 0; f_n < AXES; f_n = f_n + 1)
    if (write_axis[f_n] && !rst) begin
      {f_set[AXES+f_n], f_set[f_n]}          <= {bus_data[AXIS_INPUTS_LIMIT_HIGH_INVERTED_LSB], bus_data[AXIS_INPUTS_LIMIT_LOW_INVERTED_LSB]};
      {f_set[3*AXES+f_n], f_set[2*AXES+f_n]} <= {bus_data[AXIS_INPUTS_ALARM_INVERTED_LSB], bus_data[AXIS_INPUTS_HOME_INVERTED_LSB]};
      {f_set[5*AXES+f_n], f_set[4*AXES+f_n]} <= {bus_data[AXIS_INPUTS_ALARM_SOFT_LSB], bus_data[AXIS_INPUTS_LIMIT_SOFT_LSB]};
      f_set[6*AXES+f_n]                      <= bus_data[AXIS_INPUTS_ALARM_DISABLES_LSB];
    end
  if (f_write && bus_address == CHANNEL_PROBE && !rst) f_set[7*AXES] <= bus_data[CHANNEL_PROBE_INVERTED_LSB];
end

always @(posedge clk) begin
  if (f_started) settings_are_kept : assert (f_has == f_set);
  if (f_ran) begin
    if ($past(bus_read && select && bus_address == CHANNEL_INPUT_LEVELS)) levels_are_read : assert (read_data == f_levels);
    if ($past(bus_read && select && bus_address == CHANNEL_INPUT_FLAGS)) flags_are_read : assert (read_data == f_flags);
    if ($past(bus_read && select && bus_address == CHANNEL_TRIGGER_STATE)) state_is_read : assert (read_data == f_state);
    if ($past(!bus_read || !f_here)) reads_nothing : assert (read_data == 32'd0);
    if ($stable(bus_address) && $stable(select))
      refuses_triggers : assert (bad_value == (select && bus_address == CHANNEL_TRIGGER && f_bad));
    if (write_filter || write_axis != {AXES{1'b0}}
        || (f_write && bus_address == CHANNEL_PROBE && bus_data[CHANNEL_PROBE_INVERTED_LSB] != probe_inverted))
      forgets_what_it_knew : assert (forget);
    else keeps_what_it_knows : assert (!forget);
  end
end
