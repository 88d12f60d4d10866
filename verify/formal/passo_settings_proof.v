// SPDX-License-Identifier: MIT
// What the registers of a channel and of its axes, and their rules, promise of settings and commands, seen from their
// ports.
`resetall
`default_nettype none

module passo_settings_proof (
  input wire clk, rst,
  input wire bus_check, bus_write, bus_read, bus_push, select,
  input wire [7:0] bus_address,
  input wire [31:0] bus_data,
  input wire [4:0] bus_msb,
  input wire bus_one_hot
);

  `include "passo_registers.vh"

  localparam [16:0] F_ONE = 17'h10000;
  localparam [31:0] F_HALF = 32'h8000_0000;

  wire        claim, select_axis;
  wire [ 3:0] refusal;
  wire [16:0] rate_target, rate_slew, stop_slew;
  wire [31:0] drain_velocity;
  wire        command_stop, command_abort, command_clear, command_zero;
  wire        needs_idle, needs_quiet, pins_need_quiet;
  wire        write_pins, write_step_timing, write_dir_timing, write_enable;
  wire [ 1:0] write_place, timing_place;
  wire [15:0] write_timing, timing;
  wire        timing_written, write_is_minimal;
  wire        high_is_minimal, low_is_minimal, setup_is_minimal, hold_is_minimal;
  wire        both_edges, step_inverted, direction_inverted;

  // of the state nothing is promised
  wire        quiet, stopping, overrun;
  wire [ 2:0] state;
  wire [ 3:0] cause;
  wire [14:0] drained;
  wire [16:0] rate;
  wire [31:0] velocity;
  wire [ 8:0] line_room;
  wire [ 4:0] ramp_room;
  wire [ 3:0] lost;
  wire        write_inputs;
  wire        disable_axis;

  passo_rules #(
    .AXES(1)
  ) u_rules (
    .*,
    .bus_address({select ? 4'd1 : 4'd2, bus_address}),
    .bus_odd    (bus_data[0]),
    .bad_value  (1'b0),
    .needs_quiet(pins_need_quiet)
  );

  passo_channel_registers #(
    .AXES(1)
  ) u_registers (
    .*,
    .read_data        (),
    .select_line_queue(),
    .select_ramp_queue(),
    .select_position  ()
  );

  passo_axis_registers #(
    .AXES(1)
  ) u_axis_registers (
    .*,
    .select_position (),
    .bus_address     (bus_address[2:0]),
    .read_data       (),
    .answers_position(),
    .timing_place    (write_place),
    .timing          (write_timing),
    .timing_is_minimal(write_is_minimal),
    .half             ()
  );

  passo_axis_settings u_settings (
    .*,
    .bus_data       (bus_data[4:0]),
    .enable         (),
    .enable_inverted()
  );

  // --- Which values are bad
  wire f_is_setting = select && bus_address <= CHANNEL_DRAIN_VELOCITY;
  wire f_is_command = select && bus_address == CHANNEL_COMMAND;
  wire f_is_drain_velocity = select && bus_address == CHANNEL_DRAIN_VELOCITY;
  wire f_bad = f_is_command        ? (bus_data & ~CHANNEL_COMMAND_DEFINED) != 32'd0 :
               f_is_drain_velocity ? bus_data == 32'd0 || bus_data > F_HALF : bus_data > {15'd0, F_ONE};
  wire f_stops = bus_data[CHANNEL_COMMAND_STOP_LSB] | bus_data[CHANNEL_COMMAND_ABORT_LSB];
  wire f_told = bus_msb == 5'd0 ? bus_data <= 32'd1 : bus_data >> bus_msb == 32'd1;
  wire f_one_hot = (bus_data & (bus_data - 32'd1)) == 32'd0;

  // --- Assumptions: the link, and the payload buffer
  reg        f_started = 1'b0;
  reg  [1:0] f_reset = 2'b11;  // one and two clocks ago
  reg        f_strobe = 1'b0;  // in the clock before
  reg        f_two = 1'b0;  // two clocks have been
  reg [ 9:0] f_bus_q;
  reg [ 9:0] f_bus_qq;
  reg [31:0] f_data_q;
  reg        f_told_q;
  wire [9:0] f_bus = {select, bus_push, bus_address};
  always @(posedge clk) begin
    f_started <= 1'b1;
    f_reset   <= {f_reset[0], rst};
    f_strobe  <= bus_check | bus_write | bus_read;
    f_two     <= f_started;
    f_bus_q   <= f_bus;
    f_bus_qq  <= f_bus_q;
    f_data_q  <= bus_data;
    f_told_q  <= f_told && bus_one_hot == f_one_hot;
    if (!f_started) settings_reset : assume (rst);
    settings_one_strobe : assume (bus_check + bus_write + bus_read <= 2'd1 && !(f_strobe && (bus_check || bus_write || bus_read)));
    if (bus_check || bus_write || bus_read) 
      settings_bus_stands : assume (f_two && f_bus == f_bus_q && f_bus == f_bus_qq && bus_data == f_data_q);
    if (f_strobe) settings_data_stand : assume (bus_data == f_data_q);
    if (bus_check) settings_told : assume (f_told && bus_one_hot == f_one_hot && f_told_q);
    if (bus_write && f_is_setting) settings_as_checked : assume (!bus_push && !f_bad);
  end

  reg        f_checked = 1'b0;  // a setting, in the clock before
  reg        f_checked_bad;
  reg        f_pushed;
  reg        f_write_pins = 1'b0;
  wire       f_writes_timing = write_step_timing | write_dir_timing;
  wire [31:0] f_times = bus_data | {15'd0, bus_data[31:16] == 16'd0, 15'd0, bus_data[15:0] == 16'd0};
  reg        f_wrote_timing = 1'b0;
  reg        f_wrote_step;
  reg [15:0] f_lower;
  reg  [7:0] f_drain_low;
  reg  [2:0] f_pins;
  wire [ 2:0] f_pins_now = {both_edges, step_inverted, direction_inverted};
  always @(posedge clk) begin
    f_checked      <= bus_check & f_is_setting & ~rst;
    f_checked_bad  <= f_bad;
    f_pushed       <= bus_push;
    f_write_pins   <= write_pins & ~rst;
    f_wrote_timing <= f_writes_timing & ~rst;
    f_wrote_step   <= write_step_timing;
    f_lower        <= f_times[15:0];
    f_drain_low    <= drain_velocity[7:0];
    f_pins         <= f_pins_now;
    if (f_started) begin
      rates_at_most_1 : assert (rate_target <= F_ONE && rate_slew <= F_ONE && stop_slew <= F_ONE);
      if (f_reset == 2'b00)
        drain_velocity_in_range :
        assert ({drain_velocity[31:8], f_drain_low} <= F_HALF && {drain_velocity[31:8], f_drain_low} != 32'd0);
      if (f_checked)
        refused_if_bad :
        assert (claim && refusal == (f_pushed ? VERDICT_BAD_OPERATION : f_checked_bad ? VERDICT_BAD_VALUE : VERDICT_OK));
      if (bus_check && f_is_command && f_stops) stop_needs_nothing : assert (!needs_idle && !needs_quiet);
      if (bus_check && f_is_command && !f_stops && bus_data[CHANNEL_COMMAND_CLEAR_LSB])
        clear_needs_no_motion : assert (needs_idle);
      if (bus_check && f_is_command && !f_stops && bus_data[CHANNEL_COMMAND_ZERO_LSB])
        zero_needs_quiet : assert (needs_quiet);
      if (bus_check && select && bus_address == CHANNEL_AXIS_BASE) pins_need_quiet_channel : assert (pins_need_quiet);
      if (command_stop || command_abort) stop_is_alone : assert (!command_clear && !command_zero && !(command_stop && command_abort));
      if (f_writes_timing) halves_as_sent : assert (write_timing == f_times[31:16] && write_place == {write_step_timing, 1'b1});
      if (f_wrote_timing) lower_half_as_sent : assert (write_timing == f_lower && write_place == {f_wrote_step, 1'b0});
      if (!f_write_pins) pins_change_when_written : assert (f_pins_now == f_pins);
    end
  end

endmodule
`resetall
