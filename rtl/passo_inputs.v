// SPDX-License-Identifier: MIT
// Inputs of a channel: levels and flags, limits and alarms, the trigger, and their registers.
//
// Promise: `read_data` is the addressed register one clock after `bus_read`, for one clock, else 0. `bad_value`: a
// checked word of TRIGGER names a source or an axis that the core lacks. `hard_stop` and `soft_stop` ask the motion to stop, each with its cause; `hard_stop` also drops the steps that wait.
// `wait_known`: an input is unknown, or a trigger is being armed, so that no motion may begin.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_inputs #(
  parameter AXES = 4
) (
  input  wire            clk,
  input  wire            rst,
  // bus
  input  wire            bus_write,
  input  wire            bus_read,
  input  wire            select,
  input  wire [     7:0] bus_address,     // within the channel
  input  wire [    31:0] bus_data,
  output wire            bad_value,
  output wire [    31:0] read_data,
  input  wire [AXES-1:0] write_axis,      // strobes with bus_data: the register INPUTS of an axis
  // core
  input  wire            tick,            // of the filter
  input  wire [    15:0] filter,
  input  wire            write_filter,    // strobe: it changes with the next clock
  input  wire            watchdog_stop,
  input  wire            disable_drives,
  // pins
  input  wire [AXES-1:0] limit_low,
  input  wire [AXES-1:0] limit_high,
  input  wire [AXES-1:0] home,
  input  wire [AXES-1:0] alarm,
  input  wire            probe,
  input  wire [AXES-1:0] index,           // of encoders, synchronized
  // axes
  input  wire [AXES-1:0] waits,
  input  wire [AXES-1:0] negative,
  output wire [AXES-1:0] closed_low,
  output wire [AXES-1:0] closed_high,
  output wire [AXES-1:0] disable_axis,
  output wire            latch,           // strobe: latch the positions
  // motion
  input  wire            may_close,
  input  wire            moving,
  input  wire            clear,
  output wire            hard_stop,
  output wire [     3:0] hard_cause,
  output wire            soft_stop,
  output wire [     3:0] soft_cause,
  output wire            end_endless,
  output wire            wait_known
);

  `include "passo_registers.vh"

  localparam WIDTH = 4 * AXES + 1;

  // Registers. Decoded one clock ahead of the strobe: the address is stable by then.
  reg        known;
  wire [2:0] number = bus_address[2:0];

  wire of_axis = bus_data[CHANNEL_TRIGGER_SOURCE_LSB+:CHANNEL_TRIGGER_SOURCE_BITS] != TRIGGER_SOURCE_NONE
                 && bus_data[CHANNEL_TRIGGER_SOURCE_LSB+:CHANNEL_TRIGGER_SOURCE_BITS] != TRIGGER_SOURCE_PROBE;
  wire [3:0] axis = {1'b0, bus_data[CHANNEL_TRIGGER_AXIS_LSB+:CHANNEL_TRIGGER_AXIS_BITS]};
  wire is_trigger = known && number == CHANNEL_TRIGGER[2:0];
  wire bad_trigger = (bus_data[15:0] & ~CHANNEL_TRIGGER_DEFINED[15:0]) != 16'd0
                     || bus_data[CHANNEL_TRIGGER_SOURCE_LSB+:CHANNEL_TRIGGER_SOURCE_BITS] > TRIGGER_SOURCE_INDEX
                     || (bus_data[CHANNEL_TRIGGER_ARM_LSB]
                         && bus_data[CHANNEL_TRIGGER_SOURCE_LSB+:CHANNEL_TRIGGER_SOURCE_BITS] == TRIGGER_SOURCE_NONE)
                     || (of_axis && axis >= AXES[3:0]);
  wire write = bus_write & known;
  wire write_trigger = bus_write && is_trigger;
  wire write_probe = write && number == CHANNEL_PROBE[2:0];
  wire clear_flags = write && number == CHANNEL_INPUT_CLEAR[2:0];
  reg [7:0] reads;

  assign bad_value = is_trigger && bad_trigger;

  integer i;
  always @(posedge clk) begin
    known <= select && bus_address[7:3] == CHANNEL_INPUT_LEVELS[7:3];
    for (i = 0; i < 8; i = i + 1) reads[i] <= bus_read && known && number == i[2:0];
  end

  // Settings of the inputs: they describe the machine and are kept over a reset.
  reg [AXES-1:0] low_inverted;
  reg [AXES-1:0] high_inverted;
  reg [AXES-1:0] home_inverted;
  reg [AXES-1:0] alarm_inverted;
  reg [AXES-1:0] limit_soft;
  reg [AXES-1:0] alarm_soft;
  reg [AXES-1:0] alarm_disables;
  reg            probe_inverted;

  genvar n;
  generate
    for (n = 0; n < AXES; n = n + 1) begin : g_axis
      always @(posedge clk)
        if (write_axis[n] && !rst) begin
          low_inverted[n]   <= bus_data[AXIS_INPUTS_LIMIT_LOW_INVERTED_LSB];
          high_inverted[n]  <= bus_data[AXIS_INPUTS_LIMIT_HIGH_INVERTED_LSB];
          home_inverted[n]  <= bus_data[AXIS_INPUTS_HOME_INVERTED_LSB];
          alarm_inverted[n] <= bus_data[AXIS_INPUTS_ALARM_INVERTED_LSB];
          limit_soft[n]     <= bus_data[AXIS_INPUTS_LIMIT_SOFT_LSB];
          alarm_soft[n]     <= bus_data[AXIS_INPUTS_ALARM_SOFT_LSB];
          alarm_disables[n] <= bus_data[AXIS_INPUTS_ALARM_DISABLES_LSB];
        end
    end
  endgenerate
  always @(posedge clk) if (write_probe && !rst) probe_inverted <= bus_data[CHANNEL_PROBE_INVERTED_LSB];

  initial begin
    low_inverted   = {AXES{1'b0}};
    high_inverted  = {AXES{1'b0}};
    home_inverted  = {AXES{1'b0}};
    alarm_inverted = {AXES{1'b0}};
    limit_soft     = {AXES{1'b0}};
    alarm_soft     = {AXES{1'b0}};
    alarm_disables = {AXES{1'b0}};
    probe_inverted = 1'b0;
  end

  // Levels that were filtered otherwise say nothing about the ones to come.
  wire forget = write_filter || write_axis != {AXES{1'b0}}
                || (write_probe && bus_data[CHANNEL_PROBE_INVERTED_LSB] != probe_inverted);
  wire unknown;
  wire [WIDTH-1:0] synced;
  wire [WIDTH-1:0] level;
  wire [WIDTH-1:0] was_active;

  wire [AXES-1:0] clear_low = bus_data[0+:AXES] & {AXES{clear_flags}};
  wire [AXES-1:0] clear_high = bus_data[8+:AXES] & {AXES{clear_flags}};
  wire [AXES-1:0] clear_home = bus_data[16+:AXES] & {AXES{clear_flags}};
  wire [AXES-1:0] clear_alarm = bus_data[24+:AXES] & {AXES{clear_flags}};

  passo_input #(
    .WIDTH(WIDTH)
  ) u_input (
    .clk(clk),
    .rst(rst),
    .pins({probe, alarm, home, limit_high, limit_low}),
    .inverted({probe_inverted, alarm_inverted, home_inverted, high_inverted, low_inverted}),
    .tick(tick),
    .forget(forget),
    .clear({write_probe & bus_data[CHANNEL_PROBE_CLEAR_LSB], clear_alarm, clear_home, clear_high, clear_low}),
    .synced(synced),
    .level(level),
    .was_active(was_active),
    .unknown(unknown)
  );

  wire            limit_hard;
  wire            limit_softly;
  wire            alarm_hard;
  wire            alarm_softly;
  wire [AXES-1:0] named;

  passo_limits #(
    .AXES(AXES)
  ) u_limits (
    .clk         (clk),
    .rst         (rst),
    .limit_low   (level[0+:AXES]),
    .limit_high  (level[AXES+:AXES]),
    .alarm       (level[3*AXES+:AXES]),
    .limit_soft  (limit_soft),
    .alarm_soft  (alarm_soft),
    .waits       (waits),
    .negative    (negative),
    .may_close   (may_close),
    .closed_low  (closed_low),
    .closed_high (closed_high),
    .clear       (clear),
    .limit_hard  (limit_hard),
    .limit_softly(limit_softly),
    .alarm_hard  (alarm_hard),
    .alarm_softly(alarm_softly),
    .named       (named)
  );

  wire arming;
  wire armed;
  wire source_level;
  wire fired;
  wire trigger_hard;
  wire trigger_soft;

  passo_trigger #(
    .AXES(AXES)
  ) u_trigger (
    .clk        (clk),
    .rst        (rst),
    .write      (write_trigger),
    .bus_data   (bus_data[16:0]),
    .filter     (filter),
    .forget     (forget),
    .sources    ({index, synced[0+:3*AXES]}),
    .probe      (synced[4*AXES]),
    .arming     (arming),
    .armed      (armed),
    .level      (source_level),
    .fired      (fired),
    .latch      (latch),
    .hard_stop  (trigger_hard),
    .soft_stop  (trigger_soft),
    .end_endless(end_endless)
  );

  assign wait_known = unknown | arming;
  assign hard_stop = limit_hard | alarm_hard | trigger_hard;
  assign hard_cause = limit_hard ? CAUSE_LIMIT : alarm_hard ? CAUSE_ALARM : CAUSE_TRIGGER;
  assign soft_stop = limit_softly | alarm_softly | trigger_soft | (watchdog_stop & moving);
  assign soft_cause   = limit_softly ? CAUSE_LIMIT :
                        alarm_softly ? CAUSE_ALARM :
                        trigger_soft ? CAUSE_TRIGGER : CAUSE_WATCHDOG;
  assign disable_axis = (level[3*AXES+:AXES] & alarm_disables) | {AXES{disable_drives}};

  wire [31:0] levels = {
    {{(8 - AXES) {1'b0}}, level[3*AXES+:AXES]},
    {{(8 - AXES) {1'b0}}, level[2*AXES+:AXES]},
    {{(8 - AXES) {1'b0}}, level[AXES+:AXES]},
    {{(8 - AXES) {1'b0}}, level[0+:AXES]}
  };
  wire [31:0] flags = {
    {{(8 - AXES) {1'b0}}, was_active[3*AXES+:AXES]},
    {{(8 - AXES) {1'b0}}, was_active[2*AXES+:AXES]},
    {{(8 - AXES) {1'b0}}, was_active[AXES+:AXES]},
    {{(8 - AXES) {1'b0}}, was_active[0+:AXES]}
  };
  wire [31:0] state = {
    16'd0,
    {{(8 - AXES) {1'b0}}, named},
    1'b0,
    unknown,
    source_level & armed,
    arming,
    was_active[4*AXES],
    level[4*AXES],
    fired,
    armed
  };

  assign read_data = (reads[CHANNEL_INPUT_LEVELS[2:0]] ? levels : 32'd0)
                     | (reads[CHANNEL_INPUT_FLAGS[2:0]] ? flags : 32'd0)
                     | (reads[CHANNEL_TRIGGER_STATE[2:0]] ? state : 32'd0);

`ifdef FORMAL
  `include "passo_inputs_formal.vh"
`endif

endmodule
`resetall
