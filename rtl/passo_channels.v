// SPDX-License-Identifier: MIT
// Channels of a core, and what they share: shape tables, sync input, slew tick, and with INPUTS the e-stop, the
// watchdog and the filter of the machine. Wiring, except for sync and slew tick.
//
// Promise: what any channel answers, rejects or asks is that of all. `slew_tick` comes once per tick of real clocks.
// Latency: a rising edge of `sync` starts the armed channels 4 clocks later.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_channels #(
  parameter                     CHANNELS        = 1,
  parameter                     AXES            = 4,
  parameter                     TICK_LOG2       = 7,
  parameter                     LINE_QUEUE_LOG2 = 8,
  parameter                     RAMP_QUEUE_LOG2 = 4,
  parameter                     STEPS_REGISTER  = 0,
  parameter                     INPUTS          = 0,
  parameter                     ENCODERS        = 0,
  parameter                     OUTPUTS         = 0,
  parameter                     RASTER          = 0,
  parameter                     COMPARE         = 0,
  parameter                     TRACKERS        = 0,
  parameter                     TRACKED         = 0,
  parameter [CHANNELS*AXES-1:0] STEP_RESET      = 0,
  parameter [CHANNELS*AXES-1:0] DIR_RESET       = 0,
  parameter [CHANNELS*AXES-1:0] ENABLE_RESET    = 0
) (
  input  wire                                    clk,
  input  wire                                    rst,
  // bus
  input  wire                                    bus_frame,
  input  wire                                    bus_commit,
  input  wire                                    bus_check,
  input  wire                                    bus_write,
  input  wire                                    bus_read,
  input  wire                                    bus_push,
  input  wire [                            11:0] bus_address,
  input  wire [                            31:0] bus_data,
  input  wire [                             4:0] bus_msb,
  input  wire                                    needs_quiet,
  output wire                                    bad_value,
  output reg  [                             3:0] refusal,
  output reg  [                            31:0] read_data,
  output wire                                    incomplete,
  output wire                                    busy,
  // core
  input  wire                                    snapshot,
  input  wire [                    CHANNELS-1:0] run,
  input  wire [                    CHANNELS-1:0] wait_sync,
  output wire [                    CHANNELS-1:0] stopped,
  output wire [                    CHANNELS-1:0] occupied,
  output wire [CHANNELS*(LINE_QUEUE_LOG2+1)-1:0] line_room,
  output wire [CHANNELS*(RAMP_QUEUE_LOG2+1)-1:0] ramp_room,
  // pins: bit channel * AXES + axis
  input  wire                                    sync,
  input  wire [               CHANNELS*AXES-1:0] limit_low,
  input  wire [               CHANNELS*AXES-1:0] limit_high,
  input  wire [               CHANNELS*AXES-1:0] home,
  input  wire [               CHANNELS*AXES-1:0] alarm,
  input  wire [                    CHANNELS-1:0] probe,
  /* verilator lint_off UNUSEDSIGNAL */
  input  wire                                    estop_n,        // asynchronous
  /* verilator lint_on UNUSEDSIGNAL */
  input  wire [               CHANNELS*AXES-1:0] encoder_a,
  input  wire [               CHANNELS*AXES-1:0] encoder_b,
  input  wire [               CHANNELS*AXES-1:0] encoder_index,
  output wire [               CHANNELS*AXES-1:0] step,
  output wire [               CHANNELS*AXES-1:0] dir,
  output wire [               CHANNELS*AXES-1:0] enable,
  output wire [                  CHANNELS*8-1:0] outputs,
  output wire [                    CHANNELS-1:0] power,
  output wire [                    CHANNELS-1:0] compare,
  output wire [                    CHANNELS-1:0] running
);

  `include "passo_registers.vh"

  wire [   CHANNELS-1:0] channel_bad_value;
  wire [ CHANNELS*4-1:0] channel_refusal;
  wire [CHANNELS*32-1:0] channel_read_data;
  wire [   CHANNELS-1:0] channel_incomplete;
  wire [   CHANNELS-1:0] channel_busy;

  // tables
  wire                   tables_wanted;
  wire [   CHANNELS-1:0] table_request;
  wire [CHANNELS*10-1:0] table_address;
  wire [   CHANNELS-1:0] table_served;
  wire [           15:0] table_point;
  wire [           15:0] table_point_next;

  // inputs of the machine
  wire                filter_tick;
  wire [        15:0] filter;
  wire                write_filter;
  wire                estop_pressed;
  wire                estop;
  wire                watchdog_stop;
  wire                disable_drives;
  /* verilator lint_off UNUSEDSIGNAL */
  wire [CHANNELS-1:0] moving;
  /* verilator lint_on UNUSEDSIGNAL */
  wire [        31:0] machine_read_data;

  assign bad_value  = channel_bad_value != {CHANNELS{1'b0}};
  assign incomplete = channel_incomplete != {CHANNELS{1'b0}};
  assign busy       = channel_busy != {CHANNELS{1'b0}} || (tables_wanted && occupied != {CHANNELS{1'b0}});

  // Unselected targets drive 0.
  integer i;
  always @* begin
    refusal   = 4'd0;
    read_data = machine_read_data;
    for (i = 0; i < CHANNELS; i = i + 1) begin
      refusal   = refusal | channel_refusal[i*4+:4];
      read_data = read_data | channel_read_data[i*32+:32];
    end
  end

  // Shape banks 1 .. 3 are the last three blocks of 256 addresses.
  reg select_tables;  // one clock after the address, in time for the strobe

  (* async_reg = "true" *)
  reg  [          2:0] sync_q;
  wire                 sync_edge = sync_q[1] & ~sync_q[2];
  reg  [TICK_LOG2-1:0] slew_count;
  reg                  slew_tick;

  always @(posedge clk) begin
    select_tables <= bus_address[11:10] == ADDRESS_COSINE_BASE[11:10] && bus_address[9:8] != 2'd0;
    sync_q        <= {sync_q[1:0], sync};
    slew_count    <= slew_count + 1'b1;
    slew_tick     <= slew_count == {TICK_LOG2{1'b1}};
    if (rst) begin
      sync_q     <= 3'b111;
      slew_count <= {TICK_LOG2{1'b0}};
      slew_tick  <= 1'b0;
    end
  end

  passo_tables #(
    .CHANNELS(CHANNELS)
  ) u_tables (
    .clk        (clk),
    .rst        (rst),
    .bus_frame  (bus_frame),
    .bus_commit (bus_commit),
    .bus_check  (bus_check),
    .bus_write  (bus_write),
    .select     (select_tables),
    .bus_address(bus_address[9:0]),
    .bus_data   (bus_data[15:0]),
    .wanted     (tables_wanted),
    .request    (table_request),
    .address    (table_address),
    .served     (table_served),
    .point      (table_point),
    .point_next (table_point_next)
  );

  generate
    if (INPUTS != 0) begin : g_machine
      passo_machine #(
        .TICK_LOG2(TICK_LOG2)
      ) u_machine (
        .clk           (clk),
        .rst           (rst),
        .bus_write     (bus_write),
        .bus_read      (bus_read),
        .bus_address   (bus_address),
        .bus_data      (bus_data[19:0]),
        .read_data     (machine_read_data),
        .estop_n       (estop_n),
        .moving        (moving != {CHANNELS{1'b0}}),
        .slew_tick     (slew_tick),
        .tick          (filter_tick),
        .filter        (filter),
        .write_filter  (write_filter),
        .pressed       (estop_pressed),
        .estop         (estop),
        .watchdog_stop (watchdog_stop),
        .disable_drives(disable_drives)
      );
    end else begin : g_no_machine
      assign machine_read_data = 32'd0;
      assign filter_tick       = 1'b0;
      assign filter            = 16'd0;
      assign write_filter      = 1'b0;
      assign estop_pressed     = 1'b0;
      assign estop             = 1'b0;
      assign watchdog_stop     = 1'b0;
      assign disable_drives    = 1'b0;
    end
  endgenerate

  genvar channel;
  generate
    for (channel = 0; channel < CHANNELS; channel = channel + 1) begin : g_channel
      localparam [3:0] BLOCK = channel + 1;

      passo_channel #(
        .AXES           (AXES),
        .TICK_LOG2      (TICK_LOG2),
        .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
        .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2),
        .STEPS_REGISTER (STEPS_REGISTER),
        .INPUTS         (INPUTS),
        .ENCODERS       (ENCODERS),
        .OUTPUTS        (OUTPUTS),
        .RASTER         (RASTER),
        .COMPARE        (COMPARE),
        .TRACKERS       (TRACKERS),
        .TRACKED        (TRACKED),
        .STEP_RESET     (STEP_RESET[channel*AXES+:AXES]),
        .DIR_RESET      (DIR_RESET[channel*AXES+:AXES]),
        .ENABLE_RESET   (ENABLE_RESET[channel*AXES+:AXES])
      ) u_channel (
        .clk             (clk),
        .rst             (rst),
        .bus_frame       (bus_frame),
        .bus_commit      (bus_commit),
        .bus_check       (bus_check),
        .bus_write       (bus_write),
        .bus_read        (bus_read),
        .bus_push        (bus_push),
        .select          (bus_address[11:8] == BLOCK),
        .bus_address     (bus_address[7:0]),
        .bus_data        (bus_data),
        .bus_msb         (bus_msb),
        .needs_quiet     (needs_quiet),
        .bad_value       (channel_bad_value[channel]),
        .refusal         (channel_refusal[channel*4+:4]),
        .read_data       (channel_read_data[channel*32+:32]),
        .incomplete      (channel_incomplete[channel]),
        .busy            (channel_busy[channel]),
        .tables_wanted   (tables_wanted),
        .run             (run[channel]),
        .wait_sync       (wait_sync[channel]),
        .sync_edge       (sync_edge),
        .slew_tick       (slew_tick),
        .snapshot        (snapshot),
        .stopped         (stopped[channel]),
        .occupied        (occupied[channel]),
        .line_room       (line_room[channel*(LINE_QUEUE_LOG2+1)+:LINE_QUEUE_LOG2+1]),
        .ramp_room       (ramp_room[channel*(RAMP_QUEUE_LOG2+1)+:RAMP_QUEUE_LOG2+1]),
        .table_request   (table_request[channel]),
        .table_address   (table_address[channel*10+:10]),
        .table_served    (table_served[channel]),
        .table_point     (table_point),
        .table_point_next(table_point_next),
        .filter_tick     (filter_tick),
        .filter          (filter),
        .write_filter    (write_filter),
        .estop_pressed   (estop_pressed),
        .estop           (estop),
        .watchdog_stop   (watchdog_stop),
        .disable_drives  (disable_drives),
        .limit_low       (limit_low[channel*AXES+:AXES]),
        .limit_high      (limit_high[channel*AXES+:AXES]),
        .home            (home[channel*AXES+:AXES]),
        .alarm           (alarm[channel*AXES+:AXES]),
        .probe           (probe[channel]),
        .moving          (moving[channel]),
        .encoder_a       (encoder_a[channel*AXES+:AXES]),
        .encoder_b       (encoder_b[channel*AXES+:AXES]),
        .encoder_index   (encoder_index[channel*AXES+:AXES]),
        .step            (step[channel*AXES+:AXES]),
        .dir             (dir[channel*AXES+:AXES]),
        .enable          (enable[channel*AXES+:AXES]),
        .outputs         (outputs[channel*8+:8]),
        .power           (power[channel]),
        .compare         (compare[channel]),
        .running         (running[channel])
      );
    end
  endgenerate

`ifdef FORMAL
  `include "passo_channels_formal.vh"
`endif

endmodule
`resetall
